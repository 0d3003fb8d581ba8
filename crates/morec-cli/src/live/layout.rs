//! The option `--layout`: the threads of recognition.

use morec::live::{SessionOptions, Threading};
use morec_live::pin_thread;

/// The values of `--layout`.
#[derive(clap::ValueEnum, Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum LayoutArg {
    /// One thread
    #[default]
    Inline,
    /// A thread for each stage (method of 2009 only)
    Stages,
    /// The same, each thread tied to a core
    Pinned,
}

impl LayoutArg {
    /// The usual options with this layout.
    pub fn options(self) -> SessionOptions {
        let (layout, on_thread): (_, Option<fn(&'static str)>) = match self {
            LayoutArg::Inline => (Threading::Inline, None),
            LayoutArg::Stages => (Threading::Stages, None),
            LayoutArg::Pinned => (Threading::Stages, Some(pin_thread)),
        };
        SessionOptions {
            layout,
            on_thread,
            ..SessionOptions::default()
        }
    }
}

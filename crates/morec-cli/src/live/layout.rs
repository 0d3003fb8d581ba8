//! How recognition is laid out on threads, as it is typed.

use morec::live::{SessionOptions, Threading};
use morec_live::pin_thread;

/// `--layout`.
#[derive(clap::ValueEnum, Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum LayoutArg {
    /// All of recognition on one thread
    #[default]
    Inline,
    /// A thread for each stage of the method of 2009, as its thesis has it (indexes of svrdm only)
    Stages,
    /// The same, every thread tied to a core as long as there are any, then round again
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

//! How recognition is laid out on threads, as it is typed.

use morec::live::{Layout, SessionOptions};

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
            LayoutArg::Inline => (Layout::Inline, None),
            LayoutArg::Stages => (Layout::Stages, None),
            LayoutArg::Pinned => (Layout::Stages, Some(pin)),
        };
        SessionOptions {
            layout,
            on_thread,
            ..SessionOptions::default()
        }
    }
}

/// Threads in the order in which frames pass them: neighbours go to neighbouring cores.
const STAGES: [&str; 7] = [
    "source",
    "input",
    "segments",
    "extraction",
    "classification",
    "scoring",
    "tracking",
];

/// Ties this thread to its core. Where the system allows no such thing, the thread goes where it is sent.
fn pin(what: &'static str) {
    let (Some(stage), Some(cores)) = (
        STAGES.iter().position(|stage| *stage == what),
        core_affinity::get_core_ids(),
    ) else {
        return;
    };
    if let Some(core) = cores.get(stage % cores.len().max(1)) {
        core_affinity::set_for_current(*core);
    }
}

//! How recognition is laid out on threads, as it is typed.

use morec::live::Layout;

/// `--layout`.
#[derive(clap::ValueEnum, Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum LayoutArg {
    /// All of recognition on one thread
    #[default]
    Inline,
    /// A thread for each stage of the method of 2009, as its thesis has it (indexes of svrdm only)
    Stages,
}

impl From<LayoutArg> for Layout {
    fn from(arg: LayoutArg) -> Self {
        match arg {
            LayoutArg::Inline => Layout::Inline,
            LayoutArg::Stages => Layout::Stages,
        }
    }
}

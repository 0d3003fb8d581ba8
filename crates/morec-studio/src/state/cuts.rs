//! Cuts of the clip that is shown: dragged into place, added, removed. Cuts by hand are kept apart from automatic ones.

/// Commands for cuts; moments are seconds of the clip.
#[derive(Debug, Clone, PartialEq)]
pub enum CutCommand {
    /// Takes hold of the cut at a moment.
    Grab(f64),
    /// The pointer that holds it is there.
    Drag(f64),
    Drop,
    Select(Option<f64>),
    Add(f64),
    /// Removes the cut at a moment.
    Remove(f64),
    /// Forgets what was put into place: the cuts that the method finds are kept.
    Reset,
}

/// A cut that is being dragged: where it was, where it is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HeldCut {
    pub from_secs: f64,
    pub at_secs: f64,
    /// Dropped, and on its way to the database.
    pub dropped: bool,
}

//! Options of a receiver of VMC.

/// Options of a receiver.
#[derive(Debug, Clone, PartialEq)]
pub struct VmcOptions {
    /// Exchange left and right: for senders that show their performer as a mirror would.
    pub mirrored: bool,
    /// Performers that are followed at once, at most [`MAX_PERFORMERS`](morec::live::MAX_PERFORMERS); packets of others are counted and left.
    pub actors: usize,
    /// Leave out frames that show a T-pose too exact to be a person's.
    pub skip_t_pose: bool,
}

impl Default for VmcOptions {
    fn default() -> Self {
        Self {
            mirrored: false,
            actors: 4,
            skip_t_pose: true,
        }
    }
}

//! Poses and notices that a receiver has made of its packets and that the session has not fetched yet.

use std::collections::VecDeque;

use morec::live::{Frame, SourceEvent, SourceItem};

/// Complete frames, skeletons and departures that wait to be taken, oldest first; used frames come back for reuse.
#[derive(Debug, Default)]
pub(crate) struct ReadyItems {
    items: VecDeque<SourceItem<Frame>>,
    spare: Vec<Frame>,
}

impl ReadyItems {
    /// A frame to be filled in.
    pub(crate) fn spare(&mut self) -> Frame {
        self.spare.pop().unwrap_or_default()
    }

    /// Takes back a frame that is not needed.
    pub(crate) fn give_back(&mut self, frame: Frame) {
        self.spare.push(frame);
    }

    pub(crate) fn push(&mut self, item: SourceItem<Frame>) {
        self.items.push_back(item);
    }

    /// The next event; fills `frame` for [`SourceEvent::Frame`].
    pub(crate) fn next(&mut self, frame: &mut Frame) -> Option<SourceEvent> {
        Some(match self.items.pop_front()? {
            SourceItem::Frame(mut full) => {
                std::mem::swap(frame, &mut full);
                self.spare.push(full);
                SourceEvent::Frame
            }
            SourceItem::Rig(actor, rig) => SourceEvent::Rig(actor, rig),
            SourceItem::Gone(actor) => SourceEvent::Gone(actor),
        })
    }
}

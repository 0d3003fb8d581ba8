//! Reads a datagram of VMC once, into its time stamps, bones and states.

use super::message::{VmcMessage, understand};
use crate::osc;

/// What a datagram says, in its order.
#[derive(Debug, Default)]
pub(super) struct Datagram {
    said: Vec<VmcMessage>,
    sent_secs: Option<f64>,
    malformed: bool,
}

impl Datagram {
    /// Reads any bytes. O(bytes); takes memory only for more messages than any datagram before had.
    pub(super) fn read(&mut self, bytes: &[u8]) {
        self.said.clear();
        (self.sent_secs, self.malformed) = (None, false);
        let malformed = osc::read(bytes, &mut |message| match understand(&message) {
            Some(said) => {
                if let VmcMessage::Time(secs) = said {
                    self.sent_secs = Some(secs);
                }
                self.said.push(said);
            }
            None => self.malformed = true,
        });
        self.malformed |= malformed > 0;
    }

    pub(super) fn said(&self) -> &[VmcMessage] {
        &self.said
    }

    /// Its last stamp, of the sender's clock.
    pub(super) fn sent_secs(&self) -> Option<f64> {
        self.sent_secs
    }

    /// True if a part of it could not be understood.
    pub(super) fn is_malformed(&self) -> bool {
        self.malformed
    }
}

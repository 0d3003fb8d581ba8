//! The first block of a C3D file.

use super::number::Processor;
use super::params::BLOCK;

/// Contents of the header.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct C3dHeader {
    pub(super) points: usize,
    /// Analog values in a frame.
    pub(super) analog: usize,
    pub(super) first_frame: u16,
    pub(super) last_frame: u16,
    /// Length of an integer step; negative if points are floats.
    pub(super) scale: f64,
    pub(super) data_block: usize,
    pub(super) rate_hz: f64,
    /// Seconds and names of up to 18 events.
    pub(super) events: Vec<(f64, String)>,
}

/// The word that says that events have names of four letters.
const NAMED_EVENTS: u16 = 12345;
const MOST_EVENTS: usize = 18;

impl C3dHeader {
    /// Reads a header of [`BLOCK`] bytes.
    pub(super) fn read(bytes: &[u8; BLOCK], processor: Processor) -> Self {
        // Words are counted from 1 in the format's description.
        let pair = |word: usize| [bytes[2 * word - 2], bytes[2 * word - 1]];
        let word = |number: usize| processor.u16(pair(number));
        let float = |number: usize| {
            let ([a, b], [c, d]) = (pair(number), pair(number + 1));
            processor.f32([a, b, c, d])
        };
        let mut events = Vec::new();
        if word(150) == NAMED_EVENTS {
            for event in 0..usize::from(word(151)).min(MOST_EVENTS) {
                let name = &bytes[396 + 4 * event..400 + 4 * event];
                let name = String::from_utf8_lossy(name);
                let name = name.trim_matches(['\0', ' ']).to_owned();
                events.push((float(153 + 2 * event), name));
            }
        }
        Self {
            points: usize::from(word(2)),
            analog: usize::from(word(3)),
            first_frame: word(4),
            last_frame: word(5),
            scale: float(7),
            data_block: usize::from(word(9)),
            rate_hz: float(11),
            events,
        }
    }

    /// True if these values can be a header's.
    pub(super) fn is_plausible(&self) -> bool {
        let rate = self.rate_hz;
        self.data_block > 1 && (rate == 0.0 || (0.01..100_000.0).contains(&rate))
    }
}

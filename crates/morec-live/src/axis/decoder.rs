//! Decodes the bytes of the broadcast to frames, and encodes frames.

use super::AXIS_BONE_COUNT;

/// Bytes of a header.
pub(super) const HEADER: usize = 64;
pub(super) const BEGIN: u16 = 0xDDFF;
pub(super) const END: u16 = 0xEEFF;
/// The version that the programs send.
pub(super) const VERSION: u32 = 0x0101_0000;
/// Numbers of a frame at most; the broadcast has 360.
pub const MAX_VALUES: usize = 2048;

/// Values of the hips and 58 bones that have angles only.
pub(super) const WITHOUT_POSITIONS: usize = 3 + 3 * AXIS_BONE_COUNT;
/// Values of bones that have positions, too.
pub(super) const WITH_POSITIONS: usize = 6 * AXIS_BONE_COUNT;
/// Values before the hips, if there is a reference.
pub(super) const REFERENCE: usize = 6;

/// A frame as it was sent.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AxisFrame<'a> {
    /// Number of the avatar.
    pub avatar: u32,
    /// Name of the avatar, as far as it is text.
    pub name: &'a str,
    /// Number of the frame.
    pub number: u32,
    /// True if every bone has a position.
    pub positions: bool,
    /// From the hips on: 354 with positions, 180 without.
    pub values: &'a [f32],
}

/// Something in the stream that is no frame.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum AxisError {
    /// Bytes between frames, or what looked like one and was not.
    #[error("byte {at}: expected a frame (FF DD …), found {skipped} other bytes")]
    Rubbish {
        /// Place in the stream, bytes from its beginning.
        at: u64,
        /// Number of bytes left out.
        skipped: u64,
    },
    /// A header that says something impossible.
    #[error("byte {at}: expected {expected} numbers in a frame, found {found}")]
    Count {
        /// Place of the header.
        at: u64,
        /// The required number, in words.
        expected: &'static str,
        /// The number that the header declares.
        found: usize,
    },
    /// A word that is not a number.
    #[error("byte {at}: expected a position or an angle, found {found}")]
    Value {
        /// Place of the number.
        at: u64,
        /// The value, as text.
        found: String,
    },
}

/// Makes frames of the bytes of a stream, however these are cut into pieces. What is no frame is left out, said, and the
/// next frame is found. Holds one frame's bytes at most.
#[derive(Debug, Clone, Default)]
pub struct AxisDecoder {
    buffer: Vec<u8>,
    values: Vec<f32>,
    /// Place of the buffer's first byte in the stream.
    at: u64,
    /// Start of the present run of bytes that belong to no frame.
    rubbish_at: Option<u64>,
}

/// Contents of the buffer's beginning.
enum FrameHead {
    /// Too little to say.
    Short,
    /// No frame.
    None,
    /// A frame of this many bytes.
    Frame(usize),
}

impl AxisDecoder {
    /// A stream that begins now.
    pub fn new() -> Self {
        Self::default()
    }

    /// Takes the next bytes of the stream; calls `out` with every frame that is now whole and every error. Takes memory
    /// only until the first frame is through.
    pub fn push(
        &mut self,
        mut bytes: &[u8],
        out: &mut impl FnMut(Result<AxisFrame<'_>, AxisError>),
    ) {
        while !bytes.is_empty() {
            // Little at a time, so that the buffer stays small whatever comes.
            let (piece, rest) = bytes.split_at(bytes.len().min(4096));
            self.buffer.extend_from_slice(piece);
            bytes = rest;
            let mut used = 0;
            loop {
                match self.head(used, out) {
                    FrameHead::Short => break,
                    FrameHead::None => {
                        self.rubbish_at.get_or_insert(self.at + used as u64);
                        used += self.next_begin(used + 1);
                    }
                    FrameHead::Frame(length) => {
                        self.end_rubbish(used, out);
                        self.frame(used, length, out);
                        used += length;
                    }
                }
            }
            self.buffer.drain(..used);
            self.at += used as u64;
        }
    }

    /// The stream ends: says what was left over.
    pub fn finish(&mut self, out: &mut impl FnMut(Result<AxisFrame<'_>, AxisError>)) {
        if !self.buffer.is_empty() {
            self.rubbish_at.get_or_insert(self.at);
        }
        self.end_rubbish(self.buffer.len(), out);
        self.at += self.buffer.len() as u64;
        self.buffer.clear();
    }

    fn end_rubbish(&mut self, used: usize, out: &mut impl FnMut(Result<AxisFrame<'_>, AxisError>)) {
        if let Some(at) = self.rubbish_at.take() {
            out(Err(AxisError::Rubbish {
                at,
                skipped: self.at + used as u64 - at,
            }));
        }
    }

    fn u16(&self, at: usize) -> Option<u16> {
        Some(u16::from_le_bytes(
            self.buffer.get(at..at + 2)?.try_into().ok()?,
        ))
    }

    fn u32(&self, at: usize) -> u32 {
        let bytes = self
            .buffer
            .get(at..at + 4)
            .and_then(|bytes| bytes.try_into().ok());
        u32::from_le_bytes(bytes.unwrap_or_default())
    }

    /// Decodes the contents at `used`.
    fn head(
        &self,
        used: usize,
        out: &mut impl FnMut(Result<AxisFrame<'_>, AxisError>),
    ) -> FrameHead {
        let begin = BEGIN.to_le_bytes();
        let there = &self.buffer[used..];
        if !there.iter().zip(&begin).all(|(a, b)| a == b) {
            return FrameHead::None;
        }
        let Some(end) = self.u16(used + HEADER - 2) else {
            return FrameHead::Short;
        };
        if end != END {
            return FrameHead::None;
        }
        let count = usize::from(self.u16(used + 6).unwrap_or_default());
        let (positions, reference) = (there[8] != 0, there[9] != 0);
        if count < values_of(positions, reference) || count > MAX_VALUES {
            let expected = match (positions, reference) {
                (false, false) => "180 to 2048",
                (false, true) => "186 to 2048",
                (true, false) => "354 to 2048",
                (true, true) => "360 to 2048",
            };
            out(Err(AxisError::Count {
                at: self.at + used as u64,
                expected,
                found: count,
            }));
            return FrameHead::None;
        }
        let length = HEADER + 4 * count;
        if there.len() < length {
            FrameHead::Short
        } else {
            FrameHead::Frame(length)
        }
    }

    /// Bytes from the one before `from` to the next possible beginning of a frame.
    fn next_begin(&self, from: usize) -> usize {
        let [first, _] = BEGIN.to_le_bytes();
        let found = self.buffer[from..].iter().position(|byte| *byte == first);
        1 + found.unwrap_or(self.buffer.len() - from)
    }

    fn frame(
        &mut self,
        used: usize,
        length: usize,
        out: &mut impl FnMut(Result<AxisFrame<'_>, AxisError>),
    ) {
        let header = &self.buffer[used..used + HEADER];
        let (positions, reference) = (header[8] != 0, header[9] != 0);
        let first = HEADER + if reference { REFERENCE * 4 } else { 0 };
        let values = &self.buffer[used + first..used + length];
        self.values.clear();
        // Sizes were checked: there are at least as many.
        let wanted = if positions {
            WITH_POSITIONS
        } else {
            WITHOUT_POSITIONS
        };
        for (n, bytes) in values.chunks_exact(4).take(wanted).enumerate() {
            let value = f32::from_le_bytes(bytes.try_into().unwrap_or_default());
            // Kilometres away, or turned round a thousand times, is no pose either.
            if !(value.is_finite() && value.abs() < 1e6) {
                let at = self.at + (used + first + 4 * n) as u64;
                out(Err(AxisError::Value {
                    at,
                    found: value.to_string(),
                }));
                return;
            }
            self.values.push(value);
        }
        let name = &header[14..46];
        let name = &name[..name
            .iter()
            .position(|byte| *byte == 0)
            .unwrap_or(name.len())];
        out(Ok(AxisFrame {
            avatar: self.u32(used + 10),
            name: std::str::from_utf8(name).unwrap_or_default(),
            number: self.u32(used + 46),
            positions,
            values: &self.values,
        }));
    }
}

/// Values that a frame must have.
pub(super) fn values_of(positions: bool, reference: bool) -> usize {
    let bones = if positions {
        WITH_POSITIONS
    } else {
        WITHOUT_POSITIONS
    };
    bones + if reference { REFERENCE } else { 0 }
}

//! Codes the curves of all channels; each number as its difference from a prediction.

use crate::coder::{Coder, Flag, Whole};
use crate::smooth::ChannelKind;
use crate::smooth::bezier::{ChannelValue, Tangent};
use crate::smooth::lattice::{Code, Lattice, MOST_STEPS, Piece, StepSize, Tangents};

/// Why a channel could not be read.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Fault {
    /// The bytes are used up.
    Cut,
    /// More curves than there can be.
    TooMany,
    /// A number that no writer writes.
    Number,
}

/// Forecasts of one kind of channel.
#[derive(Default)]
struct CurveModel {
    steps: [Whole; 2],
    constant: Flag,
    same_steps: Flag,
    first: Whole,
    frames: Whole,
    line: Flag,
    parabola: Flag,
    key: [Whole; 2],
    leaving: Whole,
    arriving: Whole,
}

/// Foresees and codes channels, one after the other.
#[derive(Default)]
pub(super) struct MotionCoder {
    rotation: CurveModel,
    position: CurveModel,
    steps: [Option<Lattice>; 2],
}

/// A channel as it is stored.
pub(super) struct Stored {
    pub lattice: Lattice,
    pub first: Code,
    pub pieces: Vec<Piece>,
}

/// State of a curve between one piece and the next.
struct ChannelState {
    key: Code,
    point: ChannelValue,
    /// Velocity at which the last piece arrived, in tangents a sample period; zero at the start.
    arrival: Tangent,
}

/// Share of the way to the next key that the leaving tangent predicts: 3 were the curve a line, and less the more it
/// slows down.
const REACH_OF_TANGENT: f64 = 1.8;

impl MotionCoder {
    /// Writes `channel`, or reads a channel of `frames` frames and at most `most` curve segments, depending on `coder`. When
    /// reading, the content of `channel` is ignored.
    ///
    /// # Errors
    /// When reading: the bytes end early, or a value is out of range.
    pub fn channel<C: Coder>(
        &mut self,
        coder: &mut C,
        kind: ChannelKind,
        channel: &Stored,
        frames: usize,
        most: usize,
    ) -> Result<Stored, Fault> {
        let (model, last) = match kind {
            ChannelKind::Rotation => (&mut self.rotation, &mut self.steps[0]),
            ChannelKind::Position => (&mut self.position, &mut self.steps[1]),
        };
        let lattice = model.lattice(coder, kind, channel.lattice, *last)?;
        *last = Some(lattice);
        let first = code(coder, &mut model.first, channel.first, [0; 3])?;
        let mut pieces = Vec::new();
        if model.constant.code(coder, channel.pieces.is_empty()) {
            return Ok(Stored {
                lattice,
                first,
                pieces,
            });
        }
        let mut state = ChannelState {
            key: first,
            point: lattice.key_point(&first, None),
            arrival: Tangent::zeros(),
        };
        let mut left = frames.saturating_sub(1);
        while left > 0 {
            if coder.is_beyond_end() {
                return Err(Fault::Cut);
            }
            if pieces.len() >= most {
                return Err(Fault::TooMany);
            }
            let given = channel.pieces.get(pieces.len()).copied();
            let piece = model.piece(coder, &lattice, given, &mut state)?;
            left = left
                .checked_sub(piece.frames as usize)
                .ok_or(Fault::Number)?;
            pieces.push(piece);
        }
        Ok(Stored {
            lattice,
            first,
            pieces,
        })
    }
}

impl CurveModel {
    /// The steps of a channel: mostly those of the channel before.
    fn lattice<C: Coder>(
        &mut self,
        coder: &mut C,
        kind: ChannelKind,
        given: Lattice,
        last: Option<Lattice>,
    ) -> Result<Lattice, Fault> {
        if let Some(last) = last
            && self.same_steps.code(coder, given == last)
        {
            return Ok(last);
        }
        let mut step = |given: StepSize, model: &mut Whole| {
            i8::try_from(model.signed(coder, i64::from(given.0)))
                .map(StepSize)
                .map_err(|_| Fault::Number)
        };
        let key = step(given.key, &mut self.steps[0])?;
        let tangent = step(given.tangent, &mut self.steps[1])?;
        Ok(Lattice { kind, key, tangent })
    }

    fn piece<C: Coder>(
        &mut self,
        coder: &mut C,
        lattice: &Lattice,
        given: Option<Piece>,
        state: &mut ChannelState,
    ) -> Result<Piece, Fault> {
        let given = given.unwrap_or(Piece {
            frames: 1,
            key: state.key,
            tangents: Tangents::Cubic([0; 3], [0; 3]),
        });
        let frames = self.frames.natural(coder, u64::from(given.frames - 1));
        let frames = u32::try_from(frames)
            .ok()
            .and_then(|f| f.checked_add(1))
            .ok_or(Fault::Number)?;
        let line = self
            .line
            .code(coder, matches!(given.tangents, Tangents::Line));
        let parabola = !line
            && self
                .parabola
                .code(coder, matches!(given.tangents, Tangents::Parabola(_)));
        let leaving_as_arrived = state.arrival * f64::from(frames);
        let (given_leaving, given_arriving) = match given.tangents {
            Tangents::Line => ([0; 3], [0; 3]),
            Tangents::Parabola(a) => (a, [0; 3]),
            Tangents::Cubic(a, b) => (a, b),
        };
        let mut leaving = leaving_as_arrived;
        let mut a = [0; 3];
        if !line {
            a = code(
                coder,
                &mut self.leaving,
                given_leaving,
                lattice.tangent_code(&leaving),
            )?;
            leaving = lattice.tangent(&a);
        }
        let promised = self.promised_key(lattice, state, &leaving);
        let key = code(coder, &mut self.key[usize::from(line)], given.key, promised)?;
        let end = lattice.key_point(&key, Some(&state.point));
        let chord = lattice.kind.local(&state.point, &end).xyz();
        let tangents = if line {
            Tangents::Line
        } else if parabola {
            Tangents::Parabola(a)
        } else {
            let as_parabola = lattice.tangent_code(&(leaving - chord * (2.0 / 3.0)));
            Tangents::Cubic(
                a,
                code(coder, &mut self.arriving, given_arriving, as_parabola)?,
            )
        };
        let (_, b) = tangents.resolve(lattice, &chord);
        *state = ChannelState {
            key,
            point: end,
            arrival: -b / f64::from(frames),
        };
        Ok(Piece {
            frames,
            key,
            tangents,
        })
    }

    /// The key that the tangent points to.
    fn promised_key(&self, lattice: &Lattice, state: &ChannelState, leaving: &Tangent) -> Code {
        let kind = lattice.kind;
        let ahead = state.point + kind.tangents(&state.point) * (leaving * REACH_OF_TANGENT);
        kind.finish(ahead)
            .map_or(state.key, |ahead| lattice.key_code(&ahead))
    }
}

/// Tangents may reach beyond keys, but not so far.
const MOST_CODE: u64 = 1 << 60;

/// Three numbers as differences from those promised.
fn code<C: Coder>(
    coder: &mut C,
    model: &mut Whole,
    given: Code,
    promised: Code,
) -> Result<Code, Fault> {
    let mut found = [0; 3];
    for axis in 0..3 {
        let promised = promised[axis].clamp(-MOST_STEPS, MOST_STEPS);
        found[axis] =
            promised.saturating_add(model.signed(coder, given[axis].saturating_sub(promised)));
        if found[axis].unsigned_abs() > MOST_CODE {
            return Err(Fault::Number);
        }
    }
    Ok(found)
}

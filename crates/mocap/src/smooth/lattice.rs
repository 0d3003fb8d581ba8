//! Rounds control points to whole steps before the fit is checked, so that the stored curve is the fitted one.
//!
//! A key of a rotation is kept as its modified Rodrigues parameters `v / (1 + w)`, three numbers of at most 1 that
//! need no square root's care anywhere (Schaub and Junkins, *Stereographic orientation parameters for attitude
//! dynamics*, 1996); which of q and −q is meant follows from the key before. Inner points are kept as tangents.

use super::bezier::{ChannelKind, ChannelValue, CurveSegment, Tangent};

/// Whole steps in three coordinates.
pub(super) type Code = [i64; 3];

/// Steps beyond this have lost their last binary digits.
pub(super) const MOST_STEPS: i64 = 1 << 48;

/// The size of a channel's steps, as the power of √2 that it is: one byte in a file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct StepSize(pub i8);

impl StepSize {
    /// The largest step that is no larger than `most`.
    pub fn at_most(most: f64) -> Self {
        let power = (2.0 * most.log2()).floor().clamp(-126.0, 126.0) as i8;
        // The logarithm is rounded: the power beside it may be the one.
        if Self(power).size() > most {
            Self(power - 1)
        } else {
            Self(power)
        }
    }

    /// Half of it; the smallest there is stays.
    pub fn halved(self) -> Self {
        Self(self.0.saturating_sub(2))
    }

    /// Its size, the same to the bit on every machine.
    pub fn size(self) -> f64 {
        let whole = i32::from(self.0).div_euclid(2);
        let root = if self.0.rem_euclid(2) == 1 {
            std::f64::consts::SQRT_2
        } else {
            1.0
        };
        f64::powi(2.0, whole) * root
    }
}

/// Rounding of a channel's control points.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Lattice {
    /// Kind of the values.
    pub kind: ChannelKind,
    pub key: StepSize,
    pub tangent: StepSize,
}

/// Tangents are rounded so much more coarsely than keys: they move a curve by at most 4/9 of themselves, and a turn
/// of a tangent by 1 turns the joint by 2 rad where a key's turns it by 4.
const TANGENT_ROTATION: f64 = 2.5;
const TANGENT_POSITION: f64 = 1.5;
/// Share of the threshold that rounding a key may take.
const KEY_SHARE: f64 = 0.4;

impl Lattice {
    /// Rounds so that a key is off by less than `KEY_SHARE` of `tolerance`: a chord between quaternions, or a
    /// distance.
    pub fn new(kind: ChannelKind, tolerance: f64) -> Self {
        // The corner of a step's cube lies √3/2 from its middle; at 0 the quaternion moves by twice the parameters.
        let (spread, ratio) = match kind {
            ChannelKind::Rotation => (3f64.sqrt(), TANGENT_ROTATION),
            ChannelKind::Position => (3f64.sqrt() / 2.0, TANGENT_POSITION),
        };
        let key = KEY_SHARE * tolerance / spread;
        Self {
            kind,
            key: StepSize::at_most(key),
            tangent: StepSize::at_most(key * ratio),
        }
    }

    /// Half the steps.
    pub fn finer(self) -> Self {
        Self {
            key: self.key.halved(),
            tangent: self.tangent.halved(),
            ..self
        }
    }

    /// The key nearest to `value`.
    pub fn key_code(&self, value: &ChannelValue) -> Code {
        let parameters = match self.kind {
            ChannelKind::Position => value.xyz(),
            ChannelKind::Rotation if value.w < 0.0 => -value.xyz() / (1.0 - value.w),
            ChannelKind::Rotation => value.xyz() / (1.0 + value.w),
        };
        rounded(&parameters, self.key)
    }

    /// The key of a code, on the side of `previous`. Any code gives a unit quaternion, or a finite position.
    pub fn key_point(&self, code: &Code, previous: Option<&ChannelValue>) -> ChannelValue {
        let parameters = vector(code, self.key);
        match self.kind {
            ChannelKind::Position => parameters.push(0.0),
            ChannelKind::Rotation => {
                let square = parameters.norm_squared();
                let q = (2.0 / (1.0 + square) * parameters).push((1.0 - square) / (1.0 + square));
                if previous.is_some_and(|p| p.dot(&q) < 0.0) {
                    -q
                } else {
                    q
                }
            }
        }
    }

    /// A tangent in whole steps.
    pub fn tangent_code(&self, tangent: &Tangent) -> Code {
        rounded(tangent, self.tangent)
    }

    /// The tangent that [`tangent_code`](Self::tangent_code) gave this code, to within half a step.
    pub fn tangent(&self, code: &Code) -> Tangent {
        vector(code, self.tangent)
    }
}

fn rounded(v: &Tangent, step: StepSize) -> Code {
    let size = step.size();
    // `as` keeps within i64 and makes 0 of what is no number.
    [
        (v.x / size).round() as i64,
        (v.y / size).round() as i64,
        (v.z / size).round() as i64,
    ]
}

fn vector(code: &Code, step: StepSize) -> Tangent {
    Tangent::new(code[0] as f64, code[1] as f64, code[2] as f64) * step.size()
}

/// A segment in whole steps.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Piece {
    /// Sample periods that it lasts, at least 1.
    pub frames: u32,
    /// The key it ends at.
    pub key: Code,
    /// In whole steps.
    pub tangents: Tangents,
}

/// The inner control points of a piece: "up to cubic" (thesis, §3.3).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Tangents {
    /// A straight line (an arc, nearly): both inner points lie on the chord.
    Line,
    /// A parabola: the second inner point follows from the first.
    Parabola(Code),
    /// A cubic: both inner points free.
    Cubic(Code, Code),
}

impl Tangents {
    /// Tangents `(P1 − P0, P2 − P3)` in the frames of their keys, where `chord` is P3's vector part seen from P0.
    pub fn resolve(&self, lattice: &Lattice, chord: &Tangent) -> (Tangent, Tangent) {
        match self {
            Tangents::Line => (chord / 3.0, -chord / 3.0),
            Tangents::Parabola(a) => {
                let a = lattice.tangent(a);
                (a, a - chord * (2.0 / 3.0))
            }
            Tangents::Cubic(a, b) => (lattice.tangent(a), lattice.tangent(b)),
        }
    }
}

impl Piece {
    /// The segment that begins with the key `p0` at sample `start`.
    pub fn segment(&self, lattice: &Lattice, start: u32, p0: ChannelValue) -> CurveSegment {
        let kind = lattice.kind;
        let p3 = lattice.key_point(&self.key, Some(&p0));
        let (a, b) = self.tangents.resolve(lattice, &kind.local(&p0, &p3).xyz());
        let p1 = p0 + kind.tangents(&p0) * a;
        let p2 = p3 + kind.tangents(&p3) * b;
        CurveSegment {
            start,
            frames: self.frames,
            points: [p0, p1, p2, p3],
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        /// Keys lie within their share of the threshold, and on the side of the key before.
        #[test]
        fn keys_are_near(
            q in [-1.0f64..1.0, -1.0..1.0, -1.0..1.0, -1.0..1.0], before in [-1.0f64..1.0, -1.0..1.0, -1.0..1.0, -1.0..1.0],
            tolerance in 1e-5f64..0.3,
        ) {
            let q = ChannelValue::from(q);
            prop_assume!(q.norm() > 0.1);
            let (q, before) = (q.normalize(), ChannelValue::from(before));
            let lattice = Lattice::new(ChannelKind::Rotation, tolerance);
            let key = lattice.key_point(&lattice.key_code(&q), Some(&before));
            prop_assert!(key.dot(&before) >= 0.0);
            prop_assert!((key - q).norm().min((key + q).norm()) <= KEY_SHARE * tolerance * 1.001);
            let lattice = Lattice::new(ChannelKind::Position, tolerance);
            let position = before.xyz().push(0.0);
            let key = lattice.key_point(&lattice.key_code(&position), None);
            prop_assert!((key - position).norm() <= KEY_SHARE * tolerance * 1.001);
        }

        #[test]
        fn any_code_is_a_rotation(code in any::<[i64; 3]>(), power in any::<i8>()) {
            let lattice = Lattice { kind: ChannelKind::Rotation, key: StepSize(power), tangent: StepSize(power) };
            let q = lattice.key_point(&code, None);
            prop_assert!((q.norm() - 1.0).abs() < 1e-9, "{}", q);
        }

        #[test]
        fn steps_are_the_largest_of_their_kind(most in 1e-15f64..1e15) {
            let step = StepSize::at_most(most);
            prop_assert!(step.size() <= most && most < StepSize(step.0 + 1).size() * 1.000001);
            prop_assert!((step.halved().size() * 2.0 / step.size() - 1.0).abs() < 1e-12);
        }
    }
}

//! Synthetic people: how they are built and how they move.

use super::timeline::LimbSide;
use crate::rng::Rng;

/// A person: lengths of the body, habits of posture and movement.
#[derive(Debug, Clone, PartialEq)]
pub struct Person {
    /// Name in labels and clip names.
    pub name: String,
    /// Standing height, metres.
    pub height_m: f64,
    /// Leg length over the average for the height.
    pub leg_ratio: f64,
    /// Arm length over the average for the height.
    pub arm_ratio: f64,
    /// Width of shoulders and hips over the average for the height.
    pub width_ratio: f64,
    /// How far the upper back is bent forward at rest, radians.
    pub stoop_rad: f64,
    /// Sideways lean at rest, radians.
    pub lean_rad: f64,
    /// Where the hands hang: outward, up, forward from the shoulder, in arm lengths.
    pub rest_hand: [f64; 3],
    /// How far the elbows are carried outward, radians.
    pub elbow_rad: f64,
    /// Half the distance between the feet over that between the hip joints.
    pub stance: f64,
    /// Speed of movement; 1 is average.
    pub tempo: f64,
    /// Size of movement; 1 is average.
    pub amplitude: f64,
    /// The hand that waves and points, the foot that kicks.
    pub hand: LimbSide,
    /// Size of the slow sway of body and hands; 1 is average.
    pub sway: f64,
    /// Deviation of the sensors' noise on every joint, radians.
    pub noise_rad: f64,
}

const NAMES: [&str; 12] = [
    "ada", "ben", "cleo", "dan", "eva", "finn", "gus", "hana", "ivo", "jo", "kim", "lea",
];

impl Person {
    /// Of average build and habits, without sway or noise.
    pub fn average() -> Self {
        Self {
            name: "average".to_owned(),
            height_m: 1.72,
            leg_ratio: 1.0,
            arm_ratio: 1.0,
            width_ratio: 1.0,
            stoop_rad: 0.08,
            lean_rad: 0.0,
            rest_hand: [0.12, -0.96, 0.08],
            elbow_rad: 0.0,
            stance: 1.1,
            tempo: 1.0,
            amplitude: 1.0,
            hand: LimbSide::Right,
            sway: 0.0,
            noise_rad: 0.0,
        }
    }

    /// Person number `number` of those that `seed` makes; 1.45 to 1.95 m tall, one in eight left-handed.
    pub fn draw(seed: u64, number: usize) -> Self {
        let mut rng = Rng::for_part(seed, 0x9e50 + number as u64);
        let round = number / NAMES.len();
        let name = NAMES[number % NAMES.len()];
        Self {
            name: if round == 0 {
                name.to_owned()
            } else {
                format!("{name}{}", round + 1)
            },
            height_m: (1.70 + 0.10 * rng.normal()).clamp(1.45, 1.95),
            leg_ratio: 1.0 + 0.025 * rng.normal(),
            arm_ratio: 1.0 + 0.03 * rng.normal(),
            width_ratio: 1.0 + 0.06 * rng.normal(),
            stoop_rad: rng.range(0.0, 0.22),
            lean_rad: 0.02 * rng.normal(),
            rest_hand: [
                rng.range(0.06, 0.24),
                rng.range(-0.975, -0.925),
                rng.range(0.02, 0.17),
            ],
            elbow_rad: rng.range(-0.3, 0.2),
            stance: rng.range(0.9, 1.6),
            tempo: rng.range(0.8, 1.22),
            amplitude: rng.range(0.86, 1.08),
            hand: if rng.chance(0.125) {
                LimbSide::Left
            } else {
                LimbSide::Right
            },
            sway: rng.range(0.5, 1.6),
            noise_rad: rng.range(0.001, 0.006),
        }
    }

    /// The same person recorded without sway or noise: every channel is then an exactly smooth curve.
    pub fn noiseless(self) -> Self {
        Self {
            sway: 0.0,
            noise_rad: 0.0,
            ..self
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn people_differ_and_stay_themselves() {
        let people: Vec<Person> = (0..30).map(|n| Person::draw(5, n)).collect();
        for (n, person) in people.iter().enumerate() {
            assert_eq!(*person, Person::draw(5, n));
            assert!((1.45..=1.95).contains(&person.height_m));
            assert!(
                people[..n]
                    .iter()
                    .all(|p| p.name != person.name && p.height_m != person.height_m)
            );
        }
        assert_ne!(Person::draw(5, 0), Person::draw(6, 0));
    }
}

//! Proportions of people that distinguish human skeletons from others.
//!
//! Lengths of segments as shares of body height: Drillis and Contini, *Body Segment Parameters* (1966), as tabled by
//! Winter, *Biomechanics and Motor Control of Human Movement*, figure 4.1: thigh .245, shin .246, upper arm .186, forearm
//! .146, hip to shoulder .288, width of hips .191 and of shoulders .259 (the joints lie somewhat inside of these).

/// Thigh over shin.
pub const THIGH_TO_SHIN: f64 = 0.245 / 0.246;
/// Upper arm over forearm. Joints in skeletons are nearer to the middle of the arm than the table's.
pub const ARM_TO_FOREARM: f64 = 1.15;
/// Shoulder to wrist over hip to ankle.
pub const ARM_TO_LEG: f64 = 0.332 / 0.491;
/// Hips to shoulders over hip to ankle.
pub const TRUNK_TO_LEG: f64 = 0.288 / 0.491;
/// Between the hip joints over hip to ankle.
pub const BETWEEN_HIPS: f64 = 0.22;
/// Between the shoulder joints over shoulder to wrist.
pub const BETWEEN_SHOULDERS: f64 = 0.7;
/// Hip to ankle of an adult of 1.70 m, in metres.
pub const LEG: f64 = 0.83;
/// Wrist to the tip of the middle finger of an adult, in metres.
pub const HAND: f64 = 0.186;

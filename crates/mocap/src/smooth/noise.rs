//! Estimates the sensor noise of a clip.

use super::SmoothParams;
use crate::clip::Clip;
use crate::math::{Quat, Vec3, quantile, same_hemisphere};

/// What noise of variance 1 leaves in a squared fourth difference: the squares of 1 −4 6 −4 1 (Rice, *Bandwidth choice for nonparametric
/// regression*, 1984).
const NOISE_GAIN: f64 = 70.0;
/// Median of the squared length of three independent standard normal values, divided by 3.
const MEDIAN_OF_THREE: f64 = 0.789;
/// Thresholds in standard deviations of the noise. Of 2.5 to 5, this brought a swinging joint nearest to its motion without noise, at
/// noise of 0.1°, 0.3° and 1°: less keeps the noise, more lets curves leave the motion.
const THRESHOLD_DEVIATIONS: f64 = 3.5;
/// Of the joints that move, this share is at most as noisy as the threshold assumes.
const JOINT_SHARE: f64 = 0.75;

/// Standard deviations of the sensor noise of a clip, for each axis.
#[derive(Debug, Clone, Copy, PartialEq, Default, serde::Serialize)]
pub struct MeasuredNoise {
    /// Of a joint's rotation, radians; 0 if no joint turns.
    pub angle_rad: f64,
    /// Of a joint's position in its parent's frame, in the clip's unit of length; 0 if no joint moves.
    pub position: f64,
}

impl MeasuredNoise {
    /// Measures noise by the median squared fourth difference of each channel, in which motion of a few hertz vanishes; of all
    /// rotations, and of all positions, the third quartile counts. Slow drift is not seen. Clips of fewer than five
    /// frames have none. O(frames · joints).
    pub fn of(clip: &Clip) -> Self {
        let joints = clip.skeleton.len();
        let rotations = (0..joints).map(|joint| {
            let mut last = Quat::identity();
            let values = (0..clip.frames).map(|frame| {
                last = same_hemisphere(&last, clip.frame_rotations(frame)[joint]);
                // A small turn by an angle moves a unit quaternion by half of it.
                [2.0 * last.w, 2.0 * last.i, 2.0 * last.j, 2.0 * last.k]
            });
            deviation(&values.collect::<Vec<_>>())
        });
        let positions = clip.tracks.iter().map(|track| {
            let values = track.positions.iter().map(|p: &Vec3| [p.x, p.y, p.z, 0.0]);
            deviation(&values.collect::<Vec<_>>())
        });
        Self {
            angle_rad: third_quartile(rotations.collect()),
            position: third_quartile(positions.collect()),
        }
    }

    /// `params` with thresholds that smooth this noise away, but not below a tenth of a degree and half a millimetre.
    pub fn thresholds(&self, params: SmoothParams) -> SmoothParams {
        let position_metres = self.position * params.metres_per_unit;
        SmoothParams {
            angle_rad: (THRESHOLD_DEVIATIONS * self.angle_rad).clamp(0.1f64.to_radians(), 1.0),
            position_metres: (THRESHOLD_DEVIATIONS * position_metres).clamp(0.0005, 10.0),
            ..params
        }
    }
}

/// Standard deviation of the noise of each of three independent directions in which `values` move; 0 of fewer than five.
fn deviation(values: &[[f64; 4]]) -> f64 {
    let squared = |w: &[[f64; 4]]| -> f64 {
        let of_axis = |k: usize| w[0][k] - 4.0 * w[1][k] + 6.0 * w[2][k] - 4.0 * w[3][k] + w[4][k];
        (0..4).map(|k| of_axis(k).powi(2)).sum()
    };
    let median = quantile(values.windows(5).map(squared).collect(), 0.5);
    (median / NOISE_GAIN / 3.0 / MEDIAN_OF_THREE).sqrt()
}

/// The third quartile of the deviations that are not 0; 0 if all are.
fn third_quartile(mut deviations: Vec<f64>) -> f64 {
    deviations.retain(|deviation| *deviation > 0.0);
    quantile(deviations, JOINT_SHARE)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::smooth::compress;
    use crate::smooth::tests::one_joint;

    /// A swinging joint whose rotation has noise of this many degrees, and whose position has noise of 3 mm.
    fn noisy(degrees: f64) -> Clip {
        let mut state = 1u64;
        let mut uniform = move || {
            state = state
                .wrapping_mul(6364136223846793005)
                .wrapping_add(1442695040888963407);
            (state >> 11) as f64 / (1u64 << 53) as f64
        };
        // The sum of twelve uniform values, less its mean, is all but normal with variance 1.
        let mut normal = move || (0..12).map(|_| uniform()).sum::<f64>() - 6.0;
        let mut clip = one_joint(
            120.0,
            1200,
            |t| Quat::from_euler_angles((3.0 * t).sin(), 0.5 * t.cos(), 0.0),
            |t| Vec3::new(t.sin(), 0.9, t),
        );
        for rotation in &mut clip.rotations {
            let jitter = Vec3::new(normal(), normal(), normal()) * degrees.to_radians();
            *rotation *= Quat::from_scaled_axis(jitter);
        }
        for place in &mut clip.tracks[0].positions {
            *place += Vec3::new(normal(), normal(), normal()) * 0.003;
        }
        clip
    }

    #[test]
    fn noise_is_measured_whatever_the_motion() {
        for degrees in [0.1, 0.3, 1.0] {
            let noise = MeasuredNoise::of(&noisy(degrees));
            let found = noise.angle_rad.to_degrees();
            assert!((found / degrees - 1.0).abs() < 0.1, "{found} for {degrees}");
            assert!((noise.position / 0.003 - 1.0).abs() < 0.1, "{noise:?}");
        }
        assert!(MeasuredNoise::of(&noisy(0.0)).angle_rad < 1e-4);
    }

    #[test]
    fn thresholds_of_the_noise_bring_the_motion_back() {
        let (clean, noisy) = (noisy(0.0), noisy(1.0));
        let params = MeasuredNoise::of(&noisy).thresholds(SmoothParams::default());
        let smoothed = compress(&noisy, &params, &())
            .unwrap()
            .sample(120.0)
            .unwrap();
        let rms = |clip: &Clip| {
            let pairs = clip.rotations.iter().zip(&clean.rotations);
            let sum: f64 = pairs.map(|(a, b)| a.angle_to(b).powi(2)).sum();
            (sum / clean.frames as f64).sqrt()
        };
        let (before, after) = (rms(&noisy), rms(&smoothed));
        assert!(after < 0.75 * before, "{after} of {before}");
    }
}

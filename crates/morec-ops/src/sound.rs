//! The sound of a file as its envelope, and the offset of a video from a clap: the program `ffmpeg` decodes.

use std::io::Read;
use std::path::Path;
use std::process::{Command, Stdio};

use morec::clip::Clip;
use morec::kinematics::WorldPose;
use morec::progress::Progress;
use morec::roles::{Role, RoleMap};

/// Samples a second that are decoded, and values of the envelope a second.
const SAMPLES_HZ: usize = 8000;
const ENVELOPE_HZ: usize = 200;
/// Longest sound that is read, seconds.
const LONGEST_SECS: usize = 24 * 3600;
/// An onset is louder than the mean of this time before it, seconds.
const BEFORE_ONSET_SECS: f64 = 0.05;
/// Hands meet where they are nearest for this time before and after, seconds, and come nearer by this much in the time before, metres.
const MEETING_SECS: f64 = 0.25;
const LEAST_APPROACH: f64 = 0.1;
/// Meetings whose distances differ by less are as near as each other, metres: the faster approach is the clap.
const AS_NEAR: f64 = 0.05;

/// How loud a sound is over time.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct SoundEnvelope {
    /// The largest amplitude in each step of time, 0 to 1.
    pub peaks: Vec<f32>,
}

impl SoundEnvelope {
    /// Values a second.
    pub const HZ: f64 = ENVELOPE_HZ as f64;

    /// Decodes the sound of a video or sound file by `program`, which is `ffmpeg`. A silent stretch before the sound begins is kept, so
    /// that times are those of the video. Costs about a second for twenty minutes of a compressed video.
    ///
    /// # Errors
    /// A sentence: the file is not there or has no sound, the program is not installed or failed, or `progress` asked to stop.
    pub fn of_file(program: &Path, file: &Path, progress: &dyn Progress) -> Result<Self, String> {
        let name = file.display();
        let file = file
            .canonicalize()
            .map_err(|why| format!("{name}: {why}"))?;
        // A name is never taken for an address on the net.
        let mut input = std::ffi::OsString::from("file:");
        input.push(file);
        let filter = format!("aresample={SAMPLES_HZ}:async=1:first_pts=0");
        let mut decoder = Command::new(program)
            .args([
                "-v",
                "error",
                "-nostdin",
                "-protocol_whitelist",
                "file,pipe",
                "-i",
            ])
            .arg(input)
            .args(["-vn", "-ac", "1", "-af", &filter, "-f", "s16le", "-"])
            .stdin(Stdio::null())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .map_err(|why| match why.kind() {
                std::io::ErrorKind::NotFound => {
                    "ffmpeg is not installed: it reads the sound of videos (https://ffmpeg.org)"
                        .to_owned()
                }
                _ => format!("{}: {why}", program.display()),
            })?;
        let said = decoder.stderr.take().map(|errors| {
            std::thread::spawn(move || {
                let mut text = Vec::new();
                let mut errors = errors;
                // What is not kept is read all the same: the program would wait for a reader.
                let _ = errors.by_ref().take(4096).read_to_end(&mut text);
                let _ = std::io::copy(&mut errors, &mut std::io::sink());
                String::from_utf8_lossy(&text).trim().to_owned()
            })
        });
        let read = match decoder.stdout.take() {
            Some(samples) => Self::of_samples(samples, progress),
            None => Ok(Self::default()),
        };
        // Of what was not read to its end, and of what has ended by itself.
        let _ = decoder.kill();
        let _ = decoder.wait();
        let said = said.and_then(|said| said.join().ok()).unwrap_or_default();
        let envelope = read.map_err(|why| format!("{name}: {why}"))?;
        match (envelope.peaks.is_empty(), said.lines().last()) {
            (false, _) => Ok(envelope),
            (true, None) => Err(format!("{name}: no sound")),
            (true, Some(last)) => Err(format!("{name}: no sound: {last}")),
        }
    }

    /// Of samples of 16 bits, little-endian, one channel.
    fn of_samples(mut samples: impl Read, progress: &dyn Progress) -> Result<Self, String> {
        let mut second = Vec::with_capacity(2 * SAMPLES_HZ);
        let mut peaks = Vec::new();
        for secs in 0..LONGEST_SECS {
            progress.report("seconds of sound", secs, 0);
            if progress.cancelled() {
                return Err("stopped".to_owned());
            }
            second.clear();
            let mut part = samples.by_ref().take(2 * SAMPLES_HZ as u64);
            part.read_to_end(&mut second)
                .map_err(|why| why.to_string())?;
            let steps = second.chunks(2 * SAMPLES_HZ / ENVELOPE_HZ);
            peaks.extend(steps.map(|step| {
                let samples = step.chunks_exact(2);
                let sizes = samples.map(|s| i16::from_le_bytes([s[0], s[1]]).unsigned_abs());
                f32::from(sizes.max().unwrap_or(0)) / 32768.0
            }));
            if second.len() < 2 * SAMPLES_HZ {
                break;
            }
        }
        Ok(Self { peaks })
    }

    /// The moment at which the sound rises most above what was before, seconds; `None` of silence. O(length).
    pub fn loudest_onset(&self) -> Option<f64> {
        let before = (BEFORE_ONSET_SECS * Self::HZ) as usize;
        let rise = |at: usize| {
            let mean = self.peaks[at - before..at].iter().sum::<f32>() / before as f32;
            (self.peaks[at] - mean, at)
        };
        let rises = (before..self.peaks.len()).map(rise);
        let (rise, at) = rises.max_by(|a, b| a.0.total_cmp(&b.0))?;
        (rise > 0.0).then(|| at as f64 / Self::HZ)
    }
}

/// A clap that was seen and heard.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ClapMatch {
    /// Time of the clip at which the hands meet, seconds.
    pub hands_secs: f64,
    /// Time of the sound at which it rises most, seconds.
    pub sound_secs: f64,
}

impl ClapMatch {
    /// Matches the loudest onset of a sound with the moment at which the hands of a clip meet.
    ///
    /// # Errors
    /// A sentence: the sound is silent, the wrists are not known, or the hands never meet.
    pub fn of(sound: &SoundEnvelope, clip: &Clip, roles: &RoleMap) -> Result<Self, String> {
        let sound_secs = sound.loudest_onset().ok_or("the sound is silent")?;
        let hands_secs = hands_meet(clip, roles)?;
        Ok(Self {
            hands_secs,
            sound_secs,
        })
    }

    /// Time of the video at which the clip begins, seconds.
    pub fn offset_secs(&self) -> f64 {
        self.sound_secs - self.hands_secs
    }
}

/// The moment at which the wrists are nearest after they approached each other, seconds of the clip. O(joints · frames).
fn hands_meet(clip: &Clip, roles: &RoleMap) -> Result<f64, String> {
    let wrists = roles
        .joint(Role::LeftHand)
        .zip(roles.joint(Role::RightHand));
    let (left, right) = wrists.ok_or("the clip does not have both hands")?;
    let mut pose = WorldPose::default();
    let distance = |frame| {
        pose.set(clip, frame);
        (pose.positions[left] - pose.positions[right]).norm()
    };
    let distances: Vec<f64> = (0..clip.frames).map(distance).collect();
    let around = ((MEETING_SECS * clip.rate_hz).ceil() as usize).max(1);
    let approach = |at: usize| {
        let before = &distances[at.saturating_sub(around)..at];
        before.iter().copied().fold(f64::NEG_INFINITY, f64::max) - distances[at]
    };
    let is_meeting = |at: &usize| {
        let near = &distances[at.saturating_sub(around)..(at + around + 1).min(distances.len())];
        approach(*at) >= LEAST_APPROACH && near.iter().all(|other| distances[*at] <= *other)
    };
    let meetings: Vec<usize> = (1..distances.len()).filter(is_meeting).collect();
    let least = meetings.iter().map(|at| distances[*at]);
    let least = least.fold(f64::INFINITY, f64::min);
    let nearest = meetings
        .into_iter()
        .filter(|at| distances[*at] < least + AS_NEAR);
    let clap = nearest.max_by(|a, b| approach(*a).total_cmp(&approach(*b)));
    let clap = clap.ok_or("the hands never meet in the clip")?;
    Ok(clap as f64 / clip.rate_hz)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Samples of a hum with bursts at these times, seconds.
    fn samples(secs: f64, bursts: &[(f64, f64)]) -> Vec<u8> {
        let sample = |n: usize| {
            let at = n as f64 / SAMPLES_HZ as f64;
            let hum = 0.05 * (at * 700.0).sin();
            let burst = bursts.iter().map(|(from, size)| match at - from {
                since if since >= 0.0 => size * (-since * 40.0).exp() * (since * 9000.0).cos(),
                _ => 0.0,
            });
            let value = hum + burst.sum::<f64>();
            ((value * 32767.0) as i16).to_le_bytes()
        };
        (0..(secs * SAMPLES_HZ as f64) as usize)
            .flat_map(sample)
            .collect()
    }

    /// Two wrists whose distance is `of` the time, metres, 60 frames a second.
    fn wrists(secs: f64, of: impl Fn(f64) -> f64) -> (Clip, RoleMap) {
        use morec::clip::Points;
        use morec::math::Vec3;
        let frames = (secs * 60.0) as usize;
        let points = [("left", 0.5), ("right", -0.5)].map(|(name, side)| {
            let place = |frame| Vec3::new(side * of(frame as f64 / 60.0), 1.0, 0.0);
            (name.to_owned(), (0..frames).map(place).collect())
        });
        let clip = Clip::of_points("wrists".to_owned(), 60.0, points, Points::default());
        let mut roles = RoleMap::default();
        roles.set(Role::LeftHand, Some(0));
        roles.set(Role::RightHand, Some(1));
        (clip, roles)
    }

    #[test]
    fn a_clap_is_where_hands_meet_fast_and_not_where_they_are_folded() {
        let clap = |at: f64| 0.06 + 0.8 * (2.5 * (at - 3.0).abs()).min(1.0);
        // Folded slowly later, and nearer than by the clap.
        let folded = |at: f64| 0.04 + 0.25 * (at - 6.0).abs();
        let (clip, roles) = wrists(8.0, |at| clap(at).min(folded(at)));
        let sound = SoundEnvelope::of_samples(&samples(9.0, &[(4.25, 0.8)])[..], &()).unwrap();
        let found = ClapMatch::of(&sound, &clip, &roles).unwrap();
        assert_eq!(found.hands_secs, 3.0);
        assert!((found.offset_secs() - 1.25).abs() < 0.011, "{found:?}");
        let (apart, _) = wrists(8.0, |_| 0.6);
        let error = ClapMatch::of(&sound, &apart, &roles).unwrap_err();
        assert!(error.contains("never meet"), "{error}");
        let error = ClapMatch::of(&sound, &clip, &RoleMap::default()).unwrap_err();
        assert!(error.contains("both hands"), "{error}");
        let error = ClapMatch::of(&SoundEnvelope::default(), &clip, &roles).unwrap_err();
        assert!(error.contains("silent"), "{error}");
    }

    #[test]
    fn a_synthetic_clap_is_found_within_its_label() {
        use morec::synth::{DatabaseSpec, database};
        let spec = DatabaseSpec {
            people: 6,
            repetitions: 1,
            classes: vec!["wave", "clap", "bow"],
            ..DatabaseSpec::default()
        };
        for take in database(3, &spec) {
            let roles = RoleMap::find(&take.clip.skeleton);
            let at = hands_meet(&take.clip, &roles).unwrap();
            let clap = take
                .labels
                .iter()
                .find(|label| label.class == "clap")
                .unwrap();
            assert!(
                (clap.span.start_secs..clap.span.stop_secs).contains(&at),
                "{at} {clap:?}"
            );
        }
    }

    #[test]
    fn the_loudest_onset_is_the_burst_and_no_slow_swell() {
        let bytes = samples(4.0, &[(1.0, 0.3), (2.5, 0.7)]);
        let envelope = SoundEnvelope::of_samples(bytes.as_slice(), &()).unwrap();
        assert_eq!(envelope.peaks.len(), 800);
        let onset = envelope.loudest_onset().unwrap();
        assert!((onset - 2.5).abs() < 0.011, "{onset}");
        assert_eq!(SoundEnvelope::default().loudest_onset(), None);
    }
}

//! The result: sets, their instances, and the stretches in no set.

use std::collections::BTreeSet;

use crate::TimeSpan;

/// Instances of a set in a clip are one run if they are less than this share of a length apart.
const RUN_GAP: f64 = 0.35;

/// One time that a motion is done.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
pub struct SetInstance {
    /// Number of the clip, in the order in which they were given.
    pub clip: usize,
    /// When.
    #[serde(flatten)]
    pub span: TimeSpan,
    /// How far it is from the middle of its set: mean elastic distance over spread; outermost members are the doubtful ones.
    pub distance: f64,
}

/// Instances of one motion.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct RepetitionSet {
    /// By clip and time. Two or more.
    pub instances: Vec<SetInstance>,
    /// Seconds of moving beyond the longest instance: what a description of one instance explains of the others.
    pub explained_secs: f64,
}

/// A stretch that no set explains.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
pub struct LoneStretch {
    /// Number of the clip.
    pub clip: usize,
    /// When.
    #[serde(flatten)]
    pub span: TimeSpan,
    /// The set that it is nearest to, and its distance, if any is near.
    pub nearest: Option<(usize, f64)>,
}

/// Result of a discovery.
#[derive(Debug, Clone, PartialEq, Default, serde::Serialize)]
pub struct Discovery {
    /// Sets by what they explain, the greatest first.
    pub sets: Vec<RepetitionSet>,
    /// What was seen once, by clip and time.
    pub alone: Vec<LoneStretch>,
    /// Time weighted by how fast it is, in all clips.
    pub moving_secs: f64,
    /// That of the sets' instances.
    pub moving_in_sets_secs: f64,
}

impl Discovery {
    /// Share of the motion that lies in sets, 0 to 1.
    pub fn share_in_sets(&self) -> f64 {
        match self.moving_secs > 0.0 {
            true => (self.moving_in_sets_secs / self.moving_secs).min(1.0),
            false => 0.0,
        }
    }

    /// Moments at which a clip is cut: where instances begin and end, in order, its own ends left out.
    pub fn cuts_of(&self, clip: usize, duration_secs: f64) -> Vec<f64> {
        let instances = self.sets.iter().flat_map(|set| &set.instances);
        let of_clip = instances.filter(|instance| instance.clip == clip);
        let mut cuts: Vec<f64> = of_clip
            .flat_map(|i| [i.span.start_secs, i.span.stop_secs])
            .collect();
        cuts.retain(|&cut| cut > 0.0 && cut < duration_secs);
        cuts.sort_by(f64::total_cmp);
        cuts.dedup();
        cuts
    }
}

impl RepetitionSet {
    /// Number of clips in which the motion is done.
    pub fn clips(&self) -> usize {
        let clips: BTreeSet<usize> = self.instances.iter().map(|i| i.clip).collect();
        clips.len()
    }

    /// Median length.
    pub fn length_secs(&self) -> f64 {
        median_of(
            self.instances
                .iter()
                .map(|i| i.span.duration_secs())
                .collect(),
        )
    }

    /// Runs in place of instances: such as follow each other at once, joined.
    pub fn runs(&self) -> Vec<SetInstance> {
        let gap = RUN_GAP * self.length_secs();
        let mut runs: Vec<SetInstance> = Vec::new();
        for &instance in &self.instances {
            match runs.last_mut() {
                Some(last)
                    if last.clip == instance.clip
                        && instance.span.start_secs - last.span.stop_secs <= gap =>
                {
                    last.span.stop_secs = last.span.stop_secs.max(instance.span.stop_secs);
                    last.distance = last.distance.max(instance.distance);
                }
                _ => runs.push(instance),
            }
        }
        runs
    }
}

/// The middle value; the mean of the middle two where their number is even.
pub(super) fn median_of(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    let n = values.len();
    match n {
        0 => 0.0,
        _ => 0.5 * (values[(n - 1) / 2] + values[n / 2]),
    }
}

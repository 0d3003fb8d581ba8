//! Labels of whole clips, reduced to their moving part, as training does.

use morec::TimeSpan;
use morec::features::{FeatureParams, bones_of_clip, rows_of_clip};
use morec::labels::Sample;
use morec::train::{TrainClip, motion_span};

/// The part of a clip that a label of all of it teaches: from the first to the last movement, seconds. O(frames · joints).
pub fn taught_span(clip: &TrainClip) -> TimeSpan {
    let params = FeatureParams::default();
    let bones = bones_of_clip(&clip.clip, &clip.roles, &clip.rest);
    let rows = rows_of_clip(&clip.clip, &clip.roles, &clip.rest, bones, &params);
    let taught = TimeSpan::of_frames(motion_span(&rows, bones), params.tick_hz());
    match taught.is_stretch() {
        true => taught,
        false => TimeSpan::new(0.0, clip.clip.duration_secs()),
    }
}

/// The stretch of `sample`, which lies in `clip`, that teaches.
pub(super) fn taught_part(sample: &Sample, clip: &TrainClip) -> TimeSpan {
    match sample.whole_clip {
        true => taught_span(clip),
        false => sample.span,
    }
}

/// Gives `samples` of whole clips the stretches of `clips` that they teach; returns how many changed. A recogniser that was taught
/// without the still ends cannot find them.
pub fn measure_as_taught(samples: &mut [Sample], clips: &[TrainClip]) -> usize {
    let mut changed = 0;
    for sample in samples.iter_mut().filter(|s| s.whole_clip) {
        let Some(clip) = clips.iter().find(|clip| clip.name == sample.clip) else {
            continue;
        };
        let taught = taught_span(clip);
        changed += usize::from(taught != sample.span);
        sample.span = taught;
    }
    changed
}

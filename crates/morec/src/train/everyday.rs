//! Built-in everyday motion for training: synthetic and recorded.

use rayon::prelude::*;

use crate::clip::Clip;
use crate::formats::{Limits, mclip};
use crate::import::Take;
use crate::roles::RoleMap;
use crate::synth;

use super::from_clips::TrainClip;
use super::options::EVERYDAY_SEED;
use super::set::StreamKind;

/// Names and bytes of the real clips. Their credit and terms are in `everyday/CREDITS.md`.
macro_rules! built_in {
    ($($name:literal)*) => {
        [$(($name, include_bytes!(concat!("../../everyday/", $name, ".mclip")).as_slice())),*]
    };
}

const REAL: [(&str, &[u8]); 24] = built_in!(
    "cmu_01_08" "cmu_01_14" "cmu_02_03" "cmu_02_04" "cmu_02_05" "cmu_02_07" "cmu_02_10" "cmu_03_01"
    "cmu_03_03" "cmu_05_02" "cmu_05_06" "cmu_05_13" "cmu_05_18" "cmu_06_02" "cmu_06_07" "cmu_06_12"
    "cmu_07_01" "cmu_07_05" "cmu_07_12" "cmu_backflip" "cmu_charleston1" "cmu_lambada"
    "cmu_pirouette" "cmu_zombie"
);

/// The clips of [`synth::everyday`].
pub fn everyday_clips() -> Vec<TrainClip> {
    let made = synth::everyday(EVERYDAY_SEED).into_iter();
    made.map(synthetic).collect()
}

/// Those of [`synth::everyday_gestures`], and the real ones: see [`TrainSet::everyday`](super::set::TrainSet::everyday).
pub fn second_look_clips() -> Vec<TrainClip> {
    let made = synth::everyday_gestures(EVERYDAY_SEED).into_iter();
    let real: Vec<TrainClip> = REAL.par_iter().filter_map(real).collect();
    made.map(synthetic).chain(real).collect()
}

/// True of the name of a real clip of the everyday motion that is built in.
pub fn is_built_in(name: &str) -> bool {
    REAL.iter().any(|(real, _)| *real == name)
}

fn synthetic(clip: Clip) -> TrainClip {
    TrainClip {
        name: clip.name.clone(),
        roles: RoleMap::find(&clip.skeleton),
        rest: 0..0,
        source: StreamKind::Everyday,
        person: None,
        clip,
    }
}

/// A clip that is built in; all of them can be read, as a test sees.
fn real((name, bytes): &(&str, &[u8])) -> Option<TrainClip> {
    let clip = mclip::read(bytes, name, &Limits::default())
        .ok()?
        .clips
        .pop()?;
    Some(TrainClip {
        source: StreamKind::Everyday,
        ..Take::new(clip).ok()?.into()
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::features::{BoneSet, bones_of_clip};

    #[test]
    fn real_clips_are_read_and_show_whole_bodies() {
        let clips: Vec<TrainClip> = REAL.iter().filter_map(real).collect();
        assert_eq!(clips.len(), REAL.len());
        for clip in &clips {
            let bones = bones_of_clip(&clip.clip, &clip.roles, &clip.rest);
            assert_eq!(bones, BoneSet::BODY, "{}", clip.name);
        }
        let secs: f64 = clips.iter().map(|c| c.clip.duration_secs()).sum();
        assert!(secs > 240.0, "{secs} s");
    }
}

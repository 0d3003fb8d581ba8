//! Synthetic people performing labelled gestures, for tests, examples and first trials.

use morec::import::Take;
use morec::synth::{self, DatabaseSpec, MotionKind, database, everyday, motions_of};
use pyo3::prelude::*;

use crate::clip::PyClip;
use crate::clip_data::ClipData;
use crate::errors::{morec_error, value_error};

type LabelTuple = (&'static str, f64, f64);

fn ready(clip: morec::clip::Clip) -> PyResult<PyClip> {
    let take = Take::new(clip).map_err(morec_error)?;
    Ok(ClipData::from(take).into())
}

/// For each clip the labels (class, start and stop in seconds) and the person.
#[pyfunction]
#[pyo3(signature = (seed, people, streams, repetitions, classes, unknown_share, left_handed, rate_hz))]
#[allow(clippy::too_many_arguments)] // Keyword arguments of one Python function.
pub fn synth_database(
    py: Python<'_>,
    seed: u64,
    people: usize,
    streams: usize,
    repetitions: usize,
    classes: Option<Vec<String>>,
    unknown_share: f64,
    left_handed: bool,
    rate_hz: f64,
) -> PyResult<Vec<(PyClip, Vec<LabelTuple>, String)>> {
    let mut spec = DatabaseSpec {
        people,
        streams,
        repetitions,
        unknown_share,
        left_handed,
        rate_hz,
        ..DatabaseSpec::default()
    };
    if let Some(names) = classes {
        let gesture = |name: &String| {
            let known = motions_of(MotionKind::Gesture)
                .map(|m| m.name())
                .find(|n| n == name);
            known.ok_or_else(|| {
                let known: Vec<_> = motions_of(MotionKind::Gesture).map(|m| m.name()).collect();
                value_error(format!(
                    "no gesture is called {name:?}; the gestures are {}",
                    known.join(", ")
                ))
            })
        };
        spec.classes = names.iter().map(gesture).collect::<PyResult<_>>()?;
    }
    let takes = py.detach(|| database(seed, &spec));
    let told = |take: synth::SyntheticTake| {
        let labels = take
            .labels
            .iter()
            .map(|l| (l.class, l.span.start_secs, l.span.stop_secs));
        Ok((ready(take.clip)?, labels.collect(), take.person))
    };
    takes.into_iter().map(told).collect()
}

/// The first `clips` clips of everyday motion, which holds no gesture.
#[pyfunction]
pub fn synth_everyday(py: Python<'_>, seed: u64, clips: usize) -> PyResult<Vec<PyClip>> {
    let made = py.detach(|| everyday(seed));
    made.into_iter().take(clips).map(ready).collect()
}

/// Names of the gestures.
#[pyfunction]
pub fn synth_motions() -> Vec<&'static str> {
    motions_of(MotionKind::Gesture)
        .map(|motion| motion.name())
        .collect()
}

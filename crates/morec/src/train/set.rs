//! The training set: streams of feature rows and their labels.

use std::ops::Range;

use crate::classes::ClassId;
use crate::features::Rows;

/// Origin of a training stream, and so how far its unlabelled parts may be trusted to hold no class.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum StreamKind {
    /// A clip with labels.
    Labelled,
    /// A clip that the user says holds none of the classes.
    Background,
    /// Everyday motion made by [`synth`](crate::synth).
    Everyday,
}

/// A stretch of a stream, in ticks.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct LabelledSpan {
    /// Ticks from start to stop, the stop not included.
    pub ticks: Range<usize>,
    /// The class it shows; `None` for a stretch that must be used for nothing (a sample held back for testing,
    /// a label outside the chosen classes).
    pub class: Option<ClassId>,
}

/// One clip's rows and what is known about them.
#[derive(Debug, Clone)]
pub struct TrainStream {
    /// The clip's name.
    pub name: String,
    /// The person who moves; the clip's name if nobody is named, so that clips then count as people.
    pub group: String,
    /// The person who moves, if named.
    pub person: Option<String>,
    /// Origin of the stream.
    pub source: StreamKind,
    /// True if what is not in `known` holds none of the classes.
    pub rest_is_background: bool,
    /// True if it was made from another stream: it teaches, but it is no sample that somebody showed.
    pub is_copy: bool,
    /// One row for each tick.
    pub rows: Rows,
    /// Labelled stretches, in order of their starts.
    pub known: Vec<LabelledSpan>,
}

impl TrainStream {
    /// True if `ticks` shares more than `share` of the shorter of the two with any known stretch.
    pub fn overlaps_known(&self, ticks: &Range<usize>, share: f64) -> bool {
        self.known
            .iter()
            .any(|k| overlap_share(ticks, &k.ticks) > share)
    }

    /// What lies between the known stretches, of `least` ticks and more.
    pub fn unknown(&self, least: usize) -> Vec<Range<usize>> {
        let len = self.rows.len();
        let mut parts = Vec::new();
        let mut free = 0;
        let known = self.known.iter().map(|known| known.ticks.clone());
        for ticks in known.chain(std::iter::once(len..len)) {
            let stop = ticks.start.min(len);
            if stop >= free + least {
                parts.push(free..stop);
            }
            free = free.max(ticks.end.min(len));
        }
        parts
    }
}

/// A labelled sample cut out of its stream.
#[derive(Debug, Clone)]
pub struct TrainSample {
    /// Number of the class.
    pub class: ClassId,
    /// The person who shows it: see [`TrainStream::group`].
    pub group: String,
    /// Its stream's place in the set.
    pub stream: usize,
    /// Ticks of the stream.
    pub ticks: Range<usize>,
    /// Those rows.
    pub rows: Rows,
    /// True for a faster copy, whose rows are not those of its ticks.
    pub is_faster: bool,
}

/// Everything to train from.
#[derive(Debug, Clone, Default)]
pub struct TrainSet {
    /// Names of the classes; a [`ClassId`] is an index into this.
    pub classes: Vec<String>,
    /// Labelled clips and background.
    pub streams: Vec<TrainStream>,
    /// Everyday gestures, and real everyday motion, for the second look alone: as background of a verifier they lower the score that is
    /// asked for, because little of them comes near the classes.
    pub everyday: Vec<TrainStream>,
}

/// A sample shorter than this many ticks is lengthened to it: three rows are no motion.
pub const MIN_SAMPLE_TICKS: usize = 4;

impl TrainSet {
    /// Every labelled sample, in order of streams and of time; those that do not fit their stream are left out.
    pub fn samples(&self) -> Vec<TrainSample> {
        let mut samples = Vec::new();
        for (index, stream) in self.streams.iter().enumerate() {
            for known in &stream.known {
                let Some(class) = known.class else { continue };
                let stop = known
                    .ticks
                    .end
                    .max(known.ticks.start + MIN_SAMPLE_TICKS)
                    .min(stream.rows.len());
                if known.ticks.start + MIN_SAMPLE_TICKS <= stop {
                    let ticks = known.ticks.start..stop;
                    let rows = stream.rows.slice(ticks.clone());
                    samples.push(TrainSample {
                        class,
                        group: stream.group.clone(),
                        stream: index,
                        ticks,
                        rows,
                        is_faster: false,
                    });
                }
            }
        }
        samples
    }

    /// The parts of `least` ticks and more that hold none of the classes, in ticks of their streams.
    pub fn background(&self, least: usize) -> impl Iterator<Item = (Range<usize>, &TrainStream)> {
        let streams = self.streams.iter().filter(|s| s.rest_is_background);
        streams.flat_map(move |stream| {
            let unknown = stream.unknown(least).into_iter();
            unknown.map(move |ticks| (ticks, stream))
        })
    }
}

/// At most `most` of `all`, evenly spaced.
pub fn evenly<T>(all: &[T], most: usize) -> impl Iterator<Item = &T> {
    let count = all.len().min(most);
    (0..count).map(move |i| &all[i * all.len() / count])
}

/// Ticks in both ranges.
pub fn overlap(a: &Range<usize>, b: &Range<usize>) -> usize {
    a.end.min(b.end).saturating_sub(a.start.max(b.start))
}

/// Overlap as a share of the shorter range; 0 if either is empty.
pub fn overlap_share(a: &Range<usize>, b: &Range<usize>) -> f64 {
    let shorter = a.len().min(b.len());
    if shorter == 0 {
        0.0
    } else {
        overlap(a, b) as f64 / shorter as f64
    }
}

//! The stages between chunks and detections (thesis, §4.6.3–4.6.5), each the body of a thread: it ends when what it
//! takes from has ended, and its going ends the next.

use crate::live::MAX_PERFORMERS;
use crate::svrdm::{
    Cell, FeatureExtraction, Gram, RowRing, SegmentAssembly, SegmentScoring, SvrdmModel,
};

use super::belt::{RingReceiver, RingSender};
use super::message::{Chunk, MessageStamp, Of, StageMessage, What};

/// Segment assembly's ends of the belts.
pub(super) struct Segments {
    pub(super) chunks: RingReceiver<Chunk>,
    pub(super) used: RingSender<Chunk>,
    pub(super) out: RingSender<StageMessage>,
    pub(super) spare: RingReceiver<StageMessage>,
}

impl Segments {
    /// Sends what `fill` makes of a spare message.
    fn send(&mut self, mark: MessageStamp, what: What, fill: impl FnOnce(&mut StageMessage)) {
        if let Some(mut message) = self.spare.next() {
            (message.mark, message.what) = (mark, what);
            fill(&mut message);
            self.out.send(message);
        }
    }

    /// Chunks in, segments out.
    pub(super) fn run(mut self, model: &SvrdmModel) {
        let mut assemblies: Vec<_> = (0..MAX_PERFORMERS)
            .map(|_| SegmentAssembly::new(&model.params, model.pca.dims()))
            .collect();
        while let Some(mut chunk) = self.chunks.next() {
            let (mark, assembly) = (chunk.mark, &mut assemblies[chunk.mark.actor]);
            match chunk.of {
                Of::Chunk => {
                    self.send(mark, What::Rows, |message| {
                        std::mem::swap(&mut message.rows, &mut chunk.rows)
                    });
                    assembly.push(&chunk.gram, &mut |window, gram: &Gram| {
                        self.send(mark, What::Segment(window), |message| {
                            message.gram.copy_from(gram)
                        });
                    });
                    self.send(mark, What::Column, |_| ());
                }
                Of::End(end) => {
                    assembly.reset();
                    self.send(mark, What::End(end), |_| ());
                }
                Of::Frame { time_secs } => self.send(mark, What::Frame { time_secs }, |_| ()),
            }
            self.used.send(chunk);
        }
    }
}

/// Feature vector extraction: segments get their feature vector and profile.
pub(super) fn extract(
    model: &SvrdmModel,
    mut from: RingReceiver<StageMessage>,
    mut to: RingSender<StageMessage>,
) {
    let dim = model.pca.dims();
    let mut extraction = FeatureExtraction::new(&model.params, dim, &model.signs);
    let mut rings: Vec<_> = (0..MAX_PERFORMERS)
        .map(|_| RowRing::new(&model.params, dim))
        .collect();
    while let Some(mut message) = from.next() {
        let ring = &mut rings[message.mark.actor];
        match message.what {
            What::Rows => message
                .rows
                .chunks_exact(dim)
                .for_each(|row| ring.push(row)),
            What::End(_) => ring.reset(),
            What::Segment(_) => {
                let StageMessage {
                    gram,
                    has_feature,
                    feature,
                    profile,
                    profile_len,
                    ..
                } = &mut *message;
                let found = extraction
                    .feature(gram)
                    .map(|found| feature.copy_from_slice(found));
                *has_feature = found.is_some();
                if *has_feature {
                    let found = extraction.profile(gram, ring.last(gram.frames()));
                    *profile_len = found.len();
                    profile[..found.len()].copy_from_slice(found);
                }
            }
            What::Column | What::Frame { .. } => {}
        }
        to.send(message);
    }
}

/// Classification: segments get the classes that they may be.
pub(super) fn classify(
    model: &SvrdmModel,
    mut from: RingReceiver<StageMessage>,
    mut to: RingSender<StageMessage>,
) {
    let acceptance = model.params.acceptance();
    while let Some(mut message) = from.next() {
        if let What::Segment(_) = message.what {
            let StageMessage {
                has_feature,
                feature,
                candidates,
                ..
            } = &mut *message;
            candidates.clear();
            if *has_feature {
                model.tree.descend(feature, acceptance, candidates);
            }
        }
        to.send(message);
    }
}

/// Scoring: segments get what they most certainly are.
pub(super) fn score(
    mut scoring: SegmentScoring,
    mut from: RingReceiver<StageMessage>,
    mut to: RingSender<StageMessage>,
) {
    while let Some(mut message) = from.next() {
        if let What::Segment(_) = message.what {
            let StageMessage {
                candidates,
                profile,
                profile_len,
                gram,
                cell,
                ..
            } = &mut *message;
            *cell = match candidates.is_empty() {
                true => Cell::NOTHING,
                false => scoring.best(candidates, &profile[..*profile_len], gram.frames()),
            };
        }
        to.send(message);
    }
}

//! Pose rows in, detections in frames out.

use std::sync::Arc;

use super::leading::AT_ONCE;
use super::stage;
use super::{
    Cell, ChunkAssembly, ClassCandidates, FeatureExtraction, FrameDetection, Gram, ModelError,
    SegmentAssembly, SegmentScoring, SegmentTracking, Stage, SvrdmModel, Window,
};

/// The live stages of the thesis one after the other (§4.6): input assembly, segment assembly, feature vector
/// extraction, classification, scoring, tracking. It knows no clock: rows come at the model's rate.
///
/// Construction allocates and may fail with a reason; nothing after it does either. What it gives depends on the rows
/// alone.
#[derive(Debug, Clone)]
pub struct SvrdmEngine {
    model: Arc<SvrdmModel>,
    reduced: Vec<f32>,
    chunks: ChunkAssembly,
    segments: SegmentAssembly,
    recogniser: SegmentRecogniser,
    tracking: SegmentTracking,
    column: Vec<Cell>,
    /// The segments that end with the newest chunk.
    ending: Vec<(Window, Gram)>,
}

/// From one segment to what it seems to be.
#[derive(Debug, Clone)]
struct SegmentRecogniser {
    model: Arc<SvrdmModel>,
    extraction: FeatureExtraction,
    candidates: ClassCandidates,
    scoring: SegmentScoring,
}

impl SvrdmEngine {
    /// Lays the model out for streaming; fails if its parts do not fit together.
    ///
    /// # Errors
    /// As [`SvrdmModel::check`].
    pub fn new(model: &Arc<SvrdmModel>) -> Result<Self, ModelError> {
        model.check()?;
        let (params, dim) = (&model.params, model.pca.dims());
        let scoring = SegmentScoring::new(model)?;
        Ok(Self {
            reduced: vec![0.0; dim],
            chunks: ChunkAssembly::new(params, dim),
            segments: SegmentAssembly::new(params, dim),
            tracking: SegmentTracking::of_model(model, &scoring),
            column: vec![Cell::NOTHING; params.lengths()],
            ending: vec![(Window { start: 0, stop: 0 }, Gram::new(dim)); params.lengths()],
            recogniser: SegmentRecogniser {
                model: model.clone(),
                extraction: FeatureExtraction::new(params, dim, &model.signs),
                candidates: ClassCandidates::default(),
                scoring,
            },
            model: model.clone(),
        })
    }

    /// The model in use.
    pub fn model(&self) -> &SvrdmModel {
        &self.model
    }

    /// Rows that must follow a motion's last before it can be reported: those of the chunk that shows its segment to be
    /// a maximum. How long it then waits for rivals, [`SegmentTracking`] says: until
    /// [`wait_chunks`](super::SvrdmParams::wait_chunks) at the most.
    pub fn latency_frames(&self) -> usize {
        self.model.params.chunk_frames
    }

    /// Forgets the stream so far.
    pub fn reset(&mut self) {
        self.chunks.reset();
        self.segments.reset();
        self.tracking.reset();
    }

    /// Takes the next pose row, `D` values; calls `out` with what is now certain, in order of time.
    ///
    /// Every [`chunk_frames`](super::SvrdmParams::chunk_frames)th row completes a chunk and does all the work.
    pub fn push(&mut self, row: &[f32], out: &mut impl FnMut(FrameDetection)) {
        self.push_with(row, &mut Unobserved, out);
    }

    /// The same, and calls `watch` with every segment that was looked at: the map of Fig. 4.3, cell by cell. See
    /// [`ConfidenceMap`](super::ConfidenceMap).
    pub fn push_with_observer(
        &mut self,
        row: &[f32],
        watch: &mut impl FnMut(Window, Cell),
        out: &mut impl FnMut(FrameDetection),
    ) {
        self.push_with(row, &mut CellObserver(watch), out);
    }

    /// The same, and calls `ended` after each part of a stage's work: for measuring.
    pub fn push_by_stages(
        &mut self,
        row: &[f32],
        ended: &mut impl FnMut(Stage),
        out: &mut impl FnMut(FrameDetection),
    ) {
        self.push_with(row, &mut StageObserver(ended), out);
    }

    fn push_with(
        &mut self,
        row: &[f32],
        observer: &mut impl EngineObserver,
        out: &mut impl FnMut(FrameDetection),
    ) {
        self.model.pca.project_into(row, &mut self.reduced);
        let complete = self.chunks.push(&self.reduced);
        observer.ended(Stage::InputAssembly);
        if !complete {
            return;
        }
        self.column.fill(Cell::NOTHING);
        let shortest = self.model.params.min_chunks;
        let least = self.model.params.min_confidence;
        let mut count = 0;
        self.segments
            .push(self.chunks.chunk(), &mut |window, segment| {
                // Too long or too short for any class to count: nothing, as scoring would have it.
                if !self.tracking.may_reach(window.chunks() - shortest, least) {
                    observer.cell(window, Cell::NOTHING);
                    return;
                }
                let (of, sums) = &mut self.ending[count];
                *of = window;
                sums.copy_from(segment);
                count += 1;
            });
        observer.ended(Stage::SegmentAssembly);
        for together in self.ending[..count].chunks(AT_ONCE) {
            let extraction = &mut self.recogniser.extraction;
            extraction.prepare(together.iter().map(|(_, segment)| segment));
            observer.ended(Stage::FeatureExtraction);
            for (at, (window, segment)) in together.iter().enumerate() {
                let recogniser = &mut self.recogniser;
                let cell = recogniser.recognise(at, segment, &self.chunks, observer);
                self.column[window.chunks() - shortest] = cell;
                observer.cell(*window, cell);
            }
        }
        let frames = self.model.params.chunk_frames as i64;
        self.tracking
            .push(&self.column, &mut |found| out(found.in_frames(frames)));
        observer.ended(Stage::Tracking);
    }

    /// Bytes that a stage reads and writes: its tables, its part of the model, its output.
    pub fn stage_bytes(&self, stage: Stage) -> usize {
        let dim = self.model.pca.dims();
        let gram = self.chunks.chunk().bytes();
        let recogniser = &self.recogniser;
        match stage {
            Stage::InputAssembly => {
                let rows = 4 * self.model.params.max_frames() * dim;
                8 * (1 + dim) * self.model.pca.dim() + rows + gram
            }
            Stage::SegmentAssembly => (self.segments.chunks_kept() + 1 + self.ending.len()) * gram,
            Stage::FeatureExtraction => recogniser.extraction.bytes(),
            Stage::Classification => stage::tree_bytes(&self.model),
            Stage::Scoring => recogniser.scoring.bytes(),
            Stage::Tracking => self.tracking.bytes(),
        }
    }

    /// Ends the stretch: calls `out` with what is left. Rows that make no whole chunk are left out.
    pub fn finish(&mut self, out: &mut impl FnMut(FrameDetection)) {
        let frames = self.model.params.chunk_frames as i64;
        self.tracking
            .finish(&mut |found| out(found.in_frames(frames)));
        self.reset();
    }
}

impl SegmentRecogniser {
    /// The class that the `at`th segment prepared, whose rows are the last of `chunks`, most certainly is.
    fn recognise(
        &mut self,
        at: usize,
        segment: &Gram,
        chunks: &ChunkAssembly,
        observer: &mut impl EngineObserver,
    ) -> Cell {
        let feature = self.extraction.prepared(at, segment);
        observer.ended(Stage::FeatureExtraction);
        let Some(feature) = feature else {
            return Cell::NOTHING;
        };
        let acceptance = self.model.params.acceptance();
        self.model
            .tree
            .descend(feature, acceptance, &mut self.candidates);
        observer.ended(Stage::Classification);
        if self.candidates.is_empty() {
            return Cell::NOTHING;
        }
        let profile = self
            .extraction
            .profile(segment, chunks.last_rows(segment.frames()));
        observer.ended(Stage::FeatureExtraction);
        let cell = (self.scoring).best(&self.candidates, profile, segment.frames());
        observer.ended(Stage::Scoring);
        cell
    }
}

/// What looks on while rows are taken.
trait EngineObserver {
    fn ended(&mut self, _: Stage) {}
    fn cell(&mut self, _: Window, _: Cell) {}
}

struct Unobserved;

impl EngineObserver for Unobserved {}

struct CellObserver<'a, F>(&'a mut F);

impl<F: FnMut(Window, Cell)> EngineObserver for CellObserver<'_, F> {
    fn cell(&mut self, window: Window, cell: Cell) {
        (self.0)(window, cell);
    }
}

struct StageObserver<'a, F>(&'a mut F);

impl<F: FnMut(Stage)> EngineObserver for StageObserver<'_, F> {
    fn ended(&mut self, stage: Stage) {
        (self.0)(stage);
    }
}

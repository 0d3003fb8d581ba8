//! Input assembly (thesis, §4.6.2): frames to pose rows, rows to chunks.

use std::sync::Arc;

use crate::features::Pushed;
use crate::live::detection::Steps;
use crate::live::{Frame, Model, PoseExtractor, Rig};
use crate::pivots::{PivotPose, PoseStream};
use crate::svrdm::{ChunkAssembly, SvrdmModel};

use super::belt::{RingReceiver, RingSender};
use super::message::{Chunk, End, MessageStamp, Of};

/// Output for chunks, and return of used boxes.
#[derive(Debug)]
pub(super) struct Chunks {
    pub(super) out: RingSender<Chunk>,
    pub(super) spare: RingReceiver<Chunk>,
}

impl Chunks {
    /// Sends what `fill` makes of a spare box; nothing once the stages have ended.
    fn send(&mut self, mark: MessageStamp, of: Of, fill: impl FnOnce(&mut Chunk)) {
        if let Some(mut chunk) = self.spare.next() {
            (chunk.mark, chunk.of) = (mark, of);
            fill(&mut chunk);
            self.out.send(chunk);
        }
    }
}

/// Fate of a frame.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Fate {
    /// Its skeleton is not known.
    Unusable,
    /// It completed no chunk: nothing more comes of it.
    Through,
    /// It is on its way; the last stage counts it.
    Sent,
}

/// One performer's way from frames to chunks: what [`Recognizer`](crate::live::Recognizer) does with a pose before the
/// engine has it, and the engine's first stage.
#[derive(Debug)]
pub(super) struct PerformerInput {
    actor: usize,
    known: bool,
    reader: Option<PoseExtractor>,
    rows: PoseStream,
    chunks: RowChunker,
    now_secs: f64,
    wall_secs: f64,
}

impl PerformerInput {
    pub(super) fn new(model: &Arc<SvrdmModel>, actor: usize) -> Self {
        Self {
            actor,
            known: false,
            reader: None,
            rows: PoseStream::new(&model.pivots, &model.pose),
            chunks: RowChunker::new(model),
            now_secs: 0.0,
            wall_secs: 0.0,
        }
    }

    /// Begins with a new skeleton; ends what went on with the old one.
    pub(super) fn set_rig(&mut self, rig: &Rig, to: &mut Chunks) {
        self.finish(to);
        let model = self.chunks.model.clone();
        self.known = true;
        self.rows = PoseStream::new(&model.pivots, &model.pose);
        self.reader = PoseExtractor::new(&Model::Svrdm(model), &rig.skeleton, &rig.roles).ok();
        self.now_secs = 0.0;
    }

    /// The performer has gone for now.
    pub(super) fn finish(&mut self, to: &mut Chunks) {
        self.end(End::Gone, to);
    }

    /// Takes a frame. What comes of it is reported with its times.
    pub(super) fn push(&mut self, frame: &Frame, to: &mut Chunks) -> Fate {
        if !self.known {
            return Fate::Unusable;
        }
        self.wall_secs = frame.wall_secs;
        if self.rows.breaks_at(frame.time_secs) {
            self.end(End::Gap, to);
        }
        let pivots: PivotPose = self
            .reader
            .as_mut()
            .and_then(|reader| reader.pivots(&frame.pose))
            .copied()
            .unwrap_or_default();
        // The first pose of a stretch sets its origin and completes no row: the origin read here is right.
        let mark = self.mark(frame.time_secs);
        let (chunks, mut sent) = (&mut self.chunks, false);
        let pushed = self.rows.push(frame.time_secs, &pivots, &mut |row| {
            sent |= chunks.push(row, mark, to);
        });
        if matches!(pushed, Pushed::Taken | Pushed::Restarted) {
            self.now_secs = frame.time_secs;
        }
        if !sent {
            return Fate::Through;
        }
        to.send(
            mark,
            Of::Frame {
                time_secs: frame.time_secs,
            },
            |_| (),
        );
        Fate::Sent
    }

    fn mark(&self, reported_secs: f64) -> MessageStamp {
        MessageStamp {
            actor: self.actor,
            reported_secs,
            wall_secs: self.wall_secs,
            steps: Steps::at_rate(self.rows.origin_secs(), self.chunks.model.rate_hz()),
        }
    }

    /// Ends the stretch with the row that still waits.
    fn end(&mut self, end: End, to: &mut Chunks) {
        let mark = self.mark(self.now_secs);
        let chunks = &mut self.chunks;
        self.rows.finish(&mut |row| {
            chunks.push(row, mark, to);
        });
        chunks.assembly.reset();
        to.send(mark, Of::End(end), |_| ());
    }
}

/// Rows to chunks.
#[derive(Debug)]
struct RowChunker {
    model: Arc<SvrdmModel>,
    /// The row at hand, projected: `model.pca.dims()` values.
    reduced: Vec<f32>,
    assembly: ChunkAssembly,
}

impl RowChunker {
    fn new(model: &Arc<SvrdmModel>) -> Self {
        let dim = model.pca.dims();
        Self {
            model: model.clone(),
            reduced: vec![0.0; dim],
            assembly: ChunkAssembly::new(&model.params, dim),
        }
    }

    /// Takes a pose row; true if it completed a chunk, which has then been sent.
    fn push(&mut self, row: &[f32], mark: MessageStamp, to: &mut Chunks) -> bool {
        self.model.pca.project_into(row, &mut self.reduced);
        if !self.assembly.push(&self.reduced) {
            return false;
        }
        to.send(mark, Of::Chunk, |chunk| {
            chunk.gram.copy_from(self.assembly.chunk());
            let dim = chunk.gram.dim();
            let rows = self.assembly.last_rows(self.model.params.chunk_frames);
            for (kept, row) in chunk.rows.chunks_exact_mut(dim).zip(rows) {
                kept.copy_from_slice(row);
            }
        });
        true
    }
}

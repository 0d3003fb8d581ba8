//! Messages between stages.

use crate::live::detection::Steps;
use crate::svrdm::{Cell, ClassCandidates, Gram, SvrdmModel, Window};

/// Performer and time of a message.
#[derive(Debug, Clone, Copy)]
pub(super) struct MessageStamp {
    pub(super) actor: usize,
    /// The stream's clock when what follows from it is reported, and the wall clock then.
    pub(super) reported_secs: f64,
    pub(super) wall_secs: f64,
    /// Time base of the present stretch.
    pub(super) steps: Steps,
}

impl MessageStamp {
    fn nobody() -> Self {
        let steps = Steps {
            origin_secs: 0.0,
            step_secs: 0.0,
        };
        Self {
            actor: 0,
            reported_secs: 0.0,
            wall_secs: 0.0,
            steps,
        }
    }
}

/// Reason of a stretch's end.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum End {
    /// A gap: the clock goes on.
    Gap,
    /// The performer has gone, or another skeleton follows.
    Gone,
}

/// From input assembly to segment assembly.
#[derive(Debug, Clone, Copy)]
pub(super) enum Of {
    /// A chunk is complete.
    Chunk,
    /// The stretch ends.
    End(End),
    /// A frame has been through input assembly; that it is through all stages is known when this has come through.
    Frame { time_secs: f64 },
}

/// A chunk on its way.
#[derive(Debug)]
pub(super) struct Chunk {
    pub(super) mark: MessageStamp,
    pub(super) of: Of,
    pub(super) gram: Gram,
    /// Its rows end to end.
    pub(super) rows: Vec<f32>,
}

impl Chunk {
    pub(super) fn new(model: &SvrdmModel) -> Self {
        let dim = model.pca.dims();
        let rows = vec![0.0; dim * model.params.chunk_frames];
        Self {
            mark: MessageStamp::nobody(),
            of: Of::Chunk,
            gram: Gram::new(dim),
            rows,
        }
    }
}

/// Contents of a message for the stages that it passes.
#[derive(Debug, Clone, Copy)]
pub(super) enum What {
    /// A new chunk's rows.
    Rows,
    /// A segment that ends with it.
    Segment(Window),
    /// All of its segments have gone before.
    Column,
    /// The stretch ends.
    End(End),
    /// A frame is through.
    Frame { time_secs: f64 },
}

/// A segment on its way; each stage adds what it finds. Other news travel alike, so that nothing overtakes anything.
#[derive(Debug)]
pub(super) struct StageMessage {
    pub(super) mark: MessageStamp,
    pub(super) what: What,
    pub(super) rows: Vec<f32>,
    pub(super) gram: Gram,
    /// The feature vector, if there is one.
    pub(super) has_feature: bool,
    pub(super) feature: Vec<f64>,
    /// The first `profile_len` values are the profile.
    pub(super) profile_len: usize,
    pub(super) profile: Vec<f32>,
    pub(super) candidates: ClassCandidates,
    pub(super) cell: Cell,
}

impl StageMessage {
    pub(super) fn new(model: &SvrdmModel) -> Self {
        let (params, dim) = (&model.params, model.pca.dims());
        let profile = params.comparison.rows(params.max_frames()) * params.comparison.width(dim);
        Self {
            mark: MessageStamp::nobody(),
            what: What::Rows,
            rows: vec![0.0; dim * params.chunk_frames],
            gram: Gram::new(dim),
            has_feature: false,
            feature: vec![0.0; params.feature_dim(dim)],
            profile_len: 0,
            profile: vec![0.0; profile],
            candidates: ClassCandidates::default(),
            cell: Cell::NOTHING,
        }
    }
}

//! The method of 2009 on the same labels: its tree of classes, the boundaries of its branches, its map of confidences.

use std::path::Path;
use std::sync::Arc;
use std::time::Instant;

use morec::labels::{ClassLengths, GroundTruth, Sample, class_lengths};
use morec::live::Model;
use morec::pivots::{PivotMap, pose_rows_of_clip};
use morec::svrdm::{Branch, Node, SampleClassifier, SvrdmEngine, SvrdmModel};
use morec::train::thesis::SvrdmTrainParams;
use morec::train::{TrainError, TrainingData};
use morec_db::ClipId;
use morec_ops::{OperationError, TrainSettings};

use super::progress::{JobError, JobProgress};
use super::train::{self, TrainedIndex};
use crate::body::ClipMotion;

/// Places along each side of a picture of a branch.
pub const GRID: usize = 72;

/// A trained tree, ready to be shown.
#[derive(Debug)]
pub struct Thesis {
    pub model: Arc<SvrdmModel>,
    /// The figures that it was trained with.
    pub params: SvrdmTrainParams,
    pub samples: Vec<GroundTruth>,
    pub nodes: Vec<TreeNodeView>,
    /// For each sample, the nodes on its way down the tree.
    pub paths: Vec<Vec<usize>>,
    /// Lengths of the samples of each class.
    pub lengths: Vec<ClassLengths>,
}

impl Thesis {
    /// The branch of this number.
    pub fn branch(&self, at: usize) -> Option<&Boundary> {
        match self.nodes.get(at)? {
            TreeNodeView::Branch(branch) => Some(branch),
            TreeNodeView::Leaf(_) => None,
        }
    }
}

#[derive(Debug)]
pub enum TreeNodeView {
    Leaf(String),
    Branch(Boundary),
}

/// A branch: its sides, and the plane in which it separates them.
#[derive(Debug)]
pub struct Boundary {
    pub children: [usize; 2],
    pub sides: [Vec<String>; 2],
    /// Left, lower, right and upper edge of what is shown of the plane.
    pub edges: [f64; 4],
    /// For each place, by rows from below: bit 0 where the first side's machine says `t` or more, bit 1 where the second's
    /// does.
    pub regions: Vec<u8>,
    /// For each place, what the machines of both sides say.
    pub outputs: Vec<[f64; 2]>,
    /// Samples of either side: place in `Thesis::samples`, place in the plane, side.
    pub points: Vec<(usize, [f64; 2], usize)>,
}

/// Trains on the accepted samples of the database at `path`: an index, and its tree to be shown.
pub fn run(
    path: &Path,
    settings: &TrainSettings,
    params: SvrdmTrainParams,
    progress: &JobProgress,
) -> Result<(Arc<Thesis>, Box<TrainedIndex>), JobError> {
    let trained = || -> Result<_, OperationError> {
        let begun = Instant::now();
        let data = train::material(path, &settings.classes)?;
        let trained = train::index(&data, settings, begun, progress)?;
        Ok((Arc::new(shown(&data, &trained, params)?), Box::new(trained)))
    };
    trained().map_err(|error| JobError::of("The method of 2009 was not trained", error))
}

/// The tree of an index that was trained with `params` on `data`.
fn shown(
    data: &TrainingData,
    trained: &TrainedIndex,
    params: SvrdmTrainParams,
) -> Result<Thesis, OperationError> {
    let Model::Svrdm(model) = &trained.index.model else {
        let why = "the settings train another method";
        return Err(OperationError::Settings(why.to_owned()));
    };
    let model = model.clone();
    let mut classifier = SampleClassifier::new(&model).map_err(TrainError::from)?;
    let (mut samples, mut vectors) = (Vec::new(), Vec::new());
    for clip in data.labelled() {
        let Ok(map) = PivotMap::of_clip(&model.pivots, &clip.clip, &clip.roles) else {
            continue;
        };
        let rows = pose_rows_of_clip(&clip.clip, &model.pivots, &map, &clip.rest, &model.pose);
        let rows = model.pca.project(&rows);
        for sample in data.samples.iter().filter(|s| s.clip == clip.name) {
            let cut = rows.slice((sample.span).frames_among(rows.len(), model.rate_hz()));
            if let Some(vector) = classifier.feature(&cut) {
                vectors.push(vector);
                samples.push(GroundTruth::from(sample.clone()));
            }
        }
    }
    // More than this a machine says of its own side alone.
    let least = params.tree.machine.other;
    let nodes = model.tree.nodes().iter().map(|node| match node {
        Node::Leaf(class) => TreeNodeView::Leaf(model.classes[class.index()].name.clone()),
        Node::Branch(branch) => {
            TreeNodeView::Branch(boundary(&model, branch, &samples, &vectors, least))
        }
    });
    let path = |vector: &Vec<f64>| {
        let path = model.tree.path(vector, model.params.acceptance());
        path.iter().map(|step| step.node).collect()
    };
    Ok(Thesis {
        nodes: nodes.collect(),
        paths: vectors.iter().map(path).collect(),
        lengths: class_lengths(data.samples.iter().map(Sample::length)),
        samples,
        params,
        model: model.clone(),
    })
}

fn boundary(
    model: &SvrdmModel,
    branch: &Branch,
    samples: &[GroundTruth],
    vectors: &[Vec<f64>],
    least: f64,
) -> Boundary {
    let sides = [0, 1].map(|side| {
        let classes = branch.classes[side].iter();
        classes
            .map(|class| model.classes[class.index()].name.clone())
            .collect::<Vec<_>>()
    });
    let points: Vec<(usize, [f64; 2], usize)> = samples
        .iter()
        .enumerate()
        .filter_map(|(at, sample)| {
            let side = sides.iter().position(|side| side.contains(&sample.class))?;
            Some((at, model.tree.reduce(branch, &vectors[at]), side))
        })
        .collect();
    let edges = edges(&points);
    let at = |axis: usize, step: usize| {
        let (low, high) = (edges[axis], edges[axis + 2]);
        low + (high - low) * (step as f64 + 0.5) / GRID as f64
    };
    let places = (0..GRID * GRID).map(|place| [at(0, place % GRID), at(1, place / GRID)]);
    let outputs: Vec<[f64; 2]> = places.map(|place| branch.outputs_at(place)).collect();
    let accepts = |says: f64| u8::from(says >= least);
    let regions = outputs
        .iter()
        .map(|says| accepts(says[0]) | accepts(says[1]) << 1);
    Boundary {
        children: branch.children.map(|child| child as usize),
        regions: regions.collect(),
        outputs,
        sides,
        edges,
        points,
    }
}

/// Edges of the part of the plane that is shown: all points with a quarter of their extent around them.
fn edges(points: &[(usize, [f64; 2], usize)]) -> [f64; 4] {
    let axis = |k: usize| {
        let values = || points.iter().map(|p| p.1[k]);
        let (low, high) = (
            values().fold(f64::MAX, f64::min),
            values().fold(f64::MIN, f64::max),
        );
        if low > high {
            return (0.0, 1.0);
        }
        let margin = (0.25 * (high - low)).max(0.05);
        (low - margin, high + margin)
    };
    let ((left, right), (lower, upper)) = (axis(0), axis(1));
    [left, lower, right, upper]
}

/// Confidences of the segments of a clip (Fig. 4.3), by where they start and how long they are.
#[derive(Debug, Clone)]
pub struct Map {
    pub clip: ClipId,
    /// Seconds of a chunk.
    pub chunk_secs: f64,
    /// Chunks of the shortest segment.
    pub shortest: usize,
    /// Number of lengths.
    pub lengths: usize,
    /// For each start and then each length from the shortest: confidence (0 none … 255) and class.
    pub cells: Vec<(u8, u8)>,
    pub classes: Vec<String>,
}

/// Looks at every segment of a clip.
pub fn map(
    model: &Arc<SvrdmModel>,
    motion: &ClipMotion,
    progress: &JobProgress,
) -> Result<Map, JobError> {
    use morec::progress::Progress;
    let failed = |why: String| JobError::Failed(format!("No map of confidences: {why}"));
    let pivots = PivotMap::of_clip(&model.pivots, &motion.clip, &motion.roles)
        .map_err(|error| failed(error.to_string()))?;
    let mut engine = SvrdmEngine::new(model).map_err(|error| failed(error.to_string()))?;
    let rows = pose_rows_of_clip(
        &motion.clip,
        &model.pivots,
        &pivots,
        &motion.rest,
        &model.pose,
    );
    let (params, lengths) = (&model.params, model.params.lengths());
    let mut cells = vec![(0u8, 0u8); (rows.len() / params.chunk_frames + 1) * lengths];
    for (at, row) in rows.iter().enumerate() {
        if at % 4096 == 0 && progress.cancelled() {
            return Err(JobError::Cancelled);
        }
        engine.push_with_observer(
            row,
            &mut |window, cell| {
                let place = window.start.max(0) as usize * lengths
                    + window.chunks().saturating_sub(params.min_chunks);
                if let Some(kept) = cells.get_mut(place) {
                    let level = (255.0 * cell.confidence).round().clamp(0.0, 255.0);
                    *kept = (level as u8, cell.class.index().min(255) as u8);
                }
            },
            &mut |_| (),
        );
    }
    Ok(Map {
        clip: motion.id,
        chunk_secs: params.chunk_frames as f64 / model.rate_hz(),
        shortest: params.min_chunks,
        lengths,
        cells,
        classes: model.classes.iter().map(|c| c.name.clone()).collect(),
    })
}

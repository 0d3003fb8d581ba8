//! The prototype of the thesis's recogniser: its models and stream, as `testdata/reference/README.md` says.

use std::sync::Arc;

use morec::classes::ClassInfo;
use morec::pca::Pca;
use morec::pivots::{Pivot, PivotSet, PoseParams};
use morec::svrdm::{Maxima, Profiles, Scaling, SvrdmModel, SvrdmParams, Tree};

#[derive(serde::Deserialize)]
pub struct Reference {
    pub pivots: usize,
    pub rate_hz: f64,
    pub chunk_frames: usize,
    pub accept: f64,
    /// Thousandths.
    stream: Vec<i32>,
    pub models: Vec<Figures>,
}

/// One model and what the prototype makes of the stream with it.
#[derive(serde::Deserialize)]
#[allow(dead_code)] // Not all who include this file compare figures.
pub struct Figures {
    scaling: Scaling,
    pca: Pca,
    signs: Vec<f64>,
    tree: Tree,
    profiles: Profiles,
    mean_secs: Vec<f64>,
    epsilon: f32,
    /// First and one past the last chunk of a segment, and its feature vector.
    pub features: Vec<(i64, i64, Vec<f64>)>,
    /// First and one past the last chunk, class, confidence of every segment that is not rejected.
    pub cells: Vec<(i64, i64, u16, f64)>,
    /// First and one past the last frame, class, confidence.
    pub detections: Vec<(i64, i64, u16, f64)>,
}

pub fn reference() -> Reference {
    serde_json::from_str(include_str!("../../testdata/reference/svrdm.json")).unwrap()
}

impl Reference {
    /// Pose rows.
    pub fn rows(&self) -> Vec<Vec<f32>> {
        let values: Vec<f32> = self
            .stream
            .iter()
            .map(|v| (f64::from(*v) / 1000.0) as f32)
            .collect();
        values
            .chunks_exact(4 * self.pivots)
            .map(<[f32]>::to_vec)
            .collect()
    }

    /// The prototype's model; it decides knowing the whole stream.
    pub fn model(&self, figures: &Figures) -> Arc<SvrdmModel> {
        let name = |index: usize| format!("pivot {index}");
        let pivot = |index: usize| Pivot {
            name: name(index),
            parent: index.checked_sub(1).map(name),
            joints: vec![],
            role: None,
        };
        let class = |index: usize| ClassInfo {
            name: format!("class {index}"),
            samples: 5,
            people: 0,
        };
        Arc::new(SvrdmModel {
            classes: (0..figures.mean_secs.len()).map(class).collect(),
            pivots: PivotSet::new((0..self.pivots).map(pivot).collect()).unwrap(),
            pose: PoseParams {
                rate_hz: self.rate_hz,
                ..PoseParams::default()
            },
            pca: figures.pca.clone(),
            params: SvrdmParams {
                chunk_frames: self.chunk_frames,
                accept: self.accept,
                scaling: figures.scaling,
                wait_chunks: 256,
                maxima: Maxima::Peaks,
                ..SvrdmParams::default()
            },
            signs: figures.signs.clone(),
            tree: figures.tree.clone(),
            profiles: figures.profiles.clone(),
            mean_secs: figures.mean_secs.clone(),
            epsilon: figures.epsilon,
        })
    }
}

//! §5.3: cut-out samples through a tree that half of them trained.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use serde::Serialize;

use crate::classes::ClassId;
use crate::crossval::{FoldBy, folds};
use crate::features::Rows;
use crate::index::{MotionIndex, Provenance};
use crate::labels::Sample;
use crate::plot::HeatMap;
use crate::report::pictures::{branch_picture, tree_picture};
use crate::svrdm::{SampleClassifier, SvrdmModel};
use crate::train::LabelSet;
use crate::train::thesis::{Estimated, SvrdmOptions, train_svrdm};
use morec_svrdm::train_tree::{BranchReport, FeatureSample};

use super::study::{Picture, ReproduceError, Setting, Study, frames_of, rows_of};

/// Classification rates of samples (Eq. 5.1).
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize)]
pub struct Rates {
    /// Number of samples.
    pub samples: usize,
    /// Share given their class.
    pub p_c: f64,
    /// Share given another.
    pub p_e: f64,
    /// Share rejected.
    pub p_r: f64,
}

/// One half split.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct SplitResult {
    /// Setting of the tree's training.
    pub setting: Setting,
    /// Seed of the split.
    pub seed: u64,
    /// Samples that trained.
    pub taught: usize,
    /// `T` in recognition.
    pub accept: f64,
    /// All samples through the tree, those that trained it among them: as the thesis counts.
    pub all: Rates,
    /// The samples that did not train.
    pub unseen: Rates,
    /// The same two, where a sample must be as like the class's samples as the recogniser asks of confidence.
    pub alike: [Rates; 2],
    /// Rows: what the tree says, the last row "none"; columns: what it is (Tables 5.5 and 5.6).
    pub confusion: Vec<Vec<usize>>,
    /// Bytes of the index file.
    pub index_bytes: usize,
    /// The branches.
    pub branches: Vec<BranchReport>,
    /// Estimation of thresholds, if they were estimated.
    pub estimated: Option<Estimated>,
}

pub(super) fn run(
    study: &Study<'_>,
    (setting, options): &(Setting, SvrdmOptions),
    seed: u64,
    pictures: &mut Vec<Picture>,
) -> Result<SplitResult, ReproduceError> {
    let split = folds(FoldBy::Half { seed }, study.samples, &BTreeMap::new());
    let fold = split
        .first()
        .ok_or_else(|| ReproduceError::Other("there are no samples".to_owned()))?;
    let pick = |places: &[usize]| -> Vec<Sample> {
        places.iter().map(|&i| study.samples[i].clone()).collect()
    };
    let (taught, held_back) = (pick(&fold.taught), pick(&fold.held_back));
    let labelling = LabelSet {
        samples: &taught,
        held_back: &held_back,
        classes: study.classes,
        unlabelled_is_background: true,
    };
    let (model, report) = train_svrdm(study.clips, &labelling, options, &())?;
    let model = Arc::new(model);
    let mut classifier =
        SampleClassifier::new(&model).map_err(|e| ReproduceError::Other(e.to_string()))?;
    let trained: BTreeSet<usize> = fold.taught.iter().copied().collect();
    let mut tally = Tally::new(study.classes.len());
    let mut features = vec![];
    for (place, class, rows) in cut_out(study, &model)? {
        let found = classifier.classify(&rows);
        let accepted = found.filter(|f| f.output >= model.params.accept);
        let alike = accepted.filter(|f| f.likeness >= model.params.min_confidence);
        let unseen = !trained.contains(&place);
        tally.count(
            class,
            accepted.map(|f| f.class),
            alike.map(|f| f.class),
            unseen,
        );
        if let Some(vector) = classifier.feature(&rows).filter(|_| !unseen) {
            features.push(FeatureSample {
                class,
                group: 0,
                vector,
            });
        }
    }
    draw(study, *setting, &model, &features, &tally, pictures);
    let index = MotionIndex {
        model: model.clone().into(),
        roles: BTreeMap::new(),
        provenance: Provenance::default(),
    };
    let svrdm = report.svrdm;
    Ok(SplitResult {
        setting: *setting,
        seed,
        taught: taught.len(),
        accept: model.params.accept,
        all: tally.rates(|_| true, 0),
        unseen: tally.rates(|unseen| unseen, 0),
        alike: [tally.rates(|_| true, 1), tally.rates(|unseen| unseen, 1)],
        confusion: tally.confusion,
        index_bytes: index.to_bytes()?.len(),
        branches: svrdm.as_ref().map_or_else(Vec::new, |s| s.branches.clone()),
        estimated: svrdm.and_then(|s| s.estimated),
    })
}

/// Every sample's place, class and reduced rows.
fn cut_out(
    study: &Study<'_>,
    model: &SvrdmModel,
) -> Result<Vec<(usize, ClassId, Rows)>, ReproduceError> {
    let mut all = vec![];
    for clip in study.clips {
        let of_clip = || {
            study
                .samples
                .iter()
                .enumerate()
                .filter(|(_, s)| s.clip == clip.name)
        };
        if of_clip().next().is_none() {
            continue;
        }
        let rows = model
            .pca
            .project(&rows_of(clip, &model.pivots, &model.pose)?);
        for (place, sample) in of_clip() {
            let class = study.classes.iter().position(|c| *c == sample.class);
            if let Some(class) = class {
                let cut = rows.slice(frames_of(sample, model.rate_hz(), rows.len()));
                all.push((place, ClassId(class as u16), cut));
            }
        }
    }
    Ok(all)
}

struct Tally {
    /// For each sample: whether unseen; whether right or wrong by the tree, and by the tree with likeness.
    outcomes: Vec<(bool, [Option<bool>; 2])>,
    confusion: Vec<Vec<usize>>,
}

impl Tally {
    fn new(classes: usize) -> Self {
        Self {
            outcomes: vec![],
            confusion: vec![vec![0; classes]; classes + 1],
        }
    }

    fn count(
        &mut self,
        class: ClassId,
        tree: Option<ClassId>,
        alike: Option<ClassId>,
        unseen: bool,
    ) {
        let row = tree.map_or(self.confusion.len() - 1, ClassId::index);
        self.confusion[row][class.index()] += 1;
        self.outcomes.push((
            unseen,
            [tree, alike].map(|found| found.map(|found| found == class)),
        ));
    }

    fn rates(&self, which: impl Fn(bool) -> bool, by: usize) -> Rates {
        let chosen: Vec<Option<bool>> = self
            .outcomes
            .iter()
            .filter(|(unseen, _)| which(*unseen))
            .map(|(_, found)| found[by])
            .collect();
        let share = |what: Option<bool>| {
            chosen.iter().filter(|found| **found == what).count() as f64
                / chosen.len().max(1) as f64
        };
        Rates {
            samples: chosen.len(),
            p_c: share(Some(true)),
            p_e: share(Some(false)),
            p_r: share(None),
        }
    }
}

fn draw(
    study: &Study<'_>,
    setting: Setting,
    model: &SvrdmModel,
    features: &[FeatureSample],
    tally: &Tally,
    pictures: &mut Vec<Picture>,
) {
    let name = setting.name();
    pictures.push(Picture {
        name: format!("{name}_tree"),
        caption: format!("{name}: the tree of classes (Fig. 5.2)"),
        svg: tree_picture(&model.tree, study.classes),
        table: None,
    });
    // The thesis draws where a machine says at least T and at least t of training.
    let levels = [0.4, 1.0];
    for (node, _) in model.tree.branches() {
        let Some(svg) = branch_picture(&model.tree, node, features, study.classes, levels) else {
            continue;
        };
        let caption = format!(
            "{name}: decision boundaries of branch {node} with its samples (Figs. 5.3 to 5.12)"
        );
        pictures.push(Picture {
            name: format!("{name}_branch_{node}"),
            caption,
            svg,
            table: None,
        });
    }
    let columns = study.classes.len();
    let values = tally.confusion.iter().flatten().map(|n| *n as f64);
    let rows: Vec<String> = study
        .classes
        .iter()
        .cloned()
        .chain(["none".to_owned()])
        .collect();
    let map = HeatMap::new(
        format!("{name}: what the tree says (rows) of what is labelled (columns)"),
        columns,
        values,
    );
    pictures.push(Picture {
        name: format!("{name}_confusion"),
        caption: format!("{name}: cut-out samples through the tree (Tables 5.5 and 5.6)"),
        svg: map.names(rows, study.classes.to_vec()).with_values().svg(),
        table: None,
    });
}

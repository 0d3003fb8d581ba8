//! §5.3: cut-out samples through a tree that half of them trained.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use serde::Serialize;

use crate::crossval::{Fold, FoldBy, folds};
use crate::plot::HeatMap;
use crate::report::pictures::{branch_picture, path_text, tree_picture};
use morec::classes::ClassId;
use morec::features::Rows;
use morec::index::{MotionIndex, Provenance};
use morec::labels::Sample;
use morec::svrdm::{PathStep, SampleClassifier, SvrdmModel};
use morec::train::LabelSet;
use morec::train::svrdm::{BranchReport, FeatureSample};
use morec::train::thesis::{Estimated, SvrdmOptions, train_svrdm};

use super::study::{Picture, ReproduceError, Study, frames_of, rows_of};
use morec::train::thesis::Setting;

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
    /// True if the samples trained that a split leaves out, and those of classes of a single sample (Table 5.6).
    pub complement: bool,
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
    /// What training found at each branch, the root first.
    pub branches: Vec<BranchReport>,
    /// The way of one sample that did not train down the tree, a line for each branch (Fig. 5.2).
    pub path: Vec<String>,
    /// Estimation of thresholds, if they were estimated.
    pub estimated: Option<Estimated>,
}

pub(super) fn run(
    study: &Study<'_>,
    (setting, options): &(Setting, SvrdmOptions),
    seed: u64,
    complement: bool,
    pictures: &mut Vec<Picture>,
) -> Result<SplitResult, ReproduceError> {
    let split = folds(FoldBy::Half { seed }, study.samples, &BTreeMap::new());
    let fold = split
        .first()
        .ok_or_else(|| ReproduceError::Other("there are no samples".to_owned()))?;
    let fold = if complement {
        &other_half(fold, study.samples)
    } else {
        fold
    };
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
    // Classes that no sample could describe are not the model's: the numbers of the two differ.
    let names: Vec<String> = model.classes.iter().map(|c| c.name.clone()).collect();
    let of_study = |class: ClassId| {
        let place = study
            .classes
            .iter()
            .position(|c| *c == names[class.index()]);
        ClassId(place.unwrap_or(study.classes.len()) as u16)
    };
    let of_model = |class: ClassId| {
        names
            .iter()
            .position(|n| *n == study.classes[class.index()])
    };
    let mut path = vec![];
    let mut tally = Tally::new(study.classes.len());
    let mut features = vec![];
    for (place, class, rows) in cut_out(study, &model)? {
        let found = classifier.classify(&rows);
        let accepted = found.filter(|f| f.passes(model.params.acceptance()));
        let alike = accepted.filter(|f| f.likeness >= model.params.min_confidence);
        let unseen = !trained.contains(&place);
        tally.count(
            class,
            accepted.map(|f| of_study(f.class)),
            alike.map(|f| of_study(f.class)),
            unseen,
        );
        let Some(vector) = classifier.feature(&rows) else {
            continue;
        };
        if unseen {
            // The longest way that ends in a leaf shows most.
            let found = model.tree.path(&vector, model.params.acceptance());
            if found.len() > path.len() && accepted.is_some() {
                path = found;
            }
        } else if let Some(class) = of_model(class) {
            features.push(FeatureSample {
                class: ClassId(class as u16),
                group: 0,
                vector,
            });
        }
    }
    draw(
        study,
        &Drawn {
            setting: *setting,
            complement,
            model: &model,
            names: &names,
            path: &path,
        },
        &features,
        &tally,
        pictures,
    );
    let index = MotionIndex {
        model: model.clone().into(),
        roles: BTreeMap::new(),
        provenance: Provenance::default(),
    };
    let svrdm = report.svrdm;
    Ok(SplitResult {
        setting: *setting,
        seed,
        complement,
        path: path_text(&model.tree, &names, &path),
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

/// The fold that teaches what `fold` holds back, and classes of which it holds nothing back as `fold` does.
fn other_half(fold: &Fold, samples: &[Sample]) -> Fold {
    let held_back: BTreeSet<&str> = fold
        .held_back
        .iter()
        .map(|&i| samples[i].class.as_str())
        .collect();
    let (held_back, stay): (Vec<usize>, Vec<usize>) = fold
        .taught
        .iter()
        .partition(|&&i| held_back.contains(samples[i].class.as_str()));
    let mut taught = [&fold.held_back[..], &stay].concat();
    taught.sort_unstable();
    Fold {
        taught,
        held_back,
        ..fold.clone()
    }
}

/// What is drawn of a split.
struct Drawn<'a> {
    setting: Setting,
    complement: bool,
    model: &'a SvrdmModel,
    names: &'a [String],
    path: &'a [PathStep],
}

fn draw(
    study: &Study<'_>,
    &Drawn {
        setting,
        complement,
        model,
        names,
        path,
    }: &Drawn<'_>,
    features: &[FeatureSample],
    tally: &Tally,
    pictures: &mut Vec<Picture>,
) {
    let name = setting.name();
    let half = if complement { ", the other half" } else { "" };
    let map = confusion(
        study,
        format!("{name}{half}: class by the tree (rows) and labelled class (columns)"),
        tally,
    );
    let file = if complement {
        "confusion_complement"
    } else {
        "confusion"
    };
    let table = if complement { "Table 5.6" } else { "Table 5.5" };
    pictures.push(Picture {
        name: format!("{name}_{file}"),
        caption: format!("{name}{half}: cut-out samples through the tree ({table})"),
        svg: map.svg(),
        table: None,
    });
    if complement {
        return;
    }
    pictures.push(Picture {
        name: format!("{name}_tree"),
        caption: format!("{name}: the tree of classes (Fig. 5.2)"),
        svg: tree_picture(&model.tree, names, path),
        table: None,
    });
    // The thesis draws where a machine says at least T and at least t of training.
    let levels = [0.4, 1.0];
    for (node, _) in model.tree.branches() {
        let Some(svg) = branch_picture(&model.tree, node, features, names, levels) else {
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
}

fn confusion(study: &Study<'_>, title: String, tally: &Tally) -> HeatMap {
    let columns = study.classes.len();
    let values = tally.confusion.iter().flatten().map(|n| *n as f64);
    let rows: Vec<String> = study
        .classes
        .iter()
        .cloned()
        .chain(["none".to_owned()])
        .collect();
    let map = HeatMap::new(title, columns, values);
    map.names(rows, study.classes.to_vec()).with_values()
}

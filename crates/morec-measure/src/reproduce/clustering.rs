//! §5.2: grouping samples by kWAS, held against their classes.

use serde::Serialize;

use morec::cluster::{
    KwasForm, KwasParams, PairCounts, Spectrum, adjusted_rand_index, kwas_clusters,
};
use morec::features::Rows;
use morec::pca::{ComponentCount, Moments, Pca};
use morec::pivots::{PivotSet, PoseParams};
use morec::train::StreamKind;

use super::study::{ReproduceError, Study, frames_of, rows_of};

/// Clusters at one required likeness τ, compared with the classes.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Clustering {
    /// Required likeness of two samples.
    pub tau: f64,
    /// True if samples are centred on the database's mean and reduced to 16 dimensions (§4.2), false if taken as they
    /// are.
    pub centred: bool,
    /// Number of samples.
    pub samples: usize,
    /// Clusters found.
    pub clusters: usize,
    /// Pairs of samples.
    pub pairs: PairCounts,
    /// Share of pairs on which clusters and classes agree.
    pub rand_index: f64,
    /// The same, 0 for chance.
    pub adjusted_rand_index: f64,
}

/// The values of τ in Tables 5.2 to 5.4.
pub(super) const TAUS: [f64; 3] = [0.95, 0.98, 0.99];

pub(super) fn run(study: &Study<'_>) -> Result<Vec<Clustering>, ReproduceError> {
    let (set, params) = (PivotSet::thesis(), PoseParams::default());
    let mut moments = Moments::new(set.row_dim());
    let mut cut: Vec<(usize, Rows)> = vec![];
    for clip in study
        .clips
        .iter()
        .filter(|c| c.source == StreamKind::Labelled)
    {
        let rows = rows_of(clip, &set, &params)?;
        moments.push_rows(&rows);
        for sample in study.samples.iter().filter(|s| s.clip == clip.name) {
            let span = frames_of(sample, params.rate_hz, rows.len());
            let class = study.classes.iter().position(|c| *c == sample.class);
            if let Some(class) = class.filter(|_| span.len() > 1) {
                cut.push((class, rows.slice(span)));
            }
        }
    }
    let pca = Pca::fit(&moments, ComponentCount::Dims(16))
        .map_err(|e| ReproduceError::Other(e.to_string()))?;
    let classes: Vec<usize> = cut.iter().map(|(class, _)| *class).collect();
    let centred: Vec<Spectrum> = cut
        .iter()
        .map(|(_, rows)| Spectrum::of_rows(&pca.project(rows)))
        .collect();
    let as_they_are: Vec<Spectrum> = cut
        .iter()
        .map(|(_, rows)| Spectrum::of_rows(rows))
        .collect();
    let mut found = vec![];
    for (is_centred, spectra) in [(true, &centred), (false, &as_they_are)] {
        for tau in TAUS {
            let clusters = kwas_clusters(
                spectra,
                &KwasParams {
                    k: 12,
                    tau,
                    form: KwasForm::Printed,
                },
            );
            let pairs = PairCounts::count(&classes, &clusters.of);
            found.push(Clustering {
                tau,
                centred: is_centred,
                samples: classes.len(),
                clusters: clusters.count,
                rand_index: pairs.rand_index(),
                adjusted_rand_index: adjusted_rand_index(&classes, &clusters.of),
                pairs,
            });
        }
    }
    Ok(found)
}

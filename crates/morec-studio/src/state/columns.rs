//! The samples of each class in the order in which they are shown; sorted once for every change of the database.

use std::collections::BTreeMap;

use morec_db::labels::SampleState as Judged;

use crate::store::Snapshot;

/// For each class, places of its samples in the snapshot.
#[derive(Debug, Default)]
pub struct Columns {
    of_class: BTreeMap<String, Vec<usize>>,
}

impl Columns {
    /// Proposals before labels, the likeliest first; what was rejected is left out.
    pub fn of(snapshot: &Snapshot) -> Self {
        let mut of_class: BTreeMap<String, Vec<usize>> = BTreeMap::new();
        for (at, sample) in snapshot.samples.iter().enumerate() {
            if sample.state == Judged::Rejected {
                continue;
            }
            match of_class.get_mut(&sample.class) {
                Some(column) => column.push(at),
                None => {
                    of_class.insert(sample.class.clone(), vec![at]);
                }
            }
        }
        for column in of_class.values_mut() {
            column.sort_by(|a, b| {
                let (a, b) = (&snapshot.samples[*a], &snapshot.samples[*b]);
                let judged = |s: &morec_db::labels::DbSample| s.state != Judged::Proposed;
                let score = |s: &morec_db::labels::DbSample| s.score.unwrap_or(0.0);
                judged(a)
                    .cmp(&judged(b))
                    .then(score(b).total_cmp(&score(a)))
            });
        }
        Self { of_class }
    }

    /// Places of a class's samples.
    pub fn column(&self, class: &str) -> &[usize] {
        self.of_class.get(class).map_or(&[], Vec::as_slice)
    }
}

//! Stretches resampled to an even pace, as points for comparison and grouping.

use morec::cluster::{
    AffinityParams, Clusters, Hierarchy, affinity_propagation, resampled, squared_distance,
};
use morec::features::Rows;

/// Rows of stretches, resampled to one length.
#[derive(Debug, Clone)]
pub struct Shapes(Vec<Vec<f32>>);

impl Shapes {
    /// Rows that a stretch of any length becomes.
    const POINTS: usize = 16;

    /// Of rows that all have the same columns.
    pub fn of<'a>(rows: impl Iterator<Item = &'a Rows>) -> Self {
        Self(rows.map(|rows| resampled(rows, Self::POINTS)).collect())
    }

    fn apart(&self, shape: &[f32], of: usize) -> f64 {
        squared_distance(shape, &self.0[of], Self::POINTS)
    }

    /// Affinity propagation of all, by squared distance.
    pub fn affinity(&self, params: &AffinityParams) -> Clusters {
        let alike = |a: usize, b: usize| -self.apart(&self.0[a], b);
        affinity_propagation(self.0.len(), alike, params)
    }

    /// Average linkage of all.
    pub fn hierarchy(&self) -> Hierarchy {
        let distance = |a: usize, b: usize| self.apart(&self.0[a], b).sqrt();
        Hierarchy::average(self.0.len(), distance)
    }

    /// Some of them in the order of how far they are from their mean, outliers first.
    pub fn outliers_first(&self, mut members: Vec<usize>) -> Vec<usize> {
        let mut mean = vec![0f32; self.0.first().map_or(0, Vec::len)];
        let share = 1.0 / members.len() as f32;
        for member in &members {
            let values = mean.iter_mut().zip(&self.0[*member]);
            values.for_each(|(mean, value)| *mean += share * value);
        }
        let off = |member: &usize| self.apart(&mean, *member);
        members.sort_by(|a, b| off(b).total_cmp(&off(a)));
        members
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::largest_first;

    #[test]
    fn each_group_begins_with_what_is_farthest_from_its_own_mean() {
        let places = [0.0, 0.1, 9.0, -0.8, 9.5, 0.4];
        let rows = places.map(|place| Rows::from_values(1, vec![place; 3]));
        let shapes = Shapes::of(rows.iter());
        let groups = |count: usize| {
            let clusters = shapes.hierarchy().into_clusters(count);
            let groups = largest_first(&clusters).into_iter();
            groups.map(|g| shapes.outliers_first(g)).collect::<Vec<_>>()
        };
        // The means are -0.075 and 9.25: within a group, distance from everything else does not count.
        let two = groups(2);
        assert_eq!(two[0], [3, 5, 1, 0]);
        assert_eq!(two[1].len(), 2);
        // As one group the mean is 3.03.
        assert_eq!(groups(1), [[4, 2, 3, 0, 1, 5]]);
    }
}

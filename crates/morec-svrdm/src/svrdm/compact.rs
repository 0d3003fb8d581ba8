//! A model in the precision of its file, so that what was trained is what will be read.

use crate::pca::Pca;

use super::tree::{Node, Tree};
use super::{ModelError, SegmentDistance, SvrdmModel};

impl SvrdmModel {
    /// This model with every table rounded to single precision, and profiles of whole rows to a byte a value, as an index
    /// file keeps them. What is judged in
    /// training is then what recognises later.
    ///
    /// # Errors
    /// Parts that rounding makes unusable.
    pub fn compact(&self) -> Result<Self, ModelError> {
        let invalid = |e: &dyn std::fmt::Display| ModelError::Value(e.to_string());
        let axes = (0..self.pca.dims())
            .flat_map(|i| single(self.pca.axis(i)))
            .collect();
        let (mean, eigenvalues) = (single(self.pca.mean()), single(self.pca.eigenvalues()));
        let pca =
            Pca::from_parts(mean, axes, eigenvalues, self.pca.rows()).map_err(|e| invalid(&e))?;
        let mut parts = self.tree.parts().clone();
        parts.vectors = single(&parts.vectors);
        for node in &mut parts.nodes {
            if let Node::Branch(branch) = node {
                branch
                    .points
                    .iter_mut()
                    .for_each(|p| *p = p.map(|v| f64::from(v as f32)));
                branch.weights.iter_mut().for_each(|w| *w = single(w));
            }
        }
        let tree = Tree::new(parts).map_err(|e| invalid(&e))?;
        let profiles = match self.params.comparison {
            SegmentDistance::Profiles => self.profiles.clone(),
            SegmentDistance::Rows { .. } => self.profiles.in_steps(),
        };
        Ok(Self {
            pca,
            tree,
            signs: single(&self.signs),
            profiles,
            ..self.clone()
        })
    }
}

fn single(values: &[f64]) -> Vec<f64> {
    values.iter().map(|v| f64::from(*v as f32)).collect()
}

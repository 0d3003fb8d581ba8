//! Distances to each class by the second look, which compares the whole motion.

use crate::features::Rows;
use crate::math::portable;
use crate::templates::TemplateModel;
use crate::templates::second_look::{BodyTrack, Comparison, SecondLook, sample_span, segment_of};

use super::distances::ClipDistances;

/// Of all that moves in a clip, as a sample that is labelled as a whole is taught.
pub fn distances(model: &TemplateModel, look: &SecondLook, rows: &Rows) -> ClipDistances {
    let mut classes = vec![f32::INFINITY; model.classes.len()];
    if !rows.is_empty() {
        let mut body = BodyTrack::new(model.bones, &model.features, rows.len());
        rows.iter().for_each(|row| body.push(row));
        let pace: Vec<f32> = (0..rows.len()).map(|t| body.pace(t as i64)).collect();
        let columns = BodyTrack::columns(model.bones);
        let segment = segment_of(&body, sample_span(&pace), &columns);
        let mut comparison = Comparison::new(look);
        let (distances, score) = comparison.distances_and_score(segment.values());
        for (class, distance) in look.classes.iter().zip(&distances) {
            let least = &mut classes[class.index()];
            *least = least.min(*distance);
        }
        // The score is the logarithm of a share of the nearest distance: at the bound it would be this.
        let nearest = distances.into_iter().fold(f32::MAX, f32::min);
        let accepted = nearest * portable::exp(f64::from(score - look.bound)) as f32;
        classes.iter_mut().for_each(|class| *class /= accepted);
    }
    ClipDistances {
        classes,
        verified: None,
    }
}

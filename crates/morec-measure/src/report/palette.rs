//! A colour for each class, light enough for dark text in both themes.

use std::collections::BTreeMap;

use crate::eval::Evaluation;

/// Colours by class name.
pub(super) struct Palette(BTreeMap<String, String>);

impl Palette {
    /// Hues a golden angle apart: any few neighbours differ well, however many classes there are.
    pub fn new(evaluation: &Evaluation) -> Self {
        let colour = |i: usize| {
            let hue = (210.0 + i as f64 * 137.508) % 360.0;
            let lightness = [70, 60, 78][i % 3];
            format!("hsl({hue:.0} 60% {lightness}%)")
        };
        let names = evaluation.classes.iter().map(|c| c.class.clone());
        Self(
            names
                .enumerate()
                .map(|(i, name)| (name, colour(i)))
                .collect(),
        )
    }

    pub fn colour(&self, class: &str) -> &str {
        self.0.get(class).map_or("#999", String::as_str)
    }

    /// Names and colours, by name.
    pub fn classes(&self) -> impl Iterator<Item = (&str, &str)> {
        self.0
            .iter()
            .map(|(name, colour)| (name.as_str(), colour.as_str()))
    }
}

//! Feature rows in, detections in ticks out.

use crate::classes::ClassId;
use crate::decode::{ClassDistance, Decoder, FAR, TickDetection};
use crate::features::Rows;

use super::{Bank, Metric, TemplateModel, TemplateModelError};

/// Feature rows in, detections in ticks out: the part of recognition that knows no clock.
#[derive(Debug, Clone)]
pub struct TemplateEngine {
    metric: Metric,
    bank: Bank,
    negatives: Bank,
    template_classes: Vec<ClassId>,
    decoder: Decoder,
    mapped: Vec<f32>,
    near: Vec<ClassDistance>,
}

impl TemplateEngine {
    /// Lays the model out for streaming.
    pub fn new(model: &TemplateModel) -> Result<Self, TemplateModelError> {
        model.check()?;
        let metric = Metric::new(&model.ridged, &model.total);
        let map = |rows: &Rows| metric.apply_all(rows);
        let templates: Vec<Rows> = model.samples.iter().map(|s| map(&s.rows)).collect();
        let negatives: Vec<Rows> = model.negatives.iter().map(map).collect();
        let dim = metric.dim();
        Ok(Self {
            bank: Bank::new(&templates, dim),
            negatives: Bank::new(&negatives, dim),
            template_classes: model.samples.iter().map(|s| s.class).collect(),
            decoder: Decoder::new(&model.decode, model.threshold, model.classes.len(), model.longest()),
            mapped: vec![0.0; dim],
            near: vec![ClassDistance { distance: FAR, age: 0 }; model.classes.len()],
            metric,
        })
    }

    /// Forgets the stream so far.
    pub fn reset(&mut self) {
        self.bank.reset();
        self.negatives.reset();
        self.decoder.reset();
    }

    /// Takes the next tick's row; calls `out` with what is now certain.
    pub fn push(&mut self, row: &[f32], out: &mut impl FnMut(TickDetection)) {
        self.metric.apply(row, &mut self.mapped);
        self.bank.step(&self.mapped);
        self.negatives.step(&self.mapped);
        self.near.fill(ClassDistance { distance: FAR, age: 0 });
        for (template, class) in self.template_classes.iter().enumerate() {
            let found = self.bank.matched(template);
            let best = &mut self.near[class.index()];
            if found.distance < best.distance {
                *best = ClassDistance { distance: found.distance, age: found.age };
            }
        }
        let negative =
            (0..self.negatives.len()).map(|i| self.negatives.matched(i).distance).fold(FAR, f32::min);
        self.decoder.push(&self.near, negative, out);
    }

    /// Ends the stretch: calls `out` with what the last ticks still hold.
    pub fn finish(&mut self, out: &mut impl FnMut(TickDetection)) {
        self.decoder.finish(out);
        self.reset();
    }
}

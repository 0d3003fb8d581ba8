//! How fast recognition runs, as a whole and stage by stage.

use std::fmt;
use std::sync::Arc;
use std::time::{Duration, Instant};

use anyhow::Result;
use morec::features::rows_of_clip;
use morec::import::Take;
use morec::live::Model;
use morec::pivots::{PivotMap, pose_rows_of_clip};
use morec::svrdm::{SvrdmEngine, SvrdmModel};
use morec::templates::{TemplateEngine, TemplateModel};

/// Frames and times, summed over clips; all on one thread.
#[derive(Debug, Default)]
pub struct Stats {
    frames: usize,
    reading: Duration,
    whole: Duration,
    features: Duration,
    matching: Duration,
    size: String,
}

impl Stats {
    /// Times reading a file.
    pub fn reading<T>(&mut self, read: impl FnOnce() -> T) -> T {
        timed(&mut self.reading, read)
    }

    /// Times the whole path from poses to detections.
    pub fn recognising<T>(&mut self, frames: usize, recognise: impl FnOnce() -> T) -> T {
        self.frames += frames;
        timed(&mut self.whole, recognise)
    }

    /// Runs the stages once more, one after the other, and times each.
    pub fn stages(&mut self, model: &Model, imported: &Take) -> Result<()> {
        match model {
            Model::Templates(model) => self.template_stages(model, imported),
            Model::Svrdm(model) => self.svrdm_stages(model, imported),
        }
    }

    fn template_stages(&mut self, model: &TemplateModel, imported: &Take) -> Result<()> {
        let (clip, roles, rest) = (&imported.clip, &imported.roles, imported.rest());
        let rows = timed(&mut self.features, || {
            rows_of_clip(clip, roles, rest, model.bones, &model.features)
        });
        let mut engine = TemplateEngine::new(model)?;
        timed(&mut self.matching, || {
            for row in rows.iter() {
                let _ = engine.push(row);
            }
            let _ = engine.finish();
        });
        let template_rows = model.samples.iter().map(|s| s.rows.len()).sum::<usize>()
            + model
                .negatives
                .iter()
                .map(morec::features::Rows::len)
                .sum::<usize>();
        self.size = format!("{template_rows} template rows");
        Ok(())
    }

    fn svrdm_stages(&mut self, model: &Arc<SvrdmModel>, imported: &Take) -> Result<()> {
        let Take {
            clip,
            roles,
            report: facts,
            ..
        } = imported;
        let map = PivotMap::of_clip(&model.pivots, clip, roles)?;
        let rest = &facts.rest_frames;
        let rows = timed(&mut self.features, || {
            pose_rows_of_clip(clip, &model.pivots, &map, rest, &model.pose)
        });
        let mut engine = SvrdmEngine::new(model)?;
        timed(&mut self.matching, || {
            rows.iter().for_each(|row| engine.push(row, &mut |_| {}));
            engine.finish(&mut |_| {});
        });
        self.size = format!(
            "{} classes, {} profiles",
            model.classes.len(),
            model.profiles.len()
        );
        Ok(())
    }
}

fn timed<T>(total: &mut Duration, job: impl FnOnce() -> T) -> T {
    let begun = Instant::now();
    let result = job();
    *total += begun.elapsed();
    result
}

impl fmt::Display for Stats {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(
            f,
            "frames a second on one core ({} frames, {})",
            self.frames, self.size
        )?;
        let stages = [
            ("whole path, poses to detections", self.whole),
            ("  poses to feature rows", self.features),
            ("  rows to detections", self.matching),
            ("reading the files", self.reading),
        ];
        for (name, time) in stages {
            writeln!(
                f,
                "{name:32} {:>12.0}",
                self.frames as f64 / time.as_secs_f64().max(1e-9)
            )?;
        }
        Ok(())
    }
}

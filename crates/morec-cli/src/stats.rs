//! How fast recognition runs, as a whole and stage by stage.

use std::fmt;
use std::time::{Duration, Instant};

use morec::features::rows_of_clip;
use morec::import::Imported;
use morec::templates::{TemplateEngine, TemplateModel, TemplateModelError};

/// Frames and times, summed over clips; all on one thread.
#[derive(Debug, Default)]
pub struct Stats {
    frames: usize,
    reading: Duration,
    whole: Duration,
    features: Duration,
    matching: Duration,
    template_rows: usize,
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
    pub fn stages(&mut self, model: &TemplateModel, imported: &Imported) -> Result<(), TemplateModelError> {
        let Imported { clip, roles, facts } = imported;
        let rest = &facts.rest_frames;
        let rows =
            timed(&mut self.features, || rows_of_clip(clip, roles, rest, model.bones, &model.features));
        let mut engine = TemplateEngine::new(model)?;
        timed(&mut self.matching, || {
            rows.iter().for_each(|row| engine.push(row, &mut |_| {}));
            engine.finish(&mut |_| {});
        });
        self.template_rows = model.samples.iter().map(|s| s.rows.len()).sum::<usize>()
            + model.negatives.iter().map(morec::features::Rows::len).sum::<usize>();
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
            "frames a second on one core ({} frames, {} template rows)",
            self.frames, self.template_rows
        )?;
        let stages = [
            ("whole path, poses to detections", self.whole),
            ("  poses to feature rows", self.features),
            ("  rows to detections", self.matching),
            ("reading the files", self.reading),
        ];
        for (name, time) in stages {
            writeln!(f, "{name:32} {:>12.0}", self.frames as f64 / time.as_secs_f64().max(1e-9))?;
        }
        Ok(())
    }
}

//! §5.5: how long each stage takes, and its memory.

use std::time::{Duration, Instant};

use serde::Serialize;

use morec::features::Rows;
use morec::svrdm::{Stage, SvrdmEngine};
use morec::train::LabelSet;
use morec::train::thesis::{SvrdmOptions, train_svrdm};

use super::study::{ReproduceError, Study, rows_of};
use morec::train::thesis::Setting;

/// Passes over the clips; the one of median time counts.
const PASSES: usize = 5;

/// Time of one stage.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct StageCost {
    /// Its letters in the thesis.
    pub stage: &'static str,
    /// Microseconds a row.
    pub micros: f64,
    /// Share of all stages.
    pub share: f64,
    /// Bytes that it reads and writes.
    pub bytes: usize,
}

/// The stages of a recogniser of all samples, one after the other on one thread.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct StagePerformance {
    /// Setting of the recogniser's training.
    pub setting: Setting,
    /// Rows a second, at the model's rate, of all stages together.
    pub rows_per_second: f64,
    /// The stages in order.
    pub stages: Vec<StageCost>,
}

/// Sums up the time between ends of stages.
#[derive(Debug, Clone)]
pub struct StageClock {
    last: Instant,
    spent: [Duration; Stage::ALL.len()],
}

impl StageClock {
    /// Begins now.
    pub fn new() -> Self {
        Self {
            last: Instant::now(),
            spent: Default::default(),
        }
    }

    /// A part of a stage's work has ended, and what comes next begins.
    pub fn ended(&mut self, stage: Stage) {
        let now = Instant::now();
        self.spent[stage as usize] += now - self.last;
        self.last = now;
    }

    /// Plays rows through a recogniser, stage by stage. Looking at the clock some times a row adds a few hundredths of a
    /// microsecond to each.
    pub fn play(&mut self, engine: &mut SvrdmEngine, rows: &Rows) {
        self.last = Instant::now();
        for row in rows.iter() {
            engine.push_by_stages(row, &mut |stage| self.ended(stage), &mut |_| ());
        }
        engine.finish(&mut |_| ());
        self.ended(Stage::Tracking);
    }

    /// Time of each stage so far.
    pub fn spent(&self) -> [Duration; Stage::ALL.len()] {
        self.spent
    }

    fn total(&self) -> Duration {
        self.spent.iter().sum()
    }
}

impl Default for StageClock {
    fn default() -> Self {
        Self::new()
    }
}

pub(super) fn run(
    study: &Study<'_>,
    (setting, options): &(Setting, SvrdmOptions),
) -> Result<StagePerformance, ReproduceError> {
    let labelling = LabelSet {
        samples: study.samples,
        held_back: &[],
        classes: study.classes,
        unlabelled_is_background: true,
    };
    let (model, _) = train_svrdm(study.clips, &labelling, options, &())?;
    let mut engine =
        SvrdmEngine::new(&model.into()).map_err(|e| ReproduceError::Other(e.to_string()))?;
    let model = engine.model();
    let rows: Result<Vec<Rows>, ReproduceError> = study
        .clips
        .iter()
        .map(|clip| rows_of(clip, &model.pivots, &model.pose))
        .collect();
    let rows = rows?;
    let mut passes: Vec<StageClock> = (0..PASSES)
        .map(|_| {
            let mut clock = StageClock::new();
            rows.iter().for_each(|rows| clock.play(&mut engine, rows));
            clock
        })
        .collect();
    passes.sort_by_key(StageClock::total);
    let clock = &passes[PASSES / 2];
    let count = rows.iter().map(Rows::len).sum::<usize>().max(1) as f64;
    let total = clock.total().as_secs_f64().max(1e-9);
    let stages = Stage::ALL.into_iter().zip(clock.spent());
    let cost = |(stage, spent): (Stage, Duration)| StageCost {
        stage: stage.letters(),
        micros: 1e6 * spent.as_secs_f64() / count,
        share: spent.as_secs_f64() / total,
        bytes: engine.stage_bytes(stage),
    };
    Ok(StagePerformance {
        setting: *setting,
        rows_per_second: count / total,
        stages: stages.map(cost).collect(),
    })
}

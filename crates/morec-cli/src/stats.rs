//! Speed of recognition, in total and by stage.

use std::fmt;
use std::sync::Arc;
use std::time::{Duration, Instant};

use anyhow::Result;
use morec::features::rows_of_clip;
use morec::import::Take;
use morec::kinematics::for_each_world_pose;
use morec::live::{EventOptions, Frame, Model, Performer, PerformerId, Rig};
use morec::pivots::{PivotMap, pose_rows_of_clip};
use morec::svrdm::{Stage, SvrdmEngine, SvrdmModel};
use morec::templates::{AT_ONCE, ClassMatcher, Metric, TemplateEngine, TemplateModel};
use morec_measure::reproduce::StageClock;

/// Frames and times, summed over clips; all on one thread.
#[derive(Debug, Clone, Default)]
pub struct Stats {
    frames: usize,
    reading: Duration,
    whole: Duration,
    /// Poses of joints, from the channels of a clip.
    kinematics: Duration,
    features: Duration,
    /// Rows matched against templates; nothing with the method of 2009, which has stages of its own.
    matching: Duration,
    recognising: Duration,
    /// Frame by frame from poses to events, without and with the progress of every class; nothing with the method of 2009.
    live: [Duration; 2],
    /// Of these, what each stage of the method of 2009 takes, and its bytes.
    stages: Option<StageTimes>,
    size: String,
}

/// Stages of the method of 2009, in the order of [`Stage::ALL`].
#[derive(Debug, Clone)]
struct StageTimes {
    clock: StageClock,
    bytes: [usize; Stage::ALL.len()],
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
        timed(&mut self.kinematics, || {
            for_each_world_pose(&imported.clip, imported.rest(), |_, world| {
                std::hint::black_box(world);
            });
        });
        match model {
            Model::Templates(templates) => {
                self.stream(model, imported);
                self.template_stages(templates, imported)
            }
            Model::Svrdm(model) => self.svrdm_stages(model, imported),
        }
    }

    /// Streams a clip frame by frame, without and with the progress of every class.
    fn stream(&mut self, model: &Model, imported: &Take) {
        let Take { clip, roles, .. } = imported;
        let rig = Arc::new(Rig {
            skeleton: clip.skeleton.clone(),
            roles: roles.clone(),
        });
        let mut frames = Vec::with_capacity(clip.frames);
        for_each_world_pose(clip, imported.rest(), |time_secs, world| {
            frames.push(Frame {
                time_secs,
                wall_secs: time_secs,
                actor: PerformerId(0),
                pose: world.clone(),
            });
        });
        for (progress, total) in [false, true].into_iter().zip(&mut self.live) {
            let options = EventOptions {
                progress,
                ..EventOptions::default()
            };
            let mut performer = Performer::new(model, PerformerId(0), &options);
            performer.set_rig(&rig);
            // The first frame makes the recogniser.
            let mut left = frames.iter();
            left.next().map(|first| performer.push(first).len());
            timed(total, || {
                for frame in left {
                    std::hint::black_box(performer.push(frame));
                }
                std::hint::black_box(performer.finish());
            });
        }
    }

    fn template_stages(&mut self, model: &TemplateModel, imported: &Take) -> Result<()> {
        let (clip, roles, rest) = (&imported.clip, &imported.roles, imported.rest());
        let rows = timed(&mut self.features, || {
            rows_of_clip(clip, roles, rest, model.bones, &model.features)
        });
        let metric = Metric::new(&model.ridged, &model.total);
        let mut matcher = ClassMatcher::new(model, &metric);
        timed(&mut self.matching, || {
            for ticks in rows.values().chunks(AT_ONCE * rows.dim()) {
                matcher.advance(ticks);
                (0..ticks.len() / rows.dim()).for_each(|at| matcher.look(at));
            }
        });
        let mut engine = TemplateEngine::new(model)?;
        timed(&mut self.recognising, || {
            engine.detect(&rows, |detection| {
                std::hint::black_box(detection);
            });
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
        timed(&mut self.recognising, || {
            rows.iter().for_each(|row| engine.push(row, &mut |_| {}));
            engine.finish(&mut |_| {});
        });
        let times = self.stages.get_or_insert_with(|| StageTimes {
            clock: StageClock::new(),
            bytes: Stage::ALL.map(|stage| engine.stage_bytes(stage)),
        });
        times.clock.play(&mut engine, &rows);
        self.size = format!(
            "{} classes, {} profiles",
            model.classes.len(),
            model.profiles.len()
        );
        Ok(())
    }
}

/// What the thesis prints of its stages (Table 5.8, §5.5).
const THESIS: &str = "in 2009 on six processors of a Cell, 4,487 frames a second (Table 5.8):\n\
    \x20 stage                         IA      SA     FVE      SC      SS      ST\n\
    \x20 code and data, KB         148.33  126.84  149.22  140.08  147.73  102.08\n\
    \x20 clocks per instruction      1.84    1.92    1.82    1.86    1.21    2.02\n";

fn timed<T>(total: &mut Duration, job: impl FnOnce() -> T) -> T {
    let begun = Instant::now();
    let result = job();
    *total += begun.elapsed();
    result
}

impl Stats {
    /// Frames of all clips.
    pub fn frames(&self) -> usize {
        self.frames
    }

    /// Time of the whole path from poses to detections.
    pub fn whole(&self) -> Duration {
        self.whole
    }

    /// Times of the stages of the whole path, and of it. Forward kinematics is part of making rows, and matching part of recognising.
    fn times(&self) -> Vec<(String, Duration, Option<usize>)> {
        let rest = |all: Duration, part: Duration| all.saturating_sub(part);
        let named = |name: &str, time| (name.to_owned(), time, None);
        let mut times = vec![
            named("poses of joints", self.kinematics),
            named(
                "poses to feature rows",
                rest(self.features, self.kinematics),
            ),
        ];
        match &self.stages {
            Some(StageTimes { clock, bytes }) => {
                times.push(named("rows to detections", self.recognising));
                let stages = Stage::ALL.into_iter().zip(clock.spent()).zip(bytes);
                times.extend(stages.map(|((stage, time), bytes)| {
                    let name = format!("  {:3} {}", stage.letters(), stage.name());
                    (name, time, Some(*bytes))
                }));
            }
            None => times.extend([
                named("rows to matches of classes", self.matching),
                named(
                    "matches to detections",
                    rest(self.recognising, self.matching),
                ),
            ]),
        }
        times.push(named("whole path, poses to detections", self.whole));
        times
    }
}

impl fmt::Display for Stats {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { frames, size, .. } = self;
        let whole = self.whole.as_secs_f64().max(1e-9);
        writeln!(f, "one core, {frames} frames, {size}")?;
        writeln!(
            f,
            "{:32} {:>12} {:>8} {:>16}{}",
            "stage",
            "µs a frame",
            "share",
            "frames a second",
            self.stages.as_ref().map_or("", |_| "    bytes")
        )?;
        let mut line = |name: &str, time: Duration, share: &str, bytes: Option<usize>| {
            let secs = time.as_secs_f64();
            let of_frame = secs * 1e6 / (*frames).max(1) as f64;
            // A difference of two times may be lost in their noise.
            let rate = match time.is_zero() {
                true => "–".to_owned(),
                false => format!("{:.0}", *frames as f64 / secs),
            };
            let bytes = bytes.map_or(String::new(), |bytes| format!(" {bytes:>8}"));
            writeln!(f, "{name:32} {of_frame:>12.2} {share:>8} {rate:>16}{bytes}")
        };
        line("reading the files", self.reading, "", None)?;
        for (name, time, bytes) in self.times() {
            let share = format!("{:.1} %", 100.0 * time.as_secs_f64() / whole);
            line(&name, time, &share, bytes)?;
        }
        let [live, progress] = self.live;
        if !live.is_zero() {
            line("live, frame by frame", live, "", None)?;
            let times = progress.as_secs_f64() / live.as_secs_f64();
            let name = "the same, progress of every class";
            line(name, progress, &format!("× {times:.2}"), None)?;
        }
        if self.stages.is_some() {
            f.write_str(THESIS)?;
        }
        Ok(())
    }
}

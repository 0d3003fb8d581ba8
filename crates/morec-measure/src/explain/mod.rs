//! Explanations: why a labelled motion was not reported, and how well a reported motion was performed.
//!
//! The stream is compared with the index once more, and the nearest match of the sample's class within the sample is
//! followed through the conditions of [`decode`](morec::decode) in their order. The first that fails is the reason.

mod bones;
mod deviation;
mod reason;
mod tried;

#[cfg(test)]
mod tests;

use std::ops::Range;

use morec::TimeSpan;
use morec::classes::ClassId;
use morec::clip::{Clip, Span};
use morec::decode::FAR;
use morec::features::{RowLayout, Rows, all_bones_of_clip, rows_of_clip};
use morec::labels::Mark;
use morec::live::{Detection, Model};
use morec::roles::RoleMap;
use morec::templates::second_look::{
    BodyTrack, Comparison, Judged, SecondLook, grown_of, segment_of,
};
use morec::templates::{
    Activities, Nearest, OperatingPoint, PerformerKind, PerformerLevel, StrangerGate,
    TemplateModel, Trace,
};
use morec::train::overlap_share;

pub use deviation::{Performance, deviation};
pub use morec::templates::{BoneDeviation, MotionDeviation, deviation_from};
pub use reason::{BoneOff, Reason};

/// A sample that was not reported.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct Miss {
    /// The clip's name.
    pub clip: String,
    /// Name of the class.
    pub class: String,
    /// The sample's time.
    #[serde(flatten)]
    pub span: TimeSpan,
    /// Reason why it was not reported.
    pub reason: Reason,
    /// The least noted rate of false alarms a minute at which it is reported, if the threshold was the reason and one of
    /// them helps: each is tried.
    pub sensitivity: Option<f64>,
}

/// A match belongs to a sample if it shares more than this part of the shorter of the two with it.
const BELONGS: f64 = 0.5;

/// Says of each of `sought`, labelled stretches of `clip`, why it was missed; `found` is what was recognised. Empty for the method of 2009,
/// whose decisions are in its own report. `rest` are the frames that a conversion left at the start.
/// O(frames · template rows · d), again for each rate of false alarms that may help.
pub fn explain(
    model: &Model,
    clip: (&Clip, &RoleMap, &Span),
    sought: &[Mark<&str>],
    found: &[Detection],
) -> Vec<Miss> {
    let Model::Templates(model) = model else {
        return Vec::new();
    };
    let (whole, played) = (model, clip);
    let (clip, roles, rest) = clip;
    if sought.is_empty() {
        return Vec::new();
    }
    let miss = |sought: &Mark<&str>, (reason, sensitivity)| Miss {
        clip: clip.name.clone(),
        class: sought.class.to_owned(),
        span: sought.span,
        reason,
        sensitivity,
    };
    let roles = &roles.for_bones(&clip.skeleton, model.bones);
    let bones = all_bones_of_clip(clip, roles, rest);
    let Ok(model) = model.restricted(bones) else {
        let unseen = |s| miss(s, (Reason::Unseen, None));
        return sought.iter().map(unseen).collect();
    };
    let rows = rows_of_clip(clip, roles, rest, model.bones, &model.features);
    let Ok(trace) = Trace::of(&model, &rows) else {
        return Vec::new();
    };
    let mut stream = ComparedStream {
        model: &model,
        rows: &rows,
        trace,
        found,
        open: None,
        whole: WholeMotions::of(&model, &rows),
    };
    let reasons = sought.iter().map(|s| stream.reason(s));
    let (reasons, wanted): (Vec<Reason>, Vec<Option<f64>>) = reasons.unzip();
    let rates = tried::least_that_help(whole, played, sought, wanted);
    let said = sought.iter().zip(reasons.into_iter().zip(rates));
    said.map(|(sought, reason)| miss(sought, reason)).collect()
}

/// A stream that was compared with a model.
struct ComparedStream<'a> {
    model: &'a TemplateModel,
    rows: &'a Rows,
    trace: Trace<'a>,
    found: &'a [Detection],
    /// The wider gate, where it was open at the sample.
    open: Option<&'a StrangerGate>,
    /// What whole motions are judged by, where they are.
    whole: Option<WholeMotions<'a>>,
}

/// A stream's body, and what the second look compares its segments with.
struct WholeMotions<'a> {
    look: &'a SecondLook,
    body: BodyTrack,
    columns: Vec<usize>,
    comparison: Comparison,
}

impl<'a> WholeMotions<'a> {
    fn of(model: &'a TemplateModel, rows: &Rows) -> Option<Self> {
        let look = model.look.as_ref()?;
        let mut body = BodyTrack::new(model.bones, &model.features, rows.len());
        rows.iter().for_each(|row| body.push(row));
        Some(Self {
            look,
            body,
            columns: BodyTrack::columns(model.bones),
            comparison: Comparison::new(look),
        })
    }

    /// The motion around `ticks`, by the better of its two growths.
    fn judge(&mut self, ticks: &Range<usize>) -> Judged {
        let [short, long] = grown_of(&self.body, ticks).map(|extent| {
            let segment = segment_of(&self.body, extent, &self.columns);
            self.comparison.judge(segment.values())
        });
        if long.score > short.score {
            long
        } else {
            short
        }
    }
}

impl<'a> ComparedStream<'a> {
    /// The wider gate if it was open when the sample began: as the motions that were reported before let it.
    fn open_gate(&self, sought: &Mark<&str>) -> Option<&'a StrangerGate> {
        let gate = self.model.stranger.as_ref()?;
        let hz = self.model.features.tick_hz();
        let mut level = PerformerLevel::new(gate);
        let before = self
            .found
            .iter()
            .filter(|d| d.reported_secs <= sought.span.start_secs);
        for detection in before.filter(|_| gate.performer == PerformerKind::Auto) {
            let tick = (detection.span.stop_secs * hz).round() as usize;
            let last = tick
                .saturating_sub(1)
                .min(self.trace.ticks().saturating_sub(1));
            let near = self.trace.nearest(last, detection.class).comparison;
            let discount = if level.is_open() { gate.discount } else { 0.0 };
            level.note(near.discounted(discount).distance, gate);
        }
        level.is_open().then_some(gate)
    }

    fn reason(&mut self, sought: &Mark<&str>) -> (Reason, Option<f64>) {
        let named = |c: &morec::classes::ClassInfo| c.name == sought.class;
        let Some(class) = self.model.classes.iter().position(named) else {
            return (Reason::NoSuchClass, None);
        };
        let class = ClassId(class as u16);
        let ticks = self.ticks_of(sought);
        if let Some(activities) = self.model.activities.as_ref().filter(|a| a.holds(class)) {
            let kept_out = self.activity(activities, &ticks, class);
            return (
                kept_out.unwrap_or_else(|| self.neighbour(sought, class)),
                None,
            );
        }
        if let Some(whole) = &mut self.whole {
            let (look, judged) = (whole.look, whole.judge(&ticks));
            return self.as_a_whole((look, judged), sought, (class, &ticks));
        }
        self.open = self.open_gate(sought);
        let Some((_, any)) = self.best(&ticks, |t| self.trace.nearest(t, class)) else {
            return (Reason::NoMatch, None);
        };
        let threshold = match &self.model.verifier {
            Some(verifier) => verifier.reach,
            None => self.threshold(class),
        };
        let counted = self.best(&ticks, |t| self.counted(t, class));
        let Some((tick, near)) = counted.filter(|(_, n)| n.comparison.distance < threshold) else {
            let unlike = self.unlike(&ticks, class).map(|reason| (reason, None));
            return unlike.unwrap_or_else(|| self.not_near(&ticks, class, any, threshold));
        };
        let reason = match self.trace.verify(tick, class) {
            Some((score, evidence)) if score <= 0.0 => Reason::Refused {
                score,
                other: evidence.other / evidence.distance,
                background: evidence.negative / evidence.distance,
            },
            Some(_) => self.neighbour(sought, class),
            None => self
                .nearer_elsewhere(tick, class, near)
                .unwrap_or_else(|| self.neighbour(sought, class)),
        };
        (reason, None)
    }

    /// What kept a motion from being reported that was `judged` as a whole.
    fn as_a_whole(
        &self,
        (look, judged): (&SecondLook, Judged),
        sought: &Mark<&str>,
        (class, ticks): (ClassId, &Range<usize>),
    ) -> (Reason, Option<f64>) {
        let Some((_, any)) = self.best(ticks, |t| self.trace.nearest(t, class)) else {
            return (Reason::NoMatch, None);
        };
        let Judged {
            class: named,
            score,
        } = judged;
        if score <= look.bound || named != class {
            let name = || self.model.classes[named.index()].name.clone();
            let reason = Reason::Whole {
                score,
                bound: look.bound,
                other: (named != class).then(name),
            };
            let enough = look.operating.iter().filter(|p| score > p.threshold);
            let rate = enough.map(|p| p.alarms_per_minute).min_by(f64::total_cmp);
            return (reason, rate.filter(|_| named == class));
        }
        let near = any.comparison;
        if near.distance < look.reach && !near.moves(self.model.decode.rest_gate) {
            let reason = Reason::Still {
                share: near.rest_share,
                most: self.model.decode.rest_gate,
            };
            return (reason, None);
        }
        (self.neighbour(sought, class), None)
    }

    /// What kept an activity from being recognised in `ticks`.
    fn activity(
        &self,
        activities: &Activities,
        ticks: &Range<usize>,
        class: ClassId,
    ) -> Option<Reason> {
        let hz = self.model.features.tick_hz();
        let (secs, least_secs) = (ticks.len() as f64 / hz, Activities::LEAST_TICKS as f64 / hz);
        if secs < least_secs {
            return Some(Reason::Short { secs, least_secs });
        }
        let rows = self.rows.slice(ticks.clone());
        let shares = activities.shares(RowLayout::of(self.model.bones), &rows);
        let own = shares.iter().find(|(of, _)| *of == class)?.1;
        let nearest = shares.iter().min_by(|a, b| a.1.total_cmp(&b.1))?;
        let name = |of: ClassId| self.model.classes[of.index()].name.clone();
        let nearer = (nearest.0 != class).then(|| (name(nearest.0), nearest.1));
        let unlike = own >= 1.0 || nearer.is_some();
        unlike.then_some(Reason::GoesOnUnlike { share: own, nearer })
    }

    /// The sample would have passed the relaxed gate, which was closed.
    fn unlike(&self, ticks: &Range<usize>, class: ClassId) -> Option<Reason> {
        let gate = self.model.stranger.as_ref()?;
        let (_, near) = self.best(ticks, |t| self.trace.wide(t, class))?;
        let distance = near.comparison.distance;
        (self.open.is_none() && distance < gate.threshold).then_some(Reason::Unlike {
            distance,
            threshold: gate.threshold,
        })
    }

    /// The ticks of a sample that lie in the stream.
    fn ticks_of(&self, sought: &Mark<&str>) -> Range<usize> {
        let hz = self.model.features.tick_hz();
        sought.span.frames_among(self.rows.len(), hz)
    }

    /// The nearest match of a class that ends at `tick` and passes the gate that held at the sample.
    fn counted(&self, tick: usize, class: ClassId) -> Nearest {
        match self.open {
            Some(_) => self.trace.wide(tick, class),
            None => self.trace.moving(tick, class),
        }
    }

    fn threshold(&self, class: ClassId) -> f32 {
        if let Some(gate) = self.open {
            return gate.threshold;
        }
        let own = self.model.class_thresholds.get(class.index());
        own.copied().unwrap_or(self.model.threshold)
    }

    /// The nearest match that belongs to `ticks`, and the tick at which it ends.
    fn best(
        &self,
        ticks: &Range<usize>,
        near: impl Fn(usize) -> Nearest,
    ) -> Option<(usize, Nearest)> {
        let last = (ticks.end + ticks.len()).min(self.trace.ticks());
        let belongs = |(t, n): &(usize, Nearest)| {
            let stretch = t - n.comparison.age.min(*t)..t + 1;
            n.comparison.distance < FAR && overlap_share(&stretch, ticks) > BELONGS
        };
        (ticks.start..last)
            .map(|t| (t, near(t)))
            .filter(belongs)
            .min_by(|a, b| a.1.comparison.distance.total_cmp(&b.1.comparison.distance))
    }

    /// No match is both moving and within the threshold.
    fn not_near(
        &self,
        ticks: &Range<usize>,
        class: ClassId,
        any: Nearest,
        threshold: f32,
    ) -> (Reason, Option<f64>) {
        let plain = self.model.decode.rest_share(self.model.rule());
        let (gate, discount) = match self.open {
            Some(open) => (open.rest_gate, open.discount),
            None => (plain, 0.0),
        };
        let any = Nearest {
            comparison: any.comparison.discounted(discount),
            ..any
        };
        if any.comparison.distance < threshold && !any.comparison.moves(gate) {
            let reason = Reason::Still {
                share: any.comparison.rest_share,
                most: gate,
            };
            return (reason, None);
        }
        let moving = self.best(ticks, |t| self.counted(t, class));
        let near_any = |t| self.trace.nearest(t, class);
        let Some((tick, near)) = moving.or_else(|| self.best(ticks, near_any)) else {
            return (Reason::NoMatch, None);
        };
        let distance = near.comparison.distance;
        let first = tick - near.comparison.age.min(tick);
        let template = &self.model.samples[near.template].rows;
        let reason = Reason::Far {
            distance,
            threshold,
            bones: bones::farthest(
                template,
                &self.rows.slice(first..tick + 1),
                self.model.bones,
            ),
        };
        // Under a verifier, other rates move its bar; what is too far to be looked at stays so.
        let rate = match self.model.verifier {
            Some(_) => None,
            None => {
                let points = self
                    .open
                    .map_or(&self.model.operating, |gate| &gate.operating);
                least_rate(points, distance)
            }
        };
        (reason, rate)
    }

    /// Background motion, or another class, that is nearer at the end of the match.
    fn nearer_elsewhere(&self, tick: usize, class: ClassId, near: Nearest) -> Option<Reason> {
        let decode = &self.model.decode;
        let distance = near.comparison.distance;
        let (negative, rival_share) = match self.open {
            Some(gate) => (self.trace.wide_negative(tick), gate.rival_share),
            None => (self.trace.negative(tick), decode.rival_share),
        };
        if distance >= decode.gate * negative {
            return Some(Reason::Background { distance, negative });
        }
        let around = tick.saturating_sub(decode.rival_ticks)
            ..=(tick + decode.rival_ticks).min(self.trace.ticks() - 1);
        let others = (0..self.model.classes.len()).filter(|c| *c != class.index());
        let rivals = others.flat_map(|c| {
            let of = ClassId(c as u16);
            around
                .clone()
                .map(move |t| (c, self.counted(t, of).comparison.distance))
        });
        let (rival, rival_distance) = rivals.min_by(|a, b| a.1.total_cmp(&b.1))?;
        (rival_distance < rival_share * distance).then(|| Reason::OtherClass {
            class: self.model.classes[rival].name.clone(),
            distance,
            other: rival_distance,
        })
    }

    /// A detection that took the sample's place.
    fn neighbour(&self, sought: &Mark<&str>, class: ClassId) -> Reason {
        let slack = self.model.decode.tail_ticks as f64 / self.model.features.tick_hz();
        let reach = |d: &Detection| TimeSpan {
            stop_secs: d.span.stop_secs + slack,
            ..d.span
        };
        // Below 0 where only the slack reaches.
        let shared = |d: &Detection| {
            let (a, b) = (d.span, sought.span);
            a.stop_secs.min(b.stop_secs) - a.start_secs.max(b.start_secs)
        };
        let nearest = self
            .found
            .iter()
            .filter(|d| reach(d).overlaps(sought.span))
            .max_by(|a, b| shared(a).total_cmp(&shared(b)));
        match nearest {
            Some(d) => Reason::Neighbour {
                same: d.class == class,
                class: self.model.classes[d.class.index()].name.clone(),
                span: d.span,
            },
            None => Reason::Elsewhere,
        }
    }
}

/// The least noted rate whose threshold lies above `distance`.
fn least_rate(points: &[OperatingPoint], distance: f32) -> Option<f64> {
    let enough = points.iter().filter(|p| distance < p.threshold);
    enough.map(|p| p.alarms_per_minute).min_by(f64::total_cmp)
}

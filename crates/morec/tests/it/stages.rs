//! The thesis's layout, a thread for each stage: events are those of the inline layout.

use std::sync::{Arc, OnceLock};
use std::time::Duration;

use morec::features::MAX_GAP_SECS;
use morec::kinematics::WorldPose;
use morec::live::{
    Event, EventOptions, Frame, Model, OverflowPolicy, PerformerId, Phase, Rig, Session,
    SessionError, SessionOptions, Source, SourceEvent, Status, Threading, recognize_clip,
    recognize_clip_in_session,
};
use morec::roles::RoleMap;
use morec::synth::SyntheticTake;
use morec::train::thesis::SvrdmTrainParams;
use proptest::prelude::*;

use crate::made;
use crate::thesis_people::{takes, trained};

/// Steps of a source, as plain data, so that the same stream can be had twice.
#[derive(Clone)]
enum Step {
    Rig(u16, Arc<Rig>),
    Frame(Box<Frame>),
    Gone(u16),
    Quiet,
}

struct Scripted(std::vec::IntoIter<Step>);

impl Source for Scripted {
    fn next(&mut self, frame: &mut Frame) -> SourceEvent {
        match self.0.next() {
            Some(Step::Rig(actor, rig)) => SourceEvent::Rig(PerformerId(actor), rig),
            Some(Step::Frame(next)) => {
                *frame = *next;
                SourceEvent::Frame
            }
            Some(Step::Gone(actor)) => SourceEvent::Gone(PerformerId(actor)),
            Some(Step::Quiet) => SourceEvent::Quiet,
            None => SourceEvent::Ended,
        }
    }
}

fn tuned() -> Model {
    static MODEL: OnceLock<Model> = OnceLock::new();
    MODEL
        .get_or_init(|| trained(SvrdmTrainParams::tuned()).0)
        .clone()
}

fn rig_of(take: &SyntheticTake) -> Arc<Rig> {
    let skeleton = take.clip.skeleton.clone();
    let roles = RoleMap::find(&skeleton);
    Arc::new(Rig { skeleton, roles })
}

/// A take performed by `actor`, from `origin_secs` on, at `speed`.
fn frames(take: &SyntheticTake, actor: u16, origin_secs: f64, speed: f64) -> Vec<Step> {
    let frame = |number: usize| {
        let time_secs = origin_secs + number as f64 / take.clip.rate_hz / speed;
        let pose = WorldPose::of(&take.clip, number);
        Step::Frame(Box::new(Frame {
            time_secs,
            wall_secs: 1e9 + time_secs,
            actor: PerformerId(actor),
            pose,
        }))
    };
    (0..take.clip.frames).map(frame).collect()
}

fn run(
    model: &Model,
    layout: Threading,
    steps: &[Step],
    events: EventOptions,
) -> (Vec<Event>, Status) {
    let played: Vec<Step> = steps.into();
    let source = Box::new(Scripted(played.into_iter()));
    let options = SessionOptions {
        layout,
        events,
        frame_capacity: 9,
        ..Default::default()
    };
    let (session, mut readers) = Session::start(model, source, &options).unwrap();
    let (mut reader, mut found) = (readers.pop().unwrap(), vec![]);
    while !reader.is_ended() {
        found.extend(reader.wait(Duration::from_secs(60)));
    }
    (found, session.join())
}

/// Whatever can happen in a stream: two performers, gaps, clocks that begin anew, late frames, frames without a
/// skeleton, one without joints, performers that go and come back or are beyond all that can be.
fn eventful() -> Vec<Step> {
    let (a, b) = (&takes()[0], &takes()[1]);
    let mut steps = frames(a, 0, 0.0, 1.0)[..40].to_vec();
    steps.extend([Step::Rig(0, Arc::default()), Step::Rig(5, rig_of(b))]);
    steps.extend_from_slice(&frames(a, 0, 0.0, 1.0)[..40]);
    steps.push(Step::Rig(0, rig_of(a)));
    let (mut of_a, of_b) = (frames(a, 0, 3.0, 1.0), frames(b, 5, 100.0, 0.93));
    let gap = (
        of_a.len() / 2,
        (a.clip.rate_hz * MAX_GAP_SECS * 1.5) as usize,
    );
    of_a.drain(gap.0..gap.0 + gap.1);
    of_a.drain(50..53);
    of_a.swap(70, 75);
    for at in 0..of_a.len().max(of_b.len()) {
        steps.extend(of_a.get(at).into_iter().chain(of_b.get(at)).cloned());
    }
    steps.extend([Step::Gone(0), Step::Quiet, Step::Gone(999)]);
    steps.extend(frames(b, 999, 0.0, 1.0).into_iter().take(9));
    steps.extend(frames(a, 0, 0.0, 1.1));
    steps.push(Step::Rig(5, rig_of(a)));
    steps.extend(frames(a, 5, 0.0, 1.0));
    steps
}

#[test]
fn events_are_those_of_the_inline_layout_to_the_bit() {
    let steps = eventful();
    let given = steps
        .iter()
        .filter(|step| matches!(step, Step::Frame(_)))
        .count() as u64;
    for model in [trained(SvrdmTrainParams::faithful()).0, tuned()] {
        for refractory_secs in [0.0, 5.0] {
            let events = EventOptions {
                tentative: true,
                refractory_secs,
                ..EventOptions::default()
            };
            let (inline, by_one) = run(&model, Threading::Inline, &steps, events.clone());
            let (staged, by_many) = run(&model, Threading::Stages, &steps, events);
            assert_eq!(staged, inline);
            assert!(
                inline.len() >= 6 && inline.iter().all(|e| e.phase == Phase::End),
                "{}",
                inline.len()
            );
            for status in [&by_one, &by_many] {
                assert!(status.ended && status.frames == given && status.waits.frames() == given);
            }
            let counts = |s: &Status| {
                (
                    s.unusable_frames,
                    s.events,
                    s.motions,
                    s.suppressed,
                    s.actors.len(),
                )
            };
            assert_eq!(counts(&by_many), counts(&by_one));
            assert!(
                refractory_secs > 0.0 || by_many.suppressed == 0,
                "{by_many:?}"
            );
        }
    }
}

#[test]
fn a_clip_recognised_in_stages_has_the_detections_it_has_inline() {
    let model = tuned();
    for take in takes() {
        let roles = RoleMap::find(&take.clip.skeleton);
        let inline = recognize_clip(&model, &take.clip, &roles, &(0..0)).unwrap();
        for layout in [Threading::Inline, Threading::Stages] {
            let options = SessionOptions {
                layout,
                ..Default::default()
            };
            let found =
                recognize_clip_in_session(&model, &take.clip, &roles, &(0..0), &options).unwrap();
            assert_eq!(found, inline, "{layout:?}");
        }
    }
}

/// Whoever ties threads to cores hears of each once, on that thread.
#[test]
fn every_thread_says_what_it_is_for() {
    static HEARD: std::sync::Mutex<Vec<(String, &str)>> = std::sync::Mutex::new(Vec::new());
    fn hear(what: &'static str) {
        let thread = std::thread::current().name().unwrap_or_default().to_owned();
        HEARD.lock().unwrap().push((thread, what));
    }
    let options = SessionOptions {
        layout: Threading::Stages,
        on_thread: Some(hear),
        ..Default::default()
    };
    let source = Box::new(Scripted(vec![].into_iter()));
    let (session, readers) = Session::start(&tuned(), source, &options).unwrap();
    drop(readers);
    session.join();
    let mut heard = HEARD.lock().unwrap().clone();
    heard.sort();
    let stages = [
        "classification",
        "extraction",
        "input",
        "scoring",
        "segments",
        "source",
        "tracking",
    ];
    assert_eq!(heard, stages.map(|what| (format!("morec {what}"), what)));
}

#[test]
fn a_method_without_stages_is_refused() {
    let options = SessionOptions {
        layout: Threading::Stages,
        ..Default::default()
    };
    let started = Session::start(
        &made::model(),
        Box::new(Scripted(vec![].into_iter())),
        &options,
    );
    let error = started.map(|_| ()).unwrap_err();
    assert!(
        matches!(
            error,
            SessionError::NoStages {
                method: "templates"
            }
        ),
        "{error}"
    );
}

#[test]
fn stages_that_are_stopped_end_though_nobody_reads_and_the_source_goes_on_for_ever() {
    struct Endless(Vec<Step>, usize);
    impl Source for Endless {
        fn next(&mut self, frame: &mut Frame) -> SourceEvent {
            self.1 += 1;
            match &self.0[(self.1 - 1) % self.0.len()] {
                Step::Rig(actor, rig) => SourceEvent::Rig(PerformerId(*actor), rig.clone()),
                Step::Frame(next) => {
                    frame.clone_from(next);
                    frame.time_secs += (self.1 / self.0.len()) as f64 * 100.0;
                    SourceEvent::Frame
                }
                Step::Gone(_) | Step::Quiet => SourceEvent::Quiet,
            }
        }
    }
    let model = tuned();
    let mut steps = vec![Step::Rig(0, rig_of(&takes()[0]))];
    steps.extend(frames(&takes()[0], 0, 0.0, 1.0));
    for overload in [OverflowPolicy::Wait, OverflowPolicy::Drop] {
        let options = SessionOptions {
            layout: Threading::Stages,
            overload,
            ..Default::default()
        };
        let source = Box::new(Endless(steps.clone(), 0));
        let (session, readers) = Session::start(&model, source, &options).unwrap();
        while session.status().motions == 0 {
            std::thread::sleep(Duration::from_millis(5));
        }
        assert!(session.stop().ended);
        drop(readers);
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 8, failure_persistence: None, ..Default::default() })]

    /// Whatever order frames, skeletons and goings come in.
    #[test]
    fn any_order_of_things_gives_the_events_of_the_inline_layout(
        order in prop::collection::vec((0u8..12, 0u16..3, 0usize..400), 5..40),
    ) {
        let model = tuned();
        let mut steps = vec![Step::Rig(0, rig_of(&takes()[0])), Step::Rig(1, rig_of(&takes()[1]))];
        for (kind, actor, at) in order {
            let take = &takes()[at % takes().len()];
            match kind {
                0 => steps.push(Step::Gone(actor)),
                1 => steps.push(Step::Rig(actor, rig_of(take))),
                _ => {
                    let frames = frames(take, actor, at as f64 / 10.0, 1.0);
                    steps.extend(frames.into_iter().skip(at / 2).take(150));
                }
            }
        }
        let inline = run(&model, Threading::Inline, &steps, EventOptions::default()).0;
        let staged = run(&model, Threading::Stages, &steps, EventOptions::default()).0;
        prop_assert_eq!(staged, inline);
    }
}

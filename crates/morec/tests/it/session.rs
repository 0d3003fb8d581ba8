//! Sessions: faults of their source, counts of dropped frames, status and events.

use std::sync::Arc;
use std::time::Duration;

use morec::features::{BoneSet, KeyPose};
use morec::live::{
    Event, EventOptions, EventReader, Frame, OverflowPolicy, PerformerId, Phase, Rig, Session,
    SessionOptions, Source, SourceEvent,
};
use morec::math::Vec3;
use morec::roles::Role;
use morec::templates::TemplateModel;

use crate::engines::{Played, ended, inline};
use crate::made::{self, Timed};

pub fn stream() -> Vec<Timed> {
    made::poses(&made::performance(60.0)).1
}

fn all(mut reader: EventReader) -> Vec<Event> {
    let mut events = Vec::new();
    while !reader.is_ended() {
        events.extend(reader.wait(Duration::from_secs(60)));
    }
    events
}

/// Whatever `steps` say, in turn.
struct Scripted(std::vec::IntoIter<Step>);

enum Step {
    Rig(u16, Arc<Rig>),
    Frames(u16, Vec<Timed>),
    Gone(u16),
    Quiet,
}

fn rig(actor: u16, rig: Rig) -> Step {
    Step::Rig(actor, Arc::new(rig))
}

impl Source for Scripted {
    fn next(&mut self, frame: &mut Frame) -> SourceEvent {
        match self.0.as_mut_slice().first_mut() {
            Some(Step::Frames(actor, poses)) if !poses.is_empty() => {
                let (time_secs, pose) = poses.remove(0);
                frame.set_key_pose(&pose);
                (frame.time_secs, frame.actor) = (time_secs, PerformerId(*actor));
                return SourceEvent::Frame;
            }
            _ => {}
        }
        match self.0.next() {
            Some(Step::Rig(actor, rig)) => SourceEvent::Rig(PerformerId(actor), rig),
            Some(Step::Gone(actor)) => SourceEvent::Gone(PerformerId(actor)),
            Some(Step::Frames(..) | Step::Quiet) => SourceEvent::Quiet,
            None => SourceEvent::Ended,
        }
    }
}

fn tentative() -> EventOptions {
    EventOptions {
        tentative: true,
        ..EventOptions::default()
    }
}

fn run(steps: Vec<Step>) -> (Vec<Event>, morec::live::Status) {
    run_with(&made::model(), tentative(), steps)
}

fn run_with(
    model: &Arc<TemplateModel>,
    events: EventOptions,
    steps: Vec<Step>,
) -> (Vec<Event>, morec::live::Status) {
    let source = Box::new(Scripted(steps.into_iter()));
    let options = SessionOptions {
        events,
        ..Default::default()
    };
    let (session, readers) = Session::start(model, source, &options).unwrap();
    let events = readers.into_iter().map(all).next().unwrap();
    (events, session.join())
}

#[test]
fn a_source_that_breaks_off_changes_its_skeleton_and_sends_rubbish_does_not_end_a_session() {
    let mut handless = Rig::of_roles();
    handless.roles.set(Role::LeftHand, None);
    let rubbish: Vec<Timed> = (0..50)
        .map(|i| {
            let mut pose = KeyPose::default();
            pose.set(Role::Hips, Vec3::repeat(f64::from(i) * 1e30));
            (f64::from(i * 7919 % 50), pose)
        })
        .collect();
    let (events, status) = run(vec![
        Step::Frames(0, stream()), // Without a skeleton.
        rig(0, Rig::default()),
        Step::Frames(0, stream()), // Of one without joints.
        rig(0, Rig::of_roles()),
        Step::Frames(0, stream()),
        Step::Gone(0),
        Step::Quiet,
        Step::Frames(0, rubbish),
        rig(0, handless),
        Step::Frames(0, stream()),
        Step::Frames(999, stream()), // A performer beyond all that can be.
        Step::Gone(999),
    ]);
    let ends = events.iter().filter(|e| e.phase == Phase::End).count();
    assert_eq!(ends, 4, "two streams of two motions: {events:?}");
    let frames = stream().len() as u64;
    assert_eq!(status.unusable_frames, 3 * frames, "{status:?}");
    assert_eq!(status.motions, 4);
}

#[test]
fn performers_do_not_disturb_each_other() {
    let poses = stream();
    let alone = inline(&made::model(), BoneSet::BODY, &poses);
    let mut steps = vec![rig(3, Rig::of_roles()), rig(0, Rig::of_roles())];
    for pose in &poses {
        steps.push(Step::Frames(3, vec![*pose]));
        steps.push(Step::Frames(0, vec![(pose.0 + 100.0, pose.1)]));
    }
    let (events, status) = run(steps);
    for actor in [0, 3] {
        let of_actor: Vec<&Event> = events
            .iter()
            .filter(|e| e.actor == PerformerId(actor) && e.phase == Phase::End)
            .collect();
        assert_eq!(of_actor.len(), alone.len());
        for (event, expected) in of_actor.iter().zip(&alone) {
            assert_eq!((event.class, event.score), (expected.class, expected.score));
        }
    }
    assert_eq!(
        status.actors.iter().map(|a| a.actor.0).collect::<Vec<_>>(),
        [0, 3]
    );
}

#[test]
fn every_motion_ends_once_every_start_ends_or_is_cancelled_and_numbers_have_no_gaps() {
    let (events, _) = run(vec![
        rig(0, Rig::of_roles()),
        Step::Frames(0, stream()),
        Step::Gone(0),
        Step::Frames(0, stream()),
    ]);
    let numbers: Vec<u64> = events.iter().map(|e| e.sequence).collect();
    assert_eq!(numbers, (1..=events.len() as u64).collect::<Vec<_>>());
    let last = events.iter().map(|e| e.motion).max().unwrap();
    for motion in 1..=last {
        let phases: Vec<Phase> = events
            .iter()
            .filter(|e| e.motion == motion)
            .map(|e| e.phase)
            .collect();
        let (last, before) = phases.split_last().unwrap();
        assert!(
            matches!(last, Phase::End | Phase::Cancel),
            "motion {motion}: {phases:?}"
        );
        let begun = before.first().is_none_or(|p| *p == Phase::Start);
        assert!(
            begun && before.iter().skip(1).all(|p| *p == Phase::Update),
            "motion {motion}: {phases:?}"
        );
    }
}

#[test]
fn an_activity_is_heard_of_every_second_and_its_repetitions_are_counted() {
    let model = Arc::new(made::activity_model());
    let poses = made::poses(&made::waving(3)).1;
    let steps = || vec![rig(0, Rig::of_roles()), Step::Frames(0, poses.clone())];
    let (events, _) = run_with(&model, tentative(), steps());
    let (end, going_on) = events.split_last().unwrap();
    assert_eq!(end.phase, Phase::End);
    let told: Vec<&Event> = going_on.iter().filter(|e| e.motion == end.motion).collect();
    assert_eq!(told[0].phase, Phase::Start);
    for pair in told.windows(2) {
        let (last, next) = (pair[0], pair[1]);
        assert!(
            next.span.stop_secs - last.span.stop_secs < 1.1,
            "{last:?}, {next:?}"
        );
        let count = |e: &Event| e.repetitions.map_or(0, |r| r.count);
        assert!(count(next) >= count(last), "{last:?}, {next:?}");
    }
    let repeated = end.repetitions.unwrap();
    assert!((7..=9).contains(&repeated.count), "{repeated:?}");

    let options = EventOptions {
        each_repetition: true,
        ..Default::default()
    };
    let each = run_with(&model, options, steps()).0;
    let (last, repetitions) = each.split_last().unwrap();
    assert_eq!(last.phase, Phase::End);
    assert_eq!(repetitions.len(), repeated.count as usize);
    assert!(repetitions.iter().all(|e| e.phase == Phase::Repetition));
    for pair in repetitions.windows(2) {
        assert!((pair[0].span.stop_secs - pair[1].span.start_secs).abs() < 1e-9);
    }
}

#[test]
fn a_refractory_time_tells_the_first_of_a_row_and_counts_the_others() {
    let poses = stream();
    let events = EventOptions {
        refractory_secs: 1000.0,
        ..Default::default()
    };
    let options = SessionOptions {
        events,
        ..Default::default()
    };
    let twice: Vec<Timed> = poses
        .iter()
        .copied()
        .chain(poses.iter().map(|(t, pose)| (t + 20.0, *pose)))
        .collect();
    let (session, readers) =
        Session::start(&made::model(), Box::new(Played::new(&twice)), &options).unwrap();
    let found = readers.into_iter().map(ended).next().unwrap();
    assert_eq!(found.len(), 2, "{found:?}");
    assert_eq!(session.join().suppressed, 2);
}

#[test]
fn a_source_that_may_not_wait_loses_frames_and_they_are_counted() {
    let poses = stream();
    let many: Vec<Timed> = (0..200)
        .flat_map(|lap| {
            poses
                .iter()
                .map(move |(t, pose)| (t + 60.0 * f64::from(lap), *pose))
        })
        .collect();
    let options = SessionOptions {
        overload: OverflowPolicy::Drop,
        frame_capacity: 1,
        ..Default::default()
    };
    let source = Box::new(Played::new(&many));
    let (session, mut readers) = Session::start(&made::model(), source, &options).unwrap();
    let reader = readers.pop().unwrap();
    // Nobody reads: what does not fit is dropped, and the session ends all the same.
    let status = session.join();
    assert_eq!(
        status.frames + status.dropped_frames,
        many.len() as u64,
        "{status:?}"
    );
    assert!(status.dropped_frames > 0, "{status:?}");
    let told = all(reader).len() as u64;
    assert_eq!(told + status.dropped_events, status.events);
}

#[test]
fn several_readers_each_get_everything_and_one_that_left_holds_nobody_up() {
    let options = SessionOptions {
        readers: 3,
        ..Default::default()
    };
    let source = Box::new(Played::new(&stream()));
    let (session, mut readers) = Session::start(&made::model(), source, &options).unwrap();
    drop(readers.remove(1));
    let handle = session.handle();
    let found: Vec<Vec<Event>> = readers.into_iter().map(all).collect();
    assert_eq!(found[0], found[1]);
    assert!(!found[0].is_empty());
    drop(session);
    assert!(handle.get().ended);
}

#[test]
fn a_session_that_is_stopped_ends_though_nobody_reads_and_the_source_goes_on_for_ever() {
    struct Endless(u64, Vec<Timed>, bool);
    impl Source for Endless {
        fn next(&mut self, frame: &mut Frame) -> SourceEvent {
            if !self.2 {
                self.2 = true;
                return SourceEvent::Rig(PerformerId(0), Arc::new(Rig::of_roles()));
            }
            let (time_secs, pose) = self.1[self.0 as usize % self.1.len()];
            frame.time_secs = time_secs + 60.0 * (self.0 / self.1.len() as u64) as f64;
            frame.set_key_pose(&pose);
            self.0 += 1;
            SourceEvent::Frame
        }
    }
    let source = Box::new(Endless(0, stream(), false));
    let (session, readers) =
        Session::start(&made::model(), source, &SessionOptions::default()).unwrap();
    while session.status().frames == 0 {
        std::thread::sleep(Duration::from_millis(5));
    }
    let status = session.stop();
    assert!(status.ended && status.frames > 0, "{status:?}");
    drop(readers);
}

//! How far every class has come, with each frame.

use std::sync::Arc;

use morec::live::{Event, EventOptions, Frame, Performer, PerformerId, Phase, Rig};

use crate::made::{self, Timed};

/// Events of a push and a bow after it, at so many frames a second.
fn told(progress: bool, hz: f64) -> Vec<Event> {
    let (_, poses): (_, Vec<Timed>) = made::poses(&made::performance(hz));
    let options = EventOptions {
        progress,
        ..EventOptions::default()
    };
    let mut performer = Performer::new(&made::model(), PerformerId(0), &options);
    performer.set_rig(&Arc::new(Rig::of_roles()));
    let (mut frame, mut events) = (Frame::default(), Vec::new());
    for (time_secs, pose) in &poses {
        frame.time_secs = *time_secs;
        frame.set_key_pose(pose);
        events.extend_from_slice(performer.push(&frame));
    }
    events.extend_from_slice(performer.finish());
    events
}

#[test]
fn a_gesture_rises_to_its_end_and_others_stay_below() {
    let model = made::model();
    let events = told(true, 60.0);
    let (progress, others): (Vec<Event>, Vec<Event>) =
        events.into_iter().partition(|e| e.phase == Phase::Progress);
    assert!(progress.iter().all(|e| e.motion == 0 && e.pace.is_some()));
    let ranges = |e: &Event| (0.0..=1.0).contains(&e.progress) && (0.0..=1.0).contains(&e.score);
    assert!(progress.iter().all(ranges));
    // One of each class with every row, of which there are thirty a second.
    let classes = model.classes.len();
    assert_eq!(progress.len() % classes, 0);
    for of_row in progress.chunks(classes) {
        assert!((0..).zip(of_row).all(|(class, e)| e.class.index() == class));
    }
    let ends: Vec<&Event> = others.iter().filter(|e| e.phase == Phase::End).collect();
    assert!(ends.len() >= 2, "{ends:?}");
    for end in ends {
        let during = |e: &&Event| {
            let at = e.span.stop_secs;
            e.class == end.class && at > end.span.start_secs && at <= end.span.stop_secs + 0.1
        };
        let own: Vec<&Event> = progress.iter().filter(during).collect();
        let (first, last) = (own[own.len() / 2], own[own.len() - 1]);
        assert!(last.progress > 0.9, "{last:?}");
        assert!(last.score > 0.3, "{last:?}");
        assert!(first.progress < last.progress, "{first:?} {last:?}");
        assert!((0.5..=2.0).contains(&last.pace.unwrap()), "{last:?}");
        let best = |e: &&Event| e.span.stop_secs == last.span.stop_secs;
        let nearest = progress
            .iter()
            .filter(best)
            .max_by(|a, b| a.score.total_cmp(&b.score));
        assert_eq!(nearest.unwrap().class, end.class);
    }
}

#[test]
fn progress_changes_nothing_else_and_comes_at_most_once_a_frame() {
    let without = told(false, 60.0);
    let with = told(true, 60.0);
    let plain = |e: &Event| (e.phase, e.motion, e.class, e.span, e.score);
    let others = with.iter().filter(|e| e.phase != Phase::Progress);
    assert!(others.map(plain).eq(without.iter().map(plain)));
    // At ten frames a second, each completes three rows: the newest is told.
    let classes = made::model().classes.len();
    let slow = told(true, 10.0);
    let slow = slow.iter().filter(|e| e.phase == Phase::Progress).count() / classes;
    let fast = with.iter().filter(|e| e.phase == Phase::Progress).count() / classes;
    assert!(slow > 20 && slow < fast / 2, "{slow} {fast}");
}

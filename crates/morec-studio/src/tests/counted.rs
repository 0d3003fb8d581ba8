//! Number of clicks and keys from the start to "recognised live".

use egui::Key;

use super::{labelling, takes};
use crate::state::{Command, Panel, PlayCommand};

/// The bound of the project's own measure.
const AT_MOST: usize = 40;

#[test]
fn three_gestures_of_a_played_clip_are_recognised_live_after_few_clicks_and_keys() {
    let (_folder, mut person) = labelling(0);
    let take = &takes()[0];
    assert_eq!(
        person.state().player.motion.as_ref().unwrap().clip.name,
        take.clip.name
    );
    person.key(Key::Space);
    // Each gesture's key is held while it passes: two of each class.
    let mut classes: Vec<&str> = take.labels.iter().map(|l| l.class).collect();
    classes.sort_unstable();
    classes.dedup();
    assert_eq!(classes.len(), 3);
    let mut labels = take.labels.clone();
    labels.sort_by(|a, b| a.span.start_secs.total_cmp(&b.span.start_secs));
    // Keys count up with the classes as they appear.
    let mut order: Vec<&str> = Vec::new();
    for label in &labels {
        if !order.contains(&label.class) {
            order.push(label.class);
        }
        let key = crate::keys::CLASS_KEYS[order.iter().position(|c| *c == label.class).unwrap()];
        while person.state().player.at_secs < label.span.start_secs {
            person.frames(1);
        }
        person.hold(key, label.span.duration_secs());
    }
    person.key(Key::K);
    person.settle();
    assert_eq!(person.labels().len(), labels.len());
    person.key_with(Key::T, egui::Modifiers::COMMAND);
    person.settle();
    person.goes_to(Panel::Live);
    person.key(Key::Space);
    person.settle();
    while person.state().live.counts.len() < 3 {
        let now = person.state().live.run.as_ref().unwrap().now_secs;
        assert!(
            now < 3.0 * take.clip.duration_secs(),
            "{:?}",
            person.state().live.counts
        );
        person.frames(1);
    }
    for n in 1..=3 {
        assert!(person.sees_part(&format!("Recognised gesture {n}")));
    }
    assert!(
        person.actions <= AT_MOST,
        "{} clicks and keys",
        person.actions
    );
    eprintln!(
        "{} clicks and keys from start to recognised live",
        person.actions
    );
    person.command(Command::Play(PlayCommand::Pause));
}

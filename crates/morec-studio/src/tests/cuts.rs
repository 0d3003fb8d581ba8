//! Cuts are dragged into place and kept; a channel is a curve with its keyframes.

use egui::{Key, Modifiers, vec2};

use super::{Person, labelling};
use crate::state::{ClassCommand, Command, CutCommand, Panel, PlayCommand};

/// A cut with room to its right, and its name.
fn some_cut(person: &Person) -> (f64, String) {
    let cuts = person.state().cuts();
    let apart = cuts.windows(2).find(|pair| pair[1] - pair[0] > 2.0);
    let cut = apart.map_or(cuts[0], |pair| pair[0]);
    (cut, format!("Cut at {cut:.2} s"))
}

#[test]
fn a_cut_is_dragged_into_place_and_cutting_again_leaves_it() {
    let (_folder, mut person) = labelling(1);
    let found = person.state().cuts();
    assert!(!found.is_empty());
    let (cut, name) = some_cut(&person);
    let at = person.place(&name).center();
    person.drag(at, at + vec2(25.0, 0.0));
    person.settle();
    let line = person.state().command_line.clone();
    assert!(
        line.contains("morec cut") && line.contains("--at"),
        "{line}"
    );
    let by_hand = person.state().cuts();
    assert_eq!(by_hand.len(), found.len());
    assert!(!by_hand.iter().any(|c| (c - cut).abs() < 1e-6));
    assert_eq!(person.state().cut_method(), Some("hand"));
    assert!(person.sees_part("Track of cuts"));
    person.click("Cut all clips");
    person.click("By kernel change points");
    person.settle();
    assert!(
        person
            .state()
            .said
            .contains("1 clip cut by hand not changed"),
        "{}",
        person.state().said
    );
    assert_eq!(person.state().cuts(), by_hand, "edited cuts are kept");
    person.undo();
    person.undo();
    assert_eq!(person.state().cuts(), found);
    person.redo();
    assert_eq!(person.state().cuts(), by_hand);
    person.command(Command::Cuts(CutCommand::Reset));
    assert_eq!(person.state().cuts(), found);
    person.undo();
    assert_eq!(person.state().cuts(), by_hand);
}

#[test]
fn a_cut_is_removed_and_another_added() {
    let (_folder, mut person) = labelling(1);
    let found = person.state().cuts();
    let (_, name) = some_cut(&person);
    let at = person.place(&name).center();
    person.click(&name);
    person.key(Key::Delete);
    person.settle();
    assert_eq!(person.state().cuts().len(), found.len() - 1);
    assert!(!person.offers(&name));
    // Soon after another click it would be a triple click.
    person.wait(1.0);
    person.double_click_at(at);
    person.settle();
    assert_eq!(person.state().cuts().len(), found.len());
    person.undo();
    person.undo();
    assert_eq!(person.state().cuts(), found);
}

#[test]
fn a_cut_is_made_at_the_playhead_and_moved_by_keys() {
    let (_folder, mut person) = labelling(1);
    let found = person.state().cuts();
    let (cut, name) = some_cut(&person);
    let frame = 1.0 / person.state().player.rate_hz();
    person.click(&name);
    for (key, modifiers, by) in [
        (Key::ArrowRight, Modifiers::COMMAND, frame),
        (Key::ArrowLeft, Modifiers::COMMAND, -frame),
    ] {
        let before = person.state().timeline.cut.unwrap();
        person.key_with(key, modifiers);
        person.settle();
        let now = person.state().timeline.cut.unwrap();
        assert!((now - before - by).abs() < 1e-6, "{before} {now}");
        assert!(person.state().cuts().iter().any(|c| (c - now).abs() < 1e-6));
        assert_eq!(person.state().cuts().len(), found.len());
    }
    person.command(Command::Play(PlayCommand::Seek(cut + 1.0)));
    let at = person.state().player.at_secs;
    person.key(Key::OpenBracket);
    person.settle();
    assert!(person.state().cuts().iter().any(|c| (c - at).abs() < 1e-6));
    (0..3).for_each(|_| person.undo());
    assert_eq!(person.state().cuts(), found);
    person.key(Key::X);
    person.settle();
    assert_eq!(person.state().cuts().len(), found.len() + 1);
    person.undo();
    assert_eq!(person.state().cuts(), found);
}

#[test]
fn of_many_classes_those_of_the_clip_have_a_track() {
    let (_folder, mut person) = labelling(1);
    let class = |n: usize| Command::Classes(ClassCommand::Add(format!("other {n}")));
    let few = person.state().classes.order.len();
    assert!((1..=8).contains(&few));
    (few..8).for_each(|n| person.command(class(n)));
    assert!(person.offers("Track other 7") && !person.offers("All classes"));
    person.command(class(8));
    let labelled = person.state().shown_samples()[0].class.clone();
    assert!(!person.offers("Track other 7") && person.offers(&format!("Track {labelled}")));
    person.click("All classes");
    assert!(person.offers("Track other 7") && person.offers("Track other 8"));
    person.click("All classes");
    assert!(!person.offers("Track other 8"));
    // A label in the clip brings the track of its class.
    person.key(Key::Space);
    person.hold(Key::Num8, 0.6);
    person.key(Key::K);
    person.settle();
    assert!(person.offers("Track other 7"));
}

#[test]
fn a_channel_is_shown_with_its_keyframes() {
    let (_folder, mut person) = labelling(1);
    person.click("Channel");
    person.click("Hips: position");
    person.settle();
    let channel = person.state().channel.clone().unwrap();
    assert!(channel.curves.len() > 3);
    let keys = channel.curves.len() + 1;
    assert!(person.sees_part(&format!("Channel Hips, {keys} keyframes")));
    // Curves follow each other without a gap from the beginning to the end.
    let meet =
        |pair: &[morec::smooth::Bezier]| (pair[0].span.stop_secs - pair[1].span.start_secs).abs();
    assert!(channel.curves.windows(2).all(|pair| meet(pair) < 1e-9));
    person.click("Channel: Hips");
    person.click("None");
    assert!(person.state().channel_wanted.is_none());
}

#[test]
fn playing_stays_inside_the_segment_between_the_cuts() {
    let (_folder, mut person) = labelling(1);
    let cuts = person.state().cuts();
    let pair = cuts
        .windows(2)
        .min_by(|a, b| (a[1] - a[0]).total_cmp(&(b[1] - b[0])));
    let (start, stop) = (pair.unwrap()[0], pair.unwrap()[1]);
    let middle = 0.5 * (start + stop);
    person.command(Command::Play(PlayCommand::Seek(middle)));
    person.key(Key::I);
    person.key(Key::Space);
    for _ in 0..40 {
        person.wait(0.1);
        let at = person.state().player.at_secs;
        assert!(start - 1e-6 <= at && at <= stop, "{start} {at} {stop}");
    }
    assert!(person.state().player.playing);
    person.key(Key::I);
    assert!(person.state().player.looped.is_none());
}

#[test]
fn a_clip_too_short_for_a_misfit_curve_says_so() {
    let folder = tempfile::tempdir().unwrap();
    let clips = super::clips_of(folder.path());
    let text = std::fs::read_to_string(&clips[0]).unwrap();
    let (skeleton, motion) = text.split_once("Frames:").unwrap();
    let lines: Vec<&str> = motion.lines().skip(1).take(61).collect();
    let path = folder.path().join("short.bvh");
    std::fs::write(
        &path,
        format!("{skeleton}Frames: 60\n{}\n", lines.join("\n")),
    )
    .unwrap();
    let mut person = Person::before(&[path]);
    person.goes_to(Panel::Label);
    person.settle();
    assert!(person.sees_part("Misfit (thesis): no misfit curve: this clip is too short"));
}

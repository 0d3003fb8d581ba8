//! More like this, and one performer beside another.

use egui::Key;

use super::{Person, before, labelling, takes};
use crate::body::Aligned;
use crate::state::compare::Placement;
use crate::state::{Command, Panel, TimelineCommand};

/// The first wave of the first clip is selected.
fn with_a_wave() -> (tempfile::TempDir, Person) {
    let (folder, mut person) = labelling(1);
    let label = person.state().shown_samples().iter();
    let wave = label.clone().find(|s| s.class == "wave").unwrap();
    let name = format!("wave {:.2}–{:.2} s", wave.start_secs, wave.stop_secs);
    // Soon after another click it would be a double click.
    person.wait(1.0);
    person.click(&name);
    assert_eq!(person.state().selected().len(), 1);
    (folder, person)
}

#[test]
fn what_is_like_a_label_becomes_labels_and_back() {
    let (_folder, mut person) = with_a_wave();
    let before = person.labels();
    person.key(Key::F);
    person.settle();
    assert_eq!(person.state().panel, Panel::Classes);
    let line = person.state().command_line.clone();
    assert!(line.contains("morec db search"), "{line}");
    let of = |clip: &str| takes().iter().find(|t| t.clip.name == clip).unwrap();
    let similar = person.state().classes.similar.clone().unwrap();
    let snapshot = person.state().store.as_ref().unwrap().snapshot.clone();
    // Somebody else's wave is among the first, which nobody has labelled yet.
    let (at, hit) = similar
        .hits
        .iter()
        .enumerate()
        .find(|(_, hit)| {
            let clip = &snapshot.clip(hit.clip).unwrap().name;
            clip != "ada_1"
                && of(clip).labels.iter().any(|l| {
                    let shared = l.span.overlap_secs(hit.span);
                    l.class == "wave" && shared > 0.5 * l.span.duration_secs()
                })
        })
        .unwrap();
    assert!(at < 6, "{at}");
    assert!(person.offers(&format!(
        "Like it: {} at {:.2} s",
        snapshot.clip(hit.clip).unwrap().name,
        hit.span.start_secs
    )));
    person.click(&format!("Hit {} is wave", at + 1));
    person.settle();
    assert_eq!(person.labels().len(), before.len() + 1);
    person.undo();
    assert_eq!(person.labels(), before);
    // A hit that is compared is found by a search for the example.
    let of = person.state().classes.similar.as_ref().unwrap().of;
    person.click("Compare with hit 1");
    let line = person.state().command_line.clone();
    let example = format!(
        "ada_1 --start {:.3} --stop {:.3}",
        of.span.start_secs, of.span.stop_secs
    );
    assert!(
        line.starts_with("morec db search ") && line.contains(&example),
        "{line}"
    );
    person.settle();
    person.click("Mirror image too");
    person.settle();
    assert!(person.state().classes.similar.as_ref().unwrap().mirror);
    assert!(person.state().command_line.contains("--mirror"));
    person.click("Back to classes");
    assert!(person.state().classes.similar.is_none());
}

#[test]
fn the_nearest_stands_beside_the_performer_and_on_top_along_the_warping_path() {
    let (_folder, mut person) = with_a_wave();
    person.key(Key::C);
    person.settle();
    let aligned = person.state().companions.all[0].clone();
    assert!(person.sees_part("Seen: ada_1"));
    let name = &aligned.motion.clip.name;
    assert!(person.sees_part(&format!("Seen: {name}")));
    // Time runs forwards in both, from one end to the other.
    let steps = (0..=20).map(|k| {
        let secs = aligned.of.span.duration_secs();
        aligned.at(aligned.of.span.start_secs + secs * f64::from(k) / 20.0)
    });
    let steps: Vec<f64> = steps.collect();
    assert!(steps.windows(2).all(|w| w[0] <= w[1] + 1e-9), "{steps:?}");
    assert!((steps[0] - aligned.with.span.start_secs).abs() < 1e-6);
    assert!((steps[20] - aligned.with.span.stop_secs).abs() < 1e-6);
    let apart = person.state().apart();
    assert!(apart > 0.5);
    person.click("On top");
    assert_eq!(person.state().companions.placement, Placement::OnTop);
    assert_eq!(person.state().apart(), 0.0);
    person.click("Alone");
    assert!(person.state().companions.all.is_empty());
    assert!(!person.sees_part("Seen: "));
}

#[test]
fn a_motion_stands_beside_what_components_keep_of_it() {
    let (_folder, mut person) = with_a_wave();
    let pose = |person: &Person, aligned: &Aligned| {
        let motion = person.state().player.motion.clone().unwrap();
        let secs = aligned.of.span.middle_secs();
        assert!((aligned.at(secs) - secs).abs() < 1e-6);
        let (own, rebuilt) = (motion.pose(secs), aligned.motion.pose(secs));
        let pairs = own.positions.iter().zip(&rebuilt.positions);
        pairs.map(|(a, b)| (a - b).norm()).fold(0.0, f64::max)
    };
    person.click("Reduced");
    person.click("1 component");
    person.settle();
    assert!(person.sees_part("Seen: 1 component"));
    let rough = pose(&person, &person.state().companions.all[0].clone());
    person.click("Alone");
    person.click("Reduced");
    person.click("16 components");
    person.settle();
    let fine = pose(&person, &person.state().companions.all[0].clone());
    assert!(rough > 0.02 && fine < 0.5 * rough, "{rough} {fine}");
}

#[test]
fn without_a_selection_there_is_a_sentence() {
    let (_folder, mut person) = with_a_wave();
    person.command(Command::Timeline(TimelineCommand::Select {
        id: None,
        add: false,
    }));
    person.key(Key::C);
    person.key(Key::F);
    assert!(person.sees_part("select a label or a stretch first"));
}

#[test]
fn a_hit_becomes_a_new_class_before_there_is_any() {
    let (_folder, mut person) = labelling(0);
    let range = Some((2.0, 3.5));
    person.command(Command::Timeline(TimelineCommand::Range(range)));
    person.key(Key::F);
    person.settle();
    assert!(person.state().classes.order.is_empty());
    person.click("Hit 1 is …");
    person.click("New class");
    person.settle();
    let labels = person.labels();
    assert_eq!(labels.len(), 1);
    assert_eq!(labels[0].1, "gesture 1");
}

#[test]
fn how_far_off_is_drawn_and_a_bone_goes_to_its_worst_moment() {
    let (_folder, mut person) = with_a_wave();
    assert!(!person.sees_part("Largest deviation: "));
    person.key(Key::C);
    person.settle();
    let (aligned, deviation) = person.state().deviation().unwrap();
    let (of, deviation) = (aligned.of, deviation.clone());
    assert!(person.sees_part(&format!("{:.0}° from ", deviation.off_degrees)));
    let (secs, degrees) = deviation.worst(of.span).unwrap();
    assert!(person.sees(&format!("Largest deviation: {degrees:.0}° at {secs:.2} s")));
    let bone = &deviation.bones[0];
    person.click(&format!(
        "{}: {:.0}° on average, at most {:.0}° at {:.2} s",
        bone.bone.replace('_', " "),
        bone.off_degrees,
        bone.worst_degrees,
        bone.worst_secs
    ));
    assert!((person.state().player.at_secs - bone.worst_secs).abs() < 0.2);
    person.click("Alone");
    assert!(!person.sees_part("Largest deviation: "));
}

#[test]
fn a_recognised_motion_is_held_beside_the_nearest_label_of_its_class() {
    let (_folder, mut person) = before(Panel::Train, 3);
    person.click("Start training");
    person.settle();
    person.goes_to(Panel::Label);
    person.settle();
    let (_, found) = person.state().detections.clone().unwrap();
    let wave = found.iter().find(|d| d.class == "wave").unwrap();
    assert!(!person.offers("How well?"));
    person.click(&format!("recognised wave {:.2} s", wave.span.start_secs));
    person.click("How well?");
    person.settle();
    let (aligned, deviation) = person.state().deviation().unwrap();
    assert_eq!(aligned.of.span.start_secs, wave.span.start_secs);
    let store = person.state().store.as_ref().unwrap();
    let mut labels = store.snapshot.accepted().filter(|s| s.class == "wave");
    assert!(
        labels.any(|s| s.clip == aligned.with.clip && s.start_secs == aligned.with.span.start_secs)
    );
    assert!(deviation.off_degrees < 45.0 && deviation.bones.len() > 5);
}

//! Training and judging through the window.

use super::{Person, before, made};
use crate::jobs::thesis::{GRID, TreeNodeView};
use crate::state::{Command, LibraryCommand, Panel, TimelineCommand, TrainCommand};
use crate::store::Edit;
use morec::index::MotionIndex;
use morec::train::Everyday;
use morec::train::thesis::SvrdmTrainParams;

#[test]
fn an_index_is_trained_kept_and_its_mistakes_are_found() {
    let (_folder, mut person) = before(Panel::Train, 3);
    person.everyday = Everyday::Always;
    person.click("Start training");
    person.settle();
    let index = person.state().train.index.clone().unwrap();
    assert_eq!(index.model.classes().len(), 3);
    assert!(!person.state().train.is_stale());
    let kept = person.state().store.as_ref().unwrap().snapshot.reports[0].clone();
    assert_eq!(kept.kind, morec_db::ReportKind::Training);
    person.click(&format!("Report {}: training, {}", kept.id, kept.title));
    person.settle();
    assert!(person.sees_part("Report of ") && person.sees_part(&kept.title));
    person.click("Close the report");
    person.click("Keep");
    person.settle();
    assert!(person.sees("up to date"), "the database has it");
    assert!(person.offers("Use last"), "without being asked to");
    person.click("Use studio");
    let line = &person.state().command_line;
    let written = "moves.mdb --write studio -o studio.index";
    assert!(
        line.starts_with("morec db indexes ") && line.ends_with(written),
        "{line}"
    );
    person.settle();
    person.undo();
    assert!(!person.offers("Use studio") && person.offers("Use last"));
    person.click("Cross-validate");
    person.settle();
    let judged = person.state().train.judged.as_ref().unwrap();
    let waves: usize = judged
        .moments
        .iter()
        .filter(|m| m.truth.as_deref() == Some("wave") && m.is_right())
        .count();
    assert!(waves > 0, "synthetic people wave alike");
    let wrong = judged.false_detections();
    let said = person.sees_part("in unlabelled motion: check them");
    assert_eq!(said, wrong > 0, "{wrong} false detections");
    let first = judged
        .moments
        .iter()
        .find(|m| m.truth.as_deref() == Some("wave") && m.is_right())
        .unwrap()
        .clone();
    person.click(&format!("wave recognised as wave: {waves}"));
    person.settle();
    let player = &person.state().player;
    assert_eq!(
        player.motion.as_ref().unwrap().clip.name,
        first.clip,
        "the cell plays its first instance"
    );
    let (start, stop) = player.looped.unwrap();
    assert!(start <= first.span.start_secs && first.span.stop_secs <= stop + 1e-9);
    assert!(player.playing);
}

#[test]
fn classes_are_chosen_and_changed_labels_are_said() {
    let (_folder, mut person) = before(Panel::Train, 3);
    person.click("clap");
    assert!(person.state().train.without.contains("clap"));
    person.click("Start training");
    person.settle();
    let index = person.state().train.index.clone().unwrap();
    let classes: Vec<String> = index
        .model
        .classes()
        .iter()
        .map(|c| c.name.clone())
        .collect();
    assert_eq!(classes, ["bow", "wave"]);
    let line = person.state().command_line.clone();
    assert!(line.contains("--classes bow,wave"), "{line}");
    person.click("Cross-validate");
    let line = person.state().command_line.clone();
    assert!(line.ends_with(".mdb --classes bow,wave"), "{line}");
    person.settle();
    assert!(person.state().train.judged.is_some());
    // Changed labels are said, and the index is trained again by a click.
    let label = person.state().shown_samples()[0].id;
    person.command(Command::Edit(Edit::Remove(vec![label])));
    assert!(person.sees("Labels or background have changed since training."));
    person.click("Train again");
    person.settle();
    assert!(!person.sees("Labels or background have changed since training."));
    assert!(person.state().detections.is_some());
}

#[test]
fn without_a_chosen_class_nothing_is_learned() {
    let (_folder, mut person) = before(Panel::Train, 3);
    for class in ["bow", "clap", "wave"] {
        person.click(class);
    }
    person.click("Start training");
    person.settle();
    assert!(person.sees("Nothing to train on: choose a class that has labels"));
    assert!(person.state().train.index.is_none());
}

#[test]
fn a_cross_validation_is_stopped_and_leaves_what_was_there() {
    let (_folder, mut person) = before(Panel::Train, 3);
    person.click("Cross-validate");
    assert!(person.state().is_judging() && person.sees("Judging …"));
    person.click("Stop");
    person.settle();
    assert!(!person.state().is_judging());
    assert!(person.state().train.judged.is_none());
    assert!(person.sees("Judging: stopped"));
    // It can be begun again, and stopping another leaves the result of the first.
    person.click("Cross-validate");
    person.settle();
    let moments = |person: &Person| {
        person
            .state()
            .train
            .judged
            .as_ref()
            .unwrap()
            .moments
            .clone()
    };
    let judged = moments(&person);
    person.click("Cross-validate");
    person.click("Stop");
    person.settle();
    assert!(person.sees("Judging: stopped"));
    assert_eq!(moments(&person), judged);
}

#[test]
fn classes_with_few_labels_are_named_to_be_taught_next() {
    let (_folder, person) = before(Panel::Train, 1);
    assert!(person.sees("wave: 2 labels, add labels until there are at least three"));
}

#[test]
fn the_method_of_2009_shows_its_branches_and_its_map() {
    let (_folder, mut person) = before(Panel::Train, 2);
    person.click("Train it on these labels");
    person.settle();
    let thesis = person.state().train.thesis.clone().unwrap();
    assert_eq!(thesis.samples.len(), 12);
    assert!(person.offers("Branch 0"));
    let TreeNodeView::Branch(root) = &thesis.nodes[0] else {
        panic!("three classes make a tree with branches");
    };
    // Samples lie on their own side of the boundary, most of them.
    let inside = root.points.iter().filter(|(_, [x, y], side)| {
        let [left, lower, right, upper] = root.edges;
        let column = ((x - left) / (right - left) * GRID as f64) as usize;
        let row = ((y - lower) / (upper - lower) * GRID as f64) as usize;
        root.regions[row * GRID + column] & (1 << side) != 0
    });
    assert!(2 * inside.count() > root.points.len());
    let sample = &thesis.samples[root.points[3].0];
    let name = format!(
        "Point: {} in {} at {:.2} s",
        sample.class, sample.clip, sample.span.start_secs
    );
    person.click(&name);
    person.settle();
    let player = &person.state().player;
    assert!(player.playing, "a point plays a sample");
    // Points may lie over one another: it is one of the same place.
    let played = &thesis.samples[person.state().train.sample.unwrap()];
    let shown = player.motion.as_ref().unwrap();
    assert_eq!(shown.clip.name, played.clip);
    assert_eq!(
        player.looped,
        Some((played.span.start_secs, played.span.stop_secs))
    );
    person.goes_to(Panel::Label);
    person.settle();
    assert!(person.sees("Map of confidences"));
    let map = person.state().train.map.as_ref().unwrap();
    assert!(map.cells.iter().any(|cell| cell.0 > 0));
}

#[test]
fn training_is_in_reach_in_a_small_window_with_many_classes() {
    let folder = tempfile::tempdir().unwrap();
    let mut person = Person::before(&[made(folder.path(), 1)]);
    let clip = person.state().player.motion.as_ref().unwrap().id;
    for n in 0..20 {
        let range = (f64::from(n), f64::from(n) + 0.5);
        person.command(Command::Library(LibraryCommand::Open(clip)));
        person.command(Command::Timeline(TimelineCommand::Range(Some(range))));
        let class = format!("class {n:02}");
        person.command(Command::Timeline(TimelineCommand::LabelRange(class)));
    }
    person.window.set_size(egui::vec2(1280.0, 720.0));
    person.goes_to(Panel::Train);
    person.frames(5);
    for name in ["Start training", "Cross-validate"] {
        let place = person.place(name);
        assert!(place.bottom() < 690.0, "{name}: {place}");
    }
}

#[test]
fn the_figures_of_2009_are_set_and_its_plane_is_large_with_its_thresholds() {
    let (_folder, mut person) = before(Panel::Train, 2);
    for name in [
        "Pivots",
        "Number of dimensions",
        "Value of k",
        "Value of C",
        "Value of T",
        "Value of t",
    ] {
        assert!(person.offers(name), "{name}");
    }
    person.click("As in the thesis");
    let params = person.state().train.thesis_params.clone();
    assert_eq!(params, SvrdmTrainParams::faithful());
    let fewer = SvrdmTrainParams {
        keep: morec::pca::ComponentCount::Dims(6),
        ..SvrdmTrainParams::default()
    };
    person.command(Command::Train(TrainCommand::ThesisParams(Box::new(
        fewer.clone(),
    ))));
    person.click("Train it on these labels");
    person.settle();
    let thesis = person.state().train.thesis.clone().unwrap();
    assert_eq!(thesis.model.pca.dims(), 6);
    let plane = person.place("Plane of the branch");
    assert!(
        plane.width() >= 450.0 && plane.width() == plane.height(),
        "{plane:?}"
    );
    person.click("Lengths of the classes");
    assert!(person.sees("shortest") && person.sees("longest"));
    let (first, class) = (&thesis.paths[0], &thesis.samples[0].class);
    person.command(Command::Train(TrainCommand::Sample(0)));
    let ends =
        matches!(&thesis.nodes[*first.last().unwrap()], TreeNodeView::Leaf(leaf) if leaf == class);
    assert_eq!(person.sees(&format!("→ {class}")), ends);
    assert!(first[0] == 0 && person.sees_part("→ "));
    assert!(person.sees_part("the output is T = 1.00"));
    assert!(person.sees_part("limit, t = 0.40"));
    person.click("τ: share of variance");
    assert!(person.offers("Value of τ"));
    assert!(person.sees("The parameters have changed since it was trained."));
}

#[test]
fn whatever_is_chosen_of_the_method_of_2009_can_be_judged() {
    let (_folder, mut person) = before(Panel::Train, 2);
    person.click("τ: share of variance");
    person.click("Cross-validate it");
    let line = person.state().command_line.clone();
    assert!(line.contains("--param keep.quality=0.95"), "{line}");
    person.settle();
    assert!(
        person.state().notices.is_empty(),
        "{:?}",
        person.state().notices
    );
    assert!(person.state().train.judged.is_some());
    person.click("As in the thesis");
    assert!(person.offers("Value of T of recognition"));
    person.click("estimated");
    assert!(!person.offers("Value of T of recognition"));
    person.click("Pivots");
    person.click("joint by joint");
    person.click("LowerBack");
    person.click("Train it on these labels");
    person.settle();
    let thesis = person.state().train.thesis.clone().unwrap();
    let pivots = thesis.model.pivots.pivots();
    assert_eq!(pivots.len(), 15);
    assert!(pivots.iter().all(|pivot| pivot.name != "LowerBack"));
}

#[test]
fn what_is_trained_of_2009_is_an_index_like_any_other() {
    let (folder, mut person) = before(Panel::Train, 2);
    person.click("Train it on these labels");
    person.settle();
    let train = &person.state().train;
    assert_eq!(train.index.as_ref().unwrap().model.method(), "svrdm");
    assert!(!train.bytes.is_empty());
    let path = folder.path().join("2009.index");
    person.command(Command::File(crate::state::FileCommand::ExportIndex(
        path.clone(),
    )));
    let index = MotionIndex::from_bytes(&std::fs::read(path).unwrap()).unwrap();
    assert_eq!(index.model.method(), "svrdm");
    person.goes_to(Panel::Label);
    person.settle();
    assert!(person.state().detections.is_some());
}

#[test]
fn a_class_of_one_clip_does_not_stop_the_judging_of_2009() {
    let folder = tempfile::tempdir().unwrap();
    let mut person = Person::before(&[made(folder.path(), 2)]);
    let store = person.state().store.as_ref().unwrap();
    let first = store.snapshot.accepted().next().unwrap().clone();
    person.command(Command::Edit(Edit::Reclass {
        ids: vec![first.id],
        class: "once".to_owned(),
    }));
    person.goes_to(Panel::Train);
    person.click("Cross-validate it");
    person.settle();
    let judged = person.state().train.judged.as_ref().unwrap();
    assert_eq!(judged.untested, ["once"]);
}

#[test]
fn the_method_of_2009_has_a_confusion_matrix() {
    let (_folder, mut person) = before(Panel::Train, 2);
    person.click("Cross-validate it");
    let line = person.state().command_line.clone();
    assert!(line.ends_with(".mdb --method svrdm"), "{line}");
    person.settle();
    assert!(person.sees("CROSS-VALIDATION OF THE METHOD OF 2009, WITHOUT EACH PERSON IN TURN"));
    let judged = person.state().train.judged.as_ref().unwrap();
    let labels: usize = judged.counts[..judged.rows.len()].iter().flatten().sum();
    assert_eq!(labels, 12);
}

#[test]
fn a_class_is_a_gesture_or_an_activity_and_it_can_be_said() {
    let (_folder, mut person) = before(Panel::Train, 3);
    let store = person.state().store.as_ref().unwrap();
    let waves = store.snapshot.accepted().filter(|s| s.class == "wave");
    let longest = waves
        .map(|s| s.stop_secs - s.start_secs)
        .fold(0.0, f64::max);
    person.click(&format!(
        "wave is a gesture: its longest label lasts {longest:.1} s"
    ));
    person.click("Always an activity");
    assert_eq!(person.state().train.settings.activities, ["wave"]);
    assert!(person.sees("wave is an activity: chosen by you"));
    person.click("Start training");
    person.settle();
    assert!(person.state().command_line.contains("--activities wave"));
    assert!(person.sees_part("reported when it ends: wave (named one)"));
    person.click("wave is an activity: chosen by you");
    person.click("By its labels: a gesture");
    person.click("Start training");
    person.settle();
    assert!(!person.sees_part("reported when it ends: "));
}

//! Time budgets and annotators: what is shown, compared, decided, and each decision undone.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use egui::Key;
use morec_db::labels::{DbSample, LabelOptions, NewSample};
use morec_db::{MotionDb, ReportKind};
use morec_ops::{CurveFigures, CurvePoint, GroupMethod, LearningCurve, time_budget};

use super::{Person, before, made, takes};
use crate::state::study::{AGREED, StudyView};
use crate::state::{ClassCommand, Command, Panel, PlayCommand, TimelineCommand};

fn accepted(person: &Person) -> Vec<DbSample> {
    let store = person.state().store.as_ref().unwrap();
    store.snapshot.accepted().cloned().collect()
}

#[test]
fn the_time_budget_follows_the_labels_plays_them_and_is_exported() {
    let (folder, mut person) = before(Panel::Classes, 3);
    person.click("Time budget");
    person.settle();
    assert!(person.state().command_line.starts_with("morec budget "));
    let waves = |person: &Person| {
        let all = accepted(person).into_iter();
        all.filter(|s| s.class == "wave").collect::<Vec<_>>()
    };
    let before = waves(&person);
    let row = |n: usize| format!("wave, everybody: {n} labels");
    assert!(person.sees_part(&row(before.len())));
    let ben = takes()[1].person.clone();
    let of_ben = |s: &&DbSample| s.subject.as_ref() == Some(&ben);
    let first = before.iter().find(of_ben).unwrap();
    let name = format!("wave, {ben}: ");
    let node = person.named_part(&name);
    person.click(&node);
    person.settle();
    let looped = person.state().player.looped.unwrap();
    assert_eq!(looped, (first.start_secs, first.stop_secs));
    let ids = vec![first.id];
    person.command(Command::Edit(crate::store::Edit::Remove(ids)));
    assert!(person.sees_part(&row(before.len() - 1)));
    person.undo();
    assert!(person.sees_part(&row(before.len())));
    let path = folder.path().join("budget.tsv");
    person.will_choose(&[&path]);
    person.click("Export …");
    person.settle();
    let store = person.state().store.as_ref().unwrap();
    let budget = time_budget(store.snapshot.accepted(), &store.snapshot.clips);
    assert_eq!(std::fs::read_to_string(&path).unwrap(), budget.tsv());
    assert!(person.state().command_line.contains(" -o "));
    let path = folder.path().join("budget.json");
    person.will_choose(&[&path]);
    person.click("Export …");
    person.settle();
    let text = std::fs::read_to_string(&path).unwrap();
    let written: serde_json::Value = serde_json::from_str(&text).unwrap();
    assert_eq!(written["format_version"], 1);
    assert_eq!(written["clips"], budget.clips);
    person.click("Back to classes");
    person.frames(2);
    assert!(person.sees("Column wave"));
}

/// The labels of the first two takes by ann and by ben: ben starts the first label later, gives the second another class, and has no
/// third.
fn by_two(folder: &Path) -> PathBuf {
    let path = made(folder, 0);
    let mut db = MotionDb::open(&path).unwrap();
    for (number, take) in takes().iter().take(2).enumerate() {
        let clip = db.find_clip(&take.clip.name).unwrap().id;
        let label =
            |l: &morec::labels::Mark<&'static str>| NewSample::accepted(clip, l.class, l.span);
        let of_ann: Vec<NewSample> = take.labels.iter().map(label).collect();
        let mut of_ben = of_ann.clone();
        if number == 0 {
            of_ben[0].start_secs += 0.2;
            of_ben[1].class = "shrug".to_owned();
            of_ben.remove(2);
        }
        for (name, samples) in [("ann", of_ann), ("ben", of_ben)] {
            let options = LabelOptions {
                by: "test".to_owned(),
                annotators: vec![Some(name.to_owned()); samples.len()],
                ..LabelOptions::default()
            };
            db.label(&samples, &options).unwrap();
        }
    }
    path
}

fn by_name(sample: &DbSample) -> String {
    format!(
        "{} {:.2}–{:.2} s",
        sample.class, sample.start_secs, sample.stop_secs
    )
}

#[test]
fn labels_of_one_annotator_are_shown_and_new_ones_name_theirs() {
    let folder = tempfile::tempdir().unwrap();
    let mut person = Person::before(&[by_two(folder.path())]);
    person.goes_to(Panel::Label);
    let shrug = accepted(&person).into_iter().find(|s| s.class == "shrug");
    let shrug = by_name(&shrug.unwrap());
    assert!(person.offers(&shrug));
    person.click("Annotators");
    person.click("Show labels of ann");
    person.settle();
    assert!(!person.offers(&shrug), "it is ben's");
    person.click("Annotators");
    person.types("Annotator of new labels", "cid");
    assert_eq!(person.state().study.annotator.as_deref(), Some("cid"));
    let before = accepted(&person);
    let range = TimelineCommand::Range(Some((0.1, 0.3)));
    person.command(Command::Timeline(range));
    person.key(Key::Num1);
    person.settle();
    assert!(person.state().command_line.contains("--annotator cid"));
    let is_new = |s: &DbSample| before.iter().all(|old| old.id != s.id);
    let new = accepted(&person).into_iter().find(is_new).unwrap();
    assert_eq!(new.annotators, ["cid"]);
    assert!(person.offers(&by_name(&new)), "what is made is seen");
    // Splitting keeps the annotator.
    let middle = 0.5 * (new.start_secs + new.stop_secs);
    person.command(Command::Play(PlayCommand::Seek(middle)));
    person.key(Key::S);
    person.settle();
    let parts: Vec<_> = accepted(&person).into_iter().filter(is_new).collect();
    assert_eq!(parts.len(), 2);
    assert!(parts.iter().all(|part| part.annotators == ["cid"]));
    person.undo();
    person.undo();
    assert_eq!(accepted(&person), before);
}

#[test]
fn two_annotators_are_compared_and_each_difference_is_decided_and_undone() {
    let folder = tempfile::tempdir().unwrap();
    let mut person = Person::before(&[by_two(folder.path())]);
    let before = accepted(&person);
    person.goes_to(Panel::Classes);
    person.click("Compare annotators");
    person.settle();
    assert!(
        person
            .state()
            .command_line
            .ends_with("--annotators ann,ben")
    );
    let compared = person.state().study.compared.as_ref().unwrap();
    let agreement = compared.agreement.as_ref().unwrap();
    let kappa = format!("{:.3}", agreement.time.kappa.unwrap());
    assert_eq!(agreement.clips, 2);
    assert!(person.sees(&kappa) && person.sees_part("Cohen's kappa"));
    let open = |person: &Person| person.state().study.undecided().len();
    assert_eq!(open(&person), 3);
    // The second: ben gives another class.
    let [ann, ben] =
        crate::state::study::samples_of(person.state().study.compared.as_ref().unwrap(), 1)
            .map(|s| s.unwrap().clone());
    assert_eq!(ben.class, "shrug");
    person.click("Take A, difference 2");
    person.settle();
    assert_eq!(open(&person), 2);
    let now = accepted(&person);
    assert!(now.iter().all(|s| s.class != "shrug"));
    let same = |s: &&DbSample| s.class == ann.class && s.start_secs == ann.start_secs;
    let kept = now.iter().find(same).unwrap();
    assert_eq!(kept.annotators, [AGREED, "ann"]);
    person.undo();
    assert_eq!(open(&person), 3);
    assert_eq!(accepted(&person), before);
    // By keys: the list is entered, and each decision goes on to the next difference.
    person.key(Key::ArrowDown);
    person.key(Key::Home);
    person.settle();
    assert_eq!(person.state().study.chosen, Some(0));
    assert!(person.state().player.looped.is_some());
    person.key(Key::E);
    person.settle();
    assert_eq!(open(&person), 2);
    assert_eq!(accepted(&person).len(), before.len());
    person.key(Key::B);
    person.settle();
    assert_eq!(open(&person), 1);
    assert!(accepted(&person).iter().any(|s| s.class == "shrug"));
    // The last is ann's alone: with B it goes.
    person.key(Key::B);
    person.settle();
    assert_eq!(open(&person), 0);
    assert_eq!(accepted(&person).len(), before.len() - 2);
    assert!(person.sees("Nowhere, or everything is decided."));
    for _ in 0..3 {
        person.undo();
    }
    assert_eq!(accepted(&person), before);
    assert_eq!(person.state().study.view, Some(StudyView::Annotators));
}

#[test]
fn keys_decide_nothing_while_groups_cover_the_differences() {
    let folder = tempfile::tempdir().unwrap();
    let mut person = Person::before(&[by_two(folder.path())]);
    person.goes_to(Panel::Classes);
    person.click("Compare annotators");
    person.settle();
    person.key(Key::ArrowDown);
    person.key(Key::Home);
    person.settle();
    assert_eq!(person.state().study.chosen, Some(0));
    let before = accepted(&person);
    // Groups that were asked for before may come now.
    person.command(Command::Classes(ClassCommand::Group {
        cuts: false,
        method: GroupMethod::Hierarchy,
    }));
    person.settle();
    assert!(person.state().classes.groups.is_some());
    assert_eq!(person.state().study_view(), None);
    person.key(Key::E);
    person.settle();
    assert_eq!(accepted(&person), before);
}

#[test]
fn without_two_annotators_there_is_nothing_to_compare() {
    let (_folder, mut person) = before(Panel::Classes, 1);
    person.click("Compare annotators");
    person.settle();
    assert!(person.sees("Fewer than two annotators"));
    person.click("Back to classes");
    person.frames(2);
    assert!(person.sees("Column wave"));
}

#[test]
fn the_learning_curve_is_measured_until_it_is_stopped_and_drawn_with_what_it_says() {
    let (_folder, mut person) = before(Panel::Train, 2);
    person.click("Learning curve");
    person.frames(2);
    assert!(person.state().is_measuring_curve());
    assert!(person.state().command_line.contains("--curve"));
    person.click("Stop");
    person.settle();
    assert!(!person.state().is_measuring_curve() && person.offers("Learning curve"));
    // What is drawn is of these figures.
    let point = |samples, f1s: &[f64]| CurvePoint {
        samples,
        people: None,
        draws: f1s.iter().map(|f1| figures(*f1)).collect(),
    };
    person.window.state_mut().state.train.curve = Some(LearningCurve {
        divided: "each person in turn".to_owned(),
        points: vec![point(Some(1), &[0.5, 0.6, 0.7]), point(None, &[0.9])],
        advice: vec!["from at most 1 sample to all, F1 goes up".to_owned()],
    });
    person.frames(2);
    assert!(person.sees("1 sample: F1 0.600 (0.500 to 0.700)"));
    assert!(person.sees("all: F1 0.900"));
    assert!(person.sees("From at most 1 sample to all, F1 goes up"));
    person.click("Close the curve");
    person.frames(2);
    assert!(!person.sees("all: F1 0.900"));
}

#[test]
fn a_learning_curve_is_measured_to_its_end_kept_and_opened_again() {
    let folder = tempfile::tempdir().unwrap();
    let mut person = Person::before(&[made(folder.path(), 1)]);
    person.goes_to(Panel::Train);
    person.click("Learning curve");
    person.settle();
    let curve = person.state().train.curve.clone().unwrap();
    let samples: Vec<_> = curve.points.iter().map(|point| point.samples).collect();
    assert_eq!(samples.last(), Some(&None), "all teach at last");
    assert!(
        curve.points.iter().all(|p| p.people.is_none()),
        "of one person"
    );
    assert_eq!(person.state().said, "learning curve measured");
    let reports = &person.state().store.as_ref().unwrap().snapshot.reports;
    assert_eq!(reports[0].kind, ReportKind::Curve);
    assert_eq!(reports[0].title, curve.title());
    person.click("Close the curve");
    person.frames(2);
    assert_eq!(person.state().train.curve, None);
    let report = person.named_part("learning curve, F1 of events");
    person.click(&report);
    person.settle();
    assert_eq!(person.state().train.curve, Some(curve.clone()));
    assert!(person.sees_part("Report of ") && person.sees_part("taught by"));
    let file = folder.path().join("curve.json");
    person.will_choose(&[&file]);
    person.click("Export the report …");
    person.settle();
    let text = std::fs::read_to_string(&file).unwrap();
    let written: serde_json::Value = serde_json::from_str(&text).unwrap();
    assert_eq!(written["about"]["kind"], "curve");
    assert_eq!(written["report"], serde_json::json!(curve));
    person.click("Close the report");
    person.frames(2);
    assert!(person.state().train.curve.is_none() && person.state().train.opened.is_none());
}

fn figures(f1: f64) -> CurveFigures {
    CurveFigures {
        f1: Some(f1),
        recall: Some(f1),
        alarms_per_minute: None,
        delay_secs: None,
        recall_of_classes: BTreeMap::new(),
    }
}

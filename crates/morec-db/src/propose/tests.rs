//! A simulated user over synthetic people.

use std::collections::BTreeSet;

use super::*;
use crate::ClipUpdate;
use crate::labels::SampleFilter;
use crate::testing::{database_of_waves, waves, write_bvh};
use morec::files::FileReader;
use morec::synth::{Person, Script, SyntheticTake};

fn ids(db: &MotionDb, takes: &[SyntheticTake]) -> Vec<ClipId> {
    takes
        .iter()
        .map(|t| db.find_clip(&t.clip.name).unwrap().id)
        .collect()
}

/// The label at half overlap with a proposal, as its take and place there.
fn under(takes: &[SyntheticTake], ids: &[ClipId], p: &Proposal) -> Option<(usize, usize)> {
    let take = ids.iter().position(|id| *id == p.clip)?;
    let mut labels = takes[take].labels.iter();
    let label = labels.position(|l| l.span.iou(p.span) >= 0.5)?;
    Some((take, label))
}

/// Labels of the first person.
fn first_labels(takes: &[SyntheticTake], ids: &[ClipId]) -> Vec<NewSample> {
    takes[0]
        .labels
        .iter()
        .map(|l| NewSample::accepted(ids[0], l.class, l.span))
        .collect()
}

#[test]
fn a_few_labels_find_the_others() {
    let takes = waves(3);
    let (_folder, mut db) = database_of_waves(3);
    assert!(db.propose(&ProposeOptions::default(), &()).is_err());
    let ids = ids(&db, &takes);
    db.add_samples(&first_labels(&takes, &ids), "test").unwrap();
    let proposals = db.propose(&ProposeOptions::default(), &()).unwrap();
    assert!(
        proposals
            .windows(2)
            .all(|pair| pair[0].score >= pair[1].score)
    );
    let right = |p: &&Proposal| {
        under(&takes, &ids, p).is_some_and(|(t, l)| takes[t].labels[l].class == p.class)
    };
    // Four waves and four bows are left to be found: the surest of the proposals are these.
    assert!(proposals.len() >= 8, "{proposals:?}");
    assert!(
        proposals.iter().take(8).filter(right).count() >= 7,
        "{proposals:?}"
    );
    assert!(
        proposals.iter().all(|p| p.clip != ids[0] || !right(&p)),
        "labelled stretches are not proposed"
    );
    let only = ProposeOptions {
        classes: vec!["bow".into()],
        ..ProposeOptions::default()
    };
    assert!(
        db.propose(&only, &())
            .unwrap()
            .iter()
            .all(|p| p.class == "bow")
    );
}

#[test]
fn what_was_judged_is_not_proposed_again() {
    let takes = waves(3);
    let (_folder, mut db) = database_of_waves(3);
    let ids = ids(&db, &takes);
    db.add_samples(&first_labels(&takes, &ids), "test").unwrap();
    let proposals = db.propose(&ProposeOptions::default(), &()).unwrap();
    let samples: Vec<NewSample> = proposals.into_iter().map(NewSample::from).collect();
    db.add_samples(&samples, "morec").unwrap();
    let proposed: Vec<_> = db
        .samples(&SampleFilter::default())
        .unwrap()
        .iter()
        .map(|s| s.id)
        .collect();
    db.judge(&proposed, SampleState::Rejected, "test").unwrap();
    db.judge(&proposed[..1], SampleState::Accepted, "test")
        .unwrap();
    let again = db.propose(&ProposeOptions::default(), &()).unwrap();
    for known in db.samples(&SampleFilter::default()).unwrap() {
        let same = |p: &&Proposal| {
            (p.clip == known.clip && p.class == known.class) && known.span().iou(p.span) > 0.6
        };
        assert!(again.iter().find(same).is_none(), "{known:?} again");
    }
}

/// Nobody runs out of questions before everything is found.
#[test]
fn answers_lead_to_every_sample() {
    let takes = waves(4);
    let (_folder, mut db) = database_of_waves(4);
    let ids = ids(&db, &takes);
    let mut found: BTreeSet<(usize, usize)> = BTreeSet::new();
    for class in ["wave", "bow"] {
        let at = takes[0]
            .labels
            .iter()
            .position(|l| l.class == class)
            .unwrap();
        let label = &takes[0].labels[at];
        db.add_samples(&[NewSample::accepted(ids[0], class, label.span)], "test")
            .unwrap();
        found.insert((0, at));
    }
    let all: usize = takes.iter().map(|t| t.labels.len()).sum();
    let mut answers = 0;
    while found.len() < all {
        assert!(
            answers < 3 * all,
            "{} of {all} found after {answers} answers",
            found.len()
        );
        let proposals = db.propose(&ProposeOptions::default(), &()).unwrap();
        let asked = most_informative(&proposals, 4);
        assert!(
            !asked.is_empty(),
            "{} of {all} found and nothing is asked",
            found.len()
        );
        answers += asked.len();
        let answer = |p: &Proposal| {
            let mut answer = NewSample {
                state: SampleState::Rejected,
                ..p.clone().into()
            };
            if let Some((t, l)) = under(&takes, &ids, p) {
                (answer.class, answer.state) =
                    (takes[t].labels[l].class.to_owned(), SampleState::Accepted);
            }
            answer
        };
        let given: Vec<NewSample> = asked.iter().map(|at| answer(&proposals[*at])).collect();
        found.extend(
            asked
                .iter()
                .filter_map(|at| under(&takes, &ids, &proposals[*at])),
        );
        db.add_samples(&given, "test").unwrap();
    }
}

#[test]
fn classes_of_whole_clips_propose_whole_clips() {
    let takes = waves(3);
    let (_folder, mut db) = database_of_waves(3);
    let ids = ids(&db, &takes);
    let secs = |at: usize| takes[at].clip.duration_secs();
    let whole = |at: usize| NewSample {
        whole_clip: true,
        ..NewSample::accepted(ids[at], "take", TimeSpan::new(0.0, secs(at)))
    };
    db.add_samples(&[whole(0)], "test").unwrap();
    let proposals = db.propose(&ProposeOptions::default(), &()).unwrap();
    let clips: Vec<ClipId> = proposals.iter().map(|p| p.clip).collect();
    assert!(!clips.is_empty() && !clips.contains(&ids[0]), "{clips:?}");
    assert_eq!(
        clips.iter().collect::<BTreeSet<_>>().len(),
        clips.len(),
        "a clip twice"
    );
    for p in &proposals {
        let at = ids.iter().position(|id| *id == p.clip).unwrap();
        assert!(
            p.whole_clip && p.span.start_secs == 0.0 && (p.span.stop_secs - secs(at)).abs() < 1e-9,
            "{p:?}"
        );
    }
    let rejected = NewSample {
        state: SampleState::Rejected,
        ..whole(1)
    };
    db.add_samples(&[rejected], "test").unwrap();
    assert!(
        db.propose(&ProposeOptions::default(), &())
            .unwrap()
            .iter()
            .all(|p| p.clip != ids[1])
    );
}

#[test]
fn a_listener_that_says_stop_is_heard() {
    struct Stop;
    impl Progress for Stop {
        fn cancelled(&self) -> bool {
            true
        }
    }
    let takes = waves(1);
    let (_folder, mut db) = database_of_waves(1);
    let ids = ids(&db, &takes);
    db.add_samples(&first_labels(&takes, &ids), "test").unwrap();
    assert!(matches!(
        db.propose(&ProposeOptions::default(), &Stop),
        Err(DbError::Cancelled)
    ));
}

/// A take in which somebody bows, waves so often without a pause, and bows.
fn waving(number: usize, times: usize) -> SyntheticTake {
    let script = Script::new(90 + number as u64, Person::draw(91, number));
    let script = script.rest(1.5).play("bow").rest(1.0);
    let script = (0..times).fold(script, |script, _| script.play("wave"));
    let script = script.rest(1.0).play("bow").rest(1.5);
    script.film(&format!("waving{number}"), 30.0).unwrap()
}

#[test]
fn an_activity_is_proposed_as_the_whole_stretch_that_is_repeated() {
    let takes: Vec<SyntheticTake> = [5, 7, 4]
        .iter()
        .zip(0..)
        .map(|(n, i)| waving(i, *n))
        .collect();
    let folder = tempfile::TempDir::new().unwrap();
    let written = |take: &SyntheticTake| write_bvh(folder.path(), &take.clip.name, &take.clip);
    let paths: Vec<_> = takes.iter().map(written).collect();
    let mut db = MotionDb::create(&folder.path().join("test.mdb")).unwrap();
    db.import(&paths, &FileReader::default(), &ClipUpdate::default(), &())
        .unwrap();
    let ids = ids(&db, &takes);
    let waved = |take: &SyntheticTake| {
        let waves = take.labels.iter().filter(|l| l.class == "wave");
        let spans = waves.map(|l| l.span);
        let whole = |all: TimeSpan, next: TimeSpan| TimeSpan::new(all.start_secs, next.stop_secs);
        spans.reduce(whole).unwrap()
    };
    let taught = waved(&takes[0]);
    let bow = &takes[0].labels[0];
    let first = [
        NewSample::accepted(ids[0], "wave", taught),
        NewSample::accepted(ids[0], "bow", bow.span),
    ];
    db.add_samples(&first, "test").unwrap();
    let proposals = db.propose(&ProposeOptions::default(), &()).unwrap();
    for (take, id) in takes.iter().zip(&ids).skip(1) {
        let performed = waved(take);
        let of_clip = proposals
            .iter()
            .filter(|p| p.clip == *id && p.class == "wave");
        let best = of_clip.max_by(|a, b| a.score.total_cmp(&b.score)).unwrap();
        assert!(best.span.iou(performed) > 0.8, "{best:?} for {performed}");
    }
    // What is labelled is not proposed once more.
    let again = proposals.iter().any(|p| {
        let shared = taught.overlap_secs(p.span);
        p.clip == ids[0] && p.class == "wave" && shared > 0.5 * p.span.duration_secs()
    });
    assert!(!again, "{proposals:?}");
}

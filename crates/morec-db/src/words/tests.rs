use super::*;
use crate::ClipUpdate;
use crate::labels::NewSample;
use crate::testing::database_of_waves;

fn described() -> (tempfile::TempDir, MotionDb, Vec<String>) {
    let (folder, mut db) = database_of_waves(3);
    let clips = db.clips(&ClipFilter::default()).unwrap();
    let sample = |clip: usize, class: &str, start_secs: f64, state| NewSample {
        clip: clips[clip].id,
        class: class.to_owned(),
        start_secs,
        stop_secs: start_secs + 1.0,
        whole_clip: false,
        state,
        score: None,
    };
    let samples = [
        sample(0, "waveLeft", 0.5, SampleState::Accepted),
        sample(0, "bow", 2.0, SampleState::Accepted),
        sample(1, "wave_right", 0.5, SampleState::Proposed),
        sample(1, "kick", 2.0, SampleState::Rejected),
    ];
    db.add_samples(&samples, "test").unwrap();
    let update = ClipUpdate {
        add_tags: vec!["garden party".to_owned()],
        ..ClipUpdate::default()
    };
    db.update_clips(&[clips[2].id], &update).unwrap();
    let names = clips.into_iter().map(|clip| clip.name).collect();
    (folder, db, names)
}

fn found(index: &WordIndex, query: &str) -> Vec<(String, String)> {
    let hits = index.find(query, 10).hits;
    hits.into_iter()
        .map(|hit| (hit.clip_name, hit.text))
        .collect()
}

#[test]
fn stretches_clips_and_captions_are_found_by_their_words() {
    let (_folder, db, names) = described();
    let captions = [
        (
            "jumps and greets left of the door",
            &names[1],
            Some(TimeSpan::new(1.0, 2.0)),
        ),
        ("nobody has this", &"absent".to_owned(), None),
    ];
    let captions = captions.map(|(text, clip, span)| Caption {
        clip: format!("takes/{clip}.bvh"),
        text: text.to_owned(),
        span,
    });
    let index = WordIndex::of(&db, &captions).unwrap();
    assert_eq!(index.absent(), 1);

    let hits = index.find("a person is waving with the left hand", 10);
    assert_eq!(hits.unknown, ["hand"]);
    let shown: Vec<&str> = hits.hits.iter().map(|hit| hit.text.as_str()).collect();
    // The word itself before its synonym, both words before one.
    assert_eq!(
        shown,
        [
            "waveLeft",
            "jumps and greets left of the door",
            "wave_right"
        ]
    );
    assert_eq!(hits.hits[0].places, BTreeSet::from([WordPlace::Class]));
    assert_eq!(hits.hits[1].span, TimeSpan::new(1.0, 2.0));
    assert!(
        hits.hits
            .iter()
            .all(|hit| hit.score > 0.0 && hit.score <= 1.0)
    );

    assert_eq!(found(&index, "kick"), [], "rejected");
    assert_eq!(
        found(&index, "parties"),
        [(names[2].clone(), "garden party".to_owned())]
    );
    assert_eq!(
        found(&index, "gard"),
        found(&index, "parties"),
        "a beginning"
    );
    let by_name = found(&index, &names[0]);
    assert_eq!(by_name[0].0, names[0]);
    assert_eq!(found(&index, "the"), []);
    assert_eq!(index.find("left", 1).hits.len(), 1);
}

#[test]
fn scores_are_the_weighted_shares_of_the_words() {
    let (_folder, db, _) = described();
    let index = WordIndex::of(&db, &[]).unwrap();
    // Three clips and three samples that are not rejected; `bow` in one of them, `wave` in two.
    let hits = index.find("bow wave", 10).hits;
    let (bow, wave) = ((1.0 + 6.0_f64 / 1.0).ln(), (1.0 + 6.0_f64 / 2.0).ln());
    let expected = [bow / (bow + wave), wave / (bow + wave), wave / (bow + wave)];
    assert_eq!(hits.len(), 3);
    for (hit, expected) in hits.iter().zip(expected) {
        assert!((hit.score - expected).abs() < 1e-12, "{hit:?} {expected}");
    }
}

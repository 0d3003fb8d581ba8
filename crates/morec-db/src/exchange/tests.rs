//! Annotations that are written in a form are read back the same, as far as the form can hold them.

use proptest::prelude::*;

use morec::labels::ClipLength;

use super::annotation::secs;
use super::*;
use crate::labels::SampleState;

fn lengths() -> ClipLengths {
    let length = |frames, rate_hz| ClipLength { frames, rate_hz };
    [
        ("take_1", length(1000, 120.0)),
        ("b/été 2", length(3000, 30.0)),
        ("c,\"d\"", length(500, 1.0 / 0.0083333)),
    ]
    .map(|(name, length)| (name.to_owned(), length))
    .into()
}

fn annotation() -> impl Strategy<Value = Annotation> {
    let clip = prop::sample::select(lengths().into_iter().collect::<Vec<_>>());
    let class = prop_oneof![
        Just("walk"),
        Just("a & <b> \"c\""),
        Just("größe, 2;x"),
        Just("wave in")
    ];
    let person = prop_oneof![
        Just(None),
        Just(Some("anna".to_owned())),
        Just(Some("o'b <1>".to_owned()))
    ];
    let state = prop_oneof![
        Just(SampleState::Accepted),
        Just(SampleState::Proposed),
        Just(SampleState::Rejected)
    ];
    (
        clip,
        class,
        0usize..400,
        1usize..90,
        any::<bool>(),
        person,
        prop::option::of(0.0f64..1.0),
        state,
    )
        .prop_map(
            |((clip, length), class, start, frames, whole, person, score, state)| Annotation {
                clip,
                class: class.to_owned(),
                extent: (!whole).then(|| {
                    (
                        start as f64 / length.rate_hz,
                        (start + frames) as f64 / length.rate_hz,
                    )
                }),
                person,
                score,
                state,
            },
        )
}

#[test]
fn names_that_a_table_cannot_hold_are_refused_not_lost() {
    let of = |clip: &str| Annotation {
        clip: clip.to_owned(),
        class: "wave".into(),
        extent: Some((0.0, 1.0)),
        person: None,
        score: None,
        state: SampleState::Accepted,
    };
    let lengths: ClipLengths = ["a\tb", "a\nb", " a", "x.npz", "dir/x_poses.npz"]
        .map(|name| {
            (
                name.to_owned(),
                ClipLength {
                    frames: 100,
                    rate_hz: 30.0,
                },
            )
        })
        .into();
    for name in lengths.keys() {
        let all = [of(name)];
        match write(LabelFormat::Tsv, &all, &lengths) {
            Ok(text) => {
                let again = read(LabelFormat::Tsv, text.as_bytes(), None, &lengths).unwrap();
                assert_eq!(again.annotations, all);
            }
            Err(error) => assert!(error.contains("cannot hold"), "{error}"),
        }
        for form in [
            LabelFormat::Json,
            LabelFormat::Babel,
            LabelFormat::LabelStudio,
        ] {
            let text = write(form, &all, &lengths).unwrap();
            let again = read(form, text.as_bytes(), None, &lengths).unwrap();
            assert_eq!(again.annotations, all, "{form:?}");
        }
    }
}

fn sorted(mut annotations: Vec<Annotation>) -> Vec<String> {
    annotations.sort_by(|a, b| format!("{a:?}").cmp(&format!("{b:?}")));
    annotations.into_iter().map(|a| format!("{a:?}")).collect()
}

/// Annotations as a form can hold them.
fn sayable(form: LabelFormat, all: &[Annotation]) -> Vec<Annotation> {
    let says = |a: &Annotation| {
        let mut said = a.clone();
        let spelled = || a.extent.or_else(|| secs(a, &lengths()).ok());
        match form {
            LabelFormat::Csv | LabelFormat::Json => return said,
            LabelFormat::Tsv | LabelFormat::Babel => {}
            _ => said.extent = spelled(),
        }
        if !matches!(form, LabelFormat::Tsv | LabelFormat::Eaf) {
            said.person = None;
        }
        if form != LabelFormat::LabelStudio {
            said.score = None;
        }
        if form == LabelFormat::Audacity {
            said.state = SampleState::Accepted;
        }
        said
    };
    all.iter().map(says).collect()
}

/// Reads bytes: an error, or annotations whose times are times.
fn can_be_said(form: LabelFormat, bytes: &[u8]) {
    let Ok(labels) = read(form, bytes, Some("take_1"), &lengths()) else {
        return;
    };
    for a in labels.annotations {
        if let Some((start, stop)) = a.extent {
            assert!(
                start.is_finite() && stop.is_finite() && start >= 0.0 && stop > start,
                "{form:?} {a:?}"
            );
        }
        assert!(a.score.is_none_or(f64::is_finite), "{form:?} {a:?}");
    }
}

proptest! {
    #[test]
    fn round_trips_lose_nothing(all in prop::collection::vec(annotation(), 1..20)) {
        for form in LabelFormat::ALL {
            let all: Vec<Annotation> = match form.is_of_one_clip() {
                true => all.iter().filter(|a| a.clip == all[0].clip).cloned().collect(),
                false => all.clone(),
            };
            let text = write(form, &all, &lengths()).unwrap();
            let clip = (form == LabelFormat::Audacity).then(|| all[0].clip.as_str());
            let again = read(form, text.as_bytes(), clip, &lengths()).unwrap();
            prop_assert!(again.warnings.is_empty(), "{form:?} {:?}", again.warnings);
            let snapped = again.annotations.into_iter().map(|mut a| {
                let rate_hz = lengths()[&a.clip].rate_hz;
                a.extent = a.extent.map(|(start, stop)| (snap(start, rate_hz), snap(stop, rate_hz)));
                a
            });
            prop_assert_eq!(sorted(snapped.collect()), sorted(sayable(form, &all)), "{:?}\n{}", form, text);
        }
    }

    #[test]
    fn no_bytes_panic(bytes in prop_oneof![
        prop::collection::vec(any::<u8>(), 0..300),
        "[\\PC\t\n<>&\",:{}\\[\\]0-9a-z]{0,200}".prop_map(String::into_bytes),
    ]) {
        for form in LabelFormat::ALL {
            can_be_said(form, &bytes);
        }
    }

    /// Files that were written whole and then damaged: pieces repeated, lost, changed.
    #[test]
    fn damaged_files_are_read_or_refused(
        all in prop::collection::vec(annotation(), 1..6),
        damage in prop::collection::vec((any::<prop::sample::Index>(), any::<prop::sample::Index>(), 0..4u8, any::<u8>()), 1..6),
    ) {
        for form in LabelFormat::ALL {
            let of_clip = |a: &&Annotation| !form.is_of_one_clip() || a.clip == all[0].clip;
            let all: Vec<Annotation> = all.iter().filter(of_clip).cloned().collect();
            let mut bytes = write(form, &all, &lengths()).unwrap().into_bytes();
            for (at, length, how, byte) in &damage {
                if bytes.is_empty() {
                    break;
                }
                let at = at.index(bytes.len());
                let end = at + length.index(bytes.len() - at);
                match how {
                    0 => bytes[at] = *byte,
                    1 => drop(bytes.drain(at..end)),
                    2 => bytes.truncate(at),
                    _ => {
                        let again = bytes[at..end].to_vec();
                        bytes.splice(at..at, again);
                    }
                }
            }
            can_be_said(form, &bytes);
        }
    }
}

#[test]
fn files_of_other_programs() {
    let eaf = r#"<?xml version="1.0"?><ANNOTATION_DOCUMENT><HEADER><MEDIA_DESCRIPTOR MEDIA_URL="file:///x/take_1.mp4"/>
        </HEADER><TIME_ORDER><TIME_SLOT TIME_SLOT_ID="ts1" TIME_VALUE="500"/><TIME_SLOT TIME_SLOT_ID="ts2" TIME_VALUE="1508"/>
        <TIME_SLOT TIME_SLOT_ID="ts3"/></TIME_ORDER><TIER TIER_ID="t" PARTICIPANT="p">
        <ANNOTATION><ALIGNABLE_ANNOTATION ANNOTATION_ID="a1" TIME_SLOT_REF1="ts1" TIME_SLOT_REF2="ts2"><ANNOTATION_VALUE>nod</ANNOTATION_VALUE></ALIGNABLE_ANNOTATION></ANNOTATION>
        <ANNOTATION><ALIGNABLE_ANNOTATION ANNOTATION_ID="a2" TIME_SLOT_REF1="ts1" TIME_SLOT_REF2="ts3"><ANNOTATION_VALUE>open</ANNOTATION_VALUE></ALIGNABLE_ANNOTATION></ANNOTATION>
        </TIER></ANNOTATION_DOCUMENT>"#;
    let labels = read(LabelFormat::Eaf, eaf.as_bytes(), None, &lengths()).unwrap();
    assert_eq!((labels.annotations.len(), labels.warnings.len()), (1, 1));
    let a = &labels.annotations[0];
    assert_eq!(
        (a.clip.as_str(), a.class.as_str(), a.extent),
        ("take_1", "nod", Some((0.5, 1.508)))
    );
    // 1.508 s is what ELAN makes of frame 181 at 120 Hz.
    assert_eq!(snap(1.508, 120.0), 181.0 / 120.0);

    let babel = br#"{"12": {"babel_sid": 12, "feat_p": "CMU/CMU/86/86_01_poses.npz", "dur": 9.0,
        "seq_ann": {"labels": [{"raw_label": "he walks", "proc_label": "walk", "act_cat": ["walk", "move"]}]},
        "frame_ann": null}}"#;
    let labels = read(LabelFormat::Babel, babel, None, &lengths()).unwrap();
    let classes: Vec<&str> = labels
        .annotations
        .iter()
        .map(|a| a.class.as_str())
        .collect();
    assert_eq!(
        (labels.annotations[0].clip.as_str(), classes),
        ("86_01", vec!["walk", "move"])
    );

    let track = read(
        LabelFormat::Audacity,
        b"0,5\t1,25\tnod\n\\\t100\t200\n",
        Some("a"),
        &lengths(),
    )
    .unwrap();
    assert_eq!(track.annotations[0].extent, Some((0.5, 1.25)));
}

#[test]
fn mistakes_are_located() {
    let fails = |form, text: &str| {
        read(form, text.as_bytes(), Some("a"), &lengths())
            .unwrap_err()
            .to_string()
    };
    assert!(fails(LabelFormat::Csv, "a,b\n1,2\n").starts_with("line 1: expected a column `file`"));
    assert!(
        fails(LabelFormat::Csv, "file,label,start_s,end_s\na,b,3,2\n")
            .starts_with("line 2: expected a stop after")
    );
    assert!(
        fails(LabelFormat::Csv, "file,label\n\"a,b\n")
            .starts_with("line 2: expected a closing quote")
    );
    assert!(
        fails(LabelFormat::Audacity, "1\t2\ta\nx\t2\ta\n")
            .starts_with("line 2: expected start<TAB>stop")
    );
    assert!(fails(LabelFormat::Eaf, "<a>").contains("line 1"));
    assert!(fails(LabelFormat::Json, "{\"labels\": [{\"clip\": 3}]}").starts_with("line 1"));
    let several = [("a", 1), ("b", 2)].map(|(clip, _)| Annotation {
        clip: clip.into(),
        class: "x".into(),
        extent: Some((0.0, 1.0)),
        person: None,
        score: None,
        state: SampleState::Accepted,
    });
    assert!(
        write(LabelFormat::Eaf, &several, &lengths())
            .unwrap_err()
            .contains("one clip")
    );
}

#[test]
fn a_state_is_one_of_three_or_an_error_with_its_line() {
    for (form, between) in [(LabelFormat::Csv, ","), (LabelFormat::Tsv, "\t")] {
        let text = |state: &str| {
            let header = ["clip", "class", "start_secs", "stop_secs", "state"].join(between);
            format!(
                "{header}\n{}\n",
                ["take_1", "nod", "0.5", "1.5", state].join(between)
            )
        };
        let found = |state: &str| read(form, text(state).as_bytes(), None, &lengths());
        assert_eq!(
            found("Rejected").unwrap().annotations[0].state,
            SampleState::Rejected
        );
        if form == LabelFormat::Tsv {
            let by_cr = text("rejected").replace('\n', "\r");
            let labels = read(form, by_cr.as_bytes(), None, &lengths()).unwrap();
            assert_eq!(
                labels.annotations[0].state,
                SampleState::Rejected,
                "whatever ends the lines"
            );
        }
        assert_eq!(
            found("").unwrap().annotations[0].state,
            SampleState::Proposed,
            "nothing is no judgement"
        );
        let error = found("reject").unwrap_err().to_string();
        assert!(
            error.contains("line 2") && error.contains("`reject`"),
            "{error}"
        );
    }
}

#[test]
fn labels_of_clips_that_are_not_there_are_counted() {
    let tsv = "clip\tclass\tstart\tstop\nelsewhere\tnod\t5\t15\nelsewhere\tnod\t25\t35\n";
    let labels = read(LabelFormat::Tsv, tsv.as_bytes(), None, &lengths()).unwrap();
    assert_eq!(labels.absent, [("elsewhere".to_owned(), 2)].into());
    assert!(labels.annotations.is_empty());
}

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
        prop::option::of(prop::sample::select(vec!["ann", "Ben, the 2nd"])),
    )
        .prop_map(
            |((clip, length), class, start, frames, whole, person, score, state, annotator)| {
                Annotation {
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
                    annotator: annotator.map(str::to_owned),
                }
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
        annotator: None,
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
        if !form.has_annotators() {
            said.annotator = None;
        }
        let spelled = || a.extent.or_else(|| secs(a, &lengths()).ok());
        match form {
            LabelFormat::Csv | LabelFormat::Json => return said,
            LabelFormat::Tsv | LabelFormat::Babel => {}
            _ => said.extent = spelled(),
        }
        if !matches!(
            form,
            LabelFormat::Tsv | LabelFormat::Eaf | LabelFormat::Boris
        ) {
            said.person = None;
        }
        if form != LabelFormat::LabelStudio {
            said.score = None;
        }
        if matches!(
            form,
            LabelFormat::Audacity | LabelFormat::Boris | LabelFormat::Bids
        ) {
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
            let clip = matches!(form, LabelFormat::Audacity | LabelFormat::Bids).then(|| all[0].clip.as_str());
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
        annotator: None,
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

/// Reads a file by its ending and content, with what it says of the rest.
fn opened(name: &str, text: &str, clip: Option<&str>) -> (Vec<String>, String) {
    let form = LabelFormat::of_file(name, text.as_bytes()).unwrap();
    let read = read(form, text.as_bytes(), clip, &lengths()).unwrap();
    let shown = |a: &Annotation| {
        let (start, stop) = a.extent.unwrap_or_default();
        format!("{} {} {start:.3} {stop:.3}", a.clip, a.class)
    };
    let said: Vec<String> = read.warnings.iter().map(|w| w.text.clone()).collect();
    (
        read.annotations.iter().map(shown).collect(),
        said.join("\n"),
    )
}

#[test]
fn a_moment_costs_no_other_label() {
    let studio = r#"[{"data": {"csv": "/data/upload/1/ab12cd34-take_1.csv"}, "annotations": [{"result": [
        {"value": {"start": 1.2, "end": 2.4, "timeserieslabels": ["wave"]}},
        {"value": {"start": 3, "end": 3, "instant": true, "timeserieslabels": ["tap"]}}]}]}]"#;
    let babel = r#"{"1": {"feat_p": "X/take_1.npz", "seq_ann": {"labels": [{"act_cat": ["wave"]}]},
        "frame_ann": {"labels": [{"act_cat": ["wave"], "start_t": 1.2, "end_t": 2.4},
        {"proc_label": "tap", "act_cat": ["tap"], "start_t": 3, "end_t": 3}]}}}"#;
    let own = r#"{"labels": [{"clip": "take_1", "class": "wave", "start_secs": 1.2, "stop_secs": 2.4},
        {"clip": "take_1", "class": "tap", "start_secs": 3, "stop_secs": 3}]}"#;
    let aggregated = "Observation id\tMedia file\tSubject\tBehavior\tBehavior type\tStart (s)\tStop (s)\n\
        take_1\tx.mp4\tp\twave\tSTATE\t1.2\t2.4\ntake_1\tx.mp4\tp\ttap\tPOINT\t3\t3\n";
    let tabular = "Observation id,take_1\nMedia file(s),\n\nTime,Media file path,Subject,Behavior,Status\n\
        1.2,x.mp4,p,wave,START\n2.4,x.mp4,p,wave,STOP\n3,x.mp4,p,tap,POINT\n";
    let grid = "File type = \"ooTextFile\"\nObject class = \"TextGrid\"\n\nxmin = 0\nxmax = 9\ntiers? <exists>\nsize = 2\nitem []:\n\
        item [1]:\nclass = \"IntervalTier\"\nname = \"m\"\nxmin = 0\nxmax = 9\nintervals: size = 2\n\
        intervals [1]:\nxmin = 0\nxmax = 1.2\ntext = \"\"\nintervals [2]:\nxmin = 1.2\nxmax = 2.4\ntext = \"wave\"\n\
        item [2]:\nclass = \"TextTier\"\nname = \"p\"\nxmin = 0\nxmax = 9\npoints: size = 1\npoints [1]:\nnumber = 3\nmark = \"tap\"\n";
    let elan = r#"<ANNOTATION_DOCUMENT><HEADER TIME_UNITS="milliseconds"/><TIME_ORDER>
        <TIME_SLOT TIME_SLOT_ID="a" TIME_VALUE="1200"/><TIME_SLOT TIME_SLOT_ID="b" TIME_VALUE="2400"/>
        <TIME_SLOT TIME_SLOT_ID="c" TIME_VALUE="3000"/></TIME_ORDER><TIER TIER_ID="t">
        <ANNOTATION><ALIGNABLE_ANNOTATION ANNOTATION_ID="1" TIME_SLOT_REF1="a" TIME_SLOT_REF2="b"><ANNOTATION_VALUE>wave</ANNOTATION_VALUE></ALIGNABLE_ANNOTATION></ANNOTATION>
        <ANNOTATION><ALIGNABLE_ANNOTATION ANNOTATION_ID="2" TIME_SLOT_REF1="c" TIME_SLOT_REF2="c"><ANNOTATION_VALUE>tap</ANNOTATION_VALUE></ALIGNABLE_ANNOTATION></ANNOTATION>
        </TIER></ANNOTATION_DOCUMENT>"#;
    for (name, text) in [
        ("a.txt", "1.2\t2.4\twave\n3\t3\ttap\n"),
        ("a.json", studio),
        ("a.json", babel),
        ("a.json", own),
        (
            "a.csv",
            "file,label,start_s,end_s\ntake_1,wave,1.2,2.4\ntake_1,tap,3,3\n",
        ),
        (
            "a.csv",
            "clip;class;start_secs;stop_secs\nclips/take_1.bvh;wave;1,2;2,4\ntake_1;tap;3;3\n",
        ),
        (
            "a.tsv",
            "clip\tclass\tstart_secs\tstop_secs\ntake_1\twave\t1.2\t2.4\ntake_1\ttap\t3\t3\n",
        ),
        ("a.tsv", aggregated),
        ("a.csv", tabular),
        ("a.TextGrid", grid),
        ("a.eaf", elan),
    ] {
        let (labels, said) = opened(name, text, Some("take_1"));
        assert_eq!(labels.len(), 1, "{text}");
        assert!(
            labels[0].ends_with("wave 1.200 2.400"),
            "{labels:?}: {text}"
        );
        assert!(said.contains("`tap` is a point in time"), "{said}: {text}");
    }
    let (cues, _) = opened(
        "a.srt",
        "1\n00:00:01,200 --> 00:00:02,400\nwave\n\n2\n00:01:00,000 --> 00:01:01,000\nturn\nround\n",
        Some("take_1"),
    );
    assert_eq!(
        cues,
        ["take_1 wave 1.200 2.400", "take_1 turn round 60.000 61.000"]
    );
}

#[test]
fn results_of_label_studio_of_every_kind() {
    let task = |result: &str| {
        format!(
            r#"[{{"data": {{"video": "take_1.mp4"}}, "annotations": [{{"was_cancelled": true, "result": [{{"value": {{"start": 5, "end": 6, "labels": ["no"]}}}}]}},
            {{"result": [{result}]}}]}}]"#
        )
    };
    for result in [
        r#"{"value": {"start": 1.2, "end": 2.4, "labels": ["wave"]}}"#,
        r#"{"value": {"ranges": [{"start": 145, "end": 288}], "timelinelabels": ["wave"]}}"#,
        r#"{"value": {"sequence": [{"frame": 31, "enabled": true, "time": 1.2}, {"frame": 60, "enabled": false, "time": 2.4}], "labels": ["wave"]}}"#,
    ] {
        let (labels, said) = opened("a.json", &task(result), None);
        assert_eq!(labels, ["take_1 wave 1.200 2.400"], "{result}");
        assert!(said.contains("skipped"), "{said}");
    }
    let short = r#"[{"id": 1, "csv": "take_1.csv", "label": [{"start": 1.2, "end": 2.4, "timeserieslabels": ["wave"]}]}]"#;
    assert_eq!(opened("a.json", short, None).0, ["take_1 wave 1.200 2.400"]);
    let dated = task(
        r#"{"value": {"start": "2020-03-12 06:18:01", "end": "2020-03-12 06:18:02", "timeserieslabels": ["wave"]}}"#,
    );
    let error = read(LabelFormat::LabelStudio, dated.as_bytes(), None, &lengths()).unwrap_err();
    assert!(error.found.contains("date"), "{error}");
}

#[test]
fn times_of_elan_between_those_that_are_known() {
    let slot = |id: usize, value: &str| format!(r#"<TIME_SLOT TIME_SLOT_ID="s{id}"{value}/>"#);
    let note = |id: usize, text: &str| {
        let next = id + 1;
        format!(
            r#"<ANNOTATION><ALIGNABLE_ANNOTATION ANNOTATION_ID="n{id}" TIME_SLOT_REF1="s{id}" TIME_SLOT_REF2="s{next}">
            <ANNOTATION_VALUE>{text}</ANNOTATION_VALUE></ALIGNABLE_ANNOTATION></ANNOTATION>"#
        )
    };
    let hand = r#"<ANNOTATION><REF_ANNOTATION ANNOTATION_ID="h" ANNOTATION_REF="n1"><ANNOTATION_VALUE>left</ANNOTATION_VALUE></REF_ANNOTATION></ANNOTATION>"#;
    let file = |units: &str, first: &str, last: &str| {
        format!(
            r#"<ANNOTATION_DOCUMENT><HEADER TIME_UNITS="{units}"/><TIME_ORDER>{}{}{}{}</TIME_ORDER>
            <TIER TIER_ID="phase">{}{}{}</TIER><TIER TIER_ID="hand" PARENT_REF="phase">{hand}</TIER></ANNOTATION_DOCUMENT>"#,
            slot(0, first),
            slot(1, ""),
            slot(2, ""),
            slot(3, last),
            note(0, "prep"),
            note(1, "stroke"),
            note(2, "retract"),
        )
    };
    let millis = file(
        "milliseconds",
        r#" TIME_VALUE="1200""#,
        r#" TIME_VALUE="2400""#,
    );
    let frames = file("PAL-frames", r#" TIME_VALUE="30""#, r#" TIME_VALUE="60""#);
    for text in [&millis, &frames] {
        let (labels, _) = opened("a.eaf", text, Some("take_1"));
        assert_eq!(
            labels,
            [
                "take_1 prep 1.200 1.600",
                "take_1 stroke 1.600 2.000",
                "take_1 retract 2.000 2.400"
            ]
        );
    }
    let tiers = ["hand".to_owned()];
    let context = LabelContext {
        clip: Some("take_1"),
        tiers: &tiers,
        ..LabelContext::default()
    };
    let chosen = read_with(LabelFormat::Eaf, millis.as_bytes(), &context).unwrap();
    assert_eq!(chosen.annotations.len(), 1);
    let (start, stop) = chosen.annotations[0].extent.unwrap();
    assert!((start - 1.6).abs() < 1e-9 && (stop - 2.0).abs() < 1e-9);
    let none = LabelContext {
        tiers: &["arm".to_owned()],
        ..context
    };
    let error = read_with(LabelFormat::Eaf, millis.as_bytes(), &none).unwrap_err();
    assert!(error.expected.contains("phase, hand"), "{error}");
}

/// A C3D file without points, with these events in its header.
fn c3d(first_frame: u16, events: &[(f32, &str)]) -> Vec<u8> {
    let mut bytes = vec![0; 1024];
    bytes[..2].copy_from_slice(&[2, 0x50]);
    bytes[6..8].copy_from_slice(&first_frame.to_le_bytes());
    bytes[8..10].copy_from_slice(&(first_frame + 999).to_le_bytes());
    bytes[20..24].copy_from_slice(&100f32.to_le_bytes());
    bytes[298..300].copy_from_slice(&12345u16.to_le_bytes());
    bytes[300..302].copy_from_slice(&(events.len() as u16).to_le_bytes());
    for (at, (secs, name)) in events.iter().enumerate() {
        bytes[304 + 4 * at..308 + 4 * at].copy_from_slice(&secs.to_le_bytes());
        bytes[396 + 4 * at..396 + 4 * at + name.len()].copy_from_slice(name.as_bytes());
    }
    bytes[512..516].copy_from_slice(&[1, 0x50, 1, 84]);
    bytes
}

#[test]
fn events_of_c3d_are_stretches_between_them() {
    let file = c3d(
        101,
        &[
            (1.5, "RFS"),
            (2.5, "RFS"),
            (1.25, "w on"),
            (1.75, "wOFF"),
            (2.0, "LFS"),
        ],
    );
    assert_eq!(
        LabelFormat::of_file("walk.c3d", &file),
        Some(LabelFormat::Audacity)
    );
    let labels = read(LabelFormat::Audacity, &file, Some("walk"), &lengths()).unwrap();
    let said: Vec<String> = labels.warnings.iter().map(|w| w.text.clone()).collect();
    // Times of a file count from its frame 1, those of a clip from its first.
    let found: Vec<_> = labels
        .annotations
        .iter()
        .map(|a| (a.class.as_str(), a.extent))
        .collect();
    assert_eq!(found, [("RFS", Some((0.5, 1.5)))], "{said:?}");
    assert_eq!(said.len(), 4, "{said:?}");
    assert!(
        said.iter().any(|text| text.contains("`LFS` at 1.000 s")),
        "{said:?}"
    );
    let pair = c3d(1, &[(0.5, "a on"), (1.0, "aoff"), (0.75, "b")]);
    let labels = read(LabelFormat::Audacity, &pair, Some("walk"), &lengths()).unwrap();
    assert!(
        labels.annotations.is_empty(),
        "off without a blank is a name of its own"
    );
    let none = read(
        LabelFormat::Audacity,
        &c3d(1, &[]),
        Some("walk"),
        &lengths(),
    );
    assert!(none.unwrap_err().expected.contains("events"));
}

#[test]
fn frames_may_count_from_the_first_of_a_file() {
    let first = std::collections::BTreeMap::from([("walk".to_owned(), 101)]);
    let context = LabelContext {
        label_rate_hz: Some(100.0),
        first_frames: Some(&first),
        ..LabelContext::default()
    };
    let tsv = "clip\tclass\tstart\tstop\nwalk.c3d\twave\t151\t201\nother\twave\t151\t201\n";
    let csv = "file,label,start_frame,end_frame\nwalk,wave,151,201\nother,wave,151,201\n";
    let json = r#"{"labels": [{"clip": "walk", "class": "wave", "start": 151, "stop": 201}, {"clip": "other", "class": "wave", "start": 151, "stop": 201}]}"#;
    for (form, text) in [
        (LabelFormat::Tsv, tsv),
        (LabelFormat::Csv, csv),
        (LabelFormat::Json, json),
    ] {
        let read = read_with(form, text.as_bytes(), &context).unwrap();
        let extents: Vec<_> = read.annotations.iter().map(|a| a.extent.unwrap()).collect();
        let pairs = extents.iter().zip([(0.5, 1.0), (1.51, 2.01)]);
        let is_near =
            |(a, b): (&(f64, f64), (f64, f64))| (a.0 - b.0).abs() + (a.1 - b.1).abs() < 1e-9;
        assert!(
            extents.len() == 2 && pairs.into_iter().all(is_near),
            "{extents:?} of {text}"
        );
    }
}

#[test]
fn textgrids_may_be_in_utf16() {
    let text = "File type = \"ooTextFile\"\nObject class = \"TextGrid\"\n\n0\n3\n<exists>\n1\n\"IntervalTier\"\n\"hand\"\n0\n3\n1\n1.2\n2.4\n\"grüßen\"\n";
    let wide: Vec<u8> = text.encode_utf16().flat_map(u16::to_be_bytes).collect();
    let file = [&[0xFE, 0xFF], wide.as_slice()].concat();
    let read = read(LabelFormat::Audacity, &file, Some("take_1"), &lengths()).unwrap();
    assert_eq!(read.annotations.len(), 1);
    assert_eq!(read.annotations[0].class, "grüßen");
}

proptest! {
    #[test]
    fn any_text_of_one_clip_is_read_or_refused(text in "(ooTextFile|-->|IntervalTier|\"|[0-9.:,\n]| ){0,60}") {
        let _ = read(LabelFormat::Audacity, text.as_bytes(), Some("take_1"), &lengths());
        let _ = read(LabelFormat::Csv, text.as_bytes(), None, &lengths());
    }
}

#[test]
fn a_project_of_boris() {
    let project = r#"{"project_format_version": "7.0",
        "behaviors_conf": {"0": {"type": "State event", "code": "walk"}, "1": {"type": "Point event", "code": "peck"}},
        "observations": {"obs 1": {"file": {"1": ["videos/take_1.mp4"]}, "events": [
            [0.5, "ann", "walk", "", ""], [1.0, "No focal subject", "walk", "fast", ""], [1.5, "ann", "walk", "", "end"],
            [1.7, "ann", "peck", "", "", 51], [2.0, "No focal subject", "walk", "fast", ""], [2.5, "ben", "walk", "", ""]]}}}"#;
    let labels = read(LabelFormat::Boris, project.as_bytes(), None, &lengths()).unwrap();
    let found: Vec<_> = labels
        .annotations
        .iter()
        .map(|a| (a.clip.as_str(), a.person.as_deref(), a.extent))
        .collect();
    assert_eq!(
        found,
        [
            ("videos/take_1.mp4", Some("ann"), Some((0.5, 1.5))),
            ("videos/take_1.mp4", None, Some((1.0, 2.0))),
        ]
    );
    let said: Vec<String> = labels.warnings.iter().map(ToString::to_string).collect();
    assert_eq!(said.len(), 3, "{said:?}");
    assert!(
        said[0].contains("point in time")
            && said[1].contains("has no stop")
            && said[2].contains("2 events have modifiers")
    );
}

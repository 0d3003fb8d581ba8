use super::*;
use crate::clip::Gap;

fn table(points: &[(&str, &[f64])]) -> PointTable {
    let point = |(name, xs): &(&str, &[f64])| Point {
        name: (*name).to_owned(),
        positions: xs.iter().map(|&x| Vec3::new(x, 1.0, 2.0)).collect(),
    };
    PointTable {
        points: points.iter().map(point).collect(),
        rate_hz: 8.0,
        metres_per_unit: None,
        zero_is_missing: true,
    }
}

fn load(table: PointTable) -> Loaded {
    table
        .into_loaded("take", Vec::new(), &Limits::default())
        .unwrap()
}

const N: f64 = f64::NAN;

#[test]
fn short_gaps_are_filled_and_long_ones_kept() {
    let loaded = load(table(&[
        ("A", &[0.0, N, N, 3.0, 4.0, N, N, N, 8.0]),
        ("B", &[N, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, N]),
        ("C", &[N; 9]),
        ("*7", &[1.0; 9]),
    ]));
    let clip = &loaded.clips[0];
    assert_eq!(clip.skeleton.len(), 2);
    // Two frames at 8 Hz are a quarter of a second.
    assert_eq!(clip.repaired, [1..3]);
    let gap = |joint, frames| Gap { joint, frames };
    let gaps = &clip.points.as_ref().unwrap().gaps;
    assert_eq!(gaps, &[gap(0, 5..8), gap(1, 0..1), gap(1, 8..9)]);
    let xs: Vec<f64> = clip.tracks[0].positions.iter().map(|p| p.x).collect();
    assert_eq!(xs, [0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0]);
    let ends = [0, 8].map(|f: usize| clip.tracks[1].positions[f].x);
    assert_eq!(ends, [1.0, 7.0]);
    let text: Vec<String> = loaded.warnings.iter().map(ToString::to_string).collect();
    let text = text.join("\n");
    for said in [
        "1 points never seen",
        "left out: C",
        "without a label",
        "*7",
        "A from 0.6",
    ] {
        assert!(text.contains(said), "{said}: {text}");
    }
}

#[test]
fn the_origin_is_a_gap_but_for_a_pelvis_that_rests_there() {
    let mut table = table(&[("Pelvis", &[0.0; 4]), ("Hand", &[1.0, 0.0, 1.0, 1.0])]);
    for point in &mut table.points {
        for p in &mut point.positions {
            *p = Vec3::repeat(p.x);
        }
    }
    let clip = &load(table).clips[0];
    assert_eq!(clip.tracks[0].positions, [Vec3::zeros(); 4]);
    assert_eq!(clip.tracks[1].positions, [Vec3::repeat(1.0); 4]);
}

#[test]
fn nothing_seen_is_an_error() {
    let error = table(&[("A", &[N, N])])
        .into_loaded("take", Vec::new(), &Limits::default())
        .unwrap_err();
    assert!(error.found.contains("no motion"), "{error}");
}

#[test]
fn each_body_is_a_clip() {
    let joints = [
        "hips",
        "left_hip",
        "left_knee",
        "left_ankle",
        "right_hip",
        "right_knee",
        "right_ankle",
        "neck",
        "head",
        "left_shoulder",
        "left_elbow",
        "left_wrist",
        "right_shoulder",
        "right_elbow",
        "right_wrist",
    ];
    let names: Vec<String> = ["Anna", "Ben"]
        .iter()
        .flat_map(|who| joints.iter().map(move |joint| format!("{who}:{joint}")))
        .chain(["Ball:1".to_owned()])
        .collect();
    let xs = [1.0, 2.0];
    let points: Vec<(&str, &[f64])> = names.iter().map(|n| (n.as_str(), xs.as_slice())).collect();
    let loaded = load(table(&points));
    let counts: Vec<usize> = loaded.clips.iter().map(|c| c.skeleton.len()).collect();
    assert_eq!(counts, [15, 15]);
    assert_eq!(loaded.clips[1].name, "take.2");
    assert!(loaded.warnings.iter().any(|w| w.text.contains("Ball:1")));
}

#[test]
fn people_before_the_names_of_points_are_subjects() {
    let named = |names: &[&str]| {
        let point = |name: &&str| Point {
            name: (*name).to_owned(),
            positions: vec![Vec3::new(1.0, 1.0, 1.0); 2],
        };
        let mut table = PointTable {
            points: names.iter().map(point).collect(),
            rate_hz: 30.0,
            metres_per_unit: None,
            zero_is_missing: true,
        };
        table.name_subjects();
        table
            .points
            .into_iter()
            .map(|p| p.name)
            .collect::<Vec<String>>()
    };
    let two = ["P1_nose", "P1_hip", "P2_nose", "P2_hip"];
    assert_eq!(named(&two), ["P1:nose", "P1:hip", "P2:nose", "P2:hip"]);
    for none in [
        ["P1_nose", "P1_hip", "P1_knee", "P1_foot"],
        ["P1_nose", "P1_hip", "P2_nose", "P2_knee"],
        ["L1_nose", "L1_hip", "L2_nose", "L2_hip"],
    ] {
        assert_eq!(named(&none), none);
    }
}

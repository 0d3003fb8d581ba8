//! Animals in a picture: points in two dimensions of a custom skeleton, as DeepLabCut writes them.

use std::fmt::Write as _;

use morec::rng::Rng;
use serde_json::Value;

use crate::kit::Folder;

const RATE_HZ: f64 = 30.0;
/// Seven points of a mouse from above: name, along the body and to its left, pixels.
const POINTS: [(&str, f64, f64); 7] = [
    ("nose", 55.0, 0.0),
    ("left_ear", 38.0, 12.0),
    ("right_ear", 38.0, -12.0),
    ("middle", 0.0, 0.0),
    ("left_hip", -25.0, 15.0),
    ("right_hip", -25.0, -15.0),
    ("tail_base", -42.0, 0.0),
];
const ROLES: &str = "point_1\tmiddle\npoint_2\tnose\npoint_3\ttail_base\nleft_point_1\tleft_hip\n\
    right_point_1\tright_hip\nleft_point_2\tleft_ear\nright_point_2\tright_ear\n";

/// A mouse that walks about, turns round and rears; rows of DeepLabCut, and labels in frames.
struct Mouse {
    rng: Rng,
    rows: String,
    labels: String,
    name: String,
    frame: usize,
    at: (f64, f64, f64),
}

impl Mouse {
    fn new(number: u64) -> Self {
        let of = |word: &str| format!(",{word}").repeat(3 * POINTS.len());
        let names = POINTS.map(|(name, ..)| format!(",{name}").repeat(3));
        let rows = format!(
            "scorer{}\nbodyparts{}\ncoords{}\n",
            of("net"),
            names.concat(),
            ",x,y,likelihood".repeat(POINTS.len())
        );
        Self {
            rng: Rng::new(number),
            rows,
            labels: String::new(),
            name: format!("mouse_{number}"),
            frame: 0,
            at: (320.0, 240.0, 0.3),
        }
    }

    /// A frame of a body that is `short` of its length, after a step along the body and a turn.
    fn step(&mut self, step: f64, turn: f64, short: f64) {
        self.at.2 += turn;
        let (sin, cos) = self.at.2.sin_cos();
        self.at.0 += step * cos;
        self.at.1 += step * sin;
        let _ = write!(self.rows, "{}", self.frame);
        for (name, along, left) in POINTS {
            // What rears hides its hips and comes nearer to the camera with its ears.
            let is_front = along > 0.0;
            let (along, left) = match is_front {
                true => (along * (1.0 - short), left * (1.0 + 0.5 * short)),
                false => (along * (1.0 - 0.4 * short), left),
            };
            let mut noisy = |value: f64| value + 0.4 * self.rng.normal();
            let x = noisy(self.at.0 + along * cos - left * sin);
            let y = noisy(self.at.1 + along * sin + left * cos);
            // Now and then the nose is lost, and lies anywhere.
            let lost = name == "nose" && self.frame % 97 < 2;
            let (x, likelihood) = if lost { (5.0, 0.1) } else { (x, 0.98) };
            let _ = write!(self.rows, ",{x:.2},{y:.2},{likelihood}");
        }
        self.rows.push('\n');
        self.frame += 1;
    }

    fn walk(&mut self, secs: f64) {
        for frame in 0..(secs * RATE_HZ) as usize {
            let sway = 0.012 * (frame as f64 / 9.0).sin();
            self.step(1.5, sway, 0.0);
        }
    }

    fn act(&mut self, class: &str) {
        let start = self.frame;
        let secs = 0.9 + 0.2 * self.rng.normal().abs().min(1.0);
        let frames = (secs * RATE_HZ) as usize;
        for frame in 0..frames {
            let bell = (std::f64::consts::PI * (frame as f64 + 0.5) / frames as f64).sin();
            match class {
                "turn" => self.step(0.3, 5.0 * bell / frames as f64, 0.0),
                _ => self.step(0.0, 0.0, 0.7 * bell),
            }
        }
        let _ = writeln!(
            self.labels,
            "{}\t{start}\t{}\t{class}",
            self.name, self.frame
        );
    }

    fn film(number: u64) -> Self {
        let mut mouse = Self::new(number);
        mouse.walk(2.0);
        for round in 0..10 {
            mouse.act(if (round + number).is_multiple_of(2) {
                "turn"
            } else {
                "rear"
            });
            mouse.walk(1.5 + 0.3 * (round % 3) as f64);
        }
        mouse
    }
}

#[test]
fn two_mice_teach_what_a_third_does_and_no_height_is_asked_for() {
    let mice = [1, 2, 3].map(Mouse::film);
    let header = "clip\tstart\tstop\tclass\n";
    let labels = [header, &mice[0].labels, &mice[1].labels].concat();
    let truth = [header, &mice[2].labels].concat();
    let folder = Folder::with(&[
        ("clips/mouse_1.csv", &mice[0].rows),
        ("clips/mouse_2.csv", &mice[1].rows),
        ("new/mouse_3.csv", &mice[2].rows),
        ("labels.tsv", &labels),
        ("truth.tsv", &truth),
        ("mouse.roles", ROLES),
    ]);
    let refused = folder.morec(&["inspect", "new/mouse_3.csv"]).fails();
    assert!(
        refused.contains("two dimensions") && refused.contains("--roles"),
        "{refused}"
    );
    let read = ["--roles", "mouse.roles", "--file-rate", "30"];
    let inspected = folder.morec(&[&["inspect", "new/mouse_3.csv"], &read[..]].concat());
    let said = inspected.ok();
    assert!(!said.contains("human"), "{said}");
    folder.train("mouse.index", &read).ok();
    let found = folder.morec(&[&["recognize", "mouse.index", "new"], &read[2..]].concat());
    let found = found.ok();
    std::fs::write(folder.path().join("found.tsv"), &found).unwrap();
    let evaluate = [
        "evaluate",
        "--labels",
        "truth.tsv",
        "--found",
        "found.tsv",
        "--clips",
        "new",
        "--json",
    ];
    let figures = folder.morec(&[&evaluate[..], &read[2..]].concat()).ok();
    let figures: Value = serde_json::from_str(&figures).unwrap();
    let events = &figures["events"];
    assert_eq!(events["matched"], 10, "{events}\n{found}");
    assert_eq!(events["spurious"], 0, "{events}\n{found}");
    // The index knows the points: whole clips, a page and a stream need no --roles either.
    let named = folder.morec(&[&["classify", "mouse.index", "new"], &read[2..]].concat());
    assert!(named.ok().contains("\nmouse_3\t"));
    let play = [
        "play",
        "new/mouse_3.csv",
        "--index",
        "mouse.index",
        "-o",
        "mouse.html",
    ];
    folder.morec(&[&play[..], &read[2..]].concat()).ok();
    let stream = "clip://new/mouse_3.csv?speed=0&rate=30";
    let live = folder.morec(&["live", "mouse.index", "--listen", stream]);
    assert_eq!(live.code, Some(0), "{live:?}");
    assert!(live.err.contains("10 motions"), "{}", live.err);
    // Pixels are no centimetres.
    assert!(!live.err.contains("jitter by"), "{}", live.err);
}

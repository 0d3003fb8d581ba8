//! Files made here byte by byte, apart from the writer, with every processor and every fault that was seen.

use proptest::prelude::*;

use super::*;
use crate::clip::{Clip, Gap, Points};
use crate::math::Vec3;

/// A C3D file to be.
struct Made {
    processor: Processor,
    floats: bool,
    labels: Vec<String>,
    /// `frames[f][p]` and whether it was seen.
    frames: Vec<Vec<(Vec3, bool)>>,
    scale: f64,
    first_frame: u16,
    /// Header words that are overwritten: number from 1, value.
    words: Vec<(usize, u16)>,
    units: &'static str,
    /// Further parameters of POINT: name, kind, dimensions, values as text or numbers.
    more: Vec<(&'static str, Vec<u8>, Vec<u8>, i8)>,
    /// Block of the parameters.
    block: u8,
    analog: usize,
}

impl Made {
    fn new(processor: Processor, floats: bool) -> Self {
        let frame = |f: usize| {
            let point = |p: usize| Vec3::new(f as f64 + 1.0, 10.0 * p as f64, -2.5);
            (0..3).map(|p| (point(p), true)).collect()
        };
        Self {
            processor,
            floats,
            labels: ["A", "B", "C"].map(str::to_owned).to_vec(),
            frames: (0..9).map(frame).collect(),
            scale: 0.5,
            first_frame: 1,
            words: Vec::new(),
            units: "mm",
            more: Vec::new(),
            block: 2,
            analog: 0,
        }
    }

    fn word(&self, value: u16) -> [u8; 2] {
        match self.processor {
            Processor::Sgi => value.to_be_bytes(),
            _ => value.to_le_bytes(),
        }
    }

    fn float(&self, value: f64) -> [u8; 4] {
        match self.processor {
            Processor::Intel => (value as f32).to_le_bytes(),
            Processor::Sgi => (value as f32).to_be_bytes(),
            Processor::Dec => {
                // Four times the number has the VAX's exponent; words are swapped.
                let [a, b, c, d] = (value as f32 * 4.0).to_be_bytes();
                [b, a, d, c]
            }
        }
    }

    fn parameter(&self, out: &mut Vec<u8>, name: &str, kind: i8, dims: &[u8], data: &[u8]) {
        out.extend([name.len() as u8, 1]);
        out.extend(name.as_bytes());
        out.extend(self.word((2 + 2 + dims.len() + data.len() + 1) as u16));
        out.extend([kind as u8, dims.len() as u8]);
        out.extend(dims);
        out.extend(data);
        out.push(0);
    }

    fn bytes(&self) -> Vec<u8> {
        let stated = if self.floats { -self.scale } else { self.scale };
        let processor = match self.processor {
            Processor::Intel => 84,
            Processor::Dec => 85,
            Processor::Sgi => 86,
        };
        let mut section = vec![1, 0x50, 0, processor];
        section.extend([5, 0xFF]);
        section.extend(b"POINT");
        section.extend(self.word(3));
        section.push(0);
        let count = self.labels.len().min(255);
        let label = |name: &String| format!("{name:8}").into_bytes();
        let labels: Vec<u8> = self.labels.iter().take(255).flat_map(label).collect();
        self.parameter(&mut section, "LABELS", -1, &[8, count as u8], &labels);
        let used = self.word(self.labels.len() as u16);
        self.parameter(&mut section, "USED", 2, &[], &used);
        self.parameter(&mut section, "SCALE", 4, &[], &self.float(stated));
        self.parameter(&mut section, "RATE", 4, &[], &self.float(120.0));
        let units = self.units.as_bytes();
        if !units.is_empty() {
            self.parameter(&mut section, "UNITS", -1, &[units.len() as u8], units);
        }
        for (name, dims, data, kind) in &self.more {
            self.parameter(&mut section, name, *kind, dims, data);
        }
        section.resize((section.len() + 2).next_multiple_of(BLOCK), 0);
        let before = vec![0; BLOCK * (usize::from(self.block) - 2)];
        let data_block = usize::from(self.block) + section.len() / BLOCK;
        let mut header = vec![self.block, 0x50];
        let last = self
            .first_frame
            .wrapping_add(self.frames.len() as u16)
            .wrapping_sub(1);
        for value in [
            self.labels.len() as u16,
            self.analog as u16,
            self.first_frame,
            last,
            10,
        ] {
            header.extend(self.word(value));
        }
        header.extend(self.float(stated));
        header.extend(self.word(data_block as u16));
        header.extend(self.word(1));
        header.extend(self.float(120.0));
        header.resize(BLOCK, 0);
        for &(number, value) in &self.words {
            header[2 * number - 2..2 * number].copy_from_slice(&self.word(value));
        }
        let mut bytes = [header, before, section].concat();
        for frame in &self.frames {
            for (at, seen) in frame {
                let residual = if *seen { 0.0 } else { -1.0 };
                for value in [at.x, at.y, at.z] {
                    if self.floats {
                        bytes.extend(self.float(value));
                    } else {
                        bytes.extend(self.word((value / self.scale).round() as i16 as u16));
                    }
                }
                if self.floats {
                    bytes.extend(self.float(residual));
                } else {
                    bytes.extend(self.word(residual as i16 as u16));
                }
            }
            for _ in 0..self.analog {
                bytes.extend(if self.floats { vec![7; 4] } else { vec![7; 2] });
            }
        }
        bytes.resize(bytes.len().next_multiple_of(BLOCK), 0);
        bytes
    }
}

fn load(bytes: &[u8]) -> Loaded {
    read(bytes, "take", None, &Limits::default()).unwrap()
}

fn one(made: &Made) -> (Clip, String) {
    let mut loaded = load(&made.bytes());
    let text: Vec<String> = loaded.warnings.iter().map(ToString::to_string).collect();
    (loaded.clips.remove(0), text.join("\n"))
}

#[test]
fn every_processor_reads_the_same() {
    for processor in Processor::ALL {
        for floats in [true, false] {
            let made = Made::new(processor, floats);
            let (clip, said) = one(&made);
            assert_eq!(said, "", "{processor:?} {floats}");
            assert_eq!((clip.frames, clip.rate_hz), (9, 120.0));
            assert_eq!(clip.points.as_ref().unwrap().metres_per_unit, Some(0.001));
            for (p, track) in clip.tracks.iter().enumerate() {
                for (f, at) in track.positions.iter().enumerate() {
                    assert_eq!(*at, made.frames[f][p].0, "{processor:?} {floats}");
                }
            }
        }
    }
}

#[test]
fn what_was_not_seen_is_a_gap() {
    for floats in [true, false] {
        let mut made = Made::new(Processor::Intel, floats);
        made.frames[4][1].1 = false;
        made.frames[5][1].0 = Vec3::zeros();
        if floats {
            made.frames[7][2].0.y = f64::NAN;
        }
        let (clip, said) = one(&made);
        let repaired = if floats { vec![4..6, 7..8] } else { vec![4..6] };
        assert_eq!(clip.repaired, repaired, "{said}");
        assert!((clip.tracks[1].positions[4].x - 5.0).abs() < 1e-9);
    }
}

#[test]
fn header_and_parameters_disagree() {
    // Word 2 counts points, 3 analog values, 5 is the last frame, 7 and 8 the scale, 9 the data's block.
    for words in [
        vec![(2, 7)],
        vec![(3, 5)],
        vec![(9, 40)],
        vec![(4, 1), (5, 0)],
        vec![(4, 1), (5, 4000)],
    ] {
        let mut made = Made::new(Processor::Sgi, true);
        made.words.clone_from(&words);
        made.more
            .push(("FRAMES", vec![], 9u16.to_be_bytes().to_vec(), 2));
        let start = made.word(3);
        made.more.push(("DATA_START", vec![], start.to_vec(), 2));
        let (clip, text) = one(&made);
        assert_eq!(clip.frames, 9, "{words:?} {text}");
        assert_eq!(
            clip.tracks[2].positions[8],
            Vec3::new(9.0, 20.0, -2.5),
            "{words:?}"
        );
    }
    let mut made = Made::new(Processor::Intel, false);
    // The header's scale is 2.0.
    made.words = vec![(7, 0), (8, 0x4000)];
    let (clip, text) = one(&made);
    assert_eq!(clip.tracks[1].positions[0], Vec3::new(1.0, 10.0, -2.5));
    assert!(text.contains("POINT:SCALE"), "{text}");
}

#[test]
fn frames_may_begin_anywhere_and_parameters_lie_elsewhere() {
    for (first, block) in [(0, 2), (2925, 7), (65000, 3)] {
        let mut made = Made::new(Processor::Dec, true);
        (made.first_frame, made.block) = (first, block);
        let (clip, said) = one(&made);
        assert_eq!((clip.frames, said.as_str()), (9, ""));
    }
    // The header points nowhere: block 2 is tried.
    let mut bytes = Made::new(Processor::Intel, true).bytes();
    bytes[0] = 99;
    assert_eq!(load(&bytes).clips[0].frames, 9);
}

#[test]
fn more_labels_and_frames_than_a_word_or_byte_counts() {
    let mut made = Made::new(Processor::Intel, true);
    made.labels = (0..300).map(|p| format!("M{p}")).collect();
    let frame: Vec<(Vec3, bool)> = (0..300)
        .map(|p| (Vec3::repeat(1.0 + p as f64), true))
        .collect();
    made.frames = vec![frame; 4];
    let more: Vec<u8> = (255..300)
        .flat_map(|p| format!("M{p}    ").into_bytes())
        .collect();
    made.more.push(("LABELS2", vec![8, 45], more, -1));
    let (clip, said) = one(&made);
    assert_eq!((clip.skeleton.len(), said.as_str()), (300, ""));
    assert_eq!(clip.skeleton.joints()[299].name, "M299");

    let mut made = Made::new(Processor::Intel, false);
    made.labels.truncate(1);
    made.frames = vec![vec![(Vec3::repeat(1.0), true)]; 70_000];
    made.words = vec![(5, u16::MAX)];
    let frames = (70_000f32).to_le_bytes().to_vec();
    made.more.push(("LONG_FRAMES", vec![], frames, 4));
    assert_eq!(one(&made).0.frames, 70_000);
}

#[test]
fn analog_values_and_angles_are_left_out() {
    let mut made = Made::new(Processor::Dec, false);
    made.analog = 12;
    made.labels[1] = "KAngles".to_owned();
    let (clip, said) = one(&made);
    assert_eq!(clip.skeleton.len(), 2);
    assert_eq!(clip.tracks[1].positions[3], made.frames[3][2].0);
    assert!(said.contains("1 angles"), "{said}");
}

#[test]
fn units_may_be_missing_and_files_cut() {
    let mut made = Made::new(Processor::Intel, true);
    made.units = "";
    let (clip, said) = one(&made);
    assert_eq!(clip.points.unwrap().metres_per_unit, None);
    assert!(said.contains("no POINT:UNITS"), "{said}");
    made.frames = vec![made.frames[0].clone(); 100];
    let bytes = made.bytes();
    let loaded = load(&bytes[..1024 + 48 * 20 + 7]);
    assert_eq!(loaded.clips[0].frames, 20);
    assert!(
        loaded
            .warnings
            .iter()
            .any(|w| w.text.contains("ends after 20 of 100"))
    );
}

#[test]
fn what_cannot_be_read_is_said_plainly() {
    let fail = |bytes: &[u8]| {
        read(bytes, "x", None, &Limits::default())
            .unwrap_err()
            .to_string()
    };
    assert!(fail(b"").contains("an empty file"));
    assert!(fail(&[2, 0x50, 0]).contains("3 bytes"));
    assert!(fail(&[0; 600]).contains("0x50"));
    let mut made = Made::new(Processor::Intel, true);
    made.labels.clear();
    made.frames = vec![Vec::new()];
    made.analog = 2;
    assert!(fail(&made.bytes()).contains("points in the C3D file"));
    let mut none = Made::new(Processor::Intel, true);
    none.frames.clear();
    let text = fail(&none.bytes());
    assert!(text.contains("frames"), "{text}");
}

#[test]
fn events_are_named() {
    let mut bytes = Made::new(Processor::Intel, true).bytes();
    bytes[298..300].copy_from_slice(&12345u16.to_le_bytes());
    bytes[300..302].copy_from_slice(&1u16.to_le_bytes());
    bytes[304..308].copy_from_slice(&0.05f32.to_le_bytes());
    bytes[396..400].copy_from_slice(b"RHS ");
    let text = load(&bytes).warnings[0].text.clone();
    assert_eq!(text, "1 events: RHS at 0.050 s");
}

#[test]
fn cut_or_altered_files_never_panic() {
    let limits = Limits::default();
    for processor in Processor::ALL {
        let bytes = Made::new(processor, processor == Processor::Sgi).bytes();
        for end in (0..bytes.len()).step_by(13) {
            let _ = read(&bytes[..end], "x", None, &limits);
        }
        for at in 0..bytes.len() {
            for value in [0, 1, 0x7F, 0x80, 0xFF] {
                let mut altered = bytes.clone();
                altered[at] = value;
                if let Ok(loaded) = read(&altered, "x", None, &limits) {
                    let finite = |clip: &Clip| {
                        let mut all = clip
                            .tracks
                            .iter()
                            .flat_map(|t| t.positions.iter().flatten());
                        all.all(|v| v.is_finite())
                    };
                    assert!(loaded.clips.iter().all(finite));
                }
            }
        }
    }
}

proptest! {
    /// Reading a written file gives the clip that was written, with its gaps.
    #[test]
    fn written_files_are_read_again(points in 1usize..300, frames in 1usize..40, hole in 0usize..40) {
        let track = |p: usize| -> Vec<Vec3> {
            (0..frames).map(|f| Vec3::new(p as f64 + 0.25, f as f64 - 3.5, 1.0)).collect()
        };
        let names = (0..points).map(|p| (format!("Anna:{p}"), track(p)));
        let gaps = if hole < frames { vec![Gap { joint: 0, frames: hole..frames }] } else { Vec::new() };
        let whole = hole == 0;
        let known = Points { gaps, metres_per_unit: Some(0.01) };
        let clip = Clip::of_points("take".into(), 100.0, names, known);
        let mut bytes = Vec::new();
        write(&clip, &mut bytes).unwrap();
        let read = read(&bytes, "take", None, &Limits::default());
        if points == 1 && whole {
            prop_assert!(read.is_err());
            return Ok(());
        }
        let again = read.unwrap().clips.remove(0);
        // A point that is never seen is left out.
        let left_out = usize::from(whole);
        prop_assert_eq!(again.skeleton.len(), points - left_out);
        prop_assert_eq!(again.points.as_ref().unwrap().metres_per_unit, Some(0.01));
        for p in left_out..points {
            let last = if p == 0 { hole.min(frames) } else { frames };
            let track = &again.tracks[p - left_out].positions;
            prop_assert_eq!(&track[..last], &clip.tracks[p].positions[..last]);
        }
        if !whole {
            prop_assert_eq!(&again.points.unwrap().gaps, &clip.points.unwrap().gaps);
        }
    }
}

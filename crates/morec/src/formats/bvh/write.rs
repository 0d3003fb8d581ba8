//! Clips to BVH.

use std::io::{self, Write};

use super::positions::{self, PositionChannels};
use super::{euler, points};
use crate::clip::{Clip, JointTrack};
use crate::math::Vec3;

/// Writes `clip` as BVH: roots with `Xposition Yposition Zposition Zrotation Yrotation Xrotation`, other joints with
/// the three rotations, and with positions as well where they move in their parent's frame. Joints are written
/// depth first. Angles run on past ±180° rather than jump.
///
/// [`read`](super::read) gives the same rotations within 1e-6 rad and the same positions within 1e-6 units, with
/// these exceptions that programs in use ask for: a leaf without a tip gets one of length 0; a root's OFFSET is 0, as
/// some add it to the position channels; names lose line ends, control characters and outer blanks, and a `{`
/// becomes a `(`. A skeleton with several roots is written with several ROOTs and read as several clips; a clip of
/// points is written under one ROOT, with position channels and rotations of 0, and read as points again, but for its gaps
/// and its unit.
///
/// # Errors
/// Those of `out`, and [`io::ErrorKind::InvalidInput`] if the clip's rate is not positive. O(frames × joints).
pub fn write(clip: &Clip, out: &mut dyn Write) -> io::Result<()> {
    let frame_time_secs = 1.0 / clip.rate_hz;
    if !(frame_time_secs.is_finite() && frame_time_secs > 0.0) {
        let text = format!(
            "a clip with {} frames a second cannot be written",
            clip.rate_hz
        );
        return Err(io::Error::new(io::ErrorKind::InvalidInput, text));
    }
    let under_root;
    let clip = if clip.has_rotations() {
        clip
    } else {
        under_root = points::under_one_root(clip);
        &under_root
    };
    let plan = Plan::new(clip);
    let mut text = String::from("HIERARCHY\n");
    plan.hierarchy(&mut text);
    text.push_str(&format!(
        "MOTION\nFrames: {}\nFrame Time: {frame_time_secs}\n",
        clip.frames
    ));
    out.write_all(text.as_bytes())?;
    plan.table(out)
}

/// Order and columns of the joints.
struct Plan<'a> {
    clip: &'a Clip,
    children: Vec<Vec<usize>>,
    roots: Vec<usize>,
    /// For each joint its track, if it has one.
    tracks: Vec<Option<&'a JointTrack>>,
}

impl<'a> Plan<'a> {
    fn new(clip: &'a Clip) -> Self {
        let joints = clip.skeleton.joints();
        let (mut children, mut roots) = (vec![Vec::new(); joints.len()], Vec::new());
        for (j, joint) in joints.iter().enumerate() {
            match joint.parent {
                Some(parent) => children[parent].push(j),
                None => roots.push(j),
            }
        }
        let mut tracks = vec![None; joints.len()];
        for track in &clip.tracks {
            tracks[track.joint] = Some(track);
        }
        Self {
            clip,
            children,
            roots,
            tracks,
        }
    }

    /// The joints in file order. Without recursion: a skeleton may be deep.
    fn depth_first(&self) -> Vec<usize> {
        let mut order = Vec::with_capacity(self.children.len());
        let mut open: Vec<usize> = self.roots.iter().rev().copied().collect();
        while let Some(joint) = open.pop() {
            order.push(joint);
            open.extend(self.children[joint].iter().rev());
        }
        order
    }

    fn has_positions(&self, joint: usize) -> bool {
        self.clip.skeleton.joints()[joint].parent.is_none() || self.tracks[joint].is_some()
    }

    fn hierarchy(&self, text: &mut String) {
        let mut open = Vec::new();
        for joint in self.depth_first() {
            while open.last().copied() != self.clip.skeleton.joints()[joint].parent {
                open.pop();
                close(text, open.len());
            }
            self.joint(text, joint, open.len());
            open.push(joint);
        }
        while open.pop().is_some() {
            close(text, open.len());
        }
    }

    fn joint(&self, text: &mut String, j: usize, depth: usize) {
        let joint = &self.clip.skeleton.joints()[j];
        let tabs = "\t".repeat(depth);
        let keyword = if joint.parent.is_none() {
            "ROOT"
        } else {
            "JOINT"
        };
        text.push_str(&format!(
            "{tabs}{keyword} {}\n{tabs}{{\n",
            written_name(&joint.name, j)
        ));
        text.push_str(&format!("{tabs}\tOFFSET {}\n", numbers(&self.offset(j))));
        let channels = match self.has_positions(j) {
            true => "6 Xposition Yposition Zposition Zrotation Yrotation Xrotation",
            false => "3 Zrotation Yrotation Xrotation",
        };
        text.push_str(&format!("{tabs}\tCHANNELS {channels}\n"));
        let tip = joint
            .tip
            .or_else(|| self.children[j].is_empty().then(Vec3::zeros));
        if let Some(tip) = tip {
            text.push_str(&format!(
                "{tabs}\tEnd Site\n{tabs}\t{{\n{tabs}\t\tOFFSET {}\n{tabs}\t}}\n",
                numbers(&tip)
            ));
        }
    }

    /// A joint's OFFSET. One that moves gets an OFFSET amid its positions where its own would let readers (ours
    /// among them) take the positions for steps from it.
    fn offset(&self, j: usize) -> Vec3 {
        let joint = &self.clip.skeleton.joints()[j];
        match self.tracks[j] {
            _ if joint.parent.is_none() => Vec3::zeros(),
            Some(track) if !track.positions.is_empty() => {
                let median = positions::median(&track.positions);
                let kept =
                    positions::vote(&joint.offset, &median) == Some(PositionChannels::Replace);
                if kept { joint.offset } else { median }
            }
            _ => joint.offset,
        }
    }

    fn table(&self, out: &mut dyn Write) -> io::Result<()> {
        let order = self.depth_first();
        let mut angles = vec![[0.0; 3]; order.len()];
        let mut line: Vec<u8> = Vec::new();
        for frame in 0..self.clip.frames {
            line.clear();
            let rotations = self.clip.frame_rotations(frame);
            for &j in &order {
                if self.has_positions(j) {
                    let fixed = &self.clip.skeleton.joints()[j].offset;
                    let position = self.tracks[j].map_or(fixed, |t| &t.positions[frame]);
                    position
                        .iter()
                        .for_each(|value| push_number(&mut line, *value));
                }
                angles[j] = euler::zyx_near(&rotations[j], angles[j]);
                let degrees = angles[j].map(f64::to_degrees);
                degrees
                    .iter()
                    .for_each(|value| push_number(&mut line, *value));
            }
            line.pop();
            line.push(b'\n');
            out.write_all(&line)?;
        }
        Ok(())
    }
}

fn close(text: &mut String, depth: usize) {
    text.push_str(&"\t".repeat(depth));
    text.push_str("}\n");
}

/// Seven decimals: an error of 1e-9 rad for angles, 5e-8 units for lengths.
fn numbers(v: &Vec3) -> String {
    format!("{:.7} {:.7} {:.7}", v.x, v.y, v.z)
}

/// One number as [`numbers`] writes it, without the last three decimals where they are 0 (most files hold four), and a
/// blank. The formatting of the standard library decides every digit by exact arithmetic, which takes several times as long
/// as a table of millions of numbers is worth.
fn push_number(line: &mut Vec<u8>, value: f64) {
    const ONE: u64 = 10_000_000;
    let scaled = (value * ONE as f64).abs();
    // Whole numbers up to 2^53 are doubles.
    if scaled.is_nan() || scaled >= 9e15 {
        line.extend_from_slice(format!("{value:.7} ").as_bytes());
        return;
    }
    let steps = (scaled + 0.5) as u64;
    if value < 0.0 && steps > 0 {
        line.push(b'-');
    }
    let (mut whole, fraction) = ((steps / ONE) as u32, (steps % ONE) as u32);
    // The fraction begins in the middle; a copy of fixed length takes less than one of the digits' length.
    let mut digits = [b' '; 2 * HALF];
    let mut at = HALF - 1;
    digits[at] = b'.';
    while whole >= 100 {
        at -= 2;
        put_pair(&mut digits, at, whole % 100);
        whole /= 100;
    }
    if whole >= 10 {
        at -= 2;
        put_pair(&mut digits, at, whole);
    } else {
        at -= 1;
        digits[at] = b'0' + whole as u8;
    }
    let (four, three) = (fraction / 1000, fraction % 1000);
    put_pair(&mut digits, HALF, four / 100);
    put_pair(&mut digits, HALF + 2, four % 100);
    let mut end = HALF + 4;
    if three > 0 {
        put_pair(&mut digits, end, three / 10);
        digits[end + 2] = b'0' + (three % 10) as u8;
        end += 3;
    }
    let start = line.len();
    line.extend_from_slice(&digits[at..at + LONGEST]);
    line.truncate(start + end + 1 - at);
}

/// Where the fraction of a number begins: behind at most nine digits and the point.
const HALF: usize = 16;
/// Nine digits, the point, seven decimals and a blank.
const LONGEST: usize = 18;

/// The two digits of each number below 100.
const PAIRS: [[u8; 2]; 100] = {
    let mut pairs = [[b'0'; 2]; 100];
    let mut n = 0;
    while n < 100 {
        pairs[n] = [b'0' + (n / 10) as u8, b'0' + (n % 10) as u8];
        n += 1;
    }
    pairs
};

/// The digits of `number`, below 100, at `at`.
#[inline(always)]
fn put_pair(digits: &mut [u8; 2 * HALF], at: usize, number: u32) {
    digits[at..at + 2].copy_from_slice(&PAIRS[number as usize]);
}

/// A joint's name as it survives reading.
fn written_name(name: &str, joint: usize) -> String {
    let survives = |c: char| match c {
        '{' => '(',
        c if c < ' ' => ' ',
        c => c,
    };
    let name: String = name.chars().map(survives).collect();
    match name.trim_matches(' ') {
        "" => format!("joint{joint}"),
        trimmed => trimmed.to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn written(value: f64) -> String {
        let mut line = Vec::new();
        push_number(&mut line, value);
        String::from_utf8(line).unwrap()
    }

    proptest! {
        #[test]
        fn numbers_are_those_of_the_standard_library(small in -400.0f64..400.0, large in -1e12f64..1e12) {
            for value in [small, large, small.round(), small / 1e6] {
                let text = written(value);
                let trimmed = text.strip_suffix(' ').unwrap();
                let expected: f64 = format!("{value:.7}").parse().unwrap();
                let read: f64 = trimmed.parse().unwrap();
                // A tie may fall to the other side.
                prop_assert!((read - expected).abs() <= 1.01e-7 + value.abs() * 1e-15, "{value} {text}");
                prop_assert!((read - value).abs() <= 5.01e-8 + value.abs() * 1e-15, "{value} {text}");
                let decimals = trimmed.split_once('.').unwrap().1;
                prop_assert!(decimals.len() == 4 || decimals.len() == 7 && (!decimals.ends_with("000") || value.abs() > 1e8));
            }
        }
    }

    #[test]
    fn zero_has_no_sign_and_what_is_too_large_is_written_all_the_same() {
        assert_eq!(written(-1e-9), "0.0000 ");
        assert_eq!(written(-0.5), "-0.5000 ");
        assert_eq!(written(0.12345), "0.1234500 ");
        assert_eq!(written(1e15), "1000000000000000.0000000 ");
        assert_eq!(written(f64::NAN), "NaN ");
    }
}

//! Writes clips as BVH.

use std::io::{self, Write};

use super::euler::RunningZyx;
use super::number_line::NumberLine;
use super::points;
use super::positions::{self, PositionChannels};
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
        let mut angles = RunningZyx::new(order.len());
        let mut line = NumberLine::default();
        for frame in 0..self.clip.frames {
            let rotations = self.clip.frame_rotations(frame);
            let angles = angles.next(order.iter().map(|&j| &rotations[j]));
            for (&j, angles) in order.iter().zip(angles) {
                if self.has_positions(j) {
                    let fixed = &self.clip.skeleton.joints()[j].offset;
                    let position = self.tracks[j].map_or(fixed, |t| &t.positions[frame]);
                    position.iter().for_each(|value| line.push(*value));
                }
                let degrees = angles.map(f64::to_degrees);
                degrees.iter().for_each(|value| line.push(*value));
            }
            out.write_all(line.ended())?;
        }
        Ok(())
    }
}

fn close(text: &mut String, depth: usize) {
    text.push_str(&"\t".repeat(depth));
    text.push_str("}\n");
}

/// As many decimals as the table has at most.
fn numbers(v: &Vec3) -> String {
    format!("{:.7} {:.7} {:.7}", v.x, v.y, v.z)
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

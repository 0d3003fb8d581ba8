//! MVNX: recordings of Xsens suits, in XML, versions 2 to 4.
//!
//! Every frame gives each segment's orientation and position in the world (quaternions with their real part first,
//! metres, Z up; *MVN User Manual*, "MVNX"), so that nothing has to be known of the zero pose. Poses of calibration
//! (`identity`, `tpose`, `npose`) stand before the motion and are left out.

mod body;

use roxmltree::{Document, Node};

use self::body::MvnxSegment;
use super::builder::{ClipBuilder, check_size, clip_names};
use super::descriptor::FormatDescriptor;
use super::timing::{Clock, Schedule, Stamps};
use super::xml::{child, is, limits_beside, parse, place, text_of};
use super::{Limits, Loaded, ParseError, Warning};
use crate::clip::{Clip, Joint};
use crate::math::{Axis, Quat, Vec3};
use crate::resample::usual_step;

pub(super) const FORMAT: FormatDescriptor = FormatDescriptor {
    name: "mvnx",
    title: "MVNX",
    noun: "an MVNX recording",
    endings: &["mvnx"],
    looks_so: |h| h.starts("<") && h.contains(b"<mvnx"),
    up: Some(Axis::Z),
    read: |file| Ok(file.at_rate(read(file.bytes, file.name, file.limits)?)),
};

/// Rate if a file has none.
const ASSUMED_HZ: f64 = 60.0;

/// Reads an MVNX file: one clip for each subject, called `name` (`name#subject` for several).
///
/// # Errors
/// The place and the cause: no well-formed XML, no segments, no frame with orientations and positions, more than `limits` allow.
/// A file that breaks off is read as far as it goes. O(bytes) time and memory.
pub fn read(bytes: &[u8], name: &str, limits: &Limits) -> Result<Loaded, ParseError> {
    let text = text_of(bytes)?;
    let limits = &limits_beside(&text, limits)?;
    // A frame has some dozen elements.
    let most_nodes = limits.frames.saturating_mul(64);
    let mut warnings = Vec::new();
    match parse(&text, most_nodes) {
        Ok(document) => read_document(&document, name, bytes.len(), limits, &mut warnings),
        Err(error) => {
            let Some(whole) = whole_frames(&text) else {
                return Err(error);
            };
            let document = parse(&whole, most_nodes).map_err(|_| error.clone())?;
            let note = format!(
                "{}; the file is read up to its last whole frame",
                error.found
            );
            warnings.push(Warning::new(error.at, note));
            read_document(&document, name, bytes.len(), limits, &mut warnings)
        }
    }
    .map(|clips| Loaded { clips, warnings })
}

/// A file that breaks off, closed behind its last whole frame.
fn whole_frames(text: &str) -> Option<String> {
    const END: &str = "</frame>";
    let end = text.rfind(END)? + END.len();
    Some(format!("{}</frames></subject></mvnx>", &text[..end]))
}

fn read_document(
    document: &Document<'_>,
    name: &str,
    bytes: usize,
    limits: &Limits,
    warnings: &mut Vec<Warning>,
) -> Result<Vec<Clip>, ParseError> {
    let root = document.root_element();
    if !is(root, "mvnx") {
        let found = format!("<{}>", root.tag_name().name());
        return Err(ParseError::new(place(root), "<mvnx>", found));
    }
    let subjects: Vec<Node> = root.children().filter(|n| is(*n, "subject")).collect();
    let labels: Vec<String> = subjects
        .iter()
        .map(|s| s.attribute("label").unwrap_or_default().to_owned())
        .collect();
    if subjects.is_empty() {
        return Err(ParseError::new(place(root), "<subject>", "none"));
    }
    let names = clip_names(name, &labels);
    let mut clips = Vec::with_capacity(subjects.len());
    let mut earlier = 0;
    for (subject, name) in subjects.into_iter().zip(names) {
        let clip = read_subject(subject, name, earlier, bytes, limits, warnings)?;
        earlier += clip.rotations.len();
        clips.push(clip);
    }
    Ok(clips)
}

fn read_subject(
    subject: Node<'_, '_>,
    name: String,
    earlier: usize,
    bytes: usize,
    limits: &Limits,
    warnings: &mut Vec<Warning>,
) -> Result<Clip, ParseError> {
    let segments = body::segments(subject, limits, warnings)?;
    let frames = child(subject, "frames")
        .ok_or_else(|| ParseError::new(place(subject), "<frames>", "none"))?;
    let frames: Vec<Node> = frames
        .children()
        .filter(|n| is(*n, "frame") && is_motion(*n))
        .collect();
    check_size(frames.len(), segments.len(), earlier, bytes, limits)?;
    let mut builder = ClipBuilder::new(joints(&segments));
    let mut broken = 0;
    let mut first = None;
    let rate_hz = rate(subject, &frames, warnings);
    let clock = Clock::settled(rate_hz);
    let all = Schedule::of(&stamps(&frames, rate_hz), &clock, warnings).frames(frames.len());
    check_size(all.len(), segments.len(), earlier, bytes, limits)?;
    for frame in all {
        let Some(frame) = frame.map(|at| frames[at]) else {
            builder.push_missing();
            continue;
        };
        match read_frame(frame, &segments) {
            Ok((rotations, positions)) => builder.push_world(&rotations, &positions),
            Err(flaw) => {
                builder.push_missing();
                broken += 1;
                first.get_or_insert(flaw);
            }
        }
    }
    let first = first.map(Flaw::into_error);
    if broken == frames.len() {
        return Err(first
            .unwrap_or_else(|| ParseError::new(place(subject), "frames of type normal", "none")));
    }
    if let Some(first) = first {
        let text = format!(
            "{broken} of {} frames lack numbers and are filled by interpolation; the first: expected {}, found {}",
            frames.len(),
            first.expected,
            first.found
        );
        warnings.push(Warning::new(first.at, text));
    }
    builder.finish(name, rate_hz)
}

fn stamps(frames: &[Node<'_, '_>], rate_hz: f64) -> Stamps {
    let number = |frame: &Node, name: &str| frame.attribute(name)?.trim().parse::<f64>().ok();
    let indices: Vec<Option<f64>> = frames.iter().map(|f| number(f, "index")).collect();
    if indices.iter().all(Option::is_some) {
        return Stamps::none(frames.len()).numbered(indices);
    }
    let by_time = |frame: &Node| Some(number(frame, "time")? / 1000.0 * rate_hz);
    let by_time: Vec<Option<f64>> = frames.iter().map(by_time).collect();
    let steps: Vec<f64> = by_time
        .windows(2)
        .filter_map(|pair| Some(pair[1]? - pair[0]?))
        .collect();
    // Times that disagree with the rate say nothing of frames.
    let agree = usual_step(&steps).is_some_and(|step| (step - 1.0).abs() < 0.2);
    let numbers = by_time.into_iter().map(|number| Some(number?.round()));
    match agree {
        true => Stamps::none(frames.len()).numbered(numbers.collect()),
        false => Stamps::none(frames.len()),
    }
}

fn joints(segments: &[MvnxSegment]) -> Vec<Joint> {
    segments
        .iter()
        .map(|segment| Joint {
            name: segment.label.clone(),
            parent: segment.parent,
            offset: segment.offset,
            tip: segment.tip,
        })
        .collect()
}

/// Frames without a type are motion.
fn is_motion(frame: Node<'_, '_>) -> bool {
    frame
        .attribute("type")
        .is_none_or(|kind| kind.eq_ignore_ascii_case("normal"))
}

/// Fault of a frame; its line is looked up only if it is shown.
struct Flaw<'a, 'input> {
    node: Node<'a, 'input>,
    expected: String,
    found: String,
}

impl Flaw<'_, '_> {
    fn into_error(self) -> ParseError {
        ParseError::new(place(self.node), self.expected, self.found)
    }
}

/// Orientations and positions in the world, in the order of `segments`.
fn read_frame<'a, 'input>(
    frame: Node<'a, 'input>,
    segments: &[MvnxSegment],
) -> Result<(Vec<Quat>, Vec<Vec3>), Flaw<'a, 'input>> {
    let turns = row(frame, "orientation", 4 * segments.len())?;
    let places = row(frame, "position", 3 * segments.len())?;
    let mut rotations = Vec::with_capacity(segments.len());
    let mut positions = Vec::with_capacity(segments.len());
    for segment in segments {
        let [w, x, y, z] = [0, 1, 2, 3].map(|i| turns[4 * segment.column + i]);
        let quaternion = nalgebra::Quaternion::new(w, x, y, z);
        let norm = quaternion.norm();
        if !(0.5..=2.0).contains(&norm) {
            return Err(Flaw {
                node: frame,
                expected: "quaternions of length 1".to_owned(),
                found: format!("{} turned by one of length {norm:.3}", segment.label),
            });
        }
        rotations.push(Quat::new_normalize(quaternion));
        let column = 3 * segment.column;
        positions.push(Vec3::from_column_slice(&places[column..column + 3]));
    }
    Ok((rotations, positions))
}

/// The numbers of one element of a frame; more than `width` belong to props that the file does not list.
fn row<'a, 'input>(
    frame: Node<'a, 'input>,
    tag: &str,
    width: usize,
) -> Result<Vec<f64>, Flaw<'a, 'input>> {
    let flaw = |node, expected: String, found: String| Flaw {
        node,
        expected,
        found,
    };
    let node = child(frame, tag).ok_or_else(|| {
        let expected = format!("<{tag}> of every segment in the frame");
        flaw(frame, expected, "none".to_owned())
    })?;
    let numbers = body::numbers(node.text().unwrap_or_default()).ok_or_else(|| {
        let expected = format!("numbers in <{tag}>");
        flaw(node, expected, "something else".to_owned())
    })?;
    if numbers.len() < width {
        let expected = format!("{width} numbers in <{tag}>");
        return Err(flaw(node, expected, numbers.len().to_string()));
    }
    Ok(numbers)
}

/// The rate that the file states, unless its frames' own times (milliseconds) say clearly otherwise.
fn rate(subject: Node<'_, '_>, frames: &[Node<'_, '_>], warnings: &mut Vec<Warning>) -> f64 {
    let stated = subject
        .attribute("frameRate")
        .and_then(|rate| rate.trim().parse::<f64>().ok())
        .filter(|rate| rate.is_finite() && *rate > 0.0 && *rate <= 100_000.0);
    let time = |frame: &Node| frame.attribute("time")?.trim().parse::<f64>().ok();
    let timed = match (frames.first().and_then(time), frames.last().and_then(time)) {
        (Some(first), Some(last)) if last > first && frames.len() > 2 => {
            Some((frames.len() - 1) as f64 / (last - first) * 1000.0)
        }
        _ => None,
    };
    let at = place(subject);
    match (stated, timed) {
        (Some(stated), Some(timed)) if frames.len() > 20 && (timed / stated - 1.0).abs() > 0.1 => {
            let text = format!(
                "frameRate is {stated} Hz, but the times of the frames give {timed:.2} Hz; frameRate is used (--file-rate \
                 overrides it)"
            );
            warnings.push(Warning::new(at, text));
            stated
        }
        (Some(stated), _) => stated,
        (None, Some(timed)) => {
            let text =
                format!("no frameRate; the times of the frames give {timed:.2} Hz, which is used");
            warnings.push(Warning::new(at, text));
            timed
        }
        (None, None) => {
            let text = format!("no frameRate; {ASSUMED_HZ} Hz assumed");
            warnings.push(Warning::new(at, text));
            ASSUMED_HZ
        }
    }
}

#[cfg(test)]
mod tests;

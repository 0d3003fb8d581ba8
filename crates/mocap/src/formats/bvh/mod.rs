//! BVH: the hierarchy of a skeleton and a table of its channels, in plain text.
//!
//! There is no specification that producers keep to. What differs between them and can be understood is read,
//! with a [`Warning`](super::Warning) where something had to be guessed or repaired; what cannot is refused.

mod arctangent;
mod character;
mod euler;
mod gaps;
mod half_angles;
mod hierarchy;
mod motion;
mod notes;
mod number;
mod number_line;
mod points;
mod positions;
mod rate;
mod rows;
mod source;
mod text;
mod write;

use std::io::{Read, Seek};

use super::descriptor::FormatDescriptor;
use super::head::Head;
pub use positions::PositionChannels;
pub use write::write;

use self::character::Character;
use self::hierarchy::BvhHierarchy;
use self::notes::Notes;
use self::positions::Votes;
use self::source::{InFile, InMemory, TableText};
use self::text::{Cursor, show};
use super::encoding::Encoding;
use super::{Limits, Loaded, ParseError, Place};
use crate::clip::{Clip, Skeleton, Span};

pub(super) const FORMAT: FormatDescriptor = FormatDescriptor {
    name: "bvh",
    title: "BVH",
    noun: "a BVH clip",
    endings: &["bvh"],
    looks_so: is_bvh,
    up: None,
    read: |file| {
        let options = BvhOptions {
            positions: file.positions,
            rate_hz: file.rate_hz,
            ..BvhOptions::default()
        };
        read(file.bytes, file.name, &options, file.limits)
    },
};

/// `HIERARCHY` at the start of one of the first lines (junk before it is met), or `MOTION` alone.
fn is_bvh(head: &Head) -> bool {
    let begins = |line: &[u8], word: &[u8]| {
        line.len() >= word.len() && line[..word.len()].eq_ignore_ascii_case(word)
    };
    head.lines()
        .take(100)
        .any(|line| begins(line, b"HIERARCHY"))
        || head
            .lines()
            .next()
            .is_some_and(|line| line.eq_ignore_ascii_case(b"MOTION"))
}

/// Facts that a file lacks or has wrong.
#[derive(Debug, Clone, PartialEq)]
pub struct BvhOptions {
    /// Meaning of position channels below the root; `None`: decided from the file's data.
    pub positions: Option<PositionChannels>,
    /// Frames a second; replaces the file's rate.
    pub rate_hz: Option<f64>,
    /// Share of lines in the motion table that may be broken (and are then interpolated). An incomplete last line
    /// is not counted.
    pub bad_line_share: f64,
}

impl Default for BvhOptions {
    fn default() -> Self {
        Self {
            positions: None,
            rate_hz: None,
            bad_line_share: 0.01,
        }
    }
}

/// Filled gaps that last longer are warned of: what a body does meanwhile is not known.
const LONG_GAP_SECS: f64 = 0.5;

/// Reads a BVH file: one clip for each ROOT, called `name` (`name.1`, `name.2` … if there are several).
///
/// Rotations are intrinsic products in the order in which a joint lists its channels, `R = R1·R2·R3`
/// (`parent_from_joint`). A root's position channels are its place in the world and its OFFSET is then ignored,
/// unless they stay at 0. Lengths and axes are the file's own. A file without frames gives a clip without frames.
///
/// # Errors
/// The place and the cause: no HIERARCHY, a broken one, more than `limits` allow, or too many broken lines in the motion
/// table. O(bytes); beside the result, the memory of one line.
pub fn read(
    bytes: &[u8],
    name: &str,
    options: &BvhOptions,
    limits: &Limits,
) -> Result<Loaded, ParseError> {
    let text = without_bom(bytes)?;
    let mut notes = Notes::default();
    let head = BvhHead::read(text, limits, &mut notes)?;
    let mut table = InMemory::new(&text[head.end..]);
    head.with_table(&mut table, name, options, limits, notes)
}

/// Reads a BVH file as [`read`] does, from a file of which it holds a megabyte at a time: beside the result, it takes the
/// memory of the skeleton's text and of one line.
///
/// # Errors
/// Those of [`read`], and a file that cannot be read.
pub fn read_from(
    file: impl Read + Seek,
    name: &str,
    options: &BvhOptions,
    limits: &Limits,
) -> Result<Loaded, ParseError> {
    const PIECE: usize = 1 << 20;
    read_in_pieces(file, PIECE, name, options, limits)
}

fn read_in_pieces(
    mut file: impl Read + Seek,
    piece: usize,
    name: &str,
    options: &BvhOptions,
    limits: &Limits,
) -> Result<Loaded, ParseError> {
    let mut bytes = Vec::new();
    loop {
        // Twice as much each time, until the table's beginning is in it.
        let more = bytes.len().max(piece) as u64;
        let is_whole = source::read_all(file.by_ref().take(more), &mut bytes)? < more as usize;
        let text = without_bom(&bytes)?;
        let mut notes = Notes::default();
        let head = match BvhHead::read(text, limits, &mut notes) {
            Ok(head) if is_whole || head.is_followed(text) => head,
            Err(error) if is_whole => return Err(error),
            _ => continue,
        };
        let start = (bytes.len() - text.len() + head.end) as u64;
        drop(bytes);
        let mut table = InFile::new(file, start, piece, limits.line_bytes)?;
        return head.with_table(&mut table, name, options, limits, notes);
    }
}

/// All that stands before the table.
struct BvhHead {
    hierarchy: BvhHierarchy,
    /// The MOTION section's, if there is one.
    header: Option<motion::MotionHeader>,
    /// End of the head, in bytes,
    end: usize,
    /// and on which line.
    line: u64,
}

impl BvhHead {
    fn read(text: &[u8], limits: &Limits, notes: &mut Notes) -> Result<Self, ParseError> {
        let mut cursor = find_hierarchy(text, limits, notes)?;
        let encoding = Encoding::of(hierarchy_bytes(&text[cursor.pos..]));
        if encoding != Encoding::Utf8 {
            notes.add(
                cursor.place(),
                format!("names are not UTF-8, read as {}", encoding.name()),
            );
        }
        let hierarchy = hierarchy::parse(&mut cursor, encoding, limits, notes)?;
        let header = match hierarchy.motion_follows {
            true => Some(motion::header(&mut cursor, notes)?),
            false => None,
        };
        Ok(Self {
            hierarchy,
            header,
            end: cursor.pos,
            line: cursor.line,
        })
    }

    /// True if `text` holds so much of the table that the head surely ends where it seems to.
    fn is_followed(&self, text: &[u8]) -> bool {
        const SURE: usize = 4096;
        self.header.is_some() && self.end + SURE <= text.len()
    }

    fn with_table(
        self,
        table: &mut dyn TableText,
        name: &str,
        options: &BvhOptions,
        limits: &Limits,
        mut notes: Notes,
    ) -> Result<Loaded, ParseError> {
        let mut characters: Vec<_> = (0..self.hierarchy.roots.len())
            .map(|k| Character::new(&self.hierarchy, k))
            .collect();
        let motion = self.read_motion(table, &mut characters, options, limits, &mut notes);
        let (stated_hz, lost) = motion?;
        let rate_hz = match options.rate_hz {
            Some(rate) if rate.is_finite() && rate > 0.0 => rate,
            Some(rate) => {
                return Err(ParseError::new(
                    Place::File,
                    "a positive rate in the options",
                    rate.to_string(),
                ));
            }
            None => stated_hz,
        };
        let clips = finish(characters, name, rate_hz, &lost, options, &mut notes)?;
        Ok(Loaded {
            clips,
            warnings: notes.into_warnings(),
        })
    }

    /// Reads the table into `characters`; returns the rate that the header states and the frames that were lost.
    fn read_motion(
        &self,
        table: &mut dyn TableText,
        characters: &mut [Character],
        options: &BvhOptions,
        limits: &Limits,
        notes: &mut Notes,
    ) -> Result<(f64, Vec<usize>), ParseError> {
        let Some(header) = &self.header else {
            notes.add(
                Place::Line(self.line),
                "no MOTION section: a skeleton without frames",
            );
            return Ok((rate::ASSUMED_HZ, Vec::new()));
        };
        let rate_hz = match options.rate_hz {
            Some(rate) => rate,
            None => rate::rate_hz(header.frame_time_secs, header.at, notes),
        };
        let width = self.hierarchy.channels.len();
        if width == 0 {
            notes.add(
                header.at,
                "no joint has a channel: a skeleton without frames",
            );
            return Ok((rate_hz, Vec::new()));
        }
        let request = motion::TableSpec {
            declared: header.frames,
            bad_line_share: options.bad_line_share,
            first_line: self.line,
            limits,
        };
        let lost = motion::table(table, width, characters, &request, notes)?;
        motion::compare_counts(header, characters[0].frames + lost.len(), notes);
        Ok((rate_hz, lost))
    }
}

/// Strips a UTF-8 byte order mark; refuses UTF-16, of which every other byte is 0.
fn without_bom(bytes: &[u8]) -> Result<&[u8], ParseError> {
    match bytes {
        [0xef, 0xbb, 0xbf, rest @ ..] => Ok(rest),
        [0xff, 0xfe, ..] | [0xfe, 0xff, ..] => {
            Err(ParseError::new(Place::File, "UTF-8 text", "UTF-16 text"))
        }
        _ => Ok(bytes),
    }
}

/// The place after the word HIERARCHY, or at the first ROOT if that word is missing.
fn find_hierarchy<'a>(
    text: &'a [u8],
    limits: &Limits,
    notes: &mut Notes,
) -> Result<Cursor<'a>, ParseError> {
    let mut cursor = Cursor::new(text, limits.line_bytes);
    let mut root = None;
    let mut first = None;
    loop {
        cursor.skip_space()?;
        let here = cursor.clone();
        let Some(token) = cursor.token()? else { break };
        if token.eq_ignore_ascii_case(b"HIERARCHY") {
            if let Some((at, junk)) = first {
                notes.add(
                    at,
                    format!("text before HIERARCHY skipped, {}", show(Some(junk))),
                );
            }
            return Ok(cursor);
        }
        if root.is_none() && token.eq_ignore_ascii_case(b"ROOT") {
            root = Some(here);
        }
        first.get_or_insert((cursor.place(), token));
    }
    if let Some(root) = root {
        notes.add(root.place(), "no HIERARCHY before ROOT");
        return Ok(root);
    }
    let found = match rows::count_numbers(text) {
        (0, _) => format!("none; the file begins with {}", show(first.map(|f| f.1))),
        (lines, width) => format!("no HIERARCHY; {lines}×{width} numbers found"),
    };
    Err(ParseError::new(
        Place::File,
        "HIERARCHY and the skeleton of a BVH file",
        found,
    ))
}

/// The bytes before the line that begins with MOTION: the table tells nothing about encodings.
fn hierarchy_bytes(text: &[u8]) -> &[u8] {
    let mut start = 0;
    for line in text.split_inclusive(|&b| number::is_newline(b)) {
        let word = line.trim_ascii_start();
        if word
            .get(..6)
            .is_some_and(|w| w.eq_ignore_ascii_case(b"MOTION"))
        {
            break;
        }
        start += line.len();
    }
    &text[..start]
}

/// Repairs the characters, decides what their position channels mean and makes clips of them.
fn finish(
    mut characters: Vec<Character>,
    name: &str,
    rate_hz: f64,
    lost: &[usize],
    options: &BvhOptions,
    notes: &mut Notes,
) -> Result<Vec<Clip>, ParseError> {
    let repaired: Vec<Vec<Span>> = characters.iter_mut().map(|c| c.repair(lost)).collect();
    let meaning = position_channels(&characters, options, notes);
    let several = characters.len() > 1;
    if several {
        let roots: Vec<_> = characters
            .iter()
            .map(|c| c.joints[0].name.as_str())
            .collect();
        notes.add(
            Place::File,
            format!(
                "{} roots, a clip for each: {}",
                roots.len(),
                roots.join(", ")
            ),
        );
    }
    let mut clips = Vec::with_capacity(characters.len());
    for (k, (mut character, repaired)) in characters.into_iter().zip(repaired).enumerate() {
        note_repairs(&repaired, rate_hz, notes);
        let tracks = character.take_tracks(meaning);
        let skeleton = Skeleton::new(character.joints).map_err(|e| {
            ParseError::new(Place::File, "parents before their children", e.to_string())
        })?;
        let name = if several {
            format!("{name}.{}", k + 1)
        } else {
            name.to_owned()
        };
        let Character {
            rotations, frames, ..
        } = character;
        clips.push(points::from_under_root(Clip {
            name,
            skeleton,
            rate_hz,
            rotations,
            tracks,
            frames,
            repaired,
            points: None,
        }));
    }
    Ok(clips)
}

/// Meaning of the position channels below the roots, with a warning if there are any.
fn position_channels(
    characters: &[Character],
    options: &BvhOptions,
    notes: &mut Notes,
) -> PositionChannels {
    let votes = Votes::of(characters);
    let meaning = options.positions.unwrap_or_else(|| votes.decide());
    if options.positions.is_none() && votes != Votes::default() {
        let Votes { replace, add } = votes;
        let text = format!(
            "position channels below the root are read {meaning} ({replace} joints stay near their OFFSET, {add} near 0)"
        );
        notes.add(Place::File, text);
    }
    meaning
}

fn note_repairs(repaired: &[Span], rate_hz: f64, notes: &mut Notes) {
    let frames: usize = repaired.iter().map(Span::len).sum();
    if frames == 0 {
        return;
    }
    let longest = repaired.iter().map(Span::len).max().unwrap_or(0) as f64 / rate_hz;
    let doubt = if longest > LONG_GAP_SECS {
        format!(", the longest {longest:.1} s, which is unreliable")
    } else {
        String::new()
    };
    notes.add(
        Place::File,
        format!(
            "{frames} frames filled by interpolation in {} places{doubt}",
            repaired.len()
        ),
    );
}

#[cfg(test)]
mod tests;

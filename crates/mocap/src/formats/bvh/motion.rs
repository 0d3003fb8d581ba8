//! The MOTION section: its header and its table.

use super::character::Character;
use super::notes::Notes;
use super::number;
use super::rows::{LinesSoFar, MotionLine, MotionLines};
use super::source::TableText;
use super::text::{Cursor, show};
use crate::formats::{Limits, ParseError, Place};
use crate::math::{Quat, Vec3};

/// Lines between MOTION and the table.
#[derive(Debug)]
pub(super) struct MotionHeader {
    /// `Frames:`, if it is a count.
    pub frames: Option<u64>,
    /// `Frame Time:`, if it is a number.
    pub frame_time_secs: Option<f64>,
    /// Place of the frame time, present or missing.
    pub at: Place,
}

/// Reads `Frames` and `Frame Time`, in any order, as far as they are there.
pub(super) fn header(
    cursor: &mut Cursor<'_>,
    notes: &mut Notes,
) -> Result<MotionHeader, ParseError> {
    let mut header = MotionHeader {
        frames: None,
        frame_time_secs: None,
        at: cursor.place(),
    };
    loop {
        cursor.skip_space()?;
        let mut ahead = cursor.clone();
        let key = key(&mut ahead);
        let value = match key.as_slice() {
            b"frames:" | b"frames" => {
                let value = value(&mut ahead);
                header.frames = value
                    .filter(|v| *v >= 0.0 && v.fract() == 0.0)
                    .map(|v| v as u64);
                value
            }
            b"frame time:" | b"frame time" | b"frametime:" => {
                header.at = ahead.place();
                header.frame_time_secs = value(&mut ahead);
                header.frame_time_secs
            }
            _ if cursor.at_comment() => {
                notes.count("comment", cursor.line, || "comment skipped".into());
                cursor.rest_of_line();
                continue;
            }
            _ if key.ends_with(b":") => None,
            _ => return Ok(header),
        };
        if value.is_none() {
            let skipped = ahead.rest_of_line();
            let text = || {
                format!(
                    "{}{} skipped",
                    String::from_utf8_lossy(&key),
                    show(Some(skipped))
                )
            };
            notes.count("header line", cursor.line, text);
        }
        *cursor = ahead;
    }
}

/// The lower-case words up to and with a colon, or up to a number; one blank between `frame` and `time`.
fn key(cursor: &mut Cursor<'_>) -> Vec<u8> {
    let mut key = Vec::new();
    while let Some(byte) = cursor.peek().filter(u8::is_ascii_alphabetic) {
        key.push(byte.to_ascii_lowercase());
        cursor.pos += 1;
        let word_end = cursor.pos;
        cursor.skip_blanks();
        if cursor.pos > word_end && key == b"frame" {
            key.push(b' ');
        } else if cursor.pos > word_end {
            break;
        }
    }
    if cursor.peek() == Some(b':') {
        cursor.pos += 1;
        key.push(b':');
    }
    key
}

/// A number on the rest of the line.
fn value(cursor: &mut Cursor<'_>) -> Option<f64> {
    let mut ahead = cursor.clone();
    let token = ahead.token_on_line()?;
    let value = number::parse(token).or_else(|| number::parse_with_comma(token))?;
    *cursor = ahead;
    cursor.skip_blanks();
    Some(value)
}

/// Joint rotations a file may ask for, for each byte of its table: ordinary files stay below a tenth, and without a limit a
/// short file with many joints and one channel would fill the memory.
const SAMPLES_PER_BYTE: usize = 4;
/// Memory of a sample: a rotation, and a position where the joint has one.
const BYTES_A_SAMPLE: usize = size_of::<Quat>() + size_of::<Vec3>();
/// And this many, however short it is: props of a hundred joints, of which one moves.
const FREE_SAMPLES: usize = 1 << 20;

/// Reads the table into `characters`, `width` numbers a frame. Returns the frames that were lost, as frame numbers
/// of the whole; the characters hold the others.
pub(super) fn table(
    text: &mut dyn TableText,
    width: usize,
    characters: &mut [Character],
    request: &TableSpec<'_>,
    notes: &mut Notes,
) -> Result<Vec<usize>, ParseError> {
    let joints = characters.iter().map(|c| c.joints.len()).sum::<usize>();
    let samples = FREE_SAMPLES + text.bytes().saturating_mul(SAMPLES_PER_BYTE);
    let memory = BYTES_A_SAMPLE.saturating_mul(joints.max(1));
    let affordable = request.limits.memory / memory;
    let max_frames = request.limits.frames.min(samples / joints.max(1));
    // As many frames as are declared, as far as the table has two bytes for each of their numbers.
    let believed = (text.bytes() / (2 * width)).min(max_frames);
    let frames = usize::try_from(request.declared.unwrap_or(0)).unwrap_or(believed);
    for character in characters.iter_mut() {
        character.reserve(frames.min(believed).min(affordable))?;
    }
    let table = MotionTable {
        width,
        max_frames,
        affordable,
        limits: request.limits,
        characters,
        tally: RepairCounts::default(),
    };
    let table = table.by_line(text, request, notes)?;
    if table.tally.flows(width, request.declared) {
        table.characters.iter_mut().for_each(Character::clear);
        let words = "frames are not on one line each; the numbers are read as one sequence, because their count fits";
        notes.add(Place::Line(table.tally.first_line), words);
        let tally = RepairCounts::default();
        text.rewind()?;
        MotionTable { tally, ..table }.by_stream(text, request, notes)?;
        return Ok(Vec::new());
    }
    table.tally.judge(width, request, notes)
}

/// Gives every row of the table to `take`: its numbers, its line, what it is.
fn each_row(
    text: &mut dyn TableText,
    request: &TableSpec<'_>,
    notes: &mut Notes,
    mut take: impl FnMut(&mut Vec<f64>, u64, MotionLine, &mut Notes) -> Result<(), ParseError>,
) -> Result<(), ParseError> {
    let mut so_far = LinesSoFar::new(request.first_line);
    let mut values = Vec::new();
    while let Some(piece) = text.next()? {
        let mut rows = MotionLines::new(piece, request.limits.line_bytes, so_far, notes);
        while let Some((line, row)) = rows.next(&mut values, notes)? {
            take(&mut values, line, row, notes)?;
        }
        so_far = rows.so_far();
    }
    Ok(())
}

/// Facts about the table, from the file and the caller.
pub(super) struct TableSpec<'a> {
    /// Frames the header declares.
    pub declared: Option<u64>,
    /// Share of bad lines above which the table is refused.
    pub bad_line_share: f64,
    /// Line on which the table begins.
    pub first_line: u64,
    pub limits: &'a Limits,
}

struct MotionTable<'a> {
    width: usize,
    max_frames: usize,
    /// Frames that there is memory for.
    affordable: usize,
    limits: &'a Limits,
    characters: &'a mut [Character],
    tally: RepairCounts,
}

impl MotionTable<'_> {
    fn push(&mut self, row: &[f64], line: u64) -> Result<(), ParseError> {
        let frames = self.characters.first().map_or(0, |c| c.frames);
        if frames >= self.affordable {
            return Err(ParseError::of_memory(
                self.limits.memory,
                self.limits.memory + 1,
            ));
        }
        if frames >= self.max_frames {
            let expected = format!("at most {} frames", self.max_frames);
            return Err(ParseError::new(Place::Line(line), expected, "more"));
        }
        self.characters.iter_mut().for_each(|c| c.push(row));
        Ok(())
    }

    /// One frame a line; other lines are counted and remembered.
    fn by_line(
        mut self,
        text: &mut dyn TableText,
        request: &TableSpec<'_>,
        notes: &mut Notes,
    ) -> Result<Self, ParseError> {
        each_row(text, request, notes, |values, line, row, notes| {
            self.tally.numbers += values.len() as u64;
            match row {
                MotionLine::Numbers if values.len() == self.width => {
                    self.push(values, line)?;
                    self.tally.good(line);
                    note_missing(values, line, notes);
                }
                MotionLine::Numbers => self.tally.bad(line, values.len() < self.width, || {
                    format!("{} values", values.len())
                }),
                MotionLine::Spoilt(token) => {
                    self.tally.spoilt += 1;
                    self.tally.bad(line, true, || token);
                }
            }
            Ok(())
        })?;
        Ok(self)
    }

    /// A frame every `width` numbers, whatever the lines. What is wrong with lines was noted before.
    fn by_stream(
        mut self,
        text: &mut dyn TableText,
        request: &TableSpec<'_>,
        notes: &mut Notes,
    ) -> Result<(), ParseError> {
        let mut pending = Vec::new();
        each_row(
            text,
            request,
            &mut Notes::default(),
            |values, line, _, _| {
                note_missing(values, line, notes);
                pending.append(values);
                let whole = pending.len() / self.width * self.width;
                for row in pending[..whole].chunks_exact(self.width) {
                    self.push(row, line)?;
                }
                pending.drain(..whole);
                Ok(())
            },
        )
    }
}

fn note_missing(values: &[f64], line: u64, notes: &mut Notes) {
    if let Some(column) = values.iter().position(|v| v.is_nan()) {
        let text = || {
            format!(
                "value {} is not a usable number; such values are interpolated",
                column + 1
            )
        };
        notes.count("nan", line, text);
    }
}

/// Lines of a table in which one may be bad, whatever share that is.
const LEAST_LINES: u64 = 4;

/// Counts of repairs while reading line by line.
#[derive(Debug, Default)]
struct RepairCounts {
    lines: u64,
    numbers: u64,
    first_line: u64,
    spoilt: u64,
    /// Bad lines: index among the table's lines, line number, whether it only lacks something.
    bad: Vec<(usize, u64, bool)>,
    first_bad: Option<(u64, String)>,
    last_good: Option<usize>,
}

impl RepairCounts {
    fn good(&mut self, line: u64) {
        self.start(line);
        self.last_good = Some(self.lines as usize);
        self.lines += 1;
    }

    fn bad(&mut self, line: u64, is_short: bool, found: impl FnOnce() -> String) {
        self.start(line);
        self.bad.push((self.lines as usize, line, is_short));
        self.first_bad.get_or_insert_with(|| (line, found()));
        self.lines += 1;
    }

    fn start(&mut self, line: u64) {
        if self.lines == 0 {
            self.first_line = line;
        }
    }

    /// True if the numbers are meant as one stream: their count is what the header declares, that of the lines
    /// is not.
    fn flows(&self, width: usize, declared: Option<u64>) -> bool {
        let fits = declared
            .is_some_and(|d| d != self.lines && d.checked_mul(width as u64) == Some(self.numbers));
        fits && !self.bad.is_empty() && self.spoilt == 0
    }

    /// Drops what is broken at the end, refuses a table with too much that is broken before it, and returns the
    /// frames that are to be filled.
    fn judge(
        mut self,
        width: usize,
        request: &TableSpec<'_>,
        notes: &mut Notes,
    ) -> Result<Vec<usize>, ParseError> {
        let keep = self.last_good.map_or(0, |f| f + 1);
        let trailing: Vec<_> = self.bad.iter().copied().filter(|b| b.0 >= keep).collect();
        let excused = match trailing.as_slice() {
            [(_, _, true)] => 1,
            _ => trailing
                .iter()
                .filter(|b| request.declared.is_some_and(|d| b.0 as u64 >= d && d > 0))
                .count(),
        };
        self.refuse_if_bad(self.bad.len() - excused, width, request)?;
        for (k, &(_, line, is_short)) in trailing.iter().enumerate() {
            let what = if is_short && k == 0 {
                "an incomplete last line"
            } else {
                "a broken line after the last frame"
            };
            notes.count("trailing", line, || {
                format!("{what} is dropped: expected {width} values")
            });
        }
        self.bad.truncate(self.bad.len() - trailing.len());
        for &(_, line, _) in &self.bad {
            notes.count("ragged", line, || {
                format!("not a frame of {width} values; the frame is interpolated")
            });
        }
        Ok(self.bad.iter().map(|b| b.0).collect())
    }

    fn refuse_if_bad(
        &self,
        bad: usize,
        width: usize,
        request: &TableSpec<'_>,
    ) -> Result<(), ParseError> {
        // In a short clip one line is a large share.
        let one = u64::from(self.lines >= LEAST_LINES) as f64;
        if bad as f64 <= (request.bad_line_share * self.lines as f64).max(one) {
            return Ok(());
        }
        let Some((line, found)) = &self.first_bad else {
            return Ok(());
        };
        let found = format!("{found}; {bad} of {} lines are bad", self.lines);
        Err(ParseError::new(
            Place::Line(*line),
            format!("{width} values on each line"),
            found,
        ))
    }
}

/// Says what is wrong with a header whose counts do not match the `frames` that were found.
pub(super) fn compare_counts(header: &MotionHeader, frames: usize, notes: &mut Notes) {
    match header.frames {
        None => notes.add(
            header.at,
            format!("no frame count declared, {frames} found"),
        ),
        Some(declared) if declared != frames as u64 => {
            notes.add(
                header.at,
                format!("{declared} frames declared, {frames} found; all {frames} are read"),
            );
        }
        Some(_) => {}
    }
}

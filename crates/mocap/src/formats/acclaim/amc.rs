//! Reads a motion (AMC): the rows of the file, and which of them are usable.

use std::collections::{HashMap, HashSet};

use super::motion::{AmcRow, AmcRows, assemble, channels};
use super::skeleton::Asf;
use super::text::{AsfLines, number, quoted, text, tokens};
use crate::formats::{Limits, Loaded, ParseError, Place, Warning};
use crate::math::{Quat, Vec3};

/// Frames a second where nothing says otherwise: what the CMU and HDM05 libraries were recorded at.
pub const DEFAULT_RATE_HZ: f64 = 120.0;

/// A hole in the frame numbers up to this long is filled; a longer one is closed.
const LONGEST_HOLE: u64 = 120;
/// Joints times frames that a byte may ask for: bounds the memory that a small file with a huge skeleton takes.
const CELLS_PER_BYTE: usize = 16;
/// Most warnings of a kind that are given one by one.
const SHOWN: usize = 10;

/// Facts that a motion file cannot hold.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct AmcOptions {
    /// Frames a second; `None` takes a hint in the name (`HDM_dg_01_120`, `walk_60hz`) or
    /// [`DEFAULT_RATE_HZ`], with a warning.
    pub rate_hz: Option<f64>,
}

/// Reads the motion `bytes` of `skeleton`. O(bytes + frames · joints).
///
/// Rows that a frame lacks, or that cannot be read, are interpolated from the frames around and listed in
/// [`Clip::repaired`](crate::clip::Clip::repaired), as are missing frame numbers. A last frame that is cut off
/// is dropped. All of it is said in warnings.
///
/// # Errors
/// No frame at all, something else than a frame number before the first row, more frames than `limits` allows,
/// rows most of which name no bone of `skeleton`, or more than half of the rows missing or unreadable.
pub fn read_amc(
    bytes: &[u8],
    name: &str,
    skeleton: &Asf,
    options: &AmcOptions,
    limits: &Limits,
) -> Result<Loaded, ParseError> {
    let mut reader = AmcReader::new(skeleton, limits);
    let mut lines = AsfLines::new(bytes, limits);
    while let Some((line, content)) = lines.next()? {
        reader.line(line, content)?;
    }
    let mut warnings = Vec::new();
    let rate_hz = rate(name, options, &mut warnings);
    let (rows, mut found) = reader.finish(lines.number())?;
    warnings.append(&mut found);
    let cells = rows.frames.saturating_mul(skeleton.bones.len() + 1);
    if cells > CELLS_PER_BYTE * bytes.len() {
        let found = format!(
            "{} frames of {} joints in {} bytes",
            rows.frames,
            skeleton.bones.len() + 1,
            bytes.len()
        );
        return Err(ParseError::new(
            Place::File,
            "rows of most of the skeleton's bones",
            found,
        ));
    }
    let left = limits.without(rows.memory())?;
    left.afford(cells, size_of::<Quat>() + size_of::<Vec3>())?;
    let clip = assemble(name, skeleton, rows, rate_hz, &mut warnings)?;
    Ok(Loaded {
        clips: vec![clip],
        warnings,
    })
}

struct AmcReader<'a> {
    skeleton: &'a Asf,
    limits: &'a Limits,
    degrees: bool,
    slots: HashMap<String, usize>,
    rows: AmcRows,
    /// The number that stood before the latest frame.
    number: Option<u64>,
    frames: u64,
    /// The line on which the latest frame began.
    frame_line: u64,
    known: usize,
    unknown: usize,
    unknown_names: HashSet<String>,
    /// First unreadable row, for a message if there are too many.
    first_spoiled: Option<ParseError>,
    spoiled: usize,
    warnings: Vec<Warning>,
}

impl<'a> AmcReader<'a> {
    fn new(skeleton: &'a Asf, limits: &'a Limits) -> Self {
        let names =
            std::iter::once(Asf::ROOT).chain(skeleton.bones.iter().map(|b| b.name.as_str()));
        let slots = names
            .enumerate()
            .map(|(slot, name)| (name.to_lowercase(), slot))
            .collect();
        Self {
            skeleton,
            limits,
            degrees: skeleton.degrees,
            slots,
            rows: AmcRows::new(skeleton),
            number: None,
            frames: 0,
            frame_line: 0,
            known: 0,
            unknown: 0,
            unknown_names: HashSet::new(),
            first_spoiled: None,
            spoiled: 0,
            warnings: Vec::new(),
        }
    }

    fn line(&mut self, line: u64, content: &[u8]) -> Result<(), ParseError> {
        let mut words = tokens(content);
        let first = words.next().unwrap_or_default();
        if first.starts_with(b":") {
            match first.to_ascii_lowercase().as_slice() {
                b":degrees" => self.degrees = true,
                b":radians" => self.degrees = false,
                _ => {}
            }
            return Ok(());
        }
        let second = words.next();
        if let (None, Some(number)) = (second, frame_number(first)) {
            return self.begin_frame(line, number);
        }
        if self.frames == 0 {
            let expected = "a frame number on a line of its own, before any bone";
            return Err(ParseError::new(
                Place::Line(line),
                expected,
                quoted(content),
            ));
        }
        self.row(line, first, second.into_iter().chain(words));
        Ok(())
    }

    fn begin_frame(&mut self, line: u64, number: u64) -> Result<(), ParseError> {
        let skipped = match self.number {
            Some(before) if number <= before => {
                self.warn(
                    line,
                    format!("frame {number} comes after frame {before}; taken as the next frame"),
                );
                0
            }
            Some(before) => number - before - 1,
            None => 0,
        };
        if skipped > LONGEST_HOLE {
            self.warn(
                line,
                format!("{skipped} frames are missing before frame {number}; the gap is closed"),
            );
        } else if skipped > 0 {
            self.warn(
                line,
                format!(
                    "{skipped} frames are missing before frame {number}; they are interpolated"
                ),
            );
            self.frames += skipped;
        }
        self.number = Some(number);
        self.frames += 1;
        self.frame_line = line;
        if self.frames > self.limits.frames as u64 {
            let expected = format!("at most {} frames", self.limits.frames);
            return Err(ParseError::new(
                Place::Line(line),
                expected,
                format!("frame {number}"),
            ));
        }
        Ok(())
    }

    fn row<'t>(&mut self, line: u64, name: &[u8], values: impl Iterator<Item = &'t [u8]>) {
        let name = text(name);
        let Some(&slot) = self.slots.get(&name.to_lowercase()) else {
            self.unknown += 1;
            if self.unknown_names.len() < SHOWN
                && self.unknown_names.insert(name.clone().into_owned())
            {
                let note = format!("the skeleton has no bone `{name}`; its rows are left out");
                self.warnings.push(Warning::new(Place::Line(line), note));
            }
            return;
        };
        self.known += 1;
        let start = self.rows.values.len();
        let expected = channels(self.skeleton, slot).len();
        let mut count = 0;
        for token in values {
            count += 1;
            match number(token) {
                Some(value) if count <= expected => self.rows.values.push(value),
                Some(_) => {}
                None => {
                    let expected = format!("{expected} numbers for bone {name}");
                    return self.spoil(
                        start,
                        ParseError::new(Place::Line(line), expected, quoted(token)),
                    );
                }
            }
        }
        if count != expected {
            let found = format!("{count} values");
            let expected = format!("{expected} numbers for bone {name}");
            return self.spoil(start, ParseError::new(Place::Line(line), expected, found));
        }
        // `begin_frame` has counted at least one frame before any row comes here.
        let frame = (self.frames - 1) as usize;
        if self.rows.add(slot, AmcRow { frame, start }) {
            self.warn(
                line,
                format!("a second row of bone {name} in one frame; the last one counts"),
            );
        }
    }

    fn spoil(&mut self, start: usize, problem: ParseError) {
        self.rows.values.truncate(start);
        self.spoiled += 1;
        if self.spoiled <= SHOWN {
            let note = format!(
                "expected {}, found {}; interpolated",
                problem.expected, problem.found
            );
            self.warnings.push(Warning::new(problem.at, note));
        }
        self.first_spoiled.get_or_insert(problem);
    }

    fn warn(&mut self, line: u64, note: String) {
        // Ten of a kind tell the story; a file of a million such lines must not fill the memory.
        if self.warnings.len() < 4 * SHOWN {
            self.warnings.push(Warning::new(Place::Line(line), note));
        }
    }

    fn finish(mut self, last_line: u64) -> Result<(AmcRows, Vec<Warning>), ParseError> {
        let at = Place::Line(last_line.max(1));
        if self.frames == 0 {
            let expected = "frames: a number on a line of its own, then a line for each bone";
            return Err(ParseError::new(
                at,
                expected,
                "none up to the end of the file",
            ));
        }
        if self.unknown > self.known || self.known == 0 {
            let unknown: Vec<_> = self.unknown_names.iter().take(3).cloned().collect();
            let found = match unknown.as_slice() {
                [] => "no row of any bone".to_owned(),
                names => format!(
                    "rows of {} and the like; is this the right skeleton?",
                    names.join(", ")
                ),
            };
            return Err(ParseError::new(
                Place::File,
                "rows of the skeleton's bones",
                found,
            ));
        }
        self.rows.frames = self.frames as usize;
        self.rows.degrees = self.degrees;
        if self.rows.drop_unfinished_frame() {
            let note = format!(
                "the last frame, from line {}, is incomplete and left out",
                self.frame_line
            );
            self.warnings
                .push(Warning::new(Place::Line(self.frame_line), note));
        }
        match self.first_spoiled {
            Some(problem) if self.spoiled > self.known / 2 => return Err(problem),
            _ => {}
        }
        if self.spoiled > SHOWN {
            let note = format!("{} rows in all could not be read", self.spoiled);
            self.warnings.push(Warning::new(Place::File, note));
        }
        Ok((self.rows, self.warnings))
    }
}

/// A line that is nothing but digits.
fn frame_number(token: &[u8]) -> Option<u64> {
    if !token.iter().all(u8::is_ascii_digit) {
        return None;
    }
    std::str::from_utf8(token).ok()?.parse().ok()
}

fn rate(name: &str, options: &AmcOptions, warnings: &mut Vec<Warning>) -> f64 {
    match options.rate_hz {
        Some(rate_hz) if rate_hz.is_finite() && rate_hz > 0.0 => return rate_hz,
        Some(rate_hz) => {
            let note = format!("a rate of {rate_hz} Hz is invalid and not used");
            warnings.push(Warning::new(Place::File, note));
        }
        None => {}
    }
    let (rate_hz, why) = match rate_in_name(name) {
        Some(rate_hz) => (rate_hz, "as its name says"),
        None => (DEFAULT_RATE_HZ, "the usual rate"),
    };
    let note = format!("AMC files do not state their frame rate; {rate_hz} Hz is assumed, {why}");
    warnings.push(Warning::new(Place::File, note));
    rate_hz
}

/// `HDM_dg_01-02_120` (that library ends its names with the rate), `walk_60hz`, `walk_60fps`. A bare number at
/// the end of other names is a trial's: CMU's `86_01`.
fn rate_in_name(name: &str) -> Option<f64> {
    let lower = name.to_lowercase();
    let last = lower.rsplit(['_', '-', ' ', '.']).next()?;
    let digits = match last.strip_suffix("hz").or_else(|| last.strip_suffix("fps")) {
        Some(digits) => digits,
        None if lower.starts_with("hdm_") => last,
        None => return None,
    };
    digits
        .parse()
        .ok()
        .filter(|rate| (5.0..=1000.0).contains(rate))
}

#[cfg(test)]
mod tests {
    use super::rate_in_name;

    #[test]
    fn trial_numbers_are_not_rates() {
        assert_eq!(rate_in_name("HDM_dg_06-03_03_120"), Some(120.0));
        assert_eq!(rate_in_name("walk_60hz"), Some(60.0));
        assert_eq!(rate_in_name("86_30"), None);
        assert_eq!(rate_in_name("walk"), None);
        assert_eq!(rate_in_name(""), None);
    }
}

//! CSM: markers over time as text, as Character Studio of 3ds Max takes them (Autodesk, *CSM File Specification*).
//!
//! Keywords begin with `$`, with their value behind them or below. `$Order` names the markers; below `$Points` each line is a
//! frame: its number, then x, y and z of every marker. `DROPOUT` stands for a coordinate or a marker that was not seen.

use super::cells::{Decimal, lines, number};
use super::descriptor::FormatDescriptor;
use super::points::{Point, UNSEEN, check_size};
use super::timing::{Clock, Stamps, TimedPoints};
use super::{Limits, Loaded, ParseError, Place, Warning};
use crate::math::Vec3;
use crate::parse_error::shortened;

pub(super) const FORMAT: FormatDescriptor = FormatDescriptor {
    name: "csm",
    title: "CSM",
    noun: "a CSM recording",
    endings: &["csm"],
    looks_so: |h| !h.is_binary() && h.says("$order") && h.says("$points"),
    up: None,
    read: |file| Ok(file.at_rate(read(file.bytes, file.name, file.rate_hz, file.limits)?)),
};

/// Frames a second where the file does not say.
const ASSUMED_HZ: f64 = 60.0;

/// Reads the markers of a CSM file, a clip called `name`, or one for each subject if several have a body. `rate_hz` replaces
/// the rate in the file. The unit is inferred from the body's height. O(bytes).
///
/// # Errors
/// The place and the cause: no `$Order`, no frames below `$Points`, more of markers or frames than `limits` allow.
pub fn read(
    bytes: &[u8],
    name: &str,
    rate_hz: Option<f64>,
    limits: &Limits,
) -> Result<Loaded, ParseError> {
    let rows = lines(bytes, limits)?;
    let heading = CsmHeading::read(&rows);
    if heading.markers.is_empty() {
        let expected = "names of markers below `$Order` in the CSM file";
        return Err(ParseError::new(Place::File, expected, "none"));
    }
    let body = &rows[heading.rows..];
    check_size(heading.markers.len(), body.len(), bytes.len(), limits)?;
    let mut warnings = Vec::new();
    let (points, numbers) = heading.frames(body, limits, &mut warnings)?;
    let clock = Clock {
        given_hz: rate_hz,
        stated_hz: heading.rate_hz,
        assumed_hz: ASSUMED_HZ,
    };
    let stamps = Stamps::none(numbers.len()).numbered(numbers);
    TimedPoints::of_any_unit(points, stamps, clock).into_loaded(name, warnings, limits)
}

/// Everything above the frames.
#[derive(Default)]
struct CsmHeading<'a> {
    rate_hz: Option<f64>,
    first: Option<f64>,
    last: Option<f64>,
    markers: Vec<&'a str>,
    /// Number of rows up to the frames.
    rows: usize,
}

impl<'a> CsmHeading<'a> {
    fn read(rows: &[(u64, &'a str)]) -> Self {
        let mut heading = Self::default();
        let mut keyword = String::new();
        for &(_, row) in rows {
            heading.rows += 1;
            let mut words = row.split_whitespace().peekable();
            if let Some(word) = words.peek().and_then(|word| word.strip_prefix('$')) {
                keyword = word.to_ascii_lowercase();
                words.next();
            }
            match keyword.as_str() {
                "points" => break,
                "order" => heading.markers.extend(words),
                "rate" => heading.rate_hz = heading.rate_hz.or(value(words.next())),
                "firstframe" => heading.first = heading.first.or(value(words.next())),
                "lastframe" => heading.last = heading.last.or(value(words.next())),
                _ => {}
            }
        }
        heading.rate_hz = heading.rate_hz.filter(|&rate| rate > 0.0);
        heading
    }

    /// The markers, and the number of each frame.
    fn frames(
        &self,
        body: &[(u64, &str)],
        limits: &Limits,
        warnings: &mut Vec<Warning>,
    ) -> Result<(Vec<Point>, Vec<Option<f64>>), ParseError> {
        let mut points: Vec<Point> = self
            .markers
            .iter()
            .map(|name| Point {
                name: (*name).to_owned(),
                positions: Vec::with_capacity(body.len()),
            })
            .collect();
        let mut numbers = Vec::with_capacity(body.len());
        for &(line, row) in body {
            if numbers.len() == limits.frames {
                let expected = format!("at most {} frames", limits.frames);
                return Err(ParseError::new(Place::Line(line), expected, "more"));
            }
            let mut words = row.split_whitespace();
            let Some(frame) = value(words.next()) else {
                let shown = shortened(row.trim());
                let text = format!("`{shown}` does not begin with a frame's number; left out");
                warnings.push(Warning::new(Place::Line(line), text));
                continue;
            };
            numbers.push(Some(frame));
            self.push_frame(&mut points, words, line, warnings);
        }
        self.check_count(numbers.len(), warnings);
        match numbers.last() {
            Some(_) => Ok((points, numbers)),
            None => Err(ParseError::new(
                Place::Line(body.last().map_or(1, |row| row.0)),
                "frames below `$Points`",
                "none",
            )),
        }
    }

    fn push_frame<'w>(
        &self,
        points: &mut [Point],
        words: impl Iterator<Item = &'w str>,
        line: u64,
        warnings: &mut Vec<Warning>,
    ) {
        let found: Vec<Option<f64>> = words.map(|word| value(Some(word))).collect();
        let missing = found.iter().filter(|value| value.is_none()).count();
        let needed = 3 * points.len();
        // One word for a marker, or one for each of its coordinates.
        let by_marker = missing > 0 && found.len() + 2 * missing == needed;
        if !by_marker && found.len() != needed {
            let text = format!("{} values, of {needed}: a gap", found.len());
            warnings.push(Warning::new(Place::Line(line), text));
            points.iter_mut().for_each(|p| p.positions.push(UNSEEN));
            return;
        }
        let mut found = found.into_iter();
        for point in points {
            let position = match found.next().flatten() {
                None if by_marker => UNSEEN,
                x => match (x, found.next().flatten(), found.next().flatten()) {
                    (Some(x), Some(y), Some(z)) => Vec3::new(x, y, z),
                    _ => UNSEEN,
                },
            };
            point.positions.push(position);
        }
    }

    fn check_count(&self, frames: usize, warnings: &mut Vec<Warning>) {
        let stated = self.first.zip(self.last).map(|(a, b)| b - a + 1.0);
        if let Some(stated) = stated.filter(|&stated| stated != frames as f64) {
            let text = format!("found {frames} frames, the header states {stated}");
            warnings.push(Warning::new(Place::File, text));
        }
    }
}

fn value(word: Option<&str>) -> Option<f64> {
    number(word?, Decimal::Point)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const HEAD: &str = "$Filename a.csm\n$Actor Ann\n$Comments\nTwo words\n$FirstFrame 1\n$LastFrame 3\n\
        $Rate 50\n\n$Order\nLFHD RFHD\nLANK\n\n$Points\n";

    fn load(body: &str) -> Loaded {
        let text = format!("{HEAD}{body}");
        read(text.as_bytes(), "a", None, &Limits::default()).unwrap()
    }

    #[test]
    fn frames_are_read() {
        let loaded = load("1 1 2 3  4 5 6  7 8 9\n2 2 2 3  4 5 6  7 8 9\r\n3 3 2 3 4 5 6 7 8 9\n");
        let clip = &loaded.clips[0];
        assert_eq!(loaded.warnings, []);
        assert_eq!((clip.rate_hz, clip.frames), (50.0, 3));
        assert_eq!(clip.points.as_ref().unwrap().metres_per_unit, None);
        let names: Vec<&str> = clip
            .skeleton
            .joints()
            .iter()
            .map(|j| j.name.as_str())
            .collect();
        assert_eq!(names, ["LFHD", "RFHD", "LANK"]);
    }

    #[test]
    fn what_was_not_seen_is_a_gap() {
        for missing in ["DROPOUT", "DROPOUT DROPOUT DROPOUT"] {
            let row = |f: u32, second: &str| format!("{f} {f} 2 3 {second} 7 8 9\n");
            let body: String = (1..=60)
                .map(|f| row(f, if f > 30 { missing } else { "4 5 6" }))
                .collect();
            let loaded = load(&body);
            let gaps = &loaded.clips[0].points.as_ref().unwrap().gaps;
            assert_eq!(gaps.len(), 1, "{missing}");
            assert_eq!((gaps[0].joint, &gaps[0].frames), (1, &(30..60)));
        }
    }

    #[test]
    fn what_is_wrong_is_said() {
        let loaded =
            load("1 1 2 3 4 5 6 7 8 9\nend\n3 2 3\n4 1 2 3 4 5 6 7 8 9\n5 1 2 3 4 5 6 7 8 9\n");
        let said: Vec<String> = loaded.warnings.iter().map(ToString::to_string).collect();
        assert!(
            said.iter().any(|w| w.contains("line 15: `end`")),
            "{said:?}"
        );
        assert!(
            said.iter().any(|w| w.contains("line 16: 2 values, of 9")),
            "{said:?}"
        );
        assert!(
            said.iter()
                .any(|w| w.contains("found 4 frames, the header states 3")),
            "{said:?}"
        );
        for (text, expected) in [
            ("$Points\n1 2 3 4\n", "names of markers"),
            ("$Order\nA B\n$Points\n", "frames below"),
            ("$Order A\n", "frames below"),
        ] {
            let error = read(text.as_bytes(), "a", None, &Limits::default()).unwrap_err();
            assert!(error.to_string().contains(expected), "{error}");
        }
    }

    #[test]
    fn numbers_of_frames_may_be_absurd() {
        let row = |frame: &str| format!("{frame} 1 2 3 4 5 6 7 8 9\n");
        let frames = ["1", "2", &"9".repeat(80)];
        let loaded = load(&frames.map(row).concat());
        assert!((3..=60).contains(&loaded.clips[0].frames));
    }

    proptest! {
        #[test]
        fn damage_never_panics(at in 0usize..150, byte: u8) {
            let mut text = format!("{HEAD}1 1 2 3 4 5 6 7 8 9\n2 DROPOUT 4 5 6 7 8 9\n").into_bytes();
            let at = at % text.len();
            text[at] = byte;
            let _ = read(&text, "a", None, &Limits::default());
        }
    }
}

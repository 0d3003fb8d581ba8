//! The layout of the frames of a C3D file, from its header and parameters; where they disagree, the length of the file decides.

use super::header::C3dHeader;
use super::params::{BLOCK, Parameters};
use crate::formats::{ParseError, Place, Warning};

/// Place and length of the frames.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct C3dLayout {
    /// Byte of the first frame.
    pub(super) start: usize,
    pub(super) points: usize,
    /// Analog values in a frame.
    pub(super) analog: usize,
    pub(super) floats: bool,
    pub(super) frames: usize,
}

impl C3dLayout {
    /// Of points and analog channels.
    pub(super) fn frame_bytes(&self) -> usize {
        let value = if self.floats { 4 } else { 2 };
        value * (4 * self.points + self.analog)
    }

    fn bytes(&self) -> usize {
        self.frame_bytes().saturating_mul(self.frames)
    }

    /// The first combination of what header and parameters say that the file's length confirms; else the first that
    /// fits into it; else the first, cut where the file ends.
    ///
    /// # Errors
    /// There are no points, or no frames.
    pub(super) fn choose(
        header: &C3dHeader,
        parameters: &Parameters,
        length: usize,
        warnings: &mut Vec<Warning>,
    ) -> Result<Self, ParseError> {
        let candidates = candidates(header, parameters, length);
        let with_points: Vec<C3dLayout> = candidates.into_iter().filter(|l| l.points > 0).collect();
        let Some(&first) = with_points.first() else {
            return Err(no_points(parameters));
        };
        let room = |l: &C3dLayout| length.saturating_sub(l.start);
        let fits = |l: &&C3dLayout| l.frames > 0 && l.bytes() <= room(l);
        // Data end with their block; some writers add one.
        let exact = |l: &&C3dLayout| fits(l) && room(l) - l.bytes() < 2 * BLOCK;
        let mut chosen = *with_points
            .iter()
            .find(exact)
            .or_else(|| with_points.iter().find(fits))
            .or_else(|| with_points.iter().find(|l| l.frames > 0))
            .unwrap_or(&first);
        let most = room(&chosen) / chosen.frame_bytes();
        if chosen.frames == 0 {
            let text = format!("no count of frames; the file has room for {most}");
            warnings.push(Warning::new(Place::Byte(6), text));
            chosen.frames = most;
        }
        if chosen.frames > most {
            let text = format!("the file ends after {most} of {} frames", chosen.frames);
            warnings.push(Warning::new(Place::Byte(length as u64), text));
            chosen.frames = most;
        }
        if chosen.frames == 0 {
            return Err(ParseError::new(
                Place::Byte(chosen.start as u64),
                "frames of points in the C3D file",
                "none",
            ));
        }
        note(&first, &chosen, warnings);
        Ok(chosen)
    }
}

fn no_points(parameters: &Parameters) -> ParseError {
    let channels = parameters.number("ANALOG", "USED").unwrap_or(0.0);
    let found = if channels > 0.0 {
        format!("none, but {channels} analog channels, which contain no motion")
    } else {
        "none".to_owned()
    };
    ParseError::new(Place::File, "points in the C3D file", found)
}

/// Everything that could be meant, the likeliest first.
fn candidates(header: &C3dHeader, parameters: &Parameters, length: usize) -> Vec<C3dLayout> {
    let count = |value: Option<f64>| value.map_or(0, |v| v.clamp(0.0, 1e9) as usize);
    let used = parameters.number("POINT", "USED");
    let points = distinct([count(used), header.points]);
    let ratio = |rate: f64| rate / parameters.number("POINT", "RATE").unwrap_or(header.rate_hz);
    let samples = parameters.number("ANALOG", "RATE").map_or(0.0, ratio);
    let by_rate = count(
        parameters
            .number("ANALOG", "USED")
            .map(|n| (n * samples).round()),
    );
    let analog = distinct([header.analog, by_rate]);
    let stated = parameters.number("POINT", "SCALE").unwrap_or(header.scale);
    let floats = distinct([stated < 0.0, header.scale < 0.0]);
    let start_of = |block: usize| block.saturating_sub(1).saturating_mul(BLOCK);
    let stated = count(parameters.number("POINT", "DATA_START"));
    let mut starts: Vec<usize> = distinct([header.data_block, stated])
        .into_iter()
        .filter(|&block| block > 1 && start_of(block) < length)
        .map(start_of)
        .collect();
    if starts.is_empty() {
        starts.push(parameters.end);
    }
    let mut all = Vec::new();
    for &start in &starts {
        for &points in &points {
            for &analog in &analog {
                for &floats in &floats {
                    for frames in frame_counts(header, parameters) {
                        all.push(C3dLayout {
                            start,
                            points,
                            analog,
                            floats,
                            frames,
                        });
                    }
                }
            }
        }
    }
    all
}

/// Possible numbers of frames. Words of 16 bits overflow in long recordings, so other parameters repeat the count.
pub(super) fn frame_counts(header: &C3dHeader, parameters: &Parameters) -> Vec<usize> {
    let span = |first: f64, last: f64| (last - first + 1.0).clamp(0.0, 1e9) as usize;
    let by_header = span(f64::from(header.first_frame), f64::from(header.last_frame));
    let actual = match (
        parameters.long("TRIAL", "ACTUAL_START_FIELD"),
        parameters.long("TRIAL", "ACTUAL_END_FIELD"),
    ) {
        (Some(first), Some(last)) => span(first, last),
        _ => 0,
    };
    let number = |name| {
        let value = parameters.number("POINT", name).unwrap_or(0.0);
        value.clamp(0.0, 1e9) as usize
    };
    let (frames, long) = (number("FRAMES"), number("LONG_FRAMES"));
    // What has overflowed is below the others by a multiple of 65536, or full.
    let mut counts = vec![by_header, frames];
    let most = actual.max(long);
    if most > by_header && (most > 65535 || header.last_frame == u16::MAX) {
        counts.splice(0..0, [actual, long]);
    } else {
        counts.extend([actual, long]);
    }
    let mut distinct: Vec<usize> = Vec::new();
    for count in counts {
        if count > 0 && !distinct.contains(&count) {
            distinct.push(count);
        }
    }
    if distinct.is_empty() {
        distinct.push(0);
    }
    distinct
}

fn distinct<T: PartialEq>([first, second]: [T; 2]) -> Vec<T> {
    if first == second {
        vec![first]
    } else {
        vec![first, second]
    }
}

/// Says where what was taken is not what is said first.
fn note(first: &C3dLayout, chosen: &C3dLayout, warnings: &mut Vec<Warning>) {
    let pairs = [
        ("points in a frame", first.points, chosen.points),
        ("analog values in a frame", first.analog, chosen.analog),
        ("frames", first.frames, chosen.frames),
        ("the byte of the first frame", first.start, chosen.start),
    ];
    for (what, said, taken) in pairs {
        if said != taken && said > 0 {
            let text = format!(
                "header and parameters disagree about {what}: {said} is stated, {taken} fits the file and is used"
            );
            warnings.push(Warning::new(Place::File, text));
        }
    }
    if first.floats != chosen.floats {
        let text = "header and parameters disagree on whether points are integers; the file's length decides";
        warnings.push(Warning::new(Place::File, text));
    }
}

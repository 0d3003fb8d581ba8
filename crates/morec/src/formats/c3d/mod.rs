//! C3D: points (and analog channels, which are not read) of biomechanics.
//!
//! After the format's public description, *The C3D File Format: A Technical User Guide* (Motion Lab Systems): blocks of
//! 512 bytes; a header, parameters, frames. Three processors' numbers, integers and floats. Where header and parameters
//! disagree, the length of the file decides ([`layout`]).

mod header;
mod layout;
mod number;
mod params;
mod write;

pub use write::write;

use self::header::Header;
use self::layout::Layout;
use self::number::Processor;
use self::params::{BLOCK, Parameters};
use super::points::{Point, PointTable, UNSEEN, metres_of};
use super::{Limits, Loaded, ParseError, Place, Warning};
use crate::math::Vec3;

/// Frames a second of a file that does not say.
const ASSUMED_HZ: f64 = 100.0;
/// What integer steps are taken to be if nothing says.
const ASSUMED_SCALE: f64 = 0.1;

/// Reads a C3D file: a clip of points called `name`, one for each subject if several have a body. `rate_hz` replaces
/// the rate in the file. Angles, forces, moments and powers among the points are left out; events are named in a
/// warning. O(bytes).
///
/// # Errors
/// Where and what: no C3D file, no points, no frames, more of either than `limits` allow.
pub fn read(
    bytes: &[u8],
    name: &str,
    rate_hz: Option<f64>,
    limits: &Limits,
) -> Result<Loaded, ParseError> {
    let mut warnings = Vec::new();
    let Some(block) = bytes.first_chunk::<BLOCK>() else {
        let found = match bytes.len() {
            0 => "an empty file".to_owned(),
            n => format!("{n} bytes in all"),
        };
        return Err(ParseError::new(
            Place::Byte(0),
            "a C3D header of 512 bytes",
            found,
        ));
    };
    let (start, processor) = parameter_section(bytes, block, &mut warnings)?;
    let header = Header::read(block, processor);
    let parameters = Parameters::read(bytes, start, processor, &mut warnings);
    let layout = Layout::choose(&header, &parameters, bytes.len(), &mut warnings)?;
    if layout.frames > limits.frames {
        let expected = format!("at most {} frames", limits.frames);
        return Err(ParseError::new(
            Place::Byte(6),
            expected,
            layout.frames.to_string(),
        ));
    }
    let rate_hz = rate_hz.unwrap_or_else(|| rate(&header, &parameters, &mut warnings));
    let scale = scale(&header, &parameters, layout.floats, &mut warnings);
    note_events(&header, &parameters, rate_hz, &mut warnings);
    let names = names(&parameters, layout.points, &mut warnings);
    let wanted = wanted(&names, &parameters, &mut warnings);
    let unit = parameters.texts("POINT", "UNITS");
    let metres_per_unit = unit.first().and_then(|unit| metres_of(unit));
    if metres_per_unit.is_none() {
        let text = match unit.first().filter(|unit| !unit.is_empty()) {
            Some(unit) => format!("POINT:UNITS is `{unit}`, no known unit of length"),
            None => "no POINT:UNITS; the body's height tells the unit".to_owned(),
        };
        warnings.push(Warning::new(Place::File, text));
    }
    let table = PointTable {
        points: points(bytes, &layout, processor, scale, &names, &wanted),
        rate_hz,
        metres_per_unit,
        zero_is_missing: true,
    };
    table.into_loaded(name, warnings, limits)
}

/// Where the parameters begin and which processor's numbers the file has.
fn parameter_section(
    bytes: &[u8],
    block: &[u8; BLOCK],
    warnings: &mut Vec<Warning>,
) -> Result<(usize, Processor), ParseError> {
    if block[1] != 0x50 {
        let found = format!("0x{:02X}", block[1]);
        return Err(ParseError::new(
            Place::Byte(1),
            "0x50, as in every C3D file",
            found,
        ));
    }
    let start_of = |block: u8| usize::from(block).saturating_sub(1) * BLOCK;
    let processor_at = |start: usize| Processor::of_byte(*bytes.get(start + 3)?);
    let stated = start_of(block[0]);
    if let Some(processor) = processor_at(stated).filter(|_| stated > 0) {
        return Ok((stated, processor));
    }
    let text = |found: &str| {
        let stated = block[0];
        Warning::new(
            Place::Byte(0),
            format!("no parameters in block {stated}; {found}"),
        )
    };
    if let Some(processor) = processor_at(BLOCK) {
        warnings.push(text("those of block 2 are taken"));
        return Ok((BLOCK, processor));
    }
    let start = if stated > 0 { stated } else { BLOCK };
    let plausible = |processor: &&Processor| Header::read(block, **processor).is_plausible();
    match Processor::ALL.iter().find(plausible) {
        Some(&processor) => {
            let name = processor.name();
            warnings.push(text(&format!("numbers are read as {name} wrote them")));
            Ok((start, processor))
        }
        None => Err(ParseError::new(
            Place::Byte(start as u64 + 3),
            "84, 85 or 86 for the processor of a C3D file",
            bytes
                .get(start + 3)
                .map_or("the end of the file".to_owned(), u8::to_string),
        )),
    }
}

fn rate(header: &Header, parameters: &Parameters, warnings: &mut Vec<Warning>) -> f64 {
    let usable = |rate: &f64| (0.01..=100_000.0).contains(rate);
    let stated = parameters.number("POINT", "RATE").filter(usable);
    let in_header = Some(header.rate_hz).filter(usable);
    if let (Some(stated), Some(in_header)) = (stated, in_header) {
        if (stated / in_header - 1.0).abs() > 1e-3 {
            let text = format!(
                "POINT:RATE is {stated} Hz, in the header it is {in_header} Hz; the first is taken"
            );
            warnings.push(Warning::new(Place::Byte(20), text));
        }
    }
    stated.or(in_header).unwrap_or_else(|| {
        let text = format!("no frame rate; {ASSUMED_HZ} Hz is assumed");
        warnings.push(Warning::new(Place::Byte(20), text));
        ASSUMED_HZ
    })
}

/// What an integer step is long; 1 for floats.
fn scale(
    header: &Header,
    parameters: &Parameters,
    floats: bool,
    warnings: &mut Vec<Warning>,
) -> f64 {
    if floats {
        return 1.0;
    }
    let usable = |scale: &f64| (1e-9..1e6).contains(&scale.abs());
    let stated = parameters
        .number("POINT", "SCALE")
        .map(f64::abs)
        .filter(usable);
    let in_header = Some(header.scale.abs()).filter(usable);
    if let (Some(stated), Some(in_header)) = (stated, in_header) {
        if (stated / in_header - 1.0).abs() > 1e-3 {
            let text = format!(
                "POINT:SCALE is {stated}, in the header it is {in_header}; the first is taken"
            );
            warnings.push(Warning::new(Place::Byte(12), text));
        }
    }
    stated.or(in_header).unwrap_or_else(|| {
        let text = format!("no scale for integer points; {ASSUMED_SCALE} is assumed");
        warnings.push(Warning::new(Place::Byte(12), text));
        ASSUMED_SCALE
    })
}

/// A name for each point.
fn names(parameters: &Parameters, points: usize, warnings: &mut Vec<Warning>) -> Vec<String> {
    let mut names = parameters.all_texts("POINT", "LABELS");
    if names.len() < points {
        let text = format!(
            "{} labels for {points} points; the others are numbered",
            names.len()
        );
        warnings.push(Warning::new(Place::File, text));
    }
    names.truncate(points);
    for number in names.len() + 1..=points {
        names.push(format!("point {number}"));
    }
    for (number, name) in (1..).zip(&mut names) {
        if name.is_empty() {
            *name = format!("point {number}");
        }
    }
    names
}

/// Parameters of POINT that list what is no position, and how such names end.
const NO_POSITIONS: [(&str, &[&str]); 6] = [
    ("ANGLES", &["Angles", "Angle"]),
    ("FORCES", &["Force", "Forces", "GRF"]),
    ("MOMENTS", &["Moment", "Moments", "GRM"]),
    ("POWERS", &["Power", "Powers"]),
    ("SCALARS", &[]),
    ("REACTIONS", &[]),
];

/// Which points are positions: their numbers.
fn wanted(names: &[String], parameters: &Parameters, warnings: &mut Vec<Warning>) -> Vec<usize> {
    let mut listed: Vec<String> = Vec::new();
    let mut endings: Vec<&str> = Vec::new();
    for (parameter, ends) in NO_POSITIONS {
        listed.extend(parameters.all_texts("POINT", parameter));
        endings.extend(ends);
    }
    let is_position = |name: &String| {
        let bare = name.rsplit(':').next().unwrap_or(name);
        let ends = endings
            .iter()
            .any(|end| bare.len() > end.len() && bare.ends_with(end));
        !ends && !listed.contains(name)
    };
    let wanted: Vec<usize> = (0..names.len())
        .filter(|&p| is_position(&names[p]))
        .collect();
    let left_out = names.len() - wanted.len();
    if left_out > 0 {
        let text =
            format!("{left_out} angles, forces, moments or powers among the points left out");
        warnings.push(Warning::new(Place::File, text));
    }
    wanted
}

/// The positions of the points in `wanted`, frame by frame.
fn points(
    bytes: &[u8],
    layout: &Layout,
    processor: Processor,
    scale: f64,
    names: &[String],
    wanted: &[usize],
) -> Vec<Point> {
    let data = bytes.get(layout.start..).unwrap_or_default();
    let point_bytes = if layout.floats { 16 } else { 8 };
    let mut points: Vec<Point> = wanted
        .iter()
        .map(|&p| Point {
            name: names[p].clone(),
            positions: Vec::with_capacity(layout.frames),
        })
        .collect();
    for frame in data.chunks_exact(layout.frame_bytes()).take(layout.frames) {
        for (&p, point) in wanted.iter().zip(&mut points) {
            let value = &frame[p * point_bytes..(p + 1) * point_bytes];
            let position = match layout.floats {
                true => float_point(value, processor),
                false => integer_point(value, processor).map(|p| p * scale),
            };
            point.positions.push(position.unwrap_or(UNSEEN));
        }
    }
    points
}

/// A position and its residual, which is negative if the point was not seen.
fn float_point(value: &[u8], processor: Processor) -> Option<Vec3> {
    let at = |i: usize| {
        processor.f32([
            value[4 * i],
            value[4 * i + 1],
            value[4 * i + 2],
            value[4 * i + 3],
        ])
    };
    (at(3) >= 0.0 || at(3).is_nan()).then(|| Vec3::new(at(0), at(1), at(2)))
}

fn integer_point(value: &[u8], processor: Processor) -> Option<Vec3> {
    let at = |i: usize| processor.i16([value[2 * i], value[2 * i + 1]]);
    (at(3) >= 0).then(|| Vec3::new(at(0).into(), at(1).into(), at(2).into()))
}

/// Events of the EVENT group, else of the header, in one warning: labels are not among what a clip holds.
fn note_events(
    header: &Header,
    parameters: &Parameters,
    rate_hz: f64,
    warnings: &mut Vec<Warning>,
) {
    const SHOWN: usize = 12;
    let labels = parameters.all_texts("EVENT", "LABELS");
    let contexts = parameters.all_texts("EVENT", "CONTEXTS");
    // Minutes and seconds of each.
    let times = parameters.numbers("EVENT", "TIMES");
    let mut events: Vec<(f64, String)> = labels
        .iter()
        .zip(times.chunks_exact(2))
        .enumerate()
        .map(|(e, (label, time))| {
            let context = contexts.get(e).map_or("", String::as_str);
            (
                60.0 * time[0] + time[1],
                format!("{context} {label}").trim().to_owned(),
            )
        })
        .collect();
    if events.is_empty() {
        events.clone_from(&header.events);
    }
    events.retain(|(time, name)| time.is_finite() && !name.is_empty());
    if events.is_empty() {
        return;
    }
    // Times count from the recording's frame 1; a clip begins with the first frame of the file.
    let first = f64::from(header.first_frame.max(1) - 1) / rate_hz;
    events.sort_by(|a, b| a.0.total_cmp(&b.0));
    let shown: Vec<String> = events
        .iter()
        .take(SHOWN)
        .map(|(time, name)| format!("{name} at {:.3} s", time - first))
        .collect();
    let more = if events.len() > SHOWN { ", …" } else { "" };
    let text = format!("{} events: {}{more}", events.len(), shown.join(", "));
    warnings.push(Warning::new(Place::File, text));
}

#[cfg(test)]
mod tests;

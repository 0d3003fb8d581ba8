//! C3D: points (and analog channels, which are not read) of biomechanics.
//!
//! After the format's public description, *The C3D File Format: A Technical User Guide* (Motion Lab Systems): blocks of
//! 512 bytes; a header, parameters, frames. Three processors' numbers, integers and floats. Where header and parameters
//! disagree, the length of the file decides.

mod events;
mod frames;
mod header;
mod layout;
mod number;
mod params;
mod rotations;
mod write;

pub use write::write;

use self::header::C3dHeader;
use self::layout::C3dLayout;
use self::number::Processor;
use self::params::{BLOCK, Parameters};
use super::descriptor::FormatDescriptor;
use super::points::{PointTable, check_size, metres_of};
use super::{Limits, Loaded, ParseError, Place, Warning};

pub(super) const FORMAT: FormatDescriptor = FormatDescriptor {
    name: "c3d",
    title: "C3D",
    noun: "a C3D recording",
    endings: &["c3d"],
    looks_so: |h| h.bytes.len() >= 512 && matches!(h.bytes, [1..128, 0x50, ..]) && h.is_binary(),
    up: None,
    read: |file| read(file.bytes, file.name, file.rate_hz, file.limits),
};

/// Frames a second of a file that does not say.
const ASSUMED_HZ: f64 = 100.0;
/// Length of an integer step if the file has none.
const ASSUMED_SCALE: f64 = 0.1;

/// Reads a C3D file: a clip of points called `name`, one for each subject if several have a body. `rate_hz` replaces
/// the rate in the file. Angles, forces, moments and powers among the points are left out; events are named in a
/// warning. O(bytes).
///
/// # Errors
/// The place and the cause: no C3D file, no points, no frames, more of either than `limits` allow.
pub fn read(
    bytes: &[u8],
    name: &str,
    rate_hz: Option<f64>,
    limits: &Limits,
) -> Result<Loaded, ParseError> {
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
    let mut warnings = Vec::new();
    let (start, processor) = parameter_section(bytes, block, &mut warnings)?;
    let header = C3dHeader::read(block, processor);
    let parameters = Parameters::read(bytes, start, processor, &mut warnings);
    let given_hz = rate_hz;
    let rate_hz = given_hz.unwrap_or_else(|| rate(&header, &parameters, &mut warnings));
    let layout = C3dLayout::choose(&header, &parameters, bytes.len(), &mut warnings);
    let segments = match &layout {
        Err(_) => rotations::origins(bytes, &header, &parameters, limits, &mut warnings)?,
        Ok(_) => None,
    };
    events::note(&header, &parameters, rate_hz, &mut warnings);
    let metres_per_unit = metres_per_unit(&parameters, &mut warnings);
    let (points, rate_hz) = match segments {
        Some((points, ratio)) => (points, given_hz.unwrap_or(rate_hz * ratio)),
        None => {
            let layout = layout?;
            let scale = scale(&header, &parameters, layout.floats, &mut warnings);
            let names = names(&parameters, layout.points, &mut warnings);
            let wanted = wanted(&names, &parameters, &mut warnings);
            // The length of the file bounds them.
            check_size(wanted.len(), layout.frames, bytes.len(), limits)?;
            let points = frames::points(bytes, &layout, processor, scale, &names, &wanted);
            (points, rate_hz)
        }
    };
    let frames = points.first().map_or(0, |point| point.positions.len());
    if frames > limits.frames {
        let expected = format!("at most {} frames", limits.frames);
        return Err(ParseError::new(
            Place::Byte(6),
            expected,
            frames.to_string(),
        ));
    }
    let table = PointTable {
        points,
        rate_hz,
        metres_per_unit,
        zero_is_missing: true,
    };
    table.into_loaded(name, warnings, limits)
}

/// Metres in the unit that the file states.
fn metres_per_unit(parameters: &Parameters, warnings: &mut Vec<Warning>) -> Option<f64> {
    let unit = parameters.texts("POINT", "UNITS");
    let metres_per_unit = unit.first().and_then(|unit| metres_of(unit));
    if metres_per_unit.is_none() {
        let text = match unit.first().filter(|unit| !unit.is_empty()) {
            Some(unit) => format!("POINT:UNITS is `{unit}`, no known unit of length"),
            None => "no POINT:UNITS; the unit is inferred from the body's height".to_owned(),
        };
        warnings.push(Warning::new(Place::File, text));
    }
    metres_per_unit
}

/// What a C3D file says of its time besides its rate.
#[derive(Debug, Clone, PartialEq)]
pub struct C3dTime {
    /// The number that the file gives its first frame, often 1.
    pub first_frame: usize,
    /// Seconds from the first frame, and names, of its events, in order.
    pub events: Vec<(f64, String)>,
}

/// Reads the number of the first frame and the events of a C3D file. O(bytes of its parameters).
///
/// # Errors
/// No C3D file.
pub fn read_time(bytes: &[u8]) -> Result<C3dTime, ParseError> {
    let mut warnings = Vec::new();
    let block = bytes.first_chunk::<BLOCK>().ok_or_else(|| {
        let found = format!("{} bytes in all", bytes.len());
        ParseError::new(Place::Byte(0), "a C3D header of 512 bytes", found)
    })?;
    let (start, processor) = parameter_section(bytes, block, &mut warnings)?;
    let header = C3dHeader::read(block, processor);
    let parameters = Parameters::read(bytes, start, processor, &mut warnings);
    let rate_hz = rate(&header, &parameters, &mut warnings);
    let stated = parameters.long("TRIAL", "ACTUAL_START_FIELD");
    let stated = stated.filter(|first| (0.0..1e9).contains(first));
    Ok(C3dTime {
        first_frame: stated.map_or(usize::from(header.first_frame), |first| first as usize),
        events: events::list(&header, &parameters, rate_hz),
    })
}

/// Start of the parameters, and the processor whose number format the file uses.
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
        warnings.push(text("those of block 2 are used"));
        return Ok((BLOCK, processor));
    }
    let start = if stated > 0 { stated } else { BLOCK };
    let plausible = |processor: &&Processor| C3dHeader::read(block, **processor).is_plausible();
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

fn rate(header: &C3dHeader, parameters: &Parameters, warnings: &mut Vec<Warning>) -> f64 {
    let usable = |rate: &f64| (0.01..=100_000.0).contains(rate);
    let stated = parameters.number("POINT", "RATE").filter(usable);
    let in_header = Some(header.rate_hz).filter(usable);
    if let (Some(stated), Some(in_header)) = (stated, in_header)
        && (stated / in_header - 1.0).abs() > 1e-3
    {
        let text = format!(
            "POINT:RATE is {stated} Hz, the header states {in_header} Hz; POINT:RATE is used"
        );
        warnings.push(Warning::new(Place::Byte(20), text));
    }
    stated.or(in_header).unwrap_or_else(|| {
        let text = format!("no frame rate; {ASSUMED_HZ} Hz is assumed");
        warnings.push(Warning::new(Place::Byte(20), text));
        ASSUMED_HZ
    })
}

/// Length of an integer step; 1 for floats.
fn scale(
    header: &C3dHeader,
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
    if let (Some(stated), Some(in_header)) = (stated, in_header)
        && (stated / in_header - 1.0).abs() > 1e-3
    {
        let text =
            format!("POINT:SCALE is {stated}, the header states {in_header}; POINT:SCALE is used");
        warnings.push(Warning::new(Place::Byte(12), text));
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

/// Numbers of the points that are positions.
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

#[cfg(test)]
mod tests;

//! Writing C3D: Intel floats, no analog channels.

use std::io::{self, Write};

use super::super::points::{as_points, named_unit};
use super::params::BLOCK;
use crate::clip::Clip;
use crate::math::Vec3;

/// Points in one `LABELS` table.
const LABELS_A_TABLE: usize = 255;
/// Bytes of a label.
const LABEL: usize = 32;

/// Writes a clip as C3D: its points, or where its joints are in the world. Lengths stay as they are if their unit has a
/// name that C3D files use, and become millimetres otherwise. Gaps become points that were not seen.
///
/// # Errors
/// An I/O error of `out`.
pub fn write(clip: &Clip, out: &mut dyn Write) -> io::Result<()> {
    let clip = &*as_points(clip);
    let (unit, factor) = named_unit(clip);
    let parameters = parameters(clip, unit);
    let blocks = parameters.len() / BLOCK;
    out.write_all(&header(clip, blocks))?;
    out.write_all(&parameters)?;
    let mut written = 0;
    let mut row = Vec::with_capacity(16 * clip.tracks.len());
    for frame in 0..clip.frames {
        row.clear();
        for track in &clip.tracks {
            let seen = !clip.is_gap_at(track.joint, frame);
            let at = if seen {
                track.positions[frame] * factor
            } else {
                Vec3::zeros()
            };
            for value in [at.x, at.y, at.z, if seen { 0.0 } else { -1.0 }] {
                row.extend_from_slice(&(value as f32).to_le_bytes());
            }
        }
        out.write_all(&row)?;
        written += row.len();
    }
    out.write_all(&vec![0; written.next_multiple_of(BLOCK) - written])
}

fn header(clip: &Clip, parameter_blocks: usize) -> [u8; BLOCK] {
    let mut header = [0u8; BLOCK];
    header[..2].copy_from_slice(&[2, 0x50]);
    let word = |number: usize| 2 * number - 2..2 * number;
    header[word(2)].copy_from_slice(&clamped(clip.tracks.len()));
    header[word(4)].copy_from_slice(&1u16.to_le_bytes());
    header[word(5)].copy_from_slice(&clamped(clip.frames));
    header[12..16].copy_from_slice(&(-1f32).to_le_bytes());
    header[word(9)].copy_from_slice(&clamped(2 + parameter_blocks));
    header[20..24].copy_from_slice(&(clip.rate_hz as f32).to_le_bytes());
    header
}

/// A count as a word; what does not fit is repeated in parameters.
fn clamped(count: usize) -> [u8; 2] {
    u16::try_from(count).unwrap_or(u16::MAX).to_le_bytes()
}

/// The parameter section in whole blocks.
fn parameters(clip: &Clip, unit: &str) -> Vec<u8> {
    let mut section = vec![1, 0x50, 0, 84];
    group(&mut section, 1, "POINT");
    group(&mut section, 2, "TRIAL");
    let words = |counts: &[usize]| -> Vec<u8> { counts.iter().flat_map(|&c| clamped(c)).collect() };
    let float = |value: f64| (value as f32).to_le_bytes().to_vec();
    parameter(
        &mut section,
        1,
        "USED",
        2,
        &[],
        &words(&[clip.tracks.len()]),
    );
    parameter(&mut section, 1, "SCALE", 4, &[], &float(-1.0));
    parameter(&mut section, 1, "RATE", 4, &[], &float(clip.rate_hz));
    parameter(&mut section, 1, "FRAMES", 2, &[], &words(&[clip.frames]));
    parameter(&mut section, 1, "UNITS", -1, &[unit.len()], unit.as_bytes());
    let long = |count: usize| words(&[count & 0xFFFF, count >> 16]);
    parameter(&mut section, 2, "ACTUAL_START_FIELD", 2, &[2], &long(1));
    parameter(
        &mut section,
        2,
        "ACTUAL_END_FIELD",
        2,
        &[2],
        &long(clip.frames),
    );
    for (table, joints) in clip.skeleton.joints().chunks(LABELS_A_TABLE).enumerate() {
        let name = match table {
            0 => "LABELS".to_owned(),
            more => format!("LABELS{}", more + 1),
        };
        let labels: Vec<u8> = joints.iter().flat_map(|joint| label(&joint.name)).collect();
        parameter(&mut section, 1, &name, -1, &[LABEL, joints.len()], &labels);
    }
    // The data begin behind header and parameters.
    let size = (section.len() + 32).next_multiple_of(BLOCK);
    let data_start = clamped(2 + size / BLOCK);
    parameter(&mut section, 1, "DATA_START", 2, &[], &data_start);
    section.resize(size, 0);
    section[2] = u8::try_from(size / BLOCK).unwrap_or(u8::MAX);
    section
}

/// A name in its field: cut between characters, blanks behind.
fn label(name: &str) -> [u8; LABEL] {
    let mut end = name.len().min(LABEL);
    while !name.is_char_boundary(end) {
        end -= 1;
    }
    let mut field = [b' '; LABEL];
    field[..end].copy_from_slice(&name.as_bytes()[..end]);
    field
}

fn group(section: &mut Vec<u8>, id: i8, name: &str) {
    section.extend([name.len() as u8, (-id) as u8]);
    section.extend(name.as_bytes());
    // To the next record: this word itself and an empty description.
    section.extend([3, 0, 0]);
}

fn parameter(section: &mut Vec<u8>, group: u8, name: &str, kind: i8, dims: &[usize], data: &[u8]) {
    section.extend([name.len() as u8, group]);
    section.extend(name.as_bytes());
    let step = 2 + 2 + dims.len() + data.len() + 1;
    section.extend(clamped(step));
    section.extend([kind as u8, dims.len() as u8]);
    section.extend(dims.iter().map(|&dim| dim as u8));
    section.extend(data);
    section.push(0);
}

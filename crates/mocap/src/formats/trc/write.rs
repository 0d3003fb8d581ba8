//! Writing TRC.

use std::io::{self, Write};

use super::super::points::{as_points, named_unit};
use crate::clip::Clip;

/// Writes a clip as TRC: its points, or where its joints are in the world. Lengths stay as they are if their unit has a
/// name that TRC files use, and become millimetres otherwise. Gaps become blank cells.
///
/// # Errors
/// An I/O error of `out`.
pub fn write(clip: &Clip, out: &mut dyn Write) -> io::Result<()> {
    let clip = &*as_points(clip);
    let (unit, factor) = named_unit(clip);
    let (rate, frames, points) = (clip.rate_hz, clip.frames, clip.tracks.len());
    writeln!(out, "PathFileType\t4\t(X/Y/Z)\t{}.trc", cell(&clip.name))?;
    writeln!(
        out,
        "DataRate\tCameraRate\tNumFrames\tNumMarkers\tUnits\tOrigDataRate\tOrigDataStartFrame\tOrigNumFrames"
    )?;
    writeln!(
        out,
        "{rate}\t{rate}\t{frames}\t{points}\t{unit}\t{rate}\t1\t{frames}"
    )?;
    write!(out, "Frame#\tTime")?;
    for joint in clip.skeleton.joints() {
        write!(out, "\t{}\t\t", cell(&joint.name))?;
    }
    write!(out, "\n\t")?;
    for number in 1..=points {
        write!(out, "\tX{number}\tY{number}\tZ{number}")?;
    }
    writeln!(out, "\n")?;
    for frame in 0..frames {
        write!(out, "{}\t{:.6}", frame + 1, frame as f64 / rate)?;
        for track in &clip.tracks {
            if clip.is_gap_at(track.joint, frame) {
                write!(out, "\t\t\t")?;
            } else {
                let at = track.positions[frame] * factor;
                write!(out, "\t{:.7}\t{:.7}\t{:.7}", at.x, at.y, at.z)?;
            }
        }
        writeln!(out)?;
    }
    Ok(())
}

/// A name as a cell of a table.
fn cell(name: &str) -> String {
    let text = name.replace(['\t', '\n', '\r'], " ");
    let text = text.trim();
    if text.is_empty() {
        "_".to_owned()
    } else {
        text.to_owned()
    }
}

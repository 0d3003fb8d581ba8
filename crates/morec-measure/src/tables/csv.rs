//! Tables as CSV: RFC 4180, a header row, a row for each frame.

use std::io::{self, Write};

use super::{Features, for_each_frame};
use morec::import::Take;

/// Content of a table's rows.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Content {
    /// World positions of the joints, metres: `Hips_x`, `Hips_y`, `Hips_z`. Such a table is read as a clip of points.
    #[default]
    Positions,
    /// Rotations `parent_from_joint`: `Hips_qx` to `Hips_qw`, and where the roots are.
    Rotations,
    /// Feature rows, 30 a second.
    Features,
}

/// Writes one table of `take`; the first column is the time in seconds. Points that were not seen are blank cells.
///
/// # Errors
/// An I/O error of `out`; rotations of a clip that has none; features of a body whose hips are not known.
pub fn write(take: &Take, content: Content, out: &mut dyn Write) -> io::Result<()> {
    match content {
        Content::Positions => positions(take, out),
        Content::Rotations => rotations(take, out),
        Content::Features => features(take, out),
    }
}

fn refused(why: &str) -> io::Error {
    io::Error::new(io::ErrorKind::InvalidInput, why)
}

/// A cell: quoted where it holds what separates cells.
fn cell(text: &str) -> String {
    if text.contains([',', '"', '\n', '\r', ';', '\t']) {
        format!("\"{}\"", text.replace('"', "\"\""))
    } else {
        text.to_owned()
    }
}

fn positions(take: &Take, out: &mut dyn Write) -> io::Result<()> {
    let clip = &take.clip;
    write!(out, "time_secs")?;
    for joint in clip.skeleton.joints() {
        for axis in ["x", "y", "z"] {
            write!(out, ",{}", cell(&format!("{}_{axis}", joint.name)))?;
        }
    }
    writeln!(out)?;
    for_each_frame(clip, |frame, pose| {
        write!(out, "{:.6}", frame as f64 / clip.rate_hz)?;
        for (joint, at) in pose.positions.iter().enumerate() {
            if clip.is_gap_at(joint, frame) {
                write!(out, ",,,")?;
            } else {
                write!(out, ",{:.6},{:.6},{:.6}", at.x, at.y, at.z)?;
            }
        }
        writeln!(out)
    })
}

fn rotations(take: &Take, out: &mut dyn Write) -> io::Result<()> {
    let clip = &take.clip;
    if !clip.has_rotations() {
        return Err(refused("a clip of points has no rotations"));
    }
    let joints = clip.skeleton.joints();
    write!(out, "time_secs")?;
    for joint in joints {
        if joint.parent.is_none() {
            for axis in ["x", "y", "z"] {
                write!(out, ",{}", cell(&format!("{}_{axis}", joint.name)))?;
            }
        }
        for axis in ["qx", "qy", "qz", "qw"] {
            write!(out, ",{}", cell(&format!("{}_{axis}", joint.name)))?;
        }
    }
    writeln!(out)?;
    for frame in 0..clip.frames {
        write!(out, "{:.6}", frame as f64 / clip.rate_hz)?;
        for (j, (joint, q)) in joints.iter().zip(clip.frame_rotations(frame)).enumerate() {
            if joint.parent.is_none() {
                let at = clip.local_position(frame, j);
                write!(out, ",{:.6},{:.6},{:.6}", at.x, at.y, at.z)?;
            }
            write!(out, ",{:.7},{:.7},{:.7},{:.7}", q.i, q.j, q.k, q.w)?;
        }
        writeln!(out)?;
    }
    Ok(())
}

fn features(take: &Take, out: &mut dyn Write) -> io::Result<()> {
    let features = Features::of(take).ok_or_else(|| {
        refused("there are no feature rows without the hip joints (--roles FILE names them)")
    })?;
    write!(out, "time_secs")?;
    for name in &features.names {
        write!(out, ",{name}")?;
    }
    writeln!(out)?;
    for (i, row) in features.rows.iter().enumerate() {
        write!(out, "{:.6}", (i + 1) as f64 / features.rate_hz)?;
        for value in row {
            write!(out, ",{value:.6}")?;
        }
        writeln!(out)?;
    }
    Ok(())
}

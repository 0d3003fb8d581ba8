//! The formats in which clips are written, and their extensions.

use std::path::Path;

use anyhow::{Result, bail};
use morec::clip::Clip;
use morec::formats::{bvh, c3d, gltf, jsonl, trc};
use morec::import::{ImportOptions, Take, normalize, points_by_role};
use morec_measure::tables::{Content, write_csv, write_npz};

use super::wanted::Wanted;
use crate::output;

/// Formats that `convert` writes.
#[derive(clap::ValueEnum, Clone, Copy, Debug, PartialEq, Eq)]
pub enum ClipForm {
    /// Skeleton and rotations; the clip's units and axes
    Bvh,
    /// Points, binary
    C3d,
    /// Points, tab-separated
    Trc,
    /// Positions by body part, one line of JSON a frame; metres, Y up
    Jsonl,
    /// Binary glTF: skeleton and rotations, metres
    Glb,
    /// A VRM animation: the joints that play roles
    Vrma,
    /// Positions, rotations and feature rows for NumPy
    Npz,
    /// One of these as a table
    Csv,
}

impl ClipForm {
    /// Every form with its ending.
    const ALL: [(ClipForm, &'static str); 8] = [
        (ClipForm::Bvh, "bvh"),
        (ClipForm::C3d, "c3d"),
        (ClipForm::Trc, "trc"),
        (ClipForm::Jsonl, "jsonl"),
        (ClipForm::Glb, "glb"),
        (ClipForm::Vrma, "vrma"),
        (ClipForm::Npz, "npz"),
        (ClipForm::Csv, "csv"),
    ];

    /// The ending of its files.
    pub fn ending(self) -> &'static str {
        Self::ALL
            .into_iter()
            .find(|(form, _)| *form == self)
            .map_or("bvh", |(_, ending)| ending)
    }

    /// The form that the ending of `path` promises; BVH without one.
    ///
    /// # Errors
    /// The ending of something that is not written.
    pub fn of(path: &Path) -> Result<Self> {
        let Some(ending) = path.extension() else {
            return Ok(ClipForm::Bvh);
        };
        let found = Self::ALL
            .into_iter()
            .find(|(_, known)| ending.eq_ignore_ascii_case(known));
        if let Some((form, _)) = found {
            return Ok(form);
        }
        let endings: Vec<String> = Self::ALL.iter().map(|(_, e)| format!(".{e}")).collect();
        bail!(
            "clips are written as {}, not as .{}",
            endings.join(", "),
            ending.to_string_lossy()
        )
    }
}

/// Writes a clip in the format that the ending of `path` names; whole or not at all.
pub fn write_clip(clip: &Clip, path: &Path) -> Result<()> {
    let wanted = Wanted {
        content: Content::default(),
        import: ImportOptions::default(),
        rate_hz: None,
        fit: false,
    };
    write(clip.clone(), ClipForm::of(path)?, &wanted, path)
}

/// Writes a clip in `form`; whole or not at all.
pub(super) fn write(clip: Clip, form: ClipForm, wanted: &Wanted, path: &Path) -> Result<()> {
    match form {
        ClipForm::Bvh => output::write_whole(path, |out| bvh::write(&clip, out)),
        ClipForm::C3d | ClipForm::Trc => write_points(&points_of(clip, wanted)?, form, path),
        ClipForm::Jsonl | ClipForm::Glb | ClipForm::Vrma | ClipForm::Npz | ClipForm::Csv => {
            let take = normalize(clip, &wanted.import)?;
            write_take(&take, form, wanted.content, path)
        }
    }
}

/// Writes a take in `form`, in metres with Y up; whole or not at all.
pub fn write_take(take: &Take, form: ClipForm, content: Content, path: &Path) -> Result<()> {
    match form {
        ClipForm::Bvh => output::write_whole(path, |out| bvh::write(&take.clip, out)),
        ClipForm::C3d | ClipForm::Trc => write_points(&take.clip.to_points(Some(1.0)), form, path),
        ClipForm::Jsonl => {
            let points = points_by_role(&take.clip, &take.roles);
            output::write_whole(path, |out| jsonl::write(&points, out))
        }
        ClipForm::Glb => output::write_whole(path, |out| gltf::write(&take.clip, out)),
        ClipForm::Vrma => {
            for doubt in &take.report.doubts {
                eprintln!("morec: {}: {doubt}", take.clip.name);
            }
            output::write_whole(path, |out| gltf::write_vrma(&take.clip, &take.roles, out))
        }
        ClipForm::Npz => output::write_whole(path, |out| write_npz(take, out)),
        ClipForm::Csv => output::write_whole(path, |out| write_csv(take, content, out)),
    }
}

fn write_points(points: &Clip, form: ClipForm, path: &Path) -> Result<()> {
    output::write_whole(path, |out| match form {
        ClipForm::C3d => c3d::write(points, out),
        _ => trc::write(points, out),
    })
}

/// Positions of the joints; formats of points name their unit, so one is inferred where the clip has none.
fn points_of(clip: Clip, wanted: &Wanted) -> Result<Clip> {
    if !clip.has_rotations() || clip.frames == 0 {
        return Ok(clip);
    }
    let report = normalize(clip.clone(), &wanted.import)?.report;
    Ok(clip.to_points(Some(report.metres_per_unit)))
}

//! Report of `smooth` on each clip, as text and as JSON.

use std::io::{self, Write};
use std::path::{Path, PathBuf};

use morec::smooth::{CompressedClip, Curve, Errors, SmoothParams};
use serde::Serialize;

use crate::table::TextTable;

/// A file, done or not.
#[derive(Serialize)]
#[serde(untagged)]
pub enum CompressionResult {
    Done {
        path: PathBuf,
        clips: Vec<CompressionReport>,
    },
    Failed {
        path: PathBuf,
        error: String,
    },
}

impl CompressionResult {
    pub fn failed(path: &Path, error: &anyhow::Error) -> Self {
        Self::Failed {
            path: path.to_owned(),
            error: format!("{error:#}"),
        }
    }
}

/// A clip that was compressed.
#[derive(Serialize)]
pub struct CompressionReport {
    clip: String,
    #[serde(skip_serializing_if = "Option::is_none")]
    written: Option<PathBuf>,
    frames: usize,
    rate_hz: f64,
    duration_secs: f64,
    channels: usize,
    still_channels: usize,
    keyframes: usize,
    raw_values: usize,
    control_values: usize,
    value_ratio: f64,
    stored_bytes: usize,
    #[serde(skip_serializing_if = "Option::is_none")]
    file_bytes: Option<u64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    byte_ratio: Option<f64>,
    thresholds: SmoothParams,
    errors: Errors,
}

impl CompressionReport {
    pub fn new(
        clip: &CompressedClip,
        written: Option<PathBuf>,
        stored_bytes: usize,
        file_bytes: Option<u64>,
    ) -> Self {
        Self {
            clip: clip.name().to_owned(),
            written,
            frames: clip.source_frames(),
            rate_hz: clip.source_rate_hz(),
            duration_secs: clip.duration_secs(),
            channels: clip.curves().count(),
            still_channels: clip.curves().filter(|curve| curve.is_constant()).count(),
            keyframes: clip.curves().map(Curve::keyframes).sum(),
            raw_values: clip.raw_values(),
            control_values: clip.control_values(),
            value_ratio: clip.compression_ratio(),
            stored_bytes,
            file_bytes,
            byte_ratio: file_bytes.map(|bytes| bytes as f64 / stored_bytes as f64),
            thresholds: *clip.params(),
            errors: *clip.errors(),
        }
    }

    fn write(&self, out: &mut dyn Write) -> io::Result<()> {
        writeln!(out, "{}", self.clip)?;
        if let Some(written) = &self.written {
            writeln!(out, "  written    {}", written.display())?;
        }
        let (frames, secs) = (self.frames, self.duration_secs);
        let rate = (self.rate_hz * 1e3).round() / 1e3;
        writeln!(
            out,
            "  length     {frames} frames, {secs:.2} s at {rate} Hz"
        )?;
        writeln!(
            out,
            "  keyframes  {} in {} channels, {} of which stand still",
            self.keyframes, self.channels, self.still_channels
        )?;
        let (raw, kept) = (self.raw_values, self.control_values);
        writeln!(
            out,
            "  values     {kept} for {raw}, 1:{:.1}",
            self.value_ratio
        )?;
        let stored = self.stored_bytes;
        match (self.file_bytes, self.byte_ratio) {
            (Some(file), Some(ratio)) => {
                writeln!(out, "  bytes      {stored} for {file}, 1:{ratio:.1}")?
            }
            _ => writeln!(out, "  bytes      {stored}")?,
        }
        let allowed = &self.thresholds;
        let (degrees, mm) = (
            allowed.angle_rad.to_degrees(),
            1e3 * allowed.position_metres,
        );
        writeln!(out, "  thresholds {degrees:.2}°, {mm:.1} mm")?;
        let e = &self.errors;
        let (most, mean) = (e.max_angle_rad.to_degrees(), e.mean_angle_rad.to_degrees());
        writeln!(
            out,
            "  angle      at most {most:.3}°, {mean:.3}° in the mean"
        )?;
        let mut lengths = |what: &str, most: f64, mean: f64| {
            writeln!(
                out,
                "  {what:9}  at most {:.2} mm, {:.2} mm in the mean",
                most * 1e3,
                mean * 1e3
            )
        };
        lengths("position", e.max_position_metres, e.mean_position_metres)?;
        lengths(
            "in world",
            e.max_joint_position_metres,
            e.mean_joint_position_metres,
        )
    }
}

/// One clip in full, several in a table with their total.
pub fn write(out: &mut dyn Write, reports: &[CompressionResult]) -> io::Result<()> {
    let clips: Vec<&CompressionReport> = reports
        .iter()
        .filter_map(|report| match report {
            CompressionResult::Done { clips, .. } => Some(clips),
            CompressionResult::Failed { .. } => None,
        })
        .flatten()
        .collect();
    match clips.as_slice() {
        [] => Ok(()),
        [clip] => clip.write(out),
        _ => write!(out, "{}", table(&clips)),
    }
}

fn table(clips: &[&CompressionReport]) -> TextTable {
    let header = [
        "clip",
        "keys",
        "values",
        "bytes",
        "",
        "max °",
        "mean °",
        "max mm",
        "world max",
        "world mean",
    ];
    let mut table = TextTable::new(header);
    let ratio = |a: f64, b: f64| {
        if a > 0.0 {
            format!("1:{:.1}", a / b)
        } else {
            String::new()
        }
    };
    for clip in clips {
        let e = &clip.errors;
        let file = clip.file_bytes.unwrap_or(0) as f64;
        table.row([
            clip.clip.clone(),
            clip.keyframes.to_string(),
            format!("1:{:.1}", clip.value_ratio),
            clip.stored_bytes.to_string(),
            ratio(file, clip.stored_bytes as f64),
            format!("{:.3}", e.max_angle_rad.to_degrees()),
            format!("{:.3}", e.mean_angle_rad.to_degrees()),
            format!("{:.2}", e.max_position_metres * 1e3),
            format!("{:.2}", e.max_joint_position_metres * 1e3),
            format!("{:.2}", e.mean_joint_position_metres * 1e3),
        ]);
    }
    table.row(total(clips));
    table
}

/// Sums, the largest of the largest, means over all values.
fn total(clips: &[&CompressionReport]) -> [String; 10] {
    let sum = |of: fn(&CompressionReport) -> f64| clips.iter().map(|clip| of(clip)).sum::<f64>();
    let most =
        |of: fn(&CompressionReport) -> f64| clips.iter().map(|clip| of(clip)).fold(0.0, f64::max);
    let values = sum(|c| c.raw_values as f64);
    let mean = |of: fn(&CompressionReport) -> f64| {
        clips
            .iter()
            .map(|clip| of(clip) * clip.raw_values as f64)
            .sum::<f64>()
            / values.max(1.0)
    };
    let known = clips.iter().all(|clip| clip.file_bytes.is_some());
    let stored = sum(|c| c.stored_bytes as f64);
    let bytes = sum(|c| c.file_bytes.unwrap_or(0) as f64);
    [
        format!("all {}", clips.len()),
        format!("{:.0}", sum(|c| c.keyframes as f64)),
        format!("1:{:.1}", values / sum(|c| c.control_values as f64)),
        format!("{stored:.0}"),
        if known {
            format!("1:{:.1}", bytes / stored)
        } else {
            String::new()
        },
        format!("{:.3}", most(|c| c.errors.max_angle_rad.to_degrees())),
        format!("{:.3}", mean(|c| c.errors.mean_angle_rad.to_degrees())),
        format!("{:.2}", most(|c| c.errors.max_position_metres * 1e3)),
        format!("{:.2}", most(|c| c.errors.max_joint_position_metres * 1e3)),
        format!("{:.2}", mean(|c| c.errors.mean_joint_position_metres * 1e3)),
    ]
}

//! `morec reduce`: the number of dimensions of the poses in clips.

use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use anyhow::{Context, Result, bail};
use morec::pca::{ComponentCount, Moments, Pca, QualityRow};
use morec::pivots::{PivotMap, clip_of_pose_rows, pose_rows_of_clip};
use morec_measure::report::pictures::quality_chart;
use serde::Serialize;

use super::convert::write_clip;
use crate::files;
use crate::json::write_json;
use crate::output;
use crate::poses::{PoseArgs, PoseReader};
use crate::table::TextTable;

/// Show how many dimensions the poses of clips have
///
/// Computes the principal components of all poses of all clips and prints the share of the variance that each number of
/// dimensions keeps. Memory grows with the longest clip only.
#[derive(clap::Args)]
#[command(after_help = "\
Examples:
  morec reduce recordings/
  morec reduce recordings/ --quality 0.9 --plot quality.svg
  morec reduce recordings/ --pivots roles --dims 16 --json
  morec reduce walk.bvh --dims 4 -o reduced/
  morec play walk.bvh --reduced 4 -o both.html  # beside the original")]
pub struct Args {
    /// Clips (BVH, AMC) or folders of clips
    #[arg(required = true, value_name = "CLIP")]
    clips: Vec<PathBuf>,
    /// Share of the variance to keep
    #[arg(long, value_name = "SHARE", default_value_t = 0.99)]
    quality: f64,
    /// Keep N dimensions instead
    #[arg(long, value_name = "N", conflicts_with = "quality")]
    dims: Option<usize>,
    /// Folder for the clips rebuilt from the kept dimensions (BVH)
    #[arg(short, long, value_name = "DIR")]
    output: Option<PathBuf>,
    /// Print one JSON object: the table, and the components with their mean
    #[arg(long)]
    json: bool,
    /// Draw the share that each number of dimensions keeps
    #[arg(long, value_name = "SVG")]
    plot: Option<PathBuf>,
    #[command(flatten)]
    poses: PoseArgs,
}

#[derive(Serialize)]
struct Reduced<'a> {
    clips: usize,
    pivots: usize,
    dims: usize,
    quality: f64,
    rms_error: f64,
    table: &'a [QualityRow],
    components: &'a Pca,
}

/// Reads all clips, prints what they come down to.
pub fn run(args: &Args) -> Result<ExitCode> {
    let keep = args
        .dims
        .map_or(ComponentCount::Quality(args.quality), ComponentCount::Dims);
    keep.check().map_err(anyhow::Error::msg)?;
    let reader = args.poses.reader()?;
    let mut moments = Moments::new(reader.set.row_dim());
    let mut clips = 0;
    reader.each(&args.clips, |clip| {
        moments.push_rows(&clip.rows);
        clips += 1;
        Ok(())
    })?;
    let pca = Pca::fit(&moments, keep)?;
    let table = pca.quality_table();
    if let Some(path) = &args.plot {
        let svg = quality_chart(
            &table,
            pca.dims(),
            "Dimensions and the share of the variance that they keep",
        )
        .svg();
        output::check_picture(path)?;
        output::write_whole(path, |out| out.write_all(svg.as_bytes()))
            .with_context(|| path.display().to_string())?;
    }
    if let Some(folder) = &args.output {
        args.write_reduced(&reader, &pca, folder)?;
    }
    let reduced = Reduced {
        clips,
        pivots: reader.set.len(),
        dims: pca.dims(),
        quality: pca.quality(),
        rms_error: pca.rms_error(),
        table: &table,
        components: &pca,
    };
    let mut out = crate::console::stdout();
    if args.json {
        write_json(&mut out, &reduced)?;
    } else {
        reduced.write(&mut out)?;
    }
    out.flush()?;
    Ok(ExitCode::SUCCESS)
}

impl Args {
    /// Writes every clip as its rows are after reduction (thesis, Eq. 3.10).
    fn write_reduced(&self, reader: &PoseReader, pca: &Pca, folder: &Path) -> Result<()> {
        let sources: Vec<PathBuf> = files::expand(&self.clips)?
            .iter()
            .filter_map(|path| path.canonicalize().ok())
            .collect();
        std::fs::create_dir_all(folder).with_context(|| folder.display().to_string())?;
        reader.each_take(&self.clips, |take| {
            let (clip, set, params) = (&take.clip, &reader.set, &reader.params);
            let path = folder.join(format!("{}.bvh", clip.name));
            if path
                .canonicalize()
                .is_ok_and(|path| sources.contains(&path))
            {
                bail!(
                    "{} would be overwritten; choose another folder",
                    path.display()
                );
            }
            let map = PivotMap::of_clip(set, clip, &take.roles)?;
            let rows = pose_rows_of_clip(clip, set, &map, take.rest(), params);
            let rows = pca.reconstruct(&pca.project(&rows));
            write_clip(&clip_of_pose_rows(clip, set, &map, &rows, params), &path)
        })
    }
}

impl Reduced<'_> {
    fn write(&self, out: &mut impl Write) -> std::io::Result<()> {
        let (clips, rows, values) = (self.clips, self.components.rows(), self.components.dim());
        let plural = if clips == 1 { "" } else { "s" };
        writeln!(
            out,
            "{clips} clip{plural}, {rows} poses of {} pivots, {values} values each",
            self.pivots
        )?;
        let (dims, percent) = (self.dims, 100.0 * self.quality);
        writeln!(
            out,
            "{dims} dimensions keep {percent:.2} % of the variance; root mean square error {:.4} per value",
            self.rms_error
        )?;
        writeln!(out)?;
        let mut table = TextTable::new(["dimensions", "keep", "the last adds"]);
        let mut before = 0.0;
        // Up to what was asked for and a little on: the rest is all but nothing.
        for row in self.table.iter().take((self.dims + 4).max(20)) {
            let (keep, adds) = (100.0 * row.quality, 100.0 * (row.quality - before));
            before = row.quality;
            table.row([
                row.dims.to_string(),
                format!("{keep:.2} %"),
                format!("{adds:.2} %"),
            ]);
        }
        write!(out, "{table}")
    }
}

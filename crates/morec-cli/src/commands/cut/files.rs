//! Cuts of clips in files.

use std::io::Write;
use std::process::ExitCode;

use anyhow::{Context, Result, bail};
use morec::clip::Clip;
use morec::discover::{DiscoverParams, discover};
use morec::features::{BoneSet, FeatureParams, RowLayout, Rows, rows_of_clip};
use morec::segment::{KernelParams, PpcaParams, Segmentation, kernel_cuts, segment};
use morec_db::Cutter;
use morec_measure::report::pictures::misfit_chart;
use serde::Serialize;

use super::args::Args;
use crate::json::write_json;
use crate::output;
use crate::poses::{PoseReader, PosedClip};
use crate::progress::StageBar;

#[derive(Serialize)]
struct CutClip {
    clip: String,
    rate_hz: f64,
    frames: usize,
    cuts: Vec<FoundCut>,
    forward: Vec<morec::segment::MisfitSample>,
    backward: Vec<morec::segment::MisfitSample>,
}

#[derive(Serialize)]
struct FoundCut {
    secs: f64,
    /// First frame of what begins here, counted from 0.
    frame: usize,
    /// Passes that found it (ppca).
    #[serde(flatten)]
    passes: Option<Passes>,
}

#[derive(Serialize, Clone, Copy)]
struct Passes {
    forward: bool,
    backward: bool,
}

/// Reads, cuts and prints every clip.
pub fn run(args: &Args) -> Result<ExitCode> {
    let reader = args.poses.reader()?;
    let found = match &args.settings.cutter(reader.set.clone())? {
        Cutter::Kernel(params) if args.plot.is_none() => by_kernel(&reader, params, args)?,
        Cutter::Repeats(params) if args.plot.is_none() => by_repeats(&reader, params, args)?,
        Cutter::Kernel(_) | Cutter::Repeats(_) => {
            bail!("--plot draws the misfit of --method ppca")
        }
        Cutter::Ppca(params, _) => by_ppca(&reader, params, args)?,
    };
    let mut out = crate::console::stdout();
    if args.json {
        write_json(&mut out, &found)?;
    } else {
        found.iter().try_for_each(|f| f.write(&mut out))?;
    }
    out.flush()?;
    Ok(ExitCode::SUCCESS)
}

fn by_kernel(reader: &PoseReader<'_>, params: &KernelParams, args: &Args) -> Result<Vec<CutClip>> {
    let features = FeatureParams::default();
    let mut found = Vec::new();
    reader.each_take(&args.inputs, |take| {
        let rows = rows_of_clip(
            &take.clip,
            &take.roles,
            take.rest(),
            take.bones(),
            &features,
        );
        let cuts = kernel_cuts(&rows, &features, params).context(take.clip.name.clone())?;
        found.push(CutClip::at(&take.clip, &cuts));
        Ok(())
    })?;
    Ok(found)
}

/// All clips together: what repeats in another clip is cut, too.
fn by_repeats(
    reader: &PoseReader<'_>,
    params: &DiscoverParams,
    args: &Args,
) -> Result<Vec<CutClip>> {
    let features = FeatureParams::default();
    let mut clips = Vec::new();
    reader.each_take(&args.inputs, |take| {
        let bones = take.bones();
        let rows = rows_of_clip(&take.clip, &take.roles, take.rest(), bones, &features);
        clips.push((CutClip::at(&take.clip, &[]), bones, rows));
        Ok(())
    })?;
    let bones = clips
        .iter()
        .map(|(_, bones, _)| *bones)
        .reduce(BoneSet::and);
    let bones = bones.unwrap_or(BoneSet::NONE);
    let common = clips
        .iter()
        .map(|(_, of, rows)| rows.columns(&RowLayout::kept_columns(*of, bones)));
    let rows: Vec<Rows> = common.collect();
    let sets = discover(&rows, features.tick_hz(), params, &StageBar::stoppable()?)?;
    let cut = |(number, (clip, ..)): (usize, (CutClip, BoneSet, Rows))| {
        let cuts = sets.cuts_of(number, clip.frames as f64 / clip.rate_hz);
        clip.cut_at(&cuts)
    };
    Ok(clips.into_iter().enumerate().map(cut).collect())
}

fn by_ppca(reader: &PoseReader<'_>, params: &PpcaParams, args: &Args) -> Result<Vec<CutClip>> {
    let mut found = Vec::new();
    reader.each(&args.inputs, |clip| {
        if args.plot.is_some() && !found.is_empty() {
            bail!("--plot draws one clip: give one clip, or leave --plot out");
        }
        let segmentation =
            segment(&clip.rows, reader.rate_hz(), params).context(clip.name.clone())?;
        if let Some(path) = &args.plot {
            let title = format!("{}: misfit and cuts", clip.name);
            let svg = misfit_chart(&segmentation, &title, &[]).svg();
            output::check_picture(path)?;
            output::write_whole(path, |out| out.write_all(svg.as_bytes()))
                .with_context(|| path.display().to_string())?;
        }
        found.push(CutClip::new(&clip, segmentation));
        Ok(())
    })?;
    Ok(found)
}

impl CutClip {
    /// A clip cut at these seconds.
    fn at(clip: &Clip, cuts: &[f64]) -> Self {
        let whole = Self {
            clip: clip.name.clone(),
            rate_hz: clip.rate_hz,
            frames: clip.frames,
            cuts: Vec::new(),
            forward: Vec::new(),
            backward: Vec::new(),
        };
        whole.cut_at(cuts)
    }

    fn cut_at(mut self, cuts: &[f64]) -> Self {
        let cut = |secs: &f64| FoundCut {
            secs: *secs,
            frame: (secs * self.rate_hz).round() as usize,
            passes: None,
        };
        self.cuts = cuts.iter().map(cut).collect();
        self
    }

    fn new(clip: &PosedClip, found: Segmentation) -> Self {
        let rate_hz = clip.length.rate_hz;
        let cut = |c: &morec::segment::Cut| FoundCut {
            secs: c.secs,
            frame: (c.secs * rate_hz).round() as usize,
            passes: Some(Passes {
                forward: c.forward,
                backward: c.backward,
            }),
        };
        Self {
            clip: clip.name.clone(),
            rate_hz,
            frames: clip.length.frames,
            cuts: found.cuts.iter().map(cut).collect(),
            forward: found.forward,
            backward: found.backward,
        }
    }

    fn write(&self, out: &mut impl Write) -> std::io::Result<()> {
        let secs = self.frames as f64 / self.rate_hz;
        let (name, count) = (&self.clip, self.cuts.len());
        let plural = if count == 1 { "" } else { "s" };
        writeln!(out, "{name}: {count} cut{plural} in {secs:.2} s")?;
        for cut in &self.cuts {
            let found = match cut.passes.map(|p| (p.forward, p.backward)) {
                None => "",
                Some((true, true)) => "  both ways",
                Some((true, false)) => "  forward",
                Some(_) => "  backward",
            };
            writeln!(out, "  {:8.2} s  frame {:6}{found}", cut.secs, cut.frame)?;
        }
        Ok(())
    }
}

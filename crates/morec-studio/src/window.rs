//! The program: its arguments, then a window or a picture.

use std::path::PathBuf;
use std::process::ExitCode;

use clap::Parser;

use crate::screenshot::{self, Shot};
use crate::state::Panel;

/// Name of the program for the window system and for what is remembered.
const APP: &str = "morec-studio";

/// See motions, cut, sort and label them, train, and watch them recognised live
///
/// A window over a motion database. Without a file it opens an example with synthetic people.
#[derive(Debug, Clone, Parser)]
#[command(
    name = "morec-studio",
    version,
    max_term_width = 100,
    after_help = "Exit codes: 0 the window was closed or the picture written; 1 no window can be opened or no picture drawn; 2 \
        wrong command line.\n\n\
    Examples:\n  morec-studio\n  morec-studio moves.mdb\n  morec-studio takes/ walk.bvh\n  \
    morec-studio moves.mdb --screenshot label.png --panel label --at 12"
)]
pub struct Args {
    /// A motion database (.mdb), or clips and folders of clips
    #[arg(value_name = "FILE.mdb|CLIPS")]
    paths: Vec<PathBuf>,
    /// Draw a panel into this file and end; needs no display
    #[arg(long, value_name = "FILE.png")]
    screenshot: Option<PathBuf>,
    /// The panel to show [default: the last session's panel, or library]
    ///
    /// library, label, classes, train or live.
    #[arg(long, value_name = "NAME", value_parser = panel)]
    panel: Option<Panel>,
    /// The clip that is shown in a screenshot
    #[arg(long, value_name = "CLIP", requires = "screenshot")]
    clip: Option<String>,
    /// The time that is shown in a screenshot, seconds
    #[arg(
        long,
        value_name = "SECS",
        default_value_t = 0.0,
        requires = "screenshot"
    )]
    at: f64,
    /// Search for the clip's first label of this class, compare the nearest hit
    #[arg(long, value_name = "CLASS", requires = "screenshot")]
    like: Option<String>,
    /// Show the tree of the method of 2009 instead of a cross-validation
    ///
    /// In a screenshot of the panel train.
    #[arg(long, requires = "screenshot")]
    tree: bool,
    /// Width and height of a screenshot, pixels
    #[arg(long, value_name = "WxH", default_value = "1280x720", value_parser = size, requires = "screenshot")]
    size: (usize, usize),
    /// Pixels per point in a screenshot, 0.5 to 4; 2 is a high-density screen
    #[arg(long, value_name = "FACTOR", default_value_t = 1.0, value_parser = scale, requires = "screenshot")]
    scale: f32,
    /// Begin with the light theme
    #[arg(long)]
    light: bool,
}

fn panel(name: &str) -> Result<Panel, String> {
    let known = || Panel::ALL.map(|p| p.name().to_lowercase()).join(", ");
    Panel::named(name).ok_or_else(|| format!("expected one of {}", known()))
}

fn size(text: &str) -> Result<(usize, usize), String> {
    let parse = || {
        let (width, height) = text.split_once('x')?;
        Some((width.parse().ok()?, height.parse().ok()?))
    };
    parse()
        .filter(|(w, h)| (320..=8000).contains(w) && (240..=8000).contains(h))
        .ok_or_else(|| "expected WIDTHxHEIGHT, as 1280x720".to_owned())
}

fn scale(text: &str) -> Result<f32, String> {
    let factor: Option<f32> = text.parse().ok();
    let fits = factor.filter(|f| (0.5..=4.0).contains(f));
    fits.ok_or_else(|| "expected a factor from 0.5 to 4".to_owned())
}

/// Opens the window, or draws the picture.
pub fn run(args: &Args) -> ExitCode {
    let done = match &args.screenshot {
        Some(path) => picture(args, path),
        None => window(args),
    };
    match done {
        Ok(()) => ExitCode::SUCCESS,
        Err(why) => {
            complain(&why);
            ExitCode::FAILURE
        }
    }
}

fn picture(args: &Args, path: &std::path::Path) -> Result<(), String> {
    let shot = Shot {
        panel: args.panel.unwrap_or(Panel::Library),
        clip: args.clip.clone(),
        at_secs: args.at,
        like: args.like.clone(),
        tree: args.tree,
        size: [args.size.0, args.size.1],
        scale: args.scale,
        dark: !args.light,
    };
    screenshot::write(&screenshot::draw(&args.paths, &shot)?, path)
}

#[cfg(not(feature = "window"))]
fn window(_: &Args) -> Result<(), String> {
    Err(
        "this program was built without a window (feature `window`); `--screenshot` draws a panel without a window"
            .to_owned(),
    )
}

#[cfg(feature = "window")]
fn window(args: &Args) -> Result<(), String> {
    use crate::app::{LAYOUT, Studio};
    use crate::state::layout::Layout;

    let options = eframe::NativeOptions {
        viewport: egui::ViewportBuilder::default()
            .with_title("morec studio")
            .with_app_id(APP)
            .with_inner_size([1400.0, 860.0])
            .with_min_inner_size([640.0, 400.0])
            .with_drag_and_drop(true),
        ..Default::default()
    };
    let (paths, light, panel) = (args.paths.clone(), args.light, args.panel);
    let make = move |cc: &eframe::CreationContext<'_>| {
        let layout: Option<Layout> = cc.storage.and_then(|s| eframe::get_value(s, LAYOUT));
        // Beside the layout, where neither a restart nor a tidy temporary folder takes it away.
        let unsaved = eframe::storage_dir(APP).map(|folder| folder.join("unsaved"));
        let unsaved = unsaved.unwrap_or_else(std::env::temp_dir);
        let mut studio = Studio::new(&cc.egui_ctx, &paths, unsaved);
        if let Some(layout) = &layout {
            studio.state.lay_out(layout);
            studio.state.show_again(layout);
        }
        // What is typed counts more than what is remembered.
        studio.state.dark &= !light;
        if let Some(panel) = panel {
            studio.state.panel = panel;
        }
        Ok(Box::new(studio) as Box<dyn eframe::App>)
    };
    eframe::run_native(APP, options, Box::new(make)).map_err(|error| {
        format!("no window can be opened: {error}; `--screenshot` draws a panel without a window")
    })
}

/// Prints an error to the terminal.
#[allow(clippy::print_stderr)] // A program's own words, not a library's.
fn complain(why: &str) {
    eprintln!("morec-studio: {why}");
}

//! Pictures of panels in files: `--screenshot FILE.png --panel NAME --at SECS`.

use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use egui::{ColorImage, Pos2, RawInput, Rect, Vec2};

use crate::app::Studio;
use crate::raster::{self, Textures};
use crate::state::{
    ClassCommand, Command, CompareCommand, LibraryCommand, LiveCommand, Panel, PlayCommand,
    SimilarCommand, TimelineCommand, TrainCommand,
};
use crate::stretch::Stretch;
use crate::theme::Colours;
use crate::unsaved::OwnFolder;

/// A picture of a panel.
#[derive(Debug, Clone)]
pub struct Shot {
    pub panel: Panel,
    /// The clip that is shown; the first, if none is named.
    pub clip: Option<String>,
    pub at_secs: f64,
    /// Class of a label that is searched for, with its nearest hit beside it.
    pub like: Option<String>,
    /// The panel Train shows the tree of the method of 2009 in place of a cross-validation.
    pub tree: bool,
    /// Width and height, pixels.
    pub size: [usize; 2],
    /// Pixels of a point: 2 is a screen of high density.
    pub scale: f32,
    pub dark: bool,
}

impl Default for Shot {
    /// The library as the window opens, 1280 × 720, dark.
    fn default() -> Self {
        Self {
            panel: Panel::Library,
            clip: None,
            at_secs: 0.0,
            like: None,
            tree: false,
            size: [1280, 720],
            scale: 1.0,
            dark: true,
        }
    }
}

/// No picture takes longer; what is not there by then is not in it.
const PATIENCE: Duration = Duration::from_secs(300);
/// Frames a second of the time that passes in pictures.
const RATE_HZ: f64 = 30.0;
/// Pixels of the drawing for one of the picture: edges are smooth.
const TIMES: usize = 2;

/// The program without a window: frames follow each other as fast as they can.
pub struct Headless {
    ctx: egui::Context,
    pub studio: Studio,
    textures: Textures,
    /// Pixels.
    size: Vec2,
    /// Pixels of a point.
    scale: f32,
    now: f64,
    /// What has no name lies here: pictures show nothing of other runs, and leave nothing to them.
    folder: Option<OwnFolder>,
}

impl Drop for Headless {
    fn drop(&mut self) {
        if let Some(folder) = self.folder.take() {
            folder.remove();
        }
    }
}

impl Headless {
    pub fn new(paths: &[PathBuf], size: [usize; 2], scale: f32, dark: bool) -> Self {
        let ctx = egui::Context::default();
        let folder = OwnFolder::new(&std::env::temp_dir()).ok();
        let own = folder.as_ref().map(|folder| folder.path().to_owned());
        let mut studio = Studio::new(&ctx, paths, own.unwrap_or_else(std::env::temp_dir));
        studio.state.dark = dark;
        Self {
            ctx,
            studio,
            textures: Textures::default(),
            size: Vec2::new(size[0] as f32, size[1] as f32),
            scale,
            now: 0.0,
            folder,
        }
    }

    /// With a database and a clip that are at hand.
    #[cfg(feature = "measure")]
    pub fn of(
        store: crate::store::Store,
        motion: std::sync::Arc<crate::body::ClipMotion>,
        size: [usize; 2],
    ) -> Self {
        let ctx = egui::Context::default();
        crate::theme::install(&ctx);
        let wake = std::sync::Arc::new(|| {});
        let mut state = crate::state::State::new(wake, std::env::temp_dir());
        state.store = Some(store);
        state.player.show(motion);
        let secs = state.player.secs();
        state.timeline.whole(secs);
        Self {
            ctx,
            studio: Studio::of(state),
            textures: Textures::default(),
            size: Vec2::new(size[0] as f32, size[1] as f32),
            scale: 1.0,
            now: 0.0,
            folder: None,
        }
    }

    /// One frame down to its triangles.
    #[cfg(feature = "measure")]
    pub fn tessellated(&mut self) -> usize {
        let output = self.frame(1.0 / RATE_HZ);
        self.ctx.tessellate(output.shapes, 1.0).len()
    }

    fn input(&mut self, dt: f64) -> RawInput {
        self.now += dt;
        let mut input = RawInput {
            screen_rect: Some(Rect::from_min_size(Pos2::ZERO, self.size / self.scale)),
            time: Some(self.now),
            predicted_dt: dt as f32,
            focused: true,
            ..RawInput::default()
        };
        if let Some(viewport) = input.viewports.get_mut(&input.viewport_id) {
            viewport.native_pixels_per_point = Some(TIMES as f32 * self.scale);
        }
        input
    }

    /// One frame after `dt` seconds; gives what to draw.
    pub fn frame(&mut self, dt: f64) -> egui::FullOutput {
        let input = self.input(dt);
        let studio = &mut self.studio;
        let output = self.ctx.run(input, |ctx| studio.frame(ctx));
        self.textures.apply(&output.textures_delta);
        output
    }

    /// Frames until no thread is at work.
    pub fn settle(&mut self) {
        let begun = Instant::now();
        let mut quiet = 0;
        while quiet < 3 && begun.elapsed() < PATIENCE {
            self.frame(0.0);
            quiet = if self.studio.state.is_busy() {
                0
            } else {
                quiet + 1
            };
            std::thread::sleep(Duration::from_millis(4));
        }
    }

    /// Lets time pass.
    pub fn play(&mut self, secs: f64) {
        for _ in 0..(secs * RATE_HZ).round() as usize {
            self.frame(1.0 / RATE_HZ);
        }
    }

    pub fn command(&mut self, command: Command) {
        self.studio.state.apply(command);
    }

    /// Stops playing, at a moment.
    fn stop_at(&mut self, secs: f64) {
        self.command(Command::Play(PlayCommand::Pause));
        self.command(Command::Play(PlayCommand::Seek(secs)));
    }

    /// The window as it is now.
    pub fn picture(&mut self) -> ColorImage {
        let output = self.frame(0.0);
        let primitives = self.ctx.tessellate(output.shapes, output.pixels_per_point);
        let size = [self.size.x as usize * TIMES, self.size.y as usize * TIMES];
        let dark = self.ctx.style().visuals.dark_mode;
        let image = raster::draw(
            &primitives,
            &self.textures,
            size,
            output.pixels_per_point,
            Colours::of(dark).panel,
        );
        raster::smaller(&image, TIMES)
    }
}

/// Draws a panel with the database or clips at `paths`.
pub fn draw(paths: &[PathBuf], shot: &Shot) -> Result<ColorImage, String> {
    let mut window = Headless::new(paths, shot.size, shot.scale, shot.dark);
    window.settle();
    let state = &window.studio.state;
    let Some(store) = &state.store else {
        let why = state.notices.first().map(|n| n.text.clone());
        return Err(why.unwrap_or_else(|| "nothing was opened in time".to_owned()));
    };
    let is_kept = !store.temporary;
    if let Some(name) = &shot.clip {
        let clip = store.snapshot.clips.iter().find(|c| c.name == *name);
        let id = clip.ok_or_else(|| format!("no clip is called {name}"))?.id;
        window.command(Command::Library(LibraryCommand::Open(id)));
    }
    prepare(&mut window, shot, is_kept);
    if let Some(class) = &shot.like {
        search(&mut window, shot.panel, class)?;
    }
    Ok(window.picture())
}

/// Brings the panel into a state that is worth a picture. A database that is kept stays as it is: nothing is proposed in it.
fn prepare(window: &mut Headless, shot: &Shot, is_kept: bool) {
    window.command(Command::Show(shot.panel));
    window.settle();
    let has_labels = window
        .studio
        .state
        .store
        .as_ref()
        .is_some_and(|s| s.snapshot.accepted().next().is_some());
    match shot.panel {
        Panel::Library => window.command(Command::Library(LibraryCommand::Strips(true))),
        Panel::Label if has_labels => {
            window.command(Command::Train(TrainCommand::Train));
        }
        Panel::Train if has_labels => {
            window.command(Command::Train(TrainCommand::Train));
            window.settle();
            if shot.tree {
                tree(window)
            } else {
                mistake(window)
            };
        }
        Panel::Classes if has_labels && !is_kept => {
            window.command(Command::Classes(ClassCommand::Propose));
        }
        Panel::Live => {
            if has_labels {
                window.command(Command::Train(TrainCommand::Train));
                window.settle();
            }
            window.command(Command::Live(LiveCommand::Start));
            window.settle();
            window.play(shot.at_secs);
        }
        _ => {}
    }
    window.settle();
    // A moment of the report is shown in place of the one that was asked for.
    match window.studio.state.player.looped {
        Some((start, stop)) => window.stop_at(0.5 * (start + stop)),
        None => window.stop_at(shot.at_secs),
    }
    // Strips and mistakes load clips of their own.
    window.settle();
    window.frame(1.0);
    window.settle();
}

/// Cross-validates, and compares the first mistake, if there is one.
fn mistake(window: &mut Headless) {
    window.command(Command::Train(TrainCommand::Judge));
    window.settle();
    let judged = window.studio.state.train.judged.as_ref();
    if let Some(first) = judged.and_then(|judged| judged.mistakes().first().copied()) {
        window.command(Command::Train(TrainCommand::Moment(first)));
        window.settle();
        window.command(Command::Compare(CompareCommand::Moment(None)));
    }
}

/// Trains the method of 2009, and plays a sample of the branch at the top of its tree.
fn tree(window: &mut Headless) {
    window.command(Command::Train(TrainCommand::Thesis));
    window.settle();
    let train = &window.studio.state.train;
    let branch = train.thesis.as_ref().and_then(|t| t.branch(train.branch));
    if let Some((sample, ..)) = branch.and_then(|branch| branch.points.first()) {
        let sample = *sample;
        window.command(Command::Train(TrainCommand::Sample(sample)));
    }
}

/// Searches for what is like the first label of a class, and puts the nearest beside it, in the middle of both; in the panel Label the
/// nearest of its class.
fn search(window: &mut Headless, panel: Panel, class: &str) -> Result<(), String> {
    let state = &window.studio.state;
    let labels = state.shown_samples().iter();
    let Some(label) = labels.clone().find(|s| s.class == class).cloned() else {
        return Err(format!("the clip has no label of {class}"));
    };
    window.command(Command::Timeline(TimelineCommand::Select {
        id: Some(label.id),
        add: false,
    }));
    if panel == Panel::Label {
        let of = Stretch::from(&*label);
        let class = class.to_owned();
        window.command(Command::Compare(CompareCommand::NearestOf { of, class }));
    } else {
        window.command(Command::Similar(SimilarCommand::OfSelection));
        window.settle();
        window.command(Command::Compare(CompareCommand::Nearest));
    }
    window.settle();
    window.stop_at(0.5 * (label.start_secs + label.stop_secs));
    window.settle();
    window.frame(1.0);
    window.settle();
    Ok(())
}

/// Writes a picture as PNG.
pub fn write(image: &ColorImage, path: &Path) -> Result<(), String> {
    let said = |error: &dyn std::fmt::Display| format!("{}: {error}", path.display());
    let file = std::fs::File::create(path).map_err(|e| said(&e))?;
    let [width, height] = image.size;
    let mut encoder = png::Encoder::new(std::io::BufWriter::new(file), width as u32, height as u32);
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.set_compression(png::Compression::High);
    let bytes: Vec<u8> = image
        .pixels
        .iter()
        .flat_map(|p| [p.r(), p.g(), p.b()])
        .collect();
    let mut writer = encoder.write_header().map_err(|e| said(&e))?;
    writer.write_image_data(&bytes).map_err(|e| said(&e))?;
    writer.finish().map_err(|e| said(&e))
}

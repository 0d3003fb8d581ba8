//! A frame of the window: time passes, keys are read, panels are drawn, and their commands are carried out.

use std::path::PathBuf;
use std::sync::Arc;
use std::time::Duration;

use crate::fonts::Fonts;
use crate::panels;
use crate::state::{Command, FileCommand, State};
use crate::store::Wake;
use crate::{dialogs, keys, theme};

/// The state, the panels that draw it and the threads that work for it.
pub struct Studio {
    pub state: State,
    pub dialogs: dialogs::Dialogs,
    pub fonts: Fonts,
    themed: Option<bool>,
}

impl Studio {
    /// With what was named on the command line: a database, clips, or nothing. Databases without a name lie in `unsaved`.
    pub fn new(ctx: &egui::Context, paths: &[PathBuf], unsaved: PathBuf) -> Self {
        theme::install(ctx);
        let waker = ctx.clone();
        let wake: Wake = Arc::new(move || waker.request_repaint());
        let mut state = State::new(wake, unsaved);
        state.begin(paths);
        Self::of(state)
    }

    /// With a state that is at hand.
    pub fn of(state: State) -> Self {
        Self {
            state,
            dialogs: dialogs::Dialogs::of(Arc::new(dialogs::SystemDialogs)),
            fonts: Fonts::default(),
            themed: None,
        }
    }

    /// Asks before a window is closed whose database is not saved.
    fn close(&mut self, ctx: &egui::Context) {
        let requested = ctx.input(|i| i.viewport().close_requested());
        if requested && !self.state.closing {
            self.state.apply(Command::File(FileCommand::Close));
            if !self.state.closing {
                ctx.send_viewport_cmd(egui::ViewportCommand::CancelClose);
            }
        } else if self.state.closing && !requested {
            ctx.send_viewport_cmd(egui::ViewportCommand::Close);
        }
    }

    /// Draws one frame.
    pub fn frame(&mut self, ctx: &egui::Context) {
        self.close(ctx);
        if self.themed != Some(self.state.dark) {
            self.themed = Some(self.state.dark);
            ctx.set_theme(if self.state.dark {
                egui::Theme::Dark
            } else {
                egui::Theme::Light
            });
        }
        let dt = ctx.input(|i| f64::from(i.unstable_dt));
        self.state.tick_keys(dt);
        self.state.tick(dt);
        self.fonts.follow(ctx, &mut self.state);
        let mut commands: Vec<Command> = Vec::new();
        panels::focus::follow(ctx);
        let in_menu = panels::focus::keep_in_menus(ctx);
        keys::read(ctx, &self.state, self.dialogs.is_open(), &mut commands);
        dialogs::dropped(ctx, &mut commands);
        panels::show(ctx, &self.state, &mut commands);
        if !in_menu {
            panels::focus::come_back_from_menus(ctx);
        }
        for command in commands {
            self.state.apply(command);
        }
        let wanted = panels::wanted_clips(ctx);
        for clip in wanted {
            self.state.want_motion(clip);
        }
        if let Some(ask) = self.state.ask.take() {
            self.dialogs.ask(ask, ctx);
        }
        for command in self.dialogs.answers() {
            self.state.apply(command);
        }
        // Nothing else changes by itself: threads wake the window when they have something.
        if let Some(secs) = self.state.next_change_secs() {
            ctx.request_repaint_after(Duration::from_secs_f64(secs));
        }
    }
}

/// Under which name the layout is remembered.
#[cfg(feature = "window")]
pub const LAYOUT: &str = "layout";

#[cfg(feature = "window")]
impl eframe::App for Studio {
    fn save(&mut self, storage: &mut dyn eframe::Storage) {
        eframe::set_value(storage, LAYOUT, &self.state.layout());
    }

    /// The colour of panels, which need not be painted again: where the processor draws, that takes longest.
    fn clear_color(&self, visuals: &egui::Visuals) -> [f32; 4] {
        let panel = theme::Colours::of(visuals.dark_mode).panel;
        panel.to_normalized_gamma_f32()
    }

    fn update(&mut self, ctx: &egui::Context, _frame: &mut eframe::Frame) {
        self.frame(ctx);
    }
}

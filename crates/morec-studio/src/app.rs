//! A frame of the window: time passes, keys are read, panels are drawn, and their commands are carried out.

use std::path::PathBuf;
use std::sync::Arc;
use std::time::Duration;

use crate::panels;
use crate::state::{Command, State};
use crate::store::Wake;
use crate::{dialogs, keys, theme};

/// The program.
pub struct Studio {
    pub state: State,
    pub dialogs: dialogs::Dialogs,
    themed: Option<bool>,
}

impl Studio {
    /// With what was named on the command line: a database, clips, or nothing.
    pub fn new(ctx: &egui::Context, paths: &[PathBuf]) -> Self {
        theme::install(ctx);
        let waker = ctx.clone();
        let wake: Wake = Arc::new(move || waker.request_repaint());
        let mut state = State::new(wake);
        state.begin(paths);
        Self::of(state)
    }

    /// With a state that is at hand.
    pub fn of(state: State) -> Self {
        Self {
            state,
            dialogs: dialogs::Dialogs::of(Arc::new(dialogs::SystemDialogs)),
            themed: None,
        }
    }

    /// Draws one frame.
    pub fn frame(&mut self, ctx: &egui::Context) {
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
        let mut commands: Vec<Command> = Vec::new();
        keys::read(ctx, &self.state, &mut commands);
        dialogs::dropped(ctx, &mut commands);
        panels::show(ctx, &self.state, &mut commands);
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
pub const LAYOUT: &str = "layout";

impl eframe::App for Studio {
    fn save(&mut self, storage: &mut dyn eframe::Storage) {
        eframe::set_value(storage, LAYOUT, &self.state.layout());
    }

    fn update(&mut self, ctx: &egui::Context, _frame: &mut eframe::Frame) {
        self.frame(ctx);
    }
}

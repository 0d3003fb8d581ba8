//! A person before the window: the hands and eyes of the tests.

use std::collections::VecDeque;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex};
use std::time::{Duration, Instant};

use egui::{Event, Key, Modifiers, PointerButton, Pos2, Rect};
use egui_kittest::Harness;
use egui_kittest::kittest::{NodeT, Queryable};
use morec::train::Everyday;

use crate::app::Studio;
use crate::dialogs::{Chooser, Dialogs};
use crate::state::Dialog;
use crate::state::{Command, Panel, State};

/// Seconds that pass with every frame.
pub const DT: f32 = 1.0 / 60.0;
/// No thread works longer than this, even on a busy machine.
const PATIENCE: Duration = Duration::from_secs(240);
/// Between two looks at threads that have just begun.
const SHORT: Duration = Duration::from_millis(2);

/// Dialogs that are answered by what a test has queued, and noted.
#[derive(Default)]
pub struct Answers {
    queued: Mutex<VecDeque<Vec<PathBuf>>>,
    asked: Mutex<Vec<Dialog>>,
    /// No dialog can be opened.
    closed: AtomicBool,
}

impl Chooser for Answers {
    fn choose(&self, dialog: &Dialog) -> Option<Vec<PathBuf>> {
        self.asked.lock().unwrap().push(dialog.clone());
        if self.closed.load(Ordering::Relaxed) {
            return None;
        }
        // Without an answer the dialog is cancelled.
        Some(self.queued.lock().unwrap().pop_front().unwrap_or_default())
    }
}

/// A person before the window, who looks, clicks and types; clicks and keys are counted.
pub struct Person {
    pub window: Harness<'static, Studio>,
    pub actions: usize,
    answers: Arc<Answers>,
    /// The command line that was shown last.
    checked: String,
    /// Where databases without a name lie; removed after the window.
    pub unsaved: Arc<tempfile::TempDir>,
    /// Whether training uses the built-in everyday motion. By default it does not, because that would take most of the tests' time.
    pub everyday: Everyday,
}

impl Person {
    pub fn before(paths: &[PathBuf]) -> Self {
        Self::again(paths, Arc::new(tempfile::tempdir().unwrap()))
    }

    /// Before a window that finds what earlier ones left in a folder.
    pub fn again(paths: &[PathBuf], unsaved: Arc<tempfile::TempDir>) -> Self {
        Self::seated(paths, unsaved, [1400.0, 860.0], DT)
    }

    /// Before a window of this size in points, in which so many seconds pass with every frame.
    pub fn seated(
        paths: &[PathBuf],
        unsaved: Arc<tempfile::TempDir>,
        size: [f32; 2],
        dt: f32,
    ) -> Self {
        let (ctx, paths) = (egui::Context::default(), paths.to_vec());
        let mut studio = Studio::new(&ctx, &paths, unsaved.path().to_owned());
        let answers = Arc::new(Answers::default());
        studio.dialogs = Dialogs::of(answers.clone());
        let mut installed = false;
        let window = Harness::builder()
            .with_size(size)
            .with_step_dt(dt)
            .build_state(
                move |ctx, studio: &mut Studio| {
                    if !std::mem::replace(&mut installed, true) {
                        crate::theme::install(ctx);
                    }
                    studio.frame(ctx);
                },
                studio,
            );
        let mut person = Self {
            window,
            actions: 0,
            answers,
            checked: String::new(),
            unsaved,
            everyday: Everyday::Never,
        };
        person.settle();
        person
    }

    pub fn state(&self) -> &State {
        &self.window.state().state
    }

    /// Carries out a command without a click: for what a test begins with.
    pub fn command(&mut self, command: Command) {
        self.window.state_mut().state.apply(command);
        self.settle();
    }

    /// The next dialog is answered with these paths.
    pub fn will_choose(&self, paths: &[&Path]) {
        let paths = paths.iter().map(|path| path.to_path_buf()).collect();
        self.answers.queued.lock().unwrap().push_back(paths);
    }

    /// From now on no dialog can be opened.
    pub fn has_no_dialogs(&self) {
        self.answers.closed.store(true, Ordering::Relaxed);
    }

    /// Asks the window to close, as the system does; says whether it goes.
    pub fn closes(&mut self) -> bool {
        self.actions += 1;
        let input = self.window.input_mut();
        let root = input.viewports.entry(egui::ViewportId::ROOT).or_default();
        root.events.push(egui::ViewportEvent::Close);
        self.window.step();
        let kept = self.told(&egui::ViewportCommand::CancelClose);
        self.window.step();
        !kept
    }

    /// True if the last frame said this to the window system.
    pub fn told(&self, command: &egui::ViewportCommand) -> bool {
        let output = &self.window.output().viewport_output;
        output
            .get(&egui::ViewportId::ROOT)
            .is_some_and(|root| root.commands.contains(command))
    }

    /// The dialog that was shown last.
    pub fn asked(&self) -> Dialog {
        self.answers.asked.lock().unwrap().last().unwrap().clone()
    }

    pub fn frames(&mut self, count: usize) {
        for _ in 0..count {
            self.step();
        }
    }

    fn step(&mut self) {
        let settings = &mut self.window.state_mut().state.train.settings;
        settings.everyday = self.everyday;
        self.window.step();
        // Users do not have this option of the tests: lines are checked without it.
        let line = &mut self.window.state_mut().state.command_line;
        *line = line.replace(" --everyday never", "");
        if *line != self.checked {
            super::lines::check(line);
            self.checked.clone_from(line);
        }
    }

    /// Lets time pass.
    pub fn wait(&mut self, secs: f64) {
        self.frames((secs / f64::from(DT)).round() as usize);
    }

    /// Until no thread is at work. Time passes meanwhile in the window too.
    pub fn settle(&mut self) {
        let begun = Instant::now();
        let mut quiet = 0;
        while quiet < 3 {
            assert!(begun.elapsed() < PATIENCE, "threads are at work for ever");
            let drawn = Instant::now();
            self.step();
            let busy = self.state().is_busy() || self.window.state().dialogs.is_open();
            quiet = if busy { 0 } else { quiet + 1 };
            // Drawing all the time would take half of the processors from the threads that are waited for.
            let pause = if busy { 4 * drawn.elapsed() } else { SHORT };
            std::thread::sleep(pause.min(begun.elapsed() / 8).max(SHORT));
        }
    }

    /// Until the database has answered, clips are read, and what the status bar shows is done.
    pub fn calm(&mut self) {
        let begun = Instant::now();
        loop {
            assert!(begun.elapsed() < PATIENCE, "threads are at work for ever");
            self.step();
            if !self.state().is_writing() && !self.window.state().dialogs.is_open() {
                return;
            }
            std::thread::sleep(Duration::from_millis(1));
        }
    }

    /// Types into whatever has the keyboard.
    pub fn inserts(&mut self, text: &str) {
        self.actions += 1;
        self.window.event(Event::Text(text.to_owned()));
        self.frames(1);
    }

    /// Name of the widget that has the keyboard.
    pub fn focused(&self) -> Option<String> {
        let nodes = self.window.root().children_recursive();
        let mut nodes = nodes.map(|node| node.accesskit_node());
        let node = nodes.find(|node| node.is_focused())?;
        node.label().or_else(|| node.value())
    }

    pub fn sees(&self, name: &str) -> bool {
        self.window.query_all_by_label(name).next().is_some()
    }

    pub fn sees_part(&self, name: &str) -> bool {
        self.window
            .query_all_by_label_contains(name)
            .next()
            .is_some()
    }

    /// The name of the first widget whose name contains a text.
    pub fn named_part(&self, part: &str) -> String {
        let mut found = self.window.query_all_by_label_contains(part);
        let found = found.next().and_then(|node| node.accesskit_node().label());
        found.unwrap_or_else(|| panic!("nothing is called …{part:?}…"))
    }

    /// True if the fonts have a shape for every letter.
    pub fn can_draw(&self, text: &str) -> bool {
        let font = egui::FontId::proportional(13.0);
        let letters = text.replace('\n', "");
        self.window
            .ctx
            .fonts_mut(|fonts| fonts.has_glyphs(&font, &letters))
    }

    /// True if the next frame is drawn though nothing has happened.
    pub fn is_redrawn(&self) -> bool {
        self.window.ctx.has_requested_repaint()
    }

    /// Place of the widget of this name; of a text only if no other widget has the name.
    pub fn place(&self, name: &str) -> Rect {
        let found = self.window.query_all_by_label(name);
        let is_text = |node: &egui_kittest::Node<'_>| {
            node.accesskit_node().role() == egui::accesskit::Role::Label
        };
        let node = found.min_by_key(is_text);
        node.unwrap_or_else(|| panic!("nothing is called {name:?}"))
            .rect()
    }

    /// True if a widget of this name can be clicked.
    pub fn offers(&self, name: &str) -> bool {
        self.window
            .query_all_by_label(name)
            .any(|node| node.accesskit_node().role() != egui::accesskit::Role::Label)
    }

    pub fn click(&mut self, name: &str) {
        self.click_at(self.place(name).center());
    }

    fn pointer(&mut self, at: Pos2, down: bool) {
        self.button(PointerButton::Primary, Modifiers::NONE, at, down);
    }

    fn button(&mut self, button: PointerButton, modifiers: Modifiers, pos: Pos2, pressed: bool) {
        self.window.input_mut().modifiers = modifiers;
        self.window.event(Event::PointerMoved(pos));
        self.window.event(Event::PointerButton {
            pos,
            button,
            pressed,
            modifiers,
        });
        self.frames(1);
        self.window.input_mut().modifiers = Modifiers::NONE;
    }

    /// Clicks with the right button, which opens menus.
    pub fn right_click(&mut self, name: &str) {
        self.click_with(PointerButton::Secondary, Modifiers::NONE, name);
    }

    /// Clicks while Ctrl is held.
    pub fn ctrl_click(&mut self, name: &str) {
        self.click_with(PointerButton::Primary, Modifiers::COMMAND, name);
    }

    /// Clicks while Shift is held.
    pub fn shift_click(&mut self, name: &str) {
        self.click_with(PointerButton::Primary, Modifiers::SHIFT, name);
    }

    fn click_with(&mut self, button: PointerButton, modifiers: Modifiers, name: &str) {
        self.actions += 1;
        let at = self.place(name).center();
        self.button(button, modifiers, at, true);
        self.button(button, modifiers, at, false);
        self.frames(2);
    }

    /// Types a text into a field, in place of what is there, and presses Enter.
    pub fn types(&mut self, field: &str, text: &str) {
        self.click(field);
        self.key_with(Key::A, Modifiers::COMMAND);
        self.window.event(Event::Text(text.to_owned()));
        self.frames(2);
        self.key(Key::Enter);
        self.frames(2);
        self.settle();
    }

    /// Clicks at a place.
    pub fn click_at(&mut self, at: Pos2) {
        self.actions += 1;
        self.pointer(at, true);
        self.pointer(at, false);
        self.frames(2);
    }

    /// Clicks twice at a place.
    pub fn double_click_at(&mut self, at: Pos2) {
        self.actions += 1;
        for _ in 0..2 {
            self.pointer(at, true);
            self.pointer(at, false);
        }
        self.frames(2);
    }

    /// Clicks at a place with the right button.
    pub fn right_click_at(&mut self, at: Pos2) {
        self.actions += 1;
        self.button(PointerButton::Secondary, Modifiers::NONE, at, true);
        self.button(PointerButton::Secondary, Modifiers::NONE, at, false);
        self.frames(1);
    }

    /// Presses, moves in steps, lets go.
    pub fn drag(&mut self, from: Pos2, to: Pos2) {
        self.actions += 1;
        self.window.event(Event::PointerMoved(from));
        self.frames(1);
        self.pointer(from, true);
        for step in 1..=8 {
            let at = from + (to - from) * (step as f32 / 8.0);
            self.window.event(Event::PointerMoved(at));
            self.frames(1);
        }
        self.pointer(to, false);
        self.frames(2);
    }

    /// Drags to a place, waits there, and lets go at another, which is looked for after the wait.
    pub fn drag_over(&mut self, from: Pos2, by: Pos2, secs: f64, to: impl Fn(&Self) -> Pos2) {
        self.actions += 1;
        self.pointer(from, true);
        for at in [from + (by - from) * 0.5, by] {
            self.window.event(Event::PointerMoved(at));
            self.frames(1);
        }
        self.wait(secs);
        let to = to(self);
        self.window.event(Event::PointerMoved(to));
        self.frames(1);
        self.pointer(to, false);
        self.frames(2);
    }

    fn key_event(&mut self, key: Key, pressed: bool, modifiers: Modifiers) {
        self.window.event(Event::Key {
            key,
            physical_key: None,
            pressed,
            repeat: false,
            modifiers,
        });
        self.frames(1);
    }

    pub fn key(&mut self, key: Key) {
        self.key_with(key, Modifiers::NONE);
    }

    pub fn key_with(&mut self, key: Key, modifiers: Modifiers) {
        self.actions += 1;
        self.key_event(key, true, modifiers);
        self.key_event(key, false, modifiers);
    }

    /// Holds a key down while this many seconds pass.
    pub fn hold(&mut self, key: Key, secs: f64) {
        self.actions += 1;
        self.key_event(key, true, Modifiers::NONE);
        self.wait(secs);
        self.key_event(key, false, Modifiers::NONE);
    }

    pub fn undo(&mut self) {
        self.key_with(Key::Z, Modifiers::COMMAND);
        self.settle();
    }

    pub fn redo(&mut self) {
        self.key_with(Key::Z, Modifiers::COMMAND | Modifiers::SHIFT);
        self.settle();
    }

    pub fn goes_to(&mut self, panel: Panel) {
        self.click(panel.name());
        self.settle();
    }

    /// Cuts all clips and groups the pieces.
    pub fn groups_cuts(&mut self) {
        self.click("Cut all clips");
        self.click("By kernel change points");
        self.settle();
        self.goes_to(Panel::Classes);
        self.click("Group cuts");
        self.settle();
    }

    /// Clip, class, start and stop in hundredths of a second of every accepted label: what edits change.
    pub fn labels(&self) -> Vec<(i64, String, i64, i64)> {
        let store = self.state().store.as_ref().unwrap();
        let hundredths = |secs: f64| (secs * 100.0).round() as i64;
        let label = |s: &morec_db::labels::DbSample| {
            (
                s.clip.0,
                s.class.clone(),
                hundredths(s.start_secs),
                hundredths(s.stop_secs),
            )
        };
        let mut labels: Vec<_> = store.snapshot.accepted().map(label).collect();
        labels.sort();
        labels
    }
}

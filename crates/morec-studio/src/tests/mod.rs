//! The window without a window: through the accessibility tree, as somebody with a screen reader meets it.

mod compare;
mod counted;
mod cuts;
mod edits;
mod faults;
mod live;
mod out;
mod pictures;
mod roles;
mod train;

use std::path::{Path, PathBuf};
use std::sync::OnceLock;
use std::time::{Duration, Instant};

use egui::{Event, Key, Modifiers, PointerButton, Pos2, Rect};
use egui_kittest::Harness;
use egui_kittest::kittest::{NodeT, Queryable};
use morec::formats::bvh;
use morec::synth::{DatabaseSpec, SyntheticTake, database};
use morec_db::labels::{NewSample, SampleState as Judged};
use morec_db::{ClipUpdate, MotionDb};

use crate::app::Studio;
use crate::state::{Command, Panel, State};

/// Seconds that pass with every frame.
pub const DT: f32 = 1.0 / 60.0;
/// Nothing that a thread does takes longer; a machine that is busy with other things has its time.
const PATIENCE: Duration = Duration::from_secs(240);

/// Three people, two gestures each twice.
pub fn takes() -> &'static [SyntheticTake] {
    static TAKES: OnceLock<Vec<SyntheticTake>> = OnceLock::new();
    TAKES.get_or_init(|| {
        let spec = DatabaseSpec {
            people: 3,
            repetitions: 2,
            classes: vec!["wave", "clap", "bow"],
            unknown_share: 0.3,
            ..DatabaseSpec::default()
        };
        database(7, &spec)
    })
}

/// A database of the takes; those of the first `labelled` people are labelled.
pub fn made(folder: &Path, labelled: usize) -> PathBuf {
    let mut files = Vec::new();
    for take in takes() {
        let path = folder.join(format!("{}.bvh", take.clip.name));
        let mut bytes = Vec::new();
        bvh::write(&take.clip, &mut bytes).unwrap();
        std::fs::write(&path, bytes).unwrap();
        files.push(path);
    }
    let path = folder.join("moves.mdb");
    let mut db = MotionDb::create(&path).unwrap();
    let about = ClipUpdate::default();
    db.import(&files, &morec::files::FileReader::default(), &about, &())
        .unwrap();
    for (number, take) in takes().iter().enumerate() {
        let clip = db.find_clip(&take.clip.name).unwrap().id;
        let about = ClipUpdate {
            subject: Some(take.person.clone()),
            ..ClipUpdate::default()
        };
        db.update_clips(&[clip], &about).unwrap();
        if number < labelled {
            let labels = take.labels.iter().map(|l| NewSample {
                clip,
                class: l.class.to_owned(),
                start_secs: l.start_secs,
                stop_secs: l.stop_secs,
                whole_clip: false,
                state: Judged::Accepted,
                score: None,
            });
            db.add_samples(&labels.collect::<Vec<_>>(), "test").unwrap();
        }
    }
    path
}

/// The window before a person who looks, clicks and types; both are counted.
pub struct Person {
    pub window: Harness<'static, Studio>,
    pub actions: usize,
}

impl Person {
    pub fn before(paths: &[PathBuf]) -> Self {
        let (ctx, paths) = (egui::Context::default(), paths.to_vec());
        let studio = Studio::new(&ctx, &paths);
        let window = Harness::builder()
            .with_size([1400.0, 860.0])
            .with_step_dt(DT)
            .build_state(
                |ctx, studio: &mut Studio| {
                    crate::theme::install(ctx);
                    studio.frame(ctx);
                },
                studio,
            );
        let mut person = Self { window, actions: 0 };
        person.settle();
        person
    }

    pub fn state(&self) -> &State {
        &self.window.state().state
    }

    /// What no person does: brings the window into a state that a test begins with.
    pub fn command(&mut self, command: Command) {
        self.window.state_mut().state.apply(command);
        self.settle();
    }

    pub fn frames(&mut self, count: usize) {
        self.window.run_steps(count);
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
            self.window.step();
            quiet = if self.state().is_busy() { 0 } else { quiet + 1 };
            std::thread::sleep(Duration::from_millis(2));
        }
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

    /// Where a thing of this name is that can be clicked; a text only if nothing else is called so.
    pub fn place(&self, name: &str) -> Rect {
        let found = self.window.query_all_by_label(name);
        let is_text = |node: &egui_kittest::Node<'_>| {
            node.accesskit_node().role() == egui::accesskit::Role::Label
        };
        let node = found.min_by_key(is_text);
        node.unwrap_or_else(|| panic!("nothing is called {name:?}"))
            .rect()
    }

    /// Whether there is a thing of this name that can be clicked.
    pub fn offers(&self, name: &str) -> bool {
        self.window
            .query_all_by_label(name)
            .any(|node| node.accesskit_node().role() != egui::accesskit::Role::Label)
    }

    pub fn click(&mut self, name: &str) {
        self.actions += 1;
        let at = self.place(name).center();
        self.pointer(at, true);
        self.pointer(at, false);
        self.frames(2);
    }

    fn pointer(&mut self, at: Pos2, down: bool) {
        let input = &self.window;
        input.event(Event::PointerMoved(at));
        input.event(Event::PointerButton {
            pos: at,
            button: PointerButton::Primary,
            pressed: down,
            modifiers: Modifiers::NONE,
        });
        self.frames(1);
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

    /// Holds a key down while so many seconds pass.
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

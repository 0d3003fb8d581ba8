//! Random keys, clicks, texts and drags in every state, against a model of what was seen: whatever is written is of what somebody
//! saw and chose, and Undo takes it back.

use std::collections::{BTreeMap, BTreeSet};

use std::sync::Arc;

use egui::{Key, Modifiers, Pos2, Rect, accesskit};
use egui_kittest::kittest::{NodeT, Queryable};
use morec::rng::Rng;

use super::{Person, made};
use crate::state::{Command, LibraryCommand, Panel};
use crate::store::Edit;

/// Actions of each run, unless `MOREC_ACTIONS` says how many, as `.ci/nightly` does.
const ACTIONS: usize = 300;
/// Points of the window; seconds of a frame, so that clicks that follow each other are no double clicks.
const SIZE: [f32; 2] = [1000.0, 640.0];
const DT: f32 = 0.35;
/// After so many actions another panel is begun with.
const BEGINNING: usize = 20;
/// Keys as they lie on a keyboard, those of shortcuts and of texts.
const KEYS: [Key; 31] = [
    Key::B,
    Key::Num1,
    Key::Num2,
    Key::Num7,
    Key::S,
    Key::M,
    Key::X,
    Key::A,
    Key::R,
    Key::N,
    Key::Q,
    Key::W,
    Key::I,
    Key::O,
    Key::J,
    Key::K,
    Key::L,
    Key::Delete,
    Key::Backspace,
    Key::OpenBracket,
    Key::CloseBracket,
    Key::Home,
    Key::End,
    Key::ArrowLeft,
    Key::Tab,
    Key::Enter,
    Key::Escape,
    Key::Space,
    Key::Num0,
    Key::ArrowUp,
    Key::ArrowDown,
];
/// What is clicked, where it is there. Buttons that say what they change are not in it.
const CLICKED: [&str; 22] = [
    "ada_1",
    "ben_1",
    "cleo_1",
    "Search clips",
    "Clip name",
    "Person",
    "Tags",
    "Tags of all",
    "New class of whole clips",
    "Whole clips are …",
    "Library",
    "Label",
    "Classes",
    "Train",
    "Live",
    "New class",
    "Show ada_1",
    "Show ben_1",
    "Track Labels",
    "Track of cuts",
    "Pattern of names",
    "Sort by clip",
];

/// What is typed.
const TEXTS: [&str; 7] = ["b", "1", "ada", "wave", "no/such/file", "s m x", "0"];
/// Parts of the names of buttons that random clicks leave out: what takes seconds, writes files, or opens another database.
const NOT_CLICKED: [&str; 20] = [
    "Train",
    "train",
    "validate",
    "Propose",
    "Find what",
    "Group cuts",
    "Start",
    "Record",
    "By kernel",
    "By the thesis",
    "Save",
    "New database",
    "Export",
    "A page",
    "again",
    "2009",
    "kWAS",
    "Tree of",
    "Discard",
    "Import",
];

/// Name, person, tags and labels of a clip.
type Written = (String, Option<String>, Vec<String>, Vec<(String, i64, i64)>);

/// What was seen before an action, by a look at the window alone.
struct Seen {
    panel: Panel,
    /// A text has the keyboard.
    types: bool,
    /// A window or a menu lies over the panel.
    covered: bool,
    /// The clip whose performer is seen.
    shown: Option<i64>,
    /// The clips whose rows are seen.
    rows: BTreeSet<String>,
    /// Something else than a text has the keyboard: Enter and Space are a click on it.
    focused: bool,
}

/// Clips that an action may write to, by name; `None` for any, where a control was used that is seen.
type May = Option<BTreeSet<String>>;

struct Model {
    person: Person,
    rng: Rng,
    /// The clips that were selected by clicks and are seen.
    chosen: BTreeSet<String>,
    log: Vec<String>,
    /// The action took a step of the history back, or did it again.
    turned: bool,
}

impl Model {
    fn written(&self) -> BTreeMap<i64, Written> {
        let store = self.person.state().store.as_ref().unwrap();
        let clips = store.snapshot.clips.iter().map(|c| {
            let about = (
                c.name.clone(),
                c.subject.clone(),
                c.tags.clone(),
                Vec::new(),
            );
            (c.id.0, about)
        });
        let mut clips: BTreeMap<i64, Written> = clips.collect();
        for (clip, class, start, stop) in self.person.labels() {
            clips.get_mut(&clip).unwrap().3.push((class, start, stop));
        }
        clips
    }

    fn seen(&self) -> Seen {
        let (ctx, state) = (&self.person.window.ctx, self.person.state());
        let focused = ctx.memory(|memory| memory.focused());
        let windows = self
            .person
            .window
            .query_all_by_role(egui::accesskit::Role::Window);
        let names = ["ada_1", "ben_1", "cleo_1"].into_iter();
        let row = |name: &&str| {
            self.person.offers(name) || self.person.offers(&format!("{name}, background"))
        };
        let types = focused.is_some_and(|id| egui::TextEdit::load_state(ctx, id).is_some());
        Seen {
            panel: state.panel,
            types,
            focused: focused.is_some() && !types,
            // The window itself is one.
            covered: windows.count() > 1
                || self.person.sees("Undo it")
                || egui::Popup::is_any_open(ctx),
            shown: state.player.motion.as_ref().map(|m| m.id.0),
            rows: names.filter(row).map(str::to_owned).collect(),
        }
    }

    fn name_of(&self, clip: i64) -> String {
        let store = self.person.state().store.as_ref().unwrap();
        let clips = &store.snapshot.clips;
        clips.iter().find(|c| c.id.0 == clip).unwrap().name.clone()
    }

    /// One action; says which clips it may write to.
    fn act(&mut self, seen: &Seen) -> May {
        // A class whose new name is accepted has it in all clips.
        let renames = self.person.state().classes.renaming.is_some();
        let may = match self.rng.below(20) {
            0..9 => self.key(seen),
            9..13 => Some(self.click(seen)),
            13..15 => self.click_any(seen),
            15..17 => Some(self.types(seen)),
            17 => self.drag(seen),
            _ => self.with_ctrl(seen),
        };
        may.filter(|_| !renames)
    }

    /// What leaving a field writes to: what was typed belongs to the clips that are selected or shown.
    fn accepted(&self, seen: &Seen) -> BTreeSet<String> {
        let shown = seen.shown.map(|clip| self.name_of(clip));
        match seen.types {
            true => self.chosen.iter().cloned().chain(shown).collect(),
            false => BTreeSet::new(),
        }
    }

    /// Types into what has the keyboard; without a field the letters are nobody's.
    fn types(&mut self, seen: &Seen) -> BTreeSet<String> {
        let text = TEXTS[self.rng.below(TEXTS.len())];
        self.log
            .push(format!("text {text:?}, typed {}", seen.types));
        self.person.inserts(text);
        BTreeSet::new()
    }

    /// A place in the window.
    fn somewhere(&mut self) -> Pos2 {
        let mut within = |size: f32| self.rng.below(size as usize) as f32;
        egui::pos2(within(SIZE[0]), within(SIZE[1]))
    }

    /// A drag from anywhere to anywhere: ends of labels, cuts, strips, cameras.
    fn drag(&mut self, seen: &Seen) -> May {
        let (from, to) = (self.somewhere(), self.somewhere());
        self.log.push(format!("drag {from} to {to}"));
        self.person.drag(from, to);
        self.follow_selection();
        match seen.panel {
            Panel::Label | Panel::Classes if !seen.covered => None,
            _ => Some(self.accepted(seen)),
        }
    }

    /// What can be clicked and is seen, by name.
    fn clickable(&self) -> Vec<(String, Rect)> {
        let window = Rect::from_min_size(Pos2::ZERO, SIZE.into());
        let mut found = Vec::new();
        for node in self.person.window.root().children_recursive() {
            if node.accesskit_node().bounding_box().is_none() {
                continue;
            }
            let (rect, node) = (node.rect(), node.accesskit_node());
            let acts = node.data().supports_action(accesskit::Action::Click);
            let name = node.label().unwrap_or_default();
            let left_out = NOT_CLICKED.iter().any(|part| name.contains(part));
            if acts && !node.is_disabled() && !left_out && window.contains(rect.center()) {
                found.push((name, rect));
            }
        }
        found
    }

    /// A click with either button on anything, which says by its name what it changes.
    fn click_any(&mut self, seen: &Seen) -> May {
        let found = self.clickable();
        let (name, rect) = &found[self.rng.below(found.len())];
        self.turned = ["Undo", "Redo", "Take it back"]
            .iter()
            .any(|turn| name.starts_with(turn));
        let right = self.rng.below(4) == 0;
        self.log
            .push(format!("click on {name:?} at {rect}, right {right}"));
        match right {
            true => self.person.right_click_at(rect.center()),
            false => self.person.click_at(rect.center()),
        }
        self.person.calm();
        self.follow_selection();
        match right {
            true => Some(self.accepted(seen)),
            false => None,
        }
    }

    /// The rows that are marked as selected after something was clicked.
    fn follow_selection(&mut self) {
        self.chosen = match self.person.state().library.chosen {
            true => self.selected(),
            false => BTreeSet::new(),
        };
    }

    fn key(&mut self, seen: &Seen) -> May {
        let key = KEYS[self.rng.below(KEYS.len())];
        // A source would run and its takes be trained with.
        if seen.panel == Panel::Live && matches!(key, Key::Space | Key::R | Key::Enter) {
            return Some(BTreeSet::new());
        }
        self.log.push(format!("{key:?}"));
        let shown = seen.shown.map(|clip| self.name_of(clip));
        self.turned = self.is_on_turn();
        if matches!(key, Key::Enter | Key::Space) && seen.focused {
            if self.is_on_left_out() {
                return Some(BTreeSet::new());
            }
            self.person.presses(key);
            self.person.calm();
            self.follow_selection();
            return None;
        }
        self.turned = false;
        self.person.presses(key);
        // Enter and Tab end the typing of a field, which belongs to the clips that are selected.
        if seen.types {
            return Some(match key {
                Key::Enter | Key::Tab => self.accepted(seen),
                _ => BTreeSet::new(),
            });
        }
        Some(match seen.panel {
            _ if seen.covered && key != Key::Enter && key != Key::Space => BTreeSet::new(),
            Panel::Library => {
                let chosen = self.chosen.clone();
                if matches!(key, Key::ArrowUp | Key::ArrowDown | Key::Home | Key::End) {
                    self.follow_selection();
                }
                chosen
            }
            Panel::Label | Panel::Classes => shown.into_iter().collect(),
            Panel::Train | Panel::Live => BTreeSet::new(),
        })
    }

    /// Name of what has the keyboard.
    fn focused_name(&self) -> String {
        self.person.focused().unwrap_or_default()
    }

    fn is_on_turn(&self) -> bool {
        let name = self.focused_name();
        ["Undo", "Redo", "Take it back"]
            .iter()
            .any(|turn| name.starts_with(turn))
    }

    fn is_on_left_out(&self) -> bool {
        let name = self.focused_name();
        NOT_CLICKED.iter().any(|part| name.contains(part))
    }

    /// Names of the clips that the list shows as selected.
    fn selected(&self) -> BTreeSet<String> {
        let state = self.person.state();
        let store = state.store.as_ref().unwrap();
        let selected = state.library.selected.iter();
        let names = selected.filter_map(|id| Some(store.snapshot.clip(*id)?.name.clone()));
        names.collect()
    }

    fn click(&mut self, seen: &Seen) -> BTreeSet<String> {
        let name = CLICKED[self.rng.below(CLICKED.len())];
        let row = match self.person.offers(&format!("{name}, background")) {
            true => format!("{name}, background"),
            false => name.to_owned(),
        };
        if !self.person.offers(&row) {
            return BTreeSet::new();
        }
        let may = self.accepted(seen);
        let is_row = seen.panel == Panel::Library && name.ends_with("_1");
        let how = if is_row { self.rng.below(3) } else { 0 };
        self.log.push(format!("click {row} {how}"));
        match how {
            0 => self.person.click(&row),
            1 => self.person.ctrl_click(&row),
            _ => self.person.right_click(&row),
        }
        self.person.calm();
        // A click beside a menu or a window closes it or does nothing.
        if is_row && how < 2 && !seen.covered {
            let names = self.selected();
            // A clip that the same click has renamed was seen under its name of before.
            let hidden = names.iter().filter(|name| name.ends_with("_1"));
            let hidden: Vec<&String> = hidden.filter(|name| !seen.rows.contains(*name)).collect();
            assert!(
                hidden.is_empty(),
                "{hidden:?} are selected and were not seen"
            );
            self.chosen = names;
        } else if name.starts_with("Show ") && !seen.covered {
            self.chosen.clear();
        }
        may
    }

    fn with_ctrl(&mut self, seen: &Seen) -> May {
        let keys = [
            Key::F,
            Key::Num3,
            Key::Num4,
            Key::Num5,
            Key::Z,
            Key::Y,
            Key::A,
            Key::Num1,
            Key::Num2,
            Key::H,
            Key::O,
            Key::ArrowLeft,
        ];
        let key = keys[self.rng.below(keys.len())];
        self.log.push(format!("Ctrl {key:?}"));
        self.turned = matches!(key, Key::Z | Key::Y);
        self.person.key_with(key, Modifiers::COMMAND);
        if key == Key::A && seen.panel == Panel::Library && !seen.types && !seen.covered {
            self.chosen = seen.rows.clone();
        }
        match key {
            Key::Z | Key::Y if !seen.covered => None,
            Key::ArrowLeft if seen.panel == Panel::Label && !seen.covered && !seen.types => {
                Some(seen.shown.iter().map(|clip| self.name_of(*clip)).collect())
            }
            _ => Some(BTreeSet::new()),
        }
    }

    /// Leaves fields, menus and searches for the start of some panel, where a clip is selected if it is the library.
    fn begins_again(&mut self) {
        for _ in 0..3 {
            self.person.presses(Key::Escape);
        }
        let panel = Panel::ALL[self.rng.below(Panel::ALL.len())];
        let state = &mut self.person.window.state_mut().state;
        for command in [
            Command::Library(LibraryCommand::Filter(String::new())),
            Command::Show(panel),
        ] {
            state.apply(command);
        }
        self.person.calm();
        if panel == Panel::Library && self.person.offers("ben_1") {
            self.person.click("ben_1");
            self.person.calm();
        }
        self.follow_selection();
    }

    /// The last step that is not taken back.
    fn last_step(&self) -> Option<i64> {
        let store = self.person.state().store.as_ref().unwrap();
        let mut steps = store.snapshot.history.iter();
        steps.find(|step| !step.undone).map(|step| step.id)
    }

    fn edits(&mut self, edit: Edit) {
        let state = &mut self.person.window.state_mut().state;
        state.apply(Command::Edit(edit));
        self.person.calm();
    }

    /// Panics unless Undo gives what was before the steps after `last`, and Redo what they made.
    fn is_taken_back(&mut self, last: Option<i64>, before: &Database, after: &Database) {
        let mut steps = 0;
        while self.last_step() != last && steps < 20 {
            self.edits(Edit::Undo(None));
            steps += 1;
        }
        assert_eq!(self.written(), *before, "after {:?}", self.last_actions());
        for _ in 0..steps {
            self.edits(Edit::Redo);
        }
        assert_eq!(self.written(), *after, "after {:?}", self.last_actions());
        // Later looks find clips by their names, and need some classes.
        let names = |all: &Database| all.values().map(|c| c.0.clone()).collect::<BTreeSet<_>>();
        if names(before) != names(after) || self.person.state().classes.order.len() < 2 {
            for _ in 0..steps {
                self.edits(Edit::Undo(None));
            }
        }
    }

    fn last_actions(&self) -> &[String] {
        &self.log[self.log.len().saturating_sub(12)..]
    }
}

/// Clips by number.
type Database = BTreeMap<i64, Written>;

fn run(seed: u64, actions: usize) {
    let folder = tempfile::tempdir().unwrap();
    let unsaved = Arc::new(tempfile::tempdir().unwrap());
    let person = Person::seated(&[made(folder.path(), 2)], unsaved, SIZE, DT);
    if seed.is_multiple_of(2) {
        // Without dialogs paths are typed.
        person.has_no_dialogs();
    }
    let mut model = Model {
        person,
        rng: Rng::new(seed),
        chosen: BTreeSet::new(),
        log: Vec::new(),
        turned: false,
    };
    let mut written = 0;
    for action in 0..actions {
        if action.is_multiple_of(BEGINNING) {
            model.begins_again();
        }
        let (before, seen, last) = (model.written(), model.seen(), model.last_step());
        let names: BTreeMap<i64, String> = before
            .iter()
            .map(|(id, clip)| (*id, clip.0.clone()))
            .collect();
        model.turned = false;
        let may = model.act(&seen);
        model.person.calm();
        let after = model.written();
        if let Some(may) = may {
            let changed = before
                .iter()
                .filter(|(id, clip)| after.get(id) != Some(clip));
            for (id, clip) in changed {
                assert!(
                    may.contains(&names[id]),
                    "seed {seed}: {clip:?} is now {:?}, and only {may:?} may change, after {:?}",
                    after.get(id),
                    model.last_actions()
                );
            }
        }
        if after != before && !model.turned {
            written += 1;
            model.is_taken_back(last, &before, &after);
        }
        let seen = model.seen();
        model
            .chosen
            .retain(|name| seen.panel != Panel::Library || seen.rows.contains(name));
    }
    assert!(written > 2, "{written} of {actions} actions wrote");
}

/// Number of actions of a run.
fn actions() -> usize {
    let given = std::env::var("MOREC_ACTIONS").ok();
    given.and_then(|text| text.parse().ok()).unwrap_or(ACTIONS)
}

#[test]
fn whatever_is_pressed_and_clicked_writes_to_what_is_seen_and_chosen() {
    run(1, actions());
}

#[test]
fn the_same_where_paths_are_typed() {
    run(2, actions());
}

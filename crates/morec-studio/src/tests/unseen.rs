//! Random keys and clicks in every state, against a model of what was seen: whatever is written is of what somebody saw and chose.

use std::collections::{BTreeMap, BTreeSet};

use egui::{Key, Modifiers};
use morec::rng::Rng;

use super::{Person, made};
use crate::state::{Command, Panel};

/// Actions of each run, unless `MOREC_ACTIONS` says how many.
const ACTIONS: usize = 80;
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
}

struct Model {
    person: Person,
    rng: Rng,
    /// The clips that were selected by clicks and are seen.
    chosen: BTreeSet<String>,
    log: Vec<String>,
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
        use egui_kittest::kittest::Queryable;
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
        Seen {
            panel: state.panel,
            types: focused.is_some_and(|id| egui::TextEdit::load_state(ctx, id).is_some()),
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

    /// One action; says which clips it may write to, `None` for any.
    fn act(&mut self, seen: &Seen) -> Option<BTreeSet<String>> {
        match self.rng.below(10) {
            0..6 => Some(self.key(seen)),
            6..9 => Some(self.click(seen)),
            _ => self.with_ctrl(seen),
        }
    }

    fn key(&mut self, seen: &Seen) -> BTreeSet<String> {
        let key = KEYS[self.rng.below(KEYS.len())];
        // A source would run and its takes be trained with.
        if seen.panel == Panel::Live && matches!(key, Key::Space | Key::R) {
            return BTreeSet::new();
        }
        self.log.push(format!("{key:?}"));
        let shown = seen.shown.map(|clip| self.name_of(clip));
        self.person.presses(key);
        // Enter and Tab end the typing of a field, which belongs to the clips that are selected.
        if seen.types {
            return match key {
                Key::Enter | Key::Tab => self.chosen.iter().cloned().chain(shown).collect(),
                _ => BTreeSet::new(),
            };
        }
        match seen.panel {
            _ if seen.covered && key != Key::Enter && key != Key::Space => BTreeSet::new(),
            Panel::Library => {
                let chosen = self.chosen.clone();
                if matches!(key, Key::ArrowUp | Key::ArrowDown) {
                    self.chosen = self.selected();
                }
                chosen
            }
            Panel::Label | Panel::Classes => shown.into_iter().collect(),
            Panel::Train | Panel::Live => BTreeSet::new(),
        }
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
        // A field that is left is accepted.
        let shown = seen.shown.map(|clip| self.name_of(clip));
        let mut may: BTreeSet<String> = self.chosen.iter().cloned().chain(shown).collect();
        let is_row = seen.panel == Panel::Library && name.ends_with("_1");
        let how = if is_row { self.rng.below(3) } else { 0 };
        self.log.push(format!("click {row} {how}"));
        match how {
            0 => self.person.click(&row),
            1 => self.person.ctrl_click(&row),
            _ => self.person.right_click(&row),
        }
        self.person.wait(0.6);
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
        if !seen.types {
            may.clear();
        }
        may
    }

    fn with_ctrl(&mut self, seen: &Seen) -> Option<BTreeSet<String>> {
        let keys = [
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
}

fn run(seed: u64, actions: usize) {
    let folder = tempfile::tempdir().unwrap();
    let person = Person::before(&[made(folder.path(), 2)]);
    let mut model = Model {
        person,
        rng: Rng::new(seed),
        chosen: BTreeSet::new(),
        log: Vec::new(),
    };
    for _ in 0..actions {
        let (before, seen) = (model.written(), model.seen());
        let names: BTreeMap<i64, String> = before
            .iter()
            .map(|(id, clip)| (*id, clip.0.clone()))
            .collect();
        let may = model.act(&seen);
        model.person.settle();
        let after = model.written();
        if let Some(may) = may {
            for (id, clip) in &after {
                let changed = before.get(id) != Some(clip);
                assert!(
                    !changed || may.contains(&names[id]),
                    "seed {seed}: {clip:?} was {:?}, and only {may:?} may change, after {:?}",
                    before.get(id),
                    &model.log[model.log.len().saturating_sub(12)..]
                );
            }
        }
        // Clips keep their names, by which the next looks find them.
        if after.values().any(|clip| !clip.0.ends_with("_1")) {
            model
                .person
                .command(Command::Edit(crate::store::Edit::Undo(None)));
        }
        let seen = model.seen();
        model
            .chosen
            .retain(|name| seen.panel != Panel::Library || seen.rows.contains(name));
    }
}

#[test]
fn whatever_is_pressed_and_clicked_writes_to_what_is_seen_and_chosen() {
    let given = std::env::var("MOREC_ACTIONS").ok();
    let actions = given.and_then(|text| text.parse().ok());
    for seed in 1..=2 {
        run(seed, actions.unwrap_or(ACTIONS));
    }
}

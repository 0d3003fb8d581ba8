//! The keyboard.

mod help;
mod typing;

use egui::{Key, Modifiers};

use crate::lists;
use crate::state::study::{LabelDecision, StudyCommand, StudyView};
use crate::state::{
    ClassCommand, Command, CompareCommand, CutCommand, FileCommand, Grip, LibraryCommand,
    LiveCommand, Panel, PlayCommand, SimilarCommand, State, TimelineCommand, TrainCommand,
};
use crate::store::Edit;
pub use help::HELP;
use typing::{follow_typing, is_changed, remember_change};

/// The keys of the first nine classes.
pub const CLASS_KEYS: [Key; 9] = [
    Key::Num1,
    Key::Num2,
    Key::Num3,
    Key::Num4,
    Key::Num5,
    Key::Num6,
    Key::Num7,
    Key::Num8,
    Key::Num9,
];

/// The key of whichever class it was given to, beyond the ninth, too.
const QUICK_KEY: Key = Key::Q;

/// Reads the keyboard into commands. Keys without Ctrl act on what is seen alone: none does while something lies over the panel or a
/// text has the keyboard, and each only on the panels that show what it changes.
pub fn read(ctx: &egui::Context, state: &State, asks_a_file: bool, out: &mut Vec<Command>) {
    // A question is answered first.
    if state.leaving.is_some() || state.undo_asks || state.discarding.is_some() {
        return;
    }
    let focused = ctx.memory(|memory| memory.focused());
    // A field that appears has the keyboard from its first frame on, whether or not it was drawn yet.
    let asked = state.classes.renaming.is_some() || state.classes.choosing.is_some();
    let in_field = focused.is_some_and(|id| egui::TextEdit::load_state(ctx, id).is_some());
    let in_text = asked || (in_field && is_changed(ctx));
    if !in_field {
        remember_change(ctx, false);
    }
    let covered = state.is_covered() || asks_a_file || egui::Popup::is_any_open(ctx);
    if !asked && !covered && !in_field {
        // The other panels have a list that is gone through without the keyboard being in it.
        lists::read(ctx, matches!(state.panel, Panel::Classes | Panel::Live));
    }
    // On a selected row keys act on what is selected, as without it.
    let typing = asked || (ctx.wants_keyboard_input() && !lists::is_on_selected(ctx));
    ctx.input_mut(|i| {
        commands(i, in_text || covered, out);
        if typing || covered {
            // Keys that were held when typing began are let go.
            if let Some(held) = &state.classes.held {
                out.push(class_key(held.slot, false));
            }
            return;
        }
        choosing(i, state, out);
        match state.panel {
            Panel::Live => return live(i, state, out),
            Panel::Library => library(i, state, out),
            Panel::Label => {
                // Home and End are the clip's.
                rows(i, &STEPS[..2], out);
                labels(i, state, out);
                timeline(i, state, out);
            }
            Panel::Classes => {
                if state.study_view() == Some(StudyView::Annotators) {
                    decisions(i, out);
                }
                // The list of hits does not show the label whose like was searched: keys act on a hit that was gone to.
                if state.classes.similar.is_none() || state.timeline.range.is_some() {
                    labels(i, state, out);
                }
            }
            Panel::Train => {
                for (key, by) in STEPS {
                    if i.consume_key(Modifiers::NONE, key) {
                        out.push(Command::Train(TrainCommand::StepMoment(by)));
                    }
                }
            }
        }
        playing(i, state, out);
        searching(i, state, out);
    });
    if in_field {
        follow_typing(ctx);
    }
    if !in_text && !covered && ctx.input_mut(|i| i.consume_key(Modifiers::COMMAND, Key::F)) {
        if state.panel != Panel::Label {
            out.push(Command::Show(Panel::Library));
        }
        // The field is there in the next frame.
        ctx.data_mut(|data| data.insert_temp(search_field(), true));
    }
}

/// The field in which clips are searched, and where it is remembered that it shall have the keyboard.
pub fn search_field() -> egui::Id {
    egui::Id::new("search clips")
}

fn class_key(slot: usize, down: bool) -> Command {
    Command::Classes(ClassCommand::Key { slot, down })
}

fn commands(i: &mut egui::InputState, elsewhere: bool, out: &mut Vec<Command>) {
    if !elsewhere {
        with_ctrl(i, out);
    }
    if i.consume_key(Modifiers::NONE, Key::F1) {
        out.push(Command::ShowKeys(true));
    }
    if i.key_pressed(Key::Escape) {
        out.push(Command::ShowKeys(false));
        out.push(Command::ShowHistory(false));
        out.push(Command::Classes(ClassCommand::Choosing(None)));
    }
}

fn with_ctrl(i: &mut egui::InputState, out: &mut Vec<Command>) {
    let shift = Modifiers::COMMAND | Modifiers::SHIFT;
    // The longer combination first: a shortcut is also met with more modifiers.
    if i.consume_key(shift, Key::Z) || i.consume_key(Modifiers::COMMAND, Key::Y) {
        out.push(Command::Edit(Edit::Redo));
    }
    if i.consume_key(Modifiers::COMMAND, Key::Z) {
        out.push(Command::Edit(Edit::Undo(None)));
    }
    for (panel, key) in Panel::ALL.into_iter().zip(CLASS_KEYS) {
        if i.consume_key(Modifiers::COMMAND, key) {
            out.push(Command::Show(panel));
        }
    }
    let keys = [
        (Key::O, Command::File(FileCommand::AskOpen)),
        (Key::I, Command::File(FileCommand::AskImport)),
        (Key::S, Command::File(FileCommand::AskSave)),
        (Key::T, Command::Train(TrainCommand::Train)),
        (Key::H, Command::ShowHistory(true)),
    ];
    for (key, command) in keys {
        if i.consume_key(Modifiers::COMMAND, key) {
            out.push(command);
        }
    }
}

fn library(i: &mut egui::InputState, state: &State, out: &mut Vec<Command>) {
    if i.consume_key(Modifiers::COMMAND, Key::A) {
        out.push(Command::Library(LibraryCommand::SelectAll));
    }
    rows(i, &STEPS, out);
    class_keys(i, state, out);
    if i.consume_key(Modifiers::NONE, Key::B) {
        out.push(Command::Library(LibraryCommand::Background));
    }
}

/// Keys of a list, with the number of rows that each goes on.
const STEPS: [(Key, i64); 4] = [
    (Key::ArrowUp, -1),
    (Key::ArrowDown, 1),
    (Key::Home, i64::MIN),
    (Key::End, i64::MAX),
];

/// Keys of the list of clips.
fn rows(i: &mut egui::InputState, steps: &[(Key, i64)], out: &mut Vec<Command>) {
    for &(key, by) in steps {
        if i.consume_key(Modifiers::NONE, key) {
            out.push(Command::Library(LibraryCommand::Step(by)));
        }
    }
}

fn playing(i: &mut egui::InputState, state: &State, out: &mut Vec<Command>) {
    let rate = state.player.rate_hz();
    let second = rate.round() as i64;
    let mut play = |command| out.push(Command::Play(command));
    if i.consume_key(Modifiers::NONE, Key::Space) {
        play(PlayCommand::Toggle);
    }
    for (key, command) in [
        (Key::J, PlayCommand::Shuttle(-1.0)),
        (Key::K, PlayCommand::Pause),
        (Key::L, PlayCommand::Shuttle(1.0)),
        (Key::Comma, PlayCommand::Step(-1)),
        (Key::Period, PlayCommand::Step(1)),
        (Key::Home, PlayCommand::Seek(0.0)),
        (Key::End, PlayCommand::Seek(state.player.secs())),
    ] {
        if i.consume_key(Modifiers::NONE, key) {
            play(command);
        }
    }
    let stretch = state.timeline.range.or_else(|| {
        let selected = state.selected();
        selected.first().map(|s| (s.start_secs, s.stop_secs))
    });
    if i.consume_key(Modifiers::NONE, Key::O) {
        play(PlayCommand::Loop(match state.player.looped {
            Some(_) => None,
            None => stretch,
        }));
    }
    if i.consume_key(Modifiers::NONE, Key::I) {
        play(PlayCommand::Loop(match state.player.looped {
            Some(_) => None,
            None => Some(state.segment()),
        }));
    }
    for (key, way) in [(Key::ArrowLeft, -1), (Key::ArrowRight, 1)] {
        if i.consume_key(Modifiers::SHIFT, key) {
            out.push(Command::Play(PlayCommand::Step(way * second)));
        } else if i.consume_key(Modifiers::NONE, key) {
            out.push(Command::Play(PlayCommand::Step(way)));
        }
    }
}

/// Places of classes with their keys. A class among the first nine may have the key Q beside its own.
fn slots(state: &State) -> Vec<(usize, Vec<Key>)> {
    let keys = CLASS_KEYS.into_iter().enumerate();
    let mut slots: Vec<(usize, Vec<Key>)> = keys.map(|(slot, key)| (slot, vec![key])).collect();
    match state.classes.quick_place() {
        Some(place) if place < slots.len() => slots[place].1.push(QUICK_KEY),
        Some(place) => slots.push((place, vec![QUICK_KEY])),
        None => {}
    }
    slots
}

/// The keys that choose the class of the key Q; Q itself does so while it has none.
fn choosing(i: &mut egui::InputState, state: &State, out: &mut Vec<Command>) {
    let asked = i.consume_key(Modifiers::NONE, Key::W);
    let without = state.classes.quick_place().is_none();
    if asked || (without && i.consume_key(Modifiers::NONE, QUICK_KEY)) {
        let begun = Some(String::new());
        out.push(Command::Classes(ClassCommand::Choosing(begun)));
    }
}

/// The keys of classes, which are held or tapped.
fn class_keys(i: &mut egui::InputState, state: &State, out: &mut Vec<Command>) {
    for (slot, keys) in slots(state) {
        // Keys repeat while they are held; going down is what counts.
        let went_down = i.events.iter().any(|event| {
            matches!(event, egui::Event::Key { key, pressed: true, repeat: false, modifiers, .. }
                if keys.contains(key) && modifiers.is_none())
        });
        let held = state.classes.held.as_ref().is_some_and(|h| h.slot == slot);
        if went_down && !held {
            out.push(class_key(slot, true));
        }
        if (held || went_down) && !keys.iter().any(|key| i.key_down(*key)) {
            out.push(class_key(slot, false));
        }
    }
}

/// Keys of what is selected, where a panel names it.
fn labels(i: &mut egui::InputState, state: &State, out: &mut Vec<Command>) {
    if i.key_pressed(Key::Escape) && !state.show_history {
        out.push(Command::Timeline(TimelineCommand::SelectNothing));
    }
    class_keys(i, state, out);
    for key in [Key::Delete, Key::Backspace] {
        if i.consume_key(Modifiers::NONE, key) {
            out.push(Command::Timeline(TimelineCommand::Remove));
        }
    }
    let selected = state.selected();
    let proposed = selected
        .iter()
        .find(|s| s.state == morec_db::labels::SampleState::Proposed);
    if let Some(sample) = proposed {
        if i.consume_key(Modifiers::NONE, Key::A) {
            out.push(Command::Classes(ClassCommand::Accept(sample.id)));
        }
        if i.consume_key(Modifiers::NONE, Key::R) {
            out.push(Command::Classes(ClassCommand::Reject(sample.id)));
        }
    }
}

/// Keys of the difference of two annotators that was gone to.
fn decisions(i: &mut egui::InputState, out: &mut Vec<Command>) {
    for (key, decision) in [
        (Key::A, LabelDecision::A),
        (Key::B, LabelDecision::B),
        (Key::E, LabelDecision::Both),
    ] {
        if i.consume_key(Modifiers::NONE, key) {
            out.push(Command::Study(StudyCommand::Decide(None, decision)));
        }
    }
}

/// Keys of what only the timeline shows: ends of labels, cuts, the playhead among them.
fn timeline(i: &mut egui::InputState, state: &State, out: &mut Vec<Command>) {
    for (key, command) in [
        (Key::S, TimelineCommand::Split),
        (Key::M, TimelineCommand::Merge),
        (Key::OpenBracket, TimelineCommand::ToPlayhead(Grip::Start)),
        (Key::CloseBracket, TimelineCommand::ToPlayhead(Grip::Stop)),
        (Key::Num0, TimelineCommand::Whole),
        (Key::Plus, zoom(state, 1.5)),
        (Key::Equals, zoom(state, 1.5)),
        (Key::Minus, zoom(state, 1.0 / 1.5)),
    ] {
        if i.consume_key(Modifiers::NONE, key) {
            out.push(Command::Timeline(command));
        }
    }
    let nudge = |grip, by| Command::Timeline(TimelineCommand::Nudge(grip, by));
    // The longer combination first: a shortcut is also met with more modifiers.
    for (key, way) in [(Key::ArrowLeft, -1), (Key::ArrowRight, 1)] {
        for (held, grip) in [
            (Modifiers::ALT | Modifiers::SHIFT, Grip::Stop),
            (Modifiers::ALT, Grip::Start),
            (Modifiers::COMMAND, Grip::Whole),
        ] {
            if i.consume_key(held, key) {
                out.push(nudge(grip, way));
            }
        }
    }
    if i.consume_key(Modifiers::NONE, Key::X) {
        out.push(Command::Cuts(CutCommand::Add(state.player.at_secs)));
    }
}

/// Keys that look for something and change nothing.
fn searching(i: &mut egui::InputState, state: &State, out: &mut Vec<Command>) {
    if i.consume_key(Modifiers::NONE, Key::F) {
        out.push(Command::Similar(SimilarCommand::OfSelection));
    }
    if i.consume_key(Modifiers::NONE, Key::C) {
        let judged = state.panel == Panel::Train && state.chosen_moment().is_some();
        out.push(Command::Compare(match judged {
            true => CompareCommand::Moment(None),
            false => CompareCommand::Nearest,
        }));
    }
    if i.consume_key(Modifiers::NONE, Key::N) {
        out.push(Command::Classes(ClassCommand::NextDoubtful));
    }
}

fn zoom(state: &State, factor: f64) -> TimelineCommand {
    TimelineCommand::Zoom {
        factor,
        about_secs: state.player.at_secs,
    }
}

fn live(i: &mut egui::InputState, state: &State, out: &mut Vec<Command>) {
    let half = 0.5 * state.live.looking.span_secs;
    for (key, secs) in [
        (Key::ArrowLeft, -half),
        (Key::ArrowRight, half),
        (Key::End, f64::MAX),
    ] {
        if i.consume_key(Modifiers::NONE, key) {
            out.push(Command::Live(LiveCommand::Back(secs)));
        }
    }
    for (slot, keys) in slots(state) {
        for key in keys {
            if i.consume_key(Modifiers::NONE, key) {
                out.push(Command::Live(LiveCommand::Mark(slot)));
            }
        }
    }
    if i.consume_key(Modifiers::NONE, Key::Num0) {
        out.push(Command::Live(LiveCommand::MarkBackground));
    }
    if i.consume_key(Modifiers::NONE, Key::Space) {
        out.push(Command::Live(match state.live.is_running() {
            true => LiveCommand::Stop,
            false => LiveCommand::Start,
        }));
    }
    if i.consume_key(Modifiers::NONE, Key::R) {
        out.push(Command::Live(LiveCommand::Record));
    }
}

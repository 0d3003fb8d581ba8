//! Live: a source, the performer, what is recognised as it comes, and teaching from what just happened.

use egui::{
    CentralPanel, ComboBox, Rect, RichText, ScrollArea, SidePanel, TopBottomPanel, Ui, Vec2,
    WidgetType,
};
use morec::kinematics::WorldPose;
use morec::templates::PerformerKind;
use morec_ops::RecognizeSettings;

use super::compare::Other;
use super::widgets::Clipped;
use super::{Out, live_line, padded, teach, view, widgets};
use crate::body::Body;
use crate::format;
use crate::lists::List;
use crate::state::live::Choice;
use crate::state::{Command, LiveCommand, SPEEDS, State};
use crate::theme::Colours;

/// Clips in the list of sources.
const LISTED: usize = 500;

pub fn show(ui: &mut Ui, state: &State, out: Out) {
    TopBottomPanel::bottom("minutes")
        .frame(padded())
        .resizable(true)
        .default_height(178.0)
        .height_range(120.0..=360.0)
        .show_clipped(ui, |ui| live_line::show(ui, state, out));
    SidePanel::left("source")
        .frame(padded())
        .default_width(250.0)
        .width_range(220.0..=340.0)
        .show_clipped(ui, |ui| {
            ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
                source(ui, state, out);
                performers(ui, state, out);
                health(ui, state);
                sensitivity(ui, state, out);
            });
        });
    SidePanel::right("recognised")
        .frame(padded())
        .default_width(270.0)
        .width_range(230.0..=380.0)
        .show_clipped(ui, |ui| {
            teach::show(ui, state, out);
            teach::recognised(ui, state, out);
        });
    CentralPanel::default()
        .frame(padded())
        .show_clipped(ui, |ui| performer(ui, state, out));
}

fn source(ui: &mut Ui, state: &State, out: Out) {
    let c = Colours::now(ui);
    let mut live = |command| out.push(Command::Live(command));
    widgets::section(ui, "SOURCE");
    let running = state.live.is_running();
    ui.horizontal(|ui| {
        let is_clip = matches!(state.live.choice, Choice::Clip(_));
        if ui.selectable_label(is_clip, "Clip").clicked() {
            live(LiveCommand::Choose(Choice::Clip(None)));
        }
        for (name, address) in [
            ("VMC", "vmc://127.0.0.1:39539"),
            ("Axis", "axis://127.0.0.1:7002"),
            ("JSON", "json+tcp://127.0.0.1:9000"),
        ] {
            let kind = address.split("://").next().unwrap_or_default();
            let on = matches!(&state.live.choice, Choice::Network(a) if a.starts_with(kind));
            if ui.selectable_label(on, name).clicked() {
                live(LiveCommand::Choose(Choice::Network(address.to_owned())));
            }
        }
    });
    match &state.live.choice {
        Choice::Clip(chosen) => clip_choice(ui, state, *chosen, &mut live),
        Choice::Network(address) => {
            let mut text = address.clone();
            let response = ui.add(widgets::line(&mut text).desired_width(f32::INFINITY));
            response.widget_info(|| {
                let mut info = egui::WidgetInfo::labeled(WidgetType::TextEdit, true, "Address");
                info.current_text_value = Some(address.clone());
                info
            });
            if text != *address {
                live(LiveCommand::Choose(Choice::Network(text)));
            }
        }
    }
    ui.add_space(4.0);
    let (text, command) = match running {
        true => ("Stop", LiveCommand::Stop),
        false => ("Start", LiveCommand::Start),
    };
    let button = match running {
        true => egui::Button::new(text),
        false => widgets::main_button(text, &c),
    };
    if widgets::wide(ui, true, button, 30.0).clicked() {
        live(command);
    }
    if matches!(state.live.choice, Choice::Clip(_)) {
        along(ui, state, &mut live);
    }
    record(ui, state, &mut live);
}

/// Where the clip is that is played, and how fast it goes.
fn along(ui: &mut Ui, state: &State, live: &mut impl FnMut(LiveCommand)) {
    let c = Colours::now(ui);
    if let Some((at, secs)) = state.live.run.as_ref().and_then(|run| run.position()) {
        let size = Vec2::new(ui.available_width(), 14.0);
        let (bar, response) = ui.allocate_exact_size(size, egui::Sense::click_and_drag());
        widgets::named(&response, WidgetType::Slider, "Position in the clip", false);
        let pointer = response.interact_pointer_pos();
        let share = pointer.map(|p| ((p.x - bar.left()) / bar.width()).clamp(0.0, 1.0));
        let shown = share.unwrap_or((at / secs.max(1e-9)) as f32);
        let done = bar.with_max_x(bar.left() + shown * bar.width());
        ui.painter().rect_filled(bar, 3.0, c.well);
        ui.painter().rect_filled(done, 3.0, c.tint(c.accent, 0.6));
        if let Some(share) = share.filter(|_| response.clicked() || response.drag_stopped()) {
            live(LiveCommand::Seek(f64::from(share) * secs));
        }
        let clock = format!("{} of {}", format::clock(at, 1), format::clock(secs, 1));
        response.on_hover_text(clock);
    }
    ui.horizontal(|ui| {
        ui.label(RichText::new("Speed").size(12.0).color(c.muted));
        for speed in SPEEDS.into_iter().filter(|speed| *speed >= 1.0) {
            let on = speed == state.live.speed;
            let response = ui.selectable_label(on, format!("{speed}×"));
            let name = format!("Live speed {speed}×");
            widgets::named(&response, WidgetType::SelectableLabel, name, on);
            if response.clicked() {
                live(LiveCommand::Speed(speed));
            }
        }
    });
}

fn clip_choice(
    ui: &mut Ui,
    state: &State,
    chosen: Option<morec_db::ClipId>,
    live: &mut impl FnMut(LiveCommand),
) {
    let Some(store) = &state.store else { return };
    let shown = state.player.motion.as_ref().map(|m| m.id);
    let now = chosen.or(shown).and_then(|id| store.snapshot.clip(id));
    let text = now.map_or("choose a clip", |clip| clip.name.as_str());
    let combo = ComboBox::from_id_salt("live clip")
        .width(ui.available_width() - 8.0)
        .selected_text(text);
    let combo = combo.show_ui(ui, |ui| {
        if ui
            .selectable_label(chosen.is_none(), "The clip that is shown")
            .clicked()
        {
            live(LiveCommand::Choose(Choice::Clip(None)));
        }
        // More would have no place in a list: the library finds them.
        for clip in store.snapshot.clips.iter().take(LISTED) {
            let on = now.is_some_and(|n| n.id == clip.id);
            if ui.selectable_label(on, &clip.name).clicked() {
                live(LiveCommand::Choose(Choice::Clip(Some(clip.id))));
            }
        }
    });
    widgets::named(&combo.response, WidgetType::ComboBox, "Clip to play", false);
    if store.snapshot.clips.len() > LISTED {
        let more = store.snapshot.clips.len() - LISTED;
        let text = format!("{} more: show one in the library", format::grouped(more));
        ui.colored_label(Colours::now(ui).muted, text);
    }
}

fn record(ui: &mut Ui, state: &State, live: &mut impl FnMut(LiveCommand)) {
    let c = Colours::now(ui);
    let text = match (&state.live.take, state.live.countdown) {
        (Some(take), _) => format!("⏺ Stop recording, {:.1} s", take.secs()),
        (None, Some(left)) => format!("Recording in {:.0} …", left.ceil()),
        (None, None) => "⏺ Record a take  R".to_owned(),
    };
    let text = RichText::new(text);
    let text = if state.live.take.is_some() {
        text.color(c.bad).strong()
    } else {
        text
    };
    let response = widgets::wide(ui, state.live.is_running(), egui::Button::new(text), 26.0);
    response.widget_info(|| egui::WidgetInfo::labeled(WidgetType::Button, true, "Record a take"));
    if response
        .on_hover_text("Three seconds to get ready; the take becomes a clip of the database")
        .clicked()
    {
        live(LiveCommand::Record);
    }
}

/// Choice of the performer who is watched.
fn performers(ui: &mut Ui, state: &State, out: Out) {
    let Some(run) = state.live.run.as_ref().filter(|r| r.performers.len() > 1) else {
        return;
    };
    ui.add_space(6.0);
    widgets::section(ui, "PERFORMERS");
    let watched = run.watched().map(|w| w.actor);
    ui.horizontal_wrapped(|ui| {
        let list = List::new(ui, "performers", run.performers.len());
        for (at, performer) in run.performers.iter().enumerate() {
            let number = performer.actor.0 + 1;
            let text = match performer.gone {
                true => format!("{number} (gone)"),
                false => number.to_string(),
            };
            let on = watched == Some(performer.actor);
            let response = ui.selectable_label(on, text);
            widgets::named(
                &response,
                WidgetType::SelectableLabel,
                format!("Watch performer {number}"),
                on,
            );
            if list.row(ui, at, &response, false) {
                out.push(Command::Live(LiveCommand::Watch(performer.actor)));
            }
        }
    });
}

/// Health of the stream, in words.
fn health(ui: &mut Ui, state: &State) {
    let c = Colours::now(ui);
    let Some(run) = &state.live.run else { return };
    ui.add_space(6.0);
    widgets::section(ui, "STREAM");
    ui.add(egui::Label::new(RichText::new(&run.name).size(12.5)).truncate());
    if let Some(d) = run.diagnosis() {
        let rate = d
            .rate_hz
            .map_or("– Hz".to_owned(), |hz| format!("{hz:.0} Hz"));
        let lost = format!("{:.1} % lost", 100.0 * d.lost_share);
        let height = d
            .height_m
            .map_or(String::new(), |h| format!(", {h:.2} m to the head"));
        ui.label(RichText::new(format!("{rate}, {lost}{height}")).size(12.5));
    }
    let said = run.health(state.live.index().map(|index| &**index));
    if said.is_empty() {
        ui.colored_label(c.good, "✔ No problems found.");
    }
    for (text, fault) in said.iter().take(5) {
        let colour = if *fault { c.warn } else { c.muted };
        ui.label(
            RichText::new(format!("{} {text}", if *fault { "⚠" } else { "•" }))
                .size(12.0)
                .color(colour),
        );
    }
}

fn sensitivity(ui: &mut Ui, state: &State, out: Out) {
    let c = Colours::now(ui);
    if state.live.index().is_none() {
        return;
    }
    ui.add_space(6.0);
    widgets::section(ui, "SENSITIVITY");
    if state.live.can_sense() {
        alarms(ui, state, out);
    } else {
        ui.colored_label(c.muted, "This index has only one sensitivity.");
    }
    if state.live.knows_performers() {
        who_performs(ui, state, out);
    }
    if let Some(resensed) = &state.live.resensed {
        let at = match resensed.settings.sensitivity {
            Some(alarms) => format!("At {alarms:.2} it"),
            None => "It".to_owned(),
        };
        let count = format::count(resensed.found.len(), "motion");
        let text = format!("{at} would have reported {count} in the minutes below.");
        ui.label(RichText::new(text).size(12.0));
    }
}

fn alarms(ui: &mut Ui, state: &State, out: Out) {
    let mut alarms = state.live.settings.sensitivity.unwrap_or(0.3);
    ui.spacing_mut().slider_width = ui.available_width() - 60.0;
    let slider = egui::Slider::new(&mut alarms, 0.03..=2.0)
        .logarithmic(true)
        .max_decimals(2);
    let response = ui.add(slider);
    widgets::named(&response, WidgetType::Slider, "Sensitivity", false);
    if response.changed() {
        out.push(Command::Live(LiveCommand::Settings(RecognizeSettings {
            sensitivity: Some((alarms * 100.0).round() / 100.0),
            ..state.live.settings.clone()
        })));
    }
    let said = RichText::new("accepted false alarms a minute");
    ui.label(said.size(11.0).color(Colours::now(ui).muted));
}

/// The performer that is expected, where one or two people taught.
fn who_performs(ui: &mut Ui, state: &State, out: Out) {
    let name = |kind: PerformerKind| match kind {
        PerformerKind::Auto => "automatic",
        PerformerKind::Teacher => "training subject",
        PerformerKind::Anyone => "another person",
    };
    let chosen = state.live.settings.performer.unwrap_or_default();
    ui.horizontal(|ui| {
        ui.label("Performer");
        let combo = ComboBox::from_id_salt("performer").selected_text(name(chosen));
        let combo = combo.show_ui(ui, |ui| {
            use PerformerKind::{Anyone, Auto, Teacher};
            for kind in [Auto, Teacher, Anyone] {
                if ui.selectable_label(kind == chosen, name(kind)).clicked() {
                    out.push(Command::Live(LiveCommand::Settings(RecognizeSettings {
                        performer: Some(kind),
                        ..state.live.settings.clone()
                    })));
                }
            }
        });
        widgets::named(&combo.response, WidgetType::ComboBox, "Performer", false);
        combo.response.on_hover_text(
            "Automatic: from the fourth report on, the score threshold rises to half of the performer's recent scores. Training \
             subject: half of the training samples' scores from the start. Another person: the threshold is never raised",
        );
    });
}

fn performer(ui: &mut Ui, state: &State, out: Out) {
    let rect = ui.available_rect_before_wrap();
    let Some(run) = &state.live.run else {
        let c = Colours::now(ui);
        ui.painter().rect_filled(rect, 4.0, c.well);
        ui.add_space(rect.height() * 0.3);
        widgets::nothing(
            ui,
            "No source is running",
            "Choose a source on the left and start it.",
        );
        return;
    };
    let empty = (Body::default(), WorldPose::default());
    let watched = run.watched();
    let c = Colours::now(ui);
    // The others pale, so that it is seen who is watched.
    let palette = c.body().mixed(c.muted, 0.6);
    let others = run
        .performers
        .iter()
        .filter(|p| !p.gone && !p.body.limbs.is_empty())
        .filter(|p| watched.is_none_or(|w| w.actor != p.actor))
        .map(|p| Other {
            body: &p.body,
            pose: p.pose.clone(),
            palette,
            caption: format!("Performer {}", p.actor.0 + 1),
        });
    let scene = view::Scene {
        body: watched.map_or(&empty.0, |w| &w.body),
        pose: watched.map_or(&empty.1, |w| &w.pose),
        floor: watched.map_or(0.0, |w| w.floor()),
        motion: None,
        others: others.collect(),
        caption: None,
    };
    view::draw(ui, rect, state, &scene, out);
    banner(ui, state, rect);
}

/// The last detection, large enough to be read from a few metres.
fn banner(ui: &Ui, state: &State, rect: Rect) {
    const SHOWN_SECS: f64 = 2.0;
    let c = Colours::now(ui);
    let Some(run) = &state.live.run else { return };
    let painter = ui.painter_at(rect);
    if let Some(left) = state.live.countdown {
        let text = format!("{:.0}", left.ceil());
        painter.text(
            rect.center(),
            egui::Align2::CENTER_CENTER,
            text,
            egui::FontId::proportional(96.0),
            c.warn,
        );
    }
    let fresh = run
        .seen
        .last()
        .filter(|s| run.now_secs - s.reported_secs < SHOWN_SECS);
    let Some(seen) = fresh else { return };
    let age = ((run.now_secs - seen.reported_secs) / SHOWN_SECS) as f32;
    let place = state.classes.place(&seen.class);
    let text = c.text_on(c.class(place));
    let said = match seen.repetitions {
        Some(count) => format!("{} × {count}", seen.class),
        None => seen.class.clone(),
    };
    let galley = painter.layout_no_wrap(said, egui::FontId::proportional(30.0), text);
    let size = galley.size() + Vec2::new(40.0, 18.0);
    let at = Rect::from_center_size(rect.center_bottom() - Vec2::new(0.0, 46.0), size);
    let fill = c.class(place).gamma_multiply((1.4 - age).clamp(0.0, 1.0));
    painter.rect_filled(at, 8.0, fill);
    painter.galley(at.center() - galley.size() / 2.0, galley, text);
}

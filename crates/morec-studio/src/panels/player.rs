//! The transport: play, steps, speed, loop, where it is.

use egui::{Align, Button, ComboBox, Layout, RichText, Ui, Vec2};

use super::Out;
use crate::format;
use crate::state::{Command, Panel, PlayCommand, SPEEDS, State};
use crate::theme::Colours;

pub const HEIGHT: f32 = 34.0;

/// Width below which the clip's name has no room beside the time.
const NARROW: f32 = 480.0;

/// The name of the clip that is shown, on a line of its own where [`transport`] has no room for it.
pub fn name_below(ui: &mut Ui, state: &State) {
    if let Some(clip) = state.shown_clip()
        && ui.available_width() < NARROW
    {
        ui.add(egui::Label::new(RichText::new(&clip.name).strong()).truncate());
    }
}

pub fn transport(ui: &mut Ui, state: &State, out: Out) {
    let c = Colours::now(ui);
    let player = &state.player;
    let wide = ui.available_width() >= NARROW;
    ui.allocate_ui_with_layout(
        Vec2::new(ui.available_width(), HEIGHT),
        Layout::left_to_right(Align::Center),
        |ui| {
            ui.spacing_mut().item_spacing.x = 4.0;
            let mut button =
                |ui: &mut Ui, text: &str, name: &str, hint: &str, on: bool, command| {
                    let button = Button::new(RichText::new(text).size(14.0))
                        .selected(on)
                        .min_size(Vec2::new(30.0, 26.0));
                    let response = ui.add(button).on_hover_text(hint);
                    response.widget_info(|| {
                        egui::WidgetInfo::labeled(egui::WidgetType::Button, true, name)
                    });
                    if response.clicked() {
                        out.push(Command::Play(command));
                    }
                };
            button(
                ui,
                "⏮",
                "To the beginning",
                match state.panel {
                    // There Home is the list's.
                    Panel::Library | Panel::Train => "To the beginning",
                    _ => "To the beginning (Home)",
                },
                false,
                PlayCommand::Seek(0.0),
            );
            button(
                ui,
                "◀",
                "Frame back",
                "A frame back (,)",
                false,
                PlayCommand::Step(-1),
            );
            let (sign, name) = if player.playing {
                ("⏸", "Pause")
            } else {
                ("▶", "Play")
            };
            button(
                ui,
                sign,
                name,
                "Play or stop (Space)",
                player.playing,
                PlayCommand::Toggle,
            );
            button(
                ui,
                "▶|",
                "Frame on",
                "A frame on (.)",
                false,
                PlayCommand::Step(1),
            );
            let stretch = state.timeline.range.or_else(|| {
                let selected = state.selected();
                selected.first().map(|s| (s.start_secs, s.stop_secs))
            });
            let looped = player.looped.is_some();
            let next = if looped {
                None
            } else {
                stretch.or(Some((0.0, player.secs())))
            };
            button(
                ui,
                "🔁",
                "Loop",
                "Loop the selection (O)",
                looped,
                PlayCommand::Loop(next),
            );
            ui.add_space(6.0);
            let speeds = ComboBox::from_id_salt("speed")
                .width(64.0)
                // All speeds without scrolling.
                .height(320.0)
                .selected_text(format!("{}×", player.speed))
                .show_ui(ui, |ui| {
                    for speed in SPEEDS {
                        let on = speed == player.speed;
                        if ui.selectable_label(on, format!("{speed}×")).clicked() {
                            out.push(Command::Play(PlayCommand::Speed(speed)));
                        }
                    }
                });
            speeds.response.widget_info(|| {
                let kind = egui::WidgetType::ComboBox;
                egui::WidgetInfo::labeled(kind, true, "Playing speed")
            });
            ui.add_space(8.0);
            let frame = (player.at_secs * player.rate_hz()).round() as usize;
            ui.label(
                RichText::new(format::clock(player.at_secs, 2))
                    .monospace()
                    .size(13.5),
            );
            let of = format!("of {}", format::clock(player.secs(), 2));
            ui.label(RichText::new(of).color(c.muted).size(12.0));
            // Narrow panels have room for the time only.
            if ui.available_width() > 90.0 {
                let frame = RichText::new(format!("frame {frame}"));
                ui.label(frame.color(c.muted).size(12.0));
            }
            ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
                if let Some(clip) = state.shown_clip().filter(|_| wide) {
                    ui.add(egui::Label::new(RichText::new(&clip.name).strong()).truncate());
                }
            });
        },
    );
}

//! Colours, spacing and type, in dark and in light.

use egui::{
    Color32, Context, CornerRadius, FontFamily, FontId, Stroke, TextStyle, Theme, Vec2, Visuals,
};

use crate::body::mesh::BodyColours;

/// Colours that egui has no name for.
#[derive(Debug, Clone, Copy)]
pub struct Colours {
    pub dark: bool,
    /// Behind everything.
    pub ground: Color32,
    /// Behind the content of panels.
    pub panel: Color32,
    /// Behind tracks, strips and the view.
    pub well: Color32,
    pub line: Color32,
    pub text: Color32,
    pub muted: Color32,
    pub accent: Color32,
    pub good: Color32,
    pub bad: Color32,
    pub warn: Color32,
    pub playhead: Color32,
    /// Behind the performer, above and below.
    pub sky: [Color32; 2],
}

const DARK: Colours = Colours {
    dark: true,
    ground: Color32::from_rgb(0x14, 0x17, 0x1c),
    panel: Color32::from_rgb(0x1b, 0x1f, 0x26),
    well: Color32::from_rgb(0x11, 0x14, 0x18),
    line: Color32::from_rgb(0x30, 0x36, 0x40),
    text: Color32::from_rgb(0xd9, 0xdd, 0xe3),
    muted: Color32::from_rgb(0x94, 0x9d, 0xaa),
    accent: Color32::from_rgb(0x4d, 0xa3, 0xe8),
    good: Color32::from_rgb(0x3f, 0xb4, 0x8b),
    bad: Color32::from_rgb(0xee, 0x75, 0x4a),
    warn: Color32::from_rgb(0xe6, 0xb0, 0x3c),
    playhead: Color32::from_rgb(0xff, 0xff, 0xff),
    sky: [
        Color32::from_rgb(0x16, 0x1a, 0x20),
        Color32::from_rgb(0x25, 0x2b, 0x34),
    ],
};

const LIGHT: Colours = Colours {
    dark: false,
    ground: Color32::from_rgb(0xe9, 0xec, 0xf0),
    panel: Color32::from_rgb(0xf7, 0xf8, 0xfa),
    well: Color32::from_rgb(0xff, 0xff, 0xff),
    line: Color32::from_rgb(0xcf, 0xd5, 0xdd),
    text: Color32::from_rgb(0x20, 0x26, 0x2e),
    muted: Color32::from_rgb(0x5d, 0x67, 0x75),
    accent: Color32::from_rgb(0x0b, 0x6a, 0xb5),
    good: Color32::from_rgb(0x00, 0x7d, 0x5a),
    bad: Color32::from_rgb(0xb9, 0x46, 0x0c),
    warn: Color32::from_rgb(0x8f, 0x66, 0x00),
    playhead: Color32::from_rgb(0x10, 0x14, 0x1a),
    sky: [
        Color32::from_rgb(0xfb, 0xfc, 0xfd),
        Color32::from_rgb(0xe3, 0xe8, 0xee),
    ],
};

/// Eight colours that colour-blind people tell apart (Okabe and Ito 2008, *Color Universal Design*), lightened a little
/// where dark grounds ask for it. Further classes take them again, lighter.
const CLASSES: [(u8, u8, u8); 8] = [
    (0x56, 0xb4, 0xe9),
    (0xe6, 0x9f, 0x00),
    (0x00, 0x9e, 0x73),
    (0xcc, 0x79, 0xa7),
    (0xf0, 0xe4, 0x42),
    (0xd5, 0x5e, 0x00),
    (0x33, 0x88, 0xc8),
    (0x9a, 0xa3, 0xae),
];

/// Ratio of the luminances of two colours, from 1 to 21, as WCAG 2 defines it. 4.5 is enough for text.
fn contrast(a: Color32, b: Color32) -> f32 {
    let luminance = |colour: Color32| {
        let [r, g, b, _] = egui::Rgba::from(colour).to_array();
        0.2126 * r + 0.7152 * g + 0.0722 * b
    };
    let (a, b) = (luminance(a) + 0.05, luminance(b) + 0.05);
    a.max(b) / a.min(b)
}

impl Colours {
    pub fn of(dark: bool) -> Self {
        if dark { DARK } else { LIGHT }
    }

    /// The colours in use.
    pub fn now(ui: &egui::Ui) -> Self {
        Self::of(ui.visuals().dark_mode)
    }

    /// The colour of the class in this place.
    pub fn class(&self, place: Option<usize>) -> Color32 {
        let Some(place) = place else {
            return self.muted;
        };
        let (r, g, b) = CLASSES[place % CLASSES.len()];
        let colour = Color32::from_rgb(r, g, b);
        let lap = place / CLASSES.len();
        match lap {
            0 => colour,
            n => colour.lerp_to_gamma(self.text, (0.28 * n as f32).min(0.7)),
        }
    }

    /// Text on a colour: black, or white where that is read better. One of the two always has a contrast of 4.5.
    pub fn text_on(&self, fill: Color32) -> Color32 {
        let (black, white) = (Color32::BLACK, Color32::WHITE);
        match contrast(black, fill) >= contrast(white, fill) {
            true => black,
            false => white,
        }
    }

    /// Colours of a performer: left blue, right orange, as on the pages of reports.
    pub fn body(&self) -> BodyColours {
        match self.dark {
            true => BodyColours {
                left: Color32::from_rgb(0x5f, 0xa8, 0xe6),
                right: Color32::from_rgb(0xe8, 0x8b, 0x4c),
                middle: Color32::from_rgb(0xc3, 0xc8, 0xd0),
                shadow: Color32::from_rgb(0x16, 0x1a, 0x20),
            },
            false => BodyColours {
                left: Color32::from_rgb(0x2f, 0x7f, 0xc4),
                right: Color32::from_rgb(0xd0, 0x68, 0x24),
                middle: Color32::from_rgb(0x8b, 0x94, 0xa0),
                shadow: Color32::from_rgb(0xc6, 0xcd, 0xd6),
            },
        }
    }

    /// A colour laid thinly over the well.
    pub fn tint(&self, colour: Color32, share: f32) -> Color32 {
        self.well.lerp_to_gamma(colour, share)
    }
}

/// Sets fonts, spacing and both themes.
pub fn install(ctx: &Context) {
    for dark in [true, false] {
        let theme = if dark { Theme::Dark } else { Theme::Light };
        ctx.style_mut_of(theme, |style| {
            style.visuals = visuals(dark);
            style.spacing.item_spacing = Vec2::new(8.0, 6.0);
            style.spacing.button_padding = Vec2::new(9.0, 4.0);
            style.spacing.interact_size = Vec2::new(28.0, 24.0);
            style.spacing.indent = 14.0;
            // What is out of sight must show that it is there.
            style.spacing.scroll.dormant_handle_opacity = 0.5;
            style.spacing.scroll.floating_width = 4.0;
            style.spacing.scroll.floating_allocated_width = 6.0;
            style.interaction.tooltip_delay = 0.4;
            style.animation_time = 0.08;
            style.text_styles = [
                (
                    TextStyle::Small,
                    FontId::new(11.0, FontFamily::Proportional),
                ),
                (TextStyle::Body, FontId::new(13.5, FontFamily::Proportional)),
                (
                    TextStyle::Button,
                    FontId::new(13.5, FontFamily::Proportional),
                ),
                (
                    TextStyle::Heading,
                    FontId::new(17.0, FontFamily::Proportional),
                ),
                (
                    TextStyle::Monospace,
                    FontId::new(12.0, FontFamily::Monospace),
                ),
            ]
            .into();
        });
    }
}

fn visuals(dark: bool) -> Visuals {
    let c = Colours::of(dark);
    let mut v = if dark {
        Visuals::dark()
    } else {
        Visuals::light()
    };
    let round = CornerRadius::same(4);
    v.panel_fill = c.panel;
    v.window_fill = c.panel;
    v.extreme_bg_color = c.well;
    v.faint_bg_color = c.ground;
    v.window_stroke = Stroke::new(1.0, c.line);
    v.selection.bg_fill = c.panel.lerp_to_gamma(c.accent, 0.35);
    v.selection.stroke = Stroke::new(1.0, c.text);
    v.hyperlink_color = c.accent;
    v.override_text_color = None;
    let button = c.panel.lerp_to_gamma(c.text, 0.08);
    let w = &mut v.widgets;
    w.noninteractive.bg_stroke = Stroke::new(1.0, c.line);
    w.noninteractive.fg_stroke = Stroke::new(1.0, c.text);
    w.noninteractive.corner_radius = round;
    for (state, fill, stroke) in [
        (&mut w.inactive, button, c.line),
        (&mut w.hovered, c.panel.lerp_to_gamma(c.text, 0.16), c.muted),
        (
            &mut w.active,
            c.panel.lerp_to_gamma(c.accent, 0.5),
            c.accent,
        ),
        (&mut w.open, c.panel.lerp_to_gamma(c.text, 0.12), c.line),
    ] {
        state.bg_fill = fill;
        state.weak_bg_fill = fill;
        state.bg_stroke = Stroke::new(1.0, stroke);
        state.fg_stroke = Stroke::new(1.0, c.text);
        state.corner_radius = round;
        state.expansion = 0.0;
    }
    v
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_can_be_read_on_the_colour_of_every_class_in_both_themes() {
        for colours in [DARK, LIGHT] {
            for place in 0..40 {
                let fill = colours.class(Some(place));
                let ratio = contrast(colours.text_on(fill), fill);
                assert!(
                    ratio >= 4.5,
                    "class {place}, dark {}: {ratio}",
                    colours.dark
                );
            }
        }
        assert_eq!(contrast(Color32::BLACK, Color32::WHITE).round(), 21.0);
    }
}

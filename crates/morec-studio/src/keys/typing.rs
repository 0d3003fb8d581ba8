//! Whether keys with Ctrl are those of the text that has the keyboard.

use egui::Key;

/// Where it is remembered whether the text in the field was changed since Enter.
fn changed_id() -> egui::Id {
    egui::Id::new("text was changed")
}

/// True if keys with Ctrl are the text's own: it was changed, and Enter has not been pressed since.
pub fn is_changed(ctx: &egui::Context) -> bool {
    ctx.data(|data| data.get_temp(changed_id()))
        .unwrap_or(false)
}

pub fn remember_change(ctx: &egui::Context, changed: bool) {
    ctx.data_mut(|data| data.insert_temp(changed_id(), changed));
}

/// Notices that the text that has the keyboard is changed, or accepted by Enter.
pub fn follow_typing(ctx: &egui::Context) {
    use egui::Event;
    let last = ctx.input(|i| {
        let events = i.events.iter().rev();
        let mut said = events.filter_map(|event| match event {
            Event::Text(_) | Event::Paste(_) | Event::Cut | Event::Ime(_) => Some(true),
            Event::Key {
                key, pressed: true, ..
            } => match key {
                Key::Enter => Some(false),
                Key::Backspace | Key::Delete => Some(true),
                _ => None,
            },
            _ => None,
        });
        said.next()
    });
    if let Some(changed) = last {
        remember_change(ctx, changed);
    }
}

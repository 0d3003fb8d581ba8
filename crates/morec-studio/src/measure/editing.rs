//! Time from the drop of a dragged label to the frame that shows it from the disk.

use std::path::Path;
use std::time::{Duration, Instant};

use crate::screenshot::Headless;
use crate::state::{Command, Drag, Grip, Panel, TimelineCommand};

/// Longest wait for an edit.
const PATIENCE: Duration = Duration::from_secs(10);

/// Drags the first label of a database to and fro, `times` times; gives the milliseconds on the wall from each drop until a
/// frame shows what the database then holds, in increasing order.
///
/// # Errors
/// No database, no label in the first clip, or an edit that is not made.
pub fn drops(database: &Path, times: usize) -> Result<Vec<f64>, String> {
    let mut window = Headless::new(&[database.to_owned()], [1400, 860], 1.0, true);
    window.settle();
    window.command(Command::Show(Panel::Label));
    window.settle();
    let label = window.studio.state.shown_samples().first();
    let (id, span) = label.map(|s| (s.id, s.span())).ok_or("no label")?;
    let mut took = Vec::with_capacity(times);
    for number in 0..times {
        let by_secs = [0.01, 0.02][number % 2];
        let drag = Drag {
            id,
            grip: Grip::Whole,
            held_secs: 0.0,
            span: span.map(|secs| secs + by_secs),
            dropped: false,
        };
        window.command(Command::Timeline(TimelineCommand::Grab(drag)));
        window.tessellated();
        let begun = Instant::now();
        window.command(Command::Timeline(TimelineCommand::Drop));
        // It is drawn as it was dropped until it arrives.
        while window.studio.state.timeline.drag.is_some() {
            window.tessellated();
            if begun.elapsed() > PATIENCE {
                return Err("an edit that takes ten seconds".to_owned());
            }
        }
        took.push(1000.0 * begun.elapsed().as_secs_f64());
        if let Some(notice) = window.studio.state.notices.first() {
            return Err(notice.text.clone());
        }
    }
    took.sort_by(f64::total_cmp);
    Ok(took)
}

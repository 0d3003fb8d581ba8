//! Audacity label tracks: a line of `start<TAB>stop<TAB>name` for each label, seconds.

use morec::formats::{ParseError, Place};

use super::annotation::{Annotation, ClipLengths, ReadLabels, secs};
use super::timed_text;

/// Reads a label track, a TextGrid or subtitles of one clip. Times are seconds from the clip's beginning. `clip` must be given,
/// because these formats do not name it; `tiers` chooses tiers of a TextGrid.
///
/// # Errors
/// No clip is given, or a line is not `start<TAB>stop<TAB>name`.
pub fn read(text: &str, clip: Option<&str>, tiers: &[String]) -> Result<ReadLabels, ParseError> {
    let clip = clip.ok_or_else(|| {
        ParseError::new(
            Place::File,
            "the clip as an option (a label track does not name it)",
            "no clip given",
        )
    })?;
    if timed_text::is_textgrid(text) {
        return timed_text::textgrid(text, clip, tiers);
    }
    if timed_text::is_subtitles(text) {
        return timed_text::subtitles(text, clip);
    }
    let mut read = ReadLabels::default();
    for (line, raw) in (1..).zip(text.lines()) {
        // Lines that begin with a backslash hold frequencies of the label above.
        if raw.trim().is_empty() || raw.starts_with('\\') {
            continue;
        }
        let error = |found: &str| {
            ParseError::new(
                Place::Line(line),
                "start<TAB>stop<TAB>name, in seconds",
                found,
            )
        };
        let mut cells = raw.splitn(3, '\t');
        let mut number = || {
            cells
                .next()
                .and_then(|cell| cell.trim().replace(',', ".").parse::<f64>().ok())
        };
        let (start, stop) = number().zip(number()).ok_or_else(|| error(raw))?;
        let class = cells.next().unwrap_or("").trim();
        let extent = read.stretch(Place::Line(line), class, (start, stop));
        let Some(extent) = extent.map_err(|found| error(&found))? else {
            continue;
        };
        read.annotations
            .push(Annotation::accepted(clip, class, extent));
    }
    Ok(read)
}

/// Writes annotations, all of one clip, as a label track.
///
/// # Errors
/// A label covers a whole clip of unknown length.
pub fn write(annotations: &[Annotation], lengths: &ClipLengths) -> Result<String, String> {
    annotations
        .iter()
        .map(|a| secs(a, lengths).map(|(start, stop)| format!("{start}\t{stop}\t{}\n", a.class)))
        .collect()
}

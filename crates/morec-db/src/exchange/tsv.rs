//! Tab-separated label tables, in the form that `morec train` reads.

use morec::TimeSpan;
use morec::formats::ParseError;
use morec::labels::{Extent, Labels};

use super::annotation::{Annotation, ClipLengths, LabelContext, ReadLabels, frames, secs};
use crate::labels::SampleState;

/// Reads a tab-separated label table, as `morec train` does.
///
/// # Errors
/// A required column is missing, or a cell is not what its column requires.
pub fn read(bytes: &[u8], context: &LabelContext) -> Result<ReadLabels, ParseError> {
    if is_of_boris(bytes) {
        return super::csv::read(bytes, context);
    }
    let (labels, states) = Labels::read_with(bytes, "state")?;
    // Rows with seconds need no clip to be understood; those with frames need its rate.
    let mut read = ReadLabels {
        warnings: labels.warnings,
        ..ReadLabels::default()
    };
    for (at, row) in labels.rows.into_iter().enumerate() {
        let extent = match (&row.extent, context.rate_of(&row.clip)) {
            (Extent::Secs(span), _) => Some((span.start_secs, span.stop_secs)),
            (Extent::WholeClip, _) => None,
            (Extent::Frames(frames), Some(rate_hz)) => {
                let span = TimeSpan::of_frames(frames.clone(), rate_hz);
                let before = context.before(&row.clip, rate_hz);
                Some((span.start_secs - before, span.stop_secs - before))
            }
            (Extent::Frames(_), None) => {
                *read.absent.entry(row.clip).or_default() += 1;
                continue;
            }
        };
        read.annotations.push(Annotation {
            clip: row.clip,
            class: row.class,
            extent,
            person: row.person,
            annotator: row.annotator,
            score: None,
            state: states.as_ref().map_or(Ok(SampleState::Accepted), |cells| {
                super::annotation::state(&cells[at], row.line)
            })?,
        });
    }
    Ok(read)
}

/// True of events that BORIS exports: their columns are its own.
pub fn is_of_boris(bytes: &[u8]) -> bool {
    const LOOKED_AT: usize = 4096;
    let head = String::from_utf8_lossy(&bytes[..bytes.len().min(LOOKED_AT)]);
    head.contains("Observation id") && head.contains("Behavior")
}

/// True if a name is read again as it is written: cells are cut at tabs and line ends, and trimmed, quotes about them are left out, and a
/// row may be a comment.
fn fits_a_cell(name: &str) -> bool {
    let is_quoted = name.len() > 1 && name.starts_with('"') && name[1..].contains('"');
    name.trim() == name
        && !name.contains(['\t', '\n', '\r'])
        && !is_quoted
        && !name.starts_with("# ")
}

/// Writes annotations as a tab-separated table: in frames where times fall on frames, else in seconds.
///
/// # Errors
/// A name contains a tab or a line end, which the format cannot store.
pub fn write(annotations: &[Annotation], lengths: &ClipLengths) -> Result<String, String> {
    let people = annotations.iter().any(|a| a.person.is_some());
    let annotators = annotations.iter().any(|a| a.annotator.is_some());
    let judged = annotations.iter().any(|a| a.state != SampleState::Accepted);
    let more = |a: &Annotation| {
        let cell = |name: &Option<String>| format!("\t{}", name.as_deref().unwrap_or(""));
        let cells = [
            people.then(|| cell(&a.person)),
            annotators.then(|| cell(&a.annotator)),
            judged.then(|| format!("\t{}", a.state.name())),
        ];
        cells.into_iter().flatten().collect::<String>()
    };
    let names = annotations.iter().flat_map(|a| {
        [&a.clip, &a.class]
            .into_iter()
            .chain(&a.person)
            .chain(&a.annotator)
    });
    if let Some(name) = names.into_iter().find(|name| !fits_a_cell(name)) {
        return Err(format!(
            "{name:?}: a table separated by tabs cannot hold this name; rename it, or write JSON or CSV"
        ));
    }
    let mut out = String::new();
    let last = [
        people.then_some("\tperson"),
        annotators.then_some("\tannotator"),
        judged.then_some("\tstate"),
    ]
    .into_iter()
    .flatten()
    .collect::<String>();
    if !annotations.is_empty() && annotations.iter().all(|a| a.extent.is_none()) {
        out.push_str(&format!("clip\tclass{last}\n"));
        for a in annotations {
            out.push_str(&format!("{}\t{}{}\n", a.clip, a.class, more(a)));
        }
        return Ok(out);
    }
    // Whole clips among stretches have a 1 in a column, and their start and stop for programs that do not know it.
    let mixed = annotations.iter().any(|a| a.extent.is_none());
    let column = if mixed { "\twhole_clip" } else { "" };
    out.push_str(&format!(
        "clip\tstart\tstop\tstart_secs\tstop_secs{column}\tclass{last}\n"
    ));
    for a in annotations {
        let (start, stop) = secs(a, lengths)?;
        let cells = match frames(
            &Annotation {
                extent: Some((start, stop)),
                ..a.clone()
            },
            lengths,
        ) {
            Some((from, to)) => format!("{from}\t{to}"),
            None => "\t".to_owned(),
        };
        let whole = match (mixed, a.extent) {
            (false, _) => "",
            (true, None) => "\t1",
            (true, Some(_)) => "\t0",
        };
        out.push_str(&format!(
            "{}\t{cells}\t{start}\t{stop}{whole}\t{}{}\n",
            a.clip,
            a.class,
            more(a)
        ));
    }
    Ok(out)
}

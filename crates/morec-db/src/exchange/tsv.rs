//! Tab-separated tables, as `morec train` reads them.

use morec::formats::ParseError;
use morec::labels::{Extent, Labels};

use super::{Annotation, Lengths, ReadLabels, frames, secs};
use crate::labels::State;

pub fn read(bytes: &[u8], lengths: &Lengths) -> Result<ReadLabels, ParseError> {
    let labels = Labels::read(bytes)?;
    // Rows with seconds need no clip to be understood; those with frames need its rate.
    let mut read = ReadLabels { warnings: labels.warnings, ..ReadLabels::default() };
    for row in labels.rows {
        let extent = match (&row.extent, super::length_of(&row.clip, lengths)) {
            (Extent::Secs(start, stop), _) => Some((*start, *stop)),
            (Extent::WholeClip, _) => None,
            (Extent::Frames(_), Some(length)) => Some(length.secs(&row.extent)),
            (Extent::Frames(_), None) => {
                read.warnings.push(super::no_clip(row.line, &row.clip));
                continue;
            }
        };
        read.annotations.push(Annotation {
            clip: row.clip,
            class: row.class,
            extent,
            person: row.person,
            score: None,
            state: State::Accepted,
        });
    }
    Ok(read)
}

pub fn write(annotations: &[Annotation], lengths: &Lengths) -> Result<String, String> {
    let people = annotations.iter().any(|a| a.person.is_some());
    let person = |a: &Annotation| match people {
        true => format!("\t{}", a.person.as_deref().unwrap_or("")),
        false => String::new(),
    };
    let mut out = String::new();
    let last = if people { "\tperson" } else { "" };
    if !annotations.is_empty() && annotations.iter().all(|a| a.extent.is_none()) {
        out.push_str(&format!("clip\tclass{last}\n"));
        for a in annotations {
            out.push_str(&format!("{}\t{}{}\n", a.clip, a.class, person(a)));
        }
        return Ok(out);
    }
    // Whole clips among stretches: they say so, and when they begin and end for whoever does not know the column.
    let mixed = annotations.iter().any(|a| a.extent.is_none());
    let column = if mixed { "\twhole_clip" } else { "" };
    out.push_str(&format!("clip\tstart\tstop\tstart_secs\tstop_secs{column}\tclass{last}\n"));
    for a in annotations {
        let (start, stop) = secs(a, lengths)?;
        let cells = match frames(&Annotation { extent: Some((start, stop)), ..a.clone() }, lengths) {
            Some((from, to)) => format!("{from}\t{to}"),
            None => "\t".to_owned(),
        };
        let whole = match (mixed, a.extent) {
            (false, _) => "",
            (true, None) => "\t1",
            (true, Some(_)) => "\t0",
        };
        out.push_str(&format!("{}\t{cells}\t{start}\t{stop}{whole}\t{}{}\n", a.clip, a.class, person(a)));
    }
    Ok(out)
}

//! ELAN annotation files (EAF 3.0): XML, times in whole milliseconds, tiers of annotations that do not overlap.

use std::collections::BTreeMap;
use std::fmt::Write;

use morec::formats::{ParseError, Place, Warning};
use roxmltree::{Document, Node, ParsingOptions};

use super::annotation::{Annotation, ClipLengths, LabelContext, ReadLabels, secs};
use crate::labels::SampleState;

/// Under this name a header property keeps the clip.
const CLIP: &str = "morec:clip";

/// Under this name a header property keeps the clip's frames a second: times count from its first frame.
const RATE: &str = "morec:rate_hz";

/// Most elements read of one file.
const MOST_NODES: u32 = 4_000_000;

/// Reads an ELAN file. Only the tiers that `context` chooses are read; annotations that refer to others get their times.
///
/// # Errors
/// The XML is invalid, no tier has a chosen name, or the file does not name its clip and `context` does not either.
pub fn read(text: &str, context: &LabelContext) -> Result<ReadLabels, ParseError> {
    let options = ParsingOptions {
        nodes_limit: MOST_NODES,
        ..ParsingOptions::default()
    };
    let document = Document::parse_with_options(text, options).map_err(|error| {
        let at = error.pos();
        let place = Place::Column(at.row.into(), at.col.into());
        ParseError::new(place, "an ELAN file (XML)", error.to_string())
    })?;
    let root = document.root_element();
    let place = |node: Node| {
        let at = document.text_pos_at(node.range().start);
        Place::Column(at.row.into(), at.col.into())
    };
    if !root.has_tag_name("ANNOTATION_DOCUMENT") {
        let found = format!("<{}>", root.tag_name().name());
        return Err(ParseError::new(place(root), "<ANNOTATION_DOCUMENT>", found));
    }
    let clip = match context.clip.map(str::to_owned).or_else(|| clip_of(root)) {
        Some(clip) => clip,
        None => {
            return Err(ParseError::new(
                Place::File,
                "the clip as an option",
                "no media file and no clip given",
            ));
        }
    };
    let elements = |name: &'static str| root.descendants().filter(move |n| n.has_tag_name(name));
    let a_second = units_a_second(root).ok_or_else(|| {
        let found = "another TIME_UNITS".to_owned();
        ParseError::new(place(root), "times in milliseconds or frames", found)
    })?;
    let slots: BTreeMap<&str, f64> = elements("TIME_SLOT")
        .filter_map(|slot| {
            let units = slot.attribute("TIME_VALUE")?.parse::<i64>().ok()?;
            Some((slot.attribute("TIME_SLOT_ID")?, units as f64 / a_second))
        })
        .collect();
    let mut read = ReadLabels::default();
    let ours = own_property(root, CLIP).is_some();
    let ids: Vec<&str> = elements("TIER")
        .filter_map(|tier| tier.attribute("TIER_ID"))
        .collect();
    if let Some(none) = context
        .tiers
        .iter()
        .find(|tier| !ids.contains(&tier.as_str()))
    {
        let found = format!("`{none}`");
        return Err(ParseError::new(
            Place::File,
            format!("one of the tiers {}", ids.join(", ")),
            found,
        ));
    }
    let times: BTreeMap<&str, (f64, f64)> = elements("TIER")
        .flat_map(|tier| times_of(tier, &slots))
        .collect();
    for tier in elements("TIER") {
        let is_chosen = |id: &str| context.tiers.iter().any(|tier| tier == id);
        let chosen = tier.attribute("TIER_ID").is_some_and(is_chosen);
        if !context.tiers.is_empty() && !chosen {
            continue;
        }
        let state = match tier.attribute("TIER_ID").filter(|_| ours) {
            Some(id) => state_of_tier(id),
            None => SampleState::Accepted,
        };
        let person = tier.attribute("PARTICIPANT").filter(|p| !p.is_empty());
        // What hangs on annotations of another tier is read if it is asked for.
        let is_read = |n: &Node| {
            n.has_tag_name("ALIGNABLE_ANNOTATION") || chosen && n.has_tag_name("REF_ANNOTATION")
        };
        for annotation in tier.descendants().filter(is_read) {
            let value = annotation
                .descendants()
                .find(|n| n.has_tag_name("ANNOTATION_VALUE"));
            // Blanks about what somebody typed mean nothing; in what morec wrote they are part of the name.
            let text = value.and_then(|v| v.text()).unwrap_or("");
            let class = if ours { text } else { text.trim() }.to_owned();
            let extent = times_in(annotation, &times);
            if let Some((start, _)) = extent.filter(|(start, stop)| start == stop) {
                let _ = read.stretch(place(annotation), &class, (start, start));
                continue;
            }
            let Some((start, stop)) = extent.filter(|(start, stop)| *start >= 0.0 && stop > start)
            else {
                read.warnings.push(Warning::new(
                    place(annotation),
                    "an annotation without times; left out",
                ));
                continue;
            };
            if class.is_empty() {
                read.warnings.push(Warning::new(
                    place(annotation),
                    "an annotation without a value; left out",
                ));
                continue;
            }
            read.annotations.push(Annotation {
                clip: clip.clone(),
                class,
                extent: Some((start, stop)),
                person: person.map(str::to_owned),
                score: None,
                state,
                annotator: None,
            });
        }
    }
    read.annotations.sort_by(|a, b| {
        a.extent
            .partial_cmp(&b.extent)
            .unwrap_or(std::cmp::Ordering::Equal)
    });
    Ok(read)
}

/// True if the clip stands in the file.
pub fn names_clip(text: &str) -> bool {
    Document::parse(text).is_ok_and(|document| clip_of(document.root_element()).is_some())
}

/// Units of `TIME_VALUE` in a second: ELAN knows milliseconds and frames of two kinds of video.
fn units_a_second(root: Node) -> Option<f64> {
    let header = root.descendants().find(|n| n.has_tag_name("HEADER"));
    let units = header.and_then(|header| header.attribute("TIME_UNITS"));
    match units.unwrap_or("milliseconds") {
        "" | "milliseconds" => Some(1000.0),
        "NTSC-frames" => Some(30_000.0 / 1001.0),
        "PAL-frames" => Some(25.0),
        "PAL-50-frames" => Some(50.0),
        _ => None,
    }
}

/// The times of a tier's annotations by their ids. Between two times that are known, annotations that follow each other without one are
/// equally long, as ELAN shows them.
fn times_of<'a>(tier: Node<'a, '_>, slots: &BTreeMap<&str, f64>) -> Vec<(&'a str, (f64, f64))> {
    let aligned = tier
        .descendants()
        .filter(|n| n.has_tag_name("ALIGNABLE_ANNOTATION"));
    let refs: Vec<(&str, &str, &str)> = aligned
        .filter_map(|n| {
            let of = |name| n.attribute(name);
            Some((
                of("ANNOTATION_ID")?,
                of("TIME_SLOT_REF1")?,
                of("TIME_SLOT_REF2")?,
            ))
        })
        .collect();
    let mut times = Vec::with_capacity(refs.len());
    let mut at = 0;
    while at < refs.len() {
        let chain = refs[at..].windows(2).take_while(|pair| {
            let ends = pair[0].2;
            !slots.contains_key(ends) && ends == pair[1].1
        });
        let count = chain.count() + 1;
        let (first, last) = (refs[at].1, refs[at + count - 1].2);
        if let (Some(&start), Some(&stop)) = (slots.get(first), slots.get(last)) {
            let step = (stop - start) / count as f64;
            let of = |k: usize| start + k as f64 * step;
            let chain = refs[at..at + count].iter().enumerate();
            times.extend(chain.map(|(k, &(id, ..))| {
                let end = if k + 1 == count { stop } else { of(k + 1) };
                (id, (of(k), end))
            }));
        }
        at += count;
    }
    times
}

/// The times of an annotation, or of the one that it refers to: those that divide one between them are equally long.
fn times_in(annotation: Node, times: &BTreeMap<&str, (f64, f64)>) -> Option<(f64, f64)> {
    let id = annotation.attribute("ANNOTATION_ID");
    if let Some(own) = id.and_then(|id| times.get(id)) {
        return Some(*own);
    }
    let parent = annotation.attribute("ANNOTATION_REF")?;
    let &(start, stop) = times.get(parent)?;
    let tier = annotation.ancestors().find(|n| n.has_tag_name("TIER"))?;
    let all = tier
        .descendants()
        .filter(|n| n.attribute("ANNOTATION_REF") == Some(parent));
    let all: Vec<Node> = all.collect();
    let place = all.iter().position(|n| *n == annotation)?;
    let step = (stop - start) / all.len() as f64;
    Some((
        start + place as f64 * step,
        start + (place + 1) as f64 * step,
    ))
}

fn own_property<'a>(root: Node<'a, '_>, name: &str) -> Option<&'a str> {
    let mut properties = root.descendants().filter(|n| n.has_tag_name("PROPERTY"));
    properties
        .find(|n| n.attribute("NAME") == Some(name))
        .and_then(|property| property.text())
}

/// The first word of a tier's name says what is thought of its annotations.
fn state_of_tier(id: &str) -> SampleState {
    let word = id.split(' ').next().unwrap_or_default();
    SampleState::from_name(word).unwrap_or(SampleState::Accepted)
}

fn tier_name(state: SampleState) -> &'static str {
    match state {
        SampleState::Accepted => "motion",
        other => other.name(),
    }
}

/// The property that morec writes, else the stem of the media file.
fn clip_of(root: Node) -> Option<String> {
    if let Some(clip) = own_property(root, CLIP) {
        return Some(clip.to_owned());
    }
    let media = root
        .descendants()
        .find(|n| n.has_tag_name("MEDIA_DESCRIPTOR"))?;
    let name = media.attribute("MEDIA_URL")?.rsplit('/').next()?;
    Some(
        name.rsplit_once('.')
            .map_or(name, |(stem, _)| stem)
            .to_owned(),
    )
}

/// A text as XML has it, in elements and in attributes: readers make spaces of line ends and tabs that are not written
/// as numbers.
fn escaped(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '&' => out.push_str("&amp;"),
            '<' => out.push_str("&lt;"),
            '>' => out.push_str("&gt;"),
            '"' => out.push_str("&quot;"),
            '\n' | '\r' | '\t' => {
                let _ = write!(out, "&#{};", u32::from(c));
            }
            c => out.push(c),
        }
    }
    out
}

/// An error for a text with a character that XML 1.0 does not have (section 2.2).
fn writable(text: &str) -> Result<(), String> {
    let fits = |c: &char| !matches!(c, '\0'..='\x08' | '\x0b' | '\x0c' | '\x0e'..='\x1f' | '\u{fffe}' | '\u{ffff}');
    match text.chars().find(|c| !fits(c)) {
        Some(c) => Err(format!(
            "{text:?}: ELAN files are XML, which cannot hold the character {c:?}"
        )),
        None => Ok(()),
    }
}

/// Writes annotations, all of one clip, as an ELAN file, with a tier for each person and state and for labels that overlap.
///
/// # Errors
/// A text contains characters that XML cannot store, or a label covers a whole clip of unknown length.
pub fn write(annotations: &[Annotation], lengths: &ClipLengths) -> Result<String, String> {
    let mut tiers: Vec<Tier> = Vec::new();
    for a in annotations {
        [Some(&a.clip), Some(&a.class), a.person.as_ref()]
            .into_iter()
            .flatten()
            .try_for_each(|text| writable(text))?;
        let (start, stop) = secs(a, lengths)?;
        let millis = |secs: f64| (secs * 1000.0).round() as i64;
        let (start, stop) = (millis(start), millis(stop).max(millis(start) + 1));
        let free = |tier: &Tier| {
            (tier.person, tier.state) == (a.person.as_deref(), a.state)
                && tier.rows.iter().all(|r| r.1 <= start || r.0 >= stop)
        };
        match tiers.iter_mut().find(|tier| free(tier)) {
            Some(tier) => tier.rows.push((start, stop, &a.class)),
            None => tiers.push(Tier {
                person: a.person.as_deref(),
                state: a.state,
                rows: vec![(start, stop, &a.class)],
            }),
        }
    }
    let clip = annotations.first().map_or("", |a| a.clip.as_str());
    let rate_hz = lengths.get(clip).map(|length| length.rate_hz);
    Ok(document(clip, rate_hz, &tiers))
}

/// Annotations of one person and state that do not overlap: ELAN allows no others in a tier.
struct Tier<'a> {
    person: Option<&'a str>,
    state: SampleState,
    rows: Vec<(i64, i64, &'a str)>,
}

fn document(clip: &str, rate_hz: Option<f64>, tiers: &[Tier<'_>]) -> String {
    let mut slots: Vec<(i64, usize)> = Vec::new();
    let mut body = String::new();
    let mut number = 0;
    for (index, tier) in tiers.iter().enumerate() {
        let name = tier_name(tier.state);
        let id = match tiers[..index]
            .iter()
            .filter(|t| t.state == tier.state)
            .count()
        {
            0 => name.to_owned(),
            before => format!("{name} {}", before + 1),
        };
        let person = tier
            .person
            .map_or_else(String::new, |p| format!(" PARTICIPANT=\"{}\"", escaped(p)));
        let _ = writeln!(
            body,
            "    <TIER LINGUISTIC_TYPE_REF=\"default-lt\"{person} TIER_ID=\"{id}\">"
        );
        for (start, stop, class) in &tier.rows {
            number += 1;
            let (a, b) = (2 * number - 1, 2 * number);
            slots.extend([(*start, a), (*stop, b)]);
            let _ = writeln!(
                body,
                "        <ANNOTATION><ALIGNABLE_ANNOTATION ANNOTATION_ID=\"a{number}\" TIME_SLOT_REF1=\"ts{a}\" \
                 TIME_SLOT_REF2=\"ts{b}\"><ANNOTATION_VALUE>{}</ANNOTATION_VALUE></ALIGNABLE_ANNOTATION></ANNOTATION>",
                escaped(class)
            );
        }
        body.push_str("    </TIER>\n");
    }
    // ELAN has them in the order of their times, whatever tiers they are of.
    slots.sort_unstable();
    let slot = |(millis, id): (i64, usize)| {
        format!("        <TIME_SLOT TIME_SLOT_ID=\"ts{id}\" TIME_VALUE=\"{millis}\"/>\n")
    };
    let slots: String = slots.into_iter().map(slot).collect();
    let rate = rate_hz.map_or_else(String::new, |rate| {
        format!("        <PROPERTY NAME=\"{RATE}\">{rate}</PROPERTY>\n")
    });
    format!(
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n\
         <ANNOTATION_DOCUMENT AUTHOR=\"morec\" DATE=\"1970-01-01T00:00:00+00:00\" FORMAT=\"3.0\" VERSION=\"3.0\" \
         xmlns:xsi=\"http://www.w3.org/2001/XMLSchema-instance\" \
         xsi:noNamespaceSchemaLocation=\"http://www.mpi.nl/tools/elan/EAFv3.0.xsd\">\n    \
         <HEADER MEDIA_FILE=\"\" TIME_UNITS=\"milliseconds\">\n        \
         <PROPERTY NAME=\"{CLIP}\">{}</PROPERTY>\n{rate}        \
         <PROPERTY NAME=\"lastUsedAnnotationId\">{number}</PROPERTY>\n    </HEADER>\n    \
         <TIME_ORDER>\n{slots}    </TIME_ORDER>\n{body}    \
         <LINGUISTIC_TYPE GRAPHIC_REFERENCES=\"false\" LINGUISTIC_TYPE_ID=\"default-lt\" TIME_ALIGNABLE=\"true\"/>\n\
         </ANNOTATION_DOCUMENT>\n",
        escaped(clip)
    )
}

#[cfg(test)]
mod tests;

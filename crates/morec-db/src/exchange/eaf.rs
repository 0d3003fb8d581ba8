//! ELAN annotation files (EAF 3.0): XML, times in whole milliseconds, tiers of annotations that do not overlap.

use std::collections::BTreeMap;
use std::fmt::Write;

use morec::formats::{ParseError, Place, Warning};
use roxmltree::{Document, Node, ParsingOptions};

use super::annotation::{Annotation, ClipLengths, ReadLabels, secs};
use crate::labels::SampleState;

/// Under this name a header property keeps the clip.
const CLIP: &str = "morec:clip";

/// Under this name a header property keeps the clip's frames a second: times count from its first frame.
const RATE: &str = "morec:rate_hz";

/// Most elements read of one file.
const MOST_NODES: u32 = 4_000_000;

pub fn read(text: &str, clip: Option<&str>) -> Result<ReadLabels, ParseError> {
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
    let clip = match clip.map(str::to_owned).or_else(|| clip_of(root)) {
        Some(clip) => clip,
        None => {
            return Err(ParseError::new(
                Place::File,
                "to be given the clip",
                "no media file and no clip given",
            ));
        }
    };
    let elements = |name: &'static str| root.descendants().filter(move |n| n.has_tag_name(name));
    let slots: BTreeMap<&str, Option<f64>> = elements("TIME_SLOT")
        .filter_map(|slot| {
            let millis = slot
                .attribute("TIME_VALUE")
                .and_then(|v| v.parse::<i64>().ok());
            Some((
                slot.attribute("TIME_SLOT_ID")?,
                millis.map(|m| m as f64 / 1000.0),
            ))
        })
        .collect();
    let mut read = ReadLabels::default();
    let ours = own_property(root, CLIP).is_some();
    for tier in elements("TIER") {
        let state = match tier.attribute("TIER_ID").filter(|_| ours) {
            Some(id) => state_of_tier(id),
            None => SampleState::Accepted,
        };
        let person = tier.attribute("PARTICIPANT").filter(|p| !p.is_empty());
        for annotation in tier
            .descendants()
            .filter(|n| n.has_tag_name("ALIGNABLE_ANNOTATION"))
        {
            let slot = |name| {
                annotation
                    .attribute(name)
                    .and_then(|id| slots.get(id))
                    .copied()
                    .flatten()
            };
            let value = annotation
                .descendants()
                .find(|n| n.has_tag_name("ANNOTATION_VALUE"));
            // Blanks about what somebody typed mean nothing; in what morec wrote they are part of the name.
            let text = value.and_then(|v| v.text()).unwrap_or("");
            let class = if ours { text } else { text.trim() }.to_owned();
            let extent = slot("TIME_SLOT_REF1").zip(slot("TIME_SLOT_REF2"));
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

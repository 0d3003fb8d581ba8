//! Text formats with times for one clip: Praat's TextGrid, and subtitles (SubRip, WebVTT).

use morec::formats::{ParseError, Place};

use super::annotation::{Annotation, ReadLabels};

/// True of a TextGrid, long or short.
pub(super) fn is_textgrid(text: &str) -> bool {
    text.lines()
        .take(3)
        .any(|line| line.contains("ooTextFile") || line.contains("\"TextGrid\""))
}

/// True of subtitles: a line has two times with an arrow between them.
pub(super) fn is_subtitles(text: &str) -> bool {
    text.lines().take(40).any(|line| line.contains("-->"))
}

/// Intervals of a TextGrid whose text is not empty; of the tiers of these names, if any are given. Tiers of points hold moments.
pub(super) fn textgrid(text: &str, clip: &str, tiers: &[String]) -> Result<ReadLabels, ParseError> {
    // Both forms have the same values in the same order: the long one has words before them.
    let mut values = values(text).into_iter().peekable();
    let mut read = ReadLabels::default();
    let end = || ParseError::new(Place::File, "a whole TextGrid", "its end within a tier");
    while let Some((_, value)) = values.next() {
        let is_points = match value.as_str() {
            "\"IntervalTier" => false,
            "\"TextTier" => true,
            _ => continue,
        };
        let (_, name) = values.next().ok_or_else(end)?;
        let is_chosen = tiers.is_empty()
            || tiers
                .iter()
                .any(|tier| name.strip_prefix('"') == Some(tier));
        let number = |value: Option<(u64, String)>| -> Result<(u64, f64), ParseError> {
            let (line, value) = value.ok_or_else(end)?;
            let number = value.parse::<f64>().map_err(|_| {
                ParseError::new(Place::Line(line), "a number", value.trim_start_matches('"'))
            })?;
            Ok((line, number))
        };
        let (_, _) = (number(values.next())?, number(values.next())?);
        let (_, count) = number(values.next())?;
        for _ in 0..count.clamp(0.0, 1e7) as usize {
            let (line, start) = number(values.next())?;
            let stop = if is_points {
                start
            } else {
                number(values.next())?.1
            };
            let (_, class) = values.next().ok_or_else(end)?;
            let class = class.strip_prefix('"').unwrap_or(&class).trim();
            if class.is_empty() || !is_chosen {
                continue;
            }
            let extent = read.stretch(Place::Line(line), class, (start, stop));
            let extent = extent.map_err(|found| {
                ParseError::new(Place::Line(line), "an interval with a length", found)
            })?;
            let label = extent.map(|extent| Annotation::accepted(clip, class, extent));
            read.annotations.extend(label);
        }
    }
    Ok(read)
}

/// Numbers, and texts with a quote before them, with their lines; what stands before `=` or in brackets is left out.
fn values(text: &str) -> Vec<(u64, String)> {
    let mut values = Vec::new();
    let mut chars = text.chars().peekable();
    let mut line = 1;
    let mut word = String::new();
    loop {
        let c = chars.next();
        match c {
            Some('"') => {
                let mut quoted = "\"".to_owned();
                while let Some(c) = chars.next() {
                    line += u64::from(c == '\n');
                    match c {
                        // Two quotes are one.
                        '"' if chars.peek() == Some(&'"') => quoted.extend(chars.next()),
                        '"' => break,
                        c => quoted.push(c),
                    }
                }
                values.push((line, quoted));
            }
            Some(c) if !c.is_whitespace() => word.push(c),
            c => {
                let whole = std::mem::take(&mut word);
                if whole.parse::<f64>().is_ok() {
                    values.push((line, whole));
                }
                line += u64::from(c == Some('\n'));
                if c.is_none() {
                    return values;
                }
            }
        }
    }
}

/// Cues of subtitles: `00:00:01,200 --> 00:00:02,400` and the text below.
pub(super) fn subtitles(text: &str, clip: &str) -> Result<ReadLabels, ParseError> {
    let mut read = ReadLabels::default();
    let mut lines = (1..).zip(text.lines());
    while let Some((line, raw)) = lines.next() {
        let Some((start, stop)) = raw.split_once("-->") else {
            continue;
        };
        let error = |found: &str| {
            ParseError::new(
                Place::Line(line),
                "hours:minutes:seconds --> the same",
                found,
            )
        };
        // Settings may stand behind the second time.
        let stop = stop.split_whitespace().next().unwrap_or_default();
        let extent = secs(start.trim())
            .zip(secs(stop))
            .ok_or_else(|| error(raw))?;
        let shown = lines
            .by_ref()
            .map(|(_, text)| text.trim())
            .take_while(|text| !text.is_empty());
        let class = shown.collect::<Vec<&str>>().join(" ");
        if class.is_empty() {
            continue;
        }
        let extent = read
            .stretch(Place::Line(line), &class, extent)
            .map_err(|found| error(&found))?;
        let label = extent.map(|extent| Annotation::accepted(clip, &class, extent));
        read.annotations.extend(label);
    }
    Ok(read)
}

fn secs(clock: &str) -> Option<f64> {
    let parts = clock
        .split(':')
        .map(|part| part.replace(',', ".").parse::<f64>().ok());
    let parts: Vec<f64> = parts.collect::<Option<_>>()?;
    (2..=3)
        .contains(&parts.len())
        .then(|| parts.iter().fold(0.0, |secs, part| 60.0 * secs + part))
}

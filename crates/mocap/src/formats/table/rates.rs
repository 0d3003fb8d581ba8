//! Columns and rows of a table that contain times, frame numbers or rates.

use super::layout::TableLine;
use crate::formats::cells::{Decimal, clock, number};

/// True if the values of a column rise, mostly by the same step: the column then holds times or frame numbers, whatever its name.
pub(super) fn rises_evenly(rows: &[TableLine], column: usize) -> bool {
    const LEAST: usize = 3;
    let value = |(_, cells): &TableLine| {
        let cell = cells.get(column)?;
        number(cell, Decimal::Either).or_else(|| clock(cell))
    };
    let values: Option<Vec<f64>> = rows.iter().map(value).collect();
    let Some(values) = values.filter(|values| values.len() >= LEAST) else {
        return false;
    };
    let steps: Vec<f64> = values.windows(2).map(|w| w[1] - w[0]).collect();
    let mut sorted = steps.clone();
    sorted.sort_unstable_by(f64::total_cmp);
    let usual = sorted[sorted.len() / 2];
    let near = |step: &&f64| (*step - usual).abs() <= 0.25 * usual;
    let rising = steps.iter().filter(|step| **step >= 0.0).count();
    let even = steps.iter().filter(near).count();
    usual > 0.0 && 10 * rising >= 9 * steps.len() && 4 * even >= 3 * steps.len()
}

/// True if a column counts rows one by one.
pub(super) fn counts(rows: &[TableLine], column: usize) -> bool {
    let value = |(_, cells): &TableLine| number(cells.get(column)?, Decimal::Either);
    let values: Vec<f64> = rows.iter().filter_map(value).collect();
    values.windows(2).all(|w| w[1] - w[0] == 1.0)
}

/// The rate that a row above the names states, in whatever words: `# fps: 60`, `Frame Rate,120`, `100,Hz`, `Frame time: 0.01`.
pub(super) fn rate_above(header: &[TableLine]) -> Option<f64> {
    const RATE: &str = "fps framerate samplingrate samplerate capturerate frequency datarate camerarate updaterate framespersecond hz \
        frequenz bildrate abtastrate";
    const STEP: &str = "frametime timestep dt sampletime samplinginterval";
    let (_, above) = header.split_last()?;
    let stated = |cells: &[&str]| {
        let text = cells.join(",").to_lowercase();
        let letters: String = text.chars().filter(|c| c.is_alphabetic()).collect();
        // Without what is a list of words: a value stands beside its key.
        let numbers: Vec<f64> = text
            .split(|c: char| {
                c.is_whitespace() || matches!(c, ',' | ':' | '=' | ';' | '(' | ')' | '[' | ']')
            })
            .filter_map(|word| number(word.trim_end_matches(char::is_alphabetic), Decimal::Point))
            .collect();
        let [value] = numbers[..] else { return None };
        let is_key = |key: &str| match key.len() {
            // Short words stand for themselves.
            ..=3 => text
                .split(|c: char| !c.is_alphabetic())
                .any(|word| word == key),
            _ => letters.contains(key),
        };
        let rate = match () {
            () if RATE.split(' ').any(is_key) => value,
            () if STEP.split(' ').any(is_key) && letters.contains("ms") => 1e3 / value,
            () if STEP.split(' ').any(is_key) => 1.0 / value,
            () => return None,
        };
        (rate > 0.0 && rate < 1e5).then_some(rate)
    };
    // A row of keys and values has a pair of them for each.
    let paired = |cells: &[&str]| {
        let mut pairs = cells
            .windows(2)
            .filter(|pair| pair[0].parse::<f64>().is_err());
        pairs.find_map(stated)
    };
    above
        .iter()
        .find_map(|(_, cells)| stated(cells).or_else(|| paired(cells)))
}

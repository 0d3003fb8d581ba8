//! Words and units of columns that hold no positions.

use super::layout::TableLine;
use crate::formats::cells::is_among;

/// Words behind a name that say that its position is meant.
const POSITION: &str =
    "position positions posi pos translation translate trans location loc coord t";
/// Words that say that something else is meant.
const NO_POSITION: &str = "v gyr gyroscope accelerometer compass axis element mom linacc velo grf cop rotation rot r q quat quaternion euler angle \
    vel velocity acc acceleration force moment orientation error gyro torque power momentum emg mag magnetic magnetometer \
    accel angular omega gravity";

/// True if a word behind a name says that its position is meant.
pub(super) fn is_position(word: &str) -> bool {
    is_among(POSITION, word)
}

/// True if a word in lower case says that something else is meant.
pub(super) fn is_other(word: &str) -> bool {
    is_among(NO_POSITION, word)
}

/// True if a unit is one of angles, speeds, forces or of what sensors measure.
pub(super) fn is_other_unit(unit: &str) -> bool {
    const OTHERS: &str = "deg degree degrees ° rad radians g a.u. n kn nm n.m n*m nmm n.mm v mv uv t ut µt mt gauss %";
    let unit = unit.trim().to_lowercase();
    let per_time = unit.contains("/s") || unit.ends_with("dps");
    per_time || is_among(OTHERS, &unit)
}

/// True for channels of a force plate, `FP1.For` of D-Flow.
pub(super) fn is_plate(name: &str) -> bool {
    let rest = name.strip_prefix("FP").or_else(|| name.strip_prefix("fp"));
    let Some(rest) = rest else { return false };
    let behind = rest.trim_start_matches(|c: char| c.is_ascii_digit());
    behind.len() < rest.len() && behind.starts_with(['.', '_', ' '])
}

/// What stands in brackets in a label.
pub(super) fn unit_in(label: &str) -> Option<&str> {
    let start = label.find(['(', '['])?;
    Some(label[start..].trim_matches(['(', ')', '[', ']']))
}

/// True if most columns have angles, rotations or what sensors measure, by their labels.
pub(super) fn is_turned(labels: &[String]) -> bool {
    let says = |label: &String| {
        let lower = label.to_lowercase();
        let mut parts = lower.split(|c: char| !c.is_alphanumeric());
        parts.any(|part| {
            let bare = part.trim_end_matches(['x', 'y', 'z', 'w', 's']);
            is_other(part) || !bare.is_empty() && is_other(bare)
        }) || ["angle", "flexion", "rotation"]
            .iter()
            .any(|word| lower.contains(word))
            || unit_in(label).is_some_and(is_other_unit)
    };
    let turned = labels.iter().filter(|label| says(label)).count();
    turned > 0 && turned * 2 > labels.len()
}

/// What is measured in place of positions, glued to a name or in a title.
const QUANTITIES: &str = "angle angles velocity velocities acceleration accelerations moment moments force forces power powers winkel";

/// True of what Plug-in Gait and others call angles and loads of joints, `LHipAngles`.
pub(super) fn names_other(name: &str) -> bool {
    let lower = name.to_lowercase();
    let glued = |end: &str| lower.ends_with(end) && lower.len() > end.len();
    QUANTITIES.split(' ').any(glued) && !lower.ends_with("triangle")
}

/// True if a row above the names is a title of angles, speeds or loads, `Joint Angle`.
pub(super) fn says_other_above(header: &[TableLine]) -> bool {
    /// Longer cells are sentences.
    const LONGEST: usize = 40;
    let says = |cell: &&str| {
        let lower = cell.to_lowercase();
        let words: Vec<&str> = lower.split(|c: char| !c.is_alphabetic()).collect();
        let has = |known: &str| words.iter().any(|word| is_among(known, word));
        cell.len() <= LONGEST
            && has(QUANTITIES)
            && !has("position positions marker markers trajectories no without")
    };
    let above = header.split_last().map_or(&[][..], |(_, above)| above);
    // In the row of kinds each column says what it is.
    let titles = above.iter().filter(|(_, cells)| {
        let mut filled = cells
            .iter()
            .filter(|cell| !cell.is_empty() && **cell != "#");
        filled.next().is_some() && filled.next().is_none()
    });
    titles.flat_map(|(_, cells)| cells).any(says)
}

/// True of a name to which a word for something else is glued, `headrot`, `kneeR` before an axis.
pub(super) fn is_glued_other(name: &str) -> bool {
    const LEAST: usize = 3;
    let lower = name.to_lowercase();
    let long = NO_POSITION.split(' ').filter(|word| word.len() >= LEAST);
    let is_channel =
        name.ends_with(['R', 'Q']) && name.chars().nth_back(1).is_some_and(char::is_lowercase);
    is_channel || long.into_iter().any(|word| lower.ends_with(word))
}

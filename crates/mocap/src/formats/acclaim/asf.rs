//! Reads a skeleton (ASF).

use std::collections::HashMap;

use super::skeleton::{AmcChannel, Asf, AsfBone, Root, composed};
use super::text::{AsfLines, keyword, number, quoted, text, tokens};
use crate::formats::{Limits, ParseError, Place, Warning};
use crate::math::{Axis, Quat, Vec3};

/// Reads a skeleton file. O(bytes + joints · depth).
///
/// # Errors
/// No `:bonedata` or `:hierarchy`, a bone without a name, direction or length, a name given twice, a hierarchy
/// that names unknown bones, gives one two parents or closes a loop, or more joints than `limits` allows.
pub fn read_asf(bytes: &[u8], limits: &Limits) -> Result<(Asf, Vec<Warning>), ParseError> {
    let mut reader = AsfReader::new(bytes, limits);
    let mut section = Vec::new();
    while let Some((line, content)) = reader.next()? {
        let first = tokens(content).next().unwrap_or_default();
        if first.starts_with(b":") {
            section = first.to_ascii_lowercase();
        }
        // Sections come in any order, and those that say nothing of a pose (`:version`, `:documentation`, `:skin`) are passed over.
        match section.as_slice() {
            b":units" => reader.unit(line, content)?,
            b":name" => {
                reader.name = tokens(content)
                    .skip(1)
                    .map(text)
                    .collect::<Vec<_>>()
                    .join(" ")
            }
            b":root" => reader.root_line(line, content)?,
            b":bonedata" if first.eq_ignore_ascii_case(b"begin") => reader.bone(line)?,
            b":hierarchy" => reader.hierarchy_line(line, content)?,
            [] => {
                return Err(ParseError::new(
                    Place::Line(line),
                    "`:version` or another keyword",
                    quoted(content),
                ));
            }
            _ => {}
        }
    }
    reader.finish()
}

struct AsfReader<'a> {
    lines: AsfLines<'a>,
    limits: &'a Limits,
    name: String,
    length_unit: f64,
    degrees: bool,
    root_channels: Vec<AmcChannel>,
    root_axes: Vec<Axis>,
    root_position: Vec3,
    root_orientation: Vec3,
    bones: Vec<RawBone>,
    index: HashMap<String, usize>,
    /// Parent and child in the order of the file; the root is [`ROOT`], bone `b` is `b`.
    edges: Vec<(usize, usize)>,
    /// The line that gave each bone its parent.
    placed: Vec<Option<u64>>,
    warnings: Vec<Warning>,
}

const ROOT: usize = usize::MAX;

#[derive(Default)]
struct RawBone {
    name: Option<String>,
    direction: Option<Vec3>,
    length: Option<f64>,
    axis_angles: Vec3,
    axis_order: Vec<Axis>,
    channels: Vec<AmcChannel>,
}

impl<'a> AsfReader<'a> {
    fn new(bytes: &'a [u8], limits: &'a Limits) -> Self {
        use Axis::{X, Y, Z};
        // Without an `order`: places, then angles, as every file of the CMU and HDM05 libraries has them.
        let root_channels = [X, Y, Z]
            .map(AmcChannel::Translation)
            .into_iter()
            .chain([X, Y, Z].map(AmcChannel::Rotation))
            .collect();
        Self {
            lines: AsfLines::new(bytes, limits),
            limits,
            name: String::new(),
            length_unit: 1.0,
            degrees: true,
            root_channels,
            root_axes: Axis::ALL.to_vec(),
            root_position: Vec3::zeros(),
            root_orientation: Vec3::zeros(),
            bones: Vec::new(),
            index: HashMap::new(),
            edges: Vec::new(),
            placed: Vec::new(),
            warnings: Vec::new(),
        }
    }

    fn next(&mut self) -> Result<Option<(u64, &'a [u8])>, ParseError> {
        self.lines.next()
    }

    fn unit(&mut self, line: u64, content: &[u8]) -> Result<(), ParseError> {
        let mut words = tokens(content);
        match keyword(&mut words).as_slice() {
            b"length" => {
                let length = one_number(line, words.next(), "the unit of length")?;
                if length > 0.0 {
                    self.length_unit = length;
                } else {
                    // Lengths may be scaled by anything; nothing would remain of a skeleton scaled by 0.
                    let note = format!("a unit of length of {length} is invalid; 1 is used");
                    self.warnings.push(Warning::new(Place::Line(line), note));
                }
            }
            b"angle" => {
                let unit = words.next().unwrap_or_default();
                self.degrees = match unit.to_ascii_lowercase().as_slice() {
                    unit if unit.starts_with(b"deg") => true,
                    unit if unit.starts_with(b"rad") => false,
                    _ => {
                        return Err(ParseError::new(
                            Place::Line(line),
                            "`deg` or `rad`",
                            quoted(unit),
                        ));
                    }
                };
            }
            _ => {}
        }
        Ok(())
    }

    fn root_line(&mut self, line: u64, content: &[u8]) -> Result<(), ParseError> {
        let mut words = tokens(content);
        match keyword(&mut words).as_slice() {
            b"order" => self.root_channels = channels(line, words)?,
            b"axis" => self.root_axes = axis_order(line, words.next())?,
            b"position" => {
                self.root_position = three_numbers(line, &mut words, "the root's position")?
            }
            b"orientation" => {
                self.root_orientation = three_numbers(line, &mut words, "the root's orientation")?
            }
            _ => {}
        }
        Ok(())
    }

    /// Reads a bone's block, whose `begin` stood on line `begin`.
    fn bone(&mut self, begin: u64) -> Result<(), ParseError> {
        let mut bone = RawBone::default();
        loop {
            let Some((line, content)) = self.next()? else {
                let at = Place::Line(self.lines.number());
                return Err(ParseError::new(
                    at,
                    format!("`end` of the bone begun on line {begin}"),
                    "end of file",
                ));
            };
            let mut words = tokens(content);
            match keyword(&mut words).as_slice() {
                b"end" => break,
                b"begin" => {
                    let expected = format!("`end` of the bone begun on line {begin}");
                    return Err(ParseError::new(
                        Place::Line(line),
                        expected,
                        "another `begin`",
                    ));
                }
                [b':', ..] => {
                    let expected = format!("`end` of the bone begun on line {begin}");
                    return Err(ParseError::new(
                        Place::Line(line),
                        expected,
                        quoted(content),
                    ));
                }
                b"name" => bone.name = words.next().map(|name| text(name).into_owned()),
                b"direction" => {
                    bone.direction = Some(three_numbers(line, &mut words, "a direction")?)
                }
                b"length" => bone.length = Some(one_number(line, words.next(), "a length")?),
                b"axis" => {
                    bone.axis_angles = three_numbers(line, &mut words, "three axis angles")?;
                    bone.axis_order = axis_order(line, words.next())?;
                }
                b"dof" => bone.channels = channels(line, words)?,
                // Identity number, limits, masses: nothing that a pose needs.
                _ => {}
            }
        }
        self.keep(begin, bone)
    }

    fn keep(&mut self, begin: u64, mut bone: RawBone) -> Result<(), ParseError> {
        let at = Place::Line(begin);
        let Some(name) = &bone.name else {
            return Err(ParseError::new(at, "a `name` in the bone's block", "none"));
        };
        let Some(direction) = &mut bone.direction else {
            return Err(ParseError::new(
                at,
                format!("a `direction` of bone {name}"),
                "none",
            ));
        };
        if bone.length.is_none() {
            return Err(ParseError::new(
                at,
                format!("a `length` of bone {name}"),
                "none",
            ));
        }
        let norm = direction.norm();
        // Directions are written with few decimals: a hundredth is rounding. A direction of length 0 is a bone without extent,
        // which end effectors have.
        if norm > 0.0 && (norm - 1.0).abs() > 0.01 {
            *direction /= norm;
            let note = format!("the direction of bone {name} has length {norm}; it was made 1");
            self.warnings.push(Warning::new(at, note));
        }
        // The hierarchy and motions may spell a name in another case.
        let key = name.to_lowercase();
        if key == Asf::ROOT || self.index.contains_key(&key) {
            return Err(ParseError::new(
                at,
                "a name for each bone",
                format!("{name} a second time"),
            ));
        }
        // The root is a joint beside the bones.
        if self.bones.len() + 1 >= self.limits.joints {
            return Err(ParseError::new(
                at,
                format!("at most {} joints", self.limits.joints),
                "more",
            ));
        }
        self.index.insert(key, self.bones.len());
        self.bones.push(bone);
        self.placed.push(None);
        Ok(())
    }

    fn hierarchy_line(&mut self, line: u64, content: &[u8]) -> Result<(), ParseError> {
        let mut words = tokens(content);
        let first = words.next().unwrap_or_default();
        if first.starts_with(b":")
            || first.eq_ignore_ascii_case(b"begin")
            || first.eq_ignore_ascii_case(b"end")
        {
            return Ok(());
        }
        let parent = if first.eq_ignore_ascii_case(b"root") {
            ROOT
        } else {
            self.known(line, first)?
        };
        for word in words {
            let child = self.known(line, word)?;
            if let Some(before) = self.placed[child] {
                let found = format!("{} here and on line {before}", quoted(word));
                return Err(ParseError::new(
                    Place::Line(line),
                    "one parent for each bone",
                    found,
                ));
            }
            self.placed[child] = Some(line);
            self.edges.push((parent, child));
        }
        Ok(())
    }

    fn known(&self, line: u64, name: &[u8]) -> Result<usize, ParseError> {
        self.index
            .get(&text(name).to_lowercase())
            .copied()
            .ok_or_else(|| {
                ParseError::new(Place::Line(line), "a bone of `:bonedata`", quoted(name))
            })
    }

    fn finish(mut self) -> Result<(Asf, Vec<Warning>), ParseError> {
        let at = Place::Line(self.lines.number().max(1));
        if self.bones.is_empty() {
            return Err(ParseError::new(
                at,
                "`:bonedata` with bones",
                "none up to the end of the file",
            ));
        }
        if self.edges.is_empty() {
            return Err(ParseError::new(
                at,
                "`:hierarchy` with bones",
                "none up to the end of the file",
            ));
        }
        let order = self.parents_first()?;
        let mut position_of = vec![None; self.bones.len()];
        let mut bones = Vec::with_capacity(order.len());
        let mut parents = Vec::with_capacity(order.len());
        for (new, &(parent, old)) in order.iter().enumerate() {
            position_of[old] = Some(new);
            parents.push(if parent == ROOT {
                None
            } else {
                position_of[parent]
            });
            bones.push(self.finished(old));
        }
        let orientation = self.rotation(&self.root_axes, self.root_orientation);
        if self.root_position != Vec3::zeros() || self.root_orientation != Vec3::zeros() {
            let note =
                "the root has a preset position or orientation, which is applied to every frame";
            self.warnings.push(Warning::new(Place::File, note));
        }
        let root = Root {
            channels: self.root_channels,
            position: self.root_position,
            orientation,
        };
        let (name, length_unit, degrees) = (self.name, self.length_unit, self.degrees);
        Ok((
            Asf {
                name,
                length_unit,
                degrees,
                root,
                bones,
                parents,
            },
            self.warnings,
        ))
    }

    /// The edges in an order in which every parent has been placed before, as near the file's as can be.
    fn parents_first(&mut self) -> Result<Vec<(usize, usize)>, ParseError> {
        let mut depth = vec![None; self.bones.len()];
        let mut order = Vec::with_capacity(self.edges.len());
        let mut left = std::mem::take(&mut self.edges);
        while !left.is_empty() {
            let before = left.len();
            left.retain(|&(parent, child)| {
                // The root has depth 1. An edge whose parent has no place yet waits for the next pass.
                let parent_depth = if parent == ROOT {
                    Some(1)
                } else {
                    depth[parent]
                };
                depth[child] = parent_depth.map(|d: usize| d + 1);
                if parent_depth.is_some() {
                    order.push((parent, child));
                }
                parent_depth.is_none()
            });
            // A pass that places nothing: a loop, or a limb that hangs on none.
            if left.len() == before {
                let name = self.bones[left[0].1].name.clone().unwrap_or_default();
                let at = Place::Line(self.placed[left[0].1].unwrap_or(1));
                return Err(ParseError::new(
                    at,
                    "bones that hang on the root",
                    format!("{name}, which does not"),
                ));
            }
        }
        if let Some(deep) = depth
            .iter()
            .position(|d| d.is_some_and(|d| d > self.limits.depth))
        {
            let at = Place::Line(self.placed[deep].unwrap_or(1));
            return Err(ParseError::new(
                at,
                format!("a chain of at most {} joints", self.limits.depth),
                "more",
            ));
        }
        for (b, _) in self
            .placed
            .iter()
            .enumerate()
            .filter(|(_, line)| line.is_none())
        {
            let name = self.bones[b].name.as_deref().unwrap_or_default();
            let note = format!("bone {name} is missing from the hierarchy and left out");
            self.warnings.push(Warning::new(Place::File, note));
        }
        Ok(order)
    }

    fn finished(&self, bone: usize) -> AsfBone {
        let raw = &self.bones[bone];
        AsfBone {
            name: raw.name.clone().unwrap_or_default(),
            vector: raw.direction.unwrap_or_else(Vec3::zeros) * raw.length.unwrap_or(0.0),
            axes: self.rotation(&raw.axis_order, raw.axis_angles),
            channels: raw.channels.clone(),
        }
    }

    /// The three angles belong to X, Y and Z, whatever the order in which they are applied.
    fn rotation(&self, order: &[Axis], angles: Vec3) -> Quat {
        let angles = if self.degrees {
            angles.map(f64::to_radians)
        } else {
            angles
        };
        composed(order.iter().map(|&axis| (axis, angles[axis.index()])))
    }
}

fn one_number(line: u64, token: Option<&[u8]>, what: &str) -> Result<f64, ParseError> {
    let token = token.unwrap_or_default();
    number(token).ok_or_else(|| {
        let found = if token.is_empty() {
            "nothing".to_owned()
        } else {
            quoted(token)
        };
        ParseError::new(Place::Line(line), format!("{what}, a number"), found)
    })
}

fn three_numbers<'t>(
    line: u64,
    tokens: &mut impl Iterator<Item = &'t [u8]>,
    what: &str,
) -> Result<Vec3, ParseError> {
    let mut next = || one_number(line, tokens.next(), what);
    Ok(Vec3::new(next()?, next()?, next()?))
}

/// `XYZ` and the like, in any case; XYZ if nothing is said.
fn axis_order(line: u64, token: Option<&[u8]>) -> Result<Vec<Axis>, ParseError> {
    let Some(token) = token else {
        return Ok(Axis::ALL.to_vec());
    };
    let axes: Option<Vec<Axis>> = token
        .iter()
        .map(|&letter| Axis::from_letter(char::from(letter)))
        .collect();
    axes.filter(|axes| axes.len() == 3).ok_or_else(|| {
        ParseError::new(
            Place::Line(line),
            "an order of three axes, like XYZ",
            quoted(token),
        )
    })
}

fn channels<'t>(
    line: u64,
    words: impl Iterator<Item = &'t [u8]>,
) -> Result<Vec<AmcChannel>, ParseError> {
    let mut channels = Vec::new();
    for word in words {
        let channel = AmcChannel::from_token(word).ok_or_else(|| {
            ParseError::new(
                Place::Line(line),
                "tx, ty, tz, rx, ry, rz or l",
                quoted(word),
            )
        })?;
        if channels.contains(&channel) {
            return Err(ParseError::new(
                Place::Line(line),
                "each channel once",
                format!("{} again", quoted(word)),
            ));
        }
        channels.push(channel);
    }
    Ok(channels)
}

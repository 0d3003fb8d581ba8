//! Animations: keyframes and the interpolation between them.

use serde_json::Value;

use super::super::scene::{Local, SceneSkeleton};
use super::super::{Limits, ParseError, Place, Warning};
use super::Beside;
use super::accessor::{Buffers, Numbers};
use super::document::{Document, index};
use crate::math::{Quat, Vec3, slerp};

/// One animation of a file.
pub(super) struct Animation {
    pub(super) name: String,
    pub(super) channels: Vec<GltfChannel>,
}

/// Property that a channel animates.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum TargetPath {
    Translation,
    Rotation,
    Scale,
}

/// Interpolation between two keys.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Between {
    Step,
    Linear,
    CubicSpline,
}

/// Keys of one property of one node.
pub(super) struct GltfChannel {
    node: usize,
    path: TargetPath,
    between: Between,
    /// Seconds, increasing; at least one.
    times: Vec<f64>,
    /// For each time, `path`'s numbers; for cubic splines three times as many: tangent in, value, tangent out.
    values: Vec<f64>,
}

/// A step that comes within this time is there: times are 32-bit floats.
const EPSILON_SECS: f64 = 1e-5;

/// The animations with their channels of nodes; channels that cannot be read are left out with a warning.
pub(super) fn all(
    document: &Document,
    beside: Beside<'_>,
    limits: &Limits,
    warnings: &mut Vec<Warning>,
) -> Result<Vec<Animation>, ParseError> {
    let mut buffers = Buffers::new(document, beside, limits);
    let mut animations = Vec::new();
    for (number, json) in document.list("animations").iter().enumerate() {
        let name = json["name"].as_str().unwrap_or_default().to_owned();
        let mut animation = Animation {
            name,
            channels: Vec::new(),
        };
        let (mut lost, mut why) = (0, None);
        let channels = json["channels"].as_array().map_or(&[][..], Vec::as_slice);
        for channel in channels {
            match read(channel, &json["samplers"], document, &mut buffers) {
                Ok(Some(channel)) => animation.channels.push(channel),
                Ok(None) => {}
                Err(error) if error.is_of_memory() => return Err(error),
                Err(error) => {
                    lost += 1;
                    why.get_or_insert(error);
                }
            }
        }
        if let Some(error) = why {
            // A body needs keys; one channel may belong to any object.
            if document.cut || animation.channels.is_empty() {
                return Err(error);
            }
            let text = format!(
                "animation {number}: {lost} of {} channels cannot be read and are left out: {error}",
                channels.len()
            );
            warnings.push(Warning::new(Place::File, text));
        }
        animations.push(animation);
    }
    Ok(animations)
}

/// A channel of a node's transform; `None` for shapes, extensions and targets that are not there.
fn read(
    channel: &Value,
    samplers: &Value,
    document: &Document,
    buffers: &mut Buffers<'_>,
) -> Result<Option<GltfChannel>, ParseError> {
    let target = &channel["target"];
    let path = match target["path"].as_str() {
        Some("translation") => TargetPath::Translation,
        Some("rotation") => TargetPath::Rotation,
        Some("scale") => TargetPath::Scale,
        _ => return Ok(None),
    };
    let nodes = document.list("nodes").len();
    let Some(node) = index(&target["node"]).filter(|&node| node < nodes) else {
        return Ok(None);
    };
    let missing = |what: &str| ParseError::new(Place::File, what.to_owned(), "none");
    let sampler = index(&channel["sampler"]).and_then(|number| samplers.get(number));
    let sampler = sampler.ok_or_else(|| missing("a sampler of each channel"))?;
    let accessor = |key: &str| index(&sampler[key]).ok_or_else(|| missing("keys of a sampler"));
    let times = buffers.numbers(accessor("input")?, false)?;
    let values = buffers.numbers(accessor("output")?, path == TargetPath::Rotation)?;
    let between = match sampler["interpolation"].as_str() {
        Some("STEP") => Between::Step,
        Some("CUBICSPLINE") => Between::CubicSpline,
        _ => Between::Linear,
    };
    GltfChannel::new(node, path, between, &times, &values)
}

impl GltfChannel {
    /// Keys that have both time and value, in order of time; `None` without any.
    fn new(
        node: usize,
        path: TargetPath,
        between: Between,
        times: &Numbers,
        values: &Numbers,
    ) -> Result<Option<Self>, ParseError> {
        let width = if path == TargetPath::Rotation { 4 } else { 3 };
        if (times.width, values.width) != (1, width) {
            let found = format!("{} and {}", times.width, values.width);
            let expected = format!("1 number for each time and {width} for each value");
            return Err(ParseError::new(Place::File, expected, found));
        }
        let each = match between {
            Between::CubicSpline => 3 * width,
            Between::Step | Between::Linear => width,
        };
        let mut keys: Vec<(f64, &[f64])> = times
            .values
            .iter()
            .copied()
            .zip(values.values.chunks_exact(each))
            .filter(|(time, value)| time.is_finite() && value.iter().all(|v| v.is_finite()))
            .collect();
        keys.sort_by(|a, b| a.0.total_cmp(&b.0));
        if keys.is_empty() {
            return Ok(None);
        }
        Ok(Some(Self {
            node,
            path,
            between,
            times: keys.iter().map(|key| key.0).collect(),
            values: keys.iter().flat_map(|key| key.1).copied().collect(),
        }))
    }

    fn width(&self) -> usize {
        if self.path == TargetPath::Rotation {
            4
        } else {
            3
        }
    }

    /// Without the tangents of a cubic spline.
    fn value(&self, key: usize) -> &[f64] {
        let width = self.width();
        match self.between {
            Between::CubicSpline => self.part(key, 1),
            Between::Step | Between::Linear => &self.values[key * width..][..width],
        }
    }

    /// Of a key of a spline: 0 the tangent in, 1 the value, 2 the tangent out.
    fn part(&self, key: usize, part: usize) -> &[f64] {
        let width = self.width();
        &self.values[(3 * key + part) * width..][..width]
    }

    /// Sets what this channel moves as it is at `time`.
    pub(super) fn apply(&self, time: f64, local: &mut Local) {
        let after = self.times.partition_point(|&t| t <= time);
        let late = self.times.partition_point(|&t| t <= time + EPSILON_SECS);
        let last = self.times.len() - 1;
        if self.between == Between::Step || after == 0 || after > last {
            let key = match self.between {
                Between::Step => late.saturating_sub(1),
                Between::Linear | Between::CubicSpline => after.saturating_sub(1),
            };
            return self.set(self.value(key), local);
        }
        let (a, b) = (after - 1, after);
        let span = self.times[b] - self.times[a];
        let t = (time - self.times[a]) / span;
        if self.between == Between::CubicSpline {
            let spline = self.spline(a, b, t, span);
            return self.set(&spline[..self.width()], local);
        }
        let (a, b) = (self.value(a), self.value(b));
        if self.path == TargetPath::Rotation {
            // A key of zeros is no rotation.
            local.rotation = match (rotation(a), rotation(b)) {
                (Some(a), Some(b)) => slerp(&a, &b, t),
                (a, b) => a.or(b).unwrap_or(local.rotation),
            };
            return;
        }
        let mut mixed = [0.0; 3];
        for k in 0..3 {
            mixed[k] = a[k] + t * (b[k] - a[k]);
        }
        self.set(&mixed, local);
    }

    /// Cubic Hermite spline, appendix C of the specification.
    fn spline(&self, a: usize, b: usize, t: f64, span: f64) -> [f64; 4] {
        let (t2, t3) = (t * t, t * t * t);
        let weights = [
            2.0 * t3 - 3.0 * t2 + 1.0,
            span * (t3 - 2.0 * t2 + t),
            -2.0 * t3 + 3.0 * t2,
            span * (t3 - t2),
        ];
        let parts = [
            self.part(a, 1),
            self.part(a, 2),
            self.part(b, 1),
            self.part(b, 0),
        ];
        let mut value = [0.0; 4];
        for (weight, part) in weights.into_iter().zip(parts) {
            for (value, number) in value.iter_mut().zip(part) {
                *value += weight * number;
            }
        }
        value
    }

    fn set(&self, value: &[f64], local: &mut Local) {
        match self.path {
            TargetPath::Rotation => local.rotation = rotation(value).unwrap_or(local.rotation),
            TargetPath::Translation => local.translation = Vec3::from_column_slice(&value[..3]),
            TargetPath::Scale => local.scale = Vec3::from_column_slice(&value[..3]),
        }
    }
}

/// The rotation of `x y z w`; none of zeros.
pub(super) fn rotation(value: &[f64]) -> Option<Quat> {
    let quaternion = nalgebra::Quaternion::new(value[3], value[0], value[1], value[2]);
    (quaternion.norm() > 1e-6).then(|| Quat::new_normalize(quaternion))
}

impl Animation {
    /// Its name for messages.
    pub(super) fn title(&self) -> String {
        format!("animation `{}`", self.name)
    }

    /// True if a channel moves a joint of `rig` or a node above.
    pub(super) fn moves(&self, rig: &SceneSkeleton) -> bool {
        self.of(rig).next().is_some()
    }

    fn of<'a>(&'a self, rig: &'a SceneSkeleton) -> impl Iterator<Item = &'a GltfChannel> {
        let moves = |channel: &&GltfChannel| rig.moved_by(channel.node);
        self.channels.iter().filter(moves)
    }

    /// The times of all keys that move `rig`.
    pub(super) fn key_times(&self, rig: &SceneSkeleton) -> Vec<f64> {
        self.of(rig)
            .flat_map(|channel| channel.times.iter().copied())
            .collect()
    }

    /// The channels of each node.
    pub(super) fn by_node(&self, nodes: usize) -> Vec<Vec<usize>> {
        let mut by_node = vec![Vec::new(); nodes];
        for (number, channel) in self.channels.iter().enumerate() {
            by_node[channel.node].push(number);
        }
        by_node
    }
}

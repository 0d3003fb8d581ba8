//! Positions in NumPy arrays: `.npy` files of trackers (FreeMoCap, MMPose, motion models) and `.npz` archives that name what
//! they hold, morec's own among them.
//!
//! An array is (frames, points, 3), with a fourth number for how sure a point is, with people before the points, or flat:
//! (frames, 3 × points). Points without names are known by their number.

use std::collections::BTreeMap;

use super::builder::{self, ClipBuilder};
use super::descriptor::{FormatDescriptor, FormatInput};
use super::npy::{self, Array};
use super::points::{BODY_OF_THESE, IN_A_PICTURE, Point, UNSEEN, WITH_HANDS_AND_FACE, check_size};
use super::timing::{Clock, Stamps, TimedPoints};
use super::{Limits, Loaded, ParseError, Place, Warning, container};
use crate::clip::Joint;
use crate::math::{Quat, Vec3, rotation_of_xyzw};
use crate::roles::points::{NUMBERED_HANDS, numbered_counts};

pub(super) const FORMAT: FormatDescriptor = FormatDescriptor {
    name: "numpy",
    title: "positions (NumPy)",
    noun: "a NumPy array",
    endings: &["npy"],
    looks_so: |h| h.bytes.starts_with(b"\x93NUMPY"),
    up: None,
    read: |file| {
        let loaded = read_as(file)?;
        Ok(file.at_rate(loaded))
    },
};

/// Frames a second where nothing says.
const ASSUMED_HZ: f64 = 30.0;
/// More in one array are no people.
const MOST_PEOPLE: usize = 10;

/// Keys of positions, the likeliest first.
const POSITIONS: &str = "positions positions_3d world_positions global_positions joint_positions keypoints_3d keypoints3d joints_3d joints3d joints pose3d poses3d poses_3d pred_joints motion skeleton keypoints pos xyz points";
const NAMES: &str =
    "joint_names names labels keypoint_names joints_names marker_names bodyparts landmark_names";
const TIMES: &str = "times timestamps time timestamp t time_secs times_secs";
const RATE: &str = "sampling_rate sample_rate frequency hz rate_hz fps frame_rate framerate mocap_framerate mocap_frame_rate rate";
/// True if an archive with files of these paths may hold positions and no poses of SMPL.
pub fn has_positions(paths: &[String]) -> bool {
    let has = |key: &str| paths.iter().any(|path| key_of(path) == key);
    POSITIONS.split(' ').any(has) && !super::smpl::has_poses(paths)
}

/// The likeliest key of positions, and of names.
pub(super) const POSITION: &str = "positions";
#[cfg(feature = "hdf5")]
pub(super) const NAME: &str = "joint_names";

/// True of a key of points' names.
pub(super) fn is_name(key: &str) -> bool {
    NAMES.split(' ').any(|known| known == key)
}

/// True of a key of positions, times or a rate.
pub(super) fn is_number(key: &str) -> bool {
    let all = [POSITIONS, TIMES, RATE];
    all.iter()
        .any(|keys| keys.split(' ').any(|known| known == key))
}

fn key_of(path: &str) -> &str {
    path.strip_suffix(".npy").unwrap_or(path)
}

/// Reads an array or an archive: a clip of points called `name`, or, of an archive that morec wrote, of the skeleton. O(bytes).
///
/// # Errors
/// The place and the cause: arrays of another shape or of two dimensions, no frames, more than `limits` allow.
pub fn read(
    bytes: &[u8],
    name: &str,
    rate_hz: Option<f64>,
    limits: &Limits,
) -> Result<Loaded, ParseError> {
    read_as(&FormatInput::alone(bytes, name, rate_hz, limits))
}

fn read_as(file: &FormatInput<'_>) -> Result<Loaded, ParseError> {
    let bytes = file.bytes;
    let mut archive = ArrayArchive::default();
    let mut limits = file.limits.of_packed(bytes.len());
    if bytes.starts_with(b"PK") {
        let wanted = |path: &str| {
            let key = key_of(path);
            SKELETON.contains(&key) || is_name(key) || is_number(key)
        };
        for member in container::unzip(bytes, &wanted, limits.memory)? {
            limits = limits.without(member.bytes.len())?;
            archive.add(key_of(&member.path), &member.bytes, &mut limits)?;
        }
        if let Some(loaded) = skeleton(&archive, file, &limits)? {
            return Ok(loaded);
        }
    } else {
        archive.add(POSITION, bytes, &mut limits)?;
    }
    of_arrays(&archive, file, &limits)
}

/// Reads arrays that are at hand, those of `file`; as [`read`].
pub(super) fn of_arrays(
    archive: &ArrayArchive,
    file: &FormatInput<'_>,
    limits: &Limits,
) -> Result<Loaded, ParseError> {
    let array = archive
        .first(POSITIONS)
        .ok_or_else(|| ParseError::new(Place::File, "an array of positions", "none"))?;
    let shape = PointArray::of(array, file.planar)?;
    let points = shape.points * shape.people;
    check_size(points, shape.frames, file.bytes.len(), limits)?;
    if shape.frames > limits.frames {
        let expected = format!("at most {} frames", limits.frames);
        return Err(ParseError::new(
            Place::File,
            expected,
            shape.frames.to_string(),
        ));
    }
    let mut warnings = Vec::new();
    let names = NAMES.split(' ').find_map(|key| archive.texts.get(key));
    let points = shape.points(array, names.map(Vec::as_slice), &mut warnings);
    let stated = archive
        .first(RATE)
        .and_then(|rate| rate.values.first().copied());
    let clock = Clock {
        given_hz: file.rate_hz,
        stated_hz: stated,
        assumed_hz: ASSUMED_HZ,
    };
    let times = archive
        .first(TIMES)
        .filter(|times| times.values.len() == shape.frames);
    let stamps = match times {
        Some(times) => Stamps::of_values(times.values.iter().copied().map(Some).collect(), None),
        None => Stamps::none(shape.frames),
    };
    TimedPoints::of_any_unit(points, stamps, clock).into_loaded(file.name, warnings, limits)
}

/// Arrays found in an archive.
#[derive(Default)]
pub(super) struct ArrayArchive {
    pub(super) numbers: BTreeMap<String, Array>,
    pub(super) texts: BTreeMap<String, Vec<String>>,
}

impl ArrayArchive {
    /// Adds an array, and takes its memory from `limits`.
    fn add(&mut self, key: &str, bytes: &[u8], limits: &mut Limits) -> Result<(), ParseError> {
        *limits = limits.without(npy::memory(bytes))?;
        if let Some(texts) = npy::texts(bytes) {
            self.texts.insert(key.to_owned(), texts);
            return Ok(());
        }
        let array = npy::read(bytes).map_err(|error| ParseError {
            expected: format!("{} in `{key}`", error.expected),
            found: match npy::is_of_objects(bytes) {
                true => "Python objects (pickle), which can execute code when opened and are not read: save plain \
                    arrays".to_owned(),
                false => error.found.clone(),
            },
            ..error
        })?;
        self.numbers.insert(key.to_owned(), array);
        Ok(())
    }

    fn first(&self, keys: &str) -> Option<&Array> {
        keys.split(' ').find_map(|key| self.numbers.get(key))
    }
}

/// Layout of the points in an array.
struct PointArray {
    frames: usize,
    people: usize,
    points: usize,
    /// Numbers for each point.
    width: usize,
}

impl PointArray {
    fn of(array: &Array, planar: bool) -> Result<Self, ParseError> {
        let known = |numbers: usize| {
            let points = (numbers.is_multiple_of(3)).then_some(numbers / 3)?;
            let fits = numbered_counts()
                .chain(NUMBERED_HANDS)
                .chain(WITH_HANDS_AND_FACE)
                .any(|known| known == points);
            fits.then_some(points)
        };
        let shape = |frames, people, points, width| Self {
            frames,
            people,
            points,
            width,
        };
        let found = match array.shape[..] {
            [1, frames, points, width @ 3..=4] if frames > 1 => shape(frames, 1, points, width),
            [frames, people @ 1..=MOST_PEOPLE, points, width @ 3..=4] => {
                shape(frames, people, points, width)
            }
            [frames, points, width @ 3..=4] => shape(frames, 1, points, width),
            [frames, people @ 1..=MOST_PEOPLE, points, 2] if planar => {
                shape(frames, people, points, 2)
            }
            [frames, points, 2] if planar => shape(frames, 1, points, 2),
            [.., points, 2] if points > 2 => {
                return Err(refuse(array, IN_A_PICTURE));
            }
            [frames, numbers] => match known(numbers) {
                Some(points) => shape(frames, 1, points, 3),
                None => {
                    return Err(refuse(
                        array,
                        "rows of numbers that are no known set of points",
                    ));
                }
            },
            _ => return Err(refuse(array, "another shape")),
        };
        match found.frames * found.points {
            0 => Err(refuse(array, "nothing in it")),
            _ => Ok(found),
        }
    }

    fn points(
        &self,
        array: &Array,
        names: Option<&[String]>,
        warnings: &mut Vec<Warning>,
    ) -> Vec<Point> {
        let Self {
            frames,
            people,
            points,
            width,
        } = *self;
        let names = names.filter(|names| names.len() == points);
        let mut kept = points;
        if names.is_none() && WITH_HANDS_AND_FACE.contains(&points) {
            kept = BODY_OF_THESE;
            let text = format!(
                "{points} points; the first {kept} are read as the body, hands and face are left out"
            );
            warnings.push(Warning::new(Place::File, text));
        }
        let mut all = Vec::with_capacity(people * kept);
        for person in 0..people {
            for point in 0..kept {
                let place = |frame: usize| {
                    let at = ((frame * people + person) * points + point) * width;
                    match &array.values[at..at + width.min(3)] {
                        [x, y, z] => Vec3::new(*x, *y, *z),
                        [x, y] => Vec3::new(*x, *y, 0.0),
                        _ => UNSEEN,
                    }
                };
                let bare = names.map_or_else(|| point.to_string(), |names| names[point].clone());
                all.push(Point {
                    name: if people > 1 {
                        format!("{}:{bare}", person + 1)
                    } else {
                        bare
                    },
                    positions: (0..frames).map(place).collect(),
                });
            }
        }
        all
    }
}

fn refuse(array: &Array, why: &str) -> ParseError {
    let expected = "an array of positions of shape (frames, points, 3)";
    ParseError::new(Place::File, expected, format!("{:?}, {why}", array.shape))
}

/// Keys of the archives that morec writes.
const SKELETON: [&str; 3] = ["rotations", "local_positions", "parents"];

/// The skeleton of an archive that morec wrote; `None` of others, and of a clip of points.
fn skeleton(
    archive: &ArrayArchive,
    file: &FormatInput<'_>,
    limits: &Limits,
) -> Result<Option<Loaded>, ParseError> {
    let numbers = |key: &str| archive.numbers.get(key);
    let (Some(rotations), Some(places), Some(parents), Some(names)) = (
        numbers("rotations"),
        numbers("local_positions"),
        numbers("parents"),
        archive.texts.get("joint_names"),
    ) else {
        return Ok(None);
    };
    let (&[frames, joints, 4], &[_, _, 3]) = (&rotations.shape[..], &places.shape[..]) else {
        return Ok(None);
    };
    let whole = [names.len(), parents.values.len()] == [joints; 2]
        && places.values.len() == 3 * frames * joints;
    if !whole || joints == 0 || joints > limits.joints || frames > limits.frames {
        return Ok(None);
    }
    let joint = |j: usize| Joint {
        name: names[j].clone(),
        parent: (parents.values[j] >= 0.0).then_some(parents.values[j] as usize),
        offset: places
            .values
            .get(3 * j..3 * j + 3)
            .map_or_else(Vec3::zeros, Vec3::from_column_slice),
        tip: None,
    };
    builder::check_size(frames, joints, 0, file.bytes.len(), limits)?;
    let mut builder = ClipBuilder::new((0..joints).map(joint).collect());
    let rows = rotations.values.chunks_exact(4 * joints);
    for (rotations, places) in rows.zip(places.values.chunks_exact(3 * joints)) {
        let turned: Option<Vec<Quat>> = rotations
            .chunks_exact(4)
            .map(|q| rotation_of_xyzw([q[0], q[1], q[2], q[3]]))
            .collect();
        match turned.filter(|_| places.iter().all(|v| v.is_finite())) {
            Some(turned) => {
                builder.push_local(turned, places.chunks_exact(3).map(Vec3::from_column_slice))
            }
            None => builder.push_missing(),
        }
    }
    let stated = archive
        .first(RATE)
        .and_then(|rate| rate.values.first().copied());
    let usable = |rate: &f64| (1e-3..=1e5).contains(rate);
    let rate_hz = file.rate_hz.or(stated.filter(usable)).unwrap_or(ASSUMED_HZ);
    let clip = builder.finish(file.name.to_owned(), rate_hz)?;
    Ok(Some(Loaded {
        clips: vec![clip],
        warnings: Vec::new(),
    }))
}

#[cfg(test)]
mod tests;

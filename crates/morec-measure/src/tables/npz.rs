//! Clips as NumPy archives.

use std::io::{self, Cursor, Write};

use zip::write::{SimpleFileOptions, ZipWriter};

use super::{Features, for_each_frame};
use morec::import::Take;
use morec::roles::Role;

/// Writes `take` as an archive for `numpy.load`, with these arrays (`f` frames, `j` joints, `r` feature rows, `d`
/// values in each):
///
/// | array | shape | holds |
/// |---|---|---|
/// | `positions` | f, j, 3 | world positions, metres, Y up; NaN where a point was not seen |
/// | `rotations` | f, j, 4 | `parent_from_joint`, quaternions x y z w; absent in a clip of points |
/// | `local_positions` | f, j, 3 | positions in the parent's frame, metres; absent in a clip of points |
/// | `joint_names`, `parents` | j | names; the parent's number, −1 for a root |
/// | `role_names`, `role_joints` | [`Role::COUNT`] | the roles, and the joint that plays each, −1 for none |
/// | `features`, `feature_names` | r, d; d | feature rows and their columns; absent where hips are not known |
/// | `rate_hz`, `feature_rate_hz` | | frames and rows a second |
/// | `rest_frames` | 2 | start and stop of the rest pose at the beginning |
/// | `units`, `name`, `format_version` | | `metres, seconds, Y up, right-handed`; the clip's name; 1 |
///
/// # Errors
/// An I/O error of `out`.
pub fn write(take: &Take, out: &mut dyn Write) -> io::Result<()> {
    let Take {
        clip,
        roles,
        report,
        ..
    } = take;
    let (frames, joints) = (clip.frames, clip.skeleton.len());
    let mut archive = Archive(ZipWriter::new(Cursor::new(Vec::new())));
    let mut values: Vec<f32> = Vec::with_capacity(frames * joints * 3);
    for_each_frame(clip, |frame, pose| {
        for (joint, at) in pose.positions.iter().enumerate() {
            match clip.is_gap_at(joint, frame) {
                true => values.extend([f32::NAN; 3]),
                false => values.extend([at.x as f32, at.y as f32, at.z as f32]),
            }
        }
        Ok(())
    })?;
    archive.floats("positions", &[frames, joints, 3], &values)?;
    if clip.has_rotations() {
        let turns = clip.rotations.iter();
        let turns: Vec<f32> = turns
            .flat_map(|q| [q.i, q.j, q.k, q.w].map(|v| v as f32))
            .collect();
        archive.floats("rotations", &[frames, joints, 4], &turns)?;
        values.clear();
        for frame in 0..frames {
            for joint in 0..joints {
                let at = clip.local_position(frame, joint);
                values.extend([at.x as f32, at.y as f32, at.z as f32]);
            }
        }
        archive.floats("local_positions", &[frames, joints, 3], &values)?;
    }
    let all = clip.skeleton.joints();
    let names: Vec<&str> = all.iter().map(|joint| joint.name.as_str()).collect();
    archive.texts("joint_names", &names)?;
    let number = |joint: Option<usize>| joint.and_then(|j| i64::try_from(j).ok()).unwrap_or(-1);
    let parents: Vec<i64> = all.iter().map(|joint| number(joint.parent)).collect();
    archive.integers("parents", &[joints], &parents)?;
    archive.texts("role_names", &Role::ALL.map(Role::name))?;
    let played = Role::ALL.map(|role| number(roles.joint(role)));
    archive.integers("role_joints", &[Role::COUNT], &played)?;
    if let Some(features) = Features::of(take) {
        let shape = [features.rows.len(), features.rows.dim()];
        archive.floats("features", &shape, features.rows.values())?;
        let names: Vec<&str> = features.names.iter().map(String::as_str).collect();
        archive.texts("feature_names", &names)?;
        archive.double("feature_rate_hz", features.rate_hz)?;
    }
    archive.double("rate_hz", clip.rate_hz)?;
    let rest = [report.rest_frames.start, report.rest_frames.end].map(|at| number(Some(at)));
    archive.integers("rest_frames", &[2], &rest)?;
    archive.text("units", "metres, seconds, Y up, right-handed")?;
    archive.text("name", &clip.name)?;
    archive.integers("format_version", &[], &[1])?;
    out.write_all(&archive.0.finish().map_err(io::Error::other)?.into_inner())
}

/// A zip archive of `.npy` files.
struct Archive(ZipWriter<Cursor<Vec<u8>>>);

impl Archive {
    fn add(
        &mut self,
        name: &str,
        kind: &str,
        shape: &[usize],
        bytes: impl Iterator<Item = u8>,
    ) -> io::Result<()> {
        // Archives over 4 GiB need the larger form, which NumPy reads.
        let options = SimpleFileOptions::default().large_file(true);
        self.0
            .start_file(format!("{name}.npy"), options)
            .map_err(io::Error::other)?;
        self.0.write_all(&header(kind, shape))?;
        let bytes: Vec<u8> = bytes.collect();
        self.0.write_all(&bytes)
    }

    fn floats(&mut self, name: &str, shape: &[usize], values: &[f32]) -> io::Result<()> {
        self.add(
            name,
            "<f4",
            shape,
            values.iter().flat_map(|v| v.to_le_bytes()),
        )
    }

    fn double(&mut self, name: &str, value: f64) -> io::Result<()> {
        self.add(name, "<f8", &[], value.to_le_bytes().into_iter())
    }

    fn integers(&mut self, name: &str, shape: &[usize], values: &[i64]) -> io::Result<()> {
        self.add(
            name,
            "<i8",
            shape,
            values.iter().flat_map(|v| v.to_le_bytes()),
        )
    }

    /// An array of text: each name as UTF-32, all of the longest's length.
    fn texts(&mut self, name: &str, texts: &[&str]) -> io::Result<()> {
        let longest = texts.iter().map(|text| text.chars().count()).max();
        let longest = longest.unwrap_or(0).max(1);
        let bytes = texts.iter().flat_map(|text| {
            let letters = text.chars().map(u32::from);
            letters
                .chain(std::iter::repeat(0))
                .take(longest)
                .flat_map(u32::to_le_bytes)
        });
        self.add(name, &format!("<U{longest}"), &[texts.len()], bytes)
    }

    fn text(&mut self, name: &str, text: &str) -> io::Result<()> {
        let length = text.chars().count().max(1);
        let letters = text.chars().map(u32::from).chain(std::iter::repeat(0));
        let bytes = letters.take(length).flat_map(u32::to_le_bytes);
        self.add(name, &format!("<U{length}"), &[], bytes)
    }
}

/// The header of a `.npy` file, version 1.0, after *NEP 1*: padded to 64 bytes.
fn header(kind: &str, shape: &[usize]) -> Vec<u8> {
    let sizes: Vec<String> = shape.iter().map(usize::to_string).collect();
    let shape = match sizes.as_slice() {
        [one] => format!("({one},)"),
        _ => format!("({})", sizes.join(", ")),
    };
    let mut text = format!("{{'descr': '{kind}', 'fortran_order': False, 'shape': {shape}, }}");
    const PREFIX: usize = 10;
    while !(PREFIX + text.len() + 1).is_multiple_of(64) {
        text.push(' ');
    }
    text.push('\n');
    let mut header = b"\x93NUMPY\x01\x00".to_vec();
    // A header holds no names, so that it is short.
    header.extend((text.len() as u16).to_le_bytes());
    header.extend(text.into_bytes());
    header
}

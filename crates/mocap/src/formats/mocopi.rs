//! Recorded packets of Sony's mocopi, one after the other in a file.
//!
//! Boxes of a little-endian length, a four-letter name and a value, some of them nested; after t-34400's
//! *mocopi_protocol_supplement*. `skdf` holds the skeleton, `fram` one frame: for each of 27 bones a quaternion (x, y, z, w)
//! and a position in the parent's frame, metres, Y up.

use super::builder::{ClipBuilder, check_size};
use super::descriptor::FormatDescriptor;
use super::timing::{Clock, Schedule, Stamps};
use super::{Limits, Loaded, ParseError, Place, Warning, keys};
use crate::clip::Joint;
use crate::math::{Axis, Quat, Vec3};
use crate::resample;

pub(super) const FORMAT: FormatDescriptor = FormatDescriptor {
    name: "mocopi",
    title: "mocopi packets",
    noun: "recorded mocopi packets",
    endings: &["mocopi"],
    looks_so: |h| looks_so(h.bytes),
    up: Some(Axis::Y),
    read: |file| Ok(file.at_rate(read(file.bytes, file.name, file.limits)?)),
};

/// Rate if the packets have no times.
const ASSUMED_HZ: f64 = 50.0;

/// Names and parents by bone number, for packets that carry no skeleton.
const BONES: [(&str, Option<u16>); 27] = [
    ("root", None),
    ("torso_1", Some(0)),
    ("torso_2", Some(1)),
    ("torso_3", Some(2)),
    ("torso_4", Some(3)),
    ("torso_5", Some(4)),
    ("torso_6", Some(5)),
    ("torso_7", Some(6)),
    ("neck_1", Some(7)),
    ("neck_2", Some(8)),
    ("head", Some(9)),
    ("l_shoulder", Some(7)),
    ("l_up_arm", Some(11)),
    ("l_low_arm", Some(12)),
    ("l_hand", Some(13)),
    ("r_shoulder", Some(7)),
    ("r_up_arm", Some(15)),
    ("r_low_arm", Some(16)),
    ("r_hand", Some(17)),
    ("l_up_leg", Some(0)),
    ("l_low_leg", Some(19)),
    ("l_foot", Some(20)),
    ("l_toes", Some(21)),
    ("r_up_leg", Some(0)),
    ("r_low_leg", Some(23)),
    ("r_foot", Some(24)),
    ("r_toes", Some(25)),
];

/// True if `bytes` begin with a packet's head.
pub fn looks_so(bytes: &[u8]) -> bool {
    bytes.get(4..8) == Some(b"head") && bytes.get(12..16) == Some(b"ftyp")
}

/// Reads packets: one clip called `name`.
///
/// # Errors
/// The place and the cause: a box that ends behind its parent, no frame, more than `limits` allow. Packets that break off at the end
/// are left out with a warning. O(bytes).
pub fn read(bytes: &[u8], name: &str, limits: &Limits) -> Result<Loaded, ParseError> {
    let mut warnings = Vec::new();
    let mut recording = PacketFile::default();
    if let Err(error) = recording.read(bytes) {
        if recording.frames.is_empty() {
            return Err(error);
        }
        let text = format!("the recording is incomplete: {}", error.found);
        warnings.push(Warning::new(error.at, text));
    }
    if recording.frames.is_empty() {
        let expected = "packets with frames (`fram`) of mocopi";
        let found = "a skeleton without frames";
        return Err(ParseError::new(Place::File, expected, found));
    }
    let bones = match recording.skeleton.take() {
        Some(bones) => bones,
        None => {
            let text = "no packet with the skeleton (`skdf`); mocopi's default skeleton is used";
            warnings.push(Warning::new(Place::File, text));
            usual(&recording.frames[0])
        }
    };
    let (bones, joints) = joints(bones);
    let rate_hz = recording.rate(&mut warnings);
    let stamps = recording.stamps(rate_hz);
    let schedule = Schedule::of(&stamps, &Clock::settled(rate_hz), &mut warnings);
    let frames = schedule.frames(recording.frames.len());
    check_size(frames.len(), joints.len(), 0, bytes.len(), limits)?;
    let mut builder = ClipBuilder::new(joints);
    for frame in frames {
        match frame.and_then(|at| recording.frames[at].in_order(&bones)) {
            Some((rotations, positions)) => builder.push_local(rotations, positions),
            None => builder.push_missing(),
        }
    }
    let clip = builder.finish(name.to_owned(), rate_hz)?;
    Ok(Loaded {
        clips: vec![clip],
        warnings,
    })
}

/// A bone as a skeleton packet has it, or as it is in a frame.
#[derive(Clone, Copy)]
struct MocopiBone {
    id: u16,
    parent: Option<u16>,
    rotation: Quat,
    position: Vec3,
}

#[derive(Default)]
struct MocopiFrame {
    time_secs: Option<f64>,
    number: Option<f64>,
    bones: Vec<MocopiBone>,
}

impl MocopiFrame {
    /// Rotations and positions in the order of `ids`; `None` if one is missing.
    fn in_order(&self, ids: &[u16]) -> Option<(Vec<Quat>, Vec<Vec3>)> {
        let find = |id: &u16| self.bones.iter().find(|bone| bone.id == *id);
        let bones: Option<Vec<&MocopiBone>> = ids.iter().map(find).collect();
        let bones = bones?;
        Some((
            bones.iter().map(|bone| bone.rotation).collect(),
            bones.iter().map(|bone| bone.position).collect(),
        ))
    }
}

#[derive(Default)]
struct PacketFile {
    skeleton: Option<Vec<MocopiBone>>,
    frames: Vec<MocopiFrame>,
}

impl PacketFile {
    fn read(&mut self, bytes: &[u8]) -> Result<(), ParseError> {
        for (name, value, at) in Boxes::of(bytes, 0).collect::<Result<Vec<_>, _>>()? {
            match &name {
                b"skdf" => {
                    let mut bones = Vec::new();
                    read_bones(value, at, *b"bons", *b"bndt", &mut bones)?;
                    if !bones.is_empty() {
                        self.skeleton.get_or_insert(bones);
                    }
                }
                b"fram" => {
                    let mut frame = MocopiFrame::default();
                    for part in Boxes::of(value, at) {
                        let (name, value, _) = part?;
                        let time = value.try_into().map(f64::from_le_bytes);
                        let number = value.try_into().map(u32::from_le_bytes);
                        match (&name, time, number) {
                            (b"uttm", Ok(time), _) => frame.time_secs = Some(time),
                            (b"fnum", _, Ok(number)) => frame.number = Some(f64::from(number)),
                            _ => {}
                        }
                    }
                    read_bones(value, at, *b"btrs", *b"btdt", &mut frame.bones)?;
                    self.frames.push(frame);
                }
                _ => {}
            }
        }
        Ok(())
    }

    fn rate(&self, warnings: &mut Vec<Warning>) -> f64 {
        let step = |pair: &[MocopiFrame]| {
            let secs = pair[1].time_secs? - pair[0].time_secs?;
            // Lost packets lie between numbers, not between frames.
            let frames = pair[1]
                .number
                .zip(pair[0].number)
                .map_or(1.0, |(b, a)| b - a);
            (secs > 0.0 && frames > 0.0).then_some((secs, frames))
        };
        let steps: Vec<(f64, f64)> = self.frames.windows(2).filter_map(step).collect();
        let (secs, frames) = steps
            .iter()
            .fold((0.0, 0.0), |sum, step| (sum.0 + step.0, sum.1 + step.1));
        let numbered = self.frames.iter().all(|frame| frame.number.is_some());
        let each: Vec<f64> = steps.iter().map(|(secs, _)| *secs).collect();
        // The mean, but for pauses where no number tells what was lost.
        let mean = 1.0 / resample::usual_step(&each).unwrap_or(f64::NAN);
        let hz = if numbered { frames / secs } else { mean };
        if !(hz.is_finite() && (1.0..=1000.0).contains(&hz)) {
            let text = format!("no usable times in the packets; {ASSUMED_HZ} Hz assumed");
            warnings.push(Warning::new(Place::File, text));
            return ASSUMED_HZ;
        }
        // Times are taken when packets are made and jitter.
        match keys::usual_near(hz) {
            Some(usual) => usual,
            None => hz,
        }
    }

    /// Numbers of the frames: as packets have them, else by their times where a pause is longer than jitter.
    fn stamps(&self, rate_hz: f64) -> Stamps {
        /// Steps that are a pause.
        const PAUSE: f64 = 2.5;
        let mut at = 0.0;
        let mut before: Option<f64> = None;
        let by_time = self.frames.iter().map(|frame| {
            let steps = frame.time_secs.zip(before).map(|(b, a)| (b - a) * rate_hz);
            let lost = steps.filter(|steps| *steps > PAUSE).map_or(1.0, f64::round);
            at += if before.is_some() { lost } else { 0.0 };
            before = frame.time_secs;
            Some(at)
        });
        let numbers: Vec<Option<f64>> = match self.frames.iter().all(|f| f.number.is_some()) {
            true => self.frames.iter().map(|frame| frame.number).collect(),
            false if self.frames.iter().all(|f| f.time_secs.is_some()) => by_time.collect(),
            false => Vec::new(),
        };
        Stamps::none(self.frames.len()).numbered(numbers)
    }
}

/// The bones in box `list` of `bytes`, each in a box called `each`.
fn read_bones(
    bytes: &[u8],
    begin: u64,
    list: [u8; 4],
    each: [u8; 4],
    bones: &mut Vec<MocopiBone>,
) -> Result<(), ParseError> {
    for part in Boxes::of(bytes, begin) {
        let (name, value, at) = part?;
        if name == list {
            for bone in Boxes::of(value, at) {
                let (name, value, at) = bone?;
                if name == each {
                    bones.extend(read_bone(value, at)?);
                }
            }
        }
    }
    Ok(())
}

/// A bone; `None` of numbers that are no pose.
fn read_bone(bytes: &[u8], begin: u64) -> Result<Option<MocopiBone>, ParseError> {
    let (mut id, mut parent, mut pose) = (None, None, None);
    for part in Boxes::of(bytes, begin) {
        let (name, value, _) = part?;
        let short = || value.try_into().ok().map(u16::from_le_bytes);
        match &name {
            b"bnid" => id = short(),
            b"pbid" => parent = short().filter(|id| *id != u16::MAX),
            b"tran" if value.len() == 28 => {
                let mut numbers = [0.0; 7];
                for (number, bytes) in numbers.iter_mut().zip(value.chunks_exact(4)) {
                    let bytes = [bytes[0], bytes[1], bytes[2], bytes[3]];
                    *number = f64::from(f32::from_le_bytes(bytes));
                }
                pose = Some(numbers);
            }
            _ => {}
        }
    }
    let (Some(id), Some([x, y, z, w, a, b, c])) = (id, pose) else {
        return Ok(None);
    };
    let quaternion = nalgebra::Quaternion::new(w, x, y, z);
    let usable = (0.5..2.0).contains(&quaternion.norm()) && [a, b, c].iter().all(|v| v.is_finite());
    Ok(usable.then(|| MocopiBone {
        id,
        parent,
        rotation: Quat::new_normalize(quaternion),
        position: Vec3::new(a, b, c),
    }))
}

/// The bones of a frame with the parents they always have.
fn usual(frame: &MocopiFrame) -> Vec<MocopiBone> {
    let parent = |id: u16| BONES.get(usize::from(id)).and_then(|bone| bone.1);
    let bones = frame.bones.iter();
    bones
        .map(|bone| MocopiBone {
            parent: parent(bone.id),
            ..*bone
        })
        .collect()
}

/// Bone numbers and joints, parents first; parents that are not there or lead in a circle are dropped.
fn joints(mut bones: Vec<MocopiBone>) -> (Vec<u16>, Vec<Joint>) {
    bones.sort_by_key(|bone| bone.id);
    bones.dedup_by_key(|bone| bone.id);
    let mut ids: Vec<u16> = Vec::new();
    let mut joints = Vec::new();
    while !bones.is_empty() {
        let waits = |bone: &MocopiBone, ids: &[u16]| {
            let there = bone
                .parent
                .is_none_or(|p| ids.contains(&p) || bones.iter().all(|b| b.id != p));
            !there
        };
        let next = bones.iter().position(|b| !waits(b, &ids)).unwrap_or(0);
        let bone = bones.remove(next);
        let parent = bone.parent.and_then(|p| ids.iter().position(|id| *id == p));
        let name = BONES
            .get(usize::from(bone.id))
            .map_or_else(|| format!("bone_{}", bone.id), |known| known.0.to_owned());
        ids.push(bone.id);
        joints.push(Joint {
            name,
            parent,
            offset: bone.position,
            tip: None,
        });
    }
    (ids, joints)
}

/// The boxes of a row of bytes: name, value, and where the value begins in the file.
struct Boxes<'a> {
    rest: &'a [u8],
    at: u64,
}

impl<'a> Boxes<'a> {
    fn of(bytes: &'a [u8], at: u64) -> Self {
        Self { rest: bytes, at }
    }
}

impl<'a> Iterator for Boxes<'a> {
    type Item = Result<([u8; 4], &'a [u8], u64), ParseError>;

    fn next(&mut self) -> Option<Self::Item> {
        if self.rest.is_empty() {
            return None;
        }
        let found = self.rest.len();
        let (Some((length, after)), at) = (self.rest.split_first_chunk(), self.at) else {
            self.rest = &[];
            let error = ParseError::new(Place::Byte(self.at), "a box", format!("{found} bytes"));
            return Some(Err(error));
        };
        let length = u32::from_le_bytes(*length) as usize;
        let (Some((name, after)), true) = (after.split_first_chunk(), found >= 8 + length) else {
            self.rest = &[];
            let expected = format!("a box of {length} bytes");
            let found = format!("{} bytes before the end", found.saturating_sub(8));
            return Some(Err(ParseError::new(Place::Byte(at), expected, found)));
        };
        let (value, rest) = after.split_at(length);
        self.rest = rest;
        self.at += 8 + length as u64;
        Some(Ok((*name, value, at + 8)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::formats::mangle;
    use crate::import::{ImportOptions, normalize};

    fn boxed(name: &[u8; 4], value: &[u8]) -> Vec<u8> {
        [&(value.len() as u32).to_le_bytes(), &name[..], value].concat()
    }

    /// A packet of two bones, the second one turned by `w`'s angle.
    fn frame(time: f64, second: [f32; 7]) -> Vec<u8> {
        let bone = |id: u16, numbers: [f32; 7]| {
            let numbers: Vec<u8> = numbers.iter().flat_map(|v| v.to_le_bytes()).collect();
            let id = boxed(b"bnid", &id.to_le_bytes());
            boxed(b"btdt", &[id, boxed(b"tran", &numbers)].concat())
        };
        let first = bone(0, [0.0, 0.0, 0.0, 1.0, 0.0, 0.9, 0.0]);
        let bones = boxed(b"btrs", &[first, bone(1, second)].concat());
        let head = boxed(b"head", &boxed(b"ftyp", b"sony motion format"));
        let time = boxed(b"uttm", &time.to_le_bytes());
        [head, boxed(b"fram", &[time, bones].concat())].concat()
    }

    #[test]
    fn packets_are_frames() {
        let packets: Vec<u8> = (0..4)
            .flat_map(|k| frame(0.02 * k as f64, [0.0, 0.0, 0.6, 0.8, 0.0, 0.1, 0.0]))
            .collect();
        assert!(looks_so(&packets));
        let loaded = read(&packets, "f", &Limits::default()).unwrap();
        let clip = &loaded.clips[0];
        assert_eq!((clip.frames, clip.rate_hz), (4, 50.0));
        assert_eq!(clip.skeleton.joints()[1].name, "torso_1");
        let turned = Quat::new_normalize(nalgebra::Quaternion::new(0.8, 0.0, 0.0, 0.6));
        assert!(clip.frame_rotations(2)[1].angle_to(&turned) < 1e-6);
        let cut = read(&packets[..packets.len() - 3], "f", &Limits::default());
        assert!(cut.is_err() || cut.unwrap().clips[0].frames == 3);
        mangle::each(&packets, 300, |bytes| {
            if let Ok(loaded) = read(bytes, "f", &Limits::default()) {
                mangle::check(&loaded);
            }
        });
    }

    #[test]
    fn packets_that_were_lost_are_gaps() {
        let turned = [0.0, 0.0, 0.6, 0.8, 0.0, 0.1, 0.0];
        let numbered = |number: u32| {
            let packet = frame(0.02 * f64::from(number), turned);
            let (head, body) = packet.split_at(packet.len() - inner(&packet));
            let number = boxed(b"fnum", &number.to_le_bytes());
            let body = [&number, body].concat();
            let head = &head[..head.len() - 8];
            [head, &boxed(b"fram", &body)].concat()
        };
        for lost in [[0, 1, 2, 6, 7], [0, 2, 1, 6, 7]] {
            let packets: Vec<u8> = lost.into_iter().flat_map(numbered).collect();
            let loaded = read(&packets, "f", &Limits::default()).unwrap();
            let clip = &loaded.clips[0];
            assert_eq!((clip.frames, clip.rate_hz), (8, 50.0), "{lost:?}");
            assert_eq!(clip.repaired, [3..6]);
        }
        // Without numbers, pauses in the times tell.
        let times = [0.0, 0.02, 0.041, 0.12, 0.14];
        let packets: Vec<u8> = times.iter().flat_map(|time| frame(*time, turned)).collect();
        let loaded = read(&packets, "f", &Limits::default()).unwrap();
        assert_eq!((loaded.clips[0].frames, loaded.clips[0].rate_hz), (8, 50.0));
    }

    /// Bytes within the last box of a packet.
    fn inner(packet: &[u8]) -> usize {
        let (_, _, at) = Boxes::of(packet, 0).filter_map(Result::ok).last().unwrap();
        packet.len() - at as usize
    }

    #[test]
    fn real_packets_are_a_person() {
        let (Some(skeleton), Some(frame)) = (
            mangle::real("mocopi_skeleton.bin"),
            mangle::real("mocopi_frame.bin"),
        ) else {
            return;
        };
        let error = read(&skeleton, "f", &Limits::default()).unwrap_err();
        assert!(error.found.contains("without frames"), "{error}");
        let alone = read(&frame, "f", &Limits::default()).unwrap();
        let both = read(&[skeleton, frame].concat(), "f", &Limits::default()).unwrap();
        assert_eq!(
            alone.clips[0].skeleton, both.clips[0].skeleton,
            "the usual skeleton is the real one"
        );
        assert_eq!(alone.warnings.len(), 2);
        let imported = normalize(
            both.clips.into_iter().next().unwrap(),
            &ImportOptions::default(),
        )
        .unwrap();
        assert_eq!(imported.roles.missing().count(), 0);
        assert_eq!(imported.report.unit, Some("m"));
    }
}

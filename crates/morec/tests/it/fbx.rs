//! The same motion as BVH and as FBX: the same detections, whatever axes and unit the scene states.

use std::fmt::Write;

use morec::clip::Clip;
use morec::files::FileReader;
use morec::formats::bvh;
use morec::import::Take;
use morec::live::{Detection, recognize_clip};
use morec::math::{Axis, Quat, Vec3};
use morec::synth::{DatabaseSpec, database};

use crate::made;

/// Units of time of FBX in a second.
const TICKS: f64 = 46_186_158_000.0;

/// Angles about X, Y and Z, the first applied first, in degrees.
fn euler_xyz(rotation: &Quat) -> [f64; 3] {
    let (x, y, z) = rotation.euler_angles();
    [x, y, z].map(f64::to_degrees)
}

struct Scene {
    objects: String,
    connections: String,
    next: usize,
}

impl Scene {
    fn id(&mut self) -> usize {
        self.next += 1;
        self.next
    }

    /// Curves of a property of `model`, in layer 2: three values for each frame.
    fn curves(&mut self, model: usize, property: &str, values: &[[f64; 3]], rate_hz: f64) {
        let node = self.id();
        writeln!(
            self.objects,
            "AnimationCurveNode: {node}, \"AnimCurveNode::C\", \"\" {{\n}}"
        )
        .unwrap();
        writeln!(
            self.connections,
            "C: \"OO\",{node},2\nC: \"OP\",{node},{model}, \"{property}\""
        )
        .unwrap();
        let count = values.len();
        let times: Vec<String> = (0..count)
            .map(|frame| format!("{:.0}", frame as f64 / rate_hz * TICKS))
            .collect();
        for (axis, letter) in ["X", "Y", "Z"].iter().enumerate() {
            let curve = self.id();
            let values: Vec<String> = values.iter().map(|v| format!("{:.6}", v[axis])).collect();
            writeln!(
                self.objects,
                "AnimationCurve: {curve}, \"AnimCurve::\", \"\" {{\nDefault: 0\nKeyVer: 4008\nKeyTime: *{count} {{\na: {}\n}}\n\
                 KeyValueFloat: *{count} {{\na: {}\n}}\nKeyAttrFlags: *1 {{\na: 4\n}}\nKeyAttrDataFloat: *4 {{\na: 0,0,0,0\n}}\n\
                 KeyAttrRefCount: *1 {{\na: {count}\n}}\n}}",
                times.join(","),
                values.join(",")
            )
            .unwrap();
            writeln!(self.connections, "C: \"OP\",{curve},{node}, \"d|{letter}\"").unwrap();
        }
    }
}

/// `clip` (metres, Y up) as a text file of FBX 7.4 whose settings state `up` (1 for Y, 2 for Z) and `unit_cm`.
fn fbx_of(clip: &Clip, up: usize, unit_cm: f64) -> String {
    let scale = 100.0 / unit_cm;
    let turn = match up {
        2 => Axis::X.rotation(90f64.to_radians()),
        _ => Quat::identity(),
    };
    let mut scene = Scene {
        objects: String::new(),
        connections: String::new(),
        next: 1000,
    };
    for (j, joint) in clip.skeleton.joints().iter().enumerate() {
        let (model, attribute) = (100 + j, 500 + j);
        let name = &joint.name;
        let at = joint.offset * scale;
        writeln!(
            scene.objects,
            "NodeAttribute: {attribute}, \"NodeAttribute::{name}\", \"LimbNode\" {{\nTypeFlags: \"Skeleton\"\n}}\n\
             Model: {model}, \"Model::{name}\", \"LimbNode\" {{\nVersion: 232\nProperties70:  {{\n\
             P: \"Lcl Translation\", \"Lcl Translation\", \"\", \"A\",{},{},{}\n}}\n}}",
            at.x, at.y, at.z
        )
        .unwrap();
        let parent = joint.parent.map_or(0, |parent| 100 + parent);
        writeln!(
            scene.connections,
            "C: \"OO\",{attribute},{model}\nC: \"OO\",{model},{parent}"
        )
        .unwrap();
        let is_root = joint.parent.is_none();
        let turns: Vec<[f64; 3]> = (0..clip.frames)
            .map(|frame| {
                let own = clip.frame_rotations(frame)[j];
                euler_xyz(&if is_root { turn * own } else { own })
            })
            .collect();
        scene.curves(model, "Lcl Rotation", &turns, clip.rate_hz);
        if let Some(track) = clip.track(j) {
            let place = |at: &Vec3| -> [f64; 3] {
                let at = if is_root { turn * at } else { *at };
                (at * scale).into()
            };
            let places: Vec<[f64; 3]> = track.positions.iter().map(place).collect();
            scene.curves(model, "Lcl Translation", &places, clip.rate_hz);
        }
    }
    let end = (clip.frames - 1) as f64 / clip.rate_hz * TICKS;
    format!(
        "; FBX 7.4.0 project file\nFBXHeaderExtension:  {{\nFBXHeaderVersion: 1003\nFBXVersion: 7400\n}}\nGlobalSettings:  {{\n\
         Version: 1000\nProperties70:  {{\nP: \"UpAxis\", \"int\", \"Integer\", \"\",{up}\nP: \"UpAxisSign\", \"int\", \"Integer\", \"\",1\n\
         P: \"FrontAxis\", \"int\", \"Integer\", \"\",{front}\nP: \"FrontAxisSign\", \"int\", \"Integer\", \"\",{front_sign}\n\
         P: \"CoordAxis\", \"int\", \"Integer\", \"\",0\nP: \"CoordAxisSign\", \"int\", \"Integer\", \"\",1\n\
         P: \"UnitScaleFactor\", \"double\", \"Number\", \"\",{unit_cm}\nP: \"TimeMode\", \"enum\", \"\", \"\",6\n}}\n}}\n\
         Objects:  {{\n{objects}AnimationStack: 1, \"AnimStack::Take 001\", \"\" {{\nProperties70:  {{\n\
         P: \"LocalStop\", \"KTime\", \"Time\", \"\",{end:.0}\nP: \"ReferenceStop\", \"KTime\", \"Time\", \"\",{end:.0}\n}}\n}}\n\
         AnimationLayer: 2, \"AnimLayer::Base\", \"\" {{\n}}\n}}\nConnections:  {{\nC: \"OO\",2,1\n{connections}}}\n",
        front = 3 - up,
        front_sign = if up == 2 { -1 } else { 1 },
        objects = scene.objects,
        connections = scene.connections,
    )
}

fn recognised(take: &Take) -> Vec<Detection> {
    recognize_clip(
        &made::model(),
        &take.clip,
        &take.roles,
        &take.report.rest_frames,
    )
    .unwrap()
}

#[test]
fn fbx_and_bvh_of_one_motion_give_the_same_detections() {
    let spec = DatabaseSpec {
        people: 1,
        repetitions: 2,
        rate_hz: 30.0,
        ..DatabaseSpec::default()
    };
    let clip = database(4, &spec).remove(0).clip;
    let read = |name: &str, bytes: &[u8]| {
        let file = FileReader::default().parse(name.as_ref(), bytes).unwrap();
        file.into_takes(&FileReader::default().import)
            .unwrap()
            .remove(0)
    };
    let mut bytes = Vec::new();
    bvh::write(&clip, &mut bytes).unwrap();
    let expected = recognised(&read("take.bvh", &bytes));
    assert!(expected.len() >= 5, "{} detections", expected.len());
    for (up, unit_cm, axis, unit) in [
        (1, 1.0, "y", "cm"),
        (2, 1.0, "z", "cm"),
        (1, 100.0, "y", "m"),
        (2, 2.54, "z", "inch"),
    ] {
        let take = read("take.fbx", fbx_of(&clip, up, unit_cm).as_bytes());
        assert_eq!(
            (take.clip.frames, take.clip.rate_hz),
            (clip.frames, clip.rate_hz),
            "{unit}"
        );
        assert_eq!(take.report.up.to_string(), axis, "{unit}");
        assert_eq!(take.report.unit, Some(unit));
        let found = recognised(&take);
        assert_eq!(found.len(), expected.len(), "{up} {unit}");
        for (found, expected) in found.iter().zip(&expected) {
            assert_eq!(found.class, expected.class, "{up} {unit}");
            assert!(found.span.is_near(expected.span, 0.05), "{up} {unit}");
        }
    }
}

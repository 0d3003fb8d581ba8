use super::*;
use crate::import::{ImportOptions, Take, normalize};
use crate::kinematics::WorldPose;
use crate::math::{Axis, Quat, Vec3};
use crate::testing::pushing;
use serde_json::{Value, json};
use std::io;

/// Floats in a buffer of a data address, with the accessors that lie on it.
#[derive(Default)]
struct Keys {
    bytes: Vec<u8>,
    views: Vec<Value>,
    accessors: Vec<Value>,
}

impl Keys {
    fn add(&mut self, kind: &str, width: usize, values: &[f32]) -> usize {
        self.views
            .push(json!({"buffer": 0, "byteOffset": self.bytes.len()}));
        self.bytes
            .extend(values.iter().flat_map(|v| v.to_le_bytes()));
        self.accessors.push(json!({
            "bufferView": self.views.len() - 1, "componentType": 5126,
            "count": values.len() / width, "type": kind,
        }));
        self.accessors.len() - 1
    }

    fn file(&self, mut rest: Value) -> Vec<u8> {
        let text = base64::Engine::encode(&base64::engine::general_purpose::STANDARD, &self.bytes);
        rest["buffers"] = json!([{"uri": format!("data:application/octet-stream;base64,{text}")}]);
        rest["bufferViews"] = self.views.clone().into();
        rest["accessors"] = self.accessors.clone().into();
        rest.to_string().into_bytes()
    }
}

fn open(bytes: &[u8]) -> Result<Loaded, ParseError> {
    read(
        bytes,
        "f",
        &|_| Err(io::ErrorKind::NotFound.into()),
        &Limits::default(),
    )
}

fn quat(q: Quat) -> [f32; 4] {
    [q.i, q.j, q.k, q.w].map(|v| v as f32)
}

/// Three joints in a row under a node of scale 100, the middle one turned about X.
fn bent(interpolation: &str, keys: &mut Keys) -> Value {
    let times: Vec<f32> = (0..31).map(|k| k as f32 / 30.0).collect();
    let value = |k: usize| quat(Axis::X.rotation(0.02 * k as f64));
    let values: Vec<f32> = (0..31)
        .flat_map(|k| match interpolation {
            "CUBICSPLINE" => [[0.0; 4], value(k), [0.0; 4]].concat(),
            _ => value(k).to_vec(),
        })
        .collect();
    let input = keys.add("SCALAR", 1, &times);
    let output = keys.add("VEC4", 4, &values);
    json!({
        "nodes": [
            {"name": "Armature", "scale": [100, 100, 100], "children": [1]},
            {"name": "a", "translation": [0, 0.01, 0], "children": [2]},
            {"name": "b", "translation": [0, 0.02, 0], "children": [3]},
            {"name": "c", "translation": [0, 0.03, 0]},
        ],
        "skins": [{"joints": [1, 2, 3]}],
        "animations": [{
            "name": "bend",
            "channels": [{"sampler": 0, "target": {"node": 2, "path": "rotation"}}],
            "samplers": [{"input": input, "output": output, "interpolation": interpolation}],
        }],
    })
}

#[test]
fn every_interpolation_meets_its_keys() {
    for interpolation in ["LINEAR", "STEP", "CUBICSPLINE"] {
        let mut keys = Keys::default();
        let json = bent(interpolation, &mut keys);
        let loaded = open(&keys.file(json)).unwrap();
        let clip = &loaded.clips[0];
        assert_eq!((clip.frames, clip.rate_hz), (31, 30.0));
        assert_eq!(clip.name, "f");
        for frame in 0..31 {
            let turn = Axis::X.rotation(0.02 * frame as f64);
            let pose = WorldPose::of(clip, frame);
            let end = Vec3::new(0.0, 3.0, 0.0) + turn * Vec3::new(0.0, 3.0, 0.0);
            assert!((pose.positions[2] - end).norm() < 1e-4, "{interpolation}");
            assert!(pose.rotations[2].angle_to(&turn) < 1e-4);
        }
    }
}

#[test]
fn splines_follow_the_specification_between_keys() {
    let mut keys = Keys::default();
    // From 0 with slope 1 to 2 with slope 0, in 2 s, on Y.
    let (t, z) = ([0.0, 2.0], [0.0f32; 3]);
    let values = [z, z, [0.0, 1.0, 0.0], z, [0.0, 2.0, 0.0], z].concat();
    let (input, output) = (keys.add("SCALAR", 1, &t), keys.add("VEC3", 3, &values));
    let file = keys.file(json!({
        "nodes": [{"name": "a"}],
        "animations": [{
            "channels": [{"sampler": 0, "target": {"node": 0, "path": "translation"}}],
            "samplers": [{"input": input, "output": output, "interpolation": "CUBICSPLINE"}],
        }],
    }));
    let clip = open(&file).unwrap().clips.remove(0);
    assert_eq!((clip.frames, clip.rate_hz), (61, 30.0));
    for frame in [0, 7, 30, 60] {
        let t = frame as f64 / 60.0;
        let expected = 2.0 * (t * t * t - 2.0 * t * t + t) + 2.0 * (3.0 * t * t - 2.0 * t * t * t);
        assert!((clip.local_position(frame, 0).y - expected).abs() < 1e-6);
    }
}

#[test]
fn animations_and_skeletons_are_clips() {
    let mut keys = Keys::default();
    let mut json = bent("LINEAR", &mut keys);
    let mut second = json["animations"][0].clone();
    second["name"] = "again".into();
    json["animations"].as_array_mut().unwrap().push(second);
    json["animations"]
        .as_array_mut()
        .unwrap()
        .push(json!({"name": "still"}));
    let loaded = open(&keys.file(json)).unwrap();
    let names: Vec<&str> = loaded.clips.iter().map(|c| c.name.as_str()).collect();
    assert_eq!(names, ["f#bend", "f#again"]);
    assert!(
        loaded
            .warnings
            .iter()
            .any(|w| w.text.contains("`still` moves no joint"))
    );
}

#[test]
fn sparse_and_integer_keys() {
    let mut keys = Keys::default();
    let mut json = bent("LINEAR", &mut keys);
    let place = keys.bytes.len();
    keys.bytes.extend([3u8, 0, 5, 0]);
    let value = keys.bytes.len();
    for short in [0, 0, 32767, 0].repeat(2) {
        keys.bytes.extend(i16::to_le_bytes(short));
    }
    keys.views.push(json!({"buffer": 0, "byteOffset": place}));
    keys.views.push(json!({"buffer": 0, "byteOffset": value}));
    keys.accessors.push(json!({
        "componentType": 5122, "count": 31, "type": "VEC4",
        "sparse": {"count": 2, "indices": {"bufferView": 2, "componentType": 5123}, "values": {"bufferView": 3}},
    }));
    json["animations"][0]["samplers"][0]["output"] = 2.into();
    let clip = open(&keys.file(json)).unwrap().clips.remove(0);
    assert!(clip.frame_rotations(3)[1].angle_to(&Axis::Z.rotation(std::f64::consts::PI)) < 1e-6);
}

#[test]
fn humanoids_have_their_bone_names() {
    for extension in [
        json!({"VRMC_vrm_animation": {"humanoid": {"humanBones": {"hips": {"node": 1}, "spine": {"node": 2}}}}}),
        json!({"VRM": {"humanoid": {"humanBones": [{"bone": "hips", "node": 1}, {"bone": "spine", "node": 2}]}}}),
    ] {
        let mut keys = Keys::default();
        let mut json = bent("LINEAR", &mut keys);
        json["extensions"] = extension;
        let clip = open(&keys.file(json)).unwrap().clips.remove(0);
        let names: Vec<&str> = clip.skeleton.names().collect();
        assert_eq!(names, ["hips", "spine", "c"]);
    }
}

#[test]
fn what_cannot_be_read_is_said_plainly() {
    let error = |json: Value| open(json.to_string().as_bytes()).unwrap_err().to_string();
    let model = json!({"asset": {}, "nodes": [{}], "extensions": {"VRM": {"humanoid": {"humanBones": [{"bone": "hips", "node": 0}]}}}});
    assert!(
        error(model).contains("VRM 0.x, a model with a skeleton of 1 joints, without animation")
    );
    assert!(error(json!({"asset": {}, "meshes": []})).contains("glTF 2.0, a model without"));
    assert!(error(json!({"asset": {}, "nodes": {}})).contains("glTF 1.0"));
    assert!(
        open(b"glTF\x01\0\0\0")
            .unwrap_err()
            .found
            .contains("binary glTF 1")
    );
    let mut keys = Keys::default();
    let mut json = bent("LINEAR", &mut keys);
    json["animations"][0]["samplers"][0]["output"] = 9.into();
    assert!(
        open(&keys.file(json))
            .unwrap_err()
            .expected
            .contains("accessor 9")
    );
    let mut file =
        serde_json::from_slice::<Value>(&keys.file(bent("LINEAR", &mut Keys::default()))).unwrap();
    file["buffers"][0]["uri"] = "far%20away.bin".into();
    assert!(error(file.clone()).contains("no file far away.bin"));
    let beside = |name: &str| match name {
        "far away.bin" => Ok(keys.bytes.clone()),
        _ => Err(io::ErrorKind::NotFound.into()),
    };
    assert!(
        read(
            file.to_string().as_bytes(),
            "f",
            &beside,
            &Limits::default()
        )
        .is_ok()
    );
}

#[test]
fn a_year_between_two_keys_is_refused() {
    let mut keys = Keys::default();
    let (input, output) = (
        keys.add("SCALAR", 1, &[0.0, 3e7]),
        keys.add("VEC3", 3, &[0.0; 6]),
    );
    let file = keys.file(json!({
        "nodes": [{"name": "a"}],
        "animations": [{
            "channels": [{"sampler": 0, "target": {"node": 0, "path": "translation"}}],
            "samplers": [{"input": input, "output": output}],
        }],
    }));
    assert!(open(&file).unwrap_err().expected.contains("at most"));
}

#[test]
fn circles_of_nodes_end() {
    let mut keys = Keys::default();
    let mut json = bent("LINEAR", &mut keys);
    json["nodes"][3]["children"] = json!([0, 3]);
    let clip = open(&keys.file(json)).unwrap().clips.remove(0);
    assert_eq!(clip.skeleton.len(), 3);
}

#[test]
fn cut_and_altered_files_never_panic() {
    let mut keys = Keys::default();
    let json = bent("CUBICSPLINE", &mut keys);
    crate::formats::mangle::each(&keys.file(json), 300, |bytes| {
        if let Ok(loaded) = open(bytes) {
            crate::formats::mangle::check(&loaded);
        }
    });
    if let Some(bytes) = crate::formats::mangle::real("three_vrm_test.vrma") {
        crate::formats::mangle::each(&bytes, 300, |bytes| {
            if let Ok(loaded) = open(bytes) {
                crate::formats::mangle::check(&loaded);
            }
        });
    }
}

#[test]
fn real_vrm_animations_are_people() {
    let Some(bytes) = crate::formats::mangle::real("idle_loop.vrma") else {
        return;
    };
    let loaded = open(&bytes).unwrap();
    assert!(loaded.warnings.is_empty(), "{:?}", loaded.warnings);
    let clip = loaded.clips.into_iter().next().unwrap();
    let imported = normalize(clip, &ImportOptions::default()).unwrap();
    assert_eq!(imported.report.unit, Some("m"));
    assert_eq!(imported.report.up.to_string(), "y");
    assert_eq!(imported.roles.missing().count(), 0);
    assert_eq!(
        (imported.clip.frames, imported.clip.rate_hz.round()),
        (250, 24.0)
    );
    let bytes = crate::formats::mangle::real("three_vrm_test.vrma").unwrap();
    let clip = open(&bytes).unwrap().clips.remove(0);
    assert_eq!(clip.skeleton.len(), 51);
    let imported = normalize(clip, &ImportOptions::default()).unwrap();
    assert_eq!(
        (imported.report.unit, imported.roles.missing().count()),
        (Some("m"), 0)
    );
}

#[test]
fn joints_are_where_an_independent_reader_has_them() {
    let Some(bytes) = crate::formats::mangle::real("idle_loop.vrma") else {
        return;
    };
    let golden: Value =
        serde_json::from_str(include_str!("../../../testdata/reference/gltf.json")).unwrap();
    let clip = open(&bytes).unwrap().clips.remove(0);
    for (k, frame) in golden["frames"].as_array().unwrap().iter().enumerate() {
        let pose = WorldPose::of(&clip, frame.as_u64().unwrap() as usize);
        for (bone, places) in golden["positions"].as_object().unwrap() {
            // A node of this file is called `head` too; the humanoid bone is its child.
            let joints = clip.skeleton.joints();
            let joint = joints.iter().rposition(|j| j.name == *bone).unwrap();
            let place = document::numbers::<3>(&places[k]).map(Vec3::from).unwrap();
            // 10⁻⁴ of a body of 1.4 m.
            let off = (pose.positions[joint] - place).norm();
            assert!(off < 1.4e-4, "{bone} {off}");
        }
    }
}

#[test]
fn clips_survive_the_way_through_bvh() {
    use crate::formats::bvh;
    for interpolation in ["LINEAR", "STEP", "CUBICSPLINE"] {
        let mut keys = Keys::default();
        let json = bent(interpolation, &mut keys);
        let clip = open(&keys.file(json)).unwrap().clips.remove(0);
        let mut text = Vec::new();
        bvh::write(&clip, &mut text).unwrap();
        let options = bvh::BvhOptions::default();
        let again = bvh::read(&text, "f", &options, &Limits::default()).unwrap();
        for frame in [0, 11, 30] {
            let (a, b) = (
                WorldPose::of(&clip, frame),
                WorldPose::of(&again.clips[0], frame),
            );
            for (a, b) in a.positions.iter().zip(&b.positions) {
                assert!((a - b).norm() < 1e-5, "{a} {b}");
            }
        }
    }
}

#[test]
fn what_is_written_is_read_back() {
    let imported = Take::new(pushing()).unwrap();
    let mut bytes = Vec::new();
    write(&imported.clip, &mut bytes).unwrap();
    let loaded = open(&bytes).unwrap();
    assert!(loaded.warnings.is_empty(), "{:?}", loaded.warnings);
    let clip = &loaded.clips[0];
    assert_eq!(
        (clip.frames, clip.rate_hz.round()),
        (imported.clip.frames, 30.0)
    );
    assert_eq!(clip.skeleton.len(), imported.clip.skeleton.len());
    for frame in [0, clip.frames / 2, clip.frames - 1] {
        let (a, b) = (
            WorldPose::of(clip, frame),
            WorldPose::of(&imported.clip, frame),
        );
        for (joint, place) in imported.clip.skeleton.joints().iter().zip(&b.positions) {
            let read = clip.skeleton.find(&joint.name).unwrap();
            assert!((a.positions[read] - place).norm() < 1e-5, "{}", joint.name);
        }
    }
}

#[test]
fn vrm_animations_hold_the_humanoid_and_rest_in_a_t_pose() {
    let imported = Take::new(pushing()).unwrap();
    let mut bytes = Vec::new();
    write_vrma(&imported.clip, &imported.roles, &mut bytes).unwrap();
    let again = Take::new(open(&bytes).unwrap().clips.remove(0)).unwrap();
    assert_eq!(
        (again.report.unit, again.report.up.to_string().as_str()),
        (Some("m"), "y")
    );
    assert_eq!(again.clip.frames, imported.clip.frames);
    for role in crate::roles::Role::ALL {
        assert_eq!(
            again.roles.joint(role).is_some(),
            imported.roles.joint(role).is_some(),
            "{role}"
        );
        let (Some(a), Some(b)) = (again.roles.joint(role), imported.roles.joint(role)) else {
            continue;
        };
        let frame = imported.clip.frames / 2;
        let read = WorldPose::of(&again.clip, frame).positions[a];
        let place = WorldPose::of(&imported.clip, frame).positions[b];
        assert!((read - place).norm() < 1e-3, "{role}: {read} {place}");
    }
    // At rest, as the nodes say.
    let document = Document::parse(&bytes, &Limits::default(), &mut Vec::new()).unwrap();
    let stage = GltfScene::of(&document, &Limits::default(), &mut Vec::new()).unwrap();
    let mut world: Vec<(String, Vec3, Quat)> = Vec::new();
    let nodes = document.json["nodes"].as_array().unwrap().clone();
    let mut left: Vec<(usize, Vec3, Quat)> = vec![(0, Vec3::zeros(), Quat::identity())];
    while let Some((node, at, turn)) = left.pop() {
        let rest = &stage.nodes[node].rest;
        let (at, turn) = (at + turn * rest.translation, turn * rest.rotation);
        world.push((nodes[node]["name"].as_str().unwrap().to_owned(), at, turn));
        for child in nodes[node]["children"].as_array().into_iter().flatten() {
            left.push((child.as_u64().unwrap() as usize, at, turn));
        }
    }
    let at = |name: &str| world.iter().find(|(n, ..)| n == name).unwrap().1;
    let along = |a: &str, b: &str| (at(b) - at(a)).normalize();
    assert!(along("leftUpperArm", "leftHand").x > 0.999);
    assert!(along("rightUpperArm", "rightHand").x < -0.999);
    assert!(along("leftUpperLeg", "leftFoot").y < -0.99);
    assert!(along("rightUpperLeg", "leftUpperLeg").x > 0.99);
    assert!(along("hips", "head").y > 0.95);
}

//! Hands: the guide's senders on recorded joints, an index of another kind of performer, words about hands.

use std::process::Command;

use morec::math::Vec3;
use serde_json::{Value, json};

use crate::kit::{Folder, data, skipped};

const GUIDE: &str = include_str!("../../../../docs/guide/hands.md");
const INDEX: &[u8] = include_bytes!("../../../morec/testdata/index/v1.index");

/// The script of a chapter of the guide.
fn script(chapter: &str) -> String {
    let chapter = GUIDE.split(&format!("## {chapter}\n")).nth(1).unwrap();
    let block = chapter.split("```python\n").nth(1).unwrap();
    block.split("```").next().unwrap().to_owned()
}

/// A hand that opens and closes while it goes from side to side, metres: wrist, palm, then each finger from base to tip.
fn hand(is_left: bool, secs: f64) -> Vec<Vec3> {
    let side = if is_left { -1.0 } else { 1.0 };
    let bend = 0.4 + 0.3 * (4.0 * secs).sin();
    let way = Vec3::new(0.1 * (3.0 * secs).sin(), 0.2, 0.02 * secs.cos());
    let mut points = vec![way, way + Vec3::new(0.0, 0.0, 0.05)];
    for finger in 0..5 {
        let start = if finger == 0 { 0.03 } else { 0.09 };
        let mut at = way + Vec3::new((2.5 - f64::from(finger)) * 0.02 * side, 0.0, start);
        for joint in 1..=4 {
            points.push(at);
            let turned = bend * f64::from(joint);
            at += Vec3::new(0.0, -turned.sin(), turned.cos()) * 0.026;
        }
    }
    points
}

/// Two seconds of it at 30 Hz, as lists of `[x, y, z]`.
fn recorded(is_left: bool) -> Vec<Vec<[f64; 3]>> {
    let frame = |f: u32| {
        hand(is_left, f64::from(f) / 30.0)
            .into_iter()
            .map(Into::into)
            .collect()
    };
    (0..60).map(frame).collect()
}

/// Stand-ins for the packages of the devices, which play `recorded.json`: for each frame the points of the left and of the right hand.
const STAND_INS: [(&str, &str); 8] = [
    (
        "cv2.py",
        "COLOR_BGR2RGB = 0\n\
         class VideoCapture:\n    def __init__(self, n): self.n = 0\n    def read(self):\n        self.n += 1\n        return self.n <= 60, self.n - 1\n\
         def cvtColor(picture, kind): return picture\n",
    ),
    (
        "mediapipe/__init__.py",
        "class ImageFormat: SRGB = 0\nclass Image:\n    def __init__(self, image_format, data): self.data = data\n",
    ),
    ("mediapipe/tasks/__init__.py", ""),
    (
        "mediapipe/tasks/python/__init__.py",
        "class BaseOptions:\n    def __init__(self, model_asset_path): assert model_asset_path\n",
    ),
    (
        "mediapipe/tasks/python/vision.py",
        "import json, types\nP = types.SimpleNamespace\nFRAMES = json.load(open('recorded.json'))\n\
         class RunningMode: VIDEO = 1\nclass HandLandmarkerOptions:\n    def __init__(self, **given): assert given['num_hands'] == 1\n\
         class HandLandmarker:\n    @staticmethod\n    def create_from_options(options): return HandLandmarker()\n    def detect_for_video(self, image, ms):\n        \
         _, hand = FRAMES[image.data]\n        marks = [P(x=x, y=-y, z=-z) for x, y, z in hand[:1] + hand[2:]]\n        \
         return P(hand_world_landmarks=[marks], hand_landmarks=[], handedness=[])\n",
    ),
    (
        "leap.py",
        "import json, os, types\nP = types.SimpleNamespace\nFRAMES = json.load(open('recorded.json'))\n\
         class Listener: pass\n\
         def hand(kind, points):\n    at = [P(x=1000 * x, y=1000 * y, z=1000 * z) for x, y, z in points]\n    digits = []\n    \
         for f in range(5):\n        a, b, c, d = at[2 + 4 * f:6 + 4 * f]\n        bone = lambda p, n: P(prev_joint=p, next_joint=n)\n        \
         digits.append(P(bones=[bone(at[0], a), bone(a, b), bone(b, c), bone(c, d)]))\n    \
         return P(type='HandType.' + kind, arm=P(next_joint=at[0]), digits=digits)\n\
         class Connection:\n    def add_listener(self, listener): self.listener = listener\n    def open(self): return self\n    \
         def __enter__(self):\n        for n, (left, right) in enumerate(FRAMES):\n            \
         self.listener.on_tracking_event(P(timestamp=round(n * 1e6 / 30), hands=[hand('Left', left), hand('Right', right)]))\n        os._exit(0)\n    \
         def __exit__(self, *of): pass\n",
    ),
    (
        "xr/__init__.py",
        "import ctypes, json\nFRAMES = json.load(open('recorded.json'))\nKHR_OPENGL_ENABLE_EXTENSION_NAME = EXT_HAND_TRACKING_EXTENSION_NAME = ''\n\
         class Vector3f(ctypes.Structure): _fields_ = [(a, ctypes.c_float) for a in 'xyz']\n\
         class Posef(ctypes.Structure): _fields_ = [('orientation', ctypes.c_float * 4), ('position', Vector3f)]\n\
         class HandJointLocationEXT(ctypes.Structure): _fields_ = [('location_flags', ctypes.c_uint64), ('pose', Posef), ('radius', ctypes.c_float)]\n\
         class HandJointLocationsEXT(ctypes.Structure):\n    _fields_ = [('is_active', ctypes.c_uint32), ('at', ctypes.POINTER(HandJointLocationEXT))]\n    \
         def __init__(self, joint_locations): super().__init__(0, ctypes.cast(joint_locations, ctypes.POINTER(HandJointLocationEXT)))\n\
         class HandJointsLocateInfoEXT:\n    def __init__(self, base_space, time): self.time = time\n\
         class InstanceCreateInfo:\n    def __init__(self, enabled_extension_names): pass\n\
         class HandEXT: LEFT, RIGHT = 0, 1\nclass HandTrackerCreateInfoEXT:\n    def __init__(self, hand): self.hand = hand\n\
         def create_hand_tracker_ext(session, info): return info.hand\n\
         def locate(tracker, where, found):\n    found = found._obj\n    wrist, palm, *fingers = FRAMES[where.time * 30 // 10**9][tracker]\n    \
         places = [palm, wrist] + fingers[:4]\n    \
         for f in range(1, 5): places += [palm] + fingers[4 * f:4 * f + 4]\n    \
         for joint, (x, y, z) in zip(range(26), places): found.at[joint].pose.position = Vector3f(x, y, z)\n    found.is_active = 1\n    return 0\n\
         PFN_xrLocateHandJointsEXT = None\ndef get_instance_proc_addr(instance, name): return locate\ndef check_result(result): assert result == 0\n\
         ctypes.cast = (lambda cast: lambda value, kind: cast(value, kind) if kind else value)(ctypes.cast)\n",
    ),
    (
        "xr/utils/gl/__init__.py",
        "import types\nclass ContextObject:\n    instance = session = space = None\n    def __init__(self, context_provider, instance_create_info): pass\n    \
         def __enter__(self): return self\n    def __exit__(self, *of): pass\n    \
         def frame_loop(self):\n        for n in range(60): yield types.SimpleNamespace(predicted_display_time=n * 10**9 // 30 + 1000)\n",
    ),
];

/// The lines that a script of the guide sends.
fn sent_by(chapter: &str, args: &[&str]) -> Option<String> {
    let frames: Vec<Value> = recorded(true)
        .into_iter()
        .zip(recorded(false))
        .map(|(left, right)| json!([left, right]))
        .collect();
    let folder = Folder::with(&STAND_INS);
    let write = |name: &str, text: &str| std::fs::write(folder.path().join(name), text).unwrap();
    write("recorded.json", &Value::from(frames).to_string());
    write("xr/utils/__init__.py", "");
    write(
        "xr/utils/gl/glfw_util.py",
        "class GLFWOffscreenContextProvider: pass\n",
    );
    let receiver = std::net::TcpListener::bind("127.0.0.1:0").unwrap();
    let port = receiver.local_addr().unwrap().port().to_string();
    // Frames come as fast as they are read: their numbers tell the time.
    let script = script(chapter).replace("time.monotonic()", "read[1] / 30");
    write("script.py", &script.replace("9000", &port));
    let mut python = Command::new("python3");
    python
        .arg("script.py")
        .args(args)
        .current_dir(folder.path());
    let by_tcp = args.is_empty();
    let receiving = by_tcp.then(|| {
        std::thread::spawn(move || {
            let mut text = String::new();
            let (mut stream, _) = receiver.accept().unwrap();
            std::io::Read::read_to_string(&mut stream, &mut text).unwrap();
            text
        })
    });
    let Ok(ran) = python.output() else {
        skipped("hands: no python3");
        return None;
    };
    assert!(
        ran.status.success(),
        "{}",
        String::from_utf8_lossy(&ran.stderr)
    );
    Some(match receiving {
        Some(thread) => thread.join().unwrap(),
        None => String::from_utf8(ran.stdout).unwrap(),
    })
}

/// What `inspect` says of lines, and `live` with an index of bodies.
fn said_of(lines: &str) -> (String, String) {
    let folder = Folder::with(&[("hands.jsonl", lines)]);
    std::fs::write(folder.path().join("v1.index"), INDEX).unwrap();
    let seen = folder.morec(&["inspect", "hands.jsonl"]);
    assert_eq!(seen.code, Some(0), "{seen:?}");
    let live = folder.morec_fed(
        &["live", "v1.index", "--listen", "json:-"],
        Some("hands.jsonl"),
    );
    (seen.out, live.err)
}

#[test]
fn the_guides_senders_send_hands() {
    for (chapter, args, performers) in [
        ("A webcam, by MediaPipe", &["model.task"][..], 1),
        ("Ultraleap (Leap Motion)", &[], 2),
        ("OpenXR", &[], 2),
    ] {
        let Some(lines) = sent_by(chapter, args) else {
            return;
        };
        assert_eq!(lines.lines().count(), 60 * performers, "{chapter}");
        let (seen, live) = said_of(&lines);
        assert!(seen.contains("21 of 21 (right hand)"), "{chapter}: {seen}");
        assert_eq!(
            seen.contains("21 of 21 (left hand)"),
            performers == 2,
            "{chapter}: {seen}"
        );
        for wrong in ["warning", "error", "note"] {
            assert!(!seen.contains(wrong), "{chapter}: {seen}");
        }
        assert!(!live.contains("malformed"), "{chapter}: {live}");
        assert!(
            live.contains("this index recognises a body, but the input shows a hand"),
            "{chapter}: {live}"
        );
    }
}

#[test]
fn an_index_of_bodies_refuses_a_clip_of_a_hand() {
    let line = |(frame, points): (usize, Vec<[f64; 3]>)| {
        let points: Vec<_> = points.iter().take(1).chain(&points[2..]).collect();
        json!({"t": frame as f64 / 30.0, "hand": "right", "points": points}).to_string() + "\n"
    };
    let lines: String = recorded(false).into_iter().enumerate().map(line).collect();
    let folder = Folder::with(&[("hand.jsonl", &lines)]);
    std::fs::write(folder.path().join("v1.index"), INDEX).unwrap();
    for layout in [&[][..], &["--layout", "pinned"]] {
        let ran = folder.morec(&[&["recognize", "v1.index", "hand.jsonl"], layout].concat());
        assert_eq!(ran.code, Some(1), "{ran:?}");
        assert!(
            ran.err
                .contains("this index recognises a body, but the input shows a hand"),
            "{ran:?}"
        );
    }
    let drawn = folder.morec(&["inspect", "hand.jsonl", "--draw"]);
    let dots = |c: char| ('\u{2801}'..='\u{28FF}').contains(&c);
    assert!(
        drawn.out.contains("from the front") && drawn.out.chars().filter(|c| dots(*c)).count() > 30,
        "{drawn:?}"
    );
}

/// Lines made of clips are recognised by an index that others taught.
#[test]
fn gestures_of_real_hands_are_recognised_in_lines() {
    let Some(hands) = data().map(|data| data.join("hands")) else {
        return;
    };
    if !hands.is_dir() {
        return skipped("no hands among the motion data");
    }
    let folder = Folder::with(&[]);
    let labels = std::fs::read_to_string(hands.join("labels.tsv")).unwrap();
    let header = labels.lines().next().unwrap();
    let of = |numbers: std::ops::Range<usize>| -> Vec<String> {
        numbers.map(|number| format!("train_{number:03}")).collect()
    };
    let (taught, kept) = (of(1..13), of(16..18));
    let rows = |clips: &[String]| -> Vec<&str> {
        let is_of = |row: &&str| {
            clips
                .iter()
                .any(|clip| row.split('\t').any(|cell| cell.starts_with(clip.as_str())))
        };
        labels.lines().skip(1).filter(is_of).collect()
    };
    std::fs::create_dir(folder.path().join("clips")).unwrap();
    for clip in taught.iter().chain(&kept) {
        let name = format!("{clip}.npz");
        std::fs::copy(
            hands.join("clips").join(&name),
            folder.path().join("clips").join(&name),
        )
        .unwrap();
    }
    let table = [&[header][..], &rows(&taught)].concat().join("\n") + "\n";
    std::fs::write(folder.path().join("labels.tsv"), table).unwrap();
    folder.train("signs.index", &[]).ok();
    for clip in &kept {
        let ran = folder.morec(&[
            "convert",
            &format!("clips/{clip}.npz"),
            "-o",
            &format!("{clip}.jsonl"),
        ]);
        assert_eq!(ran.code, Some(0), "{ran:?}");
        let found = folder.morec(&["recognize", "signs.index", &format!("clips/{clip}.npz")]);
        let classes = |out: &str, column: &str| -> Vec<String> {
            let mut lines = out.lines();
            let at = lines
                .next()
                .unwrap()
                .split('\t')
                .position(|cell| cell == column)
                .unwrap();
            lines
                .map(|line| line.split('\t').nth(at).unwrap().to_owned())
                .collect()
        };
        let of_clip = classes(&found.out, "class");
        assert!(!of_clip.is_empty(), "{found:?}");
        let fed = folder.morec_fed(
            &[
                "live",
                "signs.index",
                "--listen",
                "json:-",
                "--emit",
                "json:-",
            ],
            Some(&format!("{clip}.jsonl")),
        );
        let events = fed
            .out
            .lines()
            .map(|line| serde_json::from_str::<Value>(line).unwrap());
        let ended = events.filter(|event| event["phase"] == "end");
        let of_lines: Vec<String> = ended
            .map(|event| event["class"].as_str().unwrap().to_owned())
            .collect();
        assert_eq!(of_lines, of_clip, "{clip}: {fed:?}");
    }
}

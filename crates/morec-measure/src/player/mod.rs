//! Clips that play in a page of HTML which stands alone: a skeleton to turn and zoom, a timeline to scrub, and the labels and
//! detections of each clip below it.
//!
//! Positions are stored as 16-bit differences from the clip's middle, in millimetres or, where somebody goes further than 32 m, in
//! as coarse a unit as that needs, at most 30 frames a second, and drawn on a canvas by a script in the page; nothing is fetched from anywhere.

use std::path::Path;

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use serde_json::json;

use morec::TimeSpan;
use morec::clip::Clip;
use morec::features::{ALL_BONES, Bone, BoneKind, Hand, Profile};
use morec::kinematics::WorldPose;
use morec::labels::Mark;
use morec::math::Vec3;
use morec::roles::{Role, RoleMap};

/// A clip with what is known of it.
#[derive(Debug, Clone)]
pub struct PlayedClip<'a> {
    /// The motion, in metres and Y up.
    pub clip: &'a Clip,
    /// The joint of each role.
    pub roles: &'a RoleMap,
    /// Another motion of the same skeleton, drawn a step to its left.
    pub beside: Option<&'a Clip>,
    /// The stretch to show; `None` for the whole clip.
    pub span: Option<TimeSpan>,
    /// Labels of the clip.
    pub labels: Vec<Mark>,
    /// Detections in the clip.
    pub detections: Vec<Mark>,
    /// A video of the same motion, which the page plays in step.
    pub video: Option<PlayedVideo>,
}

/// A video beside a clip. The page names its file and does not hold it.
#[derive(Debug, Clone, PartialEq)]
pub struct PlayedVideo {
    /// Address of the file, as seen from the page.
    pub address: String,
    /// Time of the video at which the clip begins, seconds; negative if the clip begins first.
    pub offset_secs: f64,
}

impl PlayedVideo {
    /// The video `file`, as seen from a page in `folder`; both are absolute paths.
    pub fn of(folder: &Path, file: &Path, offset_secs: f64) -> Self {
        let from: Vec<_> = folder.components().collect();
        let to: Vec<_> = file.components().collect();
        let shared = from.iter().zip(&to).take_while(|(a, b)| a == b).count();
        let up = from[shared..].iter().map(|_| "..".to_owned());
        let down = to[shared..].iter();
        let down = down.map(|part| percent_encoded(&part.as_os_str().to_string_lossy()));
        Self {
            address: up.chain(down).collect::<Vec<_>>().join("/"),
            offset_secs,
        }
    }
}

/// A part of a path as a part of an address.
fn percent_encoded(text: &str) -> String {
    let plain = |b: u8| b.is_ascii_alphanumeric() || b"-._~".contains(&b);
    let encoded = text.bytes().map(|b| match plain(b) {
        true => char::from(b).to_string(),
        false => format!("%{b:02X}"),
    });
    encoded.collect()
}

/// Motions of one skeleton stand this far apart.
const BESIDE_METRES: f64 = 1.2;

/// Frames a second at most.
const RATE_HZ: f64 = 30.0;

const SCRIPT: &str = include_str!("player.js");
const STYLE: &str = include_str!("player.css");
const PAGE_STYLE: &str = "\
:root { color-scheme: light dark; --ink: #222; --ground: #fff; }
@media (prefers-color-scheme: dark) { :root { --ink: #ddd; --ground: #181818; } }
body { font: 15px/1.4 sans-serif; color: var(--ink); background: var(--ground); margin: 1rem auto; max-width: 60rem; \
padding: 0 1rem; }
h1 { font-size: 1.2rem; }
";

/// Clips for one page, as its script reads them.
#[derive(Debug, Clone, Default)]
pub struct Reel {
    clips: Vec<String>,
    bytes: usize,
}

impl Reel {
    /// Adds a clip, thinned to at most `frames` frames by whole steps of its rate; the page moves smoothly between them.
    /// Gives its number on the page. O(frames × joints).
    pub fn add(&mut self, played: &PlayedClip, frames: usize) -> usize {
        // A closing tag within text would end the script.
        let clip = clip(played, frames).to_string().replace("</", "<\\/");
        self.bytes += clip.len();
        self.clips.push(clip);
        self.clips.len() - 1
    }

    /// Bytes so far.
    pub fn bytes(&self) -> usize {
        self.bytes
    }

    /// True if there is no clip.
    pub fn is_empty(&self) -> bool {
        self.clips.is_empty()
    }

    /// The player as part of a page, with a button for each clip.
    pub fn section(&self) -> String {
        let list = "<nav id=\"clips\" aria-label=\"Clips\"></nav>\n";
        format!("<section id=\"player\">\n{list}{}", self.rest())
    }

    /// The player as a panel over a page, which opens at elements with the attribute `data-motion`: the clip's number.
    pub fn panel(&self) -> String {
        let head = "<p><b id=\"shown\"></b> <button id=\"close\">Close</button></p>\n";
        format!(
            "<section id=\"player\" class=\"panel\" hidden>\n{head}{}",
            self.rest()
        )
    }

    fn rest(&self) -> String {
        let data = self.clips.join(",");
        format!(
            "<style>\n{STYLE}</style>\n<canvas id=\"stage\" tabindex=\"0\" aria-label=\"The body; drag to turn, wheel to \
             zoom\"></canvas>\n<video id=\"film\" hidden muted playsinline preload=\"auto\" aria-label=\"Video\"></video>\n<p id=\"bar\"><button id=\"play\">Pause</button> <input id=\"time\" type=\"range\" min=\"0\" \
             step=\"any\" aria-label=\"Time\"> <output id=\"now\"></output> <label>speed <select id=\"speed\">\
             <option>0.25</option><option>0.5</option><option selected>1</option><option>2</option></select></label> \
             <label id=\"sound\" hidden><input type=\"checkbox\"> sound</label></p>\n<p id=\"film-note\" role=\"status\"></p>\n\
             <canvas id=\"lanes\" aria-label=\"Labels above, detections below\"></canvas>\n\
             <p id=\"legend\">Labels above, detections below. Left limbs are blue, right limbs red.</p>\n<ul id=\"marks\"></ul>\n\
             <noscript>Clips are played by a script, which is switched off.</noscript>\n\
             <script>\nconst clips = [{data}];\n{SCRIPT}</script>\n</section>\n"
        )
    }
}

/// A page of clips, up to an hour of each. O(frames × joints) memory.
pub fn page(title: &str, clips: &[PlayedClip]) -> String {
    const FRAMES: usize = 108_000;
    let mut reel = Reel::default();
    for played in clips {
        reel.add(played, FRAMES);
    }
    let title = escaped(title);
    format!(
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
         <meta name=\"viewport\" content=\"width=device-width\">\n<title>{title}</title>\n<style>\n{PAGE_STYLE}</style>\n\
         </head>\n<body>\n<h1>{title}</h1>\n{}</body>\n</html>\n",
        reel.section()
    )
}

fn escaped(text: &str) -> String {
    text.replace('&', "&amp;")
        .replace('<', "&lt;")
        .replace('>', "&gt;")
}

fn clip(played: &PlayedClip, most: usize) -> serde_json::Value {
    let PlayedClip { clip, roles, .. } = played;
    let whole = TimeSpan::new(0.0, clip.duration_secs());
    let shown = played.span.unwrap_or(whole);
    let shown = shown.frames_among(clip.frames, clip.rate_hz);
    let (first, shown) = (shown.start, shown.len());
    // Rates are halved until the stretch has no more frames than wanted.
    let mut step = (clip.rate_hz / RATE_HZ).max(1.0);
    while shown as f64 / step > most as f64 {
        step *= 2.0;
    }
    let frames = ((shown as f64 / step).floor() as usize).max(usize::from(shown > 0));
    let beside = played.beside.filter(|other| other.frames > 0);
    let beside = beside.map(|other| (other, Vec3::new(BESIDE_METRES, 0.0, 0.0)));
    let both = || std::iter::once((*clip, Vec3::zeros())).chain(beside);
    let mut pose = WorldPose::default();
    let mut poses: Vec<Vec<Vec3>> = Vec::with_capacity(frames);
    for frame in 0..frames {
        let at = first + (frame as f64 * step) as usize;
        let mut places = Vec::new();
        for (clip, step) in both() {
            pose.set(clip, at.min(clip.frames - 1));
            let joints = clip.skeleton.joints().iter().enumerate();
            let tips = (joints.filter(|(_, j)| j.tip.is_some())).map(|(j, _)| pose.tip(clip, j));
            let here = pose.positions.iter().copied().chain(tips);
            places.extend(here.map(|place| place + step));
        }
        poses.push(places);
    }
    let (middle, reach) = middle(&poses);
    // A hand is a tenth of a body.
    let size = match roles.profile() {
        Profile::Hand | Profile::Hands => 0.1,
        _ => 1.0,
    };
    let unit_metres = (reach / f64::from(i16::MAX)).max(0.001 * size);
    let mut bytes: Vec<u8> = Vec::new();
    for place in poses.iter().flatten() {
        for axis in 0..3 {
            let off = (place[axis] - middle[axis]) / unit_metres;
            bytes.extend((off.round() as i16).to_le_bytes());
        }
    }
    let joints = clip.skeleton.joints();
    let own = joints.iter().map(|joint| joint.parent);
    let tips = (0..joints.len())
        .filter(|&j| joints[j].tip.is_some())
        .map(Some);
    let mut parents: Vec<Option<usize>> = own.chain(tips).collect();
    let start = first as f64 / clip.rate_hz;
    let marks = |marks: &[Mark]| -> Vec<serde_json::Value> {
        let mark = |m: &Mark| json!([m.class, m.span.start_secs - start, m.span.stop_secs - start]);
        marks.iter().map(mark).collect()
    };
    let mut sides: Vec<i8> = (0..joints.len()).map(|j| side(clip, roles, j)).collect();
    if beside.is_some() {
        let points = parents.len();
        let of_tips = parents[joints.len()..].iter().flatten();
        let of_tips: Vec<i8> = of_tips.map(|joint| sides[*joint]).collect();
        sides.extend(of_tips);
        sides.extend_from_within(..);
        let others: Vec<_> = parents.iter().map(|p| p.map(|p| p + points)).collect();
        parents.extend(others);
    }
    let name = match played.span {
        Some(span) => format!("{} {span:.2}", clip.name),
        None => clip.name.clone(),
    };
    let video = played
        .video
        .as_ref()
        .map(|video| json!({"address": video.address, "offset": video.offset_secs + start}));
    json!({
        "video": video,
        "name": name,
        "rate": clip.rate_hz / step,
        "frames": frames,
        "parents": parents,
        "sides": sides,
        "middle": [middle.x, middle.y, middle.z],
        "lines": lines(clip, roles),
        "unit_metres": unit_metres,
        "size": size,
        "places": STANDARD.encode(bytes),
        "labels": marks(&played.labels),
        "detections": marks(&played.detections),
    })
}

/// −1 for a joint of the right limbs, 1 for one of the left, 0 else.
fn side(clip: &Clip, roles: &RoleMap, joint: usize) -> i8 {
    let joints = clip.skeleton.joints();
    let mut above = std::iter::successors(Some(joint), |&j| joints[j].parent);
    above
        .find_map(|j| {
            let role = Role::ALL
                .into_iter()
                .find(|&role| roles.joint(role) == Some(j))?;
            Some(match role.name() {
                name if name.starts_with("left") => 1,
                name if name.starts_with("right") => -1,
                _ => 0,
            })
        })
        .unwrap_or(0)
}

/// Pairs of points between which a body's bones lie, in a clip whose joints do not hang together.
fn lines(clip: &Clip, roles: &RoleMap) -> Vec<(usize, usize)> {
    if clip.has_rotations() {
        return Vec::new();
    }
    let of_body = roles.profile() == Profile::Body;
    let of_parts = |bone: &&Bone| {
        matches!(bone.kind, BoneKind::Direction) || !of_body && bone.kind == BoneKind::Offset
    };
    let parts = ALL_BONES.iter().filter(of_parts);
    let ends = parts.map(|bone| (bone.from, bone.to));
    let is_known = |role: Role| roles.joint(role).is_some();
    let hands = Hand::BOTH.into_iter().flat_map(|hand| hand.lines(is_known));
    let hips = [
        (Role::Hips, Role::LeftThigh),
        (Role::Hips, Role::RightThigh),
    ];
    ends.chain(hips)
        .chain(hands)
        .filter_map(|(from, to)| Some((roles.joint(from)?, roles.joint(to)?)))
        .collect()
}

/// The middle of the floor that the clip is on, and how far it goes from there along any axis.
fn middle(poses: &[Vec<Vec3>]) -> (Vec3, f64) {
    let (mut low, mut high) = (Vec3::repeat(f64::MAX), Vec3::repeat(f64::MIN));
    for place in poses
        .iter()
        .flatten()
        .filter(|p| p.iter().all(|v| v.is_finite()))
    {
        low = low.inf(place);
        high = high.sup(place);
    }
    if low.x > high.x {
        return (Vec3::zeros(), 0.0);
    }
    let middle = Vec3::new((low.x + high.x) / 2.0, low.y, (low.z + high.z) / 2.0);
    (middle, (high - middle).max())
}

#[cfg(test)]
mod tests {
    use super::*;
    use morec::import::Take;
    use morec::synth::{Person, Script};

    /// The page names the file, and knows at which of its moments the stretch begins.
    #[test]
    fn a_video_begins_where_the_stretch_does() {
        let script = Script::new(3, Person::draw(31, 2)).rest(0.3).play("wave");
        let take = Take::new(script.film("wave", 30.0).unwrap().clip).unwrap();
        let played = PlayedClip {
            span: Some(TimeSpan::new(0.5, 1.0)),
            video: Some(PlayedVideo {
                address: "film%20of%20it.webm".to_owned(),
                offset_secs: -0.25,
            }),
            ..whole(&take)
        };
        let expected = json!({"address": "film%20of%20it.webm", "offset": 0.25});
        assert_eq!(clip(&played, 100)["video"], expected);
        assert!(clip(&whole(&take), 100)["video"].is_null());
    }

    #[test]
    fn videos_are_named_as_seen_from_the_page() {
        let of =
            |folder: &str, file: &str| PlayedVideo::of(folder.as_ref(), file.as_ref(), 0.0).address;
        assert_eq!(of("/a/b", "/a/b/film 1.mp4"), "film%201.mp4");
        assert_eq!(of("/a/b", "/a/films/é#.mp4"), "../films/%C3%A9%23.mp4");
        assert_eq!(of("/a/b/c", "/d.mp4"), "../../../d.mp4");
    }

    #[test]
    fn a_page_stands_alone_and_holds_every_clip() {
        let script = Script::new(3, Person::draw(31, 2)).rest(0.3).play("wave");
        let take = Take::new(script.film("wa</script>ve", 120.0).unwrap().clip).unwrap();
        let mark = |class: &str| Mark::new(class, TimeSpan::new(0.3, 1.0));
        let played = PlayedClip {
            clip: &take.clip,
            roles: &take.roles,
            beside: None,
            span: None,
            labels: vec![mark("wave")],
            detections: vec![mark("wave"), mark("<b>")],
            video: None,
        };
        let page = page("A & B", &[played.clone(), played]);
        assert_eq!(
            page.matches("</script>").count(),
            1,
            "names cannot end the script"
        );
        for outside in ["http://", "https://", "src=", "@import", "url("] {
            assert!(!page.contains(outside), "{outside}");
        }
        let from = page.find("const clips = ").unwrap() + "const clips = ".len();
        let to = from + page[from..].find(";\n").unwrap();
        let data: serde_json::Value =
            serde_json::from_str(&page[from..to].replace("<\\/", "</")).unwrap();
        let clip = &data[1];
        assert_eq!(clip["name"], "wa</script>ve");
        assert!((clip["rate"].as_f64().unwrap() - 30.0).abs() < 0.1);
        // The positions are those of the clip, to the millimetre.
        let bytes = STANDARD.decode(clip["places"].as_str().unwrap()).unwrap();
        let joints = clip["parents"].as_array().unwrap().len();
        let frames = usize::try_from(clip["frames"].as_u64().unwrap()).unwrap();
        assert_eq!(bytes.len(), frames * joints * 6);
        let at = 5 * joints * 6;
        let x = f64::from(i16::from_le_bytes([bytes[at], bytes[at + 1]])) / 1000.0;
        let place = WorldPose::of(&take.clip, 20).positions[0];
        assert!((x + clip["middle"][0].as_f64().unwrap() - place.x).abs() < 1e-3);
    }

    /// The places of a clip's joints, frame by frame, as the page's script takes them.
    fn places(clip: &serde_json::Value) -> Vec<f64> {
        let bytes = STANDARD.decode(clip["places"].as_str().unwrap()).unwrap();
        let unit = clip["unit_metres"].as_f64().unwrap();
        let middle = |i: usize| clip["middle"][i % 3].as_f64().unwrap();
        let values = bytes.chunks_exact(2).enumerate();
        values
            .map(|(i, b)| f64::from(i16::from_le_bytes([b[0], b[1]])) * unit + middle(i))
            .collect()
    }

    /// Somebody who runs for a kilometre arrives there, and does not stop at what millimetres in 16 bits can say.
    #[test]
    fn a_long_way_is_shown_as_a_whole() {
        let script = Script::new(3, Person::draw(31, 2)).rest(0.5);
        let mut take = Take::new(script.film("run", 30.0).unwrap().clip).unwrap();
        let track = take.clip.tracks.iter_mut().find(|t| t.joint == 0).unwrap();
        let last = track.positions.len() - 1;
        track.positions[last].x += 1000.0;
        let (expected, played) = (track.positions[last].x, whole(&take));
        let clip = clip(&played, 1000);
        let joints = clip["parents"].as_array().unwrap().len();
        let found = places(&clip)[last * joints * 3];
        assert!((found - expected).abs() < 0.02, "{found}, {expected}");
    }

    fn whole(take: &Take) -> PlayedClip<'_> {
        PlayedClip {
            clip: &take.clip,
            roles: &take.roles,
            beside: None,
            span: None,
            labels: Vec::new(),
            detections: Vec::new(),
            video: None,
        }
    }

    /// Points do not hang together, but those that are parts of a body are joined by lines.
    #[test]
    fn points_of_a_body_are_joined() {
        let script = Script::new(3, Person::draw(31, 2)).rest(0.5);
        let joints = script.film("stand", 30.0).unwrap().clip;
        let take = Take::new(joints.to_points(None)).unwrap();
        let lines = clip(&whole(&take), 1000)["lines"].clone();
        let forearm = [Role::LeftForearm, Role::LeftHand].map(|role| take.roles.joint(role));
        assert!(
            lines.as_array().unwrap().contains(&json!(forearm)),
            "{lines}"
        );
    }

    #[test]
    fn a_motion_beside_another_has_its_own_points_a_step_away() {
        let script = Script::new(3, Person::draw(31, 2)).rest(0.3).play("wave");
        let take = Take::new(script.film("wave", 30.0).unwrap().clip).unwrap();
        let alone = clip(&whole(&take), 1000);
        let two = PlayedClip {
            beside: Some(&take.clip),
            ..whole(&take)
        };
        let two = clip(&two, 1000);
        let points = |clip: &serde_json::Value| clip["parents"].as_array().unwrap().len();
        assert_eq!(points(&two), 2 * points(&alone));
        assert_eq!(two["sides"].as_array().unwrap().len(), points(&two));
        let values = 3 * points(&alone);
        let (first, places) = (&places(&alone)[..values], places(&two));
        for at in (0..values).filter(|at| at % 3 == 0) {
            assert!((places[at] - first[at]).abs() < 2e-3);
            assert!((places[values + at] - first[at] - BESIDE_METRES).abs() < 2e-3);
        }
    }

    /// A stretch holds its own frames, thinned as asked, and its marks begin with it.
    #[test]
    fn a_stretch_is_cut_out_and_thinned() {
        let script = Script::new(3, Person::draw(31, 2)).rest(0.3).play("wave");
        let take = Take::new(script.film("wave", 30.0).unwrap().clip).unwrap();
        let played = PlayedClip {
            clip: &take.clip,
            roles: &take.roles,
            beside: None,
            span: Some(TimeSpan::new(0.3, 1.3)),
            labels: vec![Mark::new("wave", TimeSpan::new(0.5, 1.0))],
            detections: Vec::new(),
            video: None,
        };
        for (most, frames, rate) in [(100, 30, 30.0), (20, 15, 15.0), (8, 7, 7.5)] {
            let clip = clip(&played, most);
            assert_eq!(clip["frames"], frames);
            assert!((clip["rate"].as_f64().unwrap() - rate).abs() < 0.01);
            assert!((clip["labels"][0][1].as_f64().unwrap() - 0.2).abs() < 1e-6);
            assert_eq!(clip["name"], "wave 0.30–1.30 s");
        }
        let mut reel = Reel::default();
        assert_eq!((reel.add(&played, 100), reel.add(&played, 100)), (0, 1));
        let panel = reel.panel();
        assert!(panel.len() > reel.bytes() && panel.contains("hidden"));
    }
}

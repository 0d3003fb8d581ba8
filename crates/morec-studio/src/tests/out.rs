//! Out of the studio: labels in every form, a clip, a page; and what a session leaves for the next.

use morec::roles::Role;
use morec_db::exchange::{self, ClipLengths, LabelFormat};

use super::{Person, made, takes};
use crate::state::layout::{CameraLayout, Layout};
use crate::state::{
    Command, FileCommand, LibraryCommand, Panel, State, TimelineCommand, ViewCommand,
};

#[test]
fn labels_go_out_in_every_form() {
    let folder = tempfile::tempdir().unwrap();
    let mut person = Person::before(&[made(folder.path(), 2)]);
    let count = person.labels().len();
    for form in LabelFormat::ALL {
        let path = folder.path().join(format!("out-{}", form.name()));
        person.command(Command::File(FileCommand::ExportLabels(form, path.clone())));
        assert!(
            person.state().notices.is_empty(),
            "{:?}",
            person.state().notices
        );
        assert!(person.state().command_line.contains(form.name()));
        let files: Vec<_> = match form.is_of_one_clip() {
            true => std::fs::read_dir(&path)
                .unwrap()
                .map(|f| f.unwrap().path())
                .collect(),
            false => vec![path],
        };
        assert_eq!(files.len(), if form.is_of_one_clip() { 2 } else { 1 });
        let lengths = takes().iter().map(|take| {
            let (frames, rate_hz) = (take.clip.frames, take.clip.rate_hz);
            (
                take.clip.name.clone(),
                morec::labels::ClipLength { frames, rate_hz },
            )
        });
        let lengths: ClipLengths = lengths.collect();
        let read = |file: &std::path::PathBuf| {
            let bytes = std::fs::read(file).unwrap();
            let read = exchange::read(form, &bytes, Some("ada_1"), &lengths).unwrap();
            read.annotations.len()
        };
        assert_eq!(files.iter().map(read).sum::<usize>(), count, "{form:?}");
    }
}

#[test]
fn a_clip_and_a_page_go_out_and_the_database_is_not_written_over() {
    let folder = tempfile::tempdir().unwrap();
    let path = made(folder.path(), 1);
    let mut person = Person::before(std::slice::from_ref(&path));
    let clip = folder.path().join("out.bvh");
    person.command(Command::File(FileCommand::ExportClip(clip.clone())));
    let read = morec::files::open(&clip).unwrap();
    assert_eq!(read[0].clip.frames, takes()[0].clip.frames);
    let page = folder.path().join("out.html");
    person.command(Command::File(FileCommand::ExportPage(page.clone())));
    let html = std::fs::read_to_string(&page).unwrap();
    assert!(html.contains("<canvas") && html.contains("ada_1") && html.contains("wave"));
    let before = std::fs::read(&path).unwrap();
    person.command(Command::File(FileCommand::ExportPage(path.clone())));
    assert!(person.sees_part("this is the database itself"));
    assert_eq!(std::fs::read(&path).unwrap(), before);
    let nowhere = folder.path().join("no such folder").join("out.html");
    person.command(Command::File(FileCommand::ExportPage(nowhere)));
    assert!(person.sees_part("out.html: not written"));
    person.wait(1.0);
    person.click("File");
    person.frames(3);
    for entry in ["Export this clip", "A page of it to send", "Export labels"] {
        assert!(person.sees_part(entry), "{entry}");
    }
}

#[test]
fn a_clip_that_is_nearly_another_is_told_at_import_and_left_out_by_a_click() {
    let folder = tempfile::tempdir().unwrap();
    let mut person = Person::before(&[made(folder.path(), 0)]);
    let mut clip = takes()[1].clip.clone();
    clip.frames = clip.frames * 95 / 100;
    clip.rotations.truncate(clip.frames * clip.skeleton.len());
    for track in &mut clip.tracks {
        track.positions.truncate(clip.frames);
    }
    let mut bytes = Vec::new();
    morec::formats::bvh::write(&clip, &mut bytes).unwrap();
    let file = folder.path().join("shorter.bvh");
    std::fs::write(&file, bytes).unwrap();
    person.command(Command::File(FileCommand::Import(vec![file])));
    assert!(person.sees_part("1 near-duplicate"));
    assert!(person.sees_part("shorter is nearly the same as ben_1"));
    person.click("Compare");
    person.settle();
    assert_eq!(person.state().companions.all.len(), 1);
    person.click("Remove the copy");
    person.settle();
    assert!(!person.offers("shorter"));
    person.undo();
    assert!(person.offers("shorter"));
}

#[test]
fn clips_are_strips_of_poses_too() {
    let folder = tempfile::tempdir().unwrap();
    let mut person = Person::before(&[made(folder.path(), 0)]);
    person.click("Strips");
    person.settle();
    person.click("cleo_1");
    person.settle();
    let shown = person.state().player.motion.as_ref().unwrap();
    assert_eq!(shown.clip.name, "cleo_1");
    assert!(!person.offers("Sort by clip"));
    person.click("Table");
    assert!(person.offers("Sort by clip"));
}

#[test]
fn a_layout_comes_back_with_the_next_session() {
    let folder = tempfile::tempdir().unwrap();
    let path = made(folder.path(), 0);
    let mut person = Person::before(std::slice::from_ref(&path));
    person.goes_to(Panel::Label);
    person.click("Show ben_1");
    person.settle();
    person.command(Command::Dark(false));
    person.command(Command::Library(LibraryCommand::Strips(true)));
    person.click("Channel");
    person.click("Hips: position");
    person.click("Trail");
    person.click("left hand");
    person.key(egui::Key::Escape);
    person.click("Side");
    let middle = person.place("Performer").center();
    person.drag(middle, middle + egui::vec2(50.0, 40.0));
    let zoomed = crate::body::Camera {
        distance: 1.9,
        ..person.state().camera
    };
    person.command(Command::Look(ViewCommand::Camera(zoomed)));
    person.click("Follow");
    let (camera, channel) = (person.state().camera, person.state().channel.clone());
    assert!(!camera.follow && channel.is_some());
    let kept = serde_json::to_string(&person.state().layout()).unwrap();
    let layout: Layout = serde_json::from_str(&kept).unwrap();
    let mut state = State::new(std::sync::Arc::new(|| {}), std::env::temp_dir());
    state.begin(std::slice::from_ref(&path));
    state.lay_out(&layout);
    state.show_again(&layout);
    assert_eq!(state.layout().panel, "Label");
    assert!(!state.dark && state.library.strips);
    assert_eq!(state.last.as_deref(), Some(path.as_path()));
    while state.is_busy() {
        state.tick(0.0);
        std::thread::sleep(std::time::Duration::from_millis(2));
    }
    assert_eq!(state.layout().clip.as_deref(), Some("ben_1"));
    assert_eq!(state.camera, camera);
    assert_eq!(state.trail, Some(Role::LeftHand));
    assert_eq!(state.channel, channel, "its curve is read again");
    // A layout of another version lacks what this one knows.
    let old: Layout = serde_json::from_str(r#"{"panel": "Nowhere"}"#).unwrap();
    state.lay_out(&old);
    assert_eq!(state.panel, Panel::Library);
    assert!(state.camera.follow && state.trail.is_none() && state.channel_wanted.is_none());
}

#[test]
fn a_layout_with_parts_that_cannot_be_is_used_as_far_as_it_can() {
    let mut state = State::new(std::sync::Arc::new(|| {}), std::env::temp_dir());
    let strange = r#"{"panel": "Train", "trail": "third hand", "channel": {"joint": "Hips", "kind": "colour"},
        "camera": {"yaw": 0.2, "pitch": 7.0, "distance": -3.0, "target": [0.0, 1.0, 0.0]}}"#;
    let strange: Layout = serde_json::from_str(strange).unwrap();
    state.lay_out(&strange);
    assert_eq!((state.panel, state.trail), (Panel::Train, None));
    assert_eq!(state.channel_wanted, None);
    let camera = state.camera;
    assert_eq!((camera.yaw, camera.pitch, camera.distance), (0.2, 1.5, 0.6));
    let endless = Layout {
        camera: strange.camera.map(|c| CameraLayout { yaw: f64::NAN, ..c }),
        ..strange
    };
    state.lay_out(&endless);
    assert_eq!(state.camera, camera, "left as it was");
}

#[test]
fn a_stretch_and_the_labels_of_a_class_go_out_as_clips() {
    let folder = tempfile::tempdir().unwrap();
    let mut person = Person::before(&[made(folder.path(), 2)]);
    let range = Some((1.0, 2.5));
    person.command(Command::Timeline(TimelineCommand::Range(range)));
    let out = folder.path().join("part.bvh");
    person.command(Command::File(FileCommand::ExportStretch(out.clone())));
    let read = morec::files::open(&out).unwrap();
    let whole = &takes()[0].clip;
    let frames = (1.5 * whole.rate_hz).round() as usize;
    assert!(read[0].clip.frames.abs_diff(frames) <= 1);
    let out = folder.path().join("waves");
    let class = "wave".to_owned();
    person.command(Command::File(FileCommand::ExportClass(class, out.clone())));
    assert!(person.state().notices.is_empty());
    let labels = person.labels();
    let waves = labels.iter().filter(|label| label.1 == "wave").count();
    let files = std::fs::read_dir(&out).unwrap();
    let files: Vec<_> = files.map(|file| file.unwrap().path()).collect();
    assert_eq!(files.len(), waves);
    assert!(out.join("ada_1_wave_1.bvh").exists(), "{files:?}");
    // The motion is that of the label.
    let label = takes()[0].labels.iter().find(|l| l.class == "wave");
    let secs = label.unwrap().span.duration_secs();
    let read = morec::files::open(out.join("ada_1_wave_1.bvh")).unwrap();
    assert!((read[0].clip.duration_secs() - secs).abs() < 0.1);
}

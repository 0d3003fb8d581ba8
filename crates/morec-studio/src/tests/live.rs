//! Teaching from what just happened.

use egui::Key;
use morec::index::MotionIndex;
use morec::roles::mapping::Mapping;
use morec::{ImportOptions, Labels, TimeSpan, Trainer};
use morec_db::MotionDb;
use morec_db::labels::NewSample;
use morec_ops::RecognizeSettings;

use super::{Person, before, made, takes};
use crate::state::live::Choice;
use crate::state::{ClassCommand, Command, LiveCommand, Panel, TrainCommand};
use crate::store::Edit;

#[test]
fn what_just_happened_is_marked_learned_and_recognised_and_undone() {
    let (_folder, mut person) = before(Panel::Live, 0);
    person.click("Start");
    person.settle();
    let take = &takes()[0];
    let wave = take.labels.iter().find(|l| l.class == "wave").unwrap();
    let now = |person: &Person| person.state().live.run.as_ref().unwrap().now_secs;
    while now(&person) < wave.span.stop_secs + 0.4 {
        person.frames(1);
    }
    person.key(Key::Num1);
    assert_eq!(person.state().live.marks.len(), 1);
    let line = person.state().command_line.clone();
    assert!(line.ends_with("--name gesture_1"), "{line}");
    let mark = person.state().live.marks[0].clone();
    let (start, stop) = (mark.span.start_secs, mark.span.stop_secs);
    assert!(
        (start - wave.span.start_secs).abs() < 0.8 && (stop - wave.span.stop_secs).abs() < 0.8,
        "{start} {stop} {wave:?}"
    );
    // The stream goes on meanwhile.
    person.settle();
    assert!(
        person.state().live.index().is_some(),
        "trained with what was marked"
    );
    assert_eq!(person.labels().len(), 1);
    assert_eq!(person.labels()[0].1, "gesture 1");
    let later = take.labels.iter().rfind(|l| l.class == "wave").unwrap();
    while now(&person) < later.span.stop_secs + 1.5 && later.span.start_secs > wave.span.stop_secs {
        person.frames(1);
    }
    // If training outlasted the second wave, the clip comes round again.
    let end = take.clip.duration_secs() + wave.span.stop_secs + 3.0;
    while person.state().live.counts.is_empty() && now(&person) < 2.0 * end {
        person.frames(1);
    }
    assert!(person.sees("Recognised gesture 1"));
    person.click("Stop");
    person.undo();
    assert!(person.labels().is_empty());
    // The sample's clip is a step of its own.
    let clips = |person: &Person| person.state().store.as_ref().unwrap().snapshot.clips.len();
    assert_eq!(clips(&person), 4);
    person.undo();
    assert_eq!(clips(&person), 3);
    person.redo();
    person.redo();
    assert_eq!(person.labels().len(), 1);
}

#[test]
fn a_take_is_recorded_into_the_database_after_a_countdown() {
    let (_folder, mut person) = before(Panel::Live, 0);
    person.key(Key::Space);
    person.settle();
    person.key(Key::R);
    assert!(person.state().live.countdown.is_some());
    person.wait(3.2);
    assert!(person.state().live.take.is_some());
    person.wait(2.0);
    person.key(Key::R);
    person.settle();
    let store = person.state().store.as_ref().unwrap();
    let clip = store
        .snapshot
        .clips
        .iter()
        .find(|c| c.name == "take_001")
        .unwrap();
    assert!(
        (1.5..3.0).contains(&clip.duration_secs()),
        "{}",
        clip.duration_secs()
    );
    let line = person.state().command_line.clone();
    assert!(line.starts_with("morec record --listen clip://"), "{line}");
    person.command(Command::Show(Panel::Library));
    assert!(person.offers("take_001"));
    person.undo();
    assert!(!person.offers("take_001"));
    person.redo();
    assert!(person.offers("take_001"));
}

#[test]
fn a_device_is_listened_to_and_its_absence_is_said() {
    let (_folder, mut person) = before(Panel::Live, 0);
    let listen =
        |address: &str| Command::Live(LiveCommand::Choose(Choice::Network(address.to_owned())));
    person.command(listen("vmc://127.0.0.1:0"));
    person.click("Start");
    assert!(
        person
            .state()
            .live
            .run
            .as_ref()
            .unwrap()
            .name
            .starts_with("vmc://127.0.0.1:")
    );
    assert!(person.sees_part("No data has arrived yet"));
    person.click("Stop");
    // What is no address gives a sentence.
    person.command(listen("carrier://pigeon"));
    person.click("Start");
    assert!(person.state().live.run.is_none());
    assert!(!person.state().notices.is_empty());
}

/// A user at the live panel, which listens for lines of JSON; the user's folder and the address.
fn listening(labelled: usize) -> (tempfile::TempDir, Person, String) {
    let (folder, mut person) = before(Panel::Live, labelled);
    let choice = Choice::Network("json+tcp://127.0.0.1:0".to_owned());
    person.command(Command::Live(LiveCommand::Choose(choice)));
    person.click("Start");
    let name = &person.state().live.run.as_ref().unwrap().name;
    let address = name.trim_start_matches("json+tcp://").to_owned();
    (folder, person, address)
}

/// A user at the live panel, which recognises with an index trained on the labels of this many people.
fn recognising(labelled: usize) -> (tempfile::TempDir, Person) {
    let folder = tempfile::tempdir().unwrap();
    let mut person = Person::before(&[made(folder.path(), labelled)]);
    person.command(Command::Train(TrainCommand::Train));
    person.goes_to(Panel::Live);
    person.key(Key::Space);
    person.settle();
    (folder, person)
}

/// Sends the poses of a take as lines of JSON, as of two performers a metre apart.
fn send(address: &str, take: &morec::synth::SyntheticTake, frames: usize) -> std::net::TcpStream {
    use std::io::Write;
    let roles = morec::roles::RoleMap::find(&take.clip.skeleton);
    let mut stream = std::net::TcpStream::connect(address).unwrap();
    for frame in 0..frames {
        let pose = morec::kinematics::WorldPose::of(&take.clip, frame);
        for actor in 0..2 {
            let place = |role: morec::roles::Role| {
                let p = pose.positions[roles.joint(role)?];
                let [x, y, z] = [p.x + f64::from(actor), p.y, p.z];
                Some(format!("\"{role}\": [{x:.4}, {y:.4}, {z:.4}]"))
            };
            let places: Vec<String> = morec::roles::Role::ALL
                .into_iter()
                .filter_map(place)
                .collect();
            let secs = frame as f64 / take.clip.rate_hz;
            let places = places.join(", ");
            writeln!(
                stream,
                "{{\"t\": {secs:.4}, \"actor\": {actor}, \"positions\": {{{places}}}}}"
            )
            .unwrap();
        }
    }
    stream
}

#[test]
fn two_performers_are_seen_either_is_watched_and_a_lost_sender_is_said() {
    let (_folder, mut person, address) = listening(0);
    let sender = std::thread::spawn(move || send(&address, &takes()[0], 120));
    let begun = std::time::Instant::now();
    let frames = |person: &Person| -> Vec<usize> {
        let run = person.state().live.run.as_ref().unwrap();
        run.performers.iter().map(|p| p.frames.len()).collect()
    };
    while frames(&person) != [120, 120] && begun.elapsed().as_secs() < 60 {
        person.frames(1);
        std::thread::sleep(std::time::Duration::from_millis(5));
    }
    assert_eq!(frames(&person), [120, 120]);
    // The connection stays open: the sender is silent, not gone.
    let connection = sender.join().unwrap();
    person.frames(2);
    assert!(person.sees_part("Seen: Performer 2"));
    person.click("Watch performer 2");
    let run = person.state().live.run.as_ref().unwrap();
    assert_eq!(run.watched().unwrap().actor.0, 1);
    assert!(person.sees_part("Seen: Performer 1"));
    // Two seconds without a word.
    person.wait(2.0);
    assert!(person.sees_part("the sender has stopped"));
    person.frames(3);
    assert!(!person.is_redrawn(), "nothing comes, nothing changes");
    drop(connection);
    assert_eq!(frames(&person), [120, 120], "what came is still there");
}

#[test]
fn the_last_minutes_are_looked_back_at_and_a_detection_is_selected_by_a_click() {
    let (_folder, mut person) = recognising(2);
    let now = |person: &Person| person.state().live.now_secs();
    while now(&person) < 65.0 {
        person.frames(1);
    }
    let extent = |person: &Person| person.state().live.looking.extent(now(person));
    assert!(extent(&person).0 > 4.0, "{:?}", extent(&person));
    // The first detection is no longer in view: its line in the list brings it there.
    let run = person.state().live.run.as_ref().unwrap();
    let seen: Vec<_> = run
        .seen
        .iter()
        .map(|s| (s.span.start_secs, s.span.stop_secs))
        .collect();
    person.click("20 s");
    person.click("Look back");
    let held = extent(&person);
    person.wait(1.0);
    assert_eq!(extent(&person), held, "the view stands still");
    let inside = |at: &(f64, f64)| held.0 < at.0 && at.1 < held.1;
    let at = seen.iter().find(|at| inside(at)).copied().unwrap();
    let run = person.state().live.run.as_ref().unwrap();
    let found = run.seen.iter().find(|s| s.span.start_secs == at.0).unwrap();
    let name = format!("{} at {:.1} s", found.class, found.span.start_secs);
    person.click(&name);
    assert_eq!(person.state().live.range, Some(at));
    person.click("Now");
    assert!(extent(&person).1 >= now(&person));
    // Keys do the same.
    person.key(Key::ArrowLeft);
    person.wait(0.5);
    assert!(extent(&person).1 < now(&person) - 9.0);
    person.key(Key::ArrowRight);
    person.key(Key::End);
    assert!(extent(&person).1 >= now(&person));
    // The last line of the list is out of view until it is clicked.
    person.click("5 min");
    assert_eq!(extent(&person).1 - extent(&person).0, 300.0);
    let last = person
        .state()
        .live
        .run
        .as_ref()
        .unwrap()
        .seen
        .last()
        .cloned()
        .unwrap();
    person.click(&format!("Recognised {}", last.class));
    let range = person.state().live.range.unwrap();
    let run = person.state().live.run.as_ref().unwrap();
    assert!(
        run.seen
            .iter()
            .any(|s| (s.span.start_secs, s.span.stop_secs) == range && s.class == last.class)
    );
    person.click("Stop");
}

#[test]
fn somebody_else_is_recognised_more_generously_where_few_people_taught() {
    let (_folder, mut person) = recognising(1);
    person.frames(60);
    person.click("Performer");
    person.click("another person");
    let line = person.state().command_line.clone();
    assert!(line.ends_with(" --performer anyone"), "{line}");
    // The index was trained here: the line writes it first.
    assert!(
        line.starts_with("morec train ") && line.contains("morec live "),
        "{line}"
    );
    // The next start is with what was chosen, too.
    person.click("Stop");
    person.click("Start");
    let line = person.state().command_line.clone();
    assert!(line.ends_with(" --performer anyone"), "{line}");
}

#[test]
fn the_sensitivity_that_is_shown_last_is_the_one_that_is_tried() {
    let (_folder, mut person) = recognising(2);
    while person.state().live.now_secs() < takes()[0].clip.duration_secs() - 0.5 {
        person.frames(1);
    }
    let sense = |alarms| {
        Command::Live(LiveCommand::Settings(RecognizeSettings {
            sensitivity: Some(alarms),
            ..RecognizeSettings::default()
        }))
    };
    // Two values at once: the first is still being tried when the second is chosen.
    person.window.state_mut().state.apply(sense(0.03));
    person.command(sense(2.0));
    let tried = person.state().live.resensed.as_ref().unwrap();
    assert_eq!(tried.settings.sensitivity, Some(2.0));
    assert!(person.sees_part("At 2.00 it would have reported"));
}

#[test]
fn the_sensitivity_shows_what_the_minutes_would_have_held() {
    let (_folder, mut person) = before(Panel::Train, 2);
    person.click("Start training");
    person.settle();
    person.goes_to(Panel::Live);
    person.key(Key::Space);
    person.settle();
    let end = takes()[0].clip.duration_secs();
    while person.state().live.run.as_ref().unwrap().now_secs < end - 0.5 {
        person.frames(1);
    }
    assert!(!person.state().live.counts.is_empty());
    let slider = person.place("Sensitivity");
    let at = |share: f32| egui::pos2(slider.left() + share * slider.width(), slider.center().y);
    person.drag(at(0.5), at(0.05));
    person.settle();
    let few = person.state().live.resensed.as_ref().unwrap().found.len();
    person.drag(at(0.1), at(0.95));
    person.settle();
    let many = person.state().live.resensed.as_ref().unwrap().found.len();
    assert!(few <= many && many > 0, "{few} {many}");
    assert!(person.sees_part("would have reported"));
}

#[test]
fn a_class_beyond_the_ninth_is_marked_by_the_key_that_it_was_given() {
    let folder = tempfile::tempdir().unwrap();
    let mut person = Person::before(&[made(folder.path(), 0)]);
    for number in 1..=11 {
        let class = ClassCommand::Add(format!("other {number}"));
        person.command(Command::Classes(class));
    }
    person.goes_to(Panel::Live);
    person.key(Key::W);
    person
        .window
        .event(egui::Event::Text("other 11".to_owned()));
    person.frames(2);
    person.key(Key::Enter);
    person.click("Start");
    person.settle();
    let stop = takes()[0].labels[0].span.stop_secs;
    while person.state().live.run.as_ref().unwrap().now_secs < stop + 0.4 {
        person.frames(1);
    }
    person.key(Key::Q);
    person.settle();
    assert_eq!(person.labels().len(), 1);
    assert_eq!(person.labels()[0].1, "other 11");
}

#[test]
fn a_source_that_never_sends_redraws_nothing() {
    let (_folder, mut person) = before(Panel::Live, 0);
    let listen = Choice::Network("vmc://127.0.0.1:0".to_owned());
    person.command(Command::Live(LiveCommand::Choose(listen)));
    person.click("Start");
    person.wait(3.0);
    assert!(person.state().live.run.is_some());
    assert!(!person.is_redrawn());
}

/// An index of a puppet of seven points whose joints have names that people's have.
fn index_of_a_puppet() -> MotionIndex {
    let mapping = "point_1\tHips\npoint_2\tHead\nleft_point_1\tLeftUpLeg\nright_point_1\tRightUpLeg\n\
        left_point_2\tLeftHand\nright_point_2\tRightHand\nleft_point_3\tLeftForeArm\n";
    let options = ImportOptions {
        mapping: Some(Mapping::read(mapping.as_bytes()).unwrap()),
        ..ImportOptions::default()
    };
    let mut labels = Labels::default();
    let taught = takes().iter().map(|take| {
        for label in &take.labels {
            labels.add(&take.clip.name, label.class, label.span);
        }
        morec::import::normalize(take.clip.clone(), &options).unwrap()
    });
    let taught: Vec<_> = taught.collect();
    Trainer::new().labels(&labels).train(&taught).unwrap()
}

#[test]
fn with_many_classes_what_is_recognised_stays_in_view() {
    let (_folder, mut person) = before(Panel::Live, 1);
    let clip = person.state().store.as_ref().unwrap().snapshot.clips[0].id;
    let sample = |number: usize| {
        let class = format!("a motion with a long name {number}");
        NewSample::accepted(clip, &class, TimeSpan::new(1.0, 2.0))
    };
    person.command(Command::Edit(Edit::Label((0..45).map(sample).collect())));
    person.settle();
    let window = person.window.ctx.content_rect();
    let heading = person.place("RECOGNISED");
    assert!(heading.bottom() < 0.7 * window.height(), "{heading}");
}

#[test]
fn an_index_of_another_kind_of_performer_is_said() {
    let folder = tempfile::tempdir().unwrap();
    let path = made(folder.path(), 0);
    let bytes = index_of_a_puppet().to_bytes().unwrap();
    MotionDb::open(&path)
        .unwrap()
        .store_index("puppet", &bytes)
        .unwrap();
    let mut person = Person::before(&[path]);
    person.command(Command::Train(TrainCommand::UseIndex("puppet".to_owned())));
    person.goes_to(Panel::Live);
    person.key(Key::Space);
    person.settle();
    while person.state().live.now_secs() < 2.0 {
        person.frames(1);
    }
    let said = "This index recognises a custom skeleton, but the input shows a body";
    assert!(person.sees_part(said));
    assert!(!person.sees_part("No problems found"));
}

#[test]
fn a_performer_who_is_gone_is_not_said_to_be_without_fault() {
    let (_folder, mut person, address) = listening(0);
    let sender = std::thread::spawn(move || send(&address, &takes()[0], 60));
    drop(sender.join().unwrap());
    let begun = std::time::Instant::now();
    let gone = |person: &Person| {
        let run = person.state().live.run.as_ref().unwrap();
        run.watched().is_some_and(|w| w.gone)
    };
    while !gone(&person) && begun.elapsed().as_secs() < 60 {
        person.frames(1);
        std::thread::sleep(std::time::Duration::from_millis(5));
    }
    person.frames(2);
    assert!(gone(&person));
    assert!(!person.sees_part("No problems found"));
    assert!(person.sees_part("The watched performer has left"));
}

#[test]
fn a_sender_that_was_started_again_is_watched_again() {
    let (_folder, mut person, address) = listening(0);
    let watched = |person: &Person| {
        let run = person.state().live.run.as_ref().unwrap();
        run.watched().map(|w| (w.actor, w.gone, w.frames.len()))
    };
    let sends = |person: &mut Person, is_done: &dyn Fn(&Person) -> bool| {
        let address = address.clone();
        let sender = std::thread::spawn(move || send(&address, &takes()[0], 60));
        let begun = std::time::Instant::now();
        while !is_done(person) && begun.elapsed().as_secs() < 60 {
            person.frames(1);
            std::thread::sleep(std::time::Duration::from_millis(5));
        }
        sender.join().unwrap()
    };
    let first = sends(&mut person, &|p| watched(p).is_some_and(|w| w.2 == 60));
    let (actor, _, _) = watched(&person).unwrap();
    person.command(Command::Live(LiveCommand::Range(Some((0.5, 1.0)))));
    drop(first);
    let again = sends(&mut person, &|p| {
        watched(p).is_some_and(|w| w.0 != actor && w.2 == 60)
    });
    let (other, gone, frames) = watched(&person).unwrap();
    assert!(
        other != actor && !gone && frames == 60,
        "{other:?} {gone} {frames}"
    );
    // What was selected was of the other sender's clock.
    assert_eq!(person.state().live.range, None);
    let run = person.state().live.run.as_ref().unwrap();
    assert_eq!(
        person.state().live.now_secs(),
        run.watched().unwrap().now_secs
    );
    drop(again);
}

#[test]
fn what_came_before_stop_can_still_be_labelled() {
    let (_folder, mut person) = before(Panel::Live, 0);
    let wave = takes()[0].labels.iter().find(|l| l.class == "wave");
    let wave = wave.unwrap().span;
    person.key(Key::Space);
    person.settle();
    while person.state().live.now_secs() < wave.stop_secs + 0.5 {
        person.frames(1);
    }
    person.key(Key::Space);
    let stopped = person.state().live.now_secs();
    person.wait(1.0);
    assert_eq!(person.state().live.now_secs(), stopped);
    assert!(person.sees_part("the last minutes can still be labelled"));
    person.command(Command::Live(LiveCommand::Range(Some((
        wave.start_secs,
        wave.stop_secs,
    )))));
    person.command(Command::Live(LiveCommand::MarkAs("wave".to_owned())));
    person.settle();
    assert_eq!(person.labels().len(), 1);
    // The next start begins anew.
    person.key(Key::Space);
    person.settle();
    person.frames(2);
    assert!(person.state().live.now_secs() < stopped && person.state().live.marks.is_empty());
}

#[test]
fn minutes_that_are_dropped_are_neither_shown_nor_selected() {
    use std::io::Write;
    let (_folder, mut person, address) = listening(0);
    let mut stream = std::net::TcpStream::connect(address).unwrap();
    let mut send = |person: &mut Person, from: i32| {
        for frame in from..from + 30 {
            let secs = f64::from(frame) / 30.0;
            let line = serde_json::json!({"t": secs, "hand": "right", "points": hand(secs)});
            writeln!(stream, "{line}").unwrap();
        }
        let last = f64::from(from + 29) / 30.0;
        let begun = std::time::Instant::now();
        while person.state().live.now_secs() != last && begun.elapsed().as_secs() < 60 {
            person.frames(1);
            std::thread::sleep(std::time::Duration::from_millis(5));
        }
    };
    send(&mut person, 300);
    person.command(Command::Live(LiveCommand::Range(Some((10.2, 10.8)))));
    // The sender's clock begins anew.
    send(&mut person, 0);
    assert_eq!(person.state().live.range, None);
    let run = person.state().live.run.as_ref().unwrap();
    assert_eq!(run.watched().unwrap().frames.len(), 30);
    assert!(person.sees_part("the sender's clock went back"));
}

#[test]
fn a_clip_as_a_source_is_sought_and_sped_up() {
    let (_folder, mut person) = before(Panel::Live, 0);
    person.key(Key::Space);
    person.settle();
    let position = |person: &Person| {
        let run = person.state().live.run.as_ref().unwrap();
        run.position().unwrap()
    };
    person.wait(1.0);
    let (before, secs) = position(&person);
    person.click("Live speed 4×");
    person.wait(1.0);
    let (after, _) = position(&person);
    assert!((3.5..5.0).contains(&(after - before)), "{before} {after}");
    person.click("Live speed 1×");
    let bar = person.place("Position in the clip");
    let middle = bar.center();
    person.click_at(middle);
    let (at, _) = position(&person);
    assert!((at - 0.5 * secs).abs() < 0.3, "{at} of {secs}");
    // Time on the stream goes on, and its moments are known.
    person.wait(0.5);
    let run = person.state().live.run.as_ref().unwrap();
    let (_, moment) = run.moment(run.now_secs).unwrap();
    assert!((moment - position(&person).0).abs() < 0.1, "{moment}");
    let times: Vec<f64> = run
        .watched()
        .unwrap()
        .frames
        .iter()
        .map(|f| f.time_secs)
        .collect();
    assert!(times.windows(2).all(|pair| pair[0] < pair[1]));
}

/// A right hand that opens and closes, metres: wrist, then each finger from base to tip, in the order of MediaPipe.
fn hand(secs: f64) -> Vec<[f64; 3]> {
    let bend = 0.4 + 0.35 * (4.0 * secs).sin();
    let way = [0.1 * (3.0 * secs).sin(), 1.2, 0.02 * secs.cos()];
    let mut points = vec![way];
    for finger in 0..5 {
        let start = if finger == 0 { 0.03 } else { 0.09 };
        let mut at = [
            way[0] + (2.5 - f64::from(finger)) * 0.02,
            way[1],
            way[2] + start,
        ];
        for joint in 1..=4 {
            points.push(at);
            let turned = bend * f64::from(joint);
            at = [
                at[0],
                at[1] - 0.026 * turned.sin(),
                at[2] + 0.026 * turned.cos(),
            ];
        }
    }
    points
}

#[test]
fn what_is_said_of_a_source_that_cannot_be_opened_goes_when_another_runs() {
    let folder = tempfile::tempdir().unwrap();
    let mut person = Person::before(&[made(folder.path(), 1)]);
    person.goes_to(Panel::Live);
    let nowhere = Choice::Network("json+tcp://nowhere".to_owned());
    person.command(Command::Live(LiveCommand::Choose(nowhere)));
    person.click("Start");
    assert_eq!(person.state().notices.len(), 1);
    person.command(Command::Live(LiveCommand::Choose(Choice::Clip(None))));
    person.click("Start");
    person.settle();
    assert!(person.state().live.run.is_some() && person.state().notices.is_empty());
}

#[test]
fn a_hand_is_seen_marked_kept_with_its_roles_and_spoils_no_training() {
    use std::io::Write;
    let (folder, mut person, address) = listening(2);
    let mut stream = std::net::TcpStream::connect(address).unwrap();
    for frame in 0..90 {
        let secs = f64::from(frame) / 30.0;
        let line = serde_json::json!({"t": secs, "hand": "right", "points": hand(secs)});
        writeln!(stream, "{line}").unwrap();
    }
    let begun = std::time::Instant::now();
    let came = |person: &Person| {
        let watched = person.state().live.run.as_ref().unwrap().watched();
        watched.map_or(0, |w| w.frames.len())
    };
    while came(&person) < 90 && begun.elapsed().as_secs() < 60 {
        person.frames(1);
        std::thread::sleep(std::time::Duration::from_millis(5));
    }
    person.frames(2);
    // It is drawn, in the middle of the picture and large enough to be seen.
    let watched = person.state().live.run.as_ref().unwrap().watched().unwrap();
    assert!(!watched.body.limbs.is_empty());
    let camera = &person.state().camera;
    let wrist = watched.pose.positions[watched.body.hips.unwrap()];
    assert!(
        (camera.target - wrist).norm() < 0.2,
        "{:?} {wrist:?}",
        camera.target
    );
    assert!(camera.distance < 1.5, "{}", camera.distance);
    // What it did last is marked by a key, and kept as a hand.
    person.key(Key::Num5);
    person.settle();
    assert!(
        !person.sees_part("no motion to mark yet"),
        "{}",
        person.state().said
    );
    let marked = person
        .labels()
        .into_iter()
        .filter(|l| l.1.starts_with("gesture"));
    let clip = morec_db::ClipId(marked.map(|l| l.0).next().unwrap());
    let db = MotionDb::open(&folder.path().join("moves.mdb")).unwrap();
    let roles = db.clip(clip).unwrap().roles;
    assert_eq!(
        roles
            .played()
            .filter(|(role, _)| !role.is_of_body())
            .count(),
        20
    );
    // Training sets it aside, by its name, and goes on with the bodies.
    assert!(
        person.state().train.index.is_some(),
        "{:?}",
        person.state().notices
    );
    let notes = &person.state().train.report.as_ref().unwrap().notes;
    let said = "have no bone in common with the others and are not used: gesture";
    assert!(notes.iter().any(|note| note.contains(said)), "{notes:?}");
}

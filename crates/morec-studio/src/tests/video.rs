//! A video beside a clip: chosen, brought into step, in the page of the clip, taken away; each is undone. Played along by another
//! program, heard, and brought into step by a clap.

use super::{Person, made};
use crate::state::{Command, PlayCommand};

#[cfg(unix)]
mod programs;

/// Time of the clip's video at which the clip begins, if it has one.
fn offset(person: &Person) -> Option<f64> {
    let clip = person.state().shown_clip().unwrap().id;
    let store = person.state().store.as_ref().unwrap();
    Some(store.snapshot.videos.get(&clip)?.offset_secs)
}

#[test]
fn a_video_is_brought_into_step_and_the_page_plays_it() {
    let folder = tempfile::tempdir().unwrap();
    let film = folder.path().join("film 1.webm");
    std::fs::write(&film, b"frames").unwrap();
    let mut person = Person::before(&[made(folder.path(), 1)]);
    assert_eq!(offset(&person), None);
    person.will_choose(&[&film]);
    person.click("Choose a video …");
    person.settle();
    assert_eq!(offset(&person), Some(0.0));
    assert!(person.sees("film 1.webm"));
    assert!(person.state().command_line.contains("--set-video"));
    person.types("Time of the video at which the clip begins", "1.5");
    assert_eq!(offset(&person), Some(1.5));
    person.command(Command::Play(PlayCommand::Seek(0.5)));
    person.types("Time of the video at the playhead", "1.25");
    assert_eq!(offset(&person), Some(0.75));
    person.undo();
    assert_eq!(offset(&person), Some(1.5));
    let page = folder.path().join("page.html");
    person.will_choose(&[&page]);
    person.click("A page with the video …");
    person.settle();
    let html = std::fs::read_to_string(&page).unwrap();
    assert!(html.contains(r#""video":{"address":"film%201.webm","offset":1.5}"#));
    assert!(person.state().command_line.contains("--video-offset 1.500"));
    person.click("Remove the video");
    person.settle();
    assert_eq!(offset(&person), None);
    person.undo();
    assert_eq!(offset(&person), Some(1.5));
    std::fs::remove_file(&film).unwrap();
    person.will_choose(&[&page]);
    person.click("A page with the video …");
    person.settle();
    assert!(person.state().said.contains("without its video"));
}

//! Clips are found by words: classes, tags, synonyms and captions, with the reason beside each.

use super::{Person, made};
use crate::state::{Command, LibraryCommand, Panel};

fn library() -> (tempfile::TempDir, Person) {
    let folder = tempfile::tempdir().unwrap();
    let person = Person::before(&[made(folder.path(), 2)]);
    (folder, person)
}

/// Names of the clips of the list, in its order.
fn listed(person: &Person) -> Vec<String> {
    let store = person.state().store.as_ref().unwrap();
    let shown = person.state().library.shown().iter();
    shown
        .map(|at| store.snapshot.clips[*at].name.clone())
        .collect()
}

#[test]
fn words_of_labels_find_their_clips_say_why_and_play_the_place() {
    let (_folder, mut person) = library();
    assert_eq!(listed(&person).len(), 3);
    person.types("Search clips", "waving");
    assert_eq!(listed(&person), ["ada_1", "ben_1"], "cleo has no label");
    let first = person.state().shown_samples().iter();
    let wave = first
        .into_iter()
        .find(|s| s.class == "wave")
        .unwrap()
        .clone();
    let reason = format!(
        "Found in class wave at {}",
        crate::format::secs(wave.start_secs)
    );
    assert!(person.sees_part(&reason), "{reason}");
    assert!(person.sees_part("2 clips described by these words"));
    assert!(person.state().command_line.ends_with("--words waving"));
    person.click("ada_1");
    person.settle();
    let looped = person.state().player.looped.unwrap();
    assert_eq!(looped, (wave.start_secs, wave.stop_secs));
    // A label that goes is found no longer, and found again when that is undone.
    let of_ben: Vec<_> = {
        let store = person.state().store.as_ref().unwrap();
        let all = store.snapshot.accepted();
        let waves = all.filter(|s| s.class == "wave" && s.clip_name == "ben_1");
        waves.map(|s| s.id).collect()
    };
    person.command(Command::Edit(crate::store::Edit::Remove(of_ben)));
    assert_eq!(listed(&person), ["ada_1"]);
    person.command(Command::Edit(crate::store::Edit::Undo(None)));
    assert_eq!(listed(&person), ["ada_1", "ben_1"]);
}

#[test]
fn tags_are_found_unknown_words_are_named_and_nothing_is_said_so() {
    let (_folder, mut person) = library();
    person.types("Tags", "indoors");
    person.types("Search clips", "indoors zzgrmpf");
    assert_eq!(listed(&person), ["ada_1"]);
    assert!(person.sees("Found in tag indoors"));
    assert!(person.sees("Not found: zzgrmpf"));
    assert!(person.sees_part("Nothing has all of these words"));
    person.types("Search clips", "zzgrmpf");
    assert!(listed(&person).is_empty());
    assert!(person.sees("No clip is described by these words."));
    person.command(Command::Library(LibraryCommand::Filter(String::new())));
    assert_eq!(listed(&person).len(), 3);
    assert!(!person.sees_part("described by"));
}

#[test]
fn captions_of_a_file_are_searched_beside_the_database() {
    let (folder, mut person) = library();
    let table = folder.path().join("captions.tsv");
    let text = "clip\tcaption\tstart_secs\tstop_secs\n\
        cleo_1\tshe stumbles over a carpet\t1.5\t2.5\nnobody\tstumbles, too\t\t\n";
    std::fs::write(&table, text).unwrap();
    person.types("Search clips", "stumble");
    assert!(listed(&person).is_empty());
    person.will_choose(&[&table]);
    person.click("Captions …");
    person.settle();
    assert_eq!(listed(&person), ["cleo_1"]);
    assert!(person.sees("Found in caption she stumbles over a carpet at 1.50 s"));
    assert!(person.sees("2 captions, 1 of clips that are not here"));
    person.click("cleo_1");
    person.settle();
    assert_eq!(person.state().player.looped, Some((1.5, 2.5)));
    std::fs::write(&table, "clip\twords\n").unwrap();
    person.will_choose(&[&table]);
    person.click("Captions …");
    person.settle();
    assert!(person.sees_part("captions.tsv: line 1"));
    // The list beside the tracks is the same.
    person.goes_to(Panel::Label);
    assert!(person.offers("Show cleo_1") && !person.offers("Show ada_1"));
}

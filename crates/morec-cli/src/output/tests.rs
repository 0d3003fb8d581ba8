use std::fs;
use std::io::Write;

use tempfile::TempDir;

use super::*;

fn names(folder: &Path) -> Vec<String> {
    let mut names: Vec<String> = fs::read_dir(folder)
        .unwrap()
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .collect();
    names.sort();
    names
}

#[test]
fn what_was_read_is_not_written_by_any_name() {
    let folder = TempDir::new().unwrap();
    let at = |name: &str| folder.path().join(name);
    fs::write(at("in.tsv"), "clip\tclass\n").unwrap();
    fs::hard_link(at("in.tsv"), at("hard.tsv")).unwrap();
    let mut ways = vec!["in.tsv", "hard.tsv", "./in.tsv"];
    #[cfg(unix)]
    {
        std::os::unix::fs::symlink(at("in.tsv"), at("soft.tsv")).unwrap();
        ways.push("soft.tsv");
    }
    mark_read(&at("in.tsv"));
    for way in ways {
        let refused = write_whole(&at(way), |out| out.write_all(b"new")).unwrap_err();
        assert!(refused.to_string().contains("in.tsv"), "{way}: {refused}");
        assert!(Output::create(&at(way)).is_err() && growing(&at(way)).is_err());
        assert_eq!(fs::read(at("in.tsv")).unwrap(), b"clip\tclass\n", "{way}");
    }
}

#[test]
fn what_becomes_an_input_while_the_output_is_made_is_left_alone() {
    let folder = TempDir::new().unwrap();
    let path = folder.path().join("a.bvh");
    fs::write(&path, "HIERARCHY").unwrap();
    let mut output = Output::create(&path).unwrap();
    output.write_all(b"clip\tstart\n").unwrap();
    mark_read(&path);
    assert!(output.finish().is_err());
    assert_eq!(fs::read(&path).unwrap(), b"HIERARCHY");
    assert_eq!(names(folder.path()), ["a.bvh"]);
}

#[test]
fn a_failure_leaves_what_was_there_and_nothing_else() {
    let folder = TempDir::new().unwrap();
    let path = folder.path().join("a.tsv");
    fs::write(&path, "a\tb\n").unwrap();
    let failed = write_whole(&path, |out| {
        out.write_all(b"c\td\n")?;
        Err(io::Error::other("no more"))
    });
    assert!(failed.is_err());
    drop(Output::create(&path).unwrap());
    assert_eq!(fs::read(&path).unwrap(), b"a\tb\n");
    assert_eq!(names(folder.path()), ["a.tsv"]);
}

#[test]
fn another_kind_of_file_is_kept_and_the_same_kind_replaced() {
    let folder = TempDir::new().unwrap();
    let path = folder.path().join("labels.tsv");
    let write = |text: &str| write_whole(&path, |out| out.write_all(text.as_bytes())).unwrap();
    write("clip\tclass\n");
    write("clip\tstart\tstop\n");
    assert_eq!(names(folder.path()), ["labels.tsv"]);
    write("<!doctype html>\n<html>");
    assert_eq!(names(folder.path()), ["labels.tsv", "labels.tsv.old"]);
    write("{\"a\": 1}");
    assert_eq!(names(folder.path()).len(), 3);
    let kept = fs::read_to_string(folder.path().join("labels.tsv.old")).unwrap();
    assert_eq!(kept, "clip\tstart\tstop\n");
}

#[test]
fn databases_and_folders_are_no_outputs() {
    let folder = TempDir::new().unwrap();
    let path = folder.path().join("m.mdb");
    fs::write(&path, b"SQLite format 3\0 and so on").unwrap();
    assert!(write_whole(&path, |out| out.write_all(b"x")).is_err());
    let refused = check(folder.path()).unwrap_err().to_string();
    assert!(refused.contains("folder"), "{refused}");
}

#[cfg(unix)]
#[test]
fn links_are_followed_and_permissions_stay() {
    use std::os::unix::fs::{PermissionsExt, symlink};
    let folder = TempDir::new().unwrap();
    let at = |name: &str| folder.path().join(name);
    fs::write(at("real.txt"), "old").unwrap();
    fs::set_permissions(at("real.txt"), fs::Permissions::from_mode(0o640)).unwrap();
    symlink(at("real.txt"), at("link.txt")).unwrap();
    write_whole(&at("link.txt"), |out| out.write_all(b"new")).unwrap();
    assert_eq!(fs::read(at("real.txt")).unwrap(), b"new");
    assert!(fs::symlink_metadata(at("link.txt")).unwrap().is_symlink());
    let mode = fs::metadata(at("real.txt")).unwrap().permissions().mode();
    assert_eq!(mode & 0o777, 0o640);
    write_whole(Path::new("/dev/null"), |out| out.write_all(b"gone")).unwrap();
}

#[test]
fn kinds_are_seen() {
    let kinds: [(&[u8], &str); 8] = [
        (b"HIERARCHY\nROOT a", "a BVH clip"),
        (b"\x10\x00\x00\x00\x00\x00\x00\x00{\"a\"", "an index"),
        (b"SQLite format 3\0", kind::DATABASE),
        (b"<?xml version=\"1.0\"?><svg>", "an SVG picture"),
        (b"clip\tclass\n", "a table"),
        (b"file,label\n", "a table"),
        (b"Dear reader,\n", "text"),
        (b"\xff\xfe\x00\x01", "a file of another kind"),
    ];
    for (head, kind) in kinds {
        assert_eq!(super::kind::of(head), Some(kind));
    }
    assert_eq!(super::kind::of(b""), None);
}

#[test]
fn where_nothing_can_be_written_is_named() {
    // Nothing binds root: the system's own errors stand for a disk and a folder.
    for (kind, said) in [
        (
            io::ErrorKind::ReadOnlyFilesystem,
            "x.index: its disk is read-only",
        ),
        (
            io::ErrorKind::PermissionDenied,
            "x.index: the file or its folder is read-only",
        ),
    ] {
        let error = Err::<(), _>(named(kind.into())).context("x.index");
        assert_eq!(format!("{:#}", error.unwrap_err()), said);
    }
    let folder = TempDir::new().unwrap();
    let absent = folder.path().join("absent/x.index");
    let refused = write_whole(&absent, |_| Ok(())).unwrap_err();
    assert_eq!(refused.to_string(), "its folder does not exist");
    // Before there is anything to write, and without a trace.
    check(&folder.path().join("x.index")).unwrap();
    assert!(names(folder.path()).is_empty());
}

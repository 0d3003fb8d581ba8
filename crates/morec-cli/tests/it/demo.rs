//! `morec demo` from a newcomer's side: one command, then the commands it printed.

use crate::kit::Folder;

/// The words of every command that the demo printed.
fn printed_commands(out: &str) -> Vec<Vec<&str>> {
    out.lines()
        .filter_map(|l| l.strip_prefix("$ morec "))
        .map(|l| l.split(' ').collect())
        .collect()
}

#[test]
fn the_whole_job_and_then_again_by_hand() {
    let folder = Folder::with(&[]);
    let out = folder.morec(&["demo", "--quiet"]).ok();
    for file in [
        "labels.tsv",
        "people.tsv",
        "truth.tsv",
        "found.tsv",
        "demo.index",
        "report/report.html",
    ] {
        let path = folder.path().join("morec-demo").join(file);
        assert!(std::fs::metadata(&path).unwrap().len() > 0, "{file}");
    }
    let clips = std::fs::read_dir(folder.path().join("morec-demo/clips"))
        .unwrap()
        .count();
    assert_eq!(clips, 2, "two people to train on");
    assert!(out.contains("is a demonstration, not a measurement"));
    let credits = folder.path().join("morec-demo/CREDITS.md");
    let credits = std::fs::read_to_string(credits).unwrap();
    assert!(credits.contains("obtained from mocap.cs.cmu.edu") && credits.contains("EIA-0196217"));

    let commands = printed_commands(&out);
    let names: Vec<&str> = commands.iter().map(|c| c[0]).collect();
    assert_eq!(names, ["train", "recognize", "evaluate"]);
    let with = |n: usize, more: &[&str]| {
        let words: Vec<&str> = commands[n]
            .iter()
            .copied()
            .chain(more.iter().copied())
            .collect();
        folder.morec(&words).ok()
    };
    let read =
        |name: &str| std::fs::read_to_string(folder.path().join("morec-demo").join(name)).unwrap();
    let found = read("found.tsv");
    std::fs::remove_file(folder.path().join("morec-demo/found.tsv")).unwrap();
    with(1, &[]);
    assert_eq!(read("found.tsv"), found);

    let figures: serde_json::Value = serde_json::from_str(&with(2, &["--json"])).unwrap();
    let rate = |name: &str| figures["overlap"][2][name].as_f64().unwrap();
    // All 17 signals, and one that is not there.
    assert!(
        rate("recall") >= 0.99 && rate("precision") >= 0.9,
        "{}",
        figures["overlap"][2]
    );

    // With no detection at all, every sample is missed and explained.
    let none = found.lines().next().unwrap().to_owned() + "\n";
    std::fs::write(folder.path().join("none.tsv"), none).unwrap();
    let explained = folder
        .morec(&[
            "evaluate",
            "--truth",
            "morec-demo/truth.tsv",
            "--found",
            "none.tsv",
            "--clips",
            "morec-demo/new",
            "--index",
            "morec-demo/demo.index",
            "--json",
        ])
        .ok();
    let explained: serde_json::Value = serde_json::from_str(&explained).unwrap();
    let missed = explained["missed"].as_array().unwrap();
    let samples = explained["totals"]["samples"].as_u64().unwrap() as usize;
    assert_eq!(missed.len(), samples, "every sample has a reason");
    assert!(missed.iter().all(|m| m["reason"]["kind"].is_string()));

    // The same person live, as fast as it goes: the same motions.
    let clip = std::fs::read_dir(folder.path().join("morec-demo/new"))
        .unwrap()
        .next()
        .unwrap()
        .unwrap();
    let source = format!(
        "clip://morec-demo/new/{}?speed=0",
        clip.file_name().to_string_lossy()
    );
    let told = folder
        .morec(&[
            "live",
            "morec-demo/demo.index",
            "--listen",
            &source,
            "--emit",
            "json:-",
            "--tentative",
        ])
        .ok();
    let events: Vec<serde_json::Value> = told
        .lines()
        .map(|l| serde_json::from_str(l).unwrap())
        .collect();
    let ends: Vec<(String, f64)> = events
        .iter()
        .filter(|e| e["phase"] == "end")
        .map(|e| {
            let class = e["class"].as_str().unwrap().to_owned();
            (class, e["start_secs"].as_f64().unwrap())
        })
        .collect();
    let recognised: Vec<(String, f64)> = found
        .lines()
        .skip(1)
        .map(|line| line.split('\t').collect::<Vec<_>>())
        .map(|cells| (cells[3].to_owned(), cells[6].parse().unwrap()))
        .collect();
    // The stream begins after the rest pose at the clip's beginning: its ticks lie elsewhere by less than one.
    let same = |(a, b): (&(String, f64), &(String, f64))| a.0 == b.0 && (a.1 - b.1).abs() < 0.05;
    assert!(
        ends.len() == recognised.len() && ends.iter().zip(&recognised).all(same),
        "{ends:?} {recognised:?}"
    );
    assert!(
        events.iter().any(|e| e["phase"] == "start"),
        "something must be reported before its end"
    );

    // Training is the long step: two classes and no everyday motion show that the line works.
    let trained = with(
        0,
        &["--classes", "traveling,pushing", "--everyday", "never"],
    );
    assert!(
        trained.contains("pushing") && trained.contains("demo.index"),
        "{trained}"
    );
}

#[test]
fn synthetic_people_replace_real_ones() {
    let folder = Folder::with(&[]);
    folder.morec(&["demo", "--quiet"]).ok();
    let out = folder.morec(&["demo", "--quiet", "--synthetic"]).ok();
    assert!(out.contains("say nothing about accuracy on real people"));
    let names = |part: &str| {
        let entries = std::fs::read_dir(folder.path().join("morec-demo").join(part)).unwrap();
        let name = |entry: std::io::Result<std::fs::DirEntry>| entry.unwrap().file_name();
        entries.map(name).collect::<Vec<_>>()
    };
    let clips = names("clips");
    assert!(clips.len() >= 5, "{clips:?}");
    assert!(clips.iter().all(|n| n.to_string_lossy().ends_with(".bvh")));
    assert_eq!(names("new").len(), 1);
    assert!(!folder.path().join("morec-demo/background").exists());
    let evaluate = printed_commands(&out).pop().unwrap();
    let words: Vec<&str> = evaluate.into_iter().chain(["--json"]).collect();
    let figures: serde_json::Value = serde_json::from_str(&folder.morec(&words).ok()).unwrap();
    let rate = |name: &str| figures["overlap"][2][name].as_f64().unwrap();
    // Far below what it reaches, far above what anything broken would.
    assert!(rate("recall") >= 0.6 && rate("precision") >= 0.6);
}

#[test]
fn other_peoples_folders_are_left_alone() {
    let folder = Folder::with(&[("mine/clip.bvh", "mine"), ("file", "mine")]);
    for (given, said) in [("mine", "nothing was written"), ("file", "found a file")] {
        let ran = folder.morec(&["demo", "--quiet", "--folder", given]);
        assert_eq!(ran.code, Some(1), "{ran:?}");
        assert!(ran.err.contains(said), "{}", ran.err);
    }
    assert_eq!(
        std::fs::read_dir(folder.path().join("mine"))
            .unwrap()
            .count(),
        1
    );
    assert_eq!(folder.morec(&["demo", "--speed", "0"]).code, Some(2));
}

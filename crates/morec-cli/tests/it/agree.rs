//! `morec agree`, on two tables of labels.

use serde_json::Value;

use crate::kit::Folder;

const ANN: &str = "clip\tclass\tstart_secs\tstop_secs\nday/one.avi\twalk\t0\t4\none\tjump\t6\t10\nhers\twalk\t0\t1\n";
const BEN: &str = "clip\tclass\tstart_secs\tstop_secs\none\twalk\t0\t3\none\tjump\t6\t10\n";

#[test]
fn two_annotators_are_compared_over_the_clips_of_both() {
    let folder = Folder::with(&[("ann.tsv", ANN), ("ben.tsv", BEN)]);
    let ran = folder.morec(&["agree", "ann.tsv", "ben.tsv", "--time-unit", "1", "--json"]);
    let said: Value = serde_json::from_str(&ran.ok()).unwrap();
    assert_eq!((&said["clips"], &said["secs"]), (&1.into(), &10.0.into()));
    assert_eq!(said["time"]["observed"], 0.9);
    // Walk 4 and 3 of 10 units, jump 4 and 4, no label 2 and 3.
    let kappa = (0.9 - 0.34) / (1.0 - 0.34);
    assert!((said["time"]["kappa"].as_f64().unwrap() - kappa).abs() < 1e-9);
    assert_eq!(said["events"]["matched"], 2);

    let page = folder.morec(&["agree", "ann.tsv", "ben.tsv", "--report", "page.html"]);
    let said = page.ok();
    assert!(
        said.contains("Cohen's kappa") && said.contains("no label"),
        "{said}"
    );
    assert!(folder.path().join("page.html").exists());
}

#[test]
fn what_cannot_be_compared_is_named() {
    let frames = "clip\tclass\tstart\tstop\none\twalk\t0\t40\n";
    let other = "clip\tclass\tstart_secs\tstop_secs\ntwo\twalk\t0\t3\n";
    let folder = Folder::with(&[
        ("ann.tsv", ANN),
        ("frames.tsv", frames),
        ("other.tsv", other),
    ]);
    let said = folder.morec(&["agree", "ann.tsv", "frames.tsv"]).fails();
    assert!(
        said.contains("frames.tsv: line 2") && said.contains("--label-rate"),
        "{said}"
    );
    let said = folder.morec(&["agree", "ann.tsv", "other.tsv"]).fails();
    assert!(said.contains("no clip is labelled by both"), "{said}");
    folder
        .morec(&["agree", "ann.tsv", "frames.tsv", "--label-rate", "10"])
        .ok();
}

#[test]
fn recordings_that_differ_in_their_ending_are_two() {
    let of = |first: &str, second: &str| {
        format!("clip\tclass\tstart_secs\tstop_secs\nrec.1\t{first}\t0\t4\nrec.2\t{second}\t0\t4\n")
    };
    let files = [
        ("ann.tsv", of("walk", "jump")),
        ("ben.tsv", of("jump", "walk")),
    ];
    let files = files.each_ref().map(|(name, text)| (*name, text.as_str()));
    let ran = Folder::with(&files).morec(&["agree", "ann.tsv", "ben.tsv", "--json"]);
    let said: Value = serde_json::from_str(&ran.ok()).unwrap();
    assert_eq!(
        (&said["clips"], &said["events"]["matched"]),
        (&2.into(), &0.into())
    );
}

#[test]
fn two_annotators_of_one_table_or_database_are_compared() {
    let both = ANN
        .replace("class\t", "class\tannotator\t")
        .replace("walk\t", "walk\tann\t");
    let both = both.replace("jump\t", "jump\tann\t").replace("day/", "");
    let ben = BEN
        .replace("walk\t", "walk\tben\t")
        .replace("jump\t", "jump\tben\t");
    let both = both + ben.split_once('\n').unwrap().1;
    let three = format!("{both}one\trun\tcid\t0\t1\n");
    let folder = Folder::with(&[
        ("ann.tsv", ANN),
        ("ben.tsv", BEN),
        ("both.tsv", &both),
        ("three.tsv", &three),
    ]);
    let json = |args: &[&str]| folder.morec(&[&["agree"], args, &["--json"]].concat()).ok();
    let expected = json(&["ann.tsv", "ben.tsv"]);
    assert_eq!(json(&["both.tsv"]), expected);
    assert_eq!(json(&["three.tsv", "--annotators", "ann,ben"]), expected);
    let said = folder.morec(&["agree", "three.tsv"]).fails();
    assert!(
        said.contains("found ann, ben, cid") && said.contains("--annotators"),
        "{said}"
    );
    let said = folder.morec(&["agree", "ann.tsv"]).fails();
    assert!(said.contains("labels without an annotator"), "{said}");
    let said = folder
        .morec(&["agree", "both.tsv", "--annotators", "ann,dan"])
        .fails();
    assert!(
        said.contains("expected labels by dan, found ann, ben"),
        "{said}"
    );
}

#[test]
fn annotators_are_kept_by_a_database_and_by_its_tables() {
    let (folder, takes) = crate::db::studio(1);
    let clip = &takes[0].clip.name;
    let table = |rows: &[(&str, f64, f64)]| {
        let rows = rows
            .iter()
            .map(|(class, start, stop)| format!("{clip}\t{class}\t{start}\t{stop}\n"));
        format!(
            "clip\tclass\tstart_secs\tstop_secs\n{}",
            rows.collect::<String>()
        )
    };
    let ann = table(&[("walk", 0.0, 1.0), ("jump", 2.0, 3.0)]);
    let ben = table(&[("walk", 0.0, 1.0), ("jump", 2.5, 3.0)]);
    for (name, text) in [("ann.tsv", ann), ("ben.tsv", ben)] {
        std::fs::write(folder.path().join(name), text).unwrap();
    }
    folder.morec(&["db", "init", "two.mdb"]).ok();
    folder.morec(&["db", "import", "two.mdb", "clips"]).ok();
    for name in ["ann", "ben"] {
        let file = format!("{name}.tsv");
        folder
            .morec(&["db", "label", "two.mdb", &file, "--annotator", name])
            .ok();
    }
    let listed = |args: &[&str]| -> Value {
        let all = [&["db", "samples", "two.mdb", "--json"], args].concat();
        serde_json::from_str(&folder.morec(&all).ok()).unwrap()
    };
    assert_eq!(
        listed(&[])[0]["annotators"],
        serde_json::json!(["ann", "ben"])
    );
    assert_eq!(listed(&["--annotator", "ben"]).as_array().unwrap().len(), 2);
    let of_database = folder.morec(&["agree", "two.mdb", "--json"]).ok();
    let of_files = folder
        .morec(&["agree", "ann.tsv", "ben.tsv", "--clips", "clips", "--json"])
        .ok();
    assert_eq!(of_database, of_files);
    folder.morec(&["db", "export", "two.mdb", "both.csv"]).ok();
    let both = folder
        .morec(&["agree", "both.csv", "--clips", "clips", "--json"])
        .ok();
    assert_eq!(both, of_files);
}

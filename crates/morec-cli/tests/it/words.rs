//! `morec db search --words`, with captions beside the clips.

use serde_json::Value;

#[test]
fn words_find_classes_captions_and_names() {
    let (folder, takes) = crate::db::studio(2);
    let [one, two] = [&takes[0].clip.name, &takes[1].clip.name];
    for command in ["init", "import", "label"] {
        let more = match command {
            "init" => vec![],
            "import" => vec!["clips"],
            _ => vec!["labels.tsv"],
        };
        folder
            .morec(&[&["db", command, "m.mdb"], &more[..]].concat())
            .ok();
    }
    let captions = format!("clip,caption\n{two},\"strolls, then greets\"\nabsent,runs\n");
    std::fs::write(folder.path().join("captions.csv"), captions).unwrap();
    std::fs::create_dir_all(folder.path().join("human/texts")).unwrap();
    let text = "someone hurdles#hurdle/VERB#0.5#1.0\n";
    std::fs::write(folder.path().join("human/texts/000007.txt"), text).unwrap();
    let index =
        format!("source_path,start_frame,end_frame,new_name\n./{one}.npy,10,60,000007.npy\n");
    std::fs::write(folder.path().join("human/index.csv"), index).unwrap();

    let search = |words: &str, more: &[&str]| -> Value {
        let all = [&["db", "search", "m.mdb", "--words", words, "--json"], more].concat();
        serde_json::from_str(&folder.morec(&all).ok()).unwrap()
    };
    let waving = search("waving", &[]);
    let hits = waving["hits"].as_array().unwrap();
    let waves = takes
        .iter()
        .flat_map(|take| &take.labels)
        .filter(|label| label.class == "wave");
    assert_eq!(hits.len(), waves.count());
    assert!(
        hits.iter()
            .all(|hit| hit["text"] == "wave" && hit["places"][0] == "class")
    );

    let beside = ["--captions", "captions.csv", "human", "--limit", "1"];
    let walk = search("walking slowly", &beside);
    assert_eq!(walk["hits"][0]["clip"], two.as_str());
    assert_eq!(walk["unknown"], serde_json::json!(["slowly"]));
    let hurdle = search("hurdle", &beside);
    let hit = &hurdle["hits"][0];
    assert_eq!(
        (&hit["clip"], &hit["start_secs"]),
        (&one.as_str().into(), &1.0.into())
    );

    let args = [
        "db",
        "search",
        "m.mdb",
        "--words",
        "wave",
        "--report",
        "hits.html",
    ];
    let table = folder.morec(&args).ok();
    assert!(
        table.contains("words in") && table.contains("class"),
        "{table}"
    );
    let page = std::fs::read_to_string(folder.path().join("hits.html")).unwrap();
    assert!(page.contains("<svg") && page.contains("Described by wave"));
    let none = folder.morec(&["db", "search", "m.mdb", "--words", "xylophone"]);
    assert!(none.err.contains("not found: xylophone"), "{none:?}");
    let both = folder.morec(&["db", "search", "m.mdb", one, "--words", "wave"]);
    assert_eq!(both.code, Some(2));
    assert_eq!(folder.morec(&["db", "search", "m.mdb"]).code, Some(2));
}

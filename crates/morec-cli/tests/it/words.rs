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

#[test]
fn vectors_of_a_table_rank_clips() {
    let (folder, takes) = crate::db::studio(3);
    let names: Vec<&str> = takes.iter().map(|take| take.clip.name.as_str()).collect();
    folder.morec(&["db", "init", "m.mdb"]).ok();
    folder.morec(&["db", "import", "m.mdb", "clips"]).ok();
    let [a, b, c] = [names[0], names[1], names[2]];
    let table = format!("clip\tx\ty\n{a}\t1\t0\n{b}.bvh\t-3\t0\n{c}\t3\t4\nabsent\t1\t0\n");
    std::fs::write(folder.path().join("clips.tsv"), table).unwrap();
    std::fs::write(
        folder.path().join("said.csv"),
        "a slow bow,0,2\nlong,1,2,3\n",
    )
    .unwrap();
    let search = |more: &[&str]| {
        let first = ["db", "search", "m.mdb", "--embeddings", "clips.tsv"];
        folder.morec(&[&first, more].concat())
    };
    let listed = |more: &[&str]| -> Vec<(String, f64)> {
        let found: Value = serde_json::from_str(&search(more).ok()).unwrap();
        let hit = |hit: &Value| {
            let score = (1e6 * hit["score"].as_f64().unwrap()).round() / 1e6;
            (hit["clip"].as_str().unwrap().to_owned(), score)
        };
        found["hits"].as_array().unwrap().iter().map(hit).collect()
    };
    // Another clip than its own, by the cosine: lengths do not count.
    let expected = [(c.to_owned(), 0.6), (b.to_owned(), -1.0)];
    assert_eq!(listed(&["--like", a, "--json"]), expected);
    assert_eq!(
        listed(&["--like", a, "--json", "--limit", "1"]),
        expected[..1]
    );
    let by_words = ["--queries", "said.csv", "--like", "a slow bow"];
    let refused = search(&by_words);
    assert!(refused.err.contains("line 2"), "{refused:?}");
    std::fs::write(folder.path().join("said.csv"), "a slow bow,0,2\n").unwrap();
    let table = search(&by_words);
    assert!(table.err.contains("1 vectors are of clips"), "{table:?}");
    assert!(
        table.out.contains("0.800") && table.out.contains("score"),
        "{table:?}"
    );
    let page = [&by_words[..], &["--report", "hits.html"]].concat();
    search(&page).ok();
    let page = std::fs::read_to_string(folder.path().join("hits.html")).unwrap();
    assert!(page.contains("<svg") && page.contains("Like a slow bow"));
    let none = search(&["--like", "nobody"]);
    assert!(
        none.code == Some(1) && none.err.contains("nobody"),
        "{none:?}"
    );
    std::fs::write(folder.path().join("said.csv"), "long,1,2,3\n").unwrap();
    let other = search(&["--queries", "said.csv", "--like", "long"]);
    assert!(other.err.contains("expected 2 numbers"), "{other:?}");
    assert_eq!(search(&[]).code, Some(2));
}

//! `morec budget`, on a table of labels and on a database.

use serde_json::Value;

use crate::kit::Folder;

const LABELS: &str = "clip\tclass\tstart_secs\tstop_secs\tperson\n\
    one\twalk\t0\t4\tann\none\tjump\t4\t6\tann\none\twalk\t8\t10\tann\ntwo\twalk\t0\t5\tben\n";

#[test]
fn time_is_divided_among_classes_and_people() {
    let folder = Folder::with(&[("labels.tsv", LABELS)]);
    let ran = folder.morec(&["budget", "labels.tsv", "--json", "--plot", "share.svg"]);
    let said: Value = serde_json::from_str(&ran.ok()).unwrap();
    assert_eq!((&said["clips"], &said["secs"]), (&2.into(), &15.0.into()));
    assert_eq!(said["unlabelled_secs"], 2.0);
    let walk = &said["classes"][1];
    assert_eq!(
        (&walk["class"], &walk["count"]),
        (&"walk".into(), &3.into())
    );
    assert_eq!(walk["total_secs"], 11.0);
    let ann = &said["people"][0];
    assert_eq!(
        (&ann["person"], &ann["secs"]),
        (&"ann".into(), &10.0.into())
    );
    assert_eq!(ann["classes"][1]["share"], 0.6);
    assert_eq!(
        said["transitions"]["counts"],
        serde_json::json!([[0, 1], [1, 0]])
    );
    folder
        .morec(&["budget", "labels.tsv", "-o", "budget.json"])
        .ok();
    let written = std::fs::read(folder.path().join("budget.json")).unwrap();
    assert_eq!(serde_json::from_slice::<Value>(&written).unwrap(), said);
    let picture = std::fs::read_to_string(folder.path().join("share.svg")).unwrap();
    assert!(
        picture.contains("73.3") && picture.contains("ann"),
        "{picture}"
    );

    let table = folder
        .morec(&["budget", "labels.tsv", "--report", "page.html"])
        .ok();
    assert!(
        table.contains("15.0 s; 2.0 s without a label (13.3 %)"),
        "{table}"
    );
    assert!(table.contains("Next label in the same clip"), "{table}");
    let page = std::fs::read_to_string(folder.path().join("page.html")).unwrap();
    for part in ["<svg", "15.0 s; 2.0 s", "<td>ann</td>", "<th>share</th>"] {
        assert!(page.contains(part), "{part}: {page}");
    }
}

#[test]
fn a_table_without_labels_is_an_error() {
    let folder = Folder::with(&[("labels.tsv", "clip\tclass\tstart_secs\tstop_secs\n")]);
    let said = folder.morec(&["budget", "labels.tsv"]).fails();
    assert!(said.contains("no label"), "{said}");
}

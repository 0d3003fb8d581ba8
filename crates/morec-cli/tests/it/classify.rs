//! Whole clips, named by an index.

use crate::db::studio;
use serde_json::Value;

#[test]
fn cut_clips_are_named_and_others_are_not() {
    let (folder, _) = studio(3);
    folder.train("a.index", &[]).ok();
    let table = folder.morec(&["classify", "a.index", "clips"]).ok();
    let lines: Vec<&str> = table.lines().collect();
    assert!(
        lines[0].starts_with("clip\tclass\tprobability\tnearest\t"),
        "{table}"
    );
    let columns = lines[0].split('\t').count();
    assert!(lines.len() > 1 && lines.iter().all(|line| line.split('\t').count() == columns));
    let rows = folder
        .morec(&["classify", "a.index", "clips", "--form", "jsonl"])
        .ok();
    for (line, row) in lines[1..].iter().zip(rows.lines()) {
        let row: Value = serde_json::from_str(row).unwrap();
        let cells: Vec<&str> = line.split('\t').collect();
        assert_eq!(row["clip"], cells[0]);
        assert_eq!(row["class"].as_str().unwrap_or(""), cells[1]);
        let sum: f64 = row["probabilities"]
            .as_object()
            .unwrap()
            .values()
            .filter_map(Value::as_f64)
            .sum();
        assert!((0.0..=1.0 + 1e-9).contains(&sum), "{row}");
    }
    let failed = folder
        .morec(&["classify", "a.index", "nothing.bvh"])
        .fails();
    assert!(failed.contains("nothing.bvh"), "{failed}");
}

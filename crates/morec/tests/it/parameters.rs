//! `docs/parameters.md` names parameters that exist, with the defaults of the code.

use std::path::Path;

use morec::train::TrainParams;
use morec::train::thesis::SvrdmTrainParams;
use serde_json::Value;

/// The value at a path such as `decode.rest_gate`, as the page shows it.
fn shown(params: &impl serde::Serialize, path: &str) -> Option<String> {
    // Through text, so that single-precision values keep their short form.
    let text = serde_json::to_string(params).unwrap();
    let tree: Value = serde_json::from_str(&text).unwrap();
    let value = tree.pointer(&format!("/{}", path.replace('.', "/")))?;
    Some(match value {
        Value::Number(number) => number.as_f64().unwrap().to_string(),
        Value::String(word) => word.clone(),
        other => other.to_string(),
    })
}

/// Rows of the page that differ from the code, and the number of all rows.
fn faults(page: &str) -> (Vec<String>, usize) {
    let (default, faithful) = (TrainParams::default(), SvrdmTrainParams::faithful());
    let tuned = SvrdmTrainParams::tuned();
    let (mut faults, mut rows, mut thesis) = (vec![], 0, false);
    for line in page.lines() {
        thesis |= line.starts_with("## The method of 2009");
        let cells: Vec<&str> = line.split('|').map(str::trim).collect();
        let name = cells.get(1).and_then(|cell| cell.strip_prefix('`'));
        let Some(name) = name.and_then(|cell| cell.strip_suffix('`')) else {
            continue;
        };
        rows += 1;
        let values = match thesis {
            false => vec![shown(&default, name)],
            true => vec![shown(&faithful, name), shown(&tuned, name)],
        };
        for (value, cell) in values.into_iter().zip(&cells[2..]) {
            if value.as_deref() != Some(cell) {
                faults.push(format!("{name}: {cell} is {value:?}"));
            }
        }
    }
    (faults, rows)
}

#[test]
fn the_page_of_parameters_has_names_and_defaults_of_the_code() {
    let wrong = "| `decode.rest_gate` | 0.7 | |\n| `no_such` | 1 | |\n";
    let (found, _) = faults(wrong);
    assert_eq!(
        found,
        [
            "decode.rest_gate: 0.7 is Some(\"0.6\")",
            "no_such: 1 is None"
        ]
    );

    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/parameters.md");
    let (found, rows) = faults(&std::fs::read_to_string(path).unwrap());
    assert!(rows > 20, "{rows}");
    assert!(found.is_empty(), "{}", found.join("\n"));
}

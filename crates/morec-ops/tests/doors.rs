//! The options and events of every door of morec are the same: what each door's sources declare, beside the types that all share.
//! `MOREC_WRITE_DOCS=1 cargo test -p morec-ops --test doors` writes `docs/options.md` again.

use std::fmt::Write as _;
use std::fs;
use std::path::PathBuf;

use clap::{Args as _, Command, FromArgMatches as _};
use morec::live::{SCORE, StreamOptions};
use morec::templates::Calibration;
use morec_ops::{StreamSettings, TrainSettings};
use serde::Serialize;
use serde_json::{Map, Value};

fn root() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../..")
}

fn read(path: &str) -> String {
    let text = fs::read_to_string(root().join(path));
    text.unwrap_or_else(|error| panic!("{path}: {error}"))
}

/// The part of `text` from `from` to the next `to`.
fn section<'t>(text: &'t str, from: &str, to: &str) -> &'t str {
    let (_, rest) = (text.split_once(from)).unwrap_or_else(|| panic!("no `{from}`"));
    rest.split_once(to).map_or(rest, |(section, _)| section)
}

fn fields(value: &impl Serialize) -> Map<String, Value> {
    match serde_json::to_value(value) {
        Ok(Value::Object(fields)) => fields,
        other => panic!("no fields: {other:?}"),
    }
}

fn camel(name: &str) -> String {
    let mut words = name.split('_');
    let first = words.next().unwrap_or_default().to_owned();
    words.fold(first, |all, word| {
        all + &word[..1].to_uppercase() + &word[1..]
    })
}

/// The value that Python's signature, the types of npm and C# say: `None` where that is morec's own.
fn is_default(declared: &str, default: &Value) -> bool {
    match default {
        Value::Null => declared == "None",
        Value::Bool(value) => declared == if *value { "True" } else { "False" },
        Value::String(text) => declared == format!("{text:?}"),
        Value::Number(number) => declared.parse().ok() == number.as_f64(),
        Value::Array(values) if values.is_empty() => ["()", "None"].contains(&declared),
        Value::Object(table) if table.is_empty() => declared == "None",
        _ => false,
    }
}

/// The default of a parameter of Python, `name: type = default,`.
fn python_default(signature: &str, name: &str) -> Option<String> {
    let line = (signature.lines().map(str::trim)).find(|l| l.starts_with(&format!("{name}:")))?;
    let (_, default) = line.rsplit_once(" = ")?;
    Some(default.trim_end_matches(',').to_owned())
}

/// How a door writes an option with its value, or why it cannot.
type Spelling = Box<dyn Fn(&str, &Value) -> Result<String, String>>;

/// A door, and what it calls an option; or why it has none of the name.
struct Door {
    name: &'static str,
    spelling: Spelling,
    /// Options that are said otherwise there.
    otherwise: &'static [(&'static str, &'static str)],
}

impl Door {
    fn cell(&self, option: &str, default: &Value) -> Result<String, String> {
        match self.otherwise.iter().find(|(name, _)| *name == option) {
            Some((_, words)) => Ok((*words).to_owned()),
            None => (self.spelling)(option, default).map(|name| format!("`{name}`")),
        }
    }
}

fn of_command(command: Command) -> impl Fn(&str, &Value) -> Result<String, String> {
    move |option, _| {
        let arg = command.get_arguments().find(|arg| arg.get_id() == option);
        let long = arg.and_then(|arg| arg.get_long());
        long.map(|long| format!("--{long}"))
            .ok_or_else(|| "no option of the command".to_owned())
    }
}

fn of_python(path: &str, from: &str) -> impl Fn(&str, &Value) -> Result<String, String> {
    let signature = section(&read(path), from, ") ->").to_owned();
    move |option, default| {
        let declared = python_default(&signature, option).ok_or("no keyword")?;
        match is_default(&declared, default) {
            true => Ok(option.to_owned()),
            false => Err(format!("the default is {declared}, not {default}")),
        }
    }
}

fn of_npm(interface: &str) -> impl Fn(&str, &Value) -> Result<String, String> {
    let types = read("crates/morec-wasm/npm/morec.d.ts");
    let declared = section(&types, &format!("export interface {interface} {{"), "\n}").to_owned();
    move |option, _| {
        let found = declared.contains(&format!("  {option}?: "));
        found
            .then(|| option.to_owned())
            .ok_or_else(|| "no field of the interface".to_owned())
    }
}

/// C#, in a struct and in the inspector.
fn of_unity(option: &str, _: &Value) -> Result<String, String> {
    let name = camel(option);
    let parts = [
        ("MotionStream.cs", "public struct StreamOptions", "internal"),
        (
            "MorecRecognizer.cs",
            "class MorecRecognizer",
            "static readonly",
        ),
        ("MorecRecognizer.cs", "new StreamOptions", "};"),
    ];
    for (file, from, to) in parts {
        let text = read(&format!("crates/morec-capi/unity/Runtime/{file}"));
        let part = section(&text, from, to);
        let is_there = part
            .split(|c: char| !c.is_alphanumeric())
            .any(|word| word == name);
        if !is_there {
            return Err(format!("not in {file}, {from}"));
        }
    }
    Ok(name)
}

fn of_godot(option: &str, _: &Value) -> Result<String, String> {
    let text = read("crates/morec-godot/src/lib.rs");
    let node = section(
        &text,
        "pub struct RecognizerNode {",
        "/// Bones of the skeleton in the order",
    );
    let exported = node.contains(&format!("    {option}: "));
    exported
        .then(|| option.to_owned())
        .ok_or_else(|| "no property".to_owned())
}

fn of_c(option: &str, _: &Value) -> Result<String, String> {
    let header = read("crates/morec-capi/include/morec.h");
    let options = section(&header, "typedef struct MorecOptions {", "} MorecOptions;");
    let flag = format!("MOREC_{}", option.to_uppercase());
    if options.contains(&format!(" {option};")) {
        Ok(format!("MorecOptions.{option}"))
    } else if header.contains(&format!("#define {flag} ")) {
        Ok(flag)
    } else {
        Err("neither a field nor a flag".to_owned())
    }
}

const SOURCES_AXES: (&str, &str) = ("up", "the source's");

fn stream_doors() -> Vec<Door> {
    let command = StreamSettings::augment_args(Command::new("live"));
    let open = read("crates/morec-cli/src/live/open.rs");
    assert!(open.contains("pub roles: Option<PathBuf>"));
    vec![
        Door {
            name: "`morec live`",
            spelling: Box::new(of_command(command)),
            otherwise: &[("roles", "`--roles FILE`"), SOURCES_AXES],
        },
        Door {
            name: "Python, `Index.recognizer`",
            spelling: Box::new(of_python(
                "crates/morec-py/python/morec/_morec.pyi",
                "def recognizer(",
            )),
            otherwise: &[],
        },
        Door {
            name: "Python, `morec.listen`",
            spelling: Box::new(of_python(
                "crates/morec-py/python/morec/_live.py",
                "def __init__(",
            )),
            otherwise: &[SOURCES_AXES],
        },
        Door {
            name: "npm, `recognizer(points, options)`",
            spelling: Box::new(of_npm("RecognizerOptions")),
            otherwise: &[],
        },
        Door {
            name: "C",
            spelling: Box::new(of_c),
            otherwise: &[
                (
                    "performer",
                    "`MOREC_PERFORMER_ANYONE`, `MOREC_PERFORMER_TEACHER`",
                ),
                ("roles", "`MorecSkeleton.roles`, `MorecOptions.roles`"),
                ("up", "`MorecOptions.up_axis`"),
            ],
        },
        Door {
            name: "Unity",
            spelling: Box::new(of_unity),
            otherwise: &[("roles", "`joints`"), ("up", "the engine's")],
        },
        Door {
            name: "Godot",
            spelling: Box::new(of_godot),
            otherwise: &[("up", "the engine's")],
        },
    ]
}

fn train_doors() -> Vec<Door> {
    vec![
        Door {
            name: "`morec train`",
            spelling: Box::new(of_command(TrainSettings::augment_args(Command::new(
                "train",
            )))),
            otherwise: &[],
        },
        Door {
            name: "Python, `morec.train`",
            spelling: Box::new(of_python(
                "crates/morec-py/python/morec/_learn.py",
                "def train(",
            )),
            otherwise: &[],
        },
        Door {
            name: "npm, `train(clips, labels, options)`",
            spelling: Box::new(of_npm("LearnOptions")),
            otherwise: &[("svrdm", "not in the package")],
        },
    ]
}

/// A table of the options by door; what is missing goes to `faults`.
fn options_table(
    defaults: &Map<String, Value>,
    doors: &[Door],
    faults: &mut Vec<String>,
) -> String {
    let names: Vec<&str> = doors.iter().map(|door| door.name).collect();
    let mut text = format!(
        "| option | default | {} |\n|---|---|{}\n",
        names.join(" | "),
        "---|".repeat(doors.len())
    );
    for (option, default) in defaults {
        let said = match default {
            Value::Null => "as trained".to_owned(),
            Value::Array(_) | Value::Object(_) => "none".to_owned(),
            Value::String(text) => text.clone(),
            value => value.to_string(),
        };
        let _ = write!(text, "| `{option}` | {said} |");
        for door in doors {
            let cell = door.cell(option, default);
            let cell = cell.unwrap_or_else(|why| {
                faults.push(format!("{}: {option}: {why}", door.name));
                "?".to_owned()
            });
            let _ = write!(text, " {cell} |");
        }
        text.push('\n');
    }
    text
}

/// Where each door says what an event has, how it spells a field there, and fields that are called otherwise.
type EventDoor = (
    &'static str,
    &'static str,
    (&'static str, &'static str),
    fn(&str) -> String,
    &'static [(&'static str, &'static str)],
);

const EVENT_DOORS: [EventDoor; 6] = [
    (
        "`json:`, `ws://`",
        "crates/morec-live/src/event.rs",
        ("pub fn json(&self)", "line.to_string()"),
        |field| format!("\"{field}\""),
        &[("wall_secs", "stop_wall")],
    ),
    (
        "Python",
        "crates/morec-py/src/tables.rs",
        ("pub fn event<'py>", "/// The detections of several"),
        |field| format!("\"{field}\""),
        &[],
    ),
    (
        "npm",
        "crates/morec-wasm/npm/morec.d.ts",
        ("/** Times are seconds. */", "/** x, y, z of each point"),
        |field| format!("  {field}"),
        &[],
    ),
    (
        "C, `MorecEvent`",
        "crates/morec-capi/include/morec.h",
        ("typedef struct MorecEvent {", "} MorecEvent;"),
        |field| format!(" {field};"),
        &[("class", "class_id"), ("actor", "")],
    ),
    (
        "Unity, `RecognisedMotion`",
        "crates/morec-capi/unity/Runtime/MorecRecognizer.cs",
        (
            "public struct RecognisedMotion",
            "public sealed class MotionUnityEvent",
        ),
        camel,
        &[
            ("class", "name"),
            ("motion", "number"),
            ("phase", ""),
            ("actor", ""),
        ],
    ),
    (
        "Godot, `motion_event`",
        "crates/morec-godot/src/lib.rs",
        ("fn dictionary(", "/// The bones of a skeleton"),
        |field| format!("\"{field}\""),
        &[],
    ),
];

/// Names of the fields of `Event`, as serialised rows have them.
fn event_fields() -> Vec<String> {
    let text = read("crates/morec/src/live/event.rs");
    let event = section(&text, "pub struct Event {", "\n}");
    let names = event
        .lines()
        .filter_map(|line| line.trim().strip_prefix("pub ")?.split_once(':'));
    names
        .flat_map(|(name, _)| match name {
            "span" => vec!["start_secs", "stop_secs"],
            "repetitions" => vec!["repetitions", "period_secs"],
            "deviation" => vec!["off_degrees", "worst_bone", "worst_degrees"],
            name => vec![name],
        })
        .map(str::to_owned)
        .collect()
}

fn events_table(faults: &mut Vec<String>) -> String {
    let names: Vec<&str> = EVENT_DOORS.iter().map(|door| door.0).collect();
    let mut text = format!(
        "| {} |\n|{}\n",
        names.join(" | "),
        "---|".repeat(names.len())
    );
    let sources =
        EVENT_DOORS.map(|(_, path, (from, to), ..)| section(&read(path), from, to).to_owned());
    for field in event_fields() {
        text.push('|');
        for ((door, _, _, spelled, otherwise), source) in EVENT_DOORS.iter().zip(&sources) {
            let other = otherwise.iter().find(|(name, _)| *name == field);
            let name = other.map_or(field.as_str(), |(_, other)| other);
            if !name.is_empty() && !source.contains(&spelled(name)) {
                faults.push(format!("{door}: events have no {name}"));
            }
            let shown = spelled(name);
            let shown = shown.trim_matches([' ', '"', ';']);
            let _ = match shown {
                "" => write!(text, " – |"),
                shown => write!(text, " `{shown}` |"),
            };
        }
        text.push('\n');
    }
    text
}

#[test]
fn every_door_has_every_option_and_every_field_of_an_event() {
    let mut faults = Vec::new();
    let stream = options_table(
        &fields(&StreamOptions::default()),
        &stream_doors(),
        &mut faults,
    );
    let train = options_table(
        &fields(&TrainSettings::default()),
        &train_doors(),
        &mut faults,
    );
    let events = events_table(&mut faults);
    assert!(faults.is_empty(), "{faults:#?}");
    let page = format!(
        "# Options by door\n\n\
         Made from the sources: `MOREC_WRITE_DOCS=1 cargo test -p morec-ops --test doors`. In Rust, options of a stream are \
         `morec::live::StreamOptions`, where each is described, and those of training `morec_ops::TrainSettings`.\n\n\
         ## Options of a stream\n\n{stream}\n\
         In C, Unity and Godot a sensitivity of 0 is as trained. The studio sets sensitivity and performer, and shows tentative motions and \
         the count of repetitions. A Python keyword, a field in npm, a flag or a field in C that is not given has the default.\n\n\
         ## Fields of an event\n\n{events}\n\
         C and Unity have one performer a stream; Unity has an event for each phase. `score`: {SCORE}\n\n\
         ## Options of training\n\n{train}"
    );
    let path = root().join("docs/options.md");
    if std::env::var_os("MOREC_WRITE_DOCS").is_some() {
        fs::write(&path, &page).unwrap();
    }
    assert_eq!(
        fs::read_to_string(&path).unwrap_or_default(),
        page,
        "docs/options.md is not that of the sources: MOREC_WRITE_DOCS=1 cargo test -p morec-ops --test doors"
    );
}

/// What the command line makes of nothing, and of every option, is what the others take as JSON.
#[test]
fn the_command_line_and_json_give_the_same_options() {
    let parsed = |words: &[&str]| {
        let command = StreamSettings::augment_args(Command::new("live").no_binary_name(true));
        let matches = command.try_get_matches_from(words).unwrap();
        StreamSettings::from_arg_matches(&matches)
            .unwrap()
            .options()
    };
    assert_eq!(parsed(&[]), StreamOptions::default());
    let all = "--sensitivity 0.5 --performer anyone --tentative --each-repetition --deviation --progress --refractory 2";
    let json = r#"{"sensitivity": 0.5, "performer": "anyone", "tentative": true, "each_repetition": true, "deviation": true, "progress": true, "refractory_secs": 2}"#;
    let words: Vec<&str> = all.split(' ').collect();
    assert_eq!(parsed(&words), StreamOptions::from_json(json).unwrap());
}

/// Text without marks of comments, in one line.
fn running(text: &str) -> String {
    let marks = |word: &&str| !["///", "*", "//!", "/**", "*/"].contains(word);
    text.split_whitespace()
        .filter(marks)
        .collect::<Vec<_>>()
        .join(" ")
}

#[test]
fn a_score_means_the_same_wherever_it_is_described() {
    let places = [
        "crates/morec/src/live/event.rs",
        "crates/morec/src/live/detection.rs",
        "crates/morec-cli/src/commands/recognize.rs",
        "crates/morec-py/python/morec/_morec.pyi",
        "crates/morec-py/python/morec/_live.py",
        "crates/morec-wasm/npm/morec.d.ts",
        "crates/morec-capi/src/event.rs",
        "crates/morec-capi/src/eight/segment.rs",
        "crates/morec-capi/include/morec.h",
        "crates/morec-capi/unity/Runtime/MorecRecognizer.cs",
        "docs/formats/labels.md",
        "docs/formats/live-json.md",
        "docs/guide/recognise.md",
    ];
    for place in places {
        let text = running(&read(place));
        assert!(
            text.contains(SCORE),
            "{place} does not say of a score: {SCORE}"
        );
        for wrong in [
            "0 just accepted … 1 identical to a sample",
            "0 for just accepted",
        ] {
            assert!(!text.contains(wrong), "{place} says: {wrong}");
        }
    }
    let least = [
        Calibration::MEASURED,
        Calibration::OF_LOOKS,
        Calibration::VERIFIED,
    ];
    let least = least.map(|c| c.probability(0.0, 0.0, 0.0));
    let range = (
        least.iter().copied().fold(1.0, f64::min),
        least.iter().copied().fold(0.0, f64::max),
    );
    assert_eq!(format!("{:.2} to {:.2}", range.0, range.1), "0.05 to 0.44");
    assert!(SCORE.contains("0.05 to 0.44"));
}

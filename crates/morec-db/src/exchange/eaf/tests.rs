//! Written files keep the rules of the schema (EAFv3.0.xsd, in words), and come back as they were.

use std::collections::BTreeSet;

use morec::labels::ClipLength;
use proptest::prelude::*;

use super::*;

fn lengths() -> ClipLengths {
    let length = ClipLength {
        frames: 3000,
        rate_hz: 30.0,
    };
    [("take \"1\"\r\n\t & <b>".to_owned(), length)].into()
}

/// Any labels of the one clip: names and people with all that XML sets apart, overlaps, states.
fn annotations() -> impl Strategy<Value = Vec<Annotation>> {
    let name = || prop::sample::select(vec!["wave", "a\tb\nc\rd", " x ", "<&>\"'", "größe"]);
    let person = prop::option::of(name().prop_map(str::to_owned));
    let state = prop::sample::select(vec![
        SampleState::Accepted,
        SampleState::Proposed,
        SampleState::Rejected,
    ]);
    let one = (name(), 0u32..3000, 1u32..90, person, state);
    let one = one.prop_map(|(class, start, frames, person, state)| Annotation {
        clip: lengths().into_keys().next().unwrap_or_default(),
        class: class.to_owned(),
        // Whole milliseconds come back as they are.
        extent: Some((f64::from(start) / 1e3, f64::from(start + frames) / 1e3)),
        person,
        score: None,
        state,
        annotator: None,
    });
    prop::collection::vec(one, 1..20)
}

fn sorted(annotations: &[Annotation]) -> Vec<String> {
    let mut all: Vec<String> = annotations.iter().map(|a| format!("{a:?}")).collect();
    all.sort();
    all
}

/// The children of an element, by name.
fn children<'a, 'd>(node: Node<'a, 'd>) -> Vec<(&'a str, Node<'a, 'd>)> {
    let elements = node.children().filter(Node::is_element);
    elements.map(|n| (n.tag_name().name(), n)).collect()
}

/// True if the names follow each other in this order, each as often as it likes.
fn in_order(names: &[(&str, Node)], order: &[&str]) -> bool {
    let place = |name: &str| order.iter().position(|known| *known == name);
    let places: Option<Vec<usize>> = names.iter().map(|(name, _)| place(name)).collect();
    places.is_some_and(|places| places.is_sorted())
}

fn keeps_the_rules(text: &str) {
    let document = Document::parse(text).unwrap();
    let root = document.root_element();
    let has = |node: Node, names: &[&str]| names.iter().all(|name| node.has_attribute(*name));
    assert!(root.has_tag_name("ANNOTATION_DOCUMENT"));
    assert!(has(root, &["AUTHOR", "DATE", "VERSION"]), "required");
    let parts = children(root);
    let order = ["HEADER", "TIME_ORDER", "TIER", "LINGUISTIC_TYPE"];
    assert!(in_order(&parts, &order), "{parts:?}");
    assert_eq!((parts[0].0, parts[1].0), ("HEADER", "TIME_ORDER"));
    let (header, times) = (parts[0].1, parts[1].1);
    assert!(header.has_attribute("MEDIA_FILE"));
    assert_eq!(header.attribute("TIME_UNITS"), Some("milliseconds"));
    assert!(in_order(
        &children(header),
        &["MEDIA_DESCRIPTOR", "LINKED_FILE_DESCRIPTOR", "PROPERTY"]
    ));
    // IDs are names without a colon, unlike each other in the whole document.
    let mut ids = BTreeSet::new();
    let mut is_new_id = |id: &str| {
        let name = id.chars().all(|c| c.is_alphanumeric() || "-_.".contains(c));
        name && id.starts_with(char::is_alphabetic) && ids.insert(id.to_owned())
    };
    let slots: Vec<(String, u32)> = children(times)
        .into_iter()
        .map(|(name, slot)| {
            assert_eq!(name, "TIME_SLOT");
            let (id, value) = (slot.attribute("TIME_SLOT_ID"), slot.attribute("TIME_VALUE"));
            assert!(is_new_id(id.unwrap()));
            (id.unwrap().to_owned(), value.unwrap().parse().unwrap())
        })
        .collect();
    assert!(slots.is_sorted_by_key(|slot| slot.1), "in order of time");
    let of = |name: &str| -> Vec<Node> {
        let named = parts.iter().filter(|part| part.0 == name);
        named.map(|part| part.1).collect()
    };
    let types: Vec<&str> = of("LINGUISTIC_TYPE")
        .iter()
        .map(|t| t.attribute("LINGUISTIC_TYPE_ID").unwrap())
        .collect();
    let mut tiers = BTreeSet::new();
    for tier in of("TIER") {
        assert!(tiers.insert(tier.attribute("TIER_ID").unwrap()));
        assert!(types.contains(&tier.attribute("LINGUISTIC_TYPE_REF").unwrap()));
        let mut end = 0;
        let mut rows: Vec<(u32, u32)> = Vec::new();
        for (name, annotation) in children(tier) {
            assert_eq!(name, "ANNOTATION");
            let [(name, aligned)] = children(annotation).try_into().unwrap();
            assert_eq!(name, "ALIGNABLE_ANNOTATION");
            assert!(is_new_id(aligned.attribute("ANNOTATION_ID").unwrap()));
            let time = |name: &str| {
                let id = aligned.attribute(name).unwrap();
                slots.iter().find(|slot| slot.0 == id).unwrap().1
            };
            rows.push((time("TIME_SLOT_REF1"), time("TIME_SLOT_REF2")));
            let [(name, _)] = children(aligned).try_into().unwrap();
            assert_eq!(name, "ANNOTATION_VALUE");
        }
        rows.sort_unstable();
        for (start, stop) in rows {
            assert!(end <= start && start < stop, "tiers do not overlap");
            end = stop;
        }
    }
}

proptest! {
    #[test]
    fn documents_keep_the_rules_and_come_back(all in annotations()) {
        let text = write(&all, &lengths()).unwrap();
        keeps_the_rules(&text);
        let again = read(&text, &LabelContext::default()).unwrap();
        prop_assert_eq!(sorted(&again.annotations), sorted(&all));
    }
}

#[test]
fn what_xml_cannot_hold_is_refused() {
    let annotation = |class: &str| Annotation {
        clip: lengths().into_keys().next().unwrap_or_default(),
        class: class.to_owned(),
        extent: Some((0.0, 1.0)),
        person: None,
        score: None,
        state: SampleState::Accepted,
        annotator: None,
    };
    let error = write(&[annotation("bell\u{7}")], &lengths()).unwrap_err();
    assert!(
        error.contains("cannot hold the character '\\u{7}'"),
        "{error}"
    );
    assert!(write(&[annotation("\u{9f}")], &lengths()).is_ok());
}

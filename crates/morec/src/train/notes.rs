//! Notes that the reports of both methods share.

use crate::classes::ClassInfo;

/// Notes about classes with few samples.
pub(crate) fn class_notes(classes: &[ClassInfo]) -> Vec<String> {
    let note = |class: &ClassInfo| match class.samples {
        0 => Some(format!(
            "{}: has no sample and will never be recognised",
            class.name
        )),
        1 => Some(format!(
            "{}: has a single sample; add more, by several people",
            class.name
        )),
        _ => None,
    };
    classes.iter().filter_map(note).collect()
}

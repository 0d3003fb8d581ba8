//! Labels in other programs' forms, read and written.
//!
//! All of them are read as [`Annotation`]s. Times are seconds from the clip's beginning; forms that count in
//! less (milliseconds in ELAN) come back to whole frames of the clip ([`snap`]). Forms that know one recording a file (ELAN, Audacity, BIDS) need to be
//! given the clip, unless morec wrote them.
//!
//! | form | times | keeps |
//! |---|---|---|
//! | TSV ([`morec::labels`]) | frames, or seconds where they lie on no frame | clip, class, person, annotator, whole clips, state |
//! | CSV | seconds and frames | all but who set it |
//! | JSON | seconds and frames | all but who set it |
//! | ELAN | milliseconds, so frames of up to 500 Hz | clip, class, person; state by tier |
//! | Audacity | seconds | class; the clip by the file's name ([`file_name`]); Praat's TextGrids, subtitles and events of C3D are read as it |
//! | BORIS | seconds | clip, class, person; its tables of events are read as TSV or CSV |
//! | BIDS events | seconds | class, annotator; the clip by the file's name (`…_events.tsv`) |
//! | BABEL | seconds | clip, class, whole clips, state (a key of ours) |
//! | Label Studio | seconds | clip, class, score; accepted ones as annotations, others as predictions |

mod annotation;
mod audacity;
mod babel;
mod bids;
mod boris;
mod boris_project;
mod captions;
mod csv;
mod eaf;
mod events;
mod file_names;
mod json;
mod label_studio;
mod resolve;
#[cfg(test)]
mod tests;
mod timed_text;
mod tsv;

pub use captions::{Caption, add_sources, read_captions};
pub use file_names::{clip_of_file_name, file_name, file_names};

use morec::formats::ParseError;

pub(crate) use annotation::text;
pub use annotation::{Annotation, ClipLengths, LabelContext, LabelFormat, ReadLabels, snap};
pub(crate) use csv::{records, separator};
pub use resolve::{ResolvedLabels, clip_lengths, clip_of_file, resolve};
pub use tsv::is_of_boris;

impl LabelFormat {
    /// The form that a file's ending says; text files are Audacity's, Praat's or subtitles, a C3D file stands for its events, JSON is distinguished by its content.
    pub fn of_file(name: &str, bytes: &[u8]) -> Option<Self> {
        match name.rsplit_once('.')?.1.to_ascii_lowercase().as_str() {
            "tsv" if bids::is_of_bids(bytes) => Some(LabelFormat::Bids),
            "tsv" => Some(LabelFormat::Tsv),
            "csv" => Some(LabelFormat::Csv),
            "eaf" => Some(LabelFormat::Eaf),
            "txt" | "textgrid" | "srt" | "vtt" | "c3d" => Some(LabelFormat::Audacity),
            "json" => Some(json::which(bytes)),
            "boris" => Some(LabelFormat::Boris),
            _ => None,
        }
    }
}

/// Reads labels. `clip` is the clip that a file of one clip refers to.
///
/// # Errors
/// The place and the reason why the file cannot be read; frames of a clip that `lengths` does not know are not an error but counted.
pub fn read(
    form: LabelFormat,
    bytes: &[u8],
    clip: Option<&str>,
    lengths: &ClipLengths,
) -> Result<ReadLabels, ParseError> {
    let context = LabelContext {
        clip,
        lengths: Some(lengths),
        ..LabelContext::default()
    };
    read_with(form, bytes, &context)
}

/// [`read`] with what is said beside the file.
///
/// # Errors
/// As [`read`]; a tier that the file does not have.
pub fn read_with(
    form: LabelFormat,
    bytes: &[u8],
    context: &LabelContext,
) -> Result<ReadLabels, ParseError> {
    match form {
        LabelFormat::Tsv => tsv::read(bytes, context),
        LabelFormat::Csv => csv::read(bytes, context),
        LabelFormat::Json => json::read(bytes, context),
        LabelFormat::Eaf => eaf::read(text(bytes)?, context),
        LabelFormat::Audacity => {
            if let (true, Some(clip)) = (events::is_c3d(bytes), context.clip) {
                return events::read(bytes, clip);
            }
            // Praat writes what is not ASCII so.
            let wide = annotation::of_utf16(bytes);
            let text = wide.as_deref().map_or_else(|| text(bytes), Ok)?;
            audacity::read(text, context.clip, context.tiers)
        }
        LabelFormat::Babel => babel::read(bytes),
        LabelFormat::LabelStudio => label_studio::read(bytes, context),
        LabelFormat::Boris => boris_project::read(bytes, context),
        LabelFormat::Bids => bids::read(bytes, context.clip),
    }
}

/// True if a file of one clip says which.
pub fn names_clip(form: LabelFormat, bytes: &[u8]) -> bool {
    form == LabelFormat::Eaf && text(bytes).is_ok_and(eaf::names_clip)
}

/// Writes labels. Forms of one clip take the annotations of one clip only.
///
/// # Errors
/// Annotations of several clips in a form of one; a clip whose length is needed and not known.
pub fn write(
    form: LabelFormat,
    annotations: &[Annotation],
    lengths: &ClipLengths,
) -> Result<String, String> {
    if form.is_of_one_clip()
        && annotations
            .windows(2)
            .any(|pair| pair[0].clip != pair[1].clip)
    {
        return Err(format!(
            "{} holds the labels of one clip only: write one file for each clip",
            form.name()
        ));
    }
    match form {
        LabelFormat::Tsv => tsv::write(annotations, lengths),
        LabelFormat::Csv => csv::write(annotations, lengths),
        LabelFormat::Json => json::write(annotations, lengths),
        LabelFormat::Eaf => eaf::write(annotations, lengths),
        LabelFormat::Audacity => audacity::write(annotations, lengths),
        LabelFormat::Babel => babel::write(annotations, lengths),
        LabelFormat::LabelStudio => label_studio::write(annotations, lengths),
        LabelFormat::Boris => boris_project::write(annotations, lengths),
        LabelFormat::Bids => bids::write(annotations, lengths),
    }
}

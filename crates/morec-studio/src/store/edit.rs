//! Edits of the database as values: what the window may change, each one step of the history.

use std::collections::BTreeMap;
use std::path::PathBuf;

use morec::roles::RoleMap;
use morec_db::labels::{DbSample, LabelOptions, NewSample, SampleId, SampleState, WholeClip};
use morec_db::{BACKGROUND, ClipId, ClipInfo, ClipUpdate, ClipVideo, DbError, MotionDb};

/// Author of the studio's labels in the database.
pub const BY: &str = "studio";

/// One change of the database.
#[derive(Debug, Clone, PartialEq)]
pub enum Edit {
    Label(Vec<NewSample>),
    /// Labels of files, beside what is there or in place of the labels of the clips they name.
    LabelFiles {
        paths: Vec<PathBuf>,
        samples: Vec<NewSample>,
        people: BTreeMap<ClipId, String>,
        annotators: Vec<Option<String>>,
        replace: bool,
    },
    /// Classes that whole clips show, and people in them.
    WholeClips(Vec<WholeClip>),
    /// A label that starts or stops elsewhere.
    Move {
        id: SampleId,
        start_secs: f64,
        stop_secs: f64,
    },
    /// Labels in place of others: splitting and merging.
    Replace {
        what: String,
        old: Vec<DbSample>,
        /// Each with its annotators.
        new: Vec<(NewSample, Vec<String>)>,
    },
    /// Samples of another class.
    Reclass {
        ids: Vec<SampleId>,
        class: String,
    },
    /// Samples that are forgotten.
    Remove(Vec<SampleId>),
    /// Another state of samples.
    Judge {
        ids: Vec<SampleId>,
        state: SampleState,
    },
    RenameClass {
        from: String,
        to: String,
    },
    /// The labels of a class become those of another.
    MergeClass {
        from: String,
        into: String,
    },
    /// A class shows none of the classes.
    ClassIsBackground(String),
    RemoveClass(String),
    Describe {
        clips: Vec<ClipId>,
        update: ClipUpdate,
    },
    /// Marks clips as background, or no longer.
    Background {
        clips: Vec<ClipId>,
        on: bool,
    },
    RenameClip {
        from: String,
        to: String,
    },
    RemoveClips(Vec<ClipId>),
    /// The video beside a clip of this name.
    Video {
        clip: String,
        video: Option<ClipVideo>,
    },
    /// Roles of the joints of clips.
    Roles(Vec<(ClipId, RoleMap)>),
    /// Cuts of a clip by hand, seconds.
    Cuts {
        what: String,
        clip: Box<ClipInfo>,
        cuts: Vec<f64>,
    },
    /// The cuts of a clip are forgotten.
    ForgetCuts(ClipId),
    KeepIndex {
        name: String,
        bytes: Vec<u8>,
    },
    /// Takes a step back: that of this number, or the last.
    Undo(Option<i64>),
    Redo,
}

/// The change that marks clips as background, or takes the mark away.
pub fn background(on: bool) -> ClipUpdate {
    let (mut add_tags, mut remove_tags) = (Vec::new(), Vec::new());
    let tags = if on { &mut add_tags } else { &mut remove_tags };
    tags.push(BACKGROUND.to_owned());
    ClipUpdate {
        add_tags,
        remove_tags,
        ..ClipUpdate::default()
    }
}

impl Edit {
    /// Makes the change; `annotator` is who says what is new. Gives a sentence for the status line.
    pub fn apply(&self, db: &mut MotionDb, annotator: Option<&str>) -> Result<String, DbError> {
        match self {
            Edit::Label(samples) => {
                let options = LabelOptions {
                    by: BY.to_owned(),
                    annotators: vec![annotator.map(str::to_owned); samples.len()],
                    ..LabelOptions::default()
                };
                let counts = db.label(samples, &options)?.counts;
                let class = samples.first().map_or("", |s| s.class.as_str());
                Ok(match counts.added + counts.changed {
                    0 if counts.annotated > 0 => format!("this label of {class} is yours, too"),
                    0 => "this label exists already".to_owned(),
                    1 => format!("labelled {class}"),
                    n => format!("{n} labels of {class}"),
                })
            }
            Edit::LabelFiles {
                samples,
                people,
                annotators,
                replace,
                ..
            } => {
                let options = LabelOptions {
                    by: BY.to_owned(),
                    replace: *replace,
                    dry_run: false,
                    people: people.clone(),
                    annotators: annotators.clone(),
                };
                let counts = db.label(samples, &options)?.counts;
                Ok(crate::format::changed_labels(&counts))
            }
            Edit::WholeClips(clips) => {
                let counts = db.label_clips(clips, BY, annotator)?;
                Ok(crate::format::changed_labels(&counts))
            }
            Edit::Move {
                id,
                start_secs,
                stop_secs,
            } => {
                db.move_sample(*id, *start_secs, *stop_secs, BY)?;
                Ok(format!("moved to {start_secs:.2}–{stop_secs:.2} s"))
            }
            Edit::Replace { what, old, new } => {
                db.change_samples(what, old, new, BY)?;
                Ok(what.clone())
            }
            Edit::Reclass { ids, class } => {
                let moved = db.split_class(ids, class)?;
                Ok(format!("{} now {class}", samples(moved)))
            }
            Edit::Remove(ids) => {
                let removed = db.remove_samples(ids)?;
                Ok(format!("{} removed", samples(removed)))
            }
            Edit::Judge { ids, state } => {
                let changed = match (state, annotator) {
                    (SampleState::Accepted, Some(name)) => db.accept_as(ids, name, BY)?,
                    _ => db.judge(ids, *state, BY)?,
                };
                Ok(format!("{} {}", samples(changed), state.name()))
            }
            Edit::RenameClass { from, to } => {
                db.rename_class(from, to)?;
                Ok(format!("{from} renamed to {to}"))
            }
            Edit::MergeClass { from, into } => {
                let moved = db.merge_classes(std::slice::from_ref(from), into)?;
                Ok(format!("{} moved from {from} to {into}", samples(moved)))
            }
            Edit::ClassIsBackground(name) => {
                let tagged = db.class_is_background(name)?;
                let clips = crate::format::count(tagged, "clip");
                Ok(format!("{name} removed, {clips} marked as background"))
            }
            Edit::RemoveClass(name) => {
                db.remove_class(name)?;
                Ok(format!("class {name} removed"))
            }
            Edit::Describe { clips, update } => {
                let n = db.update_clips(clips, update)?;
                Ok(format!("{} described", crate::format::count(n, "clip")))
            }
            Edit::Background { clips, on } => {
                let n = db.update_clips(clips, &background(*on))?;
                let clips = crate::format::count(n, "clip");
                Ok(match on {
                    true => format!("{clips} marked as background"),
                    false => format!("{clips} no longer background"),
                })
            }
            Edit::RenameClip { from, to } => {
                db.rename_clip(from, to)?;
                Ok(format!("{from} renamed to {to}"))
            }
            Edit::RemoveClips(clips) => {
                let labels = db.remove_clips(clips)?;
                let gone = crate::format::count(clips.len(), "clip");
                Ok(match labels {
                    0 => format!("{gone} removed"),
                    n => format!("{gone} removed, with {}", samples(n)),
                })
            }
            Edit::Video { clip, video } => {
                db.set_video(clip, video.as_ref())?;
                Ok(match video {
                    Some(video) => {
                        format!("{clip} begins at {:.2} s of its video", video.offset_secs)
                    }
                    None => format!("{clip} has no video"),
                })
            }
            Edit::Roles(clips) => {
                db.set_roles(clips)?;
                Ok(format!(
                    "roles of {} changed",
                    crate::format::count(clips.len(), "clip")
                ))
            }
            Edit::Cuts { what, clip, cuts } => {
                db.cut_by_hand(clip, cuts)?;
                Ok(what.clone())
            }
            Edit::ForgetCuts(clip) => {
                db.set_segments("none", &[*clip], &[])?;
                Ok("the automatic cuts are restored".to_owned())
            }
            Edit::KeepIndex { name, bytes } => {
                db.store_index(name, bytes)?;
                Ok(format!("index {name} stored in the database"))
            }
            Edit::Undo(step) => Ok(match db.undo(*step)? {
                Some(turned) => format!("undone: {}", turned.step.what),
                None => "nothing to undo".to_owned(),
            }),
            Edit::Redo => Ok(match db.redo(None)? {
                Some(turned) => format!("redone: {}", turned.step.what),
                None => "nothing to redo".to_owned(),
            }),
        }
    }
}

fn samples(n: usize) -> String {
    match n {
        1 => "1 label".to_owned(),
        n => format!("{n} labels"),
    }
}

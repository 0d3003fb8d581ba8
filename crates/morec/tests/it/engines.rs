//! The ways there are of running recognition; the conformance suite goes through all of them.

use std::sync::Arc;

use morec::features::BoneSet;
use morec::live::{Detection, Recognizer};
use morec::templates::TemplateModel;

use crate::made::Timed;

/// One way of running recognition.
pub struct Engine {
    /// What failures call it.
    pub name: &'static str,
    /// Recognises a whole stream, which ends with the last pose.
    pub run: fn(&Arc<TemplateModel>, BoneSet, &[Timed]) -> Vec<Detection>,
}

/// All of them.
pub const ENGINES: [Engine; 2] =
    [Engine { name: "inline", run: inline }, Engine { name: "inline, in batches", run: batches }];

pub fn inline(model: &Arc<TemplateModel>, bones: BoneSet, poses: &[Timed]) -> Vec<Detection> {
    let mut recognizer = Recognizer::new(model, bones).unwrap();
    let mut found = Vec::new();
    for (time_secs, pose) in poses {
        found.extend_from_slice(recognizer.push(*time_secs, pose));
    }
    found.extend_from_slice(recognizer.finish());
    found
}

fn batches(model: &Arc<TemplateModel>, bones: BoneSet, poses: &[Timed]) -> Vec<Detection> {
    let mut recognizer = Recognizer::new(model, bones).unwrap();
    let mut found = Vec::new();
    for batch in poses.chunks(37) {
        recognizer.push_all(batch, &mut found);
    }
    found.extend_from_slice(recognizer.finish());
    found
}

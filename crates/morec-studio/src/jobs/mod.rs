//! Long work on threads of its own: with progress, cancelled on request, its outcome collected frame by frame.

pub mod align;
pub mod channel;
pub mod cut;
pub mod discover;
pub mod example;
pub mod export;
pub mod group;
pub mod import;
pub mod judge;
pub mod label_files;
pub mod learning_curve;
pub mod load;
pub mod nearest;
mod progress;
pub mod propose;
pub mod recognise;
pub mod similar;
pub mod sound;
pub mod teach;
pub mod thesis;
pub mod train;
pub mod words;

use std::collections::BTreeSet;
use std::sync::Arc;
use std::sync::mpsc::{Receiver, TryRecvError, channel};

use morec::progress::Progress;

use crate::store::Wake;
pub use progress::{JobError, JobProgress, JobStage};

/// Result of a job.
pub enum JobOutcome {
    Imported(import::ImportSummary),
    /// Labels of files, not yet applied.
    LabelsRead(label_files::LabelFiles),
    Cut(cut::CutSummary),
    Loaded(load::DecodedClip),
    Curves(cut::Curves),
    Grouped(group::ClusteredItems),
    Discovered(morec_ops::DiscoveredSets),
    Proposed(usize),
    Trained(Box<train::TrainedIndex>),
    Judged(Box<judge::CrossvalResult>),
    Curve(morec_ops::LearningCurve),
    Taught(teach::Taught),
    /// Detections of an index in a clip.
    Recognised((morec_db::ClipId, Vec<morec::labels::ClipDetection>)),
    /// Detections at another sensitivity.
    Resensed(Vec<morec::live::Detection>),
    Similar(similar::Similar),
    /// What the text of the search field describes.
    Words(words::FoundWords),
    ComparedAnnotators(Box<morec_ops::ComparedAnnotators>),
    Captions(Vec<morec_db::exchange::Caption>),
    Sound(sound::ClipSound),
    Aligned(Arc<crate::body::Aligned>),
    Channel(channel::ChannelCurve),
    /// The method of 2009, trained, and its index.
    Thesis((Arc<thesis::Thesis>, Box<train::TrainedIndex>)),
    Map(thesis::Map),
    /// A file was written: what to say of it.
    Written(String),
    /// An example, or clips that were named, lie in a database now.
    Made(example::MadeDatabase),
    /// Classes that a new index still reports in what was marked as background.
    Silent(BTreeSet<String>),
    Stopped(JobError),
}

/// A job that is under way.
pub struct Job {
    /// Name for the status bar: "Importing clips".
    pub name: String,
    /// True if the status bar shows it; small jobs are over before anybody could read their name.
    pub shown: bool,
    progress: Arc<JobProgress>,
    outcome: Receiver<JobOutcome>,
}

impl Job {
    pub fn stage(&self) -> JobStage {
        self.progress.stage()
    }

    pub fn cancel(&self) {
        self.progress.cancel();
    }

    pub fn is_cancelled(&self) -> bool {
        self.progress.cancelled()
    }
}

/// All jobs that are under way.
#[derive(Default)]
pub struct Jobs {
    pub running: Vec<Job>,
}

impl Jobs {
    /// Starts `work` on a thread of its own; `outcome` is what its result is reported as.
    pub fn start<T: 'static>(
        &mut self,
        name: &str,
        shown: bool,
        wake: &Wake,
        outcome: fn(T) -> JobOutcome,
        work: impl FnOnce(&JobProgress) -> Result<T, JobError> + Send + 'static,
    ) {
        let progress = Arc::new(JobProgress::new(wake.clone()));
        let (sender, ended) = channel();
        let (theirs, wake) = (progress.clone(), wake.clone());
        let job = move || {
            let done = work(&theirs).map_or_else(JobOutcome::Stopped, outcome);
            // Nobody may listen any more: the window was closed.
            let _ = sender.send(done);
            wake();
        };
        // Without a thread the sender is dropped, which is a failure like any other.
        let _ = std::thread::Builder::new().name(name.to_owned()).spawn(job);
        self.running.push(Job {
            name: name.to_owned(),
            shown,
            progress,
            outcome: ended,
        });
    }

    /// Takes the results of the jobs that have ended since the last call.
    pub fn poll(&mut self) -> Vec<(String, JobOutcome)> {
        let mut ended = Vec::new();
        self.running.retain(|job| match job.outcome.try_recv() {
            Ok(outcome) => {
                ended.push((job.name.clone(), outcome));
                false
            }
            Err(TryRecvError::Empty) => true,
            Err(TryRecvError::Disconnected) => {
                let failed = format!("{}: ended without an answer", job.name);
                ended.push((
                    job.name.clone(),
                    JobOutcome::Stopped(JobError::Failed(failed)),
                ));
                false
            }
        });
        ended
    }

    pub fn is_running(&self, name: &str) -> bool {
        self.running.iter().any(|job| job.name == name)
    }
}

//! Proposals: more samples of the labelled classes.

use morec::progress::Progress;
use morec_db::{DbError, MotionDb, Proposal, ProposeOptions};
use serde::{Deserialize, Serialize};

/// Of which classes samples are proposed.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize, clap::Args)]
#[serde(default, deny_unknown_fields)]
pub struct ProposeSettings {
    /// Only these classes, separated by commas
    #[arg(long, value_delimiter = ',', value_name = "CLASSES")]
    pub classes: Vec<String>,
}

impl ProposeSettings {
    /// # Errors
    /// A class that there is not; the database cannot be read.
    pub fn check(&self, db: &MotionDb) -> Result<(), DbError> {
        self.classes
            .iter()
            .try_for_each(|class| db.need_class(class))
    }

    /// Proposes anew, in place of proposals that nobody judged, and keeps what it finds: the surest first.
    ///
    /// # Errors
    /// As [`check`](Self::check); the database cannot be written, or the receiver of progress cancelled.
    pub fn run(
        &self,
        db: &mut MotionDb,
        progress: &dyn Progress,
    ) -> Result<Vec<Proposal>, DbError> {
        self.check(db)?;
        let options = ProposeOptions {
            classes: self.classes.clone(),
            ..ProposeOptions::default()
        };
        db.propose_and_keep(&options, progress)
    }
}

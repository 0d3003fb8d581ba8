//! Lengths and frame rates of clips, from their files.

use std::collections::BTreeMap;
use std::path::PathBuf;

use anyhow::bail;
use morec::labels::ClipLength;

use crate::files::{ReadArgs, expand, open};
use crate::progress::SlowProgress;

/// Rate and length of every clip in `paths`, by name. What was repaired in them is for `morec inspect` to say.
pub fn lengths(paths: &[PathBuf], read: &ReadArgs) -> anyhow::Result<BTreeMap<String, ClipLength>> {
    let files = expand(paths)?;
    let mut progress = SlowProgress::new(files.len(), "reading clips");
    let mut lengths = BTreeMap::new();
    for file in files {
        for clip in open(&file, read)?.clips {
            let length = ClipLength::from(&clip);
            if lengths.insert(clip.name.clone(), length).is_some() {
                bail!(
                    "{}: another clip is called {} too; names must differ",
                    file.display(),
                    clip.name
                );
            }
        }
        progress.step();
    }
    Ok(lengths)
}

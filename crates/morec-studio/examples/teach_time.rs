//! From a mark on the live stream to the index that knows it, with about a hundred samples: of synthetic people, or of a
//! database that is named.
#![allow(clippy::print_stdout)] // An example prints.

use std::error::Error;
use std::path::{Path, PathBuf};

use morec::files::FileReader;
use morec::formats::bvh;
use morec::synth::{DatabaseSpec, database};
use morec_db::labels::NewSample;
use morec_db::{ClipUpdate, MotionDb};
use morec_studio::measure::teaching;

const TIMES: usize = 10;

fn main() -> Result<(), Box<dyn Error>> {
    let folder = std::env::temp_dir().join(format!("morec-teach-time-{}", std::process::id()));
    std::fs::create_dir_all(&folder)?;
    let done = measure(&folder);
    std::fs::remove_dir_all(&folder)?;
    done
}

fn measure(folder: &Path) -> Result<(), Box<dyn Error>> {
    let path = folder.join("taught.mdb");
    match std::env::args_os().nth(1) {
        // What is marked stays in the copy.
        Some(named) => std::fs::copy(PathBuf::from(named), &path).map(|_| ())?,
        None => made(folder, &path)?,
    }
    let lessons = teaching(&path, TIMES)?;
    println!("{} samples", lessons.samples);
    println!("first training {:.2} s", lessons.first_secs);
    for (name, mut secs) in [
        ("training again", lessons.training_secs),
        ("from the mark to the index in use", lessons.in_use_secs),
    ] {
        secs.sort_by(f64::total_cmp);
        let (median, slowest) = (secs[secs.len() / 2], secs[secs.len() - 1]);
        println!("{name}: median {median:.2} s, slowest {slowest:.2} s of {TIMES}");
    }
    Ok(())
}

/// A database of five synthetic people, four gestures each five times: 100 samples.
fn made(folder: &Path, path: &Path) -> Result<(), Box<dyn Error>> {
    let spec = DatabaseSpec {
        people: 5,
        repetitions: 5,
        classes: vec!["wave", "raise_hands", "clap", "bow"],
        ..DatabaseSpec::default()
    };
    let mut db = MotionDb::create(path)?;
    for take in database(2009, &spec) {
        let file = folder.join(format!("{}.bvh", take.clip.name));
        let mut bytes = Vec::new();
        bvh::write(&take.clip, &mut bytes)?;
        std::fs::write(&file, bytes)?;
        let about = ClipUpdate {
            subject: Some(take.person.clone()),
            ..ClipUpdate::default()
        };
        db.import(&[file], &FileReader::default(), &about, &())?;
        let clip = db.find_clip(&take.clip.name)?.id;
        let sample = |label: &morec::labels::Mark<&'static str>| {
            NewSample::accepted(clip, label.class, label.span)
        };
        let samples: Vec<NewSample> = take.labels.iter().map(sample).collect();
        db.add_samples(&samples, "teach_time")?;
    }
    Ok(())
}

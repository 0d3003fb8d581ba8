//! From the drop of a dragged label to the frame that shows it from the disk: 5,000 clips, 10,000 labels, 1,000 steps.
#![allow(clippy::print_stdout)] // An example prints.

use std::error::Error;
use std::path::Path;

use morec::TimeSpan;
use morec::files::FileReader;
use morec::formats::bvh;
use morec::synth::{Person, Script};
use morec_db::labels::{NewSample, SampleFilter};
use morec_db::{ClipFilter, ClipUpdate, MotionDb};

const CLIPS: usize = 5000;
const TIMES: usize = 1000;

fn main() -> Result<(), Box<dyn Error>> {
    let folder = std::env::temp_dir().join(format!("morec-edit-time-{}", std::process::id()));
    std::fs::create_dir_all(&folder)?;
    let done = measure(&folder);
    std::fs::remove_dir_all(&folder)?;
    done
}

fn measure(folder: &Path) -> Result<(), Box<dyn Error>> {
    let path = folder.join("clips.mdb");
    made(folder, &path)?;
    let took = morec_studio::measure::drops(&path, TIMES)?;
    let at = |share: f64| took[((took.len() - 1) as f64 * share).round() as usize];
    println!(
        "dropped until shown from the disk: p50 {:.1} ms, p99 {:.1} ms, most {:.1} ms",
        at(0.5),
        at(0.99),
        at(1.0)
    );
    Ok(())
}

/// A database of clips with two labels each, and as many steps as are kept.
fn made(folder: &Path, path: &Path) -> Result<(), Box<dyn Error>> {
    let take = Script::new(1, Person::draw(1, 0)).rest(0.5);
    let take = take.film("clip", 30.0)?;
    let mut bytes = Vec::new();
    bvh::write(&take.clip, &mut bytes)?;
    let mut files = Vec::with_capacity(CLIPS);
    for number in 0..CLIPS {
        let file = folder.join(format!("clip_{number:05}.bvh"));
        // A line end more makes it another file.
        let ends = "\n".repeat(number);
        std::fs::write(&file, [&bytes[..], ends.as_bytes()].concat())?;
        files.push(file);
    }
    let mut db = MotionDb::create(path)?;
    let about = ClipUpdate::default();
    db.import(&files, &FileReader::default(), &about, &())?;
    let clips = db.clips(&ClipFilter::default())?;
    let label = |n: usize| {
        NewSample::accepted(
            clips[n / 2].id,
            &format!("gesture {}", n % 8 + 1),
            TimeSpan::new(0.25 * (n % 2) as f64, 0.25 * (n % 2) as f64 + 0.2),
        )
    };
    let labels: Vec<NewSample> = (0..2 * clips.len()).map(label).collect();
    db.add_samples(&labels, "edit_time")?;
    for sample in db.samples(&SampleFilter::default())?.iter().step_by(10) {
        let (start, stop) = (sample.start_secs + 0.01, sample.stop_secs + 0.01);
        db.move_sample(sample.id, start, stop, "edit_time")?;
    }
    println!(
        "{} clips, {} labels, {} steps",
        clips.len(),
        labels.len(),
        db.history()?.len()
    );
    Ok(())
}

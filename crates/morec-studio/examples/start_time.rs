//! From the start to the first frame, with a database of 5,000 clips.
#![allow(clippy::print_stdout)] // An example prints.

use std::error::Error;

use morec::files::FileReader;
use morec::formats::bvh;
use morec::synth::{Person, Script};
use morec_db::{ClipUpdate, MotionDb};

const CLIPS: usize = 5000;
const TIMES: usize = 10;

fn main() -> Result<(), Box<dyn Error>> {
    let folder = std::env::temp_dir().join(format!("morec-start-time-{}", std::process::id()));
    std::fs::create_dir_all(&folder)?;
    let done = measure(&folder);
    std::fs::remove_dir_all(&folder)?;
    done
}

fn measure(folder: &std::path::Path) -> Result<(), Box<dyn Error>> {
    let mut files = Vec::with_capacity(CLIPS);
    for number in 0..CLIPS {
        let person = Person::draw(number as u64, 0);
        let take = Script::new(number as u64, person)
            .rest(0.5)
            .film("clip", 30.0)?;
        let path = folder.join(format!("clip_{number:05}.bvh"));
        let mut bytes = Vec::new();
        bvh::write(&take.clip, &mut bytes)?;
        std::fs::write(&path, bytes)?;
        files.push(path);
    }
    let path = folder.join("clips.mdb");
    let mut db = MotionDb::create(&path)?;
    let about = ClipUpdate::default();
    let report = db.import(&files, &FileReader::default(), &about, &())?;
    drop(db);
    println!("{} clips", report.counts().imported);
    let mut secs: Vec<f64> = (0..TIMES)
        .map(|_| morec_studio::measure::first_frame_secs(&path))
        .collect();
    secs.sort_by(f64::total_cmp);
    println!(
        "first frame: median {:.3} s, slowest {:.3} s",
        secs[TIMES / 2],
        secs[TIMES - 1]
    );
    Ok(())
}

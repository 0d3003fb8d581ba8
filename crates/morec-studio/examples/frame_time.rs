//! Processor time of a frame: an hour with 10,000 labels, a database of 5,000 clips.
#![allow(clippy::print_stdout)] // An example prints.

use morec_studio::measure::{Load, frame_times};

fn main() -> Result<(), String> {
    let load = Load {
        clips: 5000,
        labels: 10_000,
        secs: 3600.0,
        frames: 600,
    };
    println!("{load:?}");
    for m in frame_times(&load)? {
        println!("{:28} p50 {:5.2} ms   p99 {:5.2} ms", m.scene, m.p50, m.p99);
    }
    Ok(())
}

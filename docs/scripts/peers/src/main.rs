//! Reading BVH beside `bvh_anim`, and dynamic time warping beside `dtw_rs`, on one core in one run.
//!
//! Each in turn, five times; the least time of each. Warping is compared by cells, a row of a template at a tick of a stream: `dtw_rs`
//! aligns two sequences from end to end and keeps the whole table, morec finds where each template ends at every tick.

use std::hint::black_box;
use std::process::ExitCode;
use std::time::Instant;

use dtw_rs::{Algorithm, DynamicTimeWarping};
use morec::features::Rows;
use morec::formats::Limits;
use morec::formats::bvh::{self, BvhOptions};
use morec::import::{ImportOptions, normalize};
use morec::synth::Rng;
use morec::templates::TemplateBank;

const ROUNDS: usize = 5;

fn main() -> ExitCode {
    let files: Result<Vec<Vec<u8>>, _> = std::env::args().skip(1).map(std::fs::read).collect();
    match files {
        Ok(files) if !files.is_empty() => reading(&files),
        Ok(_) => println!("reading: skipped, no file is named"),
        Err(error) => {
            eprintln!("{error}");
            return ExitCode::FAILURE;
        }
    }
    warping();
    ExitCode::SUCCESS
}

/// Runs all, in turn; gives the least seconds of each.
fn least<const N: usize>(mut runs: [&mut dyn FnMut(); N]) -> [f64; N] {
    let mut least = [f64::INFINITY; N];
    for _ in 0..ROUNDS {
        for (run, least) in runs.iter_mut().zip(&mut least) {
            let start = Instant::now();
            run();
            *least = least.min(start.elapsed().as_secs_f64());
        }
    }
    least
}

fn reading(files: &[Vec<u8>]) {
    let read = |file: &Vec<u8>| bvh::read(file, "clip", &BvhOptions::default(), &Limits::default());
    // Files that one of the two refuses say nothing of speed.
    let both = |file: &&Vec<u8>| {
        let peer = std::panic::catch_unwind(|| bvh_anim::from_bytes(file).is_ok());
        peer.unwrap_or(false) && read(file).is_ok()
    };
    let files: Vec<&Vec<u8>> = files.iter().filter(both).collect();
    let megabytes = files.iter().map(|file| file.len()).sum::<usize>() as f64 / 1e6;
    let each = |run: &dyn Fn(&Vec<u8>)| files.iter().for_each(|file| run(file));
    let [alone, prepared, peer] = least([
        &mut || each(&|file| drop(black_box(read(file)))),
        &mut || {
            each(&|file| {
                let clips = read(file).map(|loaded| loaded.clips).unwrap_or_default();
                for clip in clips {
                    let _ = black_box(normalize(clip, &ImportOptions::default()));
                }
            });
        },
        &mut || each(&|file| drop(black_box(bvh_anim::from_bytes(file)))),
    ]);
    println!("reading {} BVH files, {megabytes:.1} MB", files.len());
    for (what, secs) in [
        ("morec, read", alone),
        ("morec, read and prepared", prepared),
        ("bvh_anim", peer),
    ] {
        println!(
            "  {what:<26}{:>8.0} MB/s{:>8.2} x",
            megabytes / secs,
            peer / secs
        );
    }
}

/// Values in a row, rows of a template and ticks of the stream.
const DIM: usize = 70;
const LENGTH: usize = 60;
const TICKS: usize = 600;

fn rows(seed: u64, count: usize) -> Rows {
    let mut rng = Rng::new(seed);
    Rows::from_values(DIM, (0..count * DIM).map(|_| rng.unit() as f32).collect())
}

fn warping() {
    let templates: Vec<Rows> = (0..30).map(|seed| rows(seed, LENGTH)).collect();
    let stream = rows(99, TICKS);
    let lines = |rows: &Rows| rows.iter().map(<[f32]>::to_vec).collect::<Vec<_>>();
    let (template, long) = (lines(&templates[0]), lines(&stream));
    let apart = |a: &Vec<f32>, b: &Vec<f32>| -> f64 {
        let squares = a.iter().zip(b).map(|(a, b)| (a - b) * (a - b));
        f64::from(squares.sum::<f32>())
    };
    let mut bank = TemplateBank::new(&templates, DIM);
    let [one, together, peer] = least([
        &mut || stream.iter().for_each(|row| bank.step(row)),
        &mut || {
            let mut bank = TemplateBank::new(&templates, DIM);
            bank.step_through(stream.iter(), |bank| {
                black_box(bank.matched(0));
            });
        },
        &mut || {
            let aligned = DynamicTimeWarping::with_closure(&template, &long, apart);
            black_box(aligned.distance());
        },
    ]);
    let cells = (LENGTH * TICKS) as f64;
    let of_bank = cells * templates.len() as f64;
    println!("warping, templates of {LENGTH} rows of {DIM} values");
    for (what, secs) in [
        ("morec, tick by tick", one / of_bank),
        ("morec, as for clips", together / of_bank),
        ("dtw_rs", peer / cells),
    ] {
        println!(
            "  {what:<26}{:>8.2} ns a cell{:>8.1} x",
            secs * 1e9,
            peer / cells / secs
        );
    }
}

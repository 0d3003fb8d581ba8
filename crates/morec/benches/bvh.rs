//! How fast BVH is read and written, one core: `cargo bench -p morec --bench bvh`.
//!
//! Bytes a second of the file, beside two limits: `count_lines` looks at every byte once and does nothing else, and
//! `numbers_alone` splits at blanks and converts each number with `fast-float2`, the fastest reader of numbers that is kept, without
//! making a single rotation of them. At the end, `read` and `write` as shares of both, for a synthetic clip and, where `MOREC_DATA` has
//! them, for real ones (shorter numbers: fewer bytes for the same work).

// What is shared lies outside of test functions, where the lint looks for it.
#![allow(clippy::unwrap_used, clippy::print_stdout)]

use std::time::{Duration, Instant};

use divan::Bencher;
use divan::counter::BytesCount;
use morec::clip::Clip;
use morec::formats::bvh::{self, BvhOptions};
use morec::formats::{Limits, Loaded};
use morec::import::{ImportOptions, normalize};
use morec::synth::{DatabaseSpec, database};

fn main() {
    divan::main();
    shares();
}

/// A minute or two of one person.
fn clip() -> Clip {
    let spec = DatabaseSpec {
        people: 1,
        repetitions: 3,
        rate_hz: 120.0,
        ..DatabaseSpec::default()
    };
    database(1, &spec).remove(0).clip
}

fn file() -> Vec<u8> {
    let mut bytes = Vec::new();
    bvh::write(&clip(), &mut bytes).unwrap();
    bytes
}

fn parse(bytes: &[u8]) -> Loaded {
    bvh::read(bytes, "clip", &BvhOptions::default(), &Limits::default()).unwrap()
}

fn newlines(bytes: &[u8]) -> usize {
    bytes.iter().filter(|&&b| b == b'\n').count()
}

fn sum_of_numbers(bytes: &[u8]) -> f64 {
    let tokens = bytes.split(|b| b.is_ascii_whitespace());
    tokens
        .filter_map(|token| fast_float2::parse::<f64, _>(token).ok())
        .sum()
}

#[divan::bench]
fn read(bencher: Bencher) {
    let bytes = file();
    bencher
        .counter(BytesCount::new(bytes.len()))
        .bench_local(|| parse(&bytes));
}

/// The work of `morec inspect` without the diagnosis of the stream.
#[divan::bench]
fn read_and_prepare(bencher: Bencher) {
    let bytes = file();
    bencher
        .counter(BytesCount::new(bytes.len()))
        .bench_local(|| {
            let clip = parse(&bytes).clips.remove(0);
            normalize(clip, &ImportOptions::default()).unwrap()
        });
}

#[divan::bench]
fn write(bencher: Bencher) {
    let (clip, bytes) = (clip(), file().len());
    let mut out = Vec::with_capacity(bytes);
    bencher.counter(BytesCount::new(bytes)).bench_local(|| {
        out.clear();
        bvh::write(&clip, &mut out).unwrap();
    });
}

#[divan::bench]
fn count_lines(bencher: Bencher) {
    let bytes = file();
    bencher
        .counter(BytesCount::new(bytes.len()))
        .bench_local(|| newlines(&bytes));
}

#[divan::bench]
fn numbers_alone(bencher: Bencher) {
    let bytes = file();
    bencher
        .counter(BytesCount::new(bytes.len()))
        .bench_local(|| sum_of_numbers(&bytes));
}

/// The best of some runs.
fn best<T>(mut run: impl FnMut() -> T) -> Duration {
    let once = |_| {
        let start = Instant::now();
        std::hint::black_box(run());
        start.elapsed()
    };
    (0..15).map(once).min().unwrap_or_default()
}

fn shares() {
    println!("a synthetic clip");
    print_shares(&[file()]);
    let folder = std::env::var("MOREC_DATA").unwrap_or_else(|_| "../../../shared/data".into());
    let folder = std::path::Path::new(&folder).join("referee/clips");
    let files: Vec<Vec<u8>> = std::fs::read_dir(&folder)
        .into_iter()
        .flatten()
        .filter_map(|entry| Some(entry.ok()?.path()))
        .filter(|path| path.extension().is_some_and(|ending| ending == "bvh"))
        .filter_map(|path| std::fs::read(path).ok())
        .collect();
    match files.is_empty() {
        true => println!("real clips: skipped, none in {}", folder.display()),
        false => {
            println!("{} real clips", files.len());
            print_shares(&files);
        }
    }
}

fn print_shares(files: &[Vec<u8>]) {
    let bytes: usize = files.iter().map(Vec::len).sum();
    let clips: Vec<Clip> = files.iter().flat_map(|file| parse(file).clips).collect();
    let each = |run: &dyn Fn(&[u8])| best(|| files.iter().for_each(|file| run(file)));
    let numbers = each(&|file| {
        std::hint::black_box(sum_of_numbers(file));
    });
    let read = each(&|file| {
        std::hint::black_box(parse(file));
    });
    let prepare = each(&|file| {
        let clip = parse(file).clips.remove(0);
        std::hint::black_box(normalize(clip, &ImportOptions::default()).unwrap());
    });
    let lines = each(&|file| {
        std::hint::black_box(newlines(file));
    });
    let mut out = Vec::with_capacity(2 * bytes);
    let write = best(|| {
        out.clear();
        for clip in &clips {
            bvh::write(clip, &mut out).unwrap();
        }
    });
    let convert = each(&|file| {
        let mut out = Vec::with_capacity(2 * file.len());
        for clip in parse(file).clips {
            bvh::write(&clip, &mut out).unwrap();
        }
        std::hint::black_box(out);
    });
    let runs = [
        ("count_lines", lines, bytes),
        ("read", read, bytes),
        ("read and prepare", prepare, bytes),
        ("write", write, out.len()),
        ("read and write", convert, bytes),
    ];
    for (name, time, bytes) in runs {
        println!(
            "  {name}: {:.0} MB/s, {:.2} times the time of fast-float2 over the same numbers",
            bytes as f64 / time.as_secs_f64() / 1e6,
            time.as_secs_f64() / numbers.as_secs_f64()
        );
    }
}

//! How fast recognition runs, stage by stage: `cargo bench -p morec`.
//!
//! Items are ticks of a stream (30 a second) in `bank` and frames at 60 Hz in `features` and `whole_path`, so that
//! items a second say how many streams one core could follow. `bank/plain` is the same dynamic program as it is
//! written in books, to hold `bank/step` against: a double loop in single precision over the same rows. `bank/read` reads
//! as many bytes as the rows of the templates have, once a tick, and does nothing else.

// What tests share lies outside of test functions, where the lint looks for it.
#![allow(clippy::unwrap_used)]

#[path = "../tests/it/made.rs"]
mod made;

use std::sync::Arc;

use divan::Bencher;
use divan::counter::ItemsCount;
use morec::classes::ClassId;
use morec::features::{FeatureParams, FeatureStream, Rows};
use morec::live::Recognizer;
use morec::synth::Rng;
use morec::templates::TemplateModel;

fn main() {
    divan::main();
}

/// Values in a row: eleven bones.
const DIM: usize = 70;
/// Rows of a template: two seconds.
const LENGTH: usize = 60;

fn rows(seed: u64, count: usize) -> Rows {
    let mut rng = Rng::new(seed);
    Rows::from_values(DIM, (0..count * DIM).map(|_| rng.unit() as f32).collect())
}

fn templates(rows_in_all: usize) -> Vec<Rows> {
    (0..rows_in_all / LENGTH)
        .map(|n| rows(n as u64, LENGTH))
        .collect()
}

mod bank {
    use super::*;
    use morec::templates::TemplateBank;

    /// The bank's step over this many template rows.
    #[divan::bench(args = [600, 1800])]
    fn step(bencher: Bencher, template_rows: usize) {
        let mut bank = TemplateBank::new(&templates(template_rows), DIM);
        let stream = rows(99, 64);
        bencher
            .counter(ItemsCount::new(stream.len()))
            .bench_local(|| {
                stream.iter().for_each(|row| bank.step(row));
                bank.matched(0).distance
            });
    }

    /// The same four ticks at a time, as for clips.
    #[divan::bench(args = [600, 1800])]
    fn step_through(bencher: Bencher, template_rows: usize) {
        let mut bank = TemplateBank::new(&templates(template_rows), DIM);
        let stream = rows(99, 64);
        bencher
            .counter(ItemsCount::new(stream.len()))
            .bench_local(|| {
                let mut sum = 0.0;
                bank.step_through(stream.iter(), |bank| sum += bank.matched(0).distance);
                sum
            });
    }

    /// The same, plainly.
    #[divan::bench(args = [600, 1800])]
    fn plain(bencher: Bencher, template_rows: usize) {
        let (templates, stream) = (templates(template_rows), rows(99, 64));
        let mut tables: Vec<Plain> = templates.iter().map(|_| Plain::new(LENGTH)).collect();
        bencher
            .counter(ItemsCount::new(stream.len()))
            .bench_local(|| {
                for row in stream.iter() {
                    templates
                        .iter()
                        .zip(&mut tables)
                        .for_each(|(template, table)| table.step(template, row));
                }
                tables[0].columns[0][LENGTH - 1]
            });
    }

    /// Reading as many bytes as the templates' rows have, of 16 bits a value.
    #[divan::bench(args = [600, 1800])]
    fn read(bencher: Bencher, template_rows: usize) {
        let table = vec![7u64; template_rows * DIM / 4];
        let ticks = 64usize;
        bencher.counter(ItemsCount::new(ticks)).bench_local(|| {
            let mut sums = [0; 32];
            for _ in 0..ticks {
                for chunk in divan::black_box(&table[..]).as_chunks::<32>().0 {
                    sums.iter_mut()
                        .zip(chunk)
                        .for_each(|(sum, value)| *sum ^= value);
                }
            }
            sums
        });
    }

    /// One template's cells at this tick and the two before, and its local costs at this and the last.
    struct Plain {
        columns: [Vec<f32>; 3],
        costs: [Vec<f32>; 2],
    }

    impl Plain {
        fn new(length: usize) -> Self {
            Self {
                columns: std::array::from_fn(|_| vec![1e30; length]),
                costs: std::array::from_fn(|_| vec![0.0; length]),
            }
        }

        fn step(&mut self, template: &Rows, row: &[f32]) {
            self.columns.rotate_right(1);
            self.costs.rotate_right(1);
            let ([now, before, earlier], [cost, last_cost]) = (&mut self.columns, &mut self.costs);
            for (j, t) in template.iter().enumerate() {
                cost[j] = t.iter().zip(row).map(|(a, b)| (a - b) * (a - b)).sum();
                now[j] = match j {
                    0 => cost[0],
                    _ => {
                        let even = before[j - 1] + cost[j];
                        let slow = earlier[j - 1] + 0.5 * (last_cost[j] + cost[j]);
                        let fast = if j > 1 {
                            before[j - 2] + cost[j - 1] + cost[j]
                        } else {
                            1e30
                        };
                        even.min(slow).min(fast)
                    }
                };
            }
        }
    }
}

/// Ten seconds of gestures at 60 Hz.
fn poses() -> (morec::features::BoneSet, Vec<made::Timed>) {
    let script = made::right_handed(3, 1)
        .rest(1.0)
        .play("wave")
        .play("look_around")
        .play("clap")
        .rest_until(10.0);
    made::poses(&script.film("bench", 60.0).expect("motions that there are"))
}

/// Poses to feature rows.
#[divan::bench]
fn features(bencher: Bencher) {
    let (bones, poses) = poses();
    let mut stream = FeatureStream::new(bones, &FeatureParams::default());
    bencher
        .counter(ItemsCount::new(poses.len()))
        .bench_local(|| {
            let mut sum = 0.0;
            for (time_secs, pose) in &poses {
                stream.push(*time_secs, pose, &mut |row| sum += row[0]);
            }
            stream.finish(&mut |row| sum += row[0]);
            sum
        });
}

/// Poses to detections, with an index of 48 samples.
#[divan::bench]
fn whole_path(bencher: Bencher) {
    recognise(bencher, &made::model());
}

/// The same with eight activities beside the gestures.
#[divan::bench]
fn whole_path_with_activities(bencher: Bencher) {
    let mut model = (*made::model()).clone();
    let of_one = made::activity_model().activities.expect("an activity");
    let mut eight = of_one.clone();
    for class in 1..8 {
        for row in of_one.windows.rows.iter() {
            eight.windows.rows.push(row);
            eight.windows.classes.push(ClassId(class));
        }
    }
    model.activities = Some(eight);
    recognise(bencher, &Arc::new(model));
}

fn recognise(bencher: Bencher, model: &Arc<TemplateModel>) {
    let (bones, poses) = poses();
    let mut recognizer = Recognizer::new(model, bones).expect("a model of its own making");
    let mut found = Vec::with_capacity(64);
    bencher
        .counter(ItemsCount::new(poses.len()))
        .bench_local(|| {
            found.clear();
            recognizer.push_all(&poses, &mut found);
            found.extend_from_slice(recognizer.finish());
            found.len()
        });
}

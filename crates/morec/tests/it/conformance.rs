//! Expected detections in the streams of `testdata/recognition/`: every engine of [`ENGINES`] goes through every case at
//! every rate.

use morec::live::Detection;
use morec::synth::MotionKind;

use crate::cases::{Case, cases};
use crate::engines::ENGINES;
use crate::made::{self, Timed};

#[test]
fn every_engine_finds_what_every_case_expects() {
    let cases = cases();
    assert!(cases.len() >= 6);
    let mut wrong = Vec::new();
    for (name, case) in &cases {
        for &rate_hz in &case.rates_hz {
            run(
                case,
                &format!("{name} at {rate_hz} Hz"),
                rate_hz,
                &mut wrong,
            );
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// For whoever writes a case: what its person performs, to be put under `expect`.
#[test]
#[ignore = "prints; run with --ignored --nocapture"]
fn print_what_is_performed() {
    for (name, case) in cases() {
        println!("{name}");
        for l in case.take(60.0).keep(MotionKind::Gesture).labels {
            println!(
                "    {{\"class\": \"{}\", \"start_secs\": {:.2}, \"stop_secs\": {:.2}}},",
                l.class, l.span.start_secs, l.span.stop_secs
            );
        }
    }
}

/// Runs every engine and adds what is wrong with what it found to `wrong`.
fn run(case: &Case, name: &str, rate_hz: f64, wrong: &mut Vec<String>) {
    let model = made::model();
    let (bones, poses) = made::poses(&case.take(rate_hz));
    let poses = case.stream.carry(&poses);
    let clock_secs = case.stream.clock_secs;
    for engine in ENGINES {
        let found = (engine.run)(&model, bones, &poses);
        let class = |d: &Detection| model.classes[d.class.index()].name.clone();
        let near = |found: f64, expected: f64| {
            (found - clock_secs - expected).abs() <= case.tolerance_secs
        };
        let right = found.iter().zip(&case.expect).all(|(d, e)| {
            class(d) == e.class
                && near(d.span.start_secs, e.start_secs)
                && near(d.span.stop_secs, e.stop_secs)
        });
        if !right || found.len() != case.expect.len() {
            let tell = |d: &Detection| {
                (
                    class(d),
                    d.span.start_secs - clock_secs,
                    d.span.stop_secs - clock_secs,
                    d.score,
                )
            };
            let found: Vec<_> = found.iter().map(tell).collect();
            wrong.push(format!(
                "{name}, {}: found {found:.2?}, expected {:.2?}",
                engine.name, case.expect
            ));
        }
        wrong.extend(
            report_faults(&found, &poses).map(|fault| format!("{name}, {}: {fault}", engine.name)),
        );
    }
}

/// Reports come in order, at the time of a pose that has arrived, and within a fifth of a second and two frames.
fn report_faults<'a>(
    found: &'a [Detection],
    poses: &'a [Timed],
) -> impl Iterator<Item = String> + 'a {
    let ordered = |w: &[Detection]| {
        w[0].reported_secs <= w[1].reported_secs
            && w[0].span.stop_secs <= w[1].span.start_secs + 1e-9
    };
    let disorder = (!found.windows(2).all(ordered)).then(|| "out of order".to_owned());
    let late = found.iter().filter_map(|d| {
        if !poses
            .iter()
            .any(|(time_secs, _)| *time_secs == d.reported_secs)
        {
            return Some(format!(
                "reported at {}, when no pose came",
                d.reported_secs
            ));
        }
        let between = poses
            .iter()
            .filter(|p| p.0 > d.span.stop_secs + 0.2 && p.0 < d.reported_secs)
            .count();
        (between > 2).then(|| {
            format!(
                "reported {:.3} s after its end",
                d.reported_secs - d.span.stop_secs
            )
        })
    });
    disorder.into_iter().chain(late)
}

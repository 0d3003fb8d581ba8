//! Draws docs/guide/activities.svg: what a session says of a synthetic person who waves eight times.
//! `cargo run --release -p morec-measure --example activity_picture > docs/guide/activities.svg`.

#![allow(clippy::unwrap_used, clippy::print_stdout)]

use std::sync::Arc;

use morec::TimeSpan;
use morec::live::{Event, EventOptions, Frame, Performer, PerformerId, Phase, Rig};
use morec_measure::plot::{Bar, LaneChart};

#[path = "../../morec/tests/it/made.rs"]
#[allow(dead_code)]
mod made;

/// Bars that follow each other are this far apart, seconds.
const GAP_SECS: f64 = 0.06;

fn main() {
    let (model, take) = (Arc::new(made::activity_model()), made::waving(3));
    let options = EventOptions {
        tentative: true,
        each_repetition: true,
        ..EventOptions::default()
    };
    let mut performer = Performer::new(&model, PerformerId(0), &options);
    let mut events: Vec<Event> = Vec::new();
    performer.set_rig(&Arc::new(Rig::of_roles()));
    let mut frame = Frame::default();
    for (time_secs, pose) in made::poses(&take).1 {
        frame.time_secs = time_secs;
        frame.set_key_pose(&pose);
        events.extend_from_slice(performer.push(&frame));
    }
    events.extend_from_slice(performer.finish());
    let bar = |kind: usize| {
        move |span: TimeSpan| Bar {
            span: TimeSpan {
                stop_secs: span.stop_secs - GAP_SECS,
                ..span
            },
            kind,
        }
    };
    let performed = take.labels.iter().map(|l| l.span);
    let of = |phase: Phase| events.iter().filter(move |e| e.phase == phase);
    let bounds = |e: &Event| e.span;
    let moment = |e: &Event| TimeSpan::new(e.reported_secs, e.reported_secs + 0.06 + GAP_SECS);
    let count = of(Phase::End).find_map(|e| e.repetitions).unwrap().count;
    let kinds = [
        "waves without a pause, as performed".to_owned(),
        format!("the activity with its start and end: {count} repetitions"),
        "each repetition as an event of its own".to_owned(),
        "moments at which start, updates and end were said".to_owned(),
    ];
    let chart = LaneChart::new(
        "Eight waves, live",
        kinds.to_vec(),
        take.clip.duration_secs(),
    )
    .lane("performed", performed.map(bar(0)))
    .lane("end", of(Phase::End).map(bounds).map(bar(1)))
    .lane("repetition", of(Phase::Repetition).map(bounds).map(bar(2)))
    .lane(
        "said",
        events
            .iter()
            .filter(|e| e.phase != Phase::Repetition)
            .map(moment)
            .map(bar(3)),
    );
    println!("{}", chart.svg().trim_end());
}

use super::*;

/// Decides what is due, with the scores that candidates have, and returns what is then certain.
fn decided(decoder: &mut Decoder, ended: bool) -> Vec<TickDetection> {
    while decoder.is_due(ended) {
        decoder.candidates();
        decoder.decide();
    }
    decoder.report(ended).to_vec()
}

/// Runs one class's distances (age: always 3 ticks) through a decoder and returns spans.
fn spans(distances: &[f32], negatives: &[f32], params: &DecodeParams) -> Vec<(i64, i64)> {
    let rule = CandidatePolicy::Gate { threshold: 2.0 };
    let mut decoder = Decoder::new(params, rule, 1, 4);
    let mut found = vec![];
    for (t, d) in distances.iter().enumerate() {
        let negative = negatives.get(t).copied().unwrap_or(FAR);
        let near = [ClassDistance {
            distance: *d,
            age: t.min(3),
            spread: 1.0,
            rest_share: 0.0,
        }];
        decoder.push(&near, negative);
        found.extend(decided(&mut decoder, false));
    }
    found.extend(decided(&mut decoder, true));
    found.iter().map(|d| (d.start, d.stop)).collect()
}

#[test]
fn a_dip_below_the_threshold_is_one_detection_at_its_bottom() {
    let dip = [5.0, 5.0, 5.0, 5.0, 1.5, 1.0, 0.5, 1.0, 1.5, 5.0, 5.0, 5.0];
    assert_eq!(spans(&dip, &[], &DecodeParams::default()), [(3, 7)]);
    assert_eq!(spans(&dip, &[], &DecodeParams::reference()), [(3, 7)]);
}

#[test]
fn a_dip_in_the_last_ticks_counts_once_it_no_longer_falls() {
    let dip = [5.0, 5.0, 5.0, 5.0, 1.5, 1.0, 0.5];
    assert_eq!(spans(&dip, &[], &DecodeParams::default()), []);
    assert_eq!(spans(&dip, &[], &DecodeParams::reference()), [(3, 7)]);
    let level = [5.0, 5.0, 5.0, 5.0, 1.5, 1.0, 0.52, 0.5];
    assert_eq!(spans(&level, &[], &DecodeParams::default()), [(4, 8)]);
    let over = [5.0, 5.0, 5.0, 5.0, 1.5, 1.0, 0.5, 1.0];
    assert_eq!(spans(&over, &[], &DecodeParams::default()), [(3, 7)]);
}

#[test]
fn a_nearer_negative_silences_a_class() {
    let dip = [5.0, 5.0, 5.0, 5.0, 1.5, 1.0, 0.5, 1.0, 1.5, 5.0, 5.0, 5.0];
    assert_eq!(spans(&dip, &[0.3; 12], &DecodeParams::default()), []);
    assert_eq!(spans(&dip, &[0.6; 12], &DecodeParams::default()), [(3, 7)]);
}

#[test]
fn of_two_overlapping_candidates_the_better_remains_when_the_lag_allows() {
    let params = DecodeParams {
        gate: 1.2,
        gate_ticks: 0,
        peak_ticks: 0,
        lag_ticks: 4,
        overlap_ticks: 0,
        overlap_share: 0.0,
        hold_ticks: 0,
        end_fall: 1.0,
        ..DecodeParams::reference()
    };
    let twice = [5.0, 5.0, 5.0, 1.5, 1.2, 0.2, 5.0, 5.0, 5.0, 5.0, 5.0];
    assert_eq!(spans(&twice, &[], &params), [(2, 6)]);
}

/// Runs several classes' distances and ages; returns class, span and the tick before which each was out.
fn reports(ticks: &[Vec<(f32, usize)>], params: &DecodeParams) -> Vec<(u16, i64, i64, usize)> {
    let mut decoder = Decoder::new(
        params,
        CandidatePolicy::Gate { threshold: 2.0 },
        ticks[0].len(),
        20,
    );
    let mut found = vec![];
    for (t, near) in ticks.iter().enumerate() {
        let near: Vec<_> = near
            .iter()
            .map(|&(distance, age)| ClassDistance {
                distance,
                age: age.min(t),
                spread: 1.0,
                rest_share: 0.0,
            })
            .collect();
        decoder.push(&near, FAR);
        let now = decided(&mut decoder, false);
        found.extend(now.iter().map(|d| (d.class.0, d.start, d.stop, t)));
    }
    let last = decided(&mut decoder, true);
    found.extend(
        last.iter()
            .map(|d| (d.class.0, d.start, d.stop, ticks.len())),
    );
    found
}

const AWAY: (f32, usize) = (9.0, 0);

/// A short class that ends with tick 20, six ticks long, and one that began ten ticks before it and ends with
/// tick 21, at `distance`.
fn short_inside_long(distance: f32) -> Vec<Vec<(f32, usize)>> {
    let mut ticks = vec![vec![AWAY, AWAY]; 30];
    for (t, d) in [(19, 1.5), (20, 1.0), (21, 1.5)] {
        ticks[t][0] = (d, t - 15);
    }
    for (t, d) in [(19, 1.9), (20, 1.0), (21, 0.0), (22, 1.0)] {
        ticks[t][1] = (distance + d, t - 5);
    }
    ticks
}

#[test]
fn a_short_motion_waits_for_the_longer_one_that_it_ends() {
    let params = DecodeParams {
        hold_ticks: 2,
        rival_share: 0.0,
        ..DecodeParams::default()
    };
    let once = DecodeParams {
        hold_ticks: 0,
        ..params.clone()
    };
    assert_eq!(reports(&short_inside_long(0.2), &params), [(1, 5, 22, 22)]);
    assert_eq!(reports(&short_inside_long(0.2), &once), [(0, 15, 21, 21)]);
    // The longer one does not pass the threshold: nothing waits.
    assert_eq!(reports(&short_inside_long(3.0), &params), [(0, 15, 21, 21)]);
}

#[test]
fn what_waits_in_vain_is_reported_after_its_hold() {
    let mut ticks = short_inside_long(3.0);
    // A longer class comes nearer for ever and never arrives.
    for (t, near) in ticks.iter_mut().enumerate().skip(15) {
        near[1] = (1.95 - 0.01 * t as f32, t - 5);
    }
    let params = DecodeParams {
        hold_ticks: 3,
        ..DecodeParams::default()
    };
    assert_eq!(reports(&ticks, &params)[0], (0, 15, 21, 24));
}

/// A motion of ten ticks of class `first` that ends with tick 15, and one of twenty of class `second` that ends with
/// tick 30 and so began inside it.
fn one_after_the_other(first: usize, second: usize) -> Vec<Vec<(f32, usize)>> {
    let mut ticks = vec![vec![AWAY; 2]; 40];
    for (class, end, age) in [(first, 15, 9), (second, 30, 19)] {
        for (t, d) in [(end - 1, 1.0), (end, 0.5), (end + 1, 1.0)] {
            ticks[t][class] = (d, age);
        }
    }
    ticks
}

#[test]
fn a_longer_match_of_the_same_class_is_no_second_motion() {
    let ticks = one_after_the_other(0, 0);
    let params = DecodeParams::default();
    assert_eq!(reports(&ticks, &params), [(0, 6, 16, 16)]);
    let twice = DecodeParams {
        once: false,
        ..params
    };
    assert_eq!(reports(&ticks, &twice).len(), 2);
}

#[test]
fn a_nearer_match_of_another_class_refuses_a_candidate() {
    let mut ticks = vec![vec![AWAY; 2]; 30];
    for (t, d) in [(14, 1.5), (15, 1.0), (16, 1.5)] {
        ticks[t][0] = (d, 9);
    }
    // It comes nearer and ends a tick later, too late to be a candidate before the first is decided.
    for (t, d) in [(14, 0.9), (15, 0.8), (16, 0.5), (17, 0.9)] {
        ticks[t][1] = (d, 9);
    }
    let params = DecodeParams::default();
    let classes: Vec<u16> = reports(&ticks, &params).iter().map(|r| r.0).collect();
    assert_eq!(classes, [1]);
    let alone = DecodeParams {
        rival_share: 0.0,
        hold_ticks: 0,
        ..params
    };
    assert_eq!(reports(&ticks, &alone)[0].0, 0);
}

#[test]
fn the_last_partial_repetition_is_not_one_more() {
    let run = |last_spread: f32| {
        let params = DecodeParams::default();
        let mut decoder = Decoder::new(&params, CandidatePolicy::Gate { threshold: 2.0 }, 1, 20);
        let mut found = 0;
        for t in 0..60i64 {
            let mut near = ClassDistance::NONE;
            for (end, spread) in [(15, 1.0), (27, 1.1), (39, last_spread)] {
                if (t - end as i64).abs() <= 1 {
                    near = ClassDistance {
                        distance: 0.5 + (t - end as i64).abs() as f32,
                        age: 10,
                        spread,
                        rest_share: 0.0,
                    };
                }
            }
            decoder.push(&[near], FAR);
            found += decided(&mut decoder, false).len();
        }
        found
    };
    assert_eq!(run(1.0), 3);
    assert_eq!(run(0.5), 2);
}

#[test]
fn a_motion_that_overlaps_the_one_before_is_cut_not_lost() {
    let ticks = one_after_the_other(0, 1);
    let spans = |params: &DecodeParams| -> Vec<_> {
        reports(&ticks, params).iter().map(|r| (r.1, r.2)).collect()
    };
    let default = DecodeParams::default();
    assert_eq!(
        spans(&default),
        [(6, 16), (16, 31)],
        "it reaches five of its twenty ticks into the first"
    );
    assert_eq!(
        spans(&DecodeParams {
            overlap_share: 0.2,
            ..default
        }),
        [(6, 16)]
    );
}

#[test]
fn classes_may_have_thresholds_of_their_own() {
    // Two classes at one distance would be rivals.
    let params = DecodeParams {
        rival_share: 0.0,
        ..DecodeParams::default()
    };
    let mut decoder = Decoder::new(&params, CandidatePolicy::Gate { threshold: 1.0 }, 2, 20);
    decoder.set_thresholds(&[1.0, 3.0]);
    let mut found = vec![];
    for d in [9.0, 9.0, 9.0, 9.0, 9.0, 2.5, 2.0, 2.5, 9.0, 9.0, 9.0] {
        let near = [ClassDistance {
            distance: d,
            age: 4,
            spread: 1.0,
            rest_share: 0.0,
        }; 2];
        decoder.push(&near, FAR);
        let now = decided(&mut decoder, false);
        found.extend(now.iter().map(|d| (d.class.0, d.stop, d.score)));
    }
    assert_eq!(found.len(), 1);
    assert_eq!((found[0].0, found[0].1), (1, 7));
    assert!(
        (found[0].2 - 1.0 / 3.0).abs() < 1e-6,
        "the score is a share of the class's own threshold"
    );
}

#[test]
fn long_silence_neither_grows_memory_nor_loses_what_follows() {
    let mut stream = vec![9.0; 5000];
    stream.extend([1.0, 0.5, 1.0, 9.0, 9.0, 9.0, 9.0]);
    assert_eq!(
        spans(&stream, &[], &DecodeParams::default()),
        [(4998, 5002)]
    );
}

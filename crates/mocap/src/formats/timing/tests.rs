use super::*;

const UNKNOWN: Clock = Clock {
    given_hz: None,
    stated_hz: None,
    assumed_hz: 30.0,
};

fn run(times: &[f64], clock: &Clock) -> (f64, Vec<Vec3>, usize) {
    let positions = times.iter().map(|&t| Vec3::repeat(t)).collect();
    let mut points = [Point {
        name: "A".into(),
        positions,
    }];
    let mut warnings = Vec::new();
    let stamps = Stamps {
        secs: times.iter().copied().map(Some).collect(),
        numbers: Vec::new(),
    };
    let schedule = Schedule::of(&stamps, clock, &mut warnings);
    schedule.apply(&mut points);
    let mut positions = points[0].positions.clone();
    for gap in schedule.gaps() {
        let (from, to) = (positions[gap.start - 1], positions[gap.end]);
        for frame in gap.clone() {
            let t = (frame + 1 - gap.start) as f64 / (gap.len() + 1) as f64;
            positions[frame] = from.lerp(&to, t);
        }
    }
    (schedule.rate_hz, positions, warnings.len())
}

#[test]
fn printed_times_give_a_round_rate() {
    let times: Vec<f64> = (0..151)
        .map(|f| (f as f64 / 60.0 * 1e3).round() / 1e3)
        .collect();
    let (rate, positions, said) = run(&times, &UNKNOWN);
    assert_eq!((rate, positions.len(), said), (60.0, 151, 0));
}

#[test]
fn irregular_times_are_made_regular() {
    let times: Vec<f64> = (0..100)
        .map(|f| 0.05 * f as f64 + 0.02 * (f % 3) as f64)
        .collect();
    let (rate, positions, said) = run(&times, &UNKNOWN);
    assert_eq!(said, 1);
    for (frame, p) in positions.iter().enumerate() {
        assert!((p.x - frame as f64 / rate).abs() < 1e-9, "{frame}");
    }
}

#[test]
fn frames_that_are_missing_do_not_slow_a_clip_down() {
    // Two in five frames are missing: two of three steps are of two frames.
    let seen = (0..200).filter(|f| [0, 1, 3].contains(&(f % 5)));
    let times: Vec<f64> = seen.map(|f| f as f64 / 15.0).collect();
    let (rate, positions, said) = run(&times, &UNKNOWN);
    assert_eq!((rate, said), (15.0, 1));
    for (frame, p) in positions.iter().enumerate() {
        assert!((p.x - frame as f64 / 15.0).abs() < 1e-9, "{frame}");
    }
    // One pause of two seconds in a minute.
    let times: Vec<f64> = (0..900)
        .map(|f| (f + if f > 400 { 30 } else { 0 }) as f64 / 15.0)
        .collect();
    let (rate, positions, _) = run(&times, &UNKNOWN);
    assert_eq!((rate, positions.len()), (15.0, 930));
}

#[test]
fn what_is_not_known_is_assumed_and_what_is_given_holds() {
    assert_eq!(run(&[1.0, 1.0, 1.0], &UNKNOWN).0, 30.0);
    let given = Clock {
        given_hz: Some(50.0),
        ..UNKNOWN
    };
    assert_eq!(run(&[0.0, 1.0, 1.1], &given).0, 50.0);
    let wrong = Clock {
        stated_hz: Some(100.0),
        ..UNKNOWN
    };
    let times: Vec<f64> = (0..50).map(|f| f as f64 / 25.0).collect();
    let (rate, _, said) = run(&times, &wrong);
    assert_eq!((rate, said), (25.0, 1));
}

fn even(frames: usize, rate_hz: f64) -> Vec<f64> {
    (0..frames).map(|frame| frame as f64 / rate_hz).collect()
}

#[test]
fn frames_out_of_order_repeated_or_far_off_cost_no_others() {
    let mut swapped = even(40, 60.0);
    swapped.swap(6, 7);
    let mut spiked = even(40, 60.0);
    spiked[5] = 999.0;
    let twice = even(40, 60.0)
        .into_iter()
        .flat_map(|time| [time; 2])
        .collect();
    for (times, frames) in [(swapped, 40), (spiked, 40), (twice, 40)] {
        let (rate, positions, said) = run(&times, &UNKNOWN);
        assert_eq!((rate, positions.len()), (60.0, frames), "{times:?}");
        assert!((1..=2).contains(&said), "{said}: {times:?}");
        for (frame, p) in positions.iter().enumerate() {
            assert!(
                (p.x - frame as f64 / rate).abs() < 1e-9,
                "{frame}: {times:?}"
            );
        }
    }
}

#[test]
fn times_with_few_digits_repeat_without_being_repeats() {
    let times: Vec<f64> = even(240, 120.0)
        .iter()
        .map(|time| (time * 100.0).floor() / 100.0)
        .collect();
    let (rate, positions, said) = run(&times, &UNKNOWN);
    assert_eq!((rate.round(), positions.len(), said), (120.0, 240, 0));
}

#[test]
fn takes_one_behind_the_other_keep_their_rate() {
    let times = [even(40, 60.0), even(40, 60.0)].concat();
    let (rate, positions, said) = run(&times, &UNKNOWN);
    assert_eq!((rate, positions.len(), said), (60.0, 80, 2));
}

#[test]
fn numbers_of_frames_are_put_in_order_and_leave_gaps() {
    let numbers = [190.0, 192.0, 191.0, 191.0, 200.0];
    let stamps = Stamps::none(5).numbered(numbers.map(Some).to_vec());
    let mut warnings = Vec::new();
    let schedule = Schedule::of(&stamps, &UNKNOWN, &mut warnings);
    let places = schedule.places.as_ref().unwrap();
    assert_eq!((schedule.rate_hz, places.len()), (30.0, 11));
    let frames: Vec<usize> = [0, 1, 2, 10].map(|at: usize| places[at].before).to_vec();
    assert_eq!(frames, [0, 2, 1, 4]);
    assert_eq!(schedule.gaps(), [3..10]);
    // As many as that are no gap.
    let far = Stamps::none(3).numbered([0.0, 1.0, 1e9].map(Some).to_vec());
    assert!(Schedule::of(&far, &UNKNOWN, &mut warnings).places.is_none());
}

proptest::proptest! {
    #[test]
    fn any_times_and_numbers_make_frames_of_the_file(
        secs in proptest::collection::vec(proptest::option::of(-1e3f64..1e3), 1..40),
        numbers in proptest::collection::vec(proptest::option::of(-50i32..50), 1..40),
    ) {
        let count = secs.len();
        let mut numbers: Vec<Option<f64>> = numbers.into_iter().map(|n| n.map(f64::from)).collect();
        numbers.resize(count, None);
        let stamps = Stamps { secs, numbers: Vec::new() }.numbered(numbers);
        let schedule = Schedule::of(&stamps, &UNKNOWN, &mut Vec::new());
        proptest::prop_assert!(schedule.rate_hz > 0.0);
        for place in schedule.places.iter().flatten() {
            proptest::prop_assert!(place.before < count && place.after < count);
            proptest::prop_assert!((0.0..=1.0).contains(&place.t));
        }
    }
}

#[test]
fn every_tenth_frame_is_one_without_gaps() {
    let stamps = |by: f64| Stamps::none(6).numbered((0..6).map(|n| Some(by * n as f64)).collect());
    for (by, given_hz, rate_hz, frames) in [
        (10.0, None, 3.0, 6),
        (10.0, Some(25.0), 25.0, 6),
        (2.0, None, 15.0, 6),
        (1.0, None, 30.0, 6),
    ] {
        let mut warnings = Vec::new();
        let clock = Clock {
            given_hz,
            ..UNKNOWN
        };
        let schedule = Schedule::of(&stamps(by), &clock, &mut warnings);
        assert_eq!(schedule.rate_hz, rate_hz, "{by}");
        assert_eq!(schedule.frames(6).len(), frames, "{by}");
        assert!(schedule.gaps().is_empty(), "{by}");
    }
}

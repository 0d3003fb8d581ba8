//! Streams of maps against whole maps.

use super::*;
use proptest::prelude::*;

const MIN: usize = 2;
const MAX: usize = 6;

fn params(wait_chunks: usize) -> SvrdmParams {
    SvrdmParams {
        min_chunks: MIN,
        max_chunks: MAX,
        wait_chunks,
        ..SvrdmParams::default()
    }
}

/// Columns of a map, many of their cells empty; few values, so that ties are common.
fn map() -> impl Strategy<Value = Vec<Vec<Cell>>> {
    let cell = prop_oneof![
        2 => Just(Cell::NOTHING),
        3 => (0u16..3, 1u8..40)
            .prop_map(|(class, c)| Cell { class: ClassId(class), confidence: f64::from(c) / 40.0 }),
    ];
    prop::collection::vec(prop::collection::vec(cell, MAX - MIN + 1), 0..60).prop_map(|mut map| {
        for (chunk, column) in map.iter_mut().enumerate() {
            for length in 0..column.len() {
                if MIN + length > chunk + 1 {
                    column[length] = Cell::NOTHING;
                }
            }
        }
        map
    })
}

const BOTH: [Maxima; 2] = [Maxima::Peaks, Maxima::Plateaus];

/// Maxima among eight neighbours of the whole map, the best first.
fn maxima(map: &[Vec<Cell>], rule: Maxima) -> Vec<ChunkDetection> {
    let at = |start: i64, stop: i64| {
        let length = stop - start - MIN as i64;
        let column = usize::try_from(stop - 1).ok().and_then(|c| map.get(c));
        let cell = column.and_then(|c| c.get(usize::try_from(length).ok()?));
        cell.copied().unwrap_or(Cell::NOTHING)
    };
    let mut maxima = vec![];
    for stop in 1..=map.len() as i64 {
        for start in (stop - MAX as i64..=stop - MIN as i64).rev() {
            let cell = at(start, stop);
            let mut around = (-1..=1)
                .flat_map(|a| (-1..=1).map(move |b| (a, b)))
                .filter(|o| *o != (0, 0));
            let counts = around.all(|(a, b)| {
                let other = at(start + a, stop + b).confidence;
                cell.confidence > other || (rule == Maxima::Plateaus && cell.confidence == other)
            });
            if counts && cell.confidence > 0.0 {
                maxima.push(ChunkDetection {
                    class: cell.class,
                    start,
                    stop,
                    score: cell.confidence,
                });
            }
        }
    }
    maxima.sort_by(|a, b| b.score.total_cmp(&a.score));
    maxima
}

/// The best first, without what overlaps a better one.
fn at_once(map: &[Vec<Cell>], params: &SvrdmParams) -> Vec<ChunkDetection> {
    let mut kept: Vec<ChunkDetection> = vec![];
    for found in maxima(map, params.maxima) {
        if !kept.iter().any(|k| k.overlaps(&found, params.overlap)) {
            kept.push(found);
        }
    }
    kept.sort_by_key(|d| (d.start, d.stop));
    kept
}

/// Reports, each with the number of columns seen by then.
fn streamed(
    map: &[Vec<Cell>],
    params: &SvrdmParams,
    most: Vec<f64>,
) -> Vec<(ChunkDetection, usize)> {
    let mut tracking = SegmentTracking::new(params, most);
    let room = tracking.room();
    let mut found = vec![];
    for (chunk, column) in map.iter().enumerate() {
        tracking.push(column, &mut |d| found.push((d, chunk + 1)));
    }
    tracking.finish(&mut |d| found.push((d, map.len())));
    assert_eq!((tracking.tracked(), tracking.room()), (0, room));
    found
}

fn bounds(map: &[Vec<Cell>]) -> Vec<f64> {
    let most = |length: usize| {
        map.iter()
            .map(|column| column[length].confidence)
            .fold(0.0, f64::max)
    };
    (0..=MAX - MIN).map(most).collect()
}

proptest! {
    #[test]
    fn a_stream_gives_what_the_whole_map_gives(map in map(), maxima in prop::sample::select(&BOTH[..])) {
        let params = SvrdmParams { maxima, ..params(256) };
        let expected = at_once(&map, &params);
        for most in [vec![1.0; MAX - MIN + 1], bounds(&map)] {
            let mut found: Vec<_> = streamed(&map, &params, most).into_iter().map(|f| f.0).collect();
            found.sort_by_key(|d| (d.start, d.stop));
            prop_assert_eq!(&found, &expected);
        }
    }

    #[test]
    fn a_short_wait_is_kept_and_nothing_overlaps(
        map in map(), wait in 1usize..8, rule in prop::sample::select(&BOTH[..]),
    ) {
        let params = SvrdmParams { maxima: rule, ..params(wait) };
        let found = streamed(&map, &params, vec![1.0; MAX - MIN + 1]);
        for (index, (detection, seen)) in found.iter().enumerate() {
            prop_assert!(seen.saturating_sub(detection.stop as usize) <= wait);
            let others = found[..index].iter();
            prop_assert!(others.into_iter().all(|(o, _)| !o.overlaps(detection, params.overlap)));
        }
        for maximum in maxima(&map, rule) {
            let for_what = found.iter().find(|(d, _)| *d == maximum || d.overlaps(&maximum, params.overlap));
            prop_assert!(for_what.is_some(), "{maximum:?} went for nothing");
        }
    }
}

#[test]
fn a_maximum_is_reported_once_nothing_can_beat_it() {
    let cell = |confidence| Cell {
        class: ClassId(0),
        confidence,
    };
    let mut map = vec![vec![Cell::NOTHING; MAX - MIN + 1]; 20];
    (map[8][2], map[8][1], map[9][2]) = (cell(0.9), cell(0.5), cell(0.7));
    let first = |most: f64| streamed(&map, &params(256), vec![most; MAX - MIN + 1])[0];
    let found = ChunkDetection {
        class: ClassId(0),
        start: 5,
        stop: 9,
        score: 0.9,
    };
    // The column after it makes it a maximum; if none can be better, that is all.
    assert_eq!(first(0.9), (found, 10));
    // Else until a longest segment cannot share three tenths of its four chunks: one chunk at most.
    assert_eq!(first(1.0), (found, 9 + MAX - 2));
}

#[test]
fn rising_chains_end_with_the_wait() {
    // Every maximum overlaps the next, which is better.
    let mut map = vec![vec![Cell::NOTHING; MAX - MIN + 1]; 240];
    for (n, column) in map.iter_mut().enumerate().skip(10).step_by(2) {
        column[2] = Cell {
            class: ClassId(0),
            confidence: 0.2 + n as f64 / 400.0,
        };
    }
    let found = streamed(&map, &params(12), vec![1.0; MAX - MIN + 1]);
    assert!(
        found.iter().all(|(d, seen)| seen - d.stop as usize <= 12),
        "{found:?}"
    );
    let kept = |m: &ChunkDetection| found.iter().any(|(d, _)| d == m || d.overlaps(m, 0.3));
    assert!(maxima(&map, Maxima::Plateaus).iter().all(kept));
}

#[test]
fn of_segments_as_certain_as_each_other_the_first_counts() {
    // A motion that five segments of a length match in full, one chunk apart.
    let mut map = vec![vec![Cell::NOTHING; MAX - MIN + 1]; 20];
    let cell = |confidence| Cell {
        class: ClassId(1),
        confidence,
    };
    for column in &mut map[8..13] {
        (column[1], column[2], column[3]) = (cell(0.5), cell(0.9), cell(0.6));
    }
    let with = |maxima| SvrdmParams {
        maxima,
        ..params(256)
    };
    let found = |rule| streamed(&map, &with(rule), vec![1.0; MAX - MIN + 1]);
    let spans = |rule| {
        found(rule)
            .into_iter()
            .map(|(d, _)| (d.start, d.stop))
            .collect::<Vec<_>>()
    };
    assert_eq!(spans(Maxima::Plateaus), [(5, 9), (8, 12)]);
    assert_eq!(spans(Maxima::Peaks), []);
}

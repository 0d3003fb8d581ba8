//! Pictures hold what was put in, whatever it was called, and nothing that is not a number.

use super::{Bar, Chart, HeatMap, LaneChart, Regions};
use morec::TimeSpan;

fn whole(svg: &str) {
    assert!(
        svg.starts_with("<svg ") && svg.trim_end().ends_with("</svg>"),
        "{svg}"
    );
    for bad in ["NaN", "inf"] {
        assert!(!svg.contains(bad), "{bad} in {svg}");
    }
    // Every `<` opens an element or closes one: names cannot break out.
    assert_eq!(svg.matches('<').count(), svg.matches('>').count());
}

#[test]
fn a_chart_holds_its_series() {
    let chart = Chart::new("H <over> time & \"cuts\"")
        .axes("s", "distance")
        .line("H", [(0.0, 1.0), (1.0, f64::NAN), (2.0, 3.0), (3.0, 2.0)])
        .points("peaks", [(2.0, 3.0), (f64::INFINITY, 1.0)])
        .marks("cuts", [0.5, 2.5])
        .spans("labelled", [(0.0, 1.0)]);
    let svg = chart.svg();
    whole(&svg);
    assert_eq!(
        svg.matches("<polyline").count(),
        2,
        "a gap interrupts the line"
    );
    assert_eq!(svg.matches("<circle").count(), 1);
    assert_eq!(svg.matches("class=\"mark\"").count(), 2);
    for name in ["H", "peaks", "cuts", "labelled"] {
        assert!(svg.contains(&format!(">{name}</text>")), "{name}");
    }
    assert!(svg.contains("H &lt;over&gt; time &amp; &quot;cuts&quot;"));
}

#[test]
fn empty_pictures_are_pictures() {
    whole(&Chart::new("nothing").svg());
    whole(
        &Chart::new("nothing")
            .line("l", [])
            .points("p", [(f64::NAN, 0.0)])
            .svg(),
    );
    whole(&HeatMap::new("nothing", 0, []).svg());
    whole(&HeatMap::new("zero", 2, [0.0, f64::NAN, -1.0, 0.0]).svg());
}

#[test]
fn a_long_line_keeps_its_extremes() {
    let points = (0..200_000).map(|i| {
        (
            f64::from(i),
            if i == 77_777 {
                50.0
            } else {
                (f64::from(i) * 0.1).sin()
            },
        )
    });
    let svg = Chart::new("long").size(500, 200).line("", points).svg();
    whole(&svg);
    assert!(svg.len() < 60_000, "{} bytes", svg.len());
    let line = svg
        .split("points=\"")
        .nth(1)
        .and_then(|s| s.split('"').next())
        .unwrap();
    let ys = line
        .split(' ')
        .map(|p| p.split_once(',').unwrap().1.parse::<f64>().unwrap());
    let tops = ys.filter(|y| *y < 60.0).count();
    assert_eq!(tops, 1, "the one high point is drawn once");
}

#[test]
fn regions_of_one_kind_are_joined() {
    let regions = Regions {
        x: (0.0, 1.0),
        y: (0.0, 1.0),
        columns: 4,
        kinds: vec![Some(0), Some(0), None, Some(1), None, None, None, None],
        names: vec!["left".to_owned(), "right".to_owned()],
    };
    let svg = Chart::new("node").regions(regions).svg();
    whole(&svg);
    assert_eq!(
        svg.matches("/ .55)").count(),
        2 + 2,
        "two runs and two entries of the legend"
    );
}

#[test]
fn a_heat_map_draws_what_is_positive() {
    let map = HeatMap::new("confusion", 2, [3.0, 0.0, 1.5, f64::NAN])
        .names(
            vec!["a&b".to_owned(), "c".to_owned()],
            vec!["a&b".to_owned(), "c".to_owned()],
        )
        .with_values();
    let svg = map.svg();
    whole(&svg);
    assert_eq!(svg.matches("opacity=").count(), 2);
    assert!(svg.contains(">3</text>") && svg.contains(">1.50</text>"));
    assert_eq!(svg.matches("a&amp;b").count(), 2);
}

#[test]
fn lanes_hold_their_bars_and_name_what_is_there() {
    let bar = |from_secs, to_secs, kind| Bar {
        span: TimeSpan::new(from_secs, to_secs),
        kind,
    };
    let kinds = ["walk", "<jump>", "never"].map(str::to_owned).to_vec();
    let lanes = LaneChart::new("clip", kinds, 10.0)
        .lane("labelled", [bar(0.0, 2.0, 0), bar(3.0, 99.0, 1)])
        .lane("found", [bar(f64::NAN, 2.0, 0), bar(1.0, 2.0, 7)]);
    let svg = lanes.svg();
    whole(&svg);
    assert!(svg.contains("&lt;jump&gt;, 3.00 to 10.00 s"));
    assert_eq!(svg.matches(">walk</text>").count(), 1);
    assert!(!svg.contains("never"));
    whole(&LaneChart::new("nothing", vec![], 0.0).svg());
}

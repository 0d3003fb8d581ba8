//! The evaluation of 2009 on synthetic people.

use morec::train::thesis::{SvrdmOptions, SvrdmTrainParams};
use morec_measure::reproduce::{Setting, Study, page, reproduce};

use crate::thesis_people::{classes, clips, takes};

#[test]
fn the_evaluation_counts_every_sample_and_draws_every_branch() {
    let (clips, samples) = clips(takes());
    let classes = classes();
    let settings = [
        (
            Setting::Faithful,
            SvrdmOptions {
                params: SvrdmTrainParams::faithful(),
                ..Default::default()
            },
        ),
        (Setting::Tuned, SvrdmOptions::default()),
    ];
    let study = Study {
        clips: &clips,
        samples: &samples,
        classes: &classes,
        unknown: &[],
        seeds: &[3],
        settings: &settings,
    };
    let result = reproduce(&study, &()).unwrap();
    assert_eq!(result.segmentation.len(), clips.len());
    for c in &result.clustering {
        assert_eq!(c.samples, samples.len());
        assert_eq!(
            c.pairs.total(),
            (samples.len() * (samples.len() - 1) / 2) as u64
        );
    }
    for c in &result.classification {
        assert_eq!(c.all.samples, samples.len());
        assert_eq!(c.unseen.samples + c.taught, samples.len());
        assert_eq!(c.confusion.iter().flatten().sum::<usize>(), samples.len());
        for rates in [c.all, c.unseen, c.alike[0], c.alike[1]] {
            assert!((rates.p_c + rates.p_e + rates.p_r - 1.0).abs() < 1e-12);
        }
        let drawn = result
            .pictures
            .iter()
            .filter(|p| p.name.starts_with(&format!("{}_branch", c.setting.name())));
        assert_eq!(drawn.count(), classes.len() - 1);
    }
    assert_eq!(result.streams.len(), 2);
    let page = page(&result, &[("clips".to_owned(), "a <b> & c".to_owned())]);
    assert!(page.contains("a &lt;b&gt; &amp; c") && page.ends_with("</html>\n"));
    assert_eq!(page.matches("<svg").count(), page.matches("</svg>").count());
    for picture in &result.pictures {
        assert!(!picture.svg.contains("NaN"), "{}", picture.name);
        assert_eq!(picture.table.is_some(), picture.name.contains("_map_"));
        let mut lines = picture.table.iter().flat_map(|table| table.lines());
        assert!(lines.all(|line| line.split('\t').count() == 4));
    }
}

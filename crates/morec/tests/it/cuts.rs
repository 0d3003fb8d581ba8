//! How a stream is cut into pushes, and what a recogniser did before, makes no difference.

use std::sync::OnceLock;

use morec::features::{BoneSet, MAX_GAP_SECS};
use morec::live::{Detection, Recognizer};
use proptest::prelude::*;

use crate::engines::inline;
use crate::made::{self, Timed};

/// Two gestures, one before and one after a pause of the source, and what is recognised pose by pose.
fn stream() -> &'static (BoneSet, Vec<Timed>, Vec<Detection>) {
    static STREAM: OnceLock<(BoneSet, Vec<Timed>, Vec<Detection>)> = OnceLock::new();
    STREAM.get_or_init(|| {
        let script = made::right_handed(88, 1)
            .rest(0.5)
            .play("push")
            .rest(1.5)
            .play("bow")
            .rest(0.5);
        let (bones, mut poses) = made::poses(&script.film("cut", 50.0).unwrap());
        poses.retain(|p| !(3.0..3.2 + MAX_GAP_SECS).contains(&p.0));
        let found = inline(&made::model(), bones, &poses);
        assert_eq!(found.len(), 2, "the stream must hold something: {found:?}");
        (bones, poses, found)
    })
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 12, failure_persistence: None, ..Default::default() })]

    #[test]
    fn any_cut_gives_the_same_detections(sizes in prop::collection::vec(0usize..200, 1..8)) {
        let (bones, poses, expected) = stream();
        let mut recognizer = Recognizer::new(&made::model(), *bones).unwrap();
        let (mut rest, mut found) = (&poses[..], vec![]);
        for size in sizes.iter().chain(std::iter::repeat(&61)) {
            let (batch, after) = rest.split_at((*size).min(rest.len()));
            recognizer.push_all(batch, &mut found);
            rest = after;
            if rest.is_empty() {
                break;
            }
        }
        found.extend_from_slice(recognizer.finish());
        prop_assert_eq!(&found, expected);
    }

    #[test]
    fn a_used_recogniser_is_as_good_as_new_and_a_copy_as_good_as_the_original(at in 0usize..1000) {
        let (bones, poses, expected) = stream();
        let at = at % poses.len();
        let mut used = Recognizer::new(&made::model(), *bones).unwrap();
        let mut begun = vec![];
        used.push_all(&poses[..at], &mut begun);
        let mut copy = used.clone();
        copy.push_all(&poses[at..], &mut begun);
        begun.extend_from_slice(copy.finish());
        prop_assert_eq!(&begun, expected);
        used.finish();
        let mut again = vec![];
        used.push_all(poses, &mut again);
        again.extend_from_slice(used.finish());
        prop_assert_eq!(&again, expected);
    }
}

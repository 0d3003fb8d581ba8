//! Every case of `testdata/recognition/` through the C library gives the detections of the recogniser itself.

use morec::live::Detection;
use morec::roles::Role;
use morec_capi::MOREC_TENTATIVE;

use crate::cases::cases;
use crate::kit::{self, Index, Recognizer, options};
use crate::made;

#[test]
fn every_case_gives_what_the_recogniser_gives() {
    let index = Index::new(kit::index_bytes());
    let mut detections = 0;
    for (name, case) in cases() {
        for &rate_hz in &case.rates_hz {
            let (bones, poses) = made::poses(&case.take(rate_hz));
            let poses = case.stream.carry(&poses);
            let mut inline = morec::live::Recognizer::new(&kit::index().model, bones).unwrap();
            let mut expected: Vec<Detection> = Vec::new();
            inline.push_all(&poses, &mut expected);
            expected.extend_from_slice(inline.finish());
            let shown = |role: &Role| poses.iter().any(|(_, pose)| pose.get(*role).is_some());
            let roles = Role::BODY
                .into_iter()
                .filter(shown)
                .fold(0, |mask, role| mask | 1 << role.index());
            for flags in [0, MOREC_TENTATIVE] {
                let mut options = options();
                (options.roles, options.flags) = (roles, flags);
                let recognizer = Recognizer::new(&index, &options).unwrap();
                assert_eq!(recognizer.run(&poses), expected, "{name} at {rate_hz} Hz");
                let stats = recognizer.stats();
                assert_eq!(stats.frames, poses.len() as u64);
                assert_eq!((stats.refused_frames, stats.lost_events), (0, 0));
            }
            detections += expected.len();
        }
    }
    assert!(detections > 10, "{detections} detections are no suite");
}

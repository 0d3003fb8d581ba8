#![no_main]
//! Any bytes read as a skeleton: no panic, every parent first, every number finite.

use libfuzzer_sys::fuzz_target;
use morec::formats::Limits;
use morec::formats::acclaim::read_asf;

fuzz_target!(|bytes: &[u8]| {
    let limits = Limits {
        joints: 64,
        depth: 32,
        line_bytes: 4096,
        frames: 4096,
        memory: 64 << 20,
    };
    let Ok((asf, _)) = read_asf(bytes, &limits) else {
        return;
    };
    let skeleton = asf.skeleton();
    assert_eq!(skeleton.len(), asf.bones.len() + 1);
    assert!(skeleton.len() <= limits.joints);
    for joint in skeleton.joints() {
        assert!(
            joint
                .offset
                .iter()
                .chain(joint.tip.iter().flatten())
                .all(|v| v.is_finite())
        );
    }
    assert!(
        asf.bones
            .iter()
            .all(|bone| (bone.axes.coords.norm() - 1.0).abs() < 1e-9)
    );
});

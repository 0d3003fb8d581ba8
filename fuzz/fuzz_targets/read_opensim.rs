#![no_main]
//! Any bytes read as joint angles of a small leg, and as the model of a small motion: no panic, no NaN, every frame whole.

use libfuzzer_sys::fuzz_target;
use morec::formats::opensim::{read_model, read_motion};
use morec_fuzz::{LIMITS, check_rotations};

const LEG: &[u8] = include_bytes!("../../crates/mocap/testdata/opensim/leg.osim");
const KICK: &[u8] = include_bytes!("../../crates/mocap/testdata/opensim/kick.mot");

fuzz_target!(|bytes: &[u8]| {
    let (leg, _) = read_model(LEG, &LIMITS).expect("the leg is a model");
    if let Ok(loaded) = read_motion(bytes, "clip", &leg, None, &LIMITS) {
        check_rotations(&loaded);
    }
    let model = read_model(bytes, &LIMITS);
    if let Ok(loaded) =
        model.and_then(|(model, _)| read_motion(KICK, "clip", &model, None, &LIMITS))
    {
        check_rotations(&loaded);
    }
});

//! The picture of the confidences that the method of 2009 gives each window.

use morec::svrdm::{ConfidenceMap, SvrdmEngine};
use morec_measure::report::pictures::confidence_picture;

use crate::thesis::reference;

#[test]
fn the_picture_names_classes_and_times() {
    let reference = reference();
    let model = reference.model(&reference.models[0]);
    let (mut map, mut engine) = (ConfidenceMap::new(), SvrdmEngine::new(&model).unwrap());
    for row in &reference.rows() {
        engine.push_with_observer(
            row,
            &mut |window, cell| map.record(window, cell),
            &mut |_| (),
        );
    }
    let (classes, params) = (&model.classes, &model.params);
    let picture = confidence_picture(&map, "confidence", classes, params, model.rate_hz()).svg();
    assert!(picture.contains("class 4") && picture.contains("2.67 s"));
}

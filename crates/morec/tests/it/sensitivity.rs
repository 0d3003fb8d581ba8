//! The rate of false alarms that a user chooses, on indexes that verify candidates.

use morec::index::{Model, MotionIndex, SensitivityError};
use morec::templates::{ALARM_RATES, Verifier};

use crate::made;

fn verifier(model: &Model) -> &Verifier {
    match model {
        Model::Templates(model) => model.verifier.as_ref().expect("a verifier was learned"),
        Model::Svrdm(_) => panic!("trained with templates"),
    }
}

#[test]
fn a_stricter_rate_raises_the_bar_of_a_verifier_and_nothing_else() {
    let trained = Model::from(made::model());
    let bars = ALARM_RATES.map(|rate| {
        let changed = trained.with_sensitivity(rate).unwrap();
        let mut same = verifier(&changed).clone();
        let bar = std::mem::replace(&mut same.bar, verifier(&trained).bar);
        assert_eq!(&same, verifier(&trained), "at {rate}");
        bar
    });
    assert!(bars.is_sorted_by(|a, b| a >= b), "{bars:?}");
    assert!(
        bars[0] > bars[ALARM_RATES.len() - 1],
        "background of some scores: {bars:?}"
    );
}

#[test]
fn bars_for_other_rates_are_kept_in_the_file_and_older_files_have_one_bar() {
    let mut index = MotionIndex {
        model: made::model().into(),
        roles: Default::default(),
        provenance: Default::default(),
    };
    let opened = MotionIndex::from_bytes(&index.to_bytes().unwrap()).unwrap();
    assert_eq!(verifier(&opened.model), verifier(&index.model));

    let Model::Templates(ref mut model) = index.model else {
        unreachable!()
    };
    let model = std::sync::Arc::make_mut(model);
    model.verifier.as_mut().unwrap().operating.clear();
    let older = MotionIndex::from_bytes(&index.to_bytes().unwrap()).unwrap();
    assert_eq!(
        older.model.with_sensitivity(0.3),
        Err(SensitivityError::Fixed)
    );
}

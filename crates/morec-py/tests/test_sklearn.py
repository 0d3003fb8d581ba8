"""The classifier in scikit-learn's company."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import morec

pytest.importorskip("sklearn")

from sklearn.base import clone
from sklearn.model_selection import GridSearchCV, GroupKFold, cross_val_score
from sklearn.pipeline import make_pipeline
from sklearn.preprocessing import FunctionTransformer


@pytest.fixture(scope="module")
def samples(clips: list[morec.Clip], labels: morec.Table) -> tuple[list[morec.Clip], list[str], list[str]]:
    by_name = {clip.name: clip for clip in clips}
    cut = [by_name[row["clip"]][row["start_secs"] : row["stop_secs"]] for row in labels]
    return cut, labels.column("class"), labels.column("person")


def test_clips_are_classified(samples: Any) -> None:
    cut, names, people = samples
    others = [at for at, person in enumerate(people) if person != people[0]]
    first = [at for at, person in enumerate(people) if person == people[0]]
    model = morec.MotionClassifier().fit([cut[at] for at in others], [names[at] for at in others])
    held = [cut[at] for at in first]
    assert list(model.classes_) == ["bow", "clap", "wave"]
    assert model.score(held, [names[at] for at in first]) >= 5 / 6
    shares = model.predict_proba(held)
    assert shares.shape == (len(held), 3)
    np.testing.assert_allclose(shares.sum(axis=1), 1.0)
    np.testing.assert_array_equal(model.classes_[shares.argmax(axis=1)], model.predict(held))


def test_what_is_like_no_class_is_rejected(samples: Any) -> None:
    cut, names, people = samples
    model = morec.MotionClassifier(everyday="auto", reject=True, rejected="other").fit(cut, names, groups=people)
    strange = [clip[5.0:7.0] for clip in morec.synth.everyday(3, clips=4)]
    assert (model.predict(strange) == "other").mean() >= 0.75
    assert (model.predict(cut) == np.array(names)).mean() >= 0.9


def test_an_index_classifies_clips(samples: Any) -> None:
    cut, names, people = samples
    numbered = [clip.renamed(f"{at}") for at, clip in enumerate(cut)]
    samples_of = list(zip(numbered, names, people))
    taught = [(clip, name) for clip, name, person in samples_of if person != people[0]]
    held = [(clip, name) for clip, name, person in samples_of if person == people[0]]
    index = morec.train([clip for clip, _ in taught], [(clip.name, name) for clip, name in taught], progress=False)
    rows = index.classify([clip for clip, _ in held])
    assert [row["clip"] for row in rows] == [clip.name for clip, _ in held]
    right = [row["class"] == name for row, (_, name) in zip(rows, held)]
    assert np.mean(right) >= 5 / 6
    for row in rows:
        assert list(row["probabilities"]) == index.class_names and 0 <= sum(row["probabilities"].values()) <= 1
        assert row["class"] is None or (row["class"] == row["nearest"] and row["probability"] > 0.5)


def test_arrays_are_classified(samples: Any) -> None:
    cut, names, _ = samples
    frames = min(clip.frames for clip in cut)
    arrays = np.stack([morec.normalize(clip)[:frames] for clip in cut])
    model = morec.MotionClassifier(rate_hz=60.0, up="y").fit(arrays, names)
    found = model.predict(arrays)
    assert (found == np.array(names)).mean() >= 0.8
    np.testing.assert_array_equal(model.predict(arrays.reshape(len(cut), frames, -1)), found)
    with pytest.raises(ValueError, match=r"expected an array of shape \(samples, frames, 18, 3\)"):
        model.predict(np.zeros((3, 10, 7)))
    with pytest.raises(ValueError, match="found one clip"):
        model.predict(cut[0])


def test_pipelines_grids_and_folds(samples: Any) -> None:
    cut, names, people = samples
    pipeline = make_pipeline(FunctionTransformer(list), morec.MotionClassifier())
    scores = cross_val_score(pipeline, cut, names, groups=people, cv=GroupKFold(3))
    assert scores.mean() >= 0.8
    grid = GridSearchCV(morec.MotionClassifier(), {"params": [None, {"rho": 0.4}]}, cv=2).fit(cut, names)
    assert grid.best_score_ >= 0.7 and "params" in grid.best_params_
    again = clone(morec.MotionClassifier(rate_hz=25.0))
    assert again.get_params()["rate_hz"] == 25.0


def test_mistakes_are_plain_errors(samples: Any) -> None:
    from sklearn.exceptions import NotFittedError

    cut, names, _ = samples
    with pytest.raises(NotFittedError):
        morec.MotionClassifier().predict(cut)
    with pytest.raises(ValueError, match="a class for each sample"):
        morec.MotionClassifier().fit(cut, names[:-1])
    with pytest.raises(ValueError, match="at least two classes"):
        morec.MotionClassifier().fit(cut, ["a"] * len(cut))


def test_conformance() -> None:
    """scikit-learn's own checks that do not feed tables of numbers; motions are no tables."""
    from sklearn.utils import estimator_checks as checks

    model = morec.MotionClassifier()
    for check in (
        checks.check_estimator_cloneable,
        checks.check_estimator_repr,
        checks.check_no_attributes_set_in_init,
        checks.check_parameters_default_constructible,
        checks.check_get_params_invariance,
        checks.check_set_params,
        checks.check_valid_tag_types,
        checks.check_estimator_tags_renamed,
    ):
        check("MotionClassifier", clone(model))

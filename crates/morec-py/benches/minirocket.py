"""MiniRocket (aeon) on the gestures, by person, beside morec.

    pip install aeon
    MOREC_DATA=… python minirocket.py

Both get whole clips and must say which of the nine classes each shows; clips of no class are then given too, and counted as
accepted when a class is named. MiniRocket has no rejection: the largest decision value of its ridge classifier stands in, with the
threshold that accepts as many clips of the classes as morec does.
"""

from __future__ import annotations

import os
import time
from pathlib import Path

import numpy as np
from aeon.transformations.collection.convolution_based import MiniRocket
from sklearn.linear_model import RidgeClassifierCV
from sklearn.pipeline import make_pipeline
from sklearn.preprocessing import StandardScaler

import morec

#: Clips are stretched to this many ticks for MiniRocket, which wants one length.
TICKS = 100


def series(clip: morec.Clip, features: bool) -> np.ndarray:
    """A clip as (channels, ticks): places of the body's parts, or morec's feature rows."""
    rows = morec.features(clip).values if features else morec.normalize(clip, centre=True).reshape(len(clip), -1)
    rows = np.nan_to_num(rows[:, ~np.isnan(rows).all(axis=0)] if not features else rows)
    places = np.linspace(0, len(rows) - 1, TICKS)
    return np.stack([np.interp(places, np.arange(len(rows)), column) for column in rows.T]).astype(np.float32)


def main() -> None:
    data = Path(os.environ.get("MOREC_DATA", "../shared/data")) / "gestures"
    table = [line.split("\t") for line in (data / "clips.tsv").read_text().splitlines()[1:]]
    label = {clip: name for clip, name, _ in table}
    person = {clip: who for clip, _, who in table}
    clips = [clip for clip in morec.read_folder(data / "clips") if clip.name in person]
    known = [clip for clip in clips if "_dontcare_" not in clip.name]
    idle = [clip for clip in clips if "_dontcare_" in clip.name]
    y = np.array([label[clip.name] for clip in known])
    groups = np.array([person[clip.name] for clip in known])
    idle_groups = np.array([person[clip.name] for clip in idle])

    def both(name: str, run) -> None:
        begun = time.perf_counter()
        found, sure, idle_sure = np.empty(len(y), y.dtype), np.empty(len(y)), np.empty(len(idle))
        for who in np.unique(groups):
            train, test, aside = groups != who, groups == who, idle_groups == who
            found[test], sure[test], idle_sure[aside] = run(train, test, aside)
        right = (found == y).mean()
        print(f"{name}\tright {right:.3f}\t{time.perf_counter() - begun:.0f} s", flush=True)
        for kept in (1.0, 0.98, 0.95):
            level = np.quantile(sure, 1 - kept)
            accepted = (idle_sure >= level).mean()
            print(f"  accepting {kept:.2f} of the classes' clips: right {((found == y) & (sure >= level)).mean():.3f}, "
                  f"clips of no class accepted {accepted:.3f}", flush=True)

    for features in (False, True):
        X = np.stack([series(clip, features) for clip in known])
        idle_X = np.stack([series(clip, features) for clip in idle])

        def rocket(train, test, aside):
            model = make_pipeline(
                MiniRocket(random_state=1, n_jobs=-1), StandardScaler(with_mean=False),
                RidgeClassifierCV(alphas=np.logspace(-3, 3, 10)),
            ).fit(X[train], y[train])  # fmt: skip
            # Not everybody shows motion of no class.
            far = model.decision_function(idle_X[aside]).max(1) if aside.any() else np.empty(0)
            return model.predict(X[test]), model.decision_function(X[test]).max(1), far

        both(f"MiniRocket on {'feature rows' if features else 'places'}", rocket)

    def ours(train, test, aside):
        chosen = lambda mask, of: [clip for clip, keep in zip(of, mask) if keep]  # noqa: E731
        model = morec.MotionClassifier(everyday="auto").fit(chosen(train, known), y[train], groups=groups[train])
        rows = lambda clips: model.index_.classify(clips)  # noqa: E731
        near = lambda clips: np.array([max(row["probabilities"].values()) for row in rows(clips)])  # noqa: E731
        held = chosen(test, known)
        return model.predict(held), near(held), near(chosen(aside, idle)) if aside.any() else np.empty(0)

    both("morec.MotionClassifier", ours)


if __name__ == "__main__":
    main()

"""Hands: taught, recognised in clips and live by the names of their points."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import morec

RATE = 30.0
NAMES = ["wrist"] + [f"{finger}_{at}" for finger in ("thumb", "index", "middle", "ring", "little") for at in ("1", "2", "3", "tip")]


def hand(bends: np.ndarray) -> np.ndarray:
    """Positions of a right hand with the palm down, frame by frame, by how far each of its five fingers is bent."""
    frames = len(bends)
    points = [np.zeros((frames, 3))]
    for finger in range(5):
        at = np.tile([(2.5 - finger) * 0.02, 0.0, 0.03 if finger == 0 else 0.09], (frames, 1))
        for joint in range(1, 5):
            points.append(at)
            turned = bends[:, finger] * joint
            at = at + 0.026 * np.stack([np.zeros(frames), -np.sin(turned), np.cos(turned)], axis=1)
    return np.stack(points, axis=1) + [0.0, 0.2, 0.0]


def performance(seed: int) -> tuple[np.ndarray, list[tuple[str, float, float]]]:
    """A hand that closes and points, twice; between them it trembles."""
    rng = np.random.default_rng(seed)
    parts, truth, start = [], [], 0.0
    for kind in ("rest", "fist", "rest", "point", "rest", "fist", "rest", "point", "rest"):
        secs = rng.uniform(0.9, 1.2)
        course = np.sin(np.linspace(0.0, np.pi, round(secs * RATE)))
        bent = {"rest": [0, 0, 0, 0, 0], "fist": [1, 1, 1, 1, 1], "point": [1, 0, 1, 1, 1]}[kind]
        parts.append(0.1 + 0.9 * course[:, None] * np.array(bent) + 0.01 * rng.standard_normal((len(course), 1)))
        if kind != "rest":
            truth.append((kind, start, start + len(course) / RATE))
        start += len(course) / RATE
    positions = hand(np.concatenate(parts))
    return positions + 0.0005 * rng.standard_normal(positions.shape), truth


@pytest.fixture(scope="module")
def taught() -> morec.Index:
    clips, spans = [], []
    for seed in range(3):
        positions, truth = performance(seed)
        clips.append(morec.Clip.from_positions(positions, NAMES, RATE, name=f"hand{seed}"))
        spans += [(f"hand{seed}", kind, start, stop) for kind, start, stop in truth]
    return morec.train(clips, spans)


def test_an_index_of_hands_says_that_a_body_is_none(taught: morec.Index, newcomer: morec.Clip, tmp_path: Path) -> None:
    newcomer[0.0:4.0].save(tmp_path / "body.bvh")
    said = "this index recognises a hand, but the input shows a body"
    with morec.listen(f"clip://{tmp_path / 'body.bvh'}", taught, timeout=8.0) as events:
        with pytest.warns(morec.MorecWarning, match=f"error: {said}"):
            assert list(events) == []
        assert any(said in finding for finding in events.status["findings"])


def test_gestures_of_hands_are_recognised_in_clips_and_live(taught: morec.Index) -> None:
    positions, truth = performance(9)
    clip = morec.Clip.from_positions(positions, NAMES, RATE, name="new")
    assert len(clip.roles) == 21 and clip.roles["right_index_tip"] == NAMES.index("index_tip")
    found = taught.recognize(clip)
    assert [row["class"] for row in found] == [kind for kind, _, _ in truth]
    own = [f"right_{name}" if name != "wrist" else "right_hand" for name in NAMES]
    for names in (clip, NAMES, own):
        live = taught.recognizer(names)
        rows = []
        for frame, pose in enumerate(positions):
            rows += live.push(frame / RATE, pose)
        rows += live.finish()
        assert [row["class"] for row in rows] == [row["class"] for row in found]
        assert [row["stop_secs"] for row in rows] == pytest.approx([row["stop_secs"] for row in found])


def test_a_body_is_refused(taught: morec.Index, newcomer: morec.Clip) -> None:
    with pytest.raises(morec.MorecError, match="this index recognises a hand, but the input shows a body"):
        taught.recognize(newcomer)

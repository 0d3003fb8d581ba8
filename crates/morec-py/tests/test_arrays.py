"""Features and arrays for other people's models."""

from __future__ import annotations

import numpy as np
import pytest

import morec


def test_features_are_documented_columns(clips: list[morec.Clip]) -> None:
    found = morec.features(clips[0])
    assert found.values.dtype == np.float32 and found.values.shape == (len(found), 6 * len(found.bones) + 4)
    assert len(found.columns) == found.values.shape[1] == len(set(found.columns))
    assert abs(len(found) / found.rate_hz - clips[0].duration_secs) < 0.1
    assert np.asarray(found).shape == found.values.shape and np.asarray(found, np.float64).dtype == np.float64
    frame = found.to_pandas()
    assert list(frame.columns) == found.columns and frame.index.name == "time_secs"
    array = found.to_xarray()
    assert array.dims == ("time_secs", "feature") and float(array[3, 5]) == found.values[3, 5]


def test_directions_are_unit_vectors_times_a_weight(clips: list[morec.Clip]) -> None:
    found = morec.features(clips[0])
    bones = len(found.bones)
    directions = found.values[:, : 3 * bones].reshape(-1, bones, 3)
    lengths = np.linalg.norm(directions, axis=2)
    # Smoothing shortens directions a little while they turn.
    assert (np.ptp(lengths, axis=0) < 0.3 * lengths.max(axis=0)).all()
    up = found.values[:, found.columns.index("torso.direction.up")] if "torso" in found.bones else None
    if up is not None:
        assert np.median(up) > 0


def test_bones_can_be_chosen(clips: list[morec.Clip]) -> None:
    everything = morec.features(clips[0])
    some = morec.features(clips[0], bones=everything.bones[:3])
    assert some.bones == everything.bones[:3] and some.values.shape[1] == 22
    with pytest.raises(ValueError, match="no bone is called"):
        morec.features(clips[0], bones=["tail"])
    nobody = morec.Clip.from_positions(np.random.default_rng(1).normal(size=(50, 3, 3)), ["a", "b", "c"], 30)
    with pytest.raises(ValueError, match="no joint has a role"):
        morec.features(nobody)


def test_normalized_clips_have_the_roles_in_order(clips: list[morec.Clip]) -> None:
    clip = clips[0]
    places = morec.normalize(clip, dtype=np.float64)
    assert places.shape == (clip.frames, 18, 3)
    for role, joint in clip.roles.items():
        np.testing.assert_array_equal(places[:, morec.ROLES.index(role)], clip.positions[:, joint])
    slow = morec.normalize(clip, rate_hz=30)
    assert slow.dtype == np.float32 and slow.shape[0] == len(clip.resampled(30))


def test_centred_clips_begin_at_the_origin_facing_z(clips: list[morec.Clip]) -> None:
    places = morec.normalize(clips[0], centre=True, dtype=np.float64)
    hips, left, right = (morec.ROLES.index(role) for role in ("hips", "left_thigh", "right_thigh"))
    np.testing.assert_allclose(places[0, hips, [0, 2]], 0.0, atol=1e-9)
    across = places[0, left] - places[0, right]
    # Facing +Z with Y up, left is +X.
    assert across[0] > 0 and abs(across[2]) < 1e-9
    before = morec.normalize(clips[0], dtype=np.float64)
    np.testing.assert_allclose(
        np.linalg.norm(places[50, left] - places[90, hips]), np.linalg.norm(before[50, left] - before[90, hips])
    )


def test_windows_have_labels(clips: list[morec.Clip], labels: morec.Table) -> None:
    made = morec.windows(clips, labels, seconds=1.0, step=0.25)
    values, names = made
    assert values.shape[:2] == (len(names), 30) and set(names) == {"", "bow", "clap", "wave"}
    positions = morec.windows(clips[0], seconds=2.0, step=1.0, kind="positions")
    assert positions.values.shape[1:] == (60, 18, 3) and set(positions.labels) == {""}
    of_first = [at for at, clip in enumerate(made.clips) if clip == clips[0].name]
    np.testing.assert_array_equal(made.values[of_first[4]], morec.features(clips[0]).values[30:60])
    for at in of_first:
        start, stop = made.start_secs[at], made.start_secs[at] + 1.0
        shared = [
            (min(stop, row["stop_secs"]) - max(start, row["start_secs"]), row["class"])
            for row in labels
            if row["clip"] == clips[0].name
        ]
        best = max(shared)
        assert names[at] == (best[1] if best[0] >= 0.5 else "")
    assert len(morec.windows(clips[0][:0.5], seconds=1.0)) == 0
    with pytest.raises(ValueError, match="kind"):
        morec.windows(clips, kind="sounds")

"""Datasets of the library movement, as it validates them where it is installed."""

from __future__ import annotations

import numpy as np
import pytest

import morec

xarray = pytest.importorskip("xarray")
movement = pytest.importorskip("morec.movement")


def test_clips_come_back_from_a_dataset() -> None:
    clips, _ = morec.synth.database(people=2, classes=["wave", "bow"])
    two = [clip for clip in clips if clip.names == clips[0].names and clip.rate_hz == clips[0].rate_hz][:2]
    dataset = movement.to_xarray(two)
    assert dict(dataset.sizes)["individuals"] == 2 and dataset.attrs["ds_type"] == "poses"
    assert dataset.position.dims == ("time", "space", "keypoints", "individuals")
    assert dataset.confidence.dims == ("time", "keypoints", "individuals")
    joint = dataset.position.sel(individuals=two[0].name, keypoints=two[0].names[3]).values
    np.testing.assert_allclose(joint[: len(two[0].positions)], two[0].positions[:, 3])
    for clip, back in zip(two, movement.from_xarray(dataset)):
        assert (back.name, back.rate_hz, len(back.positions)) == (clip.name, clip.rate_hz, len(clip.positions))
        order = [back.names.index(name) for name in clip.names]
        np.testing.assert_allclose(back.positions[:, order], clip.positions, atol=1e-3)


def test_the_library_itself_accepts_the_dataset() -> None:
    pytest.importorskip("movement")
    from movement.kinematics import compute_velocity
    from movement.validators.datasets import ValidPosesInputs

    dataset = movement.to_xarray(morec.synth.database(people=1, classes=["wave"])[0][0])
    ValidPosesInputs.validate(dataset)
    speed = compute_velocity(dataset.position)
    assert speed.dims == dataset.position.dims


def test_pictures_need_roles_and_unsure_points_are_unknown() -> None:
    names, frames = ["nose", "neck", "tail"], 40
    xy = np.random.default_rng(0).normal(size=(frames, 2, len(names), 1)).cumsum(axis=0)
    sure = np.ones((frames, len(names), 1))
    sure[5, 0] = 0.1
    dims = ("time", "space", "keypoints", "individuals")
    dataset = xarray.Dataset(
        {"position": (dims, xy), "confidence": (("time", "keypoints", "individuals"), sure)},
        coords={"time": np.arange(frames), "space": ["x", "y"], "keypoints": names, "individuals": ["mouse"]},
        attrs={"fps": 30.0, "time_unit": "frames", "ds_type": "poses"},
    )
    with pytest.raises(ValueError, match="two dimensions"):
        movement.from_xarray(dataset)
    roles = {"point_1": "neck", "point_2": "nose", "point_3": "tail"}
    (clip,) = movement.from_xarray(dataset, roles=roles, least_confidence=0.5)
    assert clip.name == "mouse" and len(clip.positions) == frames
    del dataset.attrs["fps"]
    with pytest.raises(ValueError, match="frame rate"):
        movement.from_xarray(dataset, roles=roles)
    with pytest.raises(ValueError, match="expected a dataset of poses"):
        movement.from_xarray(dataset.drop_dims("keypoints"), roles=roles)

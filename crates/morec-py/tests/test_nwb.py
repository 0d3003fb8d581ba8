"""NWB files as pynwb itself reads and validates them."""

from __future__ import annotations

from datetime import datetime, timezone
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import morec

pynwb = pytest.importorskip("pynwb")
pytest.importorskip("ndx_ethogram")
pytest.importorskip("ndx_pose")
nwb = pytest.importorskip("morec.nwb")


def session() -> Any:
    return pynwb.NWBFile(
        session_description="A session.",
        identifier="one",
        session_start_time=datetime(2026, 1, 2, tzinfo=timezone.utc),
    )


def test_labels_and_poses_come_back_by_pynwb(tmp_path: Path) -> None:
    clips, labels = morec.synth.database(people=1, classes=["wave", "bow"])
    clip, path = clips[0], tmp_path / "one.nwb"
    nwbfile = session()
    nwb.add_poses(nwbfile, clip, start_secs=10.0)
    nwb.add_bouts(nwbfile, labels, clip, annotator="ann", start_secs=10.0)
    detected = [(clip.name, "wave", 1.0, 2.0), (clip.name, "bow", 1.5, 3.0), ("other", "bow", 0.0, 1.0)]
    nwb.add_bouts(nwbfile, detected, clip, name="detections", labeling_method="automated", start_secs=10.0)
    with pynwb.NWBHDF5IO(path, "w") as io:
        io.write(nwbfile)
    assert not pynwb.validate(path=str(path))

    expected = sorted((row["class"], row["start_secs"], row["stop_secs"]) for row in labels if row["clip"] == clip.name)
    with pynwb.NWBHDF5IO(path, "r") as io:
        read = io.read()
        bouts = read.processing["behavior"]["bouts"]
        assert bouts.labeling_method == "manual" and bouts.annotator == "ann"
        assert set(bouts.ethogram["behavior"].data[:]) == {label for label, _, _ in expected}
        rows = zip(bouts["label"].data[:], bouts["start_time"].data[:] - 10.0, bouts["stop_time"].data[:] - 10.0)
        assert sorted(rows) == [(name, pytest.approx(a), pytest.approx(b)) for name, a, b in expected]
        found = read.processing["behavior"]["detections"]
        assert list(found["label"].data[:]) == ["wave", "bow"]
        assert found.source_software.startswith("morec") and not found.ethogram.exclusive

        again = nwb.read_bouts(read, clip.name, start_secs=10.0)
        assert len(again) == len(expected) + 2 and again == sorted(again, key=lambda row: row[2:])
        (back,) = nwb.read_poses(read)
        assert back.name == clip.name and back.rate_hz == clip.rate_hz
        order = [back.names.index(name) for name in clip.names]
        np.testing.assert_allclose(back.positions[:, order], clip.positions, atol=1e-3)


def test_points_that_are_not_sure_are_unknown_and_mistakes_are_named() -> None:
    clips, _ = morec.synth.database(people=1, classes=["wave"])
    nwbfile = session()
    with pytest.raises(ValueError, match="found none"):
        nwb.read_poses(nwbfile)
    with pytest.raises(ValueError, match="expected labels of the clip"):
        nwb.add_bouts(nwbfile, [("other", "wave", 0.0, 1.0)], clips[0])
    poses = nwb.add_poses(nwbfile, clips[0])
    series = list(poses.pose_estimation_series.values())
    points = np.array(series[3].confidence)
    assert points.min() == 1.0
    points[:] = 0.2
    assert np.isnan(nwb._points(type("Series", (), {
        "data": series[3].data, "conversion": 1.0, "confidence": points,
    }), 0.5)).all()

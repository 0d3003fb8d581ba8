"""The examples with MediaPipe and a Kinect, on landmarks of synthetic people."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

import landmarks
import morec

EXAMPLES = Path(__file__).parents[1] / "examples"


def run(example: str, *args: object) -> list[list[str]]:
    command = [sys.executable, str(EXAMPLES / example), *map(str, args)]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    return [line.split("\t") for line in done.stdout.splitlines()]


def agree(found: list[list[str]], labels: morec.Table, clip: str) -> int:
    """How many labels have a detection of their class on them."""
    hits = 0
    for row in labels:
        if row["clip"] == clip:
            hits += any(
                name == row["class"] and float(start) < row["stop_secs"] and float(stop) > row["start_secs"]
                for name, start, stop in found
            )
    return hits


@pytest.fixture(scope="module")
def newcomer_labels() -> morec.Table:
    return morec.synth.database(1, people=4, repetitions=2, classes=["wave", "bow", "clap"])[1]


def test_mediapipe(index: morec.Index, newcomer: morec.Clip, newcomer_labels: morec.Table, tmp_path: Path) -> None:
    index.save(tmp_path / "signs.index")
    times, marks = landmarks.mediapipe(newcomer)
    np.savez(tmp_path / "take.npz", times_secs=times, landmarks=marks)
    found = run("mediapipe_pose.py", tmp_path / "signs.index", "--landmarks", tmp_path / "take.npz")
    assert agree(found, newcomer_labels, newcomer.name) >= 4


def test_mediapipe_without_a_live_stream(index: morec.Index, newcomer: morec.Clip) -> None:
    times, marks = landmarks.mediapipe(newcomer)
    names = [f"{number}" for number in range(33)]
    clip = morec.Clip.from_positions(marks, names, 30.0, unit=1.0)
    assert clip.facts["point_set"] == "MediaPipe pose (33)" and clip.facts["up"] == "-y"
    assert clip.positions[:, clip.roles["head"], 1].mean() > clip.positions[:, clip.roles["left_foot"], 1].mean()


def test_kinect(
    clips: list[morec.Clip], newcomer: morec.Clip, newcomer_labels: morec.Table, labels_tsv: Path, tmp_path: Path
) -> None:
    for clip in [*clips, newcomer]:
        times, joints = landmarks.kinect(clip)
        table = np.column_stack([times, joints.reshape(len(times), -1)])
        np.savetxt(tmp_path / f"{clip.name}.csv", table, delimiter=",", fmt="%.4f")
    recordings = [tmp_path / f"{clip.name}.csv" for clip in clips]
    run("kinect_joints.py", "train", tmp_path / "signs.index", labels_tsv, *recordings)
    found = run("kinect_joints.py", "recognize", tmp_path / "signs.index", tmp_path / f"{newcomer.name}.csv")
    assert agree(found, newcomer_labels, newcomer.name) >= 4

"""The camera, with a stand-in for MediaPipe and OpenCV that shows recorded landmarks."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path
from types import ModuleType, SimpleNamespace
from typing import Any

import numpy as np
import pytest

import landmarks
import morec


class Landmarker:
    """Shows one recorded frame after the other, and nobody in every tenth."""

    def __init__(self, marks: Any) -> None:
        self.marks = marks
        self.frame = 0

    def __enter__(self) -> Landmarker:
        return self

    def __exit__(self, *error: object) -> None:
        pass

    def detect_for_video(self, image: object, milliseconds: int) -> SimpleNamespace:
        row = self.marks[self.frame]
        self.frame += 1
        if self.frame % 10 == 0:
            return SimpleNamespace(pose_world_landmarks=[], pose_landmarks=[])
        # The feet are hidden, the knees below the picture.
        world = [SimpleNamespace(x=x, y=y, z=z, visibility=float(n < 27)) for n, (x, y, z) in enumerate(row)]
        picture = [SimpleNamespace(x=0.5, y=1.1 if n in (25, 26) else 0.9) for n in range(len(row))]
        return SimpleNamespace(pose_world_landmarks=[world], pose_landmarks=[picture])


def stand_in(monkeypatch: pytest.MonkeyPatch, marks: Any) -> list[str]:
    """Puts modules in the places of MediaPipe and OpenCV; a list of what was released."""
    released: list[str] = []
    left = [len(marks)]

    def read() -> tuple[bool, object]:
        left[0] -= 1
        return left[0] >= 0, None

    capture = SimpleNamespace(read=read, release=lambda: released.append("camera"))
    cv2 = ModuleType("cv2")
    vars(cv2).update(VideoCapture=lambda camera: capture, cvtColor=lambda picture, how: picture, COLOR_BGR2RGB=0)
    vision = SimpleNamespace(
        PoseLandmarkerOptions=SimpleNamespace,
        RunningMode=SimpleNamespace(VIDEO=0),
        PoseLandmarker=SimpleNamespace(create_from_options=lambda options: Landmarker(marks)),
    )
    tasks, package, mediapipe = (ModuleType(name) for name in ("python", "tasks", "mediapipe"))
    vars(tasks).update(vision=vision, BaseOptions=SimpleNamespace)
    vars(mediapipe).update(Image=SimpleNamespace, ImageFormat=SimpleNamespace(SRGB=0))
    names = {"cv2": cv2, "mediapipe": mediapipe, "mediapipe.tasks": package, "mediapipe.tasks.python": tasks}
    for name, module in names.items():
        monkeypatch.setitem(sys.modules, name, module)
    return released


def test_poses_come_with_y_up_and_the_camera_is_let_go(
    monkeypatch: pytest.MonkeyPatch, newcomer: morec.Clip, index: morec.Index, tmp_path: Path
) -> None:
    _, marks = landmarks.mediapipe(newcomer)
    marks = marks[:40]
    released = stand_in(monkeypatch, marks)
    model = tmp_path / "pose_landmarker_lite.task"
    model.touch()
    poses = list(morec.webcam(model))
    assert len(poses) == 36 and released == ["camera"]
    secs, pose = poses[0]
    assert secs >= 0 and pose.shape == (33, 3)
    np.testing.assert_allclose(pose[:25], marks[0, :25] * [1, -1, -1])
    assert np.isnan(pose[25:]).all()
    live = index.recognizer(morec.WEBCAM_POINTS)
    for secs, pose in poses:
        live.push(secs, pose)
    # The model of the working folder is found; whoever stops early lets the camera go.
    monkeypatch.chdir(tmp_path)
    released = stand_in(monkeypatch, marks)
    stopped = morec.webcam()
    next(stopped)
    stopped.close()
    assert released == ["camera"]


def test_what_is_missing_is_said_with_what_to_do(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.chdir(tmp_path)
    with pytest.raises(FileNotFoundError, match="download a pose landmarker"):
        morec.webcam()
    with pytest.raises(FileNotFoundError, match="other.task is not there"):
        morec.webcam("other.task")
    (tmp_path / "pose_landmarker.task").touch()
    monkeypatch.setitem(sys.modules, "mediapipe.tasks.python", None)
    with pytest.raises(ImportError, match="pip install mediapipe"):
        morec.webcam()
    stand_in(monkeypatch, [])
    with pytest.raises(OSError, match="camera 0 gives no picture"):
        next(morec.webcam())


def test_the_real_package_knows_what_is_asked_of_it(tmp_path: Path) -> None:
    """With a file that is no model: MediaPipe ships none."""
    pytest.importorskip("mediapipe")
    model = tmp_path / "pose_landmarker.task"
    model.write_bytes(b"no model")
    with pytest.raises(ValueError, match="pose_landmarker.task is no pose landmarker"):
        next(morec.webcam(model))
    # The guide's script, too, gets as far as the model.
    guide = Path(__file__).parents[3] / "docs" / "guide" / "devices.md"
    blocks = guide.read_text(encoding="utf-8").split("```python\n")[1:]
    script = next(block.split("```")[0] for block in blocks if "PoseLandmarkerOptions" in block)
    done = subprocess.run([sys.executable, "-c", script, str(model)], capture_output=True, text=True, check=False)
    assert done.returncode != 0 and "create_from_options" in done.stderr and "RuntimeError" in done.stderr

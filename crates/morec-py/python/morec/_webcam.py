"""Poses from this machine's camera, tracked by MediaPipe."""

from __future__ import annotations

import os
import time
from collections.abc import Generator
from importlib import import_module
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

__all__ = ["WEBCAM_POINTS", "webcam"]

#: MediaPipe's pose landmarks, in its order: what the poses of :func:`webcam` are made of.
WEBCAM_POINTS = (
    "nose left_eye_inner left_eye left_eye_outer right_eye_inner right_eye right_eye_outer left_ear right_ear "
    "mouth_left mouth_right left_shoulder right_shoulder left_elbow right_elbow left_wrist right_wrist left_pinky "
    "right_pinky left_index right_index left_thumb right_thumb left_hip right_hip left_knee right_knee left_ankle "
    "right_ankle left_heel right_heel left_foot_index right_foot_index"
).split()

MODELS = "https://ai.google.dev/edge/mediapipe/solutions/vision/pose_landmarker#models"


def webcam(
    model: str | os.PathLike[str] | None = None, camera: int = 0
) -> Generator[tuple[float, npt.NDArray[np.float64]], None, None]:
    """Poses of the person before a camera: seconds since the first frame, and the landmarks `WEBCAM_POINTS` of shape (33, 3).

    Metres from the middle of the hips, Y up; NaN where MediaPipe only guesses: hidden points, or points outside the picture.
    Frames without a person are left out. Needs the packages ``mediapipe`` (1.x)
    and ``opencv-python``, and ends with the camera, or when the iterator is closed.

    >>> live = index.recognizer(morec.WEBCAM_POINTS)                     # doctest: +SKIP
    >>> for secs, pose in morec.webcam("pose_landmarker_full.task"):     # doctest: +SKIP
    ...     for event in live.push(secs, pose):
    ...         print(event["class"], event["score"])

    Parameters
    ----------
    model : path, optional
        A pose landmarker of MediaPipe (not part of the package); by default the first ``pose_landmarker*.task`` in the working
        folder.
    camera : int
        Number of the camera.

    Raises
    ------
    FileNotFoundError
        No model was found.
    ValueError
        The file is not a model.
    ImportError
        A package is missing.
    OSError
        The camera returns no picture.
    """
    path = model_file(model)
    tasks = package("mediapipe.tasks.python", "mediapipe")
    mediapipe = package("mediapipe", "mediapipe")
    cv2 = package("cv2", "opencv-python")
    return frames(path, camera, mediapipe, tasks, cv2)


def frames(
    model: Path, camera: int, mediapipe: Any, tasks: Any, cv2: Any
) -> Generator[tuple[float, npt.NDArray[np.float64]], None, None]:
    vision = tasks.vision
    options = vision.PoseLandmarkerOptions(
        base_options=tasks.BaseOptions(model_asset_path=str(model)), running_mode=vision.RunningMode.VIDEO
    )
    try:
        opened = vision.PoseLandmarker.create_from_options(options)
    except RuntimeError as error:
        raise ValueError(f"{model} is no pose landmarker: {error}") from error
    capture = cv2.VideoCapture(camera)
    try:
        with opened as landmarker:
            seen, picture = capture.read()
            if not seen:
                raise OSError(f"camera {camera} gives no picture: is it there, free, and allowed?")
            begun = time.monotonic()
            while seen:
                secs = time.monotonic() - begun
                image = mediapipe.Image(
                    image_format=mediapipe.ImageFormat.SRGB, data=cv2.cvtColor(picture, cv2.COLOR_BGR2RGB)
                )
                found = landmarker.detect_for_video(image, round(1000 * secs))
                if found.pose_world_landmarks:
                    yield secs, points(found.pose_world_landmarks[0], found.pose_landmarks[0])
                seen, picture = capture.read()
    finally:
        capture.release()


def points(world: Any, picture: Any) -> npt.NDArray[np.float64]:
    """The landmarks of a person whose places in the picture, from 0 to 1, are `picture`."""
    # MediaPipe's Y is down, and its Z away from the camera.
    pose = np.array([[mark.x, -mark.y, -mark.z] for mark in world])
    seen = [mark.visibility > 0.5 and 0 <= at.x <= 1 and 0 <= at.y <= 1 for mark, at in zip(world, picture, strict=True)]
    pose[~np.array(seen)] = np.nan
    return pose


def model_file(model: str | os.PathLike[str] | None) -> Path:
    found = [Path(model)] if model is not None else sorted(Path().glob("pose_landmarker*.task"))
    if found and found[0].is_file():
        return found[0]
    where = f"{found[0]} is not there" if found else "no pose_landmarker*.task is in this folder"
    raise FileNotFoundError(f"{where}: MediaPipe ships no model; download a pose landmarker from {MODELS} and name the file")


def package(module: str, name: str) -> Any:
    try:
        return import_module(module)
    except ImportError as error:
        raise ImportError(f"webcam() needs {name}: pip install {name} ({error})") from error

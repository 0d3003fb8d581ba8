"""Landmarks of a clip as MediaPipe and a Kinect give them: in their order, axes and units."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

import morec

#: BlazePose, by the joint whose place stands in for the landmark.
MEDIAPIPE = (
    ["head"] * 11
    + ["left_arm", "right_arm", "left_forearm", "right_forearm", "left_hand", "right_hand"]
    + ["left_hand", "right_hand"] * 3
    + ["left_thigh", "right_thigh", "left_shin", "right_shin", "left_foot", "right_foot"]
    + ["left_foot", "right_foot"] * 2
)
#: Kinect for Windows SDK 2.0, JointType.
KINECT = [
    "hips", "torso", "neck", "head",
    "left_arm", "left_forearm", "left_hand", "left_hand", "right_arm", "right_forearm", "right_hand", "right_hand",
    "left_thigh", "left_shin", "left_foot", "left_foot", "right_thigh", "right_shin", "right_foot", "right_foot",
    "neck", "left_hand", "left_hand", "right_hand", "right_hand",
]  # fmt: skip


def _of(clip: morec.Clip, roles: list[str]) -> tuple[npt.NDArray[np.float64], npt.NDArray[np.float64]]:
    slow = clip.resampled(30.0)
    places = morec.normalize(slow, dtype=np.float64)[:, [morec.ROLES.index(role) for role in roles]]
    return np.arange(len(places)) / 30.0, places


def mediapipe(clip: morec.Clip) -> tuple[npt.NDArray[np.float64], npt.NDArray[np.float64]]:
    """Times and world landmarks: metres from between the hips, Y down, Z away from the camera; 30 a second."""
    times, places = _of(clip, MEDIAPIPE)
    places = places - (places[:, 23:24] + places[:, 24:25]) / 2
    return times, places * np.array([1.0, -1.0, -1.0])


def kinect(clip: morec.Clip) -> tuple[npt.NDArray[np.float64], npt.NDArray[np.float64]]:
    """Times and joints: metres from the sensor, Y up, somebody who faces it 2.5 m away; 30 a second."""
    times, places = _of(clip, KINECT)
    return times, places * np.array([-1.0, 1.0, -1.0]) + np.array([0.0, -0.9, 2.5])

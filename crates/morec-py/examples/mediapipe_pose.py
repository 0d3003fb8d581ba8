"""Recognise motions before a webcam, with the landmarks of MediaPipe.

    python mediapipe_pose.py signs.index                          # the camera; needs mediapipe and opencv-python
    python mediapipe_pose.py signs.index --landmarks take.npz     # recorded: times_secs (n,), landmarks (n, 33, 3)
    python mediapipe_pose.py signs.index --model pose.task        # the model file that MediaPipe's tasks need

The index may be trained on any clips, of landmarks or of a skeleton.
"""

from __future__ import annotations

import argparse
import time
from collections.abc import Iterator

import numpy as np
import numpy.typing as npt

import morec

#: Pose landmarks in MediaPipe's order.
NAMES = (
    "nose left_eye_inner left_eye left_eye_outer right_eye_inner right_eye right_eye_outer left_ear right_ear "
    "mouth_left mouth_right left_shoulder right_shoulder left_elbow right_elbow left_wrist right_wrist left_pinky "
    "right_pinky left_index right_index left_thumb right_thumb left_hip right_hip left_knee right_knee left_ankle "
    "right_ankle left_heel right_heel left_foot_index right_foot_index"
).split()
Frame = tuple[float, npt.NDArray[np.float64]]


def recorded(path: str) -> Iterator[Frame]:
    """Frames of a recording."""
    with np.load(path) as take:
        yield from zip(take["times_secs"].tolist(), take["landmarks"])


def camera(model: str) -> Iterator[Frame]:
    """Frames of the first camera."""
    import cv2
    from mediapipe import Image, ImageFormat
    from mediapipe.tasks.python import BaseOptions, vision

    options = vision.PoseLandmarkerOptions(
        base_options=BaseOptions(model_asset_path=model), running_mode=vision.RunningMode.VIDEO
    )
    capture, begun = cv2.VideoCapture(0), time.monotonic()
    with vision.PoseLandmarker.create_from_options(options) as landmarker:
        while True:
            seen, picture = capture.read()
            secs = time.monotonic() - begun
            if not seen:
                return
            image = Image(image_format=ImageFormat.SRGB, data=cv2.cvtColor(picture, cv2.COLOR_BGR2RGB))
            people = landmarker.detect_for_video(image, round(1000 * secs)).pose_world_landmarks
            if people:
                yield secs, np.array([[mark.x, mark.y, mark.z] for mark in people[0]])


def main() -> None:
    parser = argparse.ArgumentParser(description="Recognise motions before a webcam.")
    parser.add_argument("index")
    parser.add_argument("--landmarks", help="a recording in place of the camera")
    parser.add_argument("--model", default="pose_landmarker.task")
    args = parser.parse_args()
    # World landmarks: metres, Y down.
    live = morec.load(args.index).recognizer(NAMES, up="-y")
    frames = recorded(args.landmarks) if args.landmarks else camera(args.model)
    for secs, landmarks in frames:
        for found in live.push(secs, landmarks):
            print(f"{found['class']}\t{found['start_secs']:.2f}\t{found['stop_secs']:.2f}", flush=True)
    for found in live.finish():
        print(f"{found['class']}\t{found['start_secs']:.2f}\t{found['stop_secs']:.2f}", flush=True)


if __name__ == "__main__":
    main()

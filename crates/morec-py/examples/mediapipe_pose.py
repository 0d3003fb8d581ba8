"""Recognise motions before a webcam, with the landmarks of MediaPipe.

    python mediapipe_pose.py signs.index                          # the camera; needs mediapipe and opencv-python
    python mediapipe_pose.py signs.index --landmarks take.npz     # recorded: times_secs (n,), landmarks (n, 33, 3)
    python mediapipe_pose.py signs.index --model pose.task        # the model file that MediaPipe needs

The index may be trained on any clips, of landmarks or of a skeleton.
"""

from __future__ import annotations

import argparse
from collections.abc import Iterator

import numpy as np
import numpy.typing as npt

import morec

Frame = tuple[float, npt.NDArray[np.float64]]


def recorded(path: str) -> Iterator[Frame]:
    """Frames of a recording, whose Y is down as MediaPipe's is."""
    with np.load(path) as take:
        yield from zip(take["times_secs"].tolist(), take["landmarks"] * [1, -1, -1])


def main() -> None:
    parser = argparse.ArgumentParser(description="Recognise motions before a webcam.")
    parser.add_argument("index")
    parser.add_argument("--landmarks", help="a recording in place of the camera")
    parser.add_argument("--model", help="MediaPipe's pose landmarker [default: pose_landmarker*.task in this folder]")
    args = parser.parse_args()
    live = morec.load(args.index).recognizer(morec.WEBCAM_POINTS)
    frames = recorded(args.landmarks) if args.landmarks else morec.webcam(args.model)
    for secs, landmarks in frames:
        for found in live.push(secs, landmarks):
            print(f"{found['class']}\t{found['start_secs']:.2f}\t{found['stop_secs']:.2f}", flush=True)
    for found in live.finish():
        print(f"{found['class']}\t{found['start_secs']:.2f}\t{found['stop_secs']:.2f}", flush=True)


if __name__ == "__main__":
    main()

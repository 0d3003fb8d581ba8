"""Teach gestures with a Kinect and recognise them.

    python kinect_joints.py train signs.index labels.tsv anna.csv ben.csv …
    python kinect_joints.py recognize signs.index new.csv

A recording is a table without a header, commas between: seconds, then x, y, z of the 25 joints of the Kinect for Windows
SDK 2.0 in the order of JointType, metres. A joint that is not tracked is nan.
"""

from __future__ import annotations

import argparse
from pathlib import Path

import numpy as np

import morec

#: Joints in the order of JointType.
NAMES = (
    "SpineBase SpineMid Neck Head ShoulderLeft ElbowLeft WristLeft HandLeft ShoulderRight ElbowRight WristRight "
    "HandRight HipLeft KneeLeft AnkleLeft FootLeft HipRight KneeRight AnkleRight FootRight SpineShoulder HandTipLeft "
    "ThumbLeft HandTipRight ThumbRight"
).split()


def clip_of(path: Path) -> morec.Clip:
    """A recording as a clip."""
    table = np.loadtxt(path, delimiter=",", ndmin=2)
    times, joints = table[:, 0], table[:, 1:].reshape(len(table), len(NAMES), 3)
    rate_hz = (len(times) - 1) / (times[-1] - times[0])
    # A Kinect looks level, more or less: Y is up.
    return morec.Clip.from_positions(joints, NAMES, rate_hz, name=path.stem, unit=1.0, up="y")


def main() -> None:
    parser = argparse.ArgumentParser(description="Teach gestures with a Kinect and recognise them.")
    commands = parser.add_subparsers(dest="command", required=True)
    train = commands.add_parser("train")
    train.add_argument("index")
    train.add_argument("labels")
    train.add_argument("recordings", nargs="+", type=Path)
    recognize = commands.add_parser("recognize")
    recognize.add_argument("index")
    recognize.add_argument("recording", type=Path)
    args = parser.parse_args()
    if args.command == "train":
        morec.train([clip_of(path) for path in args.recordings], args.labels).save(args.index)
        return
    for found in morec.load(args.index).recognize(clip_of(args.recording)):
        print(f"{found['class']}\t{found['start_secs']:.2f}\t{found['stop_secs']:.2f}")


if __name__ == "__main__":
    main()

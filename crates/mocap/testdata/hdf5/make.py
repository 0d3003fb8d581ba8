"""Writes the small HDF5 files of the tests, with the libraries that pose estimators write theirs with (pip install h5py tables pandas).

    python crates/mocap/testdata/hdf5/make.py
"""

from pathlib import Path

import h5py
import numpy as np
import pandas as pd

FOLDER = Path(__file__).parent
FRAMES = 6
NAMES = ["left_hip", "left_knee", "left_ankle", "right_hip", "right_knee", "right_ankle", "neck", "head"]
PLACES = np.array(
    [[0.1, 0.9, 0], [0.1, 0.5, 0], [0.1, 0.1, 0], [-0.1, 0.9, 0], [-0.1, 0.5, 0], [-0.1, 0.1, 0], [0, 1.4, 0], [0, 1.6, 0]]
)
ALL = np.array([PLACES + [0.01 * frame, 0, 0] for frame in range(FRAMES)])
ALL[2:4, 7] = np.nan


def deeplabcut(name, axes, **kind):
    last = np.ones((FRAMES, len(NAMES))) if axes[2] == "likelihood" else ALL[:, :, 2]
    columns = pd.MultiIndex.from_product([["DLC"], NAMES, axes], names=["scorer", "bodyparts", "coords"])
    values = np.dstack([ALL[:, :, 0], ALL[:, :, 1], last]).reshape(FRAMES, -1)
    frame = pd.DataFrame(values, columns=columns)
    frame.to_hdf(FOLDER / name, key="df_with_missing", mode="w", **kind)


def main():
    deeplabcut("table.h5", ["x", "y", "z"], format="table", index=False, complevel=9)
    deeplabcut("fixed.h5", ["x", "y", "z"], format="fixed")
    deeplabcut("picture.h5", ["x", "y", "likelihood"], format="fixed")
    with h5py.File(FOLDER / "tracks.h5", "w") as file:
        # SLEAP's order: tracks, axes, nodes, frames.
        file.create_dataset("tracks", data=np.transpose(ALL, (2, 1, 0))[None], compression="gzip", chunks=(1, 3, 8, 3))
        file["node_names"] = np.array(NAMES, dtype="S")
    with h5py.File(FOLDER / "pose.nwb", "w") as file:
        poses = file.create_group("processing/behavior/PoseEstimation")
        poses.attrs["neurodata_type"] = "PoseEstimation"
        for number, name in enumerate(NAMES):
            series = poses.create_group(name)
            series.attrs["neurodata_type"] = "PoseEstimationSeries"
            data = series.create_dataset("data", data=100 * ALL[:, number])
            data.attrs["unit"] = "centimeters"
            if number == 0:
                start = series.create_dataset("starting_time", data=0.5)
                start.attrs["rate"] = 60.0
            else:
                series["starting_time"] = h5py.SoftLink(f"{poses.name}/{NAMES[0]}/starting_time")


if __name__ == "__main__":
    main()

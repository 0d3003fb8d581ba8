"""Positions as morec reads them beside those of other readers, on files of your own.

    python3 -m venv v && v/bin/pip install numpy ezc3d c3d bvh nimblephysics mvnx_parser
    v/bin/python docs/scripts/readers.py target/release/morec FILE...

Each file is converted to TRC by morec (positions, in the file's own axes and a named unit) and compared with what ezc3d
and c3d (C3D), bvh with forward kinematics in NumPy (BVH), nimblephysics (TRC) or mvnx_parser (MVNX) make of it. The figure is the largest distance of any point
that both see, as a share of the size of the recording.
"""

import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np


def of_morec(morec, path):
    """Names, positions (frames, points, 3; NaN where not seen) in metres."""
    with tempfile.TemporaryDirectory() as folder:
        out = Path(folder) / "x.trc"
        subprocess.run([morec, "convert", path, "-o", out], check=True, capture_output=True)
        rows = [line.split("\t") for line in out.read_text().splitlines()]
    unit = {"m": 1.0, "cm": 0.01, "mm": 0.001}[rows[2][4]]
    names = [cell for cell in rows[3][2:] if cell]
    values = [[float(v) if v.strip() else np.nan for v in (row + [""] * (3 * len(names)))[2:2 + 3 * len(names)]]
              for row in rows[5:] if len(row) > 2]
    return names, unit * np.array(values).reshape(len(values), len(names), 3)


def metres(unit):
    return {"m": 1.0, "cm": 0.01, "mm": 0.001}.get(str(unit).strip().lower(), 0.001)


def of_ezc3d(path):
    import ezc3d

    file = ezc3d.c3d(str(path))
    parameters = file["parameters"]["POINT"]
    unit = metres((parameters.get("UNITS", {}).get("value") or ["mm"])[0])
    points = file["data"]["points"][:3].transpose(2, 1, 0)
    seen = file["data"]["meta_points"]["residuals"][0].T >= 0
    names = parameters["LABELS"]["value"]
    points = np.where(seen[..., None], points, np.nan)
    return names, unit * points


def of_c3d(path):
    import c3d

    with open(path, "rb") as handle:
        reader = c3d.Reader(handle)
        names = [label.strip() for label in reader.point_labels]
        frames = [points.copy() for _, points, _ in reader.read_frames()]
        unit = reader.get("POINT:UNITS")
        unit = metres(unit.string_value) if unit else 0.001
    points = np.array(frames)
    return names, unit * np.where(points[..., 3:4] >= 0, points[..., :3], np.nan)


def of_bvh(path):
    import bvh

    tree = bvh.Bvh(Path(path).read_text())
    names = tree.get_joints_names()
    frames = np.array([[float(v) for v in frame] for frame in tree.frames])
    world, turns, column = {}, {}, 0
    for name in names:
        parent = tree.joint_parent(name)
        offset = np.tile(np.array(tree.joint_offset(name), float), (len(frames), 1))
        turn = np.tile(np.eye(3), (len(frames), 1, 1))
        moved = offset.copy()
        for channel in tree.joint_channels(name):
            values, column = frames[:, column], column + 1
            axis = "XYZ".index(channel[0].upper())
            if channel.lower().endswith("position"):
                moved[:, axis] = values
            else:
                c, s = np.cos(np.radians(values)), np.sin(np.radians(values))
                own = np.tile(np.eye(3), (len(frames), 1, 1))
                a, b = (axis + 1) % 3, (axis + 2) % 3
                own[:, a, a], own[:, a, b], own[:, b, a], own[:, b, b] = c, -s, s, c
                turn = turn @ own
        if parent is None or parent.name not in turns:
            world[name], turns[name] = moved, turn
        else:
            up = turns[parent.name]
            world[name] = world[parent.name] + np.einsum("fij,fj->fi", up, moved)
            turns[name] = up @ turn
    # BVH states no unit: the comparison is up to one factor.
    return names, np.stack([world[name] for name in names], axis=1)


def of_nimblephysics(path):
    import nimblephysics

    trc = nimblephysics.biomechanics.OpenSimParser.loadTRC(str(path))
    frames = list(trc.markerTimesteps)
    names = sorted({name for frame in frames for name in frame})
    nowhere = np.full(3, np.nan)
    return names, np.array([[frame.get(name, nowhere) for name in names] for frame in frames], float)


def of_mvnx_parser(path):
    import mvnx_parser.parser

    file = mvnx_parser.parser.Mvnx_p(str(path))
    names = [thing.get("label") for thing in file.root.iter() if thing.tag.endswith("}segment") or thing.tag == "segment"]
    return names, np.array(file.position, float).reshape(len(file.frames), -1, 3)


READERS = {".trc": [("nimblephysics", of_nimblephysics)], ".mvnx": [("mvnx_parser", of_mvnx_parser)],
           ".c3d": [("ezc3d", of_ezc3d), ("c3d", of_c3d)], ".bvh": [("bvh", of_bvh)]}


def compare(ours, theirs, scaled):
    (names, a), (others, b) = ours, theirs
    common = [(i, others.index(name)) for i, name in enumerate(names) if others.count(name) == 1]
    frames = min(len(a), len(b))
    a, b = a[:frames, [i for i, _ in common]], b[:frames, [j for _, j in common]]
    both = np.isfinite(a).all(2) & np.isfinite(b).all(2) & (np.abs(b).sum(2) > 0)
    if scaled:
        b = b * np.linalg.norm(a[both]) / np.linalg.norm(b[both])
    size = np.linalg.norm(np.nanmax(a[both], 0) - np.nanmin(a[both], 0))
    return len(common), frames, np.linalg.norm(a[both] - b[both], axis=1).max() / size


def main():
    morec, *files = sys.argv[1:]
    for path in files:
        readers = READERS.get(Path(path).suffix.lower(), [])
        for name, read in readers:
            try:
                theirs = read(path)
                points, frames, off = compare(of_morec(morec, path), theirs, name == "bvh")
                print(f"{Path(path).name}\t{name}\t{points} points\t{frames} frames\t{off:.1e}")
            except Exception as error:  # What a peer cannot read is a result, too.
                print(f"{Path(path).name}\t{name}\t{type(error).__name__}: {str(error)[:80]}")


if __name__ == "__main__":
    main()

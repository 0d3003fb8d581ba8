"""Bodies of OpenSim models as morec places them beside nimblephysics.

    python3 -m venv v && v/bin/pip install nimblephysics 'numpy<2'
    v/bin/python docs/scripts/opensim.py target/release/morec MODEL.osim...

For each model a motion is made in which every coordinate swings within its limits, converted by morec to a table of
positions in metres, and compared with the origins of the bodies that nimblephysics computes. The figure is the largest
difference of any coordinate of any body that both have.
"""

import csv
import subprocess
import sys
import tempfile
from pathlib import Path

import nimblephysics as nimble
import numpy as np

FRAMES = 60


def motion(skeleton):
    """Coordinates (frames, degrees of freedom) in radians and metres."""
    count = skeleton.getNumDofs()
    low = np.maximum(skeleton.getPositionLowerLimits(), -0.8)
    high = np.minimum(skeleton.getPositionUpperLimits(), 0.8)
    phases = np.random.default_rng(1).uniform(0, 2 * np.pi, count)
    swing = 0.5 + 0.35 * np.sin(np.arange(FRAMES)[:, None] / 10 + phases)
    return low + swing * (high - low)


def write(path, names, coordinates):
    rows = ["Coordinates", "version=1", f"nRows={FRAMES}", f"nColumns={len(names) + 1}", "inDegrees=no", "endheader"]
    rows.append("\t".join(["time", *names]))
    for frame, values in enumerate(coordinates):
        rows.append("\t".join([f"{frame / 100:.6f}", *(f"{value:.9f}" for value in values)]))
    path.write_text("\n".join(rows) + "\n")


def of_nimble(skeleton, coordinates):
    """Origin of each body by name, (frames, 3) in metres."""
    nodes = [skeleton.getBodyNode(k) for k in range(skeleton.getNumBodyNodes())]
    origins = {node.getName(): (node, np.zeros(3)) for node in nodes}
    places = []
    for values in coordinates:
        skeleton.setPositions(values)
        places.append(skeleton.getMarkerMapWorldPositions(origins))
    return {name: np.array([frame[name] for frame in places]) for name in origins}


def of_morec(morec, motion_path, model, folder):
    out = folder / "out.csv"
    command = [morec, "convert", motion_path, "--skeleton", model, "-o", out]
    subprocess.run(command, check=True, capture_output=True)
    with out.open() as lines:
        head, *rows = csv.reader(lines)
    values = np.array(rows, dtype=float)
    names = [name[:-2] for name in head if name.endswith("_x")]
    return {name: values[:, head.index(name + "_x"):][:, :3] for name in names}


def compare(morec, model):
    skeleton = nimble.biomechanics.OpenSimParser.parseOsim(str(model)).skeleton
    names = [skeleton.getDofByIndex(k).getName() for k in range(skeleton.getNumDofs())]
    coordinates = motion(skeleton)
    theirs = of_nimble(skeleton, coordinates)
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "motion.mot"
        write(path, names, coordinates)
        ours = of_morec(morec, path, model, Path(folder))
    both = sorted(ours.keys() & theirs.keys())
    worst = max(float(np.abs(ours[name] - theirs[name]).max()) for name in both)
    print(f"{model.name}\t{len(names)} coordinates\t{len(both)} of {len(theirs)} bodies\t{worst:.1e} m")


if __name__ == "__main__":
    if len(sys.argv) < 3:
        sys.exit(__doc__)
    for argument in sys.argv[2:]:
        compare(sys.argv[1], Path(argument).resolve())

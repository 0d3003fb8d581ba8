"""Positions of the joints of FBX, glTF and VRMA files as morec reads them, beside Blender's importers, on files of your own.

    python3.11 -m venv v && v/bin/pip install numpy bpy
    v/bin/python docs/scripts/scenes.py target/release/morec [--step SECS] FILE...

Each file is converted to TRC by morec (one table for each skeleton) and imported by Blender, without its window. The figure is the
largest distance of any joint that both name, at any frame, as a share of the size of the recording: as it stands, and after one
turn, shift and scale of the whole recording (Blender turns scenes to Z up, and units of FBX are kept in different places).
Between keys Blender draws straight lines between quaternions, where glTF asks for arcs: `--step` compares only at multiples of a
time, for files whose keys are that far apart.
"""

import argparse
import contextlib
import json
import os
import shutil
import struct
import subprocess
import tempfile
from pathlib import Path

import bpy
import numpy as np

UNITS = {"m": 1.0, "cm": 0.01, "mm": 0.001}


def of_morec(morec, path):
    """For each skeleton its rate, names and positions (frames, points, 3) in metres."""
    with tempfile.TemporaryDirectory() as folder:
        subprocess.run([morec, "convert", path, "-o", folder, "--form", "trc"], check=True, capture_output=True)
        for table in sorted(Path(folder).rglob("*.trc")):
            rows = [line.split("\t") for line in table.read_text().splitlines()]
            names = [cell for cell in rows[3][2:] if cell]
            values = [[float(v) for v in row[2:2 + 3 * len(names)]] for row in rows[5:] if len(row) > 2]
            positions = UNITS[rows[2][4]] * np.array(values).reshape(len(values), len(names), 3)
            yield float(rows[2][0]), names, positions


def bones_of_vrm(path):
    """Names that a VRMA gives its nodes as bones of a person, and the nodes' own."""
    data = Path(path).read_bytes()
    if data[:4] != b"glTF":
        return {}
    scene = json.loads(data[20:20 + struct.unpack_from("<I", data, 12)[0]])
    bones = scene.get("extensions", {}).get("VRMC_vrm_animation", {}).get("humanoid", {}).get("humanBones", {})
    return {name: scene["nodes"][bone["node"]].get("name", "") for name, bone in bones.items()}


def load(path, rate):
    """The file as Blender's only scene, its frames as many a second as morec's."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    # The importer of FBX stumbles over lights where this add-on is on.
    bpy.ops.preferences.addon_disable(module="cycles")
    bpy.context.scene.render.fps = max(1, round(rate))
    bpy.context.scene.render.fps_base = max(1, round(rate)) / rate
    with tempfile.TemporaryDirectory() as folder, open(os.devnull, "w") as quiet, contextlib.redirect_stdout(quiet):
        if Path(path).suffix.lower() == ".fbx":
            bpy.ops.import_scene.fbx(filepath=str(path), anim_offset=0.0, automatic_bone_orientation=False)
            return
        scene = Path(path)
        if scene.suffix.lower() in (".vrma", ".vrm"):
            # These are GLB under another name.
            scene = Path(shutil.copy(path, Path(folder) / "scene.glb"))
        bpy.ops.import_scene.gltf(filepath=str(scene), bone_heuristic="BLENDER", guess_original_bind_pose=False)


def of_blender(frames, rate):
    """For each name the places of what carries it, (frames, 3), in Blender's axes."""
    scene = bpy.context.scene
    ratio = scene.render.fps / scene.render.fps_base / rate
    places = {}
    for frame in range(frames):
        at = frame * ratio
        scene.frame_set(int(at), subframe=at - int(at))
        for thing in scene.objects:
            places.setdefault(thing.name, {}).setdefault(frame, thing.matrix_world.translation.copy())
            for bone in thing.pose.bones if thing.pose else []:
                places.setdefault(bone.name, {})[frame] = thing.matrix_world @ bone.head
    return {name: np.array([at[frame] for frame in range(frames)]) for name, at in places.items() if len(at) == frames}


def aligned(a, b):
    """`b` turned, shifted and scaled as one onto `a` (Umeyama 1991)."""
    mean_a, mean_b = a.reshape(-1, 3).mean(0), b.reshape(-1, 3).mean(0)
    a0, b0 = a.reshape(-1, 3) - mean_a, b.reshape(-1, 3) - mean_b
    u, s, v = np.linalg.svd(a0.T @ b0)
    sign = np.diag([1, 1, np.sign(np.linalg.det(u @ v))])
    turn = u @ sign @ v
    scale = (s * np.diag(sign)).sum() / (b0 ** 2).sum()
    return scale * (b.reshape(-1, 3) - mean_b) @ turn.T + mean_a, scale


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("morec")
    parser.add_argument("--step", type=float)
    parser.add_argument("files", nargs="+")
    args = parser.parse_args()
    morec = args.morec
    for path in args.files:
        bones = bones_of_vrm(path)
        for number, (rate, names, ours) in enumerate(of_morec(morec, path)):
            load(path, rate)
            theirs = of_blender(len(ours), rate)
            theirs.update({name: theirs[node] for name, node in bones.items() if node in theirs})
            common = [name for name in names if name in theirs and names.count(name) == 1]
            if not common:
                print(f"{Path(path).name}\t{number + 1}\tno joint of {len(names)} is named alike")
                continue
            a = ours[:, [names.index(name) for name in common]]
            b = np.stack([theirs[name] for name in common], axis=1)
            if args.step:
                at_step = [f for f in range(len(a)) if abs(f / rate - args.step * round(f / rate / args.step)) < 1e-6]
                a, b = a[at_step], b[at_step]
            size = np.linalg.norm(a.reshape(-1, 3).max(0) - a.reshape(-1, 3).min(0))
            fitted, scale = aligned(a, b)
            off = np.linalg.norm(a.reshape(-1, 3) - fitted, axis=1)
            # Y up as glTF and most FBX have it.
            turned = b[..., [0, 2, 1]] * [1, 1, -1]
            stands = np.linalg.norm(a - turned, axis=2)
            print(f"{Path(path).name}\t{number + 1}\t{len(common)} of {len(names)} joints\t{len(a)} frames\t"
                  f"{stands.max() / size:.1e} as it stands\t{off.max() / size:.1e} aligned, scale {scale:.5g}", flush=True)


if __name__ == "__main__":
    main()

"""Joint positions of a VRM animation by an independent reader, for formats/gltf/tests.rs.

    pip install pygltflib numpy
    python gltf.py FOLDER/idle_loop.vrma > gltf.json

Accessors are read by pygltflib; nodes are composed as 4x4 matrices. Keys, not what lies between them, are compared:
frame f of the clip is key f of every channel.
"""

import json
import sys

import numpy as np
from pygltflib import GLTF2

gltf = GLTF2().load_binary(sys.argv[1])
blob = gltf.binary_blob()
WIDTH = {"SCALAR": 1, "VEC3": 3, "VEC4": 4}


def values(number):
    accessor = gltf.accessors[number]
    view = gltf.bufferViews[accessor.bufferView]
    begin = (view.byteOffset or 0) + (accessor.byteOffset or 0)
    width = WIDTH[accessor.type]
    data = np.frombuffer(blob, "<f4", accessor.count * width, begin)
    return data.reshape(accessor.count, width).astype(float)


def matrix(t, q, s):
    x, y, z, w = np.array(q) / np.linalg.norm(q)
    turned = np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
            [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
            [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
        ]
    )
    whole = np.eye(4)
    whole[:3, :3] = turned * np.array(s)
    whole[:3, 3] = t
    return whole


animation = gltf.animations[0]
keys = {}
for channel in animation.channels:
    output = animation.samplers[channel.sampler].output
    keys[channel.target.node, channel.target.path] = values(output)
parents = {child: p for p, node in enumerate(gltf.nodes) for child in node.children or []}


def world(node, frame):
    n = gltf.nodes[node]
    part = lambda path, rest: keys[node, path][frame] if (node, path) in keys else rest
    local = matrix(
        part("translation", n.translation or [0, 0, 0]),
        part("rotation", n.rotation or [0, 0, 0, 1]),
        part("scale", n.scale or [1, 1, 1]),
    )
    return world(parents[node], frame) @ local if node in parents else local


bones = gltf.extensions["VRMC_vrm_animation"]["humanoid"]["humanBones"]
frames = [0, 100, 249]
positions = {
    bone: [[round(float(v), 6) for v in world(json_["node"], f)[:3, 3]] for f in frames]
    for bone, json_ in sorted(bones.items())
}
print(json.dumps({"file": "idle_loop.vrma", "frames": frames, "positions": positions}, indent=1))

"""BVH clips as FBX and GLB, written by Blender, so that the same motion can be recognised from other formats.

    python3.11 -m venv v && v/bin/pip install bpy
    v/bin/python docs/scripts/through_blender.py OUT SCALE CLIP.bvh...

OUT gets the folders `fbx` and `glb`; SCALE is metres in the clips' unit (0.056444 for those of mocap.cs.cmu.edu).
"""

import sys
from pathlib import Path

import bpy


def main():
    out, scale, *clips = sys.argv[1:]
    for form in ("fbx", "glb"):
        (Path(out) / form).mkdir(parents=True, exist_ok=True)
    for clip in clips:
        bpy.ops.wm.read_factory_settings(use_empty=True)
        bpy.ops.import_anim.bvh(filepath=clip, update_scene_fps=True, update_scene_duration=True, global_scale=float(scale))
        stem = Path(clip).stem
        bpy.ops.export_scene.fbx(filepath=f"{out}/fbx/{stem}.fbx", bake_anim_simplify_factor=0.0)
        bpy.ops.export_scene.gltf(filepath=f"{out}/glb/{stem}.glb", export_format="GLB")


if __name__ == "__main__":
    main()

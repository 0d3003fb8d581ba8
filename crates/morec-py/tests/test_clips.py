"""Clips: reading, arrays, slices, pickles."""

from __future__ import annotations

import io
import pickle
from pathlib import Path

import numpy as np
import pytest

import morec


def test_a_clip_says_what_it_is(clips: list[morec.Clip]) -> None:
    clip = clips[0]
    assert len(clip) == clip.frames == round(clip.duration_secs * clip.rate_hz)
    assert clip.positions.shape == (clip.frames, len(clip.names), 3)
    assert clip.rotations is not None and clip.rotations.shape == (clip.frames, len(clip.names), 4)
    assert clip.positions.dtype == np.float64
    np.testing.assert_allclose(np.linalg.norm(clip.rotations, axis=2), 1.0)
    assert clip.parents[0] == -1 and (clip.parents[1:] < np.arange(1, len(clip.names))).all()
    assert set(clip.roles) <= set(morec.ROLES) and "hips" in clip.roles
    # Metres, Y up: a grown person's hips.
    assert 0.7 < np.median(clip.positions[:, clip.roles["hips"], 1]) < 1.2
    assert clip.facts["up"] == "y" and clip.warnings == []
    assert clip.name in repr(clip)


def test_positions_are_forward_kinematics(clips: list[morec.Clip]) -> None:
    from itertools import islice

    clip = clips[0]
    assert clip.rotations is not None
    frame = 100
    world: list[tuple[np.ndarray, np.ndarray]] = []
    for joint in range(len(clip.names)):
        x, y, z, w = clip.rotations[frame, joint]
        turn = np.array(
            [
                [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
                [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
                [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
            ]
        )
        parent = clip.parents[joint]
        if parent < 0:
            world.append((clip.positions[frame, joint], turn))
        else:
            at, orientation = world[parent]
            world.append((at + orientation @ clip.offsets[joint], orientation @ turn))
    for joint, (at, _) in islice(enumerate(world), 1, None):
        np.testing.assert_allclose(at, clip.positions[frame, joint], atol=1e-9)


def test_arrays_are_made_once_and_cannot_be_written(clips: list[morec.Clip]) -> None:
    clip = clips[0]
    assert clip.positions is clip.positions
    with pytest.raises(ValueError):
        clip.positions[0, 0, 0] = 1.0


def test_a_file_is_read_from_paths_bytes_and_open_files(folder: Path) -> None:
    path = next(iter(sorted(folder.iterdir())))
    one = morec.read(path)
    assert one.name == path.stem and one.format == "bvh" and Path(str(one.path)) == path
    others = [morec.read(str(path)), morec.read(path.read_bytes(), name=path.name)]
    with open(path, "rb") as file:
        others.append(morec.read(file))
    others.append(morec.read(io.BytesIO(path.read_bytes())))
    others.append(morec.read(memoryview(path.read_bytes())))
    for other in others:
        np.testing.assert_array_equal(other.positions, one.positions)
    assert [clip.name for clip in others] == [path.stem, path.stem, path.stem, "clip", "clip"]
    with open(path, encoding="utf-8") as text, pytest.raises(TypeError, match="'rb'"):
        morec.read(text)  # type: ignore[arg-type]


def test_a_folder_is_read_in_order_and_names_what_is_left_out(folder: Path, tmp_path: Path) -> None:
    names = [clip.name for clip in morec.read_folder(folder)]
    assert names == sorted(names) and len(names) == 3
    for path in folder.iterdir():
        (tmp_path / path.name).write_bytes(path.read_bytes())
    (tmp_path / "broken.bvh").write_text("HIERARCHY nothing")
    seen: list[tuple[str, int, int]] = []
    with pytest.warns(morec.MorecWarning, match="broken.bvh: line 1"):
        clips = morec.read_folder(tmp_path, progress=lambda *told: seen.append(told))
    assert [clip.name for clip in clips] == names
    assert seen[-1] == ("", 0, 0)


def test_what_cannot_be_read_is_a_plain_error(tmp_path: Path) -> None:
    with pytest.raises(FileNotFoundError, match="nowhere.bvh"):
        morec.read(tmp_path / "nowhere.bvh")
    with pytest.raises(FileNotFoundError):
        morec.read_folder(tmp_path / "nowhere")
    broken = tmp_path / "broken.bvh"
    broken.write_text("HIERARCHY\nROOT Hips\n{\n  OFFSET 0 zero 0\n")
    with pytest.raises(morec.MorecError, match=r"broken.bvh: line 4"):
        morec.read(broken)
    with pytest.raises(morec.MorecError):
        morec.read(b"\0\1\2\3 nothing at all")
    with pytest.raises(morec.MorecError):
        morec.read_folder(tmp_path)
    with pytest.raises(ValueError, match="file_rate"):
        morec.read(broken, file_rate=-1)
    with pytest.raises(ValueError, match="up: expected x, y, z"):
        morec.read(broken, up="w")
    with pytest.raises(ValueError, match="positions: expected"):
        morec.read(broken, positions="both")
    with pytest.raises(ValueError, match="roles: .*a role"):
        morec.read(broken, roles={"tail": "Tail"})


@pytest.mark.parametrize("bytes_", [b"", b"HIERARCHY", b"\xff" * 1000, b"PK\x03\x04" + b"\0" * 50, b"glTF" + b"\1" * 99])
def test_no_bytes_are_more_than_an_error(bytes_: bytes) -> None:
    for name in ("a.bvh", "a.glb", "a.c3d", "a.npz", "a.trc", "a.zip", "a.fbx"):
        with pytest.raises(morec.MorecError):
            morec.read(bytes_, name=name)


def test_roles_units_and_axes_can_be_said(folder: Path) -> None:
    path = next(iter(sorted(folder.iterdir())))
    clip = morec.read(path, roles={"left_hand": None}, unit=2.0)
    assert "left_hand" not in clip.roles and clip.facts["metres_per_unit"] == 2.0
    np.testing.assert_allclose(clip.positions, 2.0 * morec.read(path, unit=1.0).positions, atol=1e-12)


def test_slices_are_in_seconds(clips: list[morec.Clip]) -> None:
    clip = clips[0]
    part = clip[1.0:2.5]
    assert part.frames == round(1.5 * clip.rate_hz)
    np.testing.assert_array_equal(part.positions, clip.positions[60:150])
    np.testing.assert_array_equal(clip[-1.0:].positions, clip.positions[-60:])
    assert len(clip[5.0:1.0]) == 0 and len(clip[:1e9]) == len(clip) and len(clip[: -1e9]) == 0
    assert len(clip[:]) == len(clip)
    with pytest.raises(TypeError, match="seconds"):
        clip[3]  # type: ignore[index]
    with pytest.raises(ValueError, match="step"):
        clip[0:1:2]
    with pytest.raises(ValueError, match="nan"):
        clip[float("nan") :]


def test_pickles_keep_every_bit(clips: list[morec.Clip]) -> None:
    points = morec.Clip.from_positions(
        np.where(np.arange(clips[0].frames)[:, None, None] % 500 > 400, np.nan, clips[0].positions),
        clips[0].names,
        clips[0].rate_hz,
        name="points",
    )
    for clip in (clips[0], clips[0][1.0:2.0], points, clips[0][1.0:1.0]):
        again = pickle.loads(pickle.dumps(clip))
        assert (again.name, again.rate_hz, again.names, again.roles) == (clip.name, clip.rate_hz, clip.names, clip.roles)
        assert (again.facts, again.warnings, again.rest_frames) == (clip.facts, clip.warnings, clip.rest_frames)
        np.testing.assert_array_equal(again.positions, clip.positions)
        if clip.rotations is None:
            assert again.rotations is None
        else:
            np.testing.assert_array_equal(again.rotations, clip.rotations)


def test_a_damaged_pickle_is_an_error(clips: list[morec.Clip]) -> None:
    restore, (state,) = clips[0].__reduce__()  # type: ignore[misc]
    for change in ({"frames": 3}, {"moved": [999]}, {"version": 99}, {"joints": [("a", 5, [0, 0, 0], None)]}):
        with pytest.raises(ValueError):
            restore({**state, **change})  # type: ignore[operator]
    with pytest.raises(KeyError):
        restore({"version": 1})  # type: ignore[operator]


def test_points_become_a_clip_and_gaps_stay_gaps(clips: list[morec.Clip]) -> None:
    source = clips[0]
    positions = source.positions.copy()
    hand = source.roles["left_hand"]
    positions[10:14, hand] = np.nan
    positions[100:400, hand] = np.nan
    clip = morec.Clip.from_positions(positions, source.names, source.rate_hz, name="p", unit=1.0, up="y")
    assert not clip.has_rotations and clip.rotations is None and clip.name == "p"
    at = clip.names.index(source.names[hand])
    assert np.isfinite(clip.positions[10:14, at]).all() and np.isnan(clip.positions[100:400, at]).all()
    seen = np.isfinite(positions).all(axis=2)
    np.testing.assert_allclose(clip.positions[:, : len(source.names)][seen], positions[seen], atol=1e-12)
    # The same from single precision, from another order in memory, and from lists.
    for same in (np.asfortranarray(positions), positions.tolist()):
        again = morec.Clip.from_positions(same, source.names, source.rate_hz, unit=1.0, up="y")
        np.testing.assert_array_equal(again.positions, clip.positions)


def test_arrays_of_another_shape_are_refused() -> None:
    with pytest.raises(ValueError, match=r"expected an array of shape \(frames, joints, 3\), found \(5, 3\)"):
        morec.Clip.from_positions(np.zeros((5, 3)), ["a"], 30)
    with pytest.raises(ValueError, match=r"there are 2 names, found \(5, 4, 3\)"):
        morec.Clip.from_positions(np.zeros((5, 4, 3)), ["a", "b"], 30)
    with pytest.raises(ValueError, match="rate_hz"):
        morec.Clip.from_positions(np.zeros((5, 1, 3)), ["a"], 0)
    with pytest.raises(morec.MorecError, match="at least one point with a position"):
        morec.Clip.from_positions(np.full((5, 1, 3), np.nan), ["a"], 30)
    with pytest.raises(ValueError):
        morec.Clip.from_positions("nothing", ["a"], 30)


@pytest.mark.parametrize("ending", ["bvh", "mclip", "trc", "c3d", "jsonl"])
def test_what_is_written_is_read_back(clips: list[morec.Clip], tmp_path: Path, ending: str) -> None:
    clip = clips[0][1.0:3.0]
    path = tmp_path / f"clip.{ending}"
    clip.save(path)
    again = morec.read(path)
    assert again.frames == clip.frames and again.has_rotations == (ending in ("bvh", "mclip"))
    assert set(again.roles) >= {"hips", "left_hand", "right_foot"}
    played = [clip.positions[:, clip.roles[role]] for role in ("left_hand", "head")]
    found = [again.positions[:, again.roles[role]] for role in ("left_hand", "head")]
    np.testing.assert_allclose(found, played, atol=0.006)


def test_a_file_of_another_ending_is_refused(clips: list[morec.Clip], tmp_path: Path) -> None:
    with pytest.raises(morec.MorecError, match="expected a file .bvh"):
        clips[0].save(tmp_path / "clip.doc")
    with pytest.raises(FileNotFoundError):
        clips[0].save(tmp_path / "nowhere" / "clip.bvh")


def test_notebooks_show_a_moving_drawing(clips: list[morec.Clip]) -> None:
    import xml.etree.ElementTree as ET

    html = clips[0]._repr_html_()  # type: ignore[operator]
    assert "<script" not in html
    svg = ET.fromstring(morec.animation(clips[0]))
    bones = [line for line in svg if line.tag.endswith("line")]
    assert len(bones) == len(clips[0].names) - 1
    values = bones[0][0].attrib["values"].split(";")
    assert len(values) == 60 and len(set(values)) > 1
    assert ET.fromstring(morec.animation(clips[0][1.0:1.0])) is not None


def test_resampled_clips_keep_time(clips: list[morec.Clip]) -> None:
    slow = clips[0].resampled(30.0)
    assert slow.rate_hz == 30.0 and abs(slow.duration_secs - clips[0].duration_secs) < 0.05
    np.testing.assert_allclose(slow.positions[30], clips[0].positions[60], atol=1e-12)
    with pytest.raises(ValueError, match="rates"):
        clips[0].resampled(0.0)

"""A moving drawing of a clip: SVG that notebooks show, without scripts."""

from __future__ import annotations

from html import escape

import numpy as np
import numpy.typing as npt

from ._morec import ROLES, Clip, key_positions

#: Poses of an animation; more make notebooks large.
POSES = 60
SIZE = 240
#: Bones drawn where a skeleton has no tree.
BONES = [
    ("hips", "left_thigh"), ("left_thigh", "left_shin"), ("left_shin", "left_foot"),
    ("hips", "right_thigh"), ("right_thigh", "right_shin"), ("right_shin", "right_foot"),
    ("hips", "neck"), ("neck", "head"),
    ("neck", "left_arm"), ("left_arm", "left_forearm"), ("left_forearm", "left_hand"),
    ("neck", "right_arm"), ("right_arm", "right_forearm"), ("right_forearm", "right_hand"),
]  # fmt: skip


def lines(clip: Clip) -> tuple[npt.NDArray[np.float64], list[tuple[int, int]]]:
    """Data for a drawing of the clip.

    Returns
    -------
    positions : ndarray, shape (frames, points, 3)
    bones : list of pairs of points
    """
    if clip.has_rotations:
        parents = clip.parents
        return clip.positions, [(int(parents[j]), j) for j in range(len(parents)) if parents[j] >= 0]
    if len(clip.roles) >= 5:
        places = key_positions(clip)
        seen = set(clip.roles)
        bones = [(ROLES.index(a), ROLES.index(b)) for a, b in BONES if a in seen and b in seen]
        return places, bones
    return clip.positions, []


def animation(clip: Clip, *, size: int = SIZE, poses: int = POSES) -> str:
    """Draw the clip as an animated SVG, seen from the front, playing in a loop at the clip's pace.

    Parameters
    ----------
    clip : Clip
    size : int
        Width and height, pixels.
    poses : int
        Number of poses, spread evenly; points move on straight lines between them.

    Returns
    -------
    str
        An ``<svg>`` element.
    """
    positions, bones = lines(clip)
    if not len(positions):
        return f'<svg xmlns="http://www.w3.org/2000/svg" width="{size}" height="{size}"></svg>'
    chosen = np.unique(np.linspace(0, len(positions) - 1, min(poses, len(positions))).round().astype(int))
    seen = _pixels(positions[chosen], size)
    secs = max(clip.duration_secs, 0.1)
    if bones:
        body = "".join(_line(seen[:, a], seen[:, b], secs) for a, b in bones)
    else:
        body = "".join(_dot(seen[:, point], secs) for point in range(seen.shape[1]))
    title = escape(f"{clip.name}: {clip.duration_secs:.2f} s")
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" width="{size}" height="{size}" viewBox="0 0 {size} {size}" '
        f'role="img"><title>{title}</title>{body}</svg>'
    )


def html(clip: Clip) -> str:
    """HTML that a notebook shows for a clip."""
    facts = f"{clip.frames} frames at {clip.rate_hz:g} Hz, {len(clip.names)} joints"
    warnings = "".join(f"<li>{escape(text)}</li>" for text in clip.warnings[:5])
    notes = f"<ul>{warnings}</ul>" if warnings else ""
    return f"<div>{animation(clip)}<p><b>{escape(clip.name)}</b>, {clip.duration_secs:.2f} s: {facts}</p>{notes}</div>"


def _pixels(positions: npt.NDArray[np.float64], size: int) -> npt.NDArray[np.float64]:
    """From the front: x to the right, y up, the whole path inside with a margin."""
    flat = positions[..., :2] * np.array([1.0, -1.0])
    low, high = np.nanmin(flat, axis=(0, 1)), np.nanmax(flat, axis=(0, 1))
    scale = 0.9 * size / max(float((high - low).max()), 1e-9)
    return np.asarray((flat - (low + high) / 2) * scale + size / 2, dtype=np.float64)


def _values(numbers: npt.NDArray[np.float64]) -> str:
    known = np.where(np.isfinite(numbers), numbers, 0.0)
    return ";".join(f"{value:.1f}" for value in known)


def _animate(name: str, numbers: npt.NDArray[np.float64], secs: float) -> str:
    return f'<animate attributeName="{name}" dur="{secs:.3f}s" repeatCount="indefinite" values="{_values(numbers)}"/>'


def _line(a: npt.NDArray[np.float64], b: npt.NDArray[np.float64], secs: float) -> str:
    moves = "".join(
        _animate(name, numbers, secs)
        for name, numbers in (("x1", a[:, 0]), ("y1", a[:, 1]), ("x2", b[:, 0]), ("y2", b[:, 1]))
    )
    return f'<line stroke="currentColor" stroke-width="2" stroke-linecap="round">{moves}</line>'


def _dot(at: npt.NDArray[np.float64], secs: float) -> str:
    moves = _animate("cx", at[:, 0], secs) + _animate("cy", at[:, 1], secs)
    return f'<circle r="2" fill="currentColor">{moves}</circle>'

"""Clips as datasets of the library movement, and back. Needs xarray.

>>> import morec, morec.movement
>>> dataset = morec.movement.to_xarray(clips)
>>> clips = morec.movement.from_xarray(movement.io.load_poses.from_file("mouse.h5", "DeepLabCut", fps=30), roles="mouse.roles")
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from ._files import Roles, roles_text
from ._morec import Clip
from ._points import Points, in_space

if TYPE_CHECKING:
    import xarray

__all__ = ["from_xarray", "to_xarray"]


def to_xarray(clips: Clip | Iterable[Clip], *, individuals: Sequence[str] | None = None) -> xarray.Dataset:
    """Clips of one recording as a poses dataset: where their joints are, metres, Y up.

    Parameters
    ----------
    clips : Clip or iterable of Clip
        One for each individual, with the same joints and frame rate. Frames after a clip's end are unknown.
    individuals : sequence of str, optional
        Names of the individuals; the clips' by default.

    Returns
    -------
    xarray.Dataset
        ``position`` (time, space, keypoints, individuals) and ``confidence`` (time, keypoints, individuals), which is 1 where the
        position is known and 0 elsewhere.

    Raises
    ------
    ValueError
        No clip; clips of different joints or rates; two individuals of one name.
    """
    import xarray

    clips = [clips] if isinstance(clips, Clip) else list(clips)
    if not clips:
        raise ValueError("clips: expected at least one, found none")
    first = clips[0]
    for clip in clips:
        if (clip.names, clip.rate_hz) != (first.names, first.rate_hz):
            raise ValueError(f"{clip.name}: expected the joints and the frame rate of {first.name}")
    names = [clip.name for clip in clips] if individuals is None else list(individuals)
    if len(names) != len(clips) or len(set(names)) != len(names):
        raise ValueError(f"individuals: expected {len(clips)} different names, found {names}")
    frames = max(len(clip.positions) for clip in clips)
    position = np.full((frames, 3, len(first.names), len(clips)), np.nan)
    for number, clip in enumerate(clips):
        position[: len(clip.positions), ..., number] = np.swapaxes(clip.positions, 1, 2)
    known = ~np.isnan(position).any(axis=1)
    return xarray.Dataset(
        {
            "position": (("time", "space", "keypoints", "individuals"), position),
            "confidence": (("time", "keypoints", "individuals"), known.astype(np.float64)),
        },
        coords={
            "time": np.arange(frames) / first.rate_hz,
            "space": ["x", "y", "z"],
            "keypoints": list(first.names),
            "individuals": names,
        },
        attrs={
            "fps": float(first.rate_hz),
            "time_unit": "seconds",
            "source_software": "morec",
            "ds_type": "poses",
        },
    )


def from_xarray(
    dataset: xarray.Dataset,
    *,
    least_confidence: float = 0.0,
    unit: float | None = None,
    up: str | None = None,
    roles: Roles = None,
) -> list[Clip]:
    """The individuals of a poses dataset as clips, called as they are.

    Parameters
    ----------
    dataset : xarray.Dataset
    least_confidence : float
        Points of a lower confidence are unknown.
    unit : float, optional
        Metres of a unit of length; inferred by default. Datasets of `to_xarray` are in metres.
    up : {"x", "y", "z", "-x", "-y", "-z"}, optional
        Which way is up; inferred by default.
    roles : dict, path or str, optional
        Points that play parts of the body, where names do not tell. Points in two dimensions need them, of a custom skeleton.

    Raises
    ------
    ValueError
        No poses; no frame rate; points in two dimensions without `roles`.
    """
    if "position" not in dataset or "keypoints" not in dataset.dims:
        raise ValueError("expected a dataset of poses with position and keypoints, found " + ", ".join(map(str, dataset.data_vars)))
    own = dataset.attrs.get("source_software") == "morec"
    rate, text = _rate(dataset), roles_text(roles)
    position = dataset["position"].transpose("individuals", "time", "keypoints", "space")
    points = np.array(position.values, dtype=np.float64)
    if "confidence" in dataset:
        confidence = dataset["confidence"].transpose("individuals", "time", "keypoints").values
        points[confidence < least_confidence] = np.nan
    names = [str(name) for name in dataset["keypoints"].values]
    return [
        Clip.from_positions(
            _until_last(in_space(of, str(name), roles)),
            names,
            rate,
            name=str(name),
            unit=1.0 if own and unit is None else unit,
            up="y" if own and up is None else up,
            roles=text,
        )
        for name, of in zip(dataset["individuals"].values, points)
    ]


def _until_last(points: Points) -> Points:
    """Without the frames after the last in which a point is known."""
    known = np.flatnonzero(~np.isnan(points).all(axis=(1, 2)))
    return points[: known[-1] + 1] if len(known) else points


def _rate(dataset: xarray.Dataset) -> float:
    fps: Any = dataset.attrs.get("fps")
    if fps:
        return float(fps)
    times = dataset["time"].values
    if dataset.attrs.get("time_unit") == "seconds" and len(times) > 1:
        return float((len(times) - 1) / (times[-1] - times[0]))
    raise ValueError("dataset: expected a frame rate (the attribute fps), found none")

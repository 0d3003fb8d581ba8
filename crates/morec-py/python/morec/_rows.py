"""Feature rows, arrays and windows for your own models."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from . import _morec
from ._files import Clips, as_clips
from ._labels import Labels, spans_in
from ._morec import ROLES, Clip

if TYPE_CHECKING:
    import pandas
    import xarray


@dataclass(frozen=True)
class Features:
    """Feature rows of a clip, which training and recognition compare.

    A row describes a tick (1/30 s): for each bone its direction in the performer's heading frame, weighted, and its
    velocity with saturated length, then the root's velocity and turning. Rows do not depend on body size, facing direction or
    skeleton.

    Attributes
    ----------
    values : ndarray of float32, shape (ticks, 6 bones + 4)
        One row for each tick; row ``i`` ends at ``(i + 1) / rate_hz`` seconds.
    columns : list of str
        ``<bone>.direction.<axis>`` (unit vectors times the bone's weight), ``<bone>.velocity.<axis>`` (per second, saturated,
        weighted), ``root.velocity.<axis>`` (leg lengths a second, weighted) and ``root.velocity.turning`` (radians a second,
        weighted); axes are lateral (to the left), up and forward.
    bones : list of str
        The bones, in the order of columns.
    rate_hz : float
        Rows a second.
    clip : str
        The clip's name.
    """

    values: npt.NDArray[np.float32]
    columns: list[str]
    bones: list[str]
    rate_hz: float
    clip: str

    @property
    def times_secs(self) -> npt.NDArray[np.float64]:
        """End time of each row, seconds from the clip's start; shape (ticks,)."""
        return np.asarray((np.arange(len(self.values)) + 1.0) / self.rate_hz, dtype=np.float64)

    def __len__(self) -> int:
        return len(self.values)

    def __array__(self, dtype: npt.DTypeLike | None = None, copy: bool | None = None) -> npt.NDArray[Any]:
        if copy is False and dtype is not None and np.dtype(dtype) != self.values.dtype:
            raise ValueError("another dtype needs a copy")
        return np.array(self.values, dtype=dtype, copy=True) if copy else np.asarray(self.values, dtype=dtype)

    def to_pandas(self) -> pandas.DataFrame:
        """The rows as a DataFrame indexed by time (needs pandas)."""
        import pandas

        index = pandas.Index(self.times_secs, name="time_secs")
        return pandas.DataFrame(self.values, columns=self.columns, index=index)

    def to_xarray(self) -> xarray.DataArray:
        """The rows as a DataArray with dimensions time_secs and feature (needs xarray)."""
        import xarray

        return xarray.DataArray(
            self.values,
            dims=("time_secs", "feature"),
            coords={"time_secs": self.times_secs, "feature": self.columns},
            name=self.clip,
            attrs={"rate_hz": self.rate_hz},
        )


def features(clip: Clip, *, bones: Sequence[str] | None = None) -> Features:
    """Feature rows of a clip.

    Parameters
    ----------
    clip : Clip
    bones : sequence of str, optional
        The bones to use, so that several clips get the same columns; by default all bones of the clip.

    Returns
    -------
    Features
    """
    values, columns, names, rate_hz = _morec.features(clip, None if bones is None else list(bones))
    return Features(values, columns, names, rate_hz, clip.name)


def normalize(
    clip: Clip,
    *,
    rate_hz: float | None = None,
    centre: bool = False,
    dtype: npt.DTypeLike = np.float32,
) -> npt.NDArray[Any]:
    """Positions of the body parts as an array of fixed shape, for example for a neural network.

    Metres, Y up; body parts in the order of `morec.ROLES`, whatever the clip's skeleton.

    Parameters
    ----------
    clip : Clip
    rate_hz : float, optional
        Resample to this rate.
    centre : bool
        Move the clip so that the hips begin at x = z = 0, and turn it so that the body first faces +Z.
    dtype : dtype

    Returns
    -------
    ndarray, shape (frames, 18, 3)
        NaN where a part is unknown.
    """
    if rate_hz is not None:
        clip = clip.resampled(rate_hz)
    places = _morec.key_positions(clip)
    if centre and len(places):
        places = _centred(places)
    return places.astype(dtype, copy=False)


def _centred(places: npt.NDArray[np.float64]) -> npt.NDArray[np.float64]:
    hips, left, right = (ROLES.index(role) for role in ("hips", "left_thigh", "right_thigh"))
    across = places[:, left] - places[:, right]
    seen = np.flatnonzero(np.isfinite(across).all(axis=1))
    if len(seen):
        x, _, z = across[seen[0]]
        yaw = np.arctan2(-z, x)
        cos, sin = np.cos(yaw), np.sin(yaw)
        turn = np.array([[cos, 0.0, -sin], [0.0, 1.0, 0.0], [sin, 0.0, cos]])
        places = places @ turn.T
    root = places[:, hips]
    first = np.flatnonzero(np.isfinite(root).all(axis=1))
    if len(first):
        places = places - np.array([root[first[0], 0], 0.0, root[first[0], 2]])
    return places


@dataclass(frozen=True)
class Windows:
    """Stretches of clips, all of one length, with their labels.

    Attributes
    ----------
    values : ndarray of float32
        Shape (windows, ticks, columns) of features, (windows, frames, 18, 3) of positions.
    labels : ndarray of str, shape (windows,)
        The class that covers at least half of the window; empty for none.
    clips : list of str
        The clip of each window.
    start_secs : ndarray of float64, shape (windows,)
    """

    values: npt.NDArray[np.float32]
    labels: npt.NDArray[np.str_]
    clips: list[str]
    start_secs: npt.NDArray[np.float64]

    def __len__(self) -> int:
        return len(self.values)

    def __iter__(self) -> Iterator[npt.NDArray[Any]]:
        """``values, labels = windows(…)``."""
        return iter((self.values, self.labels))


def windows(
    clips: Clips,
    labels: Labels = None,
    *,
    seconds: float = 1.0,
    step: float = 0.5,
    kind: str = "features",
    rate_hz: float = 30.0,
) -> Windows:
    """Cut clips into windows of one length, with labels.

    Parameters
    ----------
    clips : clips or paths
    labels : as in `train`, optional
    seconds, step : float
        Length of a window, and from the start of one to the start of the next.
    kind : {"features", "positions"}
        Rows of `features` over the bones that all clips show, or arrays of `normalize`.
    rate_hz : float
        Frames a second of positions; features have their own rate, 30.
    """
    if kind not in ("features", "positions"):
        raise ValueError(f'kind: expected "features" or "positions", found {kind!r}')
    if seconds <= 0 or step <= 0:
        raise ValueError("seconds and step: expected more than 0")
    of_clips = as_clips(clips)
    common = _common_bones(of_clips) if kind == "features" else []
    values, names, shown, starts = [], [], [], []
    for clip in of_clips:
        if kind == "features":
            made = features(clip, bones=common)
            rows, rate = made.values, made.rate_hz
        else:
            rows, rate = normalize(clip, rate_hz=rate_hz), rate_hz
        spans = spans_in(labels, clip) if labels is not None else []
        length = max(round(seconds * rate), 1)
        for number in range(int(max(len(rows) - length, -1) / (step * rate)) + 1 if len(rows) >= length else 0):
            start = round(number * step * rate)
            if start + length > len(rows):
                break
            values.append(rows[start : start + length])
            names.append(clip.name)
            shown.append(_class_of(spans, start / rate, (start + length) / rate))
            starts.append(start / rate)
    shape = (0,) if not values else ()
    stacked = np.stack(values) if values else np.zeros(shape, np.float32)
    return Windows(stacked, np.array(shown, dtype=np.str_), names, np.array(starts, np.float64))


def _common_bones(clips: Iterable[Clip]) -> list[str]:
    common: list[str] | None = None
    for clip in clips:
        bones = features(clip).bones
        common = bones if common is None else [bone for bone in common if bone in bones]
    if not common:
        raise ValueError("these clips have no bone of the body in common")
    return common


def _class_of(spans: list[tuple[str, float, float]], start: float, stop: float) -> str:
    best, most = "", (stop - start) / 2
    for name, first, last in spans:
        shared = min(stop, last) - max(start, first)
        if shared >= most:
            best, most = name, shared
    return best


def cut(
    clip: Clip,
    *,
    method: str = "kernel",
    window: float | None = None,
    penalty: float | None = None,
    least: float | None = None,
    rise: float | None = None,
    quality: float | None = None,
    direction: str = "both",
) -> dict[str, npt.NDArray[np.float64]]:
    """Find where a clip's behaviour changes, without labels, as ``morec cut`` does.

    Parameters
    ----------
    clip : Clip
    method : {"kernel", "ppca", "repeats"}
        kernel: change points of feature rows; ppca: the thesis's method on joint rotations, which models the poses so far and
        cuts where the next poses do not fit; repeats: starts and stops of the repetitions that `discover` finds in the clip.
    window, penalty, least : float, optional
        kernel: length of the compared windows, seconds; penalty for each cut; shortest segment, seconds.
    rise, quality : float, optional
        ppca: rise of the misfit before a cut, in multiples of the misfit of fitting poses; share of the variance that a segment's
        model keeps.
    direction : {"forward", "backward", "both"}
        ppca: direction of the passes through the clip.

    Returns
    -------
    dict
        ``cuts_secs``, shape (cuts,); of ppca also ``forward`` and ``backward``, shape (points, 2): seconds and misfit.
    """
    return _morec.cut(
        clip,
        method=method,
        window=window,
        penalty=penalty,
        least=least,
        rise=rise,
        quality=quality,
        direction=direction,
    )

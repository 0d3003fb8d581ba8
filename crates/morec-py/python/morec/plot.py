"""Plots on matplotlib axes (needs matplotlib).

Every function draws on ``ax``, or on new axes, and returns them.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from ._drawing import lines
from ._morec import Clip, Crossval
from ._rows import cut

if TYPE_CHECKING:
    from matplotlib.axes import Axes

__all__ = ["confusion", "misfit", "skeleton", "timeline"]

Rows = Iterable[Mapping[str, Any]]


def _axes(ax: Axes | None, **options: Any) -> Axes:
    if ax is not None:
        return ax
    import matplotlib.pyplot as plt

    made: Axes = plt.subplots(**options)[1]
    return made


def timeline(found: Rows, truth: Rows = (), *, clip: str | None = None, ax: Axes | None = None) -> Axes:
    """Detections over time, below the labels.

    Parameters
    ----------
    found, truth : tables
        Rows with class, start_secs, stop_secs, and clip.
    clip : str, optional
        Only rows of this clip; all otherwise.
    """
    ax = _axes(ax, figsize=(10, 2), layout="constrained")
    kept = [[row for row in rows if clip is None or row.get("clip") == clip] for rows in (truth, found)]
    classes = sorted({row["class"] for rows in kept for row in rows})
    colours = {name: f"C{number % 10}" for number, name in enumerate(classes)}
    for height, rows in zip((1.0, 0.0), kept):
        for row in rows:
            start, stop = row["start_secs"], row["stop_secs"]
            ax.broken_barh([(start, stop - start)], (height + 0.1, 0.8), facecolors=colours[row["class"]])
    for name in classes:
        ax.plot([], [], color=colours[name], linewidth=6, label=name)
    if kept[0]:
        ax.set_yticks([0.5, 1.5], ["found", "labelled"])
    else:
        ax.set_yticks([0.5], ["found"])
    ax.set_xlabel("seconds")
    if classes:
        ax.legend(loc="upper left", bbox_to_anchor=(1.0, 1.0), fontsize="small")
    if clip is not None:
        ax.set_title(clip)
    return ax


def skeleton(clip: Clip, secs: float = 0.0, *, view: str = "front", ax: Axes | None = None) -> Axes:
    """The pose at one instant.

    Parameters
    ----------
    secs : float
        Time from the clip's start, seconds.
    view : {"front", "side", "top"}
    """
    axes = {"front": (0, 1), "side": (2, 1), "top": (0, 2)}
    if view not in axes:
        raise ValueError(f'view: expected "front", "side" or "top", found {view!r}')
    ax = _axes(ax, figsize=(4, 4), layout="constrained")
    positions, bones = lines(clip)
    if not len(positions):
        raise ValueError(f"{clip.name}: the clip has no frames")
    frame = min(max(round(secs * clip.rate_hz), 0), len(positions) - 1)
    across, along = axes[view]
    pose = positions[frame]
    for a, b in bones:
        ax.plot(pose[[a, b], across], pose[[a, b], along], color="C0", linewidth=2)
    if not bones:
        ax.plot(pose[:, across], pose[:, along], "o", color="C0", markersize=3)
    ax.set_aspect("equal")
    ax.set_xlabel("xyz"[across] + " (metres)")
    ax.set_ylabel("xyz"[along] + " (metres)")
    ax.set_title(f"{clip.name}, {frame / clip.rate_hz:.2f} s")
    return ax


def confusion(evaluation: Crossval | Mapping[str, Any], *, ax: Axes | None = None) -> Axes:
    """Confusion matrix.

    Parameters
    ----------
    evaluation : Crossval, or what `morec.evaluate` gives
    """
    figures = evaluation.evaluation if isinstance(evaluation, Crossval) else evaluation
    table = figures["confusion"]
    counts = np.asarray(table["counts"], dtype=float)
    rows = [*table["rows"], "nothing"]
    columns = [*table["columns"], "nothing"]
    ax = _axes(ax, figsize=(0.5 * len(columns) + 2, 0.5 * len(rows) + 1.5), layout="constrained")
    ax.imshow(counts, cmap="Blues")
    for row in range(counts.shape[0]):
        for column in range(counts.shape[1]):
            if counts[row, column]:
                dark = counts[row, column] > counts.max() / 2
                ax.text(
                    column, row, f"{counts[row, column]:.0f}", ha="center", va="center", color="w" if dark else "k"
                )
    ax.set_xticks(range(len(columns)), columns, rotation=60, ha="right")
    ax.set_yticks(range(len(rows)), rows)
    ax.set_xlabel("found")
    ax.set_ylabel("labelled")
    return ax


def misfit(clip: Clip, *, ax: Axes | None = None, **options: Any) -> Axes:
    """Misfit of the next poses to the poses so far, with the cuts of `morec.cut` by the method ppca.

    Parameters
    ----------
    options
        Those of `morec.cut` with this method.
    """
    ax = _axes(ax, figsize=(10, 2.5), layout="constrained")
    found = cut(clip, method="ppca", **options)
    for name in ("forward", "backward"):
        curve = found[name]
        if len(curve):
            ax.plot(curve[:, 0], curve[:, 1], label=name)
    for secs in found["cuts_secs"]:
        ax.axvline(secs, color="k", linewidth=0.8, linestyle="--")
    ax.set_yscale("log")
    ax.set_xlabel("seconds")
    ax.set_ylabel("misfit")
    ax.set_title(clip.name)
    ax.legend(fontsize="small")
    return ax

"""Groups of like samples."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from .. import _morec
from .._tables import Table

COLUMNS = ["clip", "class", "start_secs", "stop_secs", "group"]
TICK_HZ = 30.0
ROUNDS = 100


def group(samples: list[dict[str, Any]], groups: int, seed: int) -> Table:
    """Samples in groups by k-means over mean and spread of their rows; the same samples and seed give the same groups."""
    samples = sorted(samples, key=lambda row: (row["clip"], row["start_secs"], row["class"]))
    by_bones: dict[int, list[int]] = {}
    looks: dict[int, npt.NDArray[np.float64]] = {}
    for at, row in enumerate(samples):
        values = _morec.rows_kept(row["bones"], row["rows"])
        start, stop = (round(row[name] * TICK_HZ) for name in ("start_secs", "stop_secs"))
        part = values[start : max(stop, start + 1)].astype(np.float64)
        if len(part):
            looks[at] = np.concatenate([part.mean(axis=0), part.std(axis=0)])
            by_bones.setdefault(row["bones"], []).append(at)
    made: list[tuple[int, tuple[int, int]]] = []
    for bones, members in by_bones.items():
        found = _means(np.stack([looks[at] for at in members]), groups, seed)
        made += [(at, (bones, int(number))) for at, number in zip(members, found)]
    sizes: dict[tuple[int, int], int] = {}
    for _, key in made:
        sizes[key] = sizes.get(key, 0) + 1
    order = {key: number for number, key in enumerate(sorted(sizes, key=lambda key: (-sizes[key], key)))}
    rows = []
    for at, key in sorted(made):
        rows.append({**{name: samples[at][name] for name in COLUMNS[:-1]}, "group": order[key]})
    return Table(rows, COLUMNS)


def _means(looks: npt.NDArray[np.float64], groups: int, seed: int) -> npt.NDArray[np.int64]:
    """k-means with the seeding of k-means++ (Arthur and Vassilvitskii 2007)."""
    random = np.random.default_rng(seed)
    centres = [looks[random.integers(len(looks))]]
    for _ in range(1, min(groups, len(looks))):
        far = np.min([((looks - centre) ** 2).sum(axis=1) for centre in centres], axis=0)
        if not far.sum():
            break
        centres.append(looks[random.choice(len(looks), p=far / far.sum())])
    middle = np.stack(centres)
    found = np.zeros(len(looks), np.int64)
    for _ in range(ROUNDS):
        distances = ((looks[:, None, :] - middle[None]) ** 2).sum(axis=2)
        new = distances.argmin(axis=1)
        if (new == found).all():
            break
        found = new
        for number in range(len(middle)):
            if (found == number).any():
                middle[number] = looks[found == number].mean(axis=0)
    return found

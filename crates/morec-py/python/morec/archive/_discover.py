"""Sets of the same motion in an archive: discovered in a sample of the clips, recognised in all of them."""

from __future__ import annotations

import warnings
from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from daft import DataFrame, col

from .. import _morec
from .._discover import discover
from .._learn import train
from .._morec import Clip, Index, MorecError, MorecWarning
from .._tables import Table

if TYPE_CHECKING:
    from ._archive import Archive

COLUMNS = ["set", "clip", "name", "start_secs", "stop_secs", "distance"]
#: Class of a set in the index, before its number.
CLASS = "set_"
#: Repetitions of a set that teach it, at most: those nearest to its middle.
TEACHING = 4
#: Clips that the next round is chosen from last this many times as long as those that it compares.
LOOKED_AT = 8
#: A discovered set is an earlier one if events of the earlier set cover more than this share of its repetitions.
KNOWN = 0.5


@dataclass(frozen=True)
class ArchiveSets:
    """Sets of the same motion, and what recognises them.

    Attributes
    ----------
    sets : Table
        The repetitions in the clips that were compared: set (from 1), clip, name, start_secs, stop_secs, distance.
    index : Index
        Its classes are ``set_1``, ``set_2``, … and were trained on the repetitions nearest to the middles of the sets.
    events : DataFrame
        What the index recognises in every clip, as from `Archive.recognize`.
    """

    sets: Table
    index: Index
    events: DataFrame


def discover_sets(archive: Archive, minutes: float, rounds: int, seed: int) -> ArchiveSets:
    if not minutes > 0 or rounds < 1:
        raise ValueError(f"expected more than 0 minutes and at least 1 round, found {minutes} and {rounds}")
    lengths = {row["clip"]: row for row in archive._clips("name", "secs").to_pylist()}
    # The order of the keys does not depend on the order in which clips were added.
    keys = sorted(lengths)
    order = [keys[at] for at in np.random.default_rng(seed).permutation(len(keys))]
    compared: dict[str, Clip] = {}
    repetitions: list[dict[str, Any]] = []
    index: Index | None = None
    for _ in range(rounds):
        explained: dict[str, list[_Event]] = {}
        left = [key for key in order if key not in compared]
        if index is not None and left:
            left = list(_up_to(left, lengths, LOOKED_AT * minutes * 60))
            explained = _by_clip(archive._recognized(index, left))
            # First those of which most is not explained; the sort keeps the order by chance among equals.
            left.sort(key=lambda key: sum(event.secs for event in explained.get(key, [])) - lengths[key]["secs"])
        new = dict(_read(archive, list(_up_to(left, lengths, minutes * 60))))
        last = max((row["set"] for row in repetitions), default=0)
        found = _numbered(discover(list(new.values())), explained, last) if new else []
        if not found:
            break
        compared |= new
        repetitions += found
        labels = _teaching(repetitions)
        teaching = [compared[clip] for clip in dict.fromkeys(row["clip"] for row in labels)]
        with warnings.catch_warnings():
            # Notes about labels that nobody has written.
            warnings.simplefilter("ignore", MorecWarning)
            # What is not labelled may well be another repetition.
            index = train(teaching, labels, unlabelled="ignore")
    if index is None:
        raise MorecError(f"{archive.store.uri}: no motion repeats in {minutes:g} minutes of its clips")
    rows = [{**row, "name": lengths[row["clip"]]["name"]} for row in repetitions]
    sets = Table([{name: row[name] for name in COLUMNS} for row in rows], COLUMNS)
    return ArchiveSets(sets, index, archive.recognize(index).collect())


@dataclass(frozen=True)
class _Event:
    number: int
    start: float
    stop: float

    @property
    def secs(self) -> float:
        return self.stop - self.start


def _teaching(repetitions: list[dict[str, Any]]) -> list[dict[str, Any]]:
    """Labels of the repetitions that teach."""
    sets: dict[int, list[dict[str, Any]]] = {}
    for row in repetitions:
        sets.setdefault(row["set"], []).append(row)
    nearest = (row for rows in sets.values() for row in sorted(rows, key=lambda row: row["distance"])[:TEACHING])
    return [
        {"clip": row["clip"], "class": f"{CLASS}{row['set']}", "start_secs": row["start_secs"], "stop_secs": row["stop_secs"]}
        for row in nearest
    ]


def _by_clip(events: DataFrame) -> dict[str, list[_Event]]:
    found: dict[str, list[_Event]] = {}
    for row in events.to_pylist():
        number = int(row["class"].removeprefix(CLASS))
        found.setdefault(row["clip"], []).append(_Event(number, row["start_secs"], row["stop_secs"]))
    return found


def _up_to(keys: list[str], lengths: dict[str, dict[str, Any]], secs: float) -> Iterator[str]:
    """Keys in order, until the clips last so long together."""
    for key in keys:
        if secs <= 0:
            return
        secs -= lengths[key]["secs"]
        yield key


def _read(archive: Archive, keys: list[str]) -> Iterator[tuple[str, Clip]]:
    """Clips by their keys, which become their names: names in an archive may repeat."""
    if not keys:
        return
    frame = archive._clips("motion", "roles", "rest_frames", "facts").where(col("clip").is_in(keys))
    rows = {row["clip"]: row for row in frame.to_pylist()}
    for key in keys:
        row = rows[key]
        yield key, _morec.kept_clip(key, row["motion"], row["roles"], row["rest_frames"], row["facts"])


def _numbered(found: Table, explained: dict[str, list[_Event]], last: int) -> list[dict[str, Any]]:
    """Repetitions with the numbers of their sets in the archive: a known set's, if its events cover most of them, or one after ``last``."""

    def known(row: dict[str, Any]) -> int:
        half = 0.5 * (row["stop_secs"] - row["start_secs"])
        of_clip = explained.get(row["clip"], [])
        shared = (event.number for event in of_clip if min(row["stop_secs"], event.stop) - max(row["start_secs"], event.start) > half)
        return next(shared, 0)

    sets: dict[int, list[dict[str, Any]]] = {}
    for row in found:
        sets.setdefault(row["set"], []).append(dict(row))
    made = []
    for _, rows in sorted(sets.items()):
        [(number, times)] = Counter(map(known, rows)).most_common(1)
        if not number or times <= KNOWN * len(rows):
            last += 1
            number = last
        made += [{**row, "set": number} for row in rows]
    return made

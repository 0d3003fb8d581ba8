"""Search: clips are read in the order of what their sketches promise, until no other can be among the hits."""

from __future__ import annotations

import math
import os
import zlib
from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from typing import Any

import daft
import numpy as np
import pyarrow.parquet as pq
from daft import DataFrame, DataType, col

from .. import _morec
from ._layout import clip_number, clip_of
from ._sketches import SketchTable
from ._store import Store, patiently
from ._tasks import Example, Nearest

#: Archives of more than GLANCED_AT clips are searched in every 64th clip first, then in every 8th, then in all.
GLANCED_AT, SOME = 1 << 14, (64, 8)
#: Batches of clips that are read in each of these first searches.
ROUNDS = 3

#: A clip's number, bones and packed rows.
KeptRows = tuple[int, int, bytes]
#: A clip's key and name.
Names = tuple[str, str]


@dataclass(frozen=True)
class Wanted:
    """Options of a search, as the native part takes them."""

    limit: int
    mirror: bool
    one_a_clip: bool

    def native(self) -> tuple[int, bool, bool]:
        return self.limit, self.mirror, self.one_a_clip


@dataclass
class Found:
    """Hits, and how much was looked at for them."""

    hits: list[tuple[str, str, float, float, float, float, bool]]
    #: Clips of which there are sketches, of these such as were bound closely, and such as were read.
    sketched: int
    bound: int
    read: int


def search(
    store: Store, sketches: Sketched, unsketched: DataFrame | None, example: Example, wanted: Wanted
) -> Found:
    """The hits among the clips of which there are sketches and those of a frame (clip, name, bones, rows) that have none."""
    ask = Asked(store, sketches, example.native(), wanted)
    found = Found([], len(sketches), 0, 0)
    rows: dict[int, KeptRows] = {}
    names: dict[int, Names] = {}
    plan = ask.plan_of_all(found, rows)
    if unsketched is not None:
        for row, name in _nearest_of(unsketched, example, wanted):
            rows[row[0]], names[row[0]] = row, name
        plan.found(_morec.SearchPart(list(rows.values())).nearest_windows(ask.example, *wanted.native()))
    while len(ask.read_next(plan, None, found, rows)[0]):
        pass
    few = [rows[number] for number in sorted(plan.chosen())]
    hits = _morec.SearchPart(few).search(ask.example, *wanted.native())
    names |= sketches.names([hit[0] for hit in hits if hit[0] not in names])
    found.hits = [(*names[hit[0]], *hit[1:]) for hit in hits]
    return found


class Sketched:
    """Tables of sketches, one after the other; clips are known by their places in all of them together."""

    def __init__(self, tables: Sequence[SketchTable]) -> None:
        self.tables = list(tables)
        self.clips = _morec.SketchedClips([table.native() for table in tables])
        self.firsts = np.cumsum([0, *(len(table.clip) for table in tables)])
        self.numbers = np.concatenate([np.zeros(0, np.int64), *(table.clip for table in tables)])

    def __len__(self) -> int:
        return len(self.clips)

    def names(self, numbers: Sequence[int]) -> dict[int, Names]:
        """Keys and names of clips by their numbers."""
        places: list[int] = np.flatnonzero(np.isin(self.numbers, numbers)).tolist()
        return {int(self.numbers[place]): self._name(place) for place in places}

    def _name(self, place: int) -> Names:
        at = int(np.searchsorted(self.firsts, place, side="right")) - 1
        return clip_of(int(self.numbers[place])), self.tables[at].name[place - int(self.firsts[at])].as_py()

    def rows(self, store: Store, places: Any) -> list[KeptRows]:
        """Rows of the clips at these places, in their order."""
        at_table = np.searchsorted(self.firsts, places, side="right") - 1
        of_parts: dict[str, list[Place]] = {}
        for order, (at, place) in enumerate(zip(at_table.tolist(), places.tolist())):
            table, row = self.tables[at], place - int(self.firsts[at])
            of_parts.setdefault(table.parts[table.part[row]][0], []).append(Place(order, table, row))
        read: list[KeptRows | None] = [None] * len(places)

        def of_part(name: str) -> None:
            for place, packed in zip(of_parts[name], _packed(store, name, of_parts[name])):
                table, row = place.table, place.row
                if zlib.crc32(packed) != table.rows_crc[row]:
                    raise ValueError(f"{store.url(name)}: not what its sketches were made of; create the archive again")
                read[place.order] = (int(table.clip[row]), int(table.bones[row]), packed)

        with ThreadPoolExecutor(min(8, 2 * (os.cpu_count() or 1))) as pool:
            list(pool.map(of_part, of_parts))
        return [row for row in read if row is not None]


@dataclass(frozen=True)
class Place:
    """A clip that is read: its place among those that are asked for, and where it is described."""

    order: int
    table: SketchTable
    row: int


def _packed(store: Store, part: str, places: list[Place]) -> list[bytes]:
    """Packed rows of clips of a part, which is read by positions where these are known, and else by row groups."""
    places.sort(key=lambda place: int(place.table.rows_at[place.row]))
    spans = [(int(place.table.rows_at[place.row]), int(place.table.rows_bytes[place.row])) for place in places]
    if spans[0][0] >= 0:
        return store.ranges(part, spans)
    file = patiently(lambda: pq.ParquetFile(store.open(part)))

    def rows_of(group: int) -> Any:
        return patiently(lambda: file.read_row_group(group, columns=["rows"])).column(0)

    groups = {group: rows_of(group) for group in {int(place.table.row_group[place.row]) for place in places}}
    return [groups[int(p.table.row_group[p.row])][int(p.table.row[p.row])].as_py() or b"" for p in places]


@dataclass(frozen=True)
class Asked:
    """An example, and where it is searched for."""

    store: Store
    sketches: Sketched
    example: _morec.SearchExample
    wanted: Wanted

    def bounds(self, closely: bool, reach: float, places: Any) -> Any:
        return self.sketches.clips.bounds(self.example, *self.wanted.native(), closely, reach, places)

    def plan(self, reach: float, places: Any) -> _morec.SearchPlan:
        """Once it is known how near windows must be, those that are near enough are few: they are compared closely at once."""
        closely = reach < math.inf
        return _morec.SearchPlan(self.bounds(closely, reach, places), *self.wanted.native(), closely)

    def plan_of_all(self, found: Found, rows: dict[int, KeptRows]) -> _morec.SearchPlan:
        """The plan for all clips; of many, some have been read.

        Among some of the clips the nearest windows are farther, but so near that of most others a glance is enough.
        """
        reach, read = math.inf, np.zeros(0, np.int64)
        windows: list[tuple[int, float]] = []
        for step in SOME if len(self.sketches) > GLANCED_AT else ():
            some = np.arange(0, len(self.sketches), step)
            plan = self.plan(reach, some)
            # Each step divides the one before it.
            plan.known(read // step, windows)
            for _ in range(ROUNDS):
                which, near = self.read_next(plan, some, found, rows)
                read, windows = np.concatenate([read, some[which]]), windows + near
            reach = plan.reach()
        plan = self.plan(reach, None)
        plan.known(read, windows)
        return plan

    def read_next(
        self, plan: _morec.SearchPlan, places: Any, found: Found, rows: dict[int, KeptRows]
    ) -> tuple[Any, list[tuple[int, float]]]:
        """Reads what a plan for the clips at these places asks for next; which it were, none if it has enough, and their windows.

        `rows` holds those of clips that may be needed.
        """
        def at(which: Any) -> Any:
            return which if places is None else places[which]

        which = plan.next_to_bound()
        if len(which):
            plan.bound(which, self.bounds(True, plan.reach(), at(which)))
            found.bound += len(which)
        which = plan.next_to_read()
        read = self.sketches.rows(self.store, at(which))
        found.read += len(read)
        windows = _morec.SearchPart(read).nearest_windows(self.example, *self.wanted.native()) if read else []
        plan.found(windows)
        # No more is held than may be needed.
        chosen = set(plan.chosen())
        for number in [number for number in rows if number not in chosen]:
            del rows[number]
        rows.update((row[0], row) for row in read if row[0] in chosen)
        return which, windows


def _nearest_of(frame: DataFrame, example: Example, wanted: Wanted) -> list[tuple[KeptRows, Names]]:
    """The nearest clips of a frame, every row of which is read."""
    numbered = frame.with_column("number", _number(col("clip")))
    worker: Any = Nearest(example, *wanted.native())
    near = worker.run(col("number"), col("bones"), col("rows"))
    answers = numbered.select(near.alias("near")).explode("near").where(~col("near").is_null())
    answers = answers.select(col("near").get("clip").alias("clip"), col("near").get("distance").alias("distance"))
    near_clips = sorted(answers.to_pylist(), key=lambda row: (row["distance"], row["clip"]))
    # Of all parts together as many of the nearest as of each.
    chosen = sorted({row["clip"] for row in near_clips[: _morec.search_windows(wanted.limit)]})
    if not chosen:
        return []
    few = daft.from_pydict({"number": chosen})
    rows = numbered.join(few, on="number").select("number", "name", "clip", "bones", "rows").to_pylist()
    rows.sort(key=lambda row: row["number"])
    return [((row["number"], row["bones"], row["rows"]), (row["clip"], row["name"])) for row in rows]


@daft.func(return_dtype=DataType.int64())
def _number(clip: str) -> int:
    return clip_number(clip)

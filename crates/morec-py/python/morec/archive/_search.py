"""Search: clips are read in the order of what their sketches promise, until no other can be among the hits."""

from __future__ import annotations

import math
import os
from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from typing import Any

import daft
import numpy as np
import pyarrow.parquet as pq
from daft import DataFrame, DataType, col

from .. import _morec
from ._layout import clip_number
from ._sketches import SketchTable
from ._store import Store, patiently
from ._tasks import Example, Nearest

#: Archives of more clips are searched in one of so many clips first.
GLANCED_AT, SOME = 1 << 16, 16

#: A clip's number, name, key, bones and packed rows.
KeptRows = tuple[int, str, str, int, bytes]


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
    store: Store, tables: Sequence[SketchTable], unsketched: DataFrame | None, example: Example, wanted: Wanted
) -> Found:
    """The hits among the clips of tables of sketches and those of a frame (clip, name, bones, rows) that have none."""
    asked, how = example.native(), wanted.native()
    sketched = Sketched(store, tables, asked, wanted)
    found = Found([], int(sketched.firsts[-1]), 0, 0)
    rows: dict[int, KeptRows] = {}
    reach = math.inf
    if found.sketched > GLANCED_AT:
        # Among some of the clips the nearest windows are further, but so near that of most others a glance is enough.
        some = np.arange(0, found.sketched, SOME)
        plan = _morec.SearchPlan(sketched.bounds(False, reach, some), *how)
        sketched.read(plan, some, found, once=True)
        reach = plan.reach()
    plan = _morec.SearchPlan(sketched.bounds(False, reach, None), *how)
    if unsketched is not None:
        rows = {row[0]: row for row in _nearest_of(unsketched, example, wanted)}
        plan.found(_part(list(rows.values())).nearest_windows(asked, *how))
    rows |= sketched.read(plan, np.arange(found.sketched), found)
    few = {number: rows[number] for number in plan.chosen()}
    hits = _part([few[number] for number in sorted(few)]).search(asked, *how)
    found.hits = [(few[hit[0]][2], few[hit[0]][1], *hit[1:]) for hit in hits]
    return found


@dataclass
class Sketched:
    """Clips of which there are sketches, and an example."""

    store: Store
    tables: Sequence[SketchTable]
    asked: _morec.SearchExample
    wanted: Wanted

    def __post_init__(self) -> None:
        self.columns = [table.native() for table in self.tables]
        self.firsts = np.cumsum([0, *(len(table.clip) for table in self.tables)])

    def bounds(self, closely: bool, reach: float, places: Any) -> Any:
        return _morec.sketch_bounds(self.asked, self.columns, *self.wanted.native(), closely, reach, places)

    def read(self, plan: _morec.SearchPlan, places: Any, found: Found, once: bool = False) -> dict[int, KeptRows]:
        """Reads what a plan for the clips at these places asks for, until it has enough or `once`; clips that may be needed."""
        rows: dict[int, KeptRows] = {}
        while True:
            which = plan.next_to_bound()
            if len(which):
                plan.bound(which, self.bounds(True, plan.reach(), places[which]))
                found.bound += len(which)
            which = plan.next_to_read()
            if not len(which):
                return rows
            read = _rows_at(self.store, self.tables, self.firsts, places[which])
            found.read += len(read)
            plan.found(_part(read).nearest_windows(self.asked, *self.wanted.native()))
            # No more is held than may be needed.
            chosen = set(plan.chosen())
            rows = {number: row for number, row in rows.items() if number in chosen}
            rows |= {row[0]: row for row in read if row[0] in chosen}
            if once:
                return rows


def _part(rows: Sequence[KeptRows]) -> _morec.SearchPart:
    return _morec.SearchPart([(number, bones, packed) for number, _, _, bones, packed in rows])


def _rows_at(store: Store, tables: Sequence[SketchTable], firsts: Any, places: Any) -> list[KeptRows]:
    """Rows of the clips at these places of all tables together, in their order."""
    at_table = np.searchsorted(firsts, places, side="right") - 1
    groups: dict[tuple[str, int], list[tuple[int, int, int]]] = {}
    for order, (at, place) in enumerate(zip(at_table.tolist(), places.tolist())):
        table, row = tables[at], place - int(firsts[at])
        where = (table.parts[table.part[row]][0], int(table.row_group[row]))
        groups.setdefault(where, []).append((int(table.row[row]), order, int(table.clip[row])))
    read: list[KeptRows | None] = [None] * len(places)

    def of_group(where: tuple[str, int]) -> None:
        inside = groups[where]
        names = ["clip", "name", "bones", "rows"]
        table = patiently(lambda: pq.ParquetFile(store.open(where[0])).read_row_group(where[1], columns=names))
        for row, (_, order, number) in zip(table.take([row for row, _, _ in inside]).to_pylist(), inside):
            if row["clip"] is None or clip_number(row["clip"]) != number:
                raise ValueError(f"{store.url(where[0])}: not what its sketches were made of; create the archive again")
            read[order] = (number, row["name"], row["clip"], row["bones"], row["rows"])

    with ThreadPoolExecutor(min(8, 2 * (os.cpu_count() or 1))) as pool:
        list(pool.map(of_group, groups))
    return [row for row in read if row is not None]


def _nearest_of(frame: DataFrame, example: Example, wanted: Wanted) -> list[KeptRows]:
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
    return sorted(
        (row["number"], row["name"], row["clip"], row["bones"], row["rows"]) for row in rows
    )


@daft.func(return_dtype=DataType.int64())
def _number(clip: str) -> int:
    return clip_number(clip)

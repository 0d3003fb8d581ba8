"""Sketches of clips, which say what a search need not read; docs/formats/archive.md describes them."""

from __future__ import annotations

import io
import json
import os
import zlib
from collections.abc import Iterator, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field
from typing import Any

import daft
import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
from daft import DataType, Series

from .. import _morec
from ._layout import CLIPS, clip_number, part_name
from ._store import Store, patiently

SKETCHES = "sketches"
#: Version of what sketches hold; others are not used.
VERSION = 3
_ABOUT = b"morec"
_ENDING = ".arrow"
SCHEMA = pa.schema(
    [
        pa.field("clip", pa.int64(), nullable=False),
        pa.field("name", pa.string()),
        pa.field("bones", pa.int64(), nullable=False),
        pa.field("part", pa.int32(), nullable=False),
        pa.field("row_group", pa.int32(), nullable=False),
        pa.field("row", pa.int32(), nullable=False),
        pa.field("rows_at", pa.int64(), nullable=False),
        pa.field("rows_bytes", pa.int32(), nullable=False),
        pa.field("rows_crc", pa.uint32(), nullable=False),
        pa.field("sketch", pa.binary(), nullable=False),
    ]
)
#: Bytes of parts that one table of sketches is made of; it holds about a seventh of that.
TABLE_BYTES = 256 << 20

#: A part of the clips: its name and size. A part that is written again has another size.
Part = tuple[str, int]


@dataclass(frozen=True)
class SketchTable:
    """A table of sketches in memory, or mapped: of each clip its name, where its rows lie and what its sketch is."""

    parts: list[Part]
    clip: Any
    name: Any
    bones: Any
    part: Any
    row_group: Any
    row: Any
    rows_at: Any
    rows_bytes: Any
    rows_crc: Any
    starts: Any
    sketches: Any

    def native(self) -> tuple[Any, Any, Any]:
        return self.bones, self.starts, self.sketches


def made_of(store: Store, parts: Sequence[Part]) -> bytes:
    """The table of sketches of the clips of these parts, as the bytes of an Arrow file."""
    columns: dict[str, list[Any]] = {name: [] for name in SCHEMA.names}
    for number, (part, _) in enumerate(parts):
        content = store.read(part)
        file = pq.ParquetFile(pa.BufferReader(content))
        for group in range(file.num_row_groups):
            table = file.read_row_group(group, columns=["clip", "name", "bones", "rows"]).to_pydict()
            there = [row for row, clip in enumerate(table["clip"]) if clip is not None]
            packed = [table["rows"][row] or b"" for row in there]
            made = _morec.sketch_kept([(table["bones"][row], rows) for row, rows in zip(there, packed)])
            columns["clip"] += [clip_number(table["clip"][row]) for row in there]
            columns["name"] += [table["name"][row] for row in there]
            columns["bones"] += [table["bones"][row] for row in there]
            columns["part"] += [number] * len(there)
            columns["row_group"] += [group] * len(there)
            columns["row"] += there
            columns["rows_at"] += _places(content, file.metadata.row_group(group), packed)
            columns["rows_bytes"] += [len(rows) for rows in packed]
            columns["rows_crc"] += [zlib.crc32(rows) for rows in packed]
            columns["sketch"] += [sketch or b"" for sketch in made]
    about = {_ABOUT: json.dumps({"sketches": VERSION, "parts": parts}).encode()}
    table = pa.table({name: pa.array(columns[name], SCHEMA.field(name).type) for name in SCHEMA.names}, schema=SCHEMA)
    out = io.BytesIO()
    # One batch, as it lies in memory: it is mapped, and nothing of it copied.
    schema = SCHEMA.with_metadata(about)
    with pa.ipc.new_file(out, schema) as writer:
        for batch in table.replace_schema_metadata(about).combine_chunks().to_batches():
            writer.write_batch(batch)
    return out.getvalue()


def _places(content: bytes, group: Any, packed: Sequence[bytes]) -> list[int]:
    """Where packed rows lie in the bytes of a part; -1 of such as do not lie there as they are."""
    columns = (group.column(at) for at in range(group.num_columns))
    chunk = next(column for column in columns if column.path_in_schema == "rows")
    # Earlier releases compressed the column.
    if chunk.compression != "UNCOMPRESSED":
        return [-1] * len(packed)
    at = chunk.data_page_offset
    end = at + chunk.total_compressed_size
    places = []
    for rows in packed:
        # A value lies there after its length. Of none nothing is read.
        found = content.find(len(rows).to_bytes(4, "little") + rows, at, end) if rows else at
        places.append(found + 4 if found >= 0 else -1)
        at = max(at, found + len(rows))
    return places


def parts_in(metadata: Mapping[bytes, bytes] | None) -> list[Part] | None:
    """The parts that a table of sketches refers to; None if it is of another version."""
    try:
        about = json.loads((metadata or {})[_ABOUT])
        if about["sketches"] != VERSION:
            return None
        return [(name, size) for name, size in about["parts"]]
    except (KeyError, ValueError, TypeError):
        return None


def _read(store: Store, name: str) -> SketchTable | None:
    try:
        table = patiently(lambda: pa.ipc.open_file(store.open(name)).read_all())
    except (FileNotFoundError, pa.ArrowInvalid):
        return None
    parts = parts_in(table.schema.metadata)
    if parts is None or table.schema.names != SCHEMA.names or table.column(0).num_chunks > 1:
        return None
    column = {name: table.column(name).combine_chunks() for name in SCHEMA.names}
    sketch, names = column.pop("sketch"), column.pop("name")
    sketch = sketch.chunk(0) if isinstance(sketch, pa.ChunkedArray) else sketch
    _, starts, values = sketch.buffers()
    numbers = {name: array.to_numpy() for name, array in column.items()}
    count = len(sketch)
    return SketchTable(
        parts=parts,
        name=names,
        starts=np.frombuffer(starts, np.int32, count + 1, 4 * sketch.offset) if count else np.zeros(1, np.int32),
        sketches=np.frombuffer(values, np.uint8) if values else np.zeros(0, np.uint8),
        **numbers,
    )


def _tables_in(store: Store) -> list[Part]:
    return [(name, size) for name, size in store.list(SKETCHES) if name.endswith(_ENDING)]


@dataclass
class Sketches:
    """The tables of sketches of an archive that were read."""

    tables: dict[Part, SketchTable | None] = field(default_factory=dict)

    def of(self, store: Store) -> list[SketchTable]:
        """All tables that there are now; those that were read before are not read again."""
        there = _tables_in(store)
        self.tables = {table: self.tables[table] for table in there if table in self.tables}
        new = [table for table in there if table not in self.tables]
        with ThreadPoolExecutor(min(8, 2 * (os.cpu_count() or 1))) as pool:
            self.tables.update(zip(new, pool.map(lambda table: _read(store, table[0]), new)))
        return [table for table in self.tables.values() if table is not None]


def used(tables: Sequence[SketchTable], parts: Sequence[Part]) -> tuple[list[SketchTable], list[Part]]:
    """Tables all of whose parts are there as they were, none of them twice; and the parts that no such table refers to."""
    left = dict.fromkeys(parts)
    chosen = []
    for table in tables:
        if all(part in left for part in table.parts):
            chosen.append(table)
            for part in table.parts:
                del left[part]
    return chosen, list(left)


def tasks(parts: Sequence[Part]) -> Iterator[list[Part]]:
    """Parts in groups that make one table each."""
    group: list[Part] = []
    for part in parts:
        if group and sum(size for _, size in group) + part[1] > TABLE_BYTES:
            yield group
            group = []
        group.append(part)
    if group:
        yield group


def table_name(parts: Sequence[Part]) -> str:
    """The name of the table of sketches of these parts."""
    name = part_name(SKETCHES, [f"{VERSION}", *(f"{part} {size}" for part, size in parts)])
    return name.removesuffix(".parquet") + _ENDING


@daft.cls(max_retries=3)
class Sketcher:
    """Writes tables of sketches; on whichever worker."""

    def __init__(self, archive: Store) -> None:
        self.archive = archive

    @daft.method.batch(return_dtype=DataType.string(), batch_size=1)
    def run(self, parts: Series, sizes: Series) -> list[str]:
        names = []
        for of_task, of_sizes in zip(parts.to_pylist(), sizes.to_pylist()):
            group = list(zip(of_task, of_sizes))
            name = table_name(group)
            self.archive.write(name, made_of(self.archive, group))
            names.append(name)
        return names


def add_sketches(store: Store) -> int:
    """Makes the sketches that are missing, and deletes tables of parts that are no more. How many parts were new."""
    parts = [(name, size) for name, size in store.list(CLIPS) if name.endswith(".parquet")]
    # Those of earlier releases are Parquet.
    there = [name for name, _ in store.list(SKETCHES) if name.endswith((_ENDING, ".parquet"))]
    read = {name: _parts_of(store, name) if name.endswith(_ENDING) else None for name in there}
    left, stale = dict.fromkeys(parts), []
    for name, of_table in read.items():
        if of_table is not None and all(part in left for part in of_table):
            for part in of_table:
                del left[part]
        else:
            stale.append(name)
    for name in stale:
        store.delete(name)
    new = list(tasks(list(left)))
    if new:
        frame = daft.from_pydict(
            {
                "parts": [[name for name, _ in group] for group in new],
                "sizes": [[size for _, size in group] for group in new],
            }
        )
        if daft.get_or_infer_runner_type() == "ray":
            frame = frame.into_partitions(len(new))
        sketcher: Any = Sketcher(store)
        frame.select(sketcher.run(frame["parts"], frame["sizes"]).alias("done")).collect()
    return len(left)


def _parts_of(store: Store, name: str) -> list[Part] | None:
    try:
        return parts_in(patiently(lambda: pa.ipc.open_file(store.open(name)).schema).metadata)
    except pa.ArrowInvalid:
        return None

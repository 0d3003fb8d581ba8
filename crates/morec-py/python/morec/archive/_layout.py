"""The tables of an archive; docs/formats/archive.md describes them."""

from __future__ import annotations

import hashlib
import io
import json
from collections.abc import Iterable, Mapping, Sequence
from typing import Any

import pyarrow as pa
import pyarrow.parquet as pq

#: Version of the layout that this release writes, and the newest it reads.
VERSION = 1
ABOUT = "archive.json"
CLIPS, LABELS = "clips", "labels"

_text, _integer, _real = pa.string(), pa.int64(), pa.float64()

#: A row for each clip, and one for each file that cannot be read: then ``error`` says why and the rest is null.
CLIP_SCHEMA = pa.schema(
    [
        pa.field("clip", _text),
        pa.field("name", _text),
        pa.field("error", _text),
        pa.field("subject", _text),
        pa.field("source", _text),
        pa.field("licence", _text),
        pa.field("tags", pa.list_(_text)),
        pa.field("secs", _real),
        pa.field("frames", _integer),
        pa.field("rate_hz", _real),
        pa.field("rest_frames", _integer),
        pa.field("repaired_frames", _integer),
        pa.field("joints", _integer),
        pa.field("skeleton", pa.binary()),
        pa.field("roles", _text),
        pa.field("facts", _text),
        pa.field("max_angle_rad", _real),
        pa.field("max_position_metres", _real),
        pa.field("motion", pa.binary()),
        pa.field("rows_recipe", _text),
        pa.field("bones", _integer),
        pa.field("rows", pa.binary()),
        pa.field("character", _integer),
        pa.field("file_hash", pa.binary()),
        pa.field("file_path", _text, nullable=False),
        pa.field("file_format", _text),
        pa.field("file_bytes", _integer),
        pa.field("file_skeleton", _text),
        pa.field("warnings", pa.list_(_text)),
    ]
)
LABEL_SCHEMA = pa.schema(
    [
        pa.field("clip", _text, nullable=False),
        pa.field("class", _text, nullable=False),
        pa.field("start_secs", _real, nullable=False),
        pa.field("stop_secs", _real, nullable=False),
        pa.field("whole_clip", pa.bool_(), nullable=False),
        pa.field("person", _text),
        pa.field("state", _text, nullable=False),
        pa.field("score", _real),
        pa.field("set_by", _text, nullable=False),
    ]
)

#: Seconds of motion in a row group: some seconds to a minute of work, whatever is done with them.
GROUP_SECS = 3600.0


def clip_number(clip: str) -> int:
    """A clip's key as a number that searching can carry; keys are the first 16 hexadecimal digits of a hash."""
    return int(clip, 16) - (1 << 63)


def clip_of(number: int) -> str:
    """The key of a clip of which this is the number."""
    return f"{number + (1 << 63):016x}"


def clip_key(file_hash: bytes, character: int) -> str:
    """Identifier of a clip in every table: the same for the same content, wherever it lies."""
    return hashlib.sha256(file_hash + character.to_bytes(8, "little")).hexdigest()[:16]


def part_name(table: str, content: Iterable[str]) -> str:
    """The name of a part, made from what it is made of: doing a task again writes the same file again."""
    digest = hashlib.sha256("\n".join(content).encode()).hexdigest()[:24]
    return f"{table}/part-{digest}.parquet"


def parquet(rows: Sequence[Mapping[str, Any]], schema: pa.Schema) -> bytes:
    """Rows as the bytes of a Parquet file; the same rows give the same bytes."""
    columns = {name: [row.get(name) for row in rows] for name in schema.names}
    table = pa.table([pa.array(columns[field.name], field.type) for field in schema], schema=schema)
    out = io.BytesIO()
    # Motion and rows are compressed by coders of their own; all else is small. Rows lie in the file as they are, so that
    # those of one clip can be read alone.
    # The stubs of pyarrow know one compression for all columns only.
    compression: Any = {name: "none" if name == "rows" else "zstd" for name in schema.names}
    with pq.ParquetWriter(out, schema, compression=compression, use_dictionary=False) as writer:
        for start, stop in _groups([row.get("secs") or 0.0 for row in rows]):
            writer.write_table(table.slice(start, stop - start))
    return out.getvalue()


def _groups(secs: Sequence[float]) -> list[tuple[int, int]]:
    groups, start, sum_secs = [], 0, 0.0
    for at, one in enumerate(secs):
        if sum_secs + one > GROUP_SECS and at > start:
            groups.append((start, at))
            start, sum_secs = at, 0.0
        sum_secs += one
    groups.append((start, len(secs)))
    return groups


def about(version: str) -> bytes:
    """The bytes of archive.json."""
    return (json.dumps({"layout": VERSION, "written_by": f"morec {version}"}, indent=1) + "\n").encode()


def check(content: bytes, uri: str) -> None:
    """Raises ValueError unless these are the bytes of an archive.json that this release knows."""
    try:
        layout = json.loads(content)["layout"]
    except (ValueError, KeyError, TypeError):
        raise ValueError(f"{uri}: {ABOUT} is not that of an archive") from None
    if not isinstance(layout, int) or layout > VERSION:
        raise ValueError(f"{uri}: layout {layout}, this morec reads up to {VERSION}: use a newer morec")

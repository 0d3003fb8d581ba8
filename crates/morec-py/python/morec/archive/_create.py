"""Import: files to rows, in tasks that can be repeated."""

from __future__ import annotations

import os
import tempfile
from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field
from typing import Any

import daft
from daft import DataType, Series

from .. import _morec
from ._layout import CLIP_SCHEMA, CLIPS, clip_key, parquet, part_name
from ._store import Store

#: Bytes of files that one task reads; a worker holds about five times as much.
TASK_BYTES = 64 << 20
#: Files in a task at most.
TASK_FILES = 256
#: Files that are fetched at once.
FETCHES = 8


@dataclass(frozen=True)
class Task:
    """Files that become one part."""

    files: list[str]
    sizes: list[int] = field(default_factory=list)

    def part(self, recipe: str) -> str:
        return part_name(CLIPS, [recipe, *(f"{name} {size}" for name, size in zip(self.files, self.sizes))])


def tasks(files: Sequence[tuple[str, int]]) -> list[Task]:
    """Files in tasks of about the same size, in order."""
    made: list[Task] = []
    names: list[str] = []
    sizes: list[int] = []
    for name, size in files:
        if names and (sum(sizes) + size > TASK_BYTES or len(names) >= TASK_FILES):
            made.append(Task(names, sizes))
            names, sizes = [], []
        names.append(name)
        sizes.append(size)
    if names:
        made.append(Task(names, sizes))
    return made


def keep(raw: Store, files: Sequence[str], about: dict[str, Any]) -> list[dict[str, Any]]:
    """Rows of files: one for each clip, or one with the error."""
    with ThreadPoolExecutor(FETCHES) as pool:
        fetched = list(pool.map(lambda name: _fetched(raw, name), files))
    rows: list[dict[str, Any]] = []
    for name, content in zip(files, fetched):
        url = raw.url(name)
        if isinstance(content, Exception):
            rows.append({"file_path": url, "error": f"{content}"})
            continue
        try:
            kept = _kept(raw, name, content)
        except _morec.MorecError as error:
            rows.append({"file_path": url, "file_bytes": len(content), "error": f"{error}"})
            continue
        for row in kept:
            key = clip_key(row["file_hash"], row["character"])
            rows.append({**row, **about, "clip": key, "file_path": url})
    return rows


def _fetched(raw: Store, name: str) -> bytes | Exception:
    try:
        return raw.read(name)
    except OSError as error:
        return error


def _kept(raw: Store, name: str, content: bytes) -> list[dict[str, Any]]:
    if not name.lower().endswith(".amc"):
        return _morec.keep_file(name, content, {})
    # An AMC motion needs the ASF skeleton that lies beside it or a folder above.
    folder = os.path.dirname(name)
    near = {folder, os.path.dirname(folder)}
    with tempfile.TemporaryDirectory() as place:
        for skeleton, _ in raw.list(os.path.dirname(folder)):
            if skeleton.lower().endswith(".asf") and os.path.dirname(skeleton) in near:
                path = os.path.join(place, skeleton)
                os.makedirs(os.path.dirname(path), exist_ok=True)
                with open(path, "wb") as out:
                    out.write(raw.read(skeleton))
        path = os.path.join(place, name)
        os.makedirs(os.path.dirname(path), exist_ok=True)
        return _morec.keep_file(path, content, {})


@daft.cls(max_retries=3)
class Importer:
    """Writes parts; on whichever worker."""

    def __init__(self, archive: Store, raw: Store, about: dict[str, Any]) -> None:
        self.archive, self.raw, self.about = archive, raw, about

    @daft.method.batch(
        return_dtype=DataType.struct({"part": DataType.string(), "clips": DataType.int64(), "errors": DataType.int64()}),
        batch_size=1,
    )
    def run(self, parts: Series, files: Series) -> list[dict[str, Any]]:
        done = []
        for part, names in zip(parts.to_pylist(), files.to_pylist()):
            rows = keep(self.raw, names, self.about)
            self.archive.write(part, parquet(rows, CLIP_SCHEMA))
            errors = sum(row.get("error") is not None for row in rows)
            done.append({"part": part, "clips": len(rows) - errors, "errors": errors})
        return done

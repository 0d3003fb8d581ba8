"""Recognition with an index that is too large for one worker.

Template matching is independent from class to class, and nearly all of the work. So the index is divided by classes, a worker
matches every clip with one part at a time, and the matches of all parts are decoded together with the first part. The events
are those of the whole index.
"""

from __future__ import annotations

import hashlib
from typing import Any

import daft
from daft import DataFrame, DataType, Series, col, lit

from .. import _morec
from .._morec import Index
from ._store import Store
from ._tasks import BATCH, EVENTS, told

#: Where parts lie in an archive.
FOLDER = "indexes"
MATCHES = DataType.struct({"matches": DataType.binary(), "error": DataType.string()})
MOTION = ("motion", "roles", "rest_frames")


def write_parts(store: Store, index: Index, of: int) -> list[str]:
    """Writes the parts of an index into the archive, unless they are there; their names."""
    digest = hashlib.blake2b(index.to_bytes(), digest_size=8).hexdigest()
    names = [f"{FOLDER}/{digest}/part-{part:04}-of-{of:04}.index" for part in range(of)]
    there = {name for name, _ in store.list(f"{FOLDER}/{digest}")}
    for part, name in enumerate(names):
        if name not in there:
            store.write(name, index.part(part, of).to_bytes())
    return names


class Parts:
    """Cache of one part of an index, for each worker."""

    def __init__(self, store: Store) -> None:
        self.store = store
        self.name: str | None = None
        self.index: Index | None = None

    def load(self, name: str) -> Index:
        if self.index is None or self.name != name:
            # The old one goes before the new one comes.
            self.index = None
            self.index = _morec.index_from_bytes(self.store.read(name))
            self.name = name
        return self.index


@daft.cls(max_retries=3)
class Match:
    """Matches clips with a part of an index."""

    def __init__(self, store: Store) -> None:
        self.parts = Parts(store)

    @daft.method.batch(return_dtype=MATCHES, batch_size=BATCH)
    def run(self, part: Series, motion: Series, roles: Series, rest_frames: Series) -> list[dict[str, Any]]:
        names = part.to_pylist()
        clips = list(zip(motion.to_pylist(), roles.to_pylist(), rest_frames.to_pylist()))
        made: list[dict[str, Any]] = [{}] * len(names)
        for name in dict.fromkeys(names):
            places = [place for place, other in enumerate(names) if other == name]
            found = _morec.match_kept(self.parts.load(name), [clips[place] for place in places])
            for place, one in zip(places, found):
                failed = isinstance(one, str)
                made[place] = {"matches": None if failed else one, "error": one if failed else None}
        return made


@daft.cls(max_retries=3)
class Decide:
    """Decodes the matches of all parts; holds the first part, with the metric and the verifier."""

    def __init__(self, store: Store, first: str) -> None:
        self.index = _morec.index_from_bytes(store.read(first))

    @daft.method.batch(return_dtype=EVENTS, batch_size=BATCH)
    def run(self, motion: Series, roles: Series, rest_frames: Series, matches: Series) -> list[dict[str, Any]]:
        clips = zip(motion.to_pylist(), roles.to_pylist(), rest_frames.to_pylist())
        given = list(zip(clips, matches.to_pylist()))
        return told(_morec.recognize_matched_kept(self.index, given))


def divided_events(clips: DataFrame, store: Store, index: Index, of: int) -> DataFrame:
    """Columns clip, name, and events and error of each clip as a struct ``found``.

    ``clips`` has the columns clip, name, motion, roles, rest_frames.
    """
    names = write_parts(store, index, of)
    asked = clips.with_column("part", lit(names)).explode("part")
    # A worker goes through the clips with one part, then with the next.
    asked = asked.repartition(of, "part").sort("part") if on_ray() else asked.sort("part")
    matcher: Any = Match(store)
    matched = asked.with_column("matched", matcher.run(col("part"), *(col(name) for name in MOTION)))
    matched = matched.where(~col("matched").get("matches").is_null())
    few = matched.select(col("clip"), col("matched").get("matches").alias("matches"))
    by_clip = few.groupby("clip").agg(col("matches").list_agg())
    decide: Any = Decide(store, names[0])
    together = clips.join(by_clip, on="clip")
    found = decide.run(*(col(name) for name in MOTION), col("matches"))
    return together.select(col("clip"), col("name"), found.alias("found"))


def on_ray() -> bool:
    return bool(daft.get_or_infer_runner_type() == "ray")

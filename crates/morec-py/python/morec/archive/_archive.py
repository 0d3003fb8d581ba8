"""Archives and their operations."""

from __future__ import annotations

import os
from collections.abc import Iterable, Sequence
from typing import Any

import daft
import numpy as np
import pyarrow.parquet as pq
from daft import DataFrame, DataType, col

from .. import _morec
from .._files import read
from .._labels import Labels, label_rows
from .._morec import Clip, Index, load
from .._tables import Table
from . import _layout as layout
from ._discover import ArchiveSets, discover_sets
from ._divided import divided_events
from ._group import group
from ._search import Found, Sketched, Wanted, search
from ._sketches import Sketches, add_sketches, used
from ._store import Store
from ._tasks import Example, cuts_of, events_of

#: Rows that do not travel unless they are asked for.
LIGHT = [name for name in layout.CLIP_SCHEMA.names if name not in ("motion", "rows", "error")]
HITS = ["clip", "name", "start_secs", "stop_secs", "score", "warp_distance", "mirrored"]


class Archive:
    """Clips and labels in Parquet tables; returned by `create` and `open`.

    Methods that return a Daft DataFrame are lazy: they run when it is collected, shown or written.
    """

    def __init__(self, store: Store) -> None:
        self.store = store
        self._sketches = Sketches()
        self._sketched: Sketched | None = None

    def __repr__(self) -> str:
        return f"<morec.archive.Archive {self.store.uri}>"

    # Tables

    def _parts(self, table: str) -> list[str]:
        return [name for name, _ in self.store.list(table) if name.endswith(".parquet")]

    def _frame(
        self, table: str, columns: Sequence[str], parts: Sequence[str] | None = None
    ) -> DataFrame | None:
        parts = self._parts(table) if parts is None else parts
        if not parts:
            return None
        urls = [self.store.url(name) for name in parts]
        frame = daft.read_parquet(urls, io_config=self.store.io_config())
        return frame.select(*columns)

    def _clips(self, *columns: str, parts: Sequence[str] | None = None) -> DataFrame:
        frame = self._frame(layout.CLIPS, [*dict.fromkeys(["clip", *columns, "error"])], parts)
        if frame is None:
            raise ValueError(f"{self.store.uri}: the archive holds no clip yet")
        return frame.where(col("error").is_null()).exclude("error")

    def clips(self) -> DataFrame:
        """Descriptions of all clips, without their motion.

        ``clip`` is its key in all tables: the same for the same content. docs/formats/archive.md lists the columns.
        """
        return self._clips(*LIGHT)

    def errors(self) -> DataFrame:
        """Refused files with the reasons: columns file_path, file_bytes, error."""
        frame = self._frame(layout.CLIPS, ["file_path", "file_bytes", "error"])
        if frame is None:
            raise ValueError(f"{self.store.uri}: the archive holds no clip yet")
        return frame.where(~col("error").is_null())

    def labels(self) -> DataFrame:
        """Labels: clip, class, start_secs, stop_secs, whole_clip, person, state, score, set_by."""
        frame = self._frame(layout.LABELS, layout.LABEL_SCHEMA.names)
        if frame is None:
            return daft.from_arrow(layout.LABEL_SCHEMA.empty_table())
        return frame

    def info(self) -> dict[str, Any]:
        """Numbers of clips, hours, frames, bytes, errors and labels."""
        clips = self._clips("secs", "frames").agg(
            col("clip").count().alias("clips"), col("secs").sum(), col("frames").sum()
        )
        found = clips.to_pylist()[0]
        sizes = [size for _, size in self.store.list(layout.CLIPS)]
        hours = (found["secs"] or 0.0) / 3600
        return {
            "clips": found["clips"],
            "hours": hours,
            "frames": found["frames"] or 0,
            "parts": len(sizes),
            "bytes": sum(sizes),
            "bytes_an_hour": sum(sizes) / hours if hours else 0.0,
            "errors": self.errors().count_rows(),
            "labels": self.labels().count_rows(),
        }

    def clip(self, name: str) -> Clip:
        """Read one clip, by its key, or by its name if the name is unique."""
        row = self._row(name, "motion", "roles", "rest_frames", "facts")
        return _morec.kept_clip(row["name"], row["motion"], row["roles"], row["rest_frames"], row["facts"])

    def _row(self, name: str, *columns: str) -> dict[str, Any]:
        frame = self._clips("name", *columns)
        called: Any = (col("clip") == name) | (col("name") == name)
        rows = frame.where(called).limit(2).to_pylist()
        if len(rows) != 1:
            found = "none" if not rows else "several; name it by its key"
            raise KeyError(f"expected one clip called {name!r}, found {found}")
        return dict(rows[0])

    # Adding

    def known_files(self) -> set[tuple[str, int]]:
        """Path and size of every file that was examined."""
        frame = self._frame(layout.CLIPS, ["file_path", "file_bytes"])
        if frame is None:
            return set()
        rows = frame.distinct().to_pylist()
        return {(row["file_path"], row["file_bytes"] or 0) for row in rows}

    def add_labels(self, labels: Labels, *, state: str = "accepted", by: str = "user") -> int:
        """Add labels, which name clips by key or name. Returns their number.

        Adding the same labels again changes nothing.
        """
        lengths = self._clips("name", "rate_hz", "secs").to_pylist()
        known = {row["clip"]: row for row in lengths} | {row["name"]: row for row in lengths}
        given = label_rows(labels)
        if isinstance(given, bytes):
            given = _morec.rows_of_table(given)
        rows = []
        for clip, name, frames, secs, person in given:
            if clip not in known:
                raise KeyError(f"no clip is called {clip!r}")
            row = known[clip]
            if secs is None and frames is not None:
                secs = (frames[0] / row["rate_hz"], frames[1] / row["rate_hz"])
            start, stop = secs or (0.0, row["secs"])
            rows.append(
                {
                    "clip": row["clip"], "class": name, "start_secs": start, "stop_secs": min(stop, row["secs"]),
                    "whole_clip": secs is None, "person": person, "state": state, "score": None, "set_by": by,
                }
            )  # fmt: skip
        self._write_labels(rows)
        return len(rows)

    def _write_labels(self, rows: list[dict[str, Any]]) -> None:
        if rows:
            name = layout.part_name(layout.LABELS, [repr(sorted(row.items())) for row in rows])
            self.store.write(name, layout.parquet(rows, layout.LABEL_SCHEMA))

    def add_database(self, path: str | os.PathLike[str]) -> int:
        """Copy the clips and labels of a database of ``morec db``. Returns the number of new clips."""
        kept = _morec.kept_of_database(os.fspath(path))
        there = set(self._keys())
        rows, keys = [], {}
        for row in kept:
            key = layout.clip_key(row["file_hash"], row["character"])
            keys[row["name"]] = key
            if key not in there:
                there.add(key)
                rows.append({**row, "clip": key})
        if rows:
            name = layout.part_name(layout.CLIPS, [row["clip"] for row in rows])
            self.store.write(name, layout.parquet(rows, layout.CLIP_SCHEMA))
        with _morec.Database(path) as db:
            labels = [{**label, "clip": keys[label["clip"]]} for label in db.labels(state=None)]
        self._write_labels(labels)
        return len(rows)

    def _keys(self) -> list[str]:
        return [] if not self._parts(layout.CLIPS) else [row["clip"] for row in self._clips().to_pylist()]

    def add_sketches(self) -> int:
        """Create the missing sketches of clips, as `create` does. Returns the number of parts that got sketches.

        A search reads the sketches of all clips and the rows of a few; without sketches it reads all rows.
        """
        return add_sketches(self.store)

    def drop_copies(self) -> int:
        """Turn rows whose content was imported from another path into rows with an error. Returns their number."""
        first: dict[str, tuple[str, str]] = {}
        copies: dict[str, dict[str, str]] = {}
        for part in self._parts(layout.CLIPS):
            table = self._read_part(part, ["clip", "file_path"])
            for row in table.to_pylist():
                if row["clip"] is None:
                    continue
                path, where = first.setdefault(row["clip"], (row["file_path"], part))
                if (path, where) == (row["file_path"], part):
                    continue
                # The first by path stays, in whichever order parts came.
                if row["file_path"] < path:
                    copies.setdefault(where, {})[path] = row["file_path"]
                    first[row["clip"]] = (row["file_path"], part)
                else:
                    copies.setdefault(part, {})[row["file_path"]] = path
        for part, of_part in copies.items():
            rows = self._read_part(part).to_pylist()
            told = [
                {"file_path": row["file_path"], "file_bytes": row["file_bytes"],
                 "error": f"a copy of {of_part[row['file_path']]}"}
                if row["clip"] is not None and row["file_path"] in of_part
                else row
                for row in rows
            ]  # fmt: skip
            self.store.write(part, layout.parquet(told, layout.CLIP_SCHEMA))
        return sum(len(of_part) for of_part in copies.values())

    def _read_part(self, part: str, columns: list[str] | None = None) -> Any:
        import pyarrow as pa

        return pq.read_table(pa.BufferReader(self.store.read(part)), columns=columns)

    # Asking

    def recognize(self, index: Index | str | os.PathLike[str], *, parts: int = 1) -> DataFrame:
        """Recognise motions in all clips with an index.

        Parameters
        ----------
        index : Index or path
        parts : int
            Number of parts into which the index is divided by its classes, so that each worker needs the memory of one part only.
            The events stay the same; every clip is read and decoded once for each part.

        Returns
        -------
        DataFrame
            Columns clip, name, class, start_secs, stop_secs, score, reported_secs: a row for each motion.
        """
        if parts < 1:
            raise ValueError(f"parts: expected 1 or more, found {parts}")
        return self._recognized(index if isinstance(index, Index) else load(index), parts=parts)

    def _recognized(self, model: Index, keys: Sequence[str] | None = None, *, parts: int = 1) -> DataFrame:
        """The same in all clips or those of ``keys``."""
        frame = self._clips("name", "motion", "roles", "rest_frames")
        if keys is not None:
            frame = frame.where(col("clip").is_in(list(keys)))
        if parts == 1:
            found = events_of(col("motion"), model, col("roles"), col("rest_frames"))
            frame = frame.select(col("clip"), col("name"), found.alias("found"))
        else:
            frame = divided_events(frame, self.store, model, parts)
        events = frame.select(col("clip"), col("name"), col("found").get("events").alias("event")).explode("event")
        events = events.where(~col("event").is_null())
        fields = ["class", "start_secs", "stop_secs", "score", "reported_secs"]
        return events.select(col("clip"), col("name"), *[col("event").get(name).alias(name) for name in fields])

    def search(
        self,
        example: Clip | str | os.PathLike[str],
        start: float = 0.0,
        stop: float | None = None,
        *,
        limit: int = 20,
        mirror: bool = False,
        one_a_clip: bool = False,
        exact: bool = True,
    ) -> Table:
        """Segments similar to an example, most similar first, as ``morec db search`` finds them.

        Parameters
        ----------
        example : Clip, path, or key or name of a clip of the archive
        start, stop : float
            The stretch of the example, seconds.
        exact : bool
            If False, the search ends when the most promising clips have been read: it takes a fraction of the time, but may miss
            hits. The hits found have the scores and order of an exact search. Clips without sketches are always read.

        Returns
        -------
        Table
            Columns clip, name, start_secs, stop_secs, score, warp_distance, mirrored.
        """
        wanted = Wanted(limit, mirror, one_a_clip, exact)
        found = self._search(self._example(example, start, stop), wanted)
        return Table([dict(zip(HITS, hit)) for hit in found.hits], HITS)

    def _search(self, asked: Example, wanted: Wanted) -> Found:
        parts = [(name, size) for name, size in self.store.list(layout.CLIPS) if name.endswith(".parquet")]
        tables, left = used(self._sketches.of(self.store), parts)
        if self._sketched is None or list(map(id, self._sketched.tables)) != list(map(id, tables)):
            self._sketched = Sketched(tables)
        unsketched = None
        if left or not parts:
            unsketched = self._clips("name", "bones", "rows", parts=[name for name, _ in left])
        return search(self.store, self._sketched, unsketched, asked, wanted)

    def _example(self, example: Clip | str | os.PathLike[str], start: float, stop: float | None) -> Example:
        if isinstance(example, str) and not os.path.exists(example):
            row = self._row(example, "bones", "rows", "secs")
            number = layout.clip_number(row["clip"])
            return Example(start, row["secs"] if stop is None else stop, kept=(number, row["bones"], row["rows"]))
        return Example(start, stop, clip=example if isinstance(example, Clip) else read(example))

    def cuts(
        self, *, window: float | None = None, penalty: float | None = None, least: float | None = None
    ) -> DataFrame:
        """Find where the behaviour of each clip changes, by kernel change points, as ``morec cut`` does.

        Returns
        -------
        DataFrame
            Columns clip, name, secs, cuts_secs.
        """
        frame = self._clips("name", "secs", "bones", "rows")
        work: Any = cuts_of
        cuts = work(col("bones"), col("rows"), window, penalty, least)
        return frame.select(
            col("clip"),
            col("name"),
            col("secs"),
            cuts.alias("cuts_secs"),
        )

    def discover(self, *, minutes: float = 60.0, rounds: int = 2, seed: int = 1) -> ArchiveSets:
        """Motions that repeat, without labels: found in a sample of the clips, recognised in all of them.

        `morec.discover` compares every stretch with every other, which is too slow for an archive. Here it compares the clips
        of a sample, and a few repetitions of each set train an index. The next round takes the clips of a larger sample of which
        the index explains least, and adds the sets that are new. The last index finds the same motions in all clips.

        Parameters
        ----------
        minutes : float
            Length of the clips that are compared in a round, in minutes; the time of a round grows with its square.
        rounds : int
            At most so many; earlier if a round finds nothing new.
        seed : int
            Chooses the clips of the first round.

        Raises
        ------
        MorecError
            No motion repeats.
        """
        return discover_sets(self, minutes, rounds, seed)

    def moments(self) -> dict[int, dict[str, Any]]:
        """Number, mean and covariance of all feature rows, exactly, for each set of bones (one bit for each bone).

        Returns
        -------
        dict
            For each set of bones ``rows`` (int), ``mean`` (columns,) and ``covariance`` (columns, columns).
        """
        work: Any = _moments
        sums = work(col("bones"), col("rows")).alias("sums")
        frame = self._clips("bones", "rows").select(col("bones"), sums)
        merged: dict[int, list[Any]] = {}
        for row in frame.where(~col("sums").is_null()).to_pylist():
            count = row["sums"]["count"]
            if not count:
                continue
            first = np.frombuffer(row["sums"]["first"])
            second = np.frombuffer(row["sums"]["second"]).reshape(len(first), len(first))
            sums = merged.setdefault(row["bones"], [0, np.zeros_like(first), np.zeros_like(second)])
            sums[0] += count
            sums[1] += first
            sums[2] += second
        made = {}
        for bones, (count, first, second) in merged.items():
            mean = first / count
            made[bones] = {"rows": count, "mean": mean, "covariance": second / count - np.outer(mean, mean)}
        return made

    def group(self, classes: Sequence[str] = (), *, groups: int = 8, seed: int = 1) -> Table:
        """Group similar labelled samples by the mean and spread of their feature rows.

        Returns
        -------
        Table
            Columns clip, class, start_secs, stop_secs, group (from 0, larger groups first).
        """
        accepted: Any = col("state") == "accepted"
        labels = self.labels().where(accepted)
        if classes:
            labels = labels.where(col("class").is_in(list(classes)))
        joined = labels.join(self._clips("bones", "rows"), on="clip")
        return group(joined.to_pylist(), groups, seed)

    def sample(
        self, clips: Iterable[str] | int | DataFrame | None = None, *, seed: int = 1
    ) -> Sample:
        """Select clips: by key or name, N at random, those in the column clip of a DataFrame, or all."""
        if isinstance(clips, DataFrame):
            chosen: set[str] | None = {row["clip"] for row in clips.select("clip").distinct().to_pylist()}
        elif clips is None:
            chosen = None
        elif isinstance(clips, int):
            keys = sorted(self._keys())
            order = np.random.default_rng(seed).permutation(len(keys))[:clips]
            chosen = {keys[at] for at in order}
        else:
            names = set(clips)
            rows = self._clips("name").to_pylist()
            chosen = {row["clip"] for row in rows if row["clip"] in names or row["name"] in names}
        return Sample(self, chosen)


class Sample:
    """Some clips of an archive."""

    def __init__(self, archive: Archive, keys: set[str] | None) -> None:
        self.archive, self.keys = archive, keys

    def to_database(self, path: str | os.PathLike[str]) -> int:
        """Copy the clips and their labels into a database of ``morec db``. Returns the number of new clips."""
        rows = []
        for part in self.archive._parts(layout.CLIPS):
            for row in self.archive._read_part(part).to_pylist():
                if row["clip"] is not None and (self.keys is None or row["clip"] in self.keys):
                    row["tags"], row["warnings"] = row["tags"] or [], row["warnings"] or []
                    rows.append(row)
        # Clips of one file lie together.
        rows.sort(key=lambda row: (row["file_path"], row["character"]))
        new = _morec.kept_to_database(os.fspath(path), rows)
        names = _morec.names_in_database(os.fspath(path))
        by_key = {layout.clip_key(file_hash, character): name for file_hash, character, name in names}
        with _morec.Database(path) as db:
            by_state: dict[tuple[str, str], list[dict[str, Any]]] = {}
            for label in self.archive.labels().to_pylist():
                if label["clip"] in by_key and (self.keys is None or label["clip"] in self.keys):
                    row = {"clip": by_key[label["clip"]], "class": label["class"], "person": label["person"]}
                    if not label["whole_clip"]:
                        row |= {"start_secs": label["start_secs"], "stop_secs": label["stop_secs"]}
                    by_state.setdefault((label["state"], label["set_by"]), []).append(row)
            for (state, by), labels in by_state.items():
                db.label(labels, state=state, by=by)
        return int(new)


@daft.func.batch(
    return_dtype=DataType.struct(
        {"count": DataType.int64(), "first": DataType.binary(), "second": DataType.binary()}
    ),
    batch_size=64,
)
def _moments(bones: daft.Series, rows: daft.Series) -> list[dict[str, Any]]:
    """Sums of rows and of their products, as bytes of float64."""
    made = []
    for of_bones, packed in zip(bones.to_pylist(), rows.to_pylist()):
        values = _morec.rows_kept(of_bones, packed).astype(np.float64)
        first, second = values.sum(axis=0), values.T @ values
        made.append({"count": len(values), "first": first.tobytes(), "second": second.tobytes()})
    return made

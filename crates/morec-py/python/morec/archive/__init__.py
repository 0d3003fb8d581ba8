"""Archives: large collections of clips, processed on one or many machines (``pip install './crates/morec-py[archive]'``).

An archive is a folder of Parquet tables, local or in an S3-compatible store. Daft runs the work: on this machine by default, on a
Ray cluster after `use_ray`.

>>> import morec.archive as ma
>>> a = ma.create("archive/", from_files="raw/**/*.bvh")
>>> events = a.recognize(index)                       # a Daft DataFrame
>>> hits = a.search("example.bvh", 10.0, 11.5, limit=50)
"""

from __future__ import annotations

import os
from typing import Any

# Daft and Ray report that they are used unless this is switched off; who wants that sets these.
os.environ.setdefault("DAFT_ANALYTICS_ENABLED", "0")
os.environ.setdefault("RAY_USAGE_STATS_ENABLED", "0")

import daft
from daft import Expression

from .. import __version__
from .._morec import Index, load
from . import _layout as layout
from ._archive import Archive
from ._create import Importer, tasks
from ._store import Store, matches, split_glob
from ._tasks import events_of

__all__ = ["Archive", "create", "open", "recognize", "use_ray"]


def use_ray(address: str | None = None) -> None:
    """Run on a Ray cluster: the cluster at ``address``, or a new cluster on this machine.

    Call this before anything else, because Daft chooses its runner only once.
    """
    daft.set_runner_ray(address=address, noop_if_initialized=True)


def create(
    archive: str | os.PathLike[str],
    *,
    from_files: str | os.PathLike[str] | None = None,
    from_database: str | os.PathLike[str] | None = None,
    subject: str | None = None,
    source: str | None = None,
    licence: str | None = None,
    s3: dict[str, str] | None = None,
    raw_s3: dict[str, str] | None = None,
) -> Archive:
    """Create an archive, or add new files to it.

    Files are parsed, compressed and turned into feature rows on the workers. The result of a task is written as a whole, so the
    import can be stopped at any time and started again. An unreadable file becomes a row with an error.

    Parameters
    ----------
    archive : path or s3://bucket/prefix
    from_files : path, URL or pattern, optional
        ``raw/**/*.bvh``; a folder stands for all files in it and below. Files with a known path and size are not read again.
    from_database : path, optional
        A database of ``morec db``, whose clips and labels are copied unchanged.
    subject, source, licence : str, optional
        Description of all new clips.
    s3, raw_s3 : dict, optional
        ``endpoint_url``, ``key_id``, ``access_key``, ``session_token``, ``region_name`` of the archive's store, and of the raw
        files' if it is another; the environment's by default.

    Returns
    -------
    Archive
    """
    store = Store(os.fspath(archive), s3 or {})
    try:
        layout.check(store.read(layout.ABOUT), store.uri)
    except FileNotFoundError:
        store.write(layout.ABOUT, layout.about(__version__))
    made = Archive(store)
    about = {"subject": subject, "source": source, "licence": licence}
    if from_files is not None:
        _add_files(made, os.fspath(from_files), about, raw_s3 if raw_s3 is not None else s3 or {})
    if from_database is not None:
        made.add_database(from_database)
    made.add_sketches()
    return made


def open(archive: str | os.PathLike[str], *, s3: dict[str, str] | None = None) -> Archive:
    """Open an archive.

    Raises
    ------
    FileNotFoundError
        The archive does not exist.
    ValueError
        The archive was written by a later release.
    """
    store = Store(os.fspath(archive), s3 or {})
    layout.check(store.read(layout.ABOUT), store.uri)
    return Archive(store)


def _add_files(archive: Archive, pattern: str, about: dict[str, Any], s3: dict[str, str]) -> None:
    folder, below = split_glob(pattern)
    raw = Store(folder, s3)
    files = [(name, size) for name, size in raw.list() if matches(name, below)]
    if not files:
        raise FileNotFoundError(f"{pattern}: no such files")
    known = archive.known_files()
    new = [(name, size) for name, size in files if (raw.url(name), size) not in known]
    # Skeletons are read with their motions.
    new = [(name, size) for name, size in new if not name.lower().endswith(".asf")]
    made = tasks(new)
    if made:
        frame = daft.from_pydict(
            {
                "part": [task.part(__version__) for task in made],
                "files": [task.files for task in made],
            }
        )
        if daft.get_or_infer_runner_type() == "ray":
            # A task for each part, wherever there is room.
            frame = frame.into_partitions(len(made))
        importer: Any = Importer(archive.store, raw, about)
        frame.select(importer.run(frame["part"], frame["files"]).alias("done")).collect()
    archive.drop_copies()


def recognize(
    motion: Expression,
    index: Index | str | os.PathLike[str],
    *,
    roles: Expression | None = None,
    rest_frames: Expression | None = None,
) -> Expression:
    """A Daft expression: the detections of an index in a column of motion, as a list of events.

    Parameters
    ----------
    motion : Expression
        Binary: the bytes of ``.mclip`` files, as the column ``motion`` of an archive.
    index : Index or path
    roles, rest_frames : Expression, optional
        Columns of an archive with these names; inferred from the motion by default.

    Returns
    -------
    Expression
        A list of structs: class, start_secs, stop_secs, score, reported_secs; empty if nothing is recognised.

    Examples
    --------
    >>> frame.with_column("events", ma.recognize(daft.col("motion"), "signs.index"))
    """
    model = index if isinstance(index, Index) else load(index)
    return events_of(motion, model, roles, rest_frames).get("events")

"""Sets of the same motion in clips without labels."""

from __future__ import annotations

from typing import Any

from . import _morec
from ._files import Clips, as_clips
from ._morec import Database
from ._progress import Progress, listener
from ._tables import Table


def discover(
    clips: Clips | Database,
    *,
    plain: bool = False,
    runs: bool = False,
    clip: str | None = None,
    progress: Progress = None,
) -> Table:
    """Find motions that repeat, without labels, as ``morec discover`` does.

    Parameters
    ----------
    clips : Clip, path, sequence of these, or Database
    plain : bool
        Do not learn a metric from the first sets; takes half the time. If people rest between motions, the result is as good.
    runs : bool
        Join successive repetitions without a pause.
    clip : str, optional
        Name of the clips of a database; ``*`` stands for any text.
    progress : bool or callable, optional

    Returns
    -------
    Table
        One row for each repetition: set (from 1, the set that covers most motion first), clip, start_secs, stop_secs, distance
        (from the middle of its set, in spreads).
    """
    settings: dict[str, Any] = {"plain": plain, "runs": runs}
    if isinstance(clips, Database):
        return _morec.discover_stored(clips, clip, listener(progress), **settings)
    if clip is not None:
        raise ValueError("clip: chooses clips of a database")
    return _morec.discover(as_clips(clips), listener(progress), **settings)

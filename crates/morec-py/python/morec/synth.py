"""Synthetic people performing labelled gestures, for tests, examples and first trials.

Accuracy on synthetic people says nothing about accuracy on real people.
"""

from __future__ import annotations

from collections.abc import Sequence

from . import _morec
from ._morec import Clip
from ._tables import Table

__all__ = ["database", "everyday", "gestures"]


def gestures() -> list[str]:
    """Names of the available synthetic gestures."""
    return _morec.synth_motions()


def database(
    seed: int = 1,
    *,
    people: int = 5,
    streams: int = 1,
    repetitions: int = 3,
    classes: Sequence[str] | None = None,
    unknown_share: float = 0.6,
    left_handed: bool = False,
    rate_hz: float = 60.0,
) -> tuple[list[Clip], Table]:
    """Clips of synthetic people and the labels of what they perform.

    Parameters
    ----------
    seed : int
        The same seed gives the same clips on every platform.
    people, streams, repetitions : int
        There are ``people × streams`` clips; every class occurs ``repetitions`` times in each.
    classes : sequence of str, optional
        The gestures, of `gestures`; all by default.
    unknown_share : float
        Other motions in a clip, for each gesture in it.
    left_handed : bool
        Whether left-handed people mirror one-handed gestures.
    rate_hz : float
        Frames a second.

    Returns
    -------
    clips : list of Clip
    labels : Table
        Columns clip, class, start_secs, stop_secs, person.
    """
    wanted = None if classes is None else list(classes)
    takes = _morec.synth_database(
        seed, people, streams, repetitions, wanted, unknown_share, left_handed, rate_hz
    )
    columns = ["clip", "class", "start_secs", "stop_secs", "person"]
    rows = [
        dict(zip(columns, (clip.name, name, start, stop, person)))
        for clip, labels, person in takes
        for name, start, stop in labels
    ]
    return [clip for clip, _, _ in takes], Table(rows, columns)


def everyday(seed: int = 1, *, clips: int = 4) -> list[Clip]:
    """Clips of everyday motion without gestures, at 60 Hz, about 0.5 min each; 36 at most."""
    return _morec.synth_everyday(seed, clips)

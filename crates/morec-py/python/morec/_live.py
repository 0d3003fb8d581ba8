"""Live sources."""

from __future__ import annotations

import warnings
from collections.abc import Iterator
from typing import Any, Literal

from . import _morec
from ._files import Roles, roles_text
from ._morec import Index, MorecWarning

__all__ = ["listen"]

#: How long the native part waits before Ctrl-C is looked for.
LOOK_SECS = 0.1


class listen:
    """Recognise motions from a live source, until it ends or you stop.

    A context manager and an iterator of events. Ctrl-C raises KeyboardInterrupt and leaves the port free; so does leaving
    the loop, once the object is closed or forgotten.

    Parameters
    ----------
    address : str
        As for ``morec live --listen``: ``vmc://HOST:PORT`` (VMC senders on a UDP port, 39539 by convention),
        ``axis://HOST:PORT`` and ``axis+udp://HOST:PORT`` (broadcasts of Axis programs), ``json:-`` and ``json+tcp://HOST:PORT``
        (lines of JSON), ``webcam://127.0.0.1:8000?mediapipe=DIR`` (the camera, by a page there), ``clip://FILE`` (a clip as if somebody
        performed it).
    index : Index
    actors : int
        Largest number of performers at the same time.
    mirror : bool
        Exchange left and right, for senders that mirror their performer.
    roles : dict, path or str, optional
        ``{"left_hand": "LWrist"}``, or a roles file: joints of body parts that the names do not identify.
    sensitivity : float, optional
        Accepted false alarms a minute in background motion: 0.1 is strict, 1 is generous. As trained by default.
    performer : {"auto", "teacher", "anyone"}
        The expected performer, as in `Index.recognize`.
    tentative : bool
        Also report motions before they end: events of the phases start, update and cancel.
    each_repetition : bool
        Also an event of the phase repetition, with its start and stop, for each repetition of an activity.
    deviation : bool
        Say how far from the nearest sample each gesture that ends, and each such repetition, was.
    progress : bool
        Also how far every class has come, with each frame: events of the phase progress, whose progress and score are how far and how
        like to a sample, both 0 to 1. Of templates only.
    refractory_secs : float
        Least time between two reports of the same class, seconds.
    timeout : float, optional
        End after this many seconds without an event.

    Yields
    ------
    dict
        phase ("end", or one that was asked for), class, start_secs, stop_secs, score, progress, reported_secs, actor, motion,
        sequence, wall_secs (seconds since 1970 at the arrival of the frame that settled it), and of an activity that repeats
        repetitions so far and period_secs (None where nothing is counted). With `deviation` also off_degrees (mean angle
        off the nearest sample), worst_bone and worst_degrees; None where nothing is compared. pace, with `deviation` or
        `progress`: its duration over that of the nearest sample, so far.

        score: Probability that the detection is right, 0 to 1. The lowest accepted score is 0.05 to 0.44, depending on the index.
        For held poses and indexes without calibration (svrdm, older files) it is the similarity to a sample instead. Of
        a tentative event: how near what was seen so far is to the beginning of a sample, 0 to 1.

    Warns
    -----
    MorecWarning
        Once for each fault of what arrives, and for what keeps the index from recognising it: nothing arrives, another kind of
        performer, missing joints, noise.

    Examples
    --------
    >>> with morec.listen("vmc://127.0.0.1:39539", index) as events:
    ...     for event in events:
    ...         print(event["class"])
    """

    def __init__(
        self,
        address: str,
        index: Index,
        *,
        actors: int = 4,
        mirror: bool = False,
        roles: Roles = None,
        sensitivity: float | None = None,
        performer: Literal["auto", "teacher", "anyone"] = "auto",
        tentative: bool = False,
        each_repetition: bool = False,
        deviation: bool = False,
        progress: bool = False,
        refractory_secs: float = 0.0,
        timeout: float | None = None,
    ) -> None:
        options = {
            "roles": roles_text(roles),
            "sensitivity": sensitivity,
            "performer": performer,
            "tentative": tentative,
            "each_repetition": each_repetition,
            "deviation": deviation,
            "progress": progress,
            "refractory_secs": refractory_secs,
        }
        self._session = _morec.LiveSession(address, index, actors, mirror, options)
        self._timeout = timeout

    @property
    def address(self) -> str:
        """The address, with the actual port if port 0 was requested."""
        return self._session.address

    @property
    def status(self) -> dict[str, Any]:
        """Counts of frames, losses and events so far; ``findings``: problems of the stream, in sentences."""
        return self._session.status()

    def close(self) -> None:
        """Stop listening."""
        self._session.close()

    def __iter__(self) -> Iterator[dict[str, Any]]:
        return self

    def __next__(self) -> dict[str, Any]:
        waited = 0.0
        while True:
            # Python looks for Ctrl-C between two calls.
            event = self._session.wait(LOOK_SECS)
            for notice in self._session.notices():
                warnings.warn(notice, MorecWarning, stacklevel=2)
            if event is not None:
                return event
            if self._session.is_ended():
                raise StopIteration
            waited += LOOK_SECS
            if self._timeout is not None and waited >= self._timeout:
                raise StopIteration

    def __enter__(self) -> listen:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def __del__(self) -> None:
        session = getattr(self, "_session", None)
        if session is not None:
            session.close()

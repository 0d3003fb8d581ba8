"""Progress bars."""

from __future__ import annotations

import sys
import time
from collections.abc import Callable
from typing import Union

#: Called as ``progress(stage, done, total)``; stage is empty at the end.
Report = Callable[[str, int, int], None]
#: ``True``: a bar; ``False``: none; ``None``: a bar on a terminal and in a notebook, if it takes longer than a second.
Progress = Union[bool, Report, None]

#: Nothing is shown for what is done sooner.
MOMENT_SECS = 1.0
WIDTH = 30


def listener(progress: Progress) -> Report | None:
    """The callback for the native part, or ``None``."""
    if callable(progress) and not isinstance(progress, bool):
        return progress
    if progress is False or (progress is None and not _is_watched()):
        return None
    return Bar(0.0 if progress else MOMENT_SECS)


def _is_watched() -> bool:
    return sys.stderr.isatty() or "ipykernel" in sys.modules


class Bar:
    """A progress bar on standard error."""

    def __init__(self, after_secs: float) -> None:
        self._begun = time.monotonic()
        self._after_secs = after_secs
        self._shown = False

    def __call__(self, stage: str, done: int, total: int) -> None:
        if not stage:
            if self._shown:
                sys.stderr.write("\n")
                sys.stderr.flush()
            return
        if time.monotonic() - self._begun < self._after_secs:
            return
        full = round(WIDTH * min(done / max(total, 1), 1.0))
        sys.stderr.write(f"\r{stage} {'█' * full}{'░' * (WIDTH - full)} {done}/{total}")
        sys.stderr.flush()
        self._shown = True

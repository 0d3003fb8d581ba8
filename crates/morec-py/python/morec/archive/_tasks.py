"""Work on rows of clips, as Daft expressions."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import daft
from daft import DataType, Expression, Series, lit

from .. import _morec
from .._morec import Clip, Index, MorecError

EVENT = {
    "class": DataType.string(),
    "start_secs": DataType.float64(),
    "stop_secs": DataType.float64(),
    "score": DataType.float64(),
    "reported_secs": DataType.float64(),
}
EVENTS = DataType.struct(
    {"events": DataType.list(DataType.struct(EVENT)), "error": DataType.string()}
)
#: Clips that a worker recognises in one go.
BATCH = 16


@daft.cls(max_retries=3)
class Recognise:
    """An index at work; made once for each worker."""

    def __init__(self, index: bytes) -> None:
        self.index = _morec.index_from_bytes(index)

    @daft.method.batch(return_dtype=EVENTS, batch_size=BATCH)
    def run(self, motion: Series, roles: Series, rest_frames: Series) -> list[dict[str, Any]]:
        clips = list(zip(motion.to_pylist(), roles.to_pylist(), rest_frames.to_pylist()))
        return told(_morec.recognize_kept(self.index, clips))


def told(found: list[Any]) -> list[dict[str, Any]]:
    """Events or the error of each clip, as rows of `EVENTS`."""
    made: list[dict[str, Any]] = []
    for one in found:
        if isinstance(one, str):
            made.append({"events": [], "error": one})
        else:
            made.append({"events": [dict(zip(EVENT, event)) for event in one], "error": None})
    return made


def events_of(
    motion: Expression, index: Index, roles: Expression | None = None, rest_frames: Expression | None = None
) -> Expression:
    """Events and the error of each clip, as a struct."""
    nothing = lit(None)
    # What Daft's decorators make of a method is an expression when it is given expressions.
    worker: Any = Recognise(index.to_bytes())
    made: Expression = worker.run(
        motion,
        roles if roles is not None else nothing.cast(DataType.string()),
        rest_frames if rest_frames is not None else nothing.cast(DataType.int64()),
    )
    return made


@daft.func.batch(return_dtype=DataType.list(DataType.float64()), batch_size=64)
def cuts_of(bones: Series, rows: Series, window: float | None, penalty: float | None, least: float | None) -> list[Any]:
    """Seconds at which clips are cut; null of clips that show no bone."""
    made: list[list[float] | None] = []
    for of_bones, packed in zip(bones.to_pylist(), rows.to_pylist()):
        try:
            made.append(_morec.cut_kept(of_bones, packed, window, penalty, least))
        except (MorecError, ValueError):
            made.append(None)
    return made


NEAR = DataType.list(DataType.struct({"clip": DataType.int64(), "distance": DataType.float32()}))


@dataclass(frozen=True)
class Example:
    """The example of a search: a stretch of a clip of the archive, or of one from elsewhere."""

    start: float
    stop: float | None
    #: Number, bones and packed rows of a clip of the archive.
    kept: tuple[int, int, bytes] | None = None
    clip: Clip | None = None

    def native(self) -> _morec.SearchExample:
        if self.kept is not None:
            number, _, _ = self.kept
            # Beyond the clip's end is its end.
            stop = 1e9 if self.stop is None else self.stop
            return _morec.SearchPart([self.kept]).example(number, self.start, stop)
        if self.clip is None:
            raise ValueError("an example is a clip")
        return _morec.search_example(self.clip, self.start, self.stop)


@daft.cls(max_retries=3)
class Nearest:
    """The clips of a part that are nearest to an example."""

    def __init__(self, example: Example, limit: int, mirror: bool, one_a_clip: bool) -> None:
        self.example = example.native()
        self.how = (limit, mirror, one_a_clip)

    @daft.method.batch(return_dtype=NEAR, batch_size=4096)
    def run(self, clip: Series, bones: Series, rows: Series) -> list[Any]:
        numbers = clip.to_pylist()
        part = _morec.SearchPart(list(zip(numbers, bones.to_pylist(), rows.to_pylist())))
        near = [{"clip": number, "distance": far} for number, far in part.nearest(self.example, *self.how)]
        # One answer for the batch, in its first row.
        return [near] + [[] for _ in numbers[1:]]

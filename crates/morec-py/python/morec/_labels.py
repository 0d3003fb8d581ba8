"""Labels from DataFrames, files, tables and lists of spans."""

from __future__ import annotations

import os
from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING, Any, Union

if TYPE_CHECKING:
    import pandas

    from ._morec import Clip

#: A DataFrame, the path of a table, rows as dictionaries (a `Table`, too), or spans: tuples of clip, class, start and stop
#: in seconds and perhaps the person.
Labels = Union["pandas.DataFrame", str, "os.PathLike[str]", Iterable[Any], None]
#: Who is seen in which clip: a dictionary, a DataFrame with columns clip and person, or the path of a table.
People = Union[Mapping[str, str], "pandas.DataFrame", str, "os.PathLike[str]", None]

#: A label as the native part takes it: clip, class, frames, seconds, person. Without both extents, the whole clip.
Row = tuple[str, str, Union[tuple[int, int], None], Union[tuple[float, float], None], Union[str, None]]


def label_rows(labels: Labels) -> list[Row] | bytes:
    """Labels as rows, or the bytes of a table."""
    if labels is None:
        raise ValueError("labels: expected a DataFrame, a path or a list of spans, found None")
    if isinstance(labels, (str, os.PathLike)):
        with open(labels, "rb") as file:
            return file.read()
    return [_row(number, label) for number, label in enumerate(_dicts(labels))]


def _dicts(labels: Any) -> Iterable[Any]:
    if hasattr(labels, "to_dict") and hasattr(labels, "columns"):
        rows: Iterable[Any] = labels.to_dict("records")
        return rows
    if isinstance(labels, Mapping):
        raise TypeError("labels: expected a DataFrame, a path or a list of spans, found a dictionary")
    rows = labels
    return rows


def _row(number: int, label: Any) -> Row:
    if isinstance(label, Mapping):
        return _of_mapping(number, label)
    try:
        clip, name, *rest = label
    except (TypeError, ValueError):
        raise ValueError(f"labels, row {number}: expected (clip, class, start_secs, stop_secs), found {label!r}") from None
    if len(rest) not in (0, 2, 3):
        raise ValueError(f"labels, row {number}: expected (clip, class, start_secs, stop_secs), found {label!r}")
    secs = _span(number, rest[0], rest[1], float) if rest else None
    person = str(rest[2]) if len(rest) == 3 and rest[2] is not None else None
    return str(clip), str(name), None, secs, person


def _of_mapping(number: int, label: Mapping[str, Any]) -> Row:
    def get(name: str) -> Any:
        value = label.get(name)
        # What a DataFrame lacks is not a number.
        return None if value is None or value != value else value

    clip, name = get("clip"), get("class")
    if clip is None or name is None:
        raise ValueError(f"labels, row {number}: expected the columns clip and class, found {', '.join(map(str, label))}")
    person = get("person")
    frames, secs = None, None
    if get("start_secs") is not None or get("stop_secs") is not None:
        secs = _span(number, get("start_secs"), get("stop_secs"), float)
    elif get("start") is not None or get("stop") is not None:
        first, last = _span(number, get("start"), get("stop"), float)
        if first != int(first) or last != int(last):
            raise ValueError(f"labels, row {number}: start and stop are frames; seconds are start_secs and stop_secs")
        frames = (int(first), int(last))
    return str(clip), str(name), frames, secs, None if person is None else str(person)


def _span(number: int, start: Any, stop: Any, kind: type[float]) -> tuple[float, float]:
    try:
        first, last = kind(start), kind(stop)
    except (TypeError, ValueError):
        raise ValueError(f"labels, row {number}: expected a start and a stop, found {start!r} and {stop!r}") from None
    if not (0 <= first < last):
        raise ValueError(f"labels, row {number}: expected a stop after the start, found {start} to {stop}")
    return first, last


def people_rows(people: People) -> dict[str, str] | bytes | None:
    """The person of each clip, as a dictionary or the bytes of a table."""
    if people is None:
        return None
    if isinstance(people, (str, os.PathLike)):
        with open(people, "rb") as file:
            return file.read()
    if hasattr(people, "columns"):
        return {str(clip): str(person) for clip, person in zip(people["clip"], people["person"])}
    return {str(clip): str(person) for clip, person in people.items()}


def spans_in(labels: Labels, clip: Clip) -> list[tuple[str, float, float]]:
    """The labels of one clip: class, start and stop in seconds."""
    from . import _morec

    return _morec.resolve_labels(clip, label_rows(labels))

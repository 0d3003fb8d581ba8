"""Training and measuring."""

from __future__ import annotations

import json
import os
from collections.abc import Iterable, Mapping, Sequence
from typing import TYPE_CHECKING, Any, Union

from . import _morec
from ._files import Clips, as_clips
from ._labels import Labels, People, label_rows, people_rows
from ._morec import Clip, Crossval, Index
from ._progress import Progress, listener

if TYPE_CHECKING:
    import pandas

#: Detections: rows with clip, class, start_secs, stop_secs (a DataFrame or a `Table`, too), or the path of a table.
Found = Union["pandas.DataFrame", str, "os.PathLike[str]", Iterable[Mapping[str, Any]]]
#: Clips that were searched, or their lengths in seconds by name.
Lengths = Union[Clips, Mapping[str, float]]
#: Clips that hold none of the classes: clips, paths, or names of clips that are given anyway.
Background = Union[Clips, Iterable[str], None]


def _aside(given: Background, clips: list[Clip]) -> list[Clip]:
    """Clips named by name, path or as they are."""
    if given is None:
        return []
    by_name = {clip.name: clip for clip in clips}
    items: Iterable[Any] = [given] if isinstance(given, (Clip, str, os.PathLike)) else given
    found: list[Clip] = []
    for item in items:
        if isinstance(item, str) and not os.path.exists(item):
            if item not in by_name:
                raise FileNotFoundError(f"{item}: no such file or folder, and none of the clips is called so")
            found.append(by_name[item])
        else:
            found.extend(as_clips(item))
    return found


def _material(
    clips: Clips, labels: Labels, people: People, background: Background, exclude: Sequence[str]
) -> dict[str, Any]:
    of_clips = [clip for clip in as_clips(clips) if clip.name not in exclude]
    return {
        "clips": of_clips,
        "labels": label_rows(labels),
        "people": people_rows(people),
        "background": [clip for clip in _aside(background, of_clips) if clip.name not in exclude],
    }


def _settings(
    classes: Sequence[str],
    one_sided: Sequence[str],
    activities: Sequence[str],
    gestures: Sequence[str],
    bones: str | Sequence[str],
    params: Mapping[str, Any] | None,
    **words: str,
) -> str:
    lists = {"classes": classes, "one_sided": one_sided, "activities": activities, "gestures": gestures}
    return json.dumps({
        **words,
        **{name: list(values) for name, values in lists.items()},
        "bones": bones if isinstance(bones, str) else ",".join(bones),
        "params": dict(params or {}),
    })


def train(
    clips: Clips,
    labels: Labels,
    *,
    people: People = None,
    background: Background = None,
    classes: Sequence[str] = (),
    exclude: Sequence[str] = (),
    method: str = "auto",
    svrdm: str = "tuned",
    unlabelled: str = "background",
    everyday: str = "always",
    mirror: str = "auto",
    one_sided: Sequence[str] = (),
    activities: Sequence[str] = (),
    gestures: Sequence[str] = (),
    bones: str | Sequence[str] = "all",
    params: Mapping[str, Any] | None = None,
    progress: Progress = None,
) -> Index:
    """Train an index from labelled clips, as ``morec train`` does, with the same options and defaults.

    Parameters
    ----------
    clips : clips or paths
        Clips that the labels refer to, by name.
    labels : DataFrame, path, Table or list of spans
        Columns clip, class and start, stop (frames, stop exclusive) or start_secs, stop_secs, or neither: then the whole clip is
        one sample, with still ends trimmed. Optionally person. Spans are (clip, class, start_secs, stop_secs).
    people : dict, DataFrame or path, optional
        The person of each clip.
    background : clips, paths or names of clips, optional
        Clips without any class; they set the detection threshold.
    classes : sequence of str
        Learn only these classes, in this order.
    exclude : sequence of str
        Leave these clips out, by name.
    method : {"auto", "templates", "svrdm"}
        auto: each class as a gesture (matched elastically in time) or an activity (matched by windows), as its samples show;
        templates: every class as a gesture; svrdm: the method of the thesis of 2009.
    svrdm : {"tuned", "faithful"}
        The parameters of the method svrdm.
    unlabelled : {"background", "ignore"}
        Use of the unlabelled parts of labelled clips.
    everyday : {"auto", "always", "never"}
        Whether to use the built-in everyday motion as background (not with method svrdm); auto: only if background has less than
        1 minute.
    mirror : {"auto", "yes", "no"}
        Whether to train on mirrored copies of samples too (not with method svrdm). yes: all classes; auto: only between pairs of
        classes named for a side, such as wave_left and wave_right.
    one_sided : sequence of str
        With mirror yes: classes whose mirror image is another motion, which becomes a negative example.
    activities, gestures : sequence of str
        With method auto: classes that are activities or gestures, whatever their samples show.
    bones : str or sequence of str
        Body parts to use (not with method svrdm): all (for clips without a body: the hands), upper, arms, hand, left_hand, hands,
        body_and_hands, points3, or names of bones.
    params : dict, optional
        Parameters of the method by their path, as ``{"rho": 0.4, "decode.lag_ticks": 2}``.
    progress : bool or callable, optional

    Returns
    -------
    Index
        The trained index; see `Index.report`.

    Raises
    ------
    MorecError
        Clips and labels do not fit together, or there are too few samples.
    ValueError
        Labels or options are invalid.

    Warns
    -----
    MorecWarning
        For labels that were cut or left out, and clips that are not used.
    """
    material = _material(clips, labels, people, background, exclude)
    settings = _settings(
        classes, one_sided, activities, gestures, bones, params,
        method=method, svrdm=svrdm, unlabelled=unlabelled, everyday=everyday, mirror=mirror,
    )  # fmt: skip
    return _morec.train(material, settings, listener(progress))


def crossval(
    clips: Clips,
    labels: Labels,
    *,
    by: str = "person",
    people: People = None,
    background: Background = None,
    unknown: Background = None,
    classes: Sequence[str] = (),
    exclude: Sequence[str] = (),
    samples: int | None = None,
    perturb: Sequence[str] = (),
    sensitivities: Sequence[float] = (),
    seed: int = 1,
    method: str = "auto",
    svrdm: str = "tuned",
    unlabelled: str = "background",
    everyday: str = "always",
    mirror: str = "auto",
    one_sided: Sequence[str] = (),
    activities: Sequence[str] = (),
    gestures: Sequence[str] = (),
    bones: str | Sequence[str] = "all",
    params: Mapping[str, Any] | None = None,
    progress: Progress = None,
) -> Crossval:
    """Cross-validate: train without a part of the labels, recognise that part, and measure, as ``morec crossval`` does.

    Parameters
    ----------
    by : {"person", "clip", "half"}
        The part left out in turn; half: half of each class's samples.
    unknown : clips, paths or names of clips, optional
        Clips without any class: every detection in them is a false alarm.
    samples : int, optional
        Train on at most N samples per class, drawn evenly across people.
    perturb : sequence of str
        Also test copies degraded in one way each, such as ``"cam:1"``, ``"rate:30"``.
    sensitivities : sequence of float
        Also test at these rates of false alarms a minute.
    seed : int
        Seed of the split into halves.

    The other parameters are those of `train`.

    Returns
    -------
    Crossval
    """
    material = _material(clips, labels, people, background, exclude)
    material["unknown"] = _aside(unknown, material["clips"])
    settings = _settings(
        classes, one_sided, activities, gestures, bones, params,
        method=method, svrdm=svrdm, unlabelled=unlabelled, everyday=everyday, mirror=mirror,
    )  # fmt: skip
    how = {
        "by": by,
        "samples": samples,
        "perturb": list(perturb),
        "sensitivities": list(sensitivities),
        "seed": seed,
    }
    return _morec.crossval(material, settings, json.dumps(how), listener(progress))


def learning_curve(
    clips: Clips,
    labels: Labels,
    *,
    by: str = "person",
    people: People = None,
    background: Background = None,
    unknown: Background = None,
    classes: Sequence[str] = (),
    exclude: Sequence[str] = (),
    unlabelled: str = "background",
    everyday: str = "always",
    mirror: str = "auto",
    one_sided: Sequence[str] = (),
    activities: Sequence[str] = (),
    gestures: Sequence[str] = (),
    bones: str | Sequence[str] = "all",
    params: Mapping[str, Any] | None = None,
    progress: Progress = None,
) -> dict[str, Any]:
    """Measure what more samples and more people are worth; what ``morec crossval --curve --json`` prints.

    Cross-validates with 1, 2, 4 ... samples of each class and with 1, 2, 4 ... people, three draws each, and with all of them. Its
    parameters mean what they mean in `crossval`.

    Returns
    -------
    dict
        ``points`` (``samples``, ``people``, and ``draws`` with ``f1``, ``recall``, ``alarms_per_minute``, ``delay_secs``), and ``advice``:
        sentences.
    """
    material = _material(clips, labels, people, background, exclude)
    material["unknown"] = _aside(unknown, material["clips"])
    settings = _settings(
        classes, one_sided, activities, gestures, bones, params, unlabelled=unlabelled, everyday=everyday, mirror=mirror,
    )  # fmt: skip
    return _morec.learning_curve(material, settings, json.dumps({"by": by}), listener(progress))


def evaluate(
    truth: Labels,
    found: Found,
    clips: Lengths,
    *,
    unknown: Lengths = (),
    classes: Sequence[str] = (),
    index: Index | None = None,
) -> dict[str, Any]:
    """Measure detections against labels. Returns what ``morec evaluate --json`` prints.

    Parameters
    ----------
    truth : DataFrame, path, Table or list of spans
        Labels, as for `train`. In labelled clips, unlabelled motion counts as none of the classes.
    found : DataFrame, path, Table or rows
        Detections: clip, class, start_secs, stop_secs, and optionally score and reported_secs; a table file may give frames.
    clips : clips, paths, or dict of name to seconds
        The streams that were recognised. Streams without labels are left out.
    unknown : clips, paths, or dict of name to seconds
        Streams without any class: detections in them are counted separately.
    classes : sequence of str
        Classes that count; all by default.
    index : Index, optional
        The index that was used; ``missed`` then gives the reason for each missed sample. Requires `clips` to be clips.

    Returns
    -------
    dict

    Raises
    ------
    ValueError
        Nothing can be measured, or no label has one of the classes.

    Warns
    -----
    MorecWarning
        For labels, detections and clips that were left out.
    """
    if index is not None and isinstance(clips, Mapping):
        raise ValueError("index: samples that were missed are looked for in the motion; clips is a dict of lengths")
    return _morec.evaluate(
        label_rows(truth), _found_rows(found), _lengths(clips), _lengths(unknown), index, classes=list(classes)
    )


def agree(a: Labels, b: Labels, clips: Lengths, *, time_unit: float = 0.1) -> dict[str, Any]:
    """Measure how far two annotators agree; what ``morec agree --json`` prints.

    Parameters
    ----------
    a, b : DataFrame, path, Table or list of spans
        The labels of each annotator, as for `train`. Clips that only one of them labels are left out.
    clips : clips, paths, or dict of name to seconds
        The labelled clips, or their lengths.
    time_unit : float
        Length of the units of time of Cohen's kappa, seconds; kappa depends on it.

    Returns
    -------
    dict
        ``time`` (kappa), ``events`` (F1, corrected for chance, boundaries), ``classes``, ``confusion``.

    Raises
    ------
    ValueError
        No clip is labelled by both.
    """
    return _morec.agree(label_rows(a), label_rows(b), _lengths(clips), time_unit)


def budget(labels: Labels, clips: Lengths, *, people: People = None) -> dict[str, Any]:
    """Measure how much time each class takes; what ``morec budget --json`` prints.

    Parameters
    ----------
    labels : DataFrame, path, Table or list of spans
        Labels, as for `train`.
    clips : clips, paths, or dict of name to seconds
        The labelled clips, or their lengths. Those without labels do not count.
    people : optional
        The person of each clip, as for `train`.

    Returns
    -------
    dict
        ``classes`` and ``people`` (count, total and mean seconds, share of the clips' duration, labels a minute), and ``transitions``:
        how often a class follows another.
    """
    return _morec.budget(label_rows(labels), _lengths(clips), people_rows(people))


def _lengths(clips: Lengths) -> dict[str, float] | list[Clip]:
    if isinstance(clips, Mapping):
        return {str(name): float(secs) for name, secs in clips.items()}
    return as_clips(clips)


def _found_rows(found: Found) -> list[tuple[str, str, float, float, float | None, float | None]] | bytes:
    """Detections as rows, or the bytes of a table."""
    if isinstance(found, (str, os.PathLike)):
        with open(found, "rb") as file:
            return file.read()
    rows = found.to_dict("records") if hasattr(found, "to_dict") else found
    return [
        (
            str(row["clip"]),
            str(row["class"]),
            float(row["start_secs"]),
            float(row["stop_secs"]),
            _number(row.get("score")),
            _number(row.get("reported_secs")),
        )
        for row in rows
    ]


def _number(value: Any) -> float | None:
    # What a DataFrame lacks is not a number.
    return None if value is None or value != value else float(value)

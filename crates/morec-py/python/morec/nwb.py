"""NWB files of neuroscience: labels as bouts (ndx-ethogram), clips as poses (ndx-pose). Needs ``pip install './crates/morec-py[nwb]'``.

>>> import morec, morec.nwb
>>> nwbfile = pynwb.read_nwb("mouse.nwb")
>>> clips = morec.nwb.read_poses(nwbfile)
>>> morec.nwb.add_bouts(nwbfile, labels, clips[0])
"""

from __future__ import annotations

from typing import Any, Literal

import numpy as np
import numpy.typing as npt
from ndx_ethogram import Ethogram, EthogramBouts
from ndx_pose import PoseEstimation, PoseEstimationSeries, Skeleton, Skeletons

from ._files import Roles, roles_text
from ._labels import Labels, spans_in
from ._morec import Clip, __version__
from ._points import in_space

__all__ = ["add_bouts", "add_poses", "read_bouts", "read_poses"]


def add_bouts(
    nwbfile: Any,
    labels: Labels,
    clip: Clip,
    *,
    name: str = "bouts",
    labeling_method: Literal["manual", "automated", "curated"] = "manual",
    annotator: str | None = None,
    start_secs: float = 0.0,
) -> Any:
    """Add the labels of one clip to an NWB file: a row for each, in the module ``behavior``, and a catalogue of the classes.

    Parameters
    ----------
    nwbfile : pynwb.NWBFile
    labels : DataFrame, path, Table or list of spans
        Labels, as for `morec.train`; detections, too. Those of other clips are left out.
    clip : Clip
        The labelled clip, for its frame rate and length.
    name : str
        Name of the table; the catalogue is called ``<name>_ethogram``.
    labeling_method : {"manual", "automated", "curated"}
        ``"automated"`` for detections, ``"curated"`` for detections that were looked at.
    annotator : str, optional
        Who labelled.
    start_secs : float
        When the clip begins on the file's clock.

    Returns
    -------
    ndx_ethogram.EthogramBouts

    Raises
    ------
    ValueError
        No label is of this clip.
    """
    spans = sorted(spans_in(labels, clip), key=lambda span: (span[1], span[2]))
    if not spans:
        raise ValueError(f"labels: expected labels of the clip {clip.name}, found none")
    catalogue = Ethogram(name=f"{name}_ethogram", description=f"Classes of {name}.", exclusive=not _overlap(spans))
    for label in dict.fromkeys(label for label, _, _ in spans):
        catalogue.add_row(behavior=label, definition=label)
    who = {} if annotator is None else {"annotator": annotator}
    how = {} if labeling_method == "manual" else {"source_software": f"morec {__version__}"}
    bouts = EthogramBouts(
        name=name,
        description=f"Labels of the clip {clip.name}.",
        labeling_method=labeling_method,
        ethogram=catalogue,
        **who,
        **how,
    )
    for label, start, stop in spans:
        bouts.add_row(start_time=start_secs + start, stop_time=start_secs + stop, label=label)
    module = _behavior(nwbfile)
    module.add(catalogue)
    module.add(bouts)
    return bouts


def read_bouts(nwbfile: Any, clip: str, *, start_secs: float = 0.0) -> list[tuple[str, str, float, float]]:
    """The bouts of an NWB file as labels of a clip.

    Parameters
    ----------
    nwbfile : pynwb.NWBFile
    clip : str
        Name of the clip that they are labels of.
    start_secs : float
        When the clip begins on the file's clock; what lies before it is left out.

    Returns
    -------
    list of (clip, class, start_secs, stop_secs)
        In the order of their starts, of all tables of bouts in the file.
    """
    rows = []
    for table in _of_kind(nwbfile, EthogramBouts):
        bouts = zip(table["label"].data[:], table["start_time"].data[:], table["stop_time"].data[:])
        for label, start, stop in bouts:
            first, last = float(start) - start_secs, float(stop) - start_secs
            if last > 0.0:
                rows.append((clip, str(label), max(first, 0.0), last))
    return sorted(rows, key=lambda row: row[2:])


def add_poses(nwbfile: Any, clip: Clip, *, name: str | None = None, start_secs: float = 0.0) -> Any:
    """Add a clip to an NWB file: where its joints are, metres, Y up, in the module ``behavior``.

    Parameters
    ----------
    nwbfile : pynwb.NWBFile
    clip : Clip
    name : str, optional
        Name of the poses; the clip's by default.
    start_secs : float
        When the clip begins on the file's clock.

    Returns
    -------
    ndx_pose.PoseEstimation
    """
    name = clip.name if name is None else name
    module = _behavior(nwbfile)
    edges = [(joint, parent) for joint, parent in enumerate(clip.parents) if parent >= 0]
    links = {"edges": np.array(edges, dtype="uint8")} if edges and len(clip.names) < 256 else {}
    skeleton = Skeleton(name=f"{name}_skeleton", nodes=list(clip.names), **links)
    if "Skeletons" not in module.data_interfaces:
        module.add(Skeletons(name="Skeletons"))
    module["Skeletons"].add_skeletons(skeleton)
    series = [
        PoseEstimationSeries(
            name=joint,
            description=f"Position of {joint}.",
            data=clip.positions[:, number],
            unit="meters",
            reference_frame="A point on the floor; Y is up.",
            starting_time=start_secs,
            rate=float(clip.rate_hz),
            confidence=np.where(np.isnan(clip.positions[:, number]).any(axis=1), 0.0, 1.0),
            confidence_definition="1 where the position is known.",
        )
        for number, joint in enumerate(clip.names)
    ]
    poses = PoseEstimation(
        name=name,
        pose_estimation_series=series,
        description=f"The clip {clip.name}.",
        source_software="morec",
        source_software_version=__version__,
        skeleton=skeleton,
    )
    module.add(poses)
    return poses


def read_poses(
    nwbfile: Any,
    *,
    least_confidence: float = 0.0,
    up: str | None = None,
    roles: Roles = None,
) -> list[Clip]:
    """The poses of an NWB file as clips: one for each performer, called as the poses are.

    Parameters
    ----------
    nwbfile : pynwb.NWBFile
    least_confidence : float
        Points of a lower confidence are unknown.
    up : {"x", "y", "z", "-x", "-y", "-z"}, optional
        Which way is up; inferred by default.
    roles : dict, path or str, optional
        Points that play parts of the body, where names do not tell. Points in two dimensions need them, of a custom skeleton.

    Raises
    ------
    ValueError
        No poses in the file; points of one performer at different times; points in two dimensions without `roles`.
    """
    clips = [_clip(poses, least_confidence, up, roles) for poses in _of_kind(nwbfile, PoseEstimation)]
    if not clips:
        raise ValueError("expected poses of ndx-pose in the file, found none")
    return clips


def _clip(poses: Any, least_confidence: float, up: str | None, roles: Roles) -> Clip:
    series = list(poses.pose_estimation_series.values())
    points = [_points(one, least_confidence) for one in series]
    points = [in_space(point, str(poses.name), roles) for point in points]
    lengths = {len(point) for point in points}
    if len(lengths) != 1:
        raise ValueError(f"{poses.name}: expected points with as many frames each, found {sorted(lengths)}")
    return Clip.from_positions(
        np.stack(points, axis=1),
        [str(one.name) for one in series],
        _rate(series[0]),
        name=str(poses.name),
        unit=1.0 if series[0].unit in ("meters", "metres", "m") else None,
        up=up,
        roles=roles_text(roles),
    )


def _points(series: Any, least_confidence: float) -> npt.NDArray[np.float64]:
    points = np.array(series.data[:], dtype=np.float64) * float(series.conversion or 1.0)
    if series.confidence is not None:
        points[np.asarray(series.confidence[:]) < least_confidence] = np.nan
    return points


def _rate(series: Any) -> float:
    if series.rate is not None:
        return float(series.rate)
    times = np.asarray(series.timestamps[:], dtype=np.float64)
    if len(times) < 2 or not times[-1] > times[0]:
        raise ValueError(f"{series.name}: expected times that grow, found {len(times)} times")
    return float((len(times) - 1) / (times[-1] - times[0]))


def _of_kind(nwbfile: Any, kind: Any) -> list[Any]:
    return [found for found in nwbfile.objects.values() if isinstance(found, kind)]


def _behavior(nwbfile: Any) -> Any:
    if "behavior" in nwbfile.processing:
        return nwbfile.processing["behavior"]
    return nwbfile.create_processing_module(name="behavior", description="Motion and its labels.")


def _overlap(spans: list[tuple[str, float, float]]) -> bool:
    return any(later[1] < earlier[2] for earlier, later in zip(spans, spans[1:]))

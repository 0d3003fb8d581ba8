"""The native part of the package."""

import os
from collections.abc import Callable, Sequence
from types import TracebackType
from typing import Any, Literal

import numpy as np
import numpy.typing as npt

from ._files import Clips
from ._tables import Table

__version__: str
ROLES: list[str]
"""Parts of the body, in the order in which arrays have them."""

_Path = str | os.PathLike[str]
_Progress = Callable[[str, int, int], None] | None
_Roles = dict[str, str | None] | str | None
_Array = npt.NDArray[np.float64]

class MorecError(Exception):
    """An unusable file, label, motion or setting; the message says where and what was expected."""

class MorecWarning(UserWarning):
    """Input was repaired, left out or is doubtful; the result is returned nevertheless."""

class Clip:
    """A motion-capture clip in metres, Y up: a skeleton, its frames, and the body parts of its joints (roles).

    ``len(clip)`` is the number of frames; ``clip[1.0:2.5]`` is the stretch from second 1 to second 2.5. Clips do not
    change; threads may share them, and they can be pickled.

    Examples
    --------
    >>> clip = morec.read("walk.bvh")
    >>> clip.positions[:, clip.roles["left_hand"]]      # metres, shape (frames, 3)
    """

    @staticmethod
    def from_positions(
        positions: npt.ArrayLike,
        names: Sequence[str],
        rate_hz: float,
        *,
        name: str = "clip",
        unit: float | None = None,
        up: str | None = None,
        roles: _Roles = None,
    ) -> Clip:
        """Make a clip of points from the positions of one performer's joints or landmarks, frame by frame.

        Parameters
        ----------
        positions : array, shape (frames, joints, 3)
            NaN where a point is missing: short gaps are filled, long gaps stay unknown.
        names : sequence of str
            Names of the points. Body parts are inferred from the names of published sets (MediaPipe, COCO, Kinect, marker sets)
            and from usual joint names.
        rate_hz : float
            Frames a second.
        name : str
            Name of the clip, by which labels refer to it.
        unit : float, optional
            Metres in the unit of `positions`; inferred by default.
        up : {"x", "y", "z", "-x", "-y", "-z"}, optional
            Up axis of `positions`; inferred by default.
        roles : dict, optional
            ``{"left_hand": "LWrist", "hips": "LHip+RHip"}``: points of body parts that the names do not identify.

        Raises
        ------
        ValueError
            The array has another shape, or the rate is not above 0.
        MorecError
            All positions are NaN.
        """
    @property
    def name(self) -> str:
        """Name of the clip: its file's stem, by default."""
    @property
    def path(self) -> os.PathLike[str] | None:
        """The file that the clip was read from, or None."""
    @property
    def format(self) -> str:
        """The file's format, ``"bvh"``; empty for clips that come from no file."""
    @property
    def rate_hz(self) -> float:
        """Frames a second."""
    @property
    def frames(self) -> int:
        """Number of frames."""
    @property
    def duration_secs(self) -> float:
        """Length in seconds: frames over rate."""
    @property
    def names(self) -> list[str]:
        """Names of the joints, parents first."""
    @property
    def parents(self) -> npt.NDArray[np.int64]:
        """Index of each joint's parent, -1 for a root; shape (joints,)."""
    @property
    def offsets(self) -> _Array:
        """Rest position of each joint in its parent's frame, metres; shape (joints, 3)."""
    @property
    def roles(self) -> dict[str, int]:
        """Index of the joint of each body part that was found."""
    @property
    def warnings(self) -> list[str]:
        """Repairs and doubts of reading, one sentence each, with the place in the file."""
    @property
    def facts(self) -> dict[str, Any]:
        """Inferred properties: up axis and unit of the file, body height, rest pose, doubts (``notes``)."""
    @property
    def rest_frames(self) -> int:
        """Number of frames at the start that show a rest pose instead of the motion."""
    @property
    def has_rotations(self) -> bool:
        """Whether joints have rotations; a clip of points has positions only."""
    @property
    def positions(self) -> _Array:
        """Position of each joint in the world, metres, Y up; shape (frames, joints, 3), read-only. Computed once."""
    @property
    def rotations(self) -> _Array | None:
        """Rotation of each joint in its parent's frame, quaternions x, y, z, w; shape (frames, joints, 4), read-only.

        None for a clip of points.
        """
    def resampled(self, rate_hz: float) -> Clip:
        """The same motion resampled to another rate, frames a second."""
    def renamed(self, name: str) -> Clip:
        """The same clip with another name, by which labels refer to it."""
    def save(self, path: _Path) -> None:
        """Write the clip in the format of the extension: .bvh, .mclip, or points as .trc, .c3d, .jsonl."""
    def __len__(self) -> int: ...
    def __getitem__(self, secs: slice, /) -> Clip: ...

class Index:
    """A trained model that recognises motions; immutable, stored in one file.

    Returned by `morec.train` and `morec.load`. Threads may share it, and it can be pickled.
    """

    @staticmethod
    def from_bytes(bytes: bytes) -> Index:
        """Read an index from the bytes of its file. Raises MorecError if they are not an index."""
    def to_bytes(self) -> bytes:
        """The bytes of the index file."""
    def part(self, part: int, of: int) -> Index:
        """Part ``part`` (from 0) of ``of`` parts: the templates of every ``of``-th class, for one of several machines.

        `morec.archive.Archive.recognize` divides an index into such parts and combines their matches.

        Raises
        ------
        ValueError
            The part does not exist, or the index was trained by the method svrdm.
        """
    def save(self, path: _Path) -> None:
        """Write the index file, whole or not at all."""
    def recognize(
        self,
        clips: Clips,
        *,
        sensitivity: float | None = None,
        performer: Literal["auto", "teacher", "anyone"] | None = None,
        deviation: bool = False,
        progress: _Progress = None,
    ) -> Table:
        """Recognise motions in clips, frame by frame as in a live stream.

        Parameters
        ----------
        clips : clip, path, or several
            Several are recognised in parallel.
        sensitivity : float, optional
            Accepted false alarms a minute in background motion: 0.1 is strict, 1 is generous. As trained by default.
        performer : {"auto", "teacher", "anyone"}, optional
            The expected performer. "auto" (default): from the fourth report on, the score threshold rises to half of the performer's
            recent scores; "teacher": it is raised from the first frame, by the scores of the training samples; "anyone": it is
            never raised.
        deviation : bool
            Whether to compare each motion with the nearest sample.
        progress : callable, optional

        Returns
        -------
        Table
            Columns clip, class, start_secs, stop_secs, score, reported_secs; for activities also repetitions and period_secs
            (None if nothing is counted). With `deviation` also deviation: a
            dict of off_degrees (mean angle off the nearest sample), pace (duration over its), bones (each with off_degrees,
            worst_degrees, worst_secs; the farthest off first) and over_time_degrees; None for activities and held poses.

            score: Probability that the detection is right, 0 to 1. The lowest accepted score is 0.05 to 0.44, depending on the
            index. For held poses and indexes without calibration (svrdm, older files) it is the similarity to a sample
            instead.

        Warns
        -----
        MorecWarning
            For clips that lack bones of the index; these bones are not used.
        """
    def recognizer(
        self,
        joints: Clip | Sequence[str],
        *,
        roles: _Roles = None,
        up: str = "y",
        sensitivity: float | None = None,
        performer: Literal["auto", "teacher", "anyone"] = "auto",
        tentative: bool = False,
        each_repetition: bool = False,
        deviation: bool = False,
        progress: bool = False,
        refractory_secs: float = 0.0,
    ) -> Recognizer:
        """A recogniser for a live stream of joint positions.

        Parameters
        ----------
        joints : sequence of str, or Clip
            Names of the rows of a pose: points of a published set, usual joint names, or `morec.ROLES`; or a clip with these
            joints.
        roles : dict, optional
            ``{"left_hand": "LWrist", "hips": "LHip+RHip"}``: points of body parts that the names do not identify.
        up : {"x", "y", "z", "-x", "-y", "-z"}
            Up axis of the stream. The unit of length does not matter.
        sensitivity : float, optional
            As in `recognize`.
        performer : {"auto", "teacher", "anyone"}
            As in `recognize`.
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

        Raises
        ------
        ValueError
            The names identify no body part, or an option is invalid.
        MorecError
            The index needs joint rotations, or has no bone in common with the joints.
        """
    def classify(self, clips: Clips) -> list[dict[str, Any]]:
        """Classify whole clips that contain one motion each; `recognize` finds motions in longer clips.

        For the method ``templates`` only.

        Returns
        -------
        list of dict
            One for each clip: ``clip``; ``class``, None if no class is more probable than all alternatives together; its
            ``probability``; ``nearest``, the class of the nearest samples, None if nothing moves; and ``probabilities`` by class,
            of which the rest to 1 is the probability that the motion is none of the classes.
        """
    @property
    def classes(self) -> list[dict[str, Any]]:
        """The classes, each with its name, number of samples and number of people."""
    @property
    def class_names(self) -> list[str]:
        """Names of the classes, in order."""
    @property
    def method(self) -> str:
        """``"templates"`` or ``"svrdm"``."""
    @property
    def provenance(self) -> dict[str, Any]:
        """Origin of the index: date, version, clips, samples, background."""
    @property
    def report(self) -> dict[str, Any] | None:
        """Report of the training; None for a loaded index."""

class Recognizer:
    """Recognises motions in one performer's stream of joint positions. Returned by `Index.recognizer`.

    Any thread may push; simultaneous calls wait for each other.
    """

    @property
    def joints(self) -> list[str]:
        """Names of the points of a pose, in the order of its rows."""
    @property
    def latency_secs(self) -> float:
        """Shortest time from the end of a motion to its report, seconds."""
    def push(self, time_secs: float, positions: npt.ArrayLike) -> list[dict[str, Any]]:
        """Process one pose.

        Parameters
        ----------
        time_secs : float
            Time of the pose on the stream's clock. Any rate, even an irregular one, is accepted; late and duplicate poses are
            ignored. After a gap of more than 0.5 s the stream starts again.
        positions : array, shape (joints, 3)
            NaN where a joint is unknown. float64 and float32 are read in place.

        Returns
        -------
        list of dict
            The events that this pose causes, usually none, with the keys of the events of `morec.listen`. Events of the phase end
            are final.
        """
    def push_all(self, times_secs: npt.ArrayLike, positions: npt.ArrayLike) -> list[dict[str, Any]]:
        """Process many poses, while other Python threads run. The events are the same as from single calls of `push`.

        Parameters
        ----------
        times_secs : array, shape (frames,)
        positions : array, shape (frames, joints, 3)
        """
    def finish(self) -> list[dict[str, Any]]:
        """End the stream and return its last events. The next push starts a new stream."""
    def diagnosis(self) -> list[str]:
        """Problems of the stream in the last seconds, one sentence each with severity and remedy."""

class LiveSession:
    def __init__(
        self, address: str, index: Index, actors: int, mirror: bool, options: dict[str, Any], /
    ) -> None: ...
    @property
    def address(self) -> str: ...
    def wait(self, secs: float, /) -> dict[str, Any] | None: ...
    def notices(self) -> list[str]: ...
    def is_ended(self) -> bool: ...
    def status(self) -> dict[str, Any]: ...
    def close(self) -> None: ...

class Crossval:
    """Measures of a cross-validation. Returned by `morec.crossval`."""

    @property
    def evaluation(self) -> dict[str, Any]:
        """Every measure, as ``morec crossval --json`` prints them."""
    @property
    def left_out(self) -> str:
        """What each training leaves out, in words: "each person in turn, 3 people"."""
    @property
    def accuracy(self) -> float | None:
        """Accuracy as defined in the thesis; None without decisions."""
    @property
    def f1(self) -> float | None:
        """F1 at half overlap."""
    @property
    def perturbed(self) -> dict[str, dict[str, Any]]:
        """Measures of each perturbation."""
    @property
    def sensitivities(self) -> dict[float, dict[str, Any]]:
        """Measures at each rate of false alarms a minute."""
    @property
    def missed(self) -> list[dict[str, Any]]:
        """Missed samples, each with the reason."""
    @property
    def folds(self) -> list[dict[str, Any]]:
        """The folds, each with the part left out and its training report."""
    @property
    def found(self) -> Table:
        """All detections: clip, class, start_secs, stop_secs, score, reported_secs."""
    @property
    def truth(self) -> Table:
        """All labels: clip, class, start_secs, stop_secs."""
    def report(self, path: _Path, *, title: str = "Cross-validation") -> None:
        """Write the report, one HTML file without outside links."""

class Database:
    """A motion database: clips, cuts, classes and labels in one SQLite file, as used by ``morec db``.

    One program can write at a time, any number can read. Use the object as a context manager, or call `close`.

    Parameters
    ----------
    path : path
    create : bool
        Create the file if it does not exist.
    """

    def __init__(self, path: _Path, *, create: bool = False) -> None: ...
    @property
    def path(self) -> os.PathLike[str]: ...
    def close(self) -> None:
        """Close the file; every other method then raises ValueError."""
    def summary(self) -> dict[str, Any]:
        """Numbers of clips, labels, cuts and indexes, and sizes in bytes."""
    def import_files(
        self,
        paths: _Path | Sequence[_Path],
        *,
        source: str | None = None,
        licence: str | None = None,
        subject: str | None = None,
        tags: Sequence[str] = (),
        progress: _Progress = None,
    ) -> Table:
        """Import the clips of files and folders, in parallel.

        Clips that the database contains already are recognised by their content.

        Returns
        -------
        Table
            Columns path, outcome (imported, known, copy, refused), clips, and notes: repairs, doubts, the reason of a refusal,
            near-duplicates.
        """
    def clips(
        self,
        name: str | None = None,
        *,
        subject: str | None = None,
        tag: str | None = None,
        class_name: str | None = None,
    ) -> Table:
        """List clips by name (``*`` any text, ``?`` one character), subject, tag, or class of their labels."""
    def clip(self, name: str) -> Clip:
        """Read a clip. Its rotations and positions differ from the file's at most by the bounds in `summary`, usually
        0.5 degrees and 5 mm."""
    def labels(
        self, *, state: str | None = "accepted", clip: str | None = None, class_name: str | None = None
    ) -> Table:
        """List the labels with this state ("accepted", "proposed", "rejected"; None for all).

        Returns
        -------
        Table
            Columns clip, class, start_secs, stop_secs, person, whole_clip, state, score, annotators (a list of names), set_by. `morec.train` takes it.
        """
    def label(self, labels: Any, *, state: str = "accepted", by: str = "user") -> dict[str, int]:
        """Add labels, given as in `morec.train`, all or none. Returns the numbers of added, changed and unchanged labels."""
    def search(
        self,
        example: Clip | _Path,
        start: float = 0.0,
        stop: float | None = None,
        *,
        mirror: bool = False,
        limit: int = 20,
        one_a_clip: bool = False,
        learned: bool = False,
        classes: Sequence[str] = (),
        warp_share: float = 0.0,
    ) -> Table:
        """Segments similar to an example, most similar first; what ``morec db search`` finds.

        Parameters
        ----------
        example : Clip, name of a clip in the database, or os.PathLike
        start, stop : float
            The stretch of the example, seconds.
        mirror : bool
            Also find motions like the example's mirror image.
        limit : int
        one_a_clip : bool
            Only the best hit of each clip.
        learned : bool
            Learn from accepted samples which differences matter; needs at least two classes with two samples each.
        classes : sequence of str
            Learn from these classes only.
        warp_share : float
            Weight of the exact path against the summary of poses and pace, 0 to 1.

        Returns
        -------
        Table
            Columns clip, start_secs, stop_secs, score, warp_distance, mirrored.
        """
    def cut(
        self,
        name: str | None = None,
        *,
        method: str = "kernel",
        window: float | None = None,
        penalty: float | None = None,
        least: float | None = None,
        rise: float | None = None,
        quality: float | None = None,
        direction: str = "both",
        progress: _Progress = None,
    ) -> Table:
        """Cut clips where their behaviour changes, and store the cuts, as ``morec cut`` does.

        Returns
        -------
        Table
            Columns clip, secs, cuts_secs, still.
        """
    def group(
        self,
        *,
        of: str | None = None,
        classes: Sequence[str] = (),
        method: str = "affinity",
        preference: float | None = None,
        groups: int | None = None,
        height: float | None = None,
        tau: float | None = None,
        k: int | None = None,
        normalised: bool = False,
        centre: str = "database",
        quality: float | None = None,
        dims: int | None = None,
        divide: Sequence[int] = (),
        join: Sequence[int] = (),
        progress: _Progress = None,
    ) -> Table:
        """Group similar stretches, largest group first, as ``morec group`` does.

        Parameters
        ----------
        of : "cuts" (the default), "labels" or "clips"
        method : "affinity", "hierarchy" (cut into ``groups``, or at a ``height``), "kwas" or "tree" (of single samples)
        divide, join : numbers of groups of the hierarchy or the tree that go one step down, or up

        Returns
        -------
        Table
            Columns group (from 1), clip, class (of labels), start_secs, stop_secs.
        """
    def propose(self, *, classes: Sequence[str] = (), progress: _Progress = None) -> Table:
        """Propose more samples of the labelled classes, most probable first, and store them in the state proposed.

        Returns
        -------
        Table
            Columns clip, class, start_secs, stop_secs, score.
        """
    def judge(
        self, *, accept: float | None = None, reject: float | None = None, classes: Sequence[str] = ()
    ) -> tuple[int, int]:
        """Accept proposals with a score of at least ``accept`` and reject proposals below ``reject``. Returns both numbers."""
    def __enter__(self) -> Database: ...
    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None, /
    ) -> None: ...

def load(path: _Path) -> Index:
    """Open an index file.

    Raises
    ------
    FileNotFoundError
        The file does not exist.
    MorecError
        The file is not an index, is damaged, or was written by a later release.
    """

def read_path(path: str, options: dict[str, Any], /) -> list[Clip]: ...
def read_bytes(bytes: bytes, name: str, options: dict[str, Any], /) -> list[Clip]: ...
def read_folder(
    paths: list[str], options: dict[str, Any], progress: _Progress = None, /
) -> tuple[list[Clip], list[str]]: ...
def features(clip: Clip, bones: list[str] | None = None, /) -> tuple[npt.NDArray[np.float32], list[str], list[str], float]: ...
def key_positions(clip: Clip, /) -> _Array: ...
def resolve_labels(clip: Clip, labels: Any, /) -> list[tuple[str, float, float]]: ...
def train(material: dict[str, Any], settings: str, progress: _Progress, /) -> Index: ...
def crossval(material: dict[str, Any], train: str, how: str, progress: _Progress, /) -> Crossval: ...
def learning_curve(material: dict[str, Any], train: str, how: str, progress: _Progress, /) -> dict[str, Any]: ...
def evaluate(
    truth: Any, found: Any, clips: Any, unknown: Any, index: Index | None, /, **settings: list[str]
) -> dict[str, Any]: ...
def agree(a: Any, b: Any, clips: Any, time_unit: float, /) -> dict[str, Any]: ...
def budget(labels: Any, clips: Any, people: Any, /) -> dict[str, Any]: ...
def discover(clips: list[Clip], progress: _Progress = None, /, **settings: bool) -> Table: ...
def discover_stored(database: Database, clip: str | None = None, progress: _Progress = None, /, **settings: bool) -> Table: ...
def cut(clip: Clip, /, **settings: str | float | None) -> dict[str, _Array]: ...
def synth_database(
    seed: int,
    people: int,
    streams: int,
    repetitions: int,
    classes: list[str] | None,
    unknown_share: float,
    left_handed: bool,
    rate_hz: float,
    /,
) -> list[tuple[Clip, list[tuple[str, float, float]], str]]: ...
def synth_everyday(seed: int, clips: int, /) -> list[Clip]: ...
def synth_motions() -> list[str]: ...
def rows_of_table(bytes: bytes, /) -> list[Any]: ...

class SearchExample: ...

class SearchPart:
    def __init__(self, clips: list[tuple[int, int, bytes]], /) -> None: ...
    def example(self, clip: int, start: float, stop: float, /) -> SearchExample: ...
    def nearest(
        self, example: SearchExample, limit: int, mirror: bool, one_a_clip: bool, /
    ) -> list[tuple[int, float]]: ...
    @property
    def ticks(self) -> int: ...

class SketchedClips:
    def __init__(
        self, tables: list[tuple[npt.NDArray[np.int64], npt.NDArray[np.int32], npt.NDArray[np.uint8]]], few: int, /
    ) -> None: ...
    def __len__(self) -> int: ...

class SearchPlan:
    def __init__(
        self, clips: SketchedClips, example: SearchExample, limit: int, mirror: bool, one_a_clip: bool, /
    ) -> None: ...
    def next_to_read(self, exact: bool, /) -> npt.NDArray[np.int64]: ...
    def take(self, clips: list[tuple[int, int, bytes]], /) -> None: ...
    def hits(self) -> list[tuple[int, float, float, float, float, bool]]: ...

def rows_packed(rows: npt.NDArray[np.float32], /) -> bytes: ...
def sketch_kept(clips: list[tuple[int, bytes]], /) -> list[bytes | None]: ...
def search_windows(limit: int, /) -> int: ...
def search_example(clip: Clip, start: float, stop: float | None = None, /) -> SearchExample: ...
def keep_file(path: str, bytes: bytes, options: dict[str, Any], /) -> list[dict[str, Any]]: ...
def kept_of_database(path: str, /) -> list[dict[str, Any]]: ...
def kept_to_database(path: str, rows: list[dict[str, Any]], /) -> int: ...
def names_in_database(path: str, /) -> list[tuple[bytes, int, str]]: ...
def kept_clip(name: str, motion: bytes, roles: str, rest_frames: int, facts: str, /) -> Clip: ...
def recognize_kept(index: Index, clips: list[tuple[bytes | None, str | None, int | None]], /) -> list[Any]: ...
def match_kept(part: Index, clips: list[tuple[bytes | None, str | None, int | None]], /) -> list[bytes | str]: ...
def recognize_matched_kept(
    first: Index, clips: list[tuple[tuple[bytes | None, str | None, int | None], list[bytes]]], /
) -> list[Any]: ...
def index_from_bytes(bytes: bytes, /) -> Index: ...
def cut_kept(
    bones: int, rows: bytes, window: float | None = None, penalty: float | None = None, least: float | None = None, /
) -> list[float]: ...
def rows_kept(bones: int, rows: bytes, /) -> npt.NDArray[np.float32]: ...
def present_recipe() -> str: ...

"""Clips from files, bytes and open files."""

from __future__ import annotations

import os
import warnings
from collections.abc import Iterable, Mapping
from typing import IO, Any, Union

from . import _morec
from ._morec import Clip, MorecError, MorecWarning
from ._progress import Progress, listener

#: A path, the bytes of a file, or a file open for reading bytes.
Source = Union[str, "os.PathLike[str]", bytes, bytearray, memoryview, IO[bytes]]
#: For each part of the body the joint that plays it, ``"A+B"`` for the middle of two, ``None`` for nobody; or the path of
#: a roles file.
Roles = Union[Mapping[str, Union[str, None]], str, "os.PathLike[str]", None]
#: Clips, or paths of clips and folders.
Clips = Union[Clip, str, "os.PathLike[str]", Iterable[Union[Clip, str, "os.PathLike[str]"]]]


def roles_text(roles: Roles) -> dict[str, str | None] | str | None:
    """Roles in the native module's form: a dictionary, or the text of a roles file."""
    if roles is None:
        return None
    if isinstance(roles, Mapping):
        return dict(roles)
    with open(roles, encoding="utf-8-sig") as file:
        return file.read()


def _options(**options: Any) -> dict[str, Any]:
    options["roles"] = roles_text(options["roles"])
    if options["skeleton"] is not None:
        options["skeleton"] = os.fspath(options["skeleton"])
    return {name: value for name, value in options.items() if value is not None}


def read_all(
    file: Source,
    *,
    name: str | None = None,
    skeleton: str | os.PathLike[str] | None = None,
    file_rate: float | None = None,
    positions: str | None = None,
    up: str | None = None,
    unit: float | None = None,
    roles: Roles = None,
) -> list[Clip]:
    """Read all clips in a file, one for each performer.

    Parameters are those of `read`.
    """
    options = _options(
        skeleton=skeleton, file_rate=file_rate, positions=positions, up=up, unit=unit, roles=roles
    )
    if isinstance(file, (str, os.PathLike)):
        clips = _morec.read_path(os.fspath(file), options)
    else:
        content = bytes(file) if isinstance(file, (bytes, bytearray, memoryview)) else file.read()
        if not isinstance(content, bytes):
            raise TypeError("expected a file open for reading bytes: open(path, 'rb')")
        clips = _morec.read_bytes(content, name or _name_of(file), options)
    if name is not None and len(clips) == 1:
        clips = [clips[0].renamed(os.path.splitext(os.path.basename(name))[0])]
    return clips


def read(
    file: Source,
    *,
    name: str | None = None,
    skeleton: str | os.PathLike[str] | None = None,
    file_rate: float | None = None,
    positions: str | None = None,
    up: str | None = None,
    unit: float | None = None,
    roles: Roles = None,
) -> Clip:
    """Read a clip in any supported format.

    Units, axes and body parts are inferred from the motion; see `Clip.facts`.

    Parameters
    ----------
    file : path, bytes or file object
        ``FILE#2`` and ``FILE#name`` are one clip of a file with several.
    name : str, optional
        Name of the clip; for bytes also the file name, whose extension may indicate the format.
    skeleton : path, optional
        The ASF skeleton of an AMC clip; by default the skeleton in the clip's folder or the folders above.
    file_rate : float, optional
        Frames a second; replaces the file's rate.
    positions : {"replace", "add"}, optional
        Meaning of BVH position channels below the root; inferred by default.
    up : {"x", "y", "z", "-x", "-y", "-z"}, optional
        Up axis of the file; inferred by default.
    unit : float, optional
        Metres in the file's unit of length; inferred by default.
    roles : dict or path, optional
        Joints of body parts, where inference fails: ``{"left_hand": "LWrist", "hips": "LHip+RHip"}``.

    Returns
    -------
    Clip

    Raises
    ------
    FileNotFoundError
        The file does not exist.
    MorecError
        The file is invalid (the message says where), or contains several clips (see `read_all`).
    """
    clips = read_all(
        file,
        name=name,
        skeleton=skeleton,
        file_rate=file_rate,
        positions=positions,
        up=up,
        unit=unit,
        roles=roles,
    )
    if len(clips) == 1:
        return clips[0]
    shown = file if isinstance(file, (str, os.PathLike)) else name or "bytes"
    found = ", ".join(clip.name for clip in clips) or "none"
    raise MorecError(f"{shown}: expected one clip, found {len(clips)} ({found}); morec.read_all reads all")


def read_folder(
    folder: str | os.PathLike[str] | Iterable[str | os.PathLike[str]],
    *,
    skeleton: str | os.PathLike[str] | None = None,
    file_rate: float | None = None,
    positions: str | None = None,
    up: str | None = None,
    unit: float | None = None,
    roles: Roles = None,
    progress: Progress = None,
) -> list[Clip]:
    """Read all clips in a folder and its subfolders, in parallel.

    Unreadable files are left out, with one `MorecWarning` each.

    Parameters
    ----------
    folder : path or iterable of paths
        Folders and files.
    progress : bool or callable, optional
        True: a progress bar; False: none; or a function ``progress(stage, done, total)``. By default a bar in terminals and
        notebooks.

    Returns
    -------
    list of Clip
        In the order of their paths.
    """
    paths = [folder] if isinstance(folder, (str, os.PathLike)) else list(folder)
    options = _options(
        skeleton=skeleton, file_rate=file_rate, positions=positions, up=up, unit=unit, roles=roles
    )
    clips, left_out = _morec.read_folder([os.fspath(path) for path in paths], options, listener(progress))
    for reason in left_out:
        warnings.warn(f"left out: {reason}", MorecWarning, stacklevel=2)
    return clips


def as_clips(clips: Clips) -> list[Clip]:
    """Clips as a list; paths are read."""
    if isinstance(clips, Clip):
        return [clips]
    if isinstance(clips, (str, os.PathLike)):
        return read_folder(clips, progress=False)
    given = list(clips)
    for clip in given:
        if not isinstance(clip, (Clip, str, os.PathLike)):
            raise TypeError(f"expected clips or paths of clips, found {type(clip).__name__}")
    paths = [clip for clip in given if not isinstance(clip, Clip)]
    if not paths:
        return [clip for clip in given if isinstance(clip, Clip)]
    read: list[Clip] = []
    for clip in given:
        read.extend([clip] if isinstance(clip, Clip) else read_folder(clip, progress=False))
    return read


def _name_of(file: object) -> str:
    name = getattr(file, "name", None)
    return os.path.basename(name) if isinstance(name, str) else "clip"

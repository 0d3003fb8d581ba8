"""Index a motion-capture database, recognise its motions live.

>>> import morec
>>> clips, labels = morec.synth.database(people=3, classes=["wave", "bow"])
>>> index = morec.train(clips, labels, everyday="never")
>>> found = index.recognize(clips[0])

Times are seconds, lengths metres, Y is up; ranges are half-open.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from . import plot, synth
from ._discover import discover
from ._files import read, read_all, read_folder
from ._drawing import animation
from ._learn import agree, budget, crossval, evaluate, learning_curve, train
from ._live import listen
from ._morec import (
    ROLES,
    Clip,
    Crossval,
    Database,
    Index,
    MorecError,
    MorecWarning,
    Recognizer,
    __version__,
    load,
)
from ._rows import Features, Windows, cut, features, normalize, windows
from ._tables import Table
from ._webcam import WEBCAM_POINTS, webcam

if TYPE_CHECKING:
    from .sklearn import MotionClassifier

__all__ = [
    "ROLES",
    "Clip",
    "Crossval",
    "Database",
    "Features",
    "Index",
    "MorecError",
    "MorecWarning",
    "MotionClassifier",
    "Recognizer",
    "Table",
    "WEBCAM_POINTS",
    "Windows",
    "__version__",
    "agree",
    "animation",
    "budget",
    "crossval",
    "cut",
    "discover",
    "evaluate",
    "features",
    "learning_curve",
    "listen",
    "load",
    "normalize",
    "plot",
    "read",
    "read_all",
    "read_folder",
    "synth",
    "train",
    "webcam",
    "windows",
]


def __getattr__(name: str) -> object:
    # scikit-learn takes a second to import, and not everybody has it.
    if name == "MotionClassifier":
        from .sklearn import MotionClassifier

        return MotionClassifier
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")

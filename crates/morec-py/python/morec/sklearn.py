"""A classifier for scikit-learn (needs scikit-learn)."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any

import numpy as np
import numpy.typing as npt
from sklearn.base import BaseEstimator, ClassifierMixin
from sklearn.utils.validation import check_is_fitted

from ._files import as_clips
from ._learn import train
from ._morec import Clip, Index

__all__ = ["MotionClassifier"]


class MotionClassifier(ClassifierMixin, BaseEstimator):  # type: ignore[misc]
    """Classify clips, or stretches of clips, with morec's templates and the interface of scikit-learn.

    Parameters
    ----------
    joints : sequence of str, optional
        Names of the points, if samples are arrays; see `Clip.from_positions`. By default ``morec.ROLES``, or only its body parts
        if the arrays have as many points.
    rate_hz : float
        Frames a second of arrays.
    up : str, optional
        Up axis of arrays; inferred by default.
    everyday : {"never", "auto", "always"}
        Whether to use built-in everyday motion as background, from which rejection is learned.
    reject : bool
        Predict ``rejected`` if none of the classes is more probable than the nearest class.
    rejected : str
        The label that is predicted then.
    params : dict, optional
        Parameters of the method, as in `morec.train`.

    Attributes
    ----------
    classes_ : ndarray
    index_ : Index

    Examples
    --------
    >>> model = morec.MotionClassifier().fit(clips, names)
    >>> model.predict_proba(others)
    """

    def __init__(
        self,
        joints: Sequence[str] | None = None,
        rate_hz: float = 30.0,
        up: str | None = None,
        everyday: str = "never",
        reject: bool = False,
        rejected: str = "",
        params: dict[str, Any] | None = None,
    ) -> None:
        self.joints = joints
        self.rate_hz = rate_hz
        self.up = up
        self.everyday = everyday
        self.reject = reject
        self.rejected = rejected
        self.params = params

    def fit(self, X: Any, y: Iterable[Any], groups: Iterable[Any] | None = None) -> MotionClassifier:
        """Train on samples.

        Parameters
        ----------
        X : sequence of Clip, paths, or array of shape (samples, frames, joints, 3) or (samples, frames, joints × 3)
            Each is one sample; still ends are trimmed.
        y : sequence, one class for each sample
        groups : sequence, optional
            The person of each sample.
        """
        clips = self._clips(X)
        names = np.asarray(list(y))
        if len(names) != len(clips):
            raise ValueError(f"expected a class for each sample, found {len(clips)} samples and {len(names)} classes")
        self.classes_, codes = np.unique(names, return_inverse=True)
        if len(self.classes_) < 2:
            raise ValueError(f"expected at least two classes, found {len(self.classes_)}")
        # Labels refer to clips by name: every sample gets its own.
        clips = [clip.renamed(f"{number}") for number, clip in enumerate(clips)]
        people = None if groups is None else {f"{number}": str(group) for number, group in enumerate(groups)}
        labels = [(clip.name, f"{code:05d}") for clip, code in zip(clips, codes)]
        order = [f"{code:05d}" for code in range(len(self.classes_))]
        self.index_: Index = train(
            clips,
            labels,
            people=people,
            classes=order,
            unlabelled="ignore",
            everyday=self.everyday,
            params=self.params,
            progress=False,
        )
        return self

    def predict_proba(self, X: Any) -> npt.NDArray[np.float64]:
        """Probability of each class, assuming that the sample is one of them; shape (samples, classes), rows sum to 1.

        For a sample without motion, all are equal.
        """
        check_is_fitted(self)
        rows = self.index_.classify(self._clips(X))
        names = self.index_.class_names
        found = np.array([[row["probabilities"][name] for name in names] for row in rows], dtype=np.float64)
        sums = found.sum(axis=1, keepdims=True)
        shares: npt.NDArray[np.float64] = np.full_like(found, 1 / len(self.classes_))
        np.divide(found, sums, out=shares, where=sums > 0)
        return shares

    def predict(self, X: Any) -> npt.NDArray[Any]:
        """The nearest class of each sample; with ``reject``, `rejected` for samples of no class."""
        check_is_fitted(self)
        rows = self.index_.classify(self._clips(X))
        names = dict(zip(self.index_.class_names, self.classes_))
        found = np.array([names.get(row["nearest"], self.classes_[0]) for row in rows], dtype=self.classes_.dtype)
        if self.reject:
            accepted = np.array([row["class"] is not None for row in rows])
            found = np.where(accepted, found.astype(object), self.rejected)
        return found

    def _clips(self, X: Any) -> list[Clip]:
        if isinstance(X, Clip):
            raise ValueError("expected several samples, found one clip; give [clip]")
        if isinstance(X, np.ndarray) and X.dtype != object:
            return self._of_arrays(X)
        given = list(X)
        if given and not isinstance(given[0], Clip) and np.ndim(given[0]) >= 2:
            return [clip for array in given for clip in self._of_arrays(np.asarray(array)[np.newaxis])]
        return as_clips(given)

    def _of_arrays(self, X: npt.NDArray[Any]) -> list[Clip]:
        from ._morec import ROLES

        names = list(ROLES if self.joints is None else self.joints)
        if self.joints is None and not (X.ndim >= 3 and X.shape[2] in (len(names), 3 * len(names))):
            names = names[: ROLES.index("left_palm")]
        if X.ndim == 3 and X.shape[2] == 3 * len(names):
            X = X.reshape(*X.shape[:2], len(names), 3)
        if X.ndim != 4 or X.shape[2:] != (len(names), 3):
            shape = ", ".join(map(str, X.shape))
            raise ValueError(
                f"expected an array of shape (samples, frames, {len(names)}, 3) or (samples, frames, {3 * len(names)}), "
                f"found ({shape})"
            )
        return [
            Clip.from_positions(sample, names, self.rate_hz, up=self.up, name=f"{number}")
            for number, sample in enumerate(X)
        ]

    def __sklearn_tags__(self) -> Any:
        tags = super().__sklearn_tags__()
        tags.input_tags.two_d_array = False
        tags.input_tags.three_d_array = True
        tags.input_tags.allow_nan = True
        tags.no_validation = True
        return tags

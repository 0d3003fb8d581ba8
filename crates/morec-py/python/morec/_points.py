"""Points of other libraries as points in space."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

Points = npt.NDArray[np.float64]


def in_space(points: Points, name: str, roles: Any) -> Points:
    """Points in space; those of a picture, whose last axis has two coordinates, lie in one plane, and `roles` must name them."""
    if points.shape[-1] != 2:
        return points
    if roles is None:
        raise ValueError(f"{name}: points in two dimensions: say with roles which points of the animal they are")
    third = np.where(np.isnan(points[..., :1]), np.nan, 0.0)
    return np.concatenate([points, third], axis=-1)

"""The first picture of the report."""

from __future__ import annotations

import json
from dataclasses import dataclass
from typing import TYPE_CHECKING

from culbuto import _native

if TYPE_CHECKING:
    from collections.abc import Sequence


@dataclass(frozen=True)
class Path:
    """Where a ball goes that is thrown as in S1: positions [x, y] (m) after 0, 1, 2, … ticks."""

    method: str
    ticks_per_second: int
    points: tuple[tuple[float, float], ...]


def thrown_ball(methods: Sequence[str], ticks_per_second: Sequence[int]) -> list[Path]:
    """Paths of the thrown ball of S1 by each method, at each number of ticks a second."""
    paths = json.loads(_native.thrown_ball(list(methods), list(ticks_per_second)))
    return [Path(**{**path, "points": tuple(map(tuple, path["points"]))}) for path in paths]

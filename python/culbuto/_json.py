"""JSON, which has no infinity: there, a number that is not finite is null."""

from __future__ import annotations

import json
import math


def or_infinite(number: float | None) -> float:
    """A number as the engine's JSON gives it."""
    return math.inf if number is None else number


def dumps(data: object) -> str:
    """Readable JSON of data, with null for numbers that JSON does not have."""
    return json.dumps(_finite(data), indent=2, ensure_ascii=False, allow_nan=False)


def _finite(data: object) -> object:
    if isinstance(data, dict):
        return {key: _finite(value) for key, value in data.items()}
    if isinstance(data, list | tuple):
        return [_finite(value) for value in data]
    return None if isinstance(data, float) and not math.isfinite(data) else data

"""Other engines on the scenes of the catalogue, as benches/peers measured them."""

from __future__ import annotations

import json
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from culbuto._json import or_infinite
from culbuto.report.stability import OURS, Line, line

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence
    from pathlib import Path


@dataclass(frozen=True)
class PeerRow:
    """One run of one scene by one engine; `setting` is what was set beside the step (s)."""

    scene: str
    engine: str
    setting: str
    step: float
    error: float
    seconds: float
    seconds_per_second: float

    @classmethod
    def of(cls, entry: dict[str, Any]) -> PeerRow:
        """A row from the runner's JSON, where an error that is no number is null."""
        return cls(**{**entry, "error": or_infinite(entry["error"])})


@dataclass(frozen=True)
class Peers:
    """What was measured of other engines, on what and with which versions of them.

    `left_out` holds why a scene has no others, `missing` why an engine could not be had.
    """

    rows: tuple[PeerRow, ...]
    versions: tuple[str, ...]
    build: str
    left_out: dict[str, str]
    missing: dict[str, str]
    stability: tuple[Line, ...]

    @classmethod
    def read(cls, path: Path) -> Peers:
        """Reads what `culbuto-peers --study` wrote; `ValueError` for anything else."""
        found = json.loads(path.read_text("utf-8"))
        try:
            rows = tuple(PeerRow.of(row) for row in found["rows"])
            left_out = {entry["scene"]: entry["why"] for entry in found["left_out"]}
            versions = tuple(version for _, version in found["versions"])
            stability = tuple(map(line, found["stability"]))
            missing = dict(found["missing"])
            return cls(rows, versions, found["build"], left_out, missing, stability)
        except (KeyError, TypeError) as error:
            message = f"{path} is no study of other engines ({error}); see `make report-peers`"
            raise ValueError(message) from error

    def engines(self, scene: str) -> list[str]:
        """Names of the other engines that have rows of a scene."""
        own = (row for row in self.rows if row.scene == scene)
        names = (row.engine for row in own if not row.engine.startswith(OURS))
        return list(dict.fromkeys(names))

    def curve(self, scene: str, engine: str) -> list[PeerRow]:
        """The rows of an engine at its best setting: the one that comes quickest below 1 %.

        Where none does, the one of the least error.
        """
        rows = [row for row in self.rows if (row.scene, row.engine) == (scene, engine)]
        settings = dict.fromkeys(row.setting for row in rows)
        curves = [[row for row in rows if row.setting == setting] for setting in settings]
        return min(curves, key=_rank, default=[])

    def quickest(self, scene: str, target: float) -> PeerRow | None:
        """The row of another engine that takes the least time for an error of at most `target`."""
        good = (row for row in self.rows if row.scene == scene and not row.engine.startswith(OURS))
        return quickest((row for row in good), target)


def quickest(rows: Iterable[PeerRow], target: float) -> PeerRow | None:
    """The row that takes the least time for an error of at most `target`."""
    good = [row for row in rows if row.error <= target]
    return min(good, key=lambda row: row.seconds_per_second, default=None)


def _rank(curve: Sequence[PeerRow]) -> tuple[float, float]:
    best = quickest(curve, 1e-2)
    least = min(row.error for row in curve)
    return (float("inf") if best is None else best.seconds_per_second, least)

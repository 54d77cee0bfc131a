"""Error against run time: a scene by several methods, at a row of steps and tolerances."""

from __future__ import annotations

import json
from dataclasses import asdict, dataclass, fields
from functools import cached_property
from typing import TYPE_CHECKING, Any

from culbuto import _native
from culbuto._json import or_infinite
from culbuto.catalogue import Scene, find

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from matplotlib.axes import Axes

STEPS_A_RUN = tuple(2**k for k in range(4, 15))
TOLERANCES = tuple(10.0**-k for k in range(2, 13))


@dataclass(frozen=True)
class Row:
    """One run of one scene by one method.

    Either `step` (s) or `tolerance` is given. `method` is "closed_form" for the exact solution
    of constant forces, "contact_step" for a scene with contacts. `error` is the largest over
    times and bodies, relative to the scene's length, infinite where the run diverged; `seconds`
    the median wall time of a run, `seconds_per_second` that for each simulated second; `energy`
    the change of the energy balance over the largest kinetic energy.
    """

    scene: str
    method: str
    step: float | None
    tolerance: float | None
    error: float
    seconds: float
    seconds_per_second: float
    steps: int
    rejected: int
    evaluations: int
    energy: float

    @classmethod
    def of(cls, entry: dict[str, Any]) -> Row:
        """A row from the engine's JSON, where one of step and tolerance is missing."""
        numbers = {name: or_infinite(entry[name]) for name in ("error", "energy")}
        return cls(**{"step": None, "tolerance": None, **entry, **numbers})


@dataclass(frozen=True)
class Order:
    """Order of a method on a scene: error falls as step^order.

    `measured` is None where the method is `exact` there, or nothing clear can be measured.
    """

    method: str
    stated: int
    measured: float | None
    exact: bool


class Table(dict[str, list[Any]]):
    """Columns by name, ready for `pandas.DataFrame`; printed as a table."""

    def __repr__(self) -> str:
        """The columns side by side, numbers short."""
        cells = [[name, *map(_short, column)] for name, column in self.items()]
        widths = [max(map(len, column)) for column in cells]
        lines = (
            "  ".join(cell.rjust(width) for cell, width in zip(line, widths, strict=True))
            for line in zip(*cells, strict=True)
        )
        return "\n".join(lines)


def _short(value: object) -> str:
    if value is None:
        return "–"
    return f"{value:.3g}" if isinstance(value, float) else str(value)


@dataclass(frozen=True)
class Study:
    """What came of `study`."""

    scene: Scene
    rows: tuple[Row, ...]

    @property
    def table(self) -> Table:
        """The rows as columns."""
        names = [field.name for field in fields(Row)]
        return Table({name: [getattr(row, name) for row in self.rows] for name in names})

    @property
    def methods(self) -> list[str]:
        """Names of the methods that have rows, in their order."""
        return list(dict.fromkeys(row.method for row in self.rows))

    @cached_property
    def order(self) -> dict[str, Order]:
        """Stated and measured order of each method, from runs at finer and finer steps."""
        return {
            method.name: _order(self.scene.name, method.name, method.order)
            for method in _native.methods()
            if method.name in self.methods
        }

    def curve(self, method: str, *, tolerance: bool = False) -> list[Row]:
        """Rows of one method at fixed steps, or with tolerances, as they were run."""
        of_kind = (row for row in self.rows if (row.tolerance is not None) == tolerance)
        return [row for row in of_kind if row.method == method]

    def to_dicts(self) -> list[dict[str, Any]]:
        """The rows, each a dict."""
        return [asdict(row) for row in self.rows]

    def plot(self, ax: Axes | None = None) -> Axes:
        """Draws error against wall seconds per simulated second, log–log (needs matplotlib)."""
        from culbuto.report import figures  # noqa: PLC0415 — matplotlib comes with an extra

        return figures.plot_study(self, ax)


def _order(scene: str, method: str, stated: int) -> Order:
    found = json.loads(_native.measured_order(scene, method))
    return Order(method, stated, found["slope"], found["exact"])


def study(
    scene: str,
    *,
    steps: Iterable[float] | None = None,
    tolerances: Iterable[float] | None = None,
    methods: Sequence[str] = (),
    repeats: int = 5,
) -> Study:
    """Runs a scene of the catalogue by each method, at each step and to each tolerance.

    Args:
        scene: Name or id.
        steps: Fixed steps (s), each taken as the nearest that divides the scene's duration; by
            default 2⁴ to 2¹⁴ steps a run.
        tolerances: For the methods that choose their own step; by default 1e-2 to 1e-12.
        methods: Their names; none: all.
        repeats: Timed runs of each row, of which the median counts.

    >>> import culbuto as cb
    >>> kepler = cb.study("kepler", steps=[0.01, 0.005], tolerances=[], methods=["leapfrog"])
    >>> [row.error < 0.02 for row in kepler.rows]
    [True, True]
    """
    entry = find(scene)
    counts = list(STEPS_A_RUN) if steps is None else _counts(entry, steps)
    limits = list(TOLERANCES) if tolerances is None else [float(limit) for limit in tolerances]
    if repeats < 1:
        message = f"repeats is {repeats}; allowed: 1 or more"
        raise ValueError(message)
    rows = json.loads(_native.study(entry.name, (counts, limits), list(methods), repeats))
    return Study(entry, tuple(map(Row.of, rows)))


def _counts(scene: Scene, steps: Iterable[float]) -> list[int]:
    duration = scene.duration or 0.0
    counts = []
    for step in steps:
        if not 0 < step <= max(duration, step):
            message = f"a step is {step}; allowed: a number of seconds above 0"
            raise ValueError(message)
        counts.append(max(1, round(duration / step)))
    return counts


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

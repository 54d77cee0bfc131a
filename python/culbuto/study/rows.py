"""Rows of error against run time, and what they tell together."""

from __future__ import annotations

import json
import math
from dataclasses import asdict, dataclass, fields
from functools import cached_property, partial
from typing import TYPE_CHECKING, Any

from culbuto import _native
from culbuto._json import or_infinite
from culbuto.study import runs

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from culbuto.catalogue import Scene


@dataclass(frozen=True)
class Row:
    """One run of one scene by one method.

    Either `step` (s) or `tolerance` is given. `method` is "closed_form" for the exact solution
    of constant forces, "contact_step" for a scene with contacts. `error` is the largest over
    times and bodies, relative to the scene's length, infinite where the run diverged, and
    `uncertainty` how far what it is compared with may be off itself, likewise; `seconds`
    the median wall time of a run, `seconds_per_second` that for each simulated second, `spread`
    how far the timed runs are apart (from quartile to quartile, relative to the median); `energy`
    the change of the energy balance over the largest kinetic energy.
    """

    scene: str
    method: str
    step: float | None
    tolerance: float | None
    error: float
    uncertainty: float
    seconds: float
    seconds_per_second: float
    spread: float
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
    """What came of `study`.

    `reference` says what rows were compared with, and `uncertainty` how far that may be off itself,
    relative as errors are: rows below it show the reference, not the method.
    """

    scene: Scene
    rows: tuple[Row, ...]
    reference: str = "the exact answer"
    uncertainty: float = 0.0

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
        """Stated and measured order of each method, from runs at finer and finer steps.

        Of a scene of the catalogue the runs are made for it; of any other the rows are taken.
        """
        of_catalogue = bool(self.scene.id)
        stated = {facts.name: facts.order for facts in _native.methods()}
        if not of_catalogue:
            stated[runs.CONTACT_STEP] = 2
        measure = partial(_order, self.scene.name) if of_catalogue else self._order_of_rows
        return {name: measure(name, stated[name]) for name in self.methods if name in stated}

    def _order_of_rows(self, method: str, stated: int) -> Order:
        rows = [row for row in self.curve(method) if row.step]
        errors = [(row.step or math.nan, row.error) for row in rows]
        floor = max(1e-14, 4 * self.uncertainty)
        exact = bool(rows) and all(row.error <= 1e-14 + 4e-15 * row.steps for row in rows)
        return Order(method, stated, None if exact else runs.slope(errors, floor), exact)

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

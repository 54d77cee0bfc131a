"""What a run kept of the laws, beside what it took."""

from __future__ import annotations

import json
from html import escape
from typing import TYPE_CHECKING

from culbuto import _native
from culbuto.catalogue import Law, Limits, law_of

if TYPE_CHECKING:
    from types import TracebackType

    from culbuto._native import StepReport, World


class Audit:
    """Watches a world: the conservation laws from its making to the last look, and the last report.

    As a context manager it looks at the end of the block. `print(audit)` in a terminal, or `audit`
    as the last line of a notebook's cell, shows all of it.

    Args:
        world: The world; it is only read.
        limits: Deviations that are allowed, relative.

    >>> import culbuto as cb
    >>> world = cb.scene("S12")
    >>> with cb.Audit(world) as audit:
    ...     world.step(0.01, steps=100)
    >>> [law.name for law in audit.laws if law.passed]
    ['energy', 'momentum', 'angular momentum', 'third law']
    """

    def __init__(self, world: World, limits: Limits | None = None) -> None:
        """Begins to watch."""
        self.world = world
        self.limits = limits or Limits()
        self._audit = _native.Audit(world)
        self._laws: tuple[Law, ...] | None = None

    def look(self) -> tuple[Law, ...]:
        """Measures the laws now; of several looks the largest deviations count."""
        asked = self.limits
        numbers = [asked.energy, asked.momentum, asked.angular_momentum, asked.third_law]
        found = json.loads(self._audit.look(self.world, numbers))
        self._laws = tuple(map(law_of, found))
        return self._laws

    @property
    def laws(self) -> tuple[Law, ...]:
        """The laws at the last look; looks if there was none."""
        return self.look() if self._laws is None else self._laws

    @property
    def report(self) -> StepReport:
        """What the last step or run took."""
        return self.world.report()

    @property
    def passed(self) -> bool:
        """Whether every law was kept that applies."""
        return all(law.passed for law in self.laws)

    def __enter__(self) -> Audit:
        """Begins to watch anew."""
        self._audit = _native.Audit(self.world)
        self._laws = None
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        """Looks, unless something went wrong."""
        if kind is None:
            self.look()

    def rows(self) -> list[tuple[str, str]]:
        """Name and value of all there is to tell."""
        return [*self.report.rows(), *((law.name, _told(law)) for law in self.laws)]

    def __str__(self) -> str:
        """For a terminal."""
        rows = self.rows()
        width = max(len(name) for name, _ in rows)
        return "\n".join(f"{name:<{width}}  {value}" for name, value in rows)

    def _repr_html_(self) -> str:
        """For a notebook."""
        left = 'style="text-align: left"'
        rows = (
            f"<tr><th {left}>{escape(name)}</th><td {left}>{escape(value)}</td></tr>"
            for name, value in self.rows()
        )
        return f"<table>{''.join(rows)}</table>"


def _told(law: Law) -> str:
    if law.measured is None:
        return f"does not apply: {law.why}"
    verdict = "kept to" if law.passed else "BROKEN by"
    return f"{verdict} {law.measured:.1e} of {law.allowed:.0e} ({law.why})"

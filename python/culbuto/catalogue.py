"""The catalogue: scenes whose answer is known, and what the engine makes of them."""

from __future__ import annotations

import json
import math
from dataclasses import dataclass
from typing import Any

from culbuto import _native


@dataclass(frozen=True)
class Scene:
    """A scene of the catalogue.

    `duration` (s), fixed step `dt` (s) and `tolerance` are those it is judged at, and `length` (m) what
    its errors are relative to; None where the answer is not a motion but numbers.
    """

    id: str
    name: str
    title: str
    about: str
    duration: float | None
    dt: float | None
    tolerance: float | None
    length: float | None

    @property
    def has_motion(self) -> bool:
        """Whether the answer is a motion, so that it can be run."""
        return self.duration is not None


@dataclass(frozen=True)
class Check:
    """A figure that is asked of a scene: `measured` must not exceed `asked`.

    `column` is "fixed" at a fixed step, "tolerance" for a run to a tolerance.
    """

    what: str
    column: str
    asked: float
    measured: float
    passed: bool


@dataclass(frozen=True)
class MethodCheck:
    """One method on a scene, moving also what has a closed form.

    `error` is relative to the scene's length, at its fixed step, and `energy` the change of the energy
    balance over the largest kinetic energy; infinite where the method refuses that step or
    diverges. `order_measured` is None where the method is `exact` here or nothing clear is measured.
    """

    method: str
    error: float
    energy: float
    order_stated: int
    order_measured: float | None
    exact: bool
    passed: bool


@dataclass(frozen=True)
class Verdict:
    """What came of a scene."""

    id: str
    name: str
    title: str
    checks: tuple[Check, ...]
    methods: tuple[MethodCheck, ...]
    passed: bool


@dataclass(frozen=True)
class Method:
    """What holds of a way through time."""

    name: str
    order: int
    about: str


def or_infinite(number: float | None) -> float:
    """JSON has no infinity: there, a number that is not finite is null."""
    return math.inf if number is None else number


def scenes() -> list[Scene]:
    """Every scene, in the order of the catalogue.

    >>> import culbuto as cb
    >>> [scene.name for scene in cb.scenes()][:2]
    ['projectile', 'constant_force']
    """
    return [_scene(entry) for entry in json.loads(_native.catalogue())]


def _scene(entry: dict[str, Any]) -> Scene:
    motion = entry.pop("motion") or dict.fromkeys(("duration", "dt", "tolerance", "length"))
    return Scene(**entry, **motion)


def find(name: str) -> Scene:
    """The scene of this id or name, whatever the case; `ValueError` with those there are."""
    wanted = name.casefold()
    for scene in scenes():
        if wanted in (scene.id.casefold(), scene.name.casefold()):
            return scene
    known = ", ".join(f"{scene.name} ({scene.id})" for scene in scenes())
    message = f"scene is {name!r}; allowed: {known}"
    raise ValueError(message)


def methods() -> list[Method]:
    """Every method that steps, the default first."""
    facts = json.loads(_native.method_facts())
    return [Method(fact["name"], fact["order"], fact["about"]) for fact in facts]


def verify(name: str) -> Verdict:
    """Runs a scene of the catalogue against its answer, by the engine as it comes and by every method.

    >>> import culbuto as cb
    >>> cb.verify("S1").passed
    True
    """
    found = json.loads(_native.verify(name))
    checks = [
        Check(c["what"], c["column"], c["asked"], or_infinite(c["measured"]), c["pass"])
        for c in found["checks"]
    ]
    rows = [
        MethodCheck(
            m["method"],
            or_infinite(m["error"]),
            or_infinite(m["energy"]),
            m["order_stated"],
            m["order_measured"],
            m["exact"],
            m["pass"],
        )
        for m in found["methods"]
    ]
    return Verdict(
        found["id"], found["name"], found["title"], tuple(checks), tuple(rows), found["pass"]
    )

"""The catalogue: scenes whose answer is known, and what the engine makes of them."""

from __future__ import annotations

import json
import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from culbuto import _native
from culbuto._json import or_infinite

if TYPE_CHECKING:
    from culbuto._native import World


@dataclass(frozen=True)
class Scene:
    """A scene of the catalogue.

    `duration` (s), fixed step `dt` (s) and `tolerance` are those it is judged at, and `length` (m)
    what its errors are relative to; None where the answer is not a motion but numbers. Scenes with
    contacts have no `tolerance` yet. `reference` says where the answer comes from, `uncertainty`
    how far it may be off itself, relative as errors are.
    """

    id: str
    name: str
    title: str
    about: str
    reference: str
    uncertainty: float
    duration: float | None
    dt: float | None
    tolerance: float | None
    length: float | None

    @property
    def has_motion(self) -> bool:
        """Whether the answer is a motion, so that it can be run."""
        return self.duration is not None

    def world(self) -> World:
        """A new world of the scene."""
        return _native.open_scene(self.name)


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

    `error` is relative to the scene's length, at its fixed step, and `energy` the change of the
    energy balance over the largest kinetic energy; infinite where the method refuses that step or
    diverges. `order_measured` is None where the method is `exact` here, or nothing clear comes out.
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


def scenes() -> list[Scene]:
    """Every scene, in the order of the catalogue.

    >>> import culbuto as cb
    >>> [scene.name for scene in cb.scenes()][:2]
    ['projectile', 'constant_force']
    """
    return [_scene(entry) for entry in json.loads(_native.catalogue())]


def _scene(entry: dict[str, Any]) -> Scene:
    motion = entry.pop("motion") or dict.fromkeys(("duration", "dt", "tolerance", "length"))
    return Scene(**{**entry, "uncertainty": or_infinite(entry["uncertainty"])}, **motion)


def find(name: str) -> Scene:
    """The scene of this id or name, whatever the case; `ValueError` with those there are."""
    wanted = name.casefold()
    for scene in scenes():
        if wanted in (scene.id.casefold(), scene.name.casefold()):
            return scene
    known = ", ".join(f"{scene.name} ({scene.id})" for scene in scenes())
    message = f"scene is {name!r}; allowed: {known}"
    raise ValueError(message)


def verify(name: str) -> Verdict:
    """Runs a scene against its answer, by the engine as it comes and by every method.

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


def scene(name: str) -> World:
    """A new world of a scene of the catalogue, by its id or name.

    >>> import culbuto as cb
    >>> world = cb.scene("S1")
    >>> world.step(1 / 60, steps=120)
    >>> abs(world.bodies[0].position - (24, -0.12)) < 1e-12
    True
    """
    return _native.open_scene(name)


@dataclass(frozen=True)
class Limits:
    """Deviations that are allowed, relative: see `verify_laws`."""

    energy: float = 1e-3
    momentum: float = 1e-9
    angular_momentum: float = 1e-9
    third_law: float = 1e-12

    def __post_init__(self) -> None:
        """Refuses what is no limit."""
        for name, limit in vars(self).items():
            if not 0 <= limit < math.inf:
                message = f"limit of {name} is {limit}; allowed: a finite number, 0 or above"
                raise ValueError(message)


@dataclass(frozen=True)
class Law:
    """A law and how well it was kept: the largest relative deviation, None where it does not apply.

    `why` says what was measured, or why the law does not apply.
    """

    name: str
    measured: float | None
    allowed: float
    why: str

    @property
    def passed(self) -> bool:
        """Whether the law was kept, or does not apply."""
        return self.measured is None or self.measured <= self.allowed


@dataclass(frozen=True)
class Laws:
    """The laws of one run."""

    method: str
    laws: tuple[Law, ...]
    passed: bool


def verify_laws(
    world: World,
    *,
    method: str | None = None,
    dt: float = 1 / 60,
    duration: float = 1.0,
    limits: Limits | None = None,
) -> Laws:
    """Measures the conservation laws on any world: energy, momentum, angular momentum, third law.

    A copy of the world is run; the world itself stays as it is. A law that outside forces suspend
    is reported as one that does not apply.

    Args:
        world: The world.
        method: By which it is run; the world's own by default.
        dt: Fixed step (s).
        duration: World time (s).
        limits: Deviations that are allowed, relative.
    """
    asked = limits or Limits()
    numbers = [asked.energy, asked.momentum, asked.angular_momentum, asked.third_law]
    for name, number in (("dt", dt), ("duration", duration)):
        if not 0 < number < math.inf:
            message = f"{name} is {number}; allowed: a finite number above 0"
            raise ValueError(message)
    found = json.loads(_native.verify_laws(world, method or world.method, dt, duration, numbers))
    return Laws(found["method"], tuple(map(law_of, found["laws"])), found["pass"])


def law_of(entry: dict[str, Any]) -> Law:
    """A law from the engine's JSON."""
    measured = or_infinite(entry["measured"]) if entry["applies"] else None
    return Law(entry["name"], measured, entry["allowed"], entry["why"])

"""Studies of worlds that are none of the catalogue."""

from __future__ import annotations

import copy
import math
from collections.abc import Sized
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from culbuto import _native
from culbuto.catalogue import Scene
from culbuto.study import runs
from culbuto.study.ladders import STEPS_OF_A_WORLD, TOLERANCES, allowed
from culbuto.study.rows import Row, Study
from culbuto.study.runs import Job, Mode, Ran, Reference

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence
    from concurrent.futures import Executor

    from culbuto._native import World


@dataclass(frozen=True)
class Case:
    """A world that is none of the catalogue, and how long it is run (s)."""

    name: str
    about: str
    world: World
    duration: float

    @property
    def meets(self) -> bool:
        """Whether bodies can meet in it."""
        return runs.meets(self.world)


def case_of(scene: Any, duration: float | None) -> Case:  # noqa: ANN401 — the user's
    """The world that is meant, and how long it is run; `ValueError` for what is not allowed."""
    name, about, world = "world", "", scene
    if isinstance(scene, str | Path):
        file = _native.SceneFile.read(scene)
        name, about = file.name or Path(scene).stem, file.about
        world, duration = file.world(), file.duration if duration is None else duration
    elif callable(scene):
        name, world = getattr(scene, "__name__", name), scene()
    if not isinstance(world, _native.World):
        what = "a name, a path, a World, or a function that makes one"
        message = f"scene is {world!r}; allowed: {what}"
        raise ValueError(message)
    if duration is None or not 0 < duration < math.inf:
        message = f"duration is {duration}; allowed: a number of seconds above 0"
        raise ValueError(message)
    return Case(name.replace("_", " "), about, copy.copy(world), duration)


@dataclass(frozen=True)
class Plan:
    """The rows of a world: methods, numbers of steps, tolerances, and how often it is seen."""

    methods: list[str]
    counts: list[int]
    limits: list[float]
    samples: int

    def modes(self, case: Case) -> Iterable[tuple[str, Mode]]:
        """Method and mode of each row."""
        # Where bodies can meet, the engine itself goes to tolerances.
        adaptive = {facts.name for facts in _native.methods() if facts.adaptive}
        adaptive |= {runs.CONTACT_STEP} if case.meets else set()
        for method in self.methods:
            for count in self.counts:
                yield method, Mode(count, None)
            for limit in self.limits if method in adaptive else ():
                yield method, Mode(None, limit)


def plan(
    case: Case,
    ladders: tuple[Iterable[float] | None, Iterable[float] | None],
    methods: Sequence[str],
    reference: object,
) -> Plan:
    """What is run, of what the user gave: steps (s) and tolerances, methods, a reference."""
    steps, tolerances = ladders
    parts = None
    if isinstance(reference, Sized) and not isinstance(reference, str):
        parts = max(1, len(reference) - 1)
    if steps is None:
        steps = [case.duration / count for count in STEPS_OF_A_WORLD]
    given = [allowed(step, case.duration) for step in steps]
    counts, samples = runs.counts_of(case.duration, given, parts)
    if tolerances is None:
        tolerances = () if case.meets else TOLERANCES
    limits = [float(limit) for limit in tolerances]
    return Plan(_chosen(case, methods), counts, limits, samples)


def _chosen(case: Case, methods: Sequence[str]) -> list[str]:
    apply = runs.methods_of(case.world)
    for name in methods:
        if name not in apply:
            message = f"method is {name!r}; allowed in this world: {', '.join(apply)}"
            raise ValueError(message)
    return list(methods) or apply


def known(case: Case, reference: Any, what: Plan) -> Reference:  # noqa: ANN401 — the user's
    """What the motion is compared with."""
    if isinstance(reference, str):
        if reference != "self":
            message = f'reference is {reference!r}; allowed: "self", a function or an array'
            raise ValueError(message)
        return runs.by_itself(case.world, case.duration, what.counts, what.samples)
    if callable(reference):
        times = np.linspace(0, case.duration, what.samples + 1)
        return runs.from_user([reference(float(time)) for time in times], case.world, what.samples)
    return runs.from_user(reference, case.world, what.samples)


@dataclass(frozen=True)
class Scale:
    """What errors are measured by: sizes of the bodies (n,), and the scene's length (m)."""

    sizes: runs.Floats
    length: float

    @classmethod
    def of(cls, case: Case, reference: Reference, length: float | None) -> Scale:
        """The user's length, or that of the motion."""
        sizes = runs.sizes_of(case.world)
        if length is None:
            return cls(sizes, runs.length_of(reference, sizes))
        if not 0 < length < math.inf:
            message = f"length is {length}; allowed: a finite number of metres above 0"
            raise ValueError(message)
        return cls(sizes, length)


def study_world(
    case: Case, what: Plan, compared: tuple[Reference, Scale], repeats: int,
    executor: Executor | None,
) -> Study:  # fmt: skip
    """Runs all rows and compares them."""
    reference, scale = compared
    jobs = [
        Job(case.world, case.duration, method, mode, what.samples, repeats)
        for method, mode in what.modes(case)
    ]
    ran = zip(jobs, runs.run_all(jobs, executor), strict=True)
    rows = [_row(case, job, run, compared) for job, run in ran if run is not None]
    off = reference.uncertainty / scale.length
    entry = Scene(
        "", case.name, case.name, case.about, reference.about, off,
        case.duration, None, None, scale.length,
    )  # fmt: skip
    return Study(entry, tuple(rows), reference.about, off)


def _row(case: Case, job: Job, run: Ran, compared: tuple[Reference, Scale]) -> Row:
    reference, scale = compared
    error = runs.distance(run.poses, reference.poses, scale.sizes) / scale.length
    count = job.mode.steps
    return Row(
        scene=case.name,
        method=job.method,
        step=None if count is None else job.duration / count,
        tolerance=job.mode.tolerance,
        error=error,
        uncertainty=reference.uncertainty / scale.length,
        seconds=run.seconds,
        seconds_per_second=run.seconds / job.duration,
        spread=run.spread,
        steps=run.steps,
        rejected=run.rejected,
        evaluations=run.evaluations,
        energy=run.energy,
    )

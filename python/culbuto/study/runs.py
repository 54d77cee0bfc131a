"""Runs of any world for a study: one job a row, which can be sent to another process."""

from __future__ import annotations

import copy
import math
from dataclasses import dataclass
from itertools import pairwise
from statistics import median
from time import perf_counter
from typing import TYPE_CHECKING, Any, TypeAlias

import numpy as np

from culbuto import _native

if TYPE_CHECKING:
    from collections.abc import Sequence
    from concurrent.futures import Executor

    from culbuto._native import World

Floats: TypeAlias = np.ndarray[Any, np.dtype[np.float64]]
CONTACT_STEP = "contact_step"
MOST_SAMPLES = 64
FINEST_TOLERANCES = (1e-13, 1e-11)  # of the reference, and of what it is compared with
FINER = (4, 2)  # times as many steps as the finest row, likewise


@dataclass(frozen=True)
class Mode:
    """How a row is run: in equal steps, or to a tolerance; the other is None."""

    steps: int | None
    tolerance: float | None


@dataclass(frozen=True)
class Job:
    """A run of a world by a method, timed `repeats` times, and seen at `samples` equal parts."""

    world: World
    duration: float
    method: str
    mode: Mode
    samples: int
    repeats: int


@dataclass(frozen=True)
class Ran:
    """What came of a job; poses (samples + 1, n, 3) are x, y (m) and angle (rad)."""

    poses: Floats
    seconds: float
    spread: float
    energy: float
    steps: int
    rejected: int
    evaluations: int


def run(job: Job) -> Ran | None:
    """Runs a job; None where the method refuses the step, or the motion leaves all numbers."""
    world = copy.copy(job.world)
    prepare(world, job.method)
    start = copy.copy(world)
    before = world.energy
    try:
        poses = _poses(world, job)
        times = [_time(copy.copy(start), job) for _ in range(job.repeats)]
    except (_native.SimulationError, ValueError):  # which is how a method refuses a step
        return None
    after, report = world.energy, world.report()
    largest = max(before.kinetic, after.kinetic) or 1.0
    return Ran(
        poses,
        median(times),
        spread_of(times),
        abs(after.balance - before.balance) / largest,
        report.steps,
        report.rejected,
        report.evaluations,
    )


def prepare(world: World, method: str) -> None:
    """Sets up a world for a method, which moves also what has a closed form, at one substep."""
    if method != CONTACT_STEP:
        world.closed_form = False
        world.method = method
    world.substeps = 1


def spread_of(times: Sequence[float]) -> float:
    """From the lower quartile to the upper, relative to the median; 0 of a single run."""
    lower, middle, upper = np.percentile(times, (25, 50, 75))
    return float((upper - lower) / middle)


def _poses(world: World, job: Job) -> Floats:
    if job.mode.tolerance is None:
        steps = job.mode.steps or 1
        motion = world.record(job.duration / steps, steps, every=steps // job.samples)
    else:
        times = np.linspace(0, job.duration, job.samples + 1)
        found = world.advance(job.duration, job.mode.tolerance, times=times).trajectory
        if found is None:  # pragma: no cover — times were given
            message = "a run that was asked for its motion has none"
            raise RuntimeError(message)
        motion = found
    return np.concatenate([motion.positions, motion.angles[..., None]], axis=2)


def _time(world: World, job: Job) -> float:
    clock = perf_counter()
    if job.mode.tolerance is None:
        steps = job.mode.steps or 1
        world.step(job.duration / steps, steps=steps)
    else:
        world.advance(job.duration, job.mode.tolerance)
    return perf_counter() - clock


def run_all(jobs: Sequence[Job], executor: Executor | None) -> list[Ran | None]:
    """Runs jobs one after the other, or through an executor; in their order in any case."""
    if executor is None:
        return [run(job) for job in jobs]
    futures = [executor.submit(run, job) for job in jobs]
    return [future.result() for future in futures]


def meets(world: World) -> bool:
    """Whether bodies can meet one another, or a fluid."""
    return "detect" in world.stages or bool(world.fluids)


def methods_of(world: World) -> list[str]:
    """What can move a world: the contact step where bodies can meet, methods where they cannot."""
    facts = _native.methods()
    if meets(world):
        return [CONTACT_STEP]
    if "joints" in world.stages:
        return [CONTACT_STEP, *(method.name for method in facts if method.joints)]
    return [method.name for method in facts]


def counts_of(
    duration: float, steps: Sequence[float], samples: int | None
) -> tuple[list[int], int]:
    """Numbers of steps nearest to the steps (s), and into how many parts of the run all divide."""
    counts = [max(1, round(duration / step)) for step in steps]
    if samples is not None:
        return [samples * max(1, round(count / samples)) for count in counts], samples
    common = math.gcd(*counts) if counts else MOST_SAMPLES
    return counts, max(part for part in range(1, MOST_SAMPLES + 1) if common % part == 0)


@dataclass(frozen=True)
class Reference:
    """The motion that rows are compared with, and how far it may be off itself (m)."""

    poses: Floats
    uncertainty: float
    about: str


def distance(a: Floats, b: Floats, sizes: Floats) -> float:
    """Largest |x − y| + ℓ|θ − φ| over times and bodies (m); infinite where one is not a number."""
    apart = np.hypot(*np.moveaxis(a[..., :2] - b[..., :2], -1, 0))
    if min(a.shape[-1], b.shape[-1]) > 2:
        apart = apart + sizes * np.abs(a[..., 2] - b[..., 2])
    largest = float(np.max(apart, initial=0.0))
    return math.inf if math.isnan(largest) else largest


def by_itself(world: World, duration: float, counts: Sequence[int], samples: int) -> Reference:
    """Two runs finer than all rows: the finer is the reference, the gap its uncertainty.

    By DOP853 to tolerances of 1e-13 and 1e-11 where nothing can meet; else by the contact step at
    a quarter and a half of the finest step, whose gap bounds the error of the finer run if its
    order is 1 or more (Richardson, 1911).
    """
    if meets(world):
        most = max(counts, default=1024)
        modes = [Mode(samples * -(-most * finer // samples), None) for finer in FINER]
        method, about = CONTACT_STEP, f"{modes[0].steps} steps, against {modes[1].steps}"
    else:
        modes = [Mode(None, tolerance) for tolerance in FINEST_TOLERANCES]
        method, about = "dop853", "DOP853 to a tolerance of 1e-13, against 1e-11"
    jobs = [Job(world, duration, method, mode, samples, 1) for mode in modes]
    finer, finest = (run(job) for job in reversed(jobs))
    if finest is None or finer is None:
        message = "the world cannot be run finer to compare with; give a reference"
        raise ValueError(message)
    sizes = sizes_of(world)
    return Reference(finest.poses, distance(finest.poses, finer.poses, sizes), about)


def from_user(given: object, world: World, samples: int) -> Reference:
    """A reference that is an array of poses (samples + 1, n, 2 or 3), in m and rad."""
    array = np.asarray(given, dtype=float)
    bodies = len(world.bodies)
    if bodies == 1 and array.ndim == 2:
        array = array[:, None, :]
    wanted = (samples + 1, bodies)
    if array.shape[:2] != wanted or array.shape[2:] not in ((2,), (3,)):
        message = (
            f"reference has the shape {array.shape}; allowed: {wanted} × 2 (positions) or × 3 "
            "(and angles); a function of time gives those of one moment"
        )
        raise ValueError(message)
    if not np.all(np.isfinite(array)):
        message = "reference holds numbers that are not finite; allowed: m and rad"
        raise ValueError(message)
    return Reference(array, 0.0, "the user's answer")


def sizes_of(world: World) -> Floats:
    """ℓ of each body: the largest distance of its outline from its centre of mass (m)."""
    return np.array([body.size for body in world.bodies])


def length_of(reference: Reference, sizes: Floats) -> float:
    """What errors are relative to: how far the farthest body goes, its own size at least (m)."""
    ways = np.ptp(reference.poses[..., :2], axis=0)
    longest = float(np.max(np.hypot(ways[:, 0], ways[:, 1]), initial=0.0))
    return max(longest, float(np.max(sizes, initial=0.0))) or 1.0


def slope(errors: Sequence[tuple[float, float]], floor: float) -> float | None:
    """Slope of log error against log step between the two finest steps that show it.

    Args:
        errors: Step (s) and relative error.
        floor: Relative error below which the reference, or rounding, shows instead.
    """
    usable = [(step, error) for step, error in sorted(errors, reverse=True) if error < 0.1]
    pairs = [(one, two) for one, two in pairwise(usable) if two[1] > floor and one[0] > two[0]]
    if not pairs:
        return None
    (coarse, large), (fine, small) = pairs[-1]
    return math.log(large / small) / math.log(coarse / fine)

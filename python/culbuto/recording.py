"""Runs that are kept: the motion of a world, what it took, and files of it."""

from __future__ import annotations

import csv
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from culbuto._native import StepReport, Trajectory, World

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

    from numpy.typing import NDArray

COLUMNS = ("positions", "angles", "velocities", "angular_velocities")
MOST_SAMPLES = 10_000
SAMPLES_TO_TOLERANCE = 240


@dataclass(frozen=True)
class Recording:
    """A motion, the names of its bodies, and what the run took."""

    trajectory: Trajectory
    names: tuple[str, ...]
    report: StepReport

    def save_npz(self, path: Path) -> None:
        """Writes names, times (k,), positions (k, n, 2), angles (k, n), velocities alike."""
        motion = self.trajectory
        arrays = {name: getattr(motion, name) for name in ("times", *COLUMNS)}
        np.savez_compressed(path, names=np.array(self.names), **arrays)

    def save_csv(self, path: Path) -> None:
        """Writes a line for each time and body; numbers are read back bit for bit."""
        motion = self.trajectory
        with path.open("w", newline="", encoding="utf-8") as file:
            lines = csv.writer(file)
            lines.writerow(("time", "body", "x", "y", "angle", "vx", "vy", "angular_velocity"))
            for k, time in enumerate(motion.times.tolist()):
                for i, name in enumerate(self.names):
                    place = (*motion.positions[k, i], motion.angles[k, i])
                    speed = (*motion.velocities[k, i], motion.angular_velocities[k, i])
                    lines.writerow((time, name, *map(float, place + speed)))


def names_of(world: World) -> tuple[str, ...]:
    """Names of the bodies, in body order; "body 3" for one that has none."""
    return tuple(body.name or f"body {i}" for i, body in enumerate(world.bodies))


def record_steps(
    world: World,
    dt: float,
    steps: int,
    done: Callable[[int], object] = lambda _: None,
) -> Recording:
    """Runs `steps` steps of `dt` (s), keeping at most 10 000; `done` hears of steps taken."""
    every = -(-steps // MOST_SAMPLES)
    samples_at_once = max(1, steps // every // 50)
    parts: list[Trajectory] = []
    reports: list[StepReport] = []
    left = steps
    while left > 0:
        now = min(left, samples_at_once * every)
        parts.append(world.record(dt, now, every))
        reports.append(world.report())
        left -= now
        done(now)
    return Recording(_joined(parts), names_of(world), _summed(reports))


def record_to_tolerance(world: World, duration: float, tolerance: float) -> Recording:
    """Runs a duration (s) to a tolerance, keeping the motion at 241 equal times."""
    times = np.linspace(0.0, duration, SAMPLES_TO_TOLERANCE + 1)
    report = world.advance(duration, tolerance, times=times)
    if report.trajectory is None:  # pragma: no cover — it is there, as times were given
        message = "the run kept no motion"
        raise RuntimeError(message)
    return Recording(report.trajectory, names_of(world), report)


def _joined(parts: list[Trajectory]) -> Trajectory:
    """One motion of several in a row: each begins where the one before ends."""

    def column(name: str) -> NDArray[np.float64]:
        arrays = [getattr(part, name) for part in parts]
        return np.concatenate([arrays[0], *(array[1:] for array in arrays[1:])])

    return Trajectory(*(column(name) for name in ("times", *COLUMNS)))


def _summed(reports: list[StepReport]) -> StepReport:
    return StepReport(
        sum(report.duration for report in reports),
        sum(report.steps for report in reports),
        sum(report.stiff_steps for report in reports),
        sum(report.rejected for report in reports),
        sum(report.evaluations for report in reports),
        sum(report.sweeps for report in reports),
        sum(report.solves for report in reports),
        max(report.parts for report in reports),
        sum(report.factorisations for report in reports),
        sum(report.impacts for report in reports),
        sum(report.events for report in reports),
        max(report.residual for report in reports),
        reports[-1].overlap,
        reports[-1].gap,
        min(report.smallest_step for report in reports),
        None,
        next((report.fallback for report in reports if report.fallback), None),
        {},
    )

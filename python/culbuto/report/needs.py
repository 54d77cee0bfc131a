"""What a scene does not need: what runs of a step, what it costs, and what all else would cost."""

from __future__ import annotations

import copy
import pickle
from dataclasses import dataclass
from statistics import median
from time import perf_counter
from typing import TYPE_CHECKING

from culbuto import _native, catalogue
from culbuto.joints import RevoluteJoint

if TYPE_CHECKING:
    from culbuto._native import World

# One of each kind of content, the leanest first.
TYPICAL = (
    "projectile", "spin_decay", "fall_with_drag", "kepler", "point_pendulum", "soft_joint",
    "gear_train", "elastic_ball", "cradle", "bowl",
)  # fmt: skip
STEPS = 200
ROUNDS = 5
FAR = 1e4  # m: what is added meets nothing that was there


@dataclass(frozen=True)
class Need:
    """What a scene takes a step, and what it would take with everything switched on.

    `stages` (s a step) are those that run; `seconds` and `everything` a step without timing the
    stages; `memory` and `memory_of_everything` what a world takes when it is stored (bytes).
    """

    scene: str
    bodies: int
    stages: dict[str, float]
    seconds: float
    memory: int
    everything: float
    memory_of_everything: int


def needs(names: tuple[str, ...] = TYPICAL) -> list[Need]:
    """Measures the scenes of these names."""
    return [_need(catalogue.find(name)) for name in names]


def _need(scene: catalogue.Scene) -> Need:
    world = scene.world()
    dt = min(scene.dt or 1 / 60, 1 / 60)
    timed = copy.copy(world)
    timed.timing = True
    timed.step(dt, steps=STEPS)
    stages = {name: seconds / STEPS for name, seconds in timed.report().stages.items()}
    full = everything(world)
    return Need(
        scene.name,
        len(world.bodies),
        {name: stages[name] for name in world.stages if name in stages},
        _seconds(world, dt),
        _stored(world),
        _seconds(full, dt),
        _stored(full),
    )


def everything(world: World) -> World:
    """A copy with all that a world can have: air, a field, sleeping, joints and what touches."""
    full = copy.copy(world)
    full.air_density = max(full.air_density, 1.2)
    full.sleeping = True
    full.add_field(_native.Central((0, 0), 0.0, 0.0))
    floor = full.add_body(_native.Box(10, 1), kind="static", position=(FAR, -0.5))
    full.add_body(_native.Box(1, 1), position=(FAR, 0.5))
    bob = full.add_body(_native.Circle(0.1), position=(FAR + 1, 3))
    full.add_joint(RevoluteJoint(floor, bob, anchor_a=(0, 3.5), anchor_b=(-1, 0)))
    return full


def _seconds(world: World, dt: float) -> float:
    times = []
    for _ in range(ROUNDS):
        run = copy.copy(world)
        run.step(dt)
        clock = perf_counter()
        run.step(dt, steps=STEPS)
        times.append((perf_counter() - clock) / STEPS)
    return median(times)


def _stored(world: World) -> int:
    return len(pickle.dumps(world))

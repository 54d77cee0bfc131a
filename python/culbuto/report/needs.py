"""What a scene does not need: what runs of a step, what it costs, and what all else would cost."""

from __future__ import annotations

import copy
import json
from dataclasses import dataclass
from importlib.resources import files
from statistics import median
from time import perf_counter
from typing import TYPE_CHECKING, Any

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

    `stages` (s a step) are those that run; `seconds` and `seconds_of_everything` a step without
    timing the stages. `counted` is the same in instructions, where they were counted.
    """

    scene: str
    bodies: int
    stages: dict[str, float]
    seconds: float
    seconds_of_everything: float
    counted: Counted | None


@dataclass(frozen=True)
class Counted:
    """What a world takes by counting: instructions a step and of each stage, bytes on the heap.

    `everything` is the same world with everything switched on, None of that one.
    """

    step: float
    stages: dict[str, float]
    bytes: int
    everything: Counted | None = None

    @classmethod
    def of(cls, entry: dict[str, Any]) -> Counted:
        """From the JSON of a run."""
        full = entry.get("everything")
        more = None if full is None else cls.of(full)
        return cls(entry["step"], entry["stages"], entry["bytes"], more)


@dataclass(frozen=True)
class Feature:
    """Instructions a step of a world that never had a feature, had it, and has it."""

    world: str
    feature: str
    never: float
    had: float
    there: float


@dataclass(frozen=True)
class Counts:
    """A run of `make needs`, which comes with the package, since valgrind is not everywhere."""

    machine: str
    versions: str
    date: str
    scenes: dict[str, Counted]
    features: tuple[Feature, ...]


def counts() -> Counts:
    """The run that comes with the package."""
    found = json.loads(files("culbuto.report").joinpath("counted.json").read_text("utf-8"))
    scenes = {entry["scene"]: Counted.of(entry) for entry in found["scenes"]}
    features = tuple(Feature(**entry) for entry in found["features"])
    return Counts(found["machine"], found["versions"], found["date"], scenes, features)


def step_of(scene: catalogue.Scene) -> float:
    """The step (s) that a scene is measured at here."""
    return min(scene.dt or 1 / 60, 1 / 60)


def needs(names: tuple[str, ...] = TYPICAL) -> list[Need]:
    """Measures the scenes of these names."""
    there = counts().scenes
    return [_need(catalogue.find(name), there.get(name)) for name in names]


def _need(scene: catalogue.Scene, counted: Counted | None) -> Need:
    world = scene.world()
    dt = step_of(scene)
    timed = copy.copy(world)
    timed.timing = True
    timed.step(dt, steps=STEPS)
    stages = {name: seconds / STEPS for name, seconds in timed.report().stages.items()}
    return Need(
        scene.name,
        len(world.bodies),
        {name: stages[name] for name in world.stages if name in stages},
        _seconds(world, dt),
        _seconds(everything(world), dt),
        counted,
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

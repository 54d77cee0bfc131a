"""Snapshots, copies and pickles: the same motion bit for bit, the same objects where they can."""

import copy
import pickle
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from hypothesis import settings
from hypothesis import strategies as st
from hypothesis.stateful import RuleBasedStateMachine, invariant, precondition, rule

import culbuto as cb
from test_fields import Spring

World = cb.World


def busy() -> World:
    """A bit of everything."""
    world = World((0.1, -9.81), air_density=1.2, wind=(1, 0), method="rk4", substeps=3)
    box = world.add_body(cb.Box(1, 2), name="box", velocity=(3, 4), angular_velocity=1)
    world.add_body(kind="static", name="ground")
    gone = world.add_body(mass=1)
    pair = world.add_body([cb.Circle(1), cb.Circle(1, center=(2, 0))], angle=0.5, inertia=9.0)
    gone.remove()
    world.add_field(Spring(2))
    world.add_field(cb.Oscillating(box, (1, 0)))
    world.add_schedule(pair, [0, 0.33, 1], [(1, 0), (2, 0)], [1, 2])
    vars(box)["friend"] = pair
    vars(world)["hero"] = box
    world.step(0.1)
    box.apply_force((1, 2), at=(0, 0))  # waits for the next step
    return world


def same(a: World, b: World) -> bool:
    return a.snapshot().__reduce__()[1][0] == b.snapshot().__reduce__()[1][0]


def through_pickle(world: World) -> World:
    return pickle.loads(pickle.dumps(world))  # type: ignore[no-any-return] # noqa: S301


def through_snapshot(world: World) -> World:
    return world.snapshot().to_world()


def through_pickled_snapshot(world: World) -> World:
    snapshot: cb.Snapshot = pickle.loads(pickle.dumps(world.snapshot()))  # noqa: S301
    return snapshot.to_world()


def through_restore(world: World) -> World:
    other = World()
    other.add_body(mass=1)
    other.restore(world.snapshot())
    return other


WAYS: list[Callable[[World], World]] = [
    copy.copy, copy.deepcopy, through_pickle, through_snapshot, through_pickled_snapshot,
    through_restore,
]  # fmt: skip


@pytest.mark.parametrize("way", WAYS)
def test_continues_bit_for_bit(way: Callable[[World], World]) -> None:
    world = busy()
    other = way(world)
    assert other is not world
    assert same(world, other)
    for _ in range(3):
        world.step(0.05, 5)
        other.step(0.05, 5)
        assert same(world, other)
        np.testing.assert_array_equal(world.positions, other.positions)
    world.advance(0.5)
    assert not same(world, other)  # they are two
    assert [b.name for b in other] == [b.name for b in world]
    assert other.schedules[0].body is other.bodies[2]
    assert all(body.world is other for body in other)


@pytest.mark.parametrize("way", [copy.deepcopy, lambda x: pickle.loads(pickle.dumps(x))])  # noqa: S301
def test_objects_keep_their_relations(way: Callable[[Any], Any]) -> None:
    world = busy()
    box, _, pair = world.bodies
    for order in ([world, box, pair], [box, world, pair], [pair, box, world]):
        made = way(order)
        new = next(x for x in made if isinstance(x, World))
        bodies = [x for x in made if isinstance(x, cb.Body)]
        originals = [x for x in order if isinstance(x, cb.Body)]
        assert bodies == [new.bodies[body.index] for body in originals]
        assert vars(new)["hero"] is new.bodies[0]
        assert vars(new.bodies[0])["friend"] is new.bodies[2]
        assert new.fields[0].function is not world.fields[0].function
    lone = way(pair)
    assert lone.world.bodies[2] is lone
    schedule = way(world.schedules[0])
    assert schedule.body.world.schedules == [schedule]
    removed = world.add_body(mass=1)
    removed.remove()
    assert way(removed).removed


def test_a_shallow_copy_shares_the_attributes() -> None:
    world = busy()
    other = copy.copy(world)
    assert vars(other.bodies[0]) == vars(world.bodies[0])
    assert vars(other.bodies[0])["friend"] is world.bodies[2]
    vars(other.bodies[0])["friend"] = None
    assert vars(world.bodies[0])["friend"] is world.bodies[2]
    assert other.fields[0].function is world.fields[0].function


def test_restoring_brings_the_objects_back() -> None:
    world = busy()
    before, fields, schedules = world.bodies, world.fields, world.schedules
    snapshot = world.snapshot()
    before[0].remove()
    fields[0].remove()
    new = world.add_body(mass=1)
    world.step(0.1)
    world.restore(snapshot)
    assert (world.bodies, world.fields, world.schedules) == (before, fields, schedules)
    parts: list[Any] = [*before, *fields, *schedules]
    assert [part.removed for part in parts] == [False] * 6
    assert new.removed
    assert world.add_body(mass=3) is not new
    assert new.removed  # though its handle is in use again
    with pytest.raises(cb.StaleHandleError):
        new.mass  # noqa: B018


def test_a_pickled_snapshot_keeps_bodies_that_are_there() -> None:
    world = busy()
    bodies, fields = world.bodies, world.fields
    snapshot: cb.Snapshot = pickle.loads(pickle.dumps(world.snapshot()))  # noqa: S301
    bodies[2].remove()
    world.restore(snapshot)
    assert world.bodies[:2] == bodies[:2]
    assert world.bodies[2] is not bodies[2]
    assert bodies[2].removed
    assert [field.removed for field in fields] == [True, True]
    assert len(snapshot) == 3
    assert snapshot.time == world.time


def test_what_cannot_be_pickled_says_so() -> None:
    world = World()
    world.add_field(lambda state: state.positions)
    with pytest.raises((AttributeError, pickle.PicklingError), match="lambda"):
        pickle.dumps(world)
    with pytest.raises(ValueError, match="snapshot"):
        cb.Snapshot(b"nonsense")


class Bodies(RuleBasedStateMachine):
    """A world against a list of what should be in it."""

    numbers = st.integers(-8, 8).map(float)
    vectors = st.tuples(numbers, numbers)

    def __init__(self) -> None:
        super().__init__()
        self.world = World((0, 0))
        self.bodies: list[cb.Body] = []
        self.stale: list[cb.Body] = []
        self.momentum = np.zeros(2)
        self.kept: list[tuple[cb.Snapshot, list[cb.Body], Any, Any]] = []

    def some(self, data: st.DataObject) -> cb.Body:
        return self.bodies[data.draw(st.integers(0, len(self.bodies) - 1))]

    @rule(mass=st.integers(1, 5), velocity=vectors, position=vectors)
    def add(self, mass: int, velocity: Any, position: Any) -> None:
        self.bodies.append(
            self.world.add_body(
                cb.Circle(1), mass=mass, velocity=velocity, position=position, mask=0
            )
        )
        self.momentum += mass * np.array(velocity)

    @precondition(lambda self: self.bodies)
    @rule(data=st.data())
    def remove(self, data: st.DataObject) -> None:
        body = self.some(data)
        index = self.bodies.index(body)
        self.momentum -= np.array(body.momentum)
        body.remove()
        self.bodies[index] = self.bodies[-1]
        self.bodies.pop()
        self.stale.append(body)

    @precondition(lambda self: self.bodies)
    @rule(data=st.data(), impulse=vectors, at=vectors)
    def jolt(self, data: st.DataObject, impulse: Any, at: Any) -> None:
        self.some(data).apply_impulse(impulse, at=at)
        self.momentum += impulse

    @precondition(lambda self: self.bodies)
    @rule(data=st.data(), force=vectors)
    def push(self, data: st.DataObject, force: Any) -> None:
        self.some(data).apply_force(force)
        self.world.step(0.5)
        self.momentum += 0.5 * np.array(force)

    @precondition(lambda self: self.bodies)
    @rule(data=st.data(), position=vectors)
    def place(self, data: st.DataObject, position: Any) -> None:
        body = self.some(data)
        body.position = position
        assert body.position == position

    @rule(steps=st.integers(1, 5))
    def step(self, steps: int) -> None:
        before = self.world.positions + 0.125 * steps * self.world.velocities
        self.world.step(0.125, steps)
        np.testing.assert_allclose(self.world.positions, before, atol=1e-9)

    @rule()
    def keep(self) -> None:
        arrays = (self.world.positions, self.world.velocities)
        self.kept.append((self.world.snapshot(), list(self.bodies), arrays, self.momentum.copy()))

    @precondition(lambda self: self.kept)
    @rule(data=st.data())
    def restore(self, data: st.DataObject) -> None:
        snapshot, bodies, arrays, momentum = data.draw(st.sampled_from(self.kept))
        self.world.restore(snapshot)
        known = {*self.bodies, *self.stale}
        self.bodies = list(bodies)
        self.stale = [body for body in known if body not in bodies]
        self.momentum = momentum.copy()
        np.testing.assert_array_equal(self.world.positions, arrays[0])
        np.testing.assert_array_equal(self.world.velocities, arrays[1])

    @rule()
    def refuse(self) -> None:
        with pytest.raises(ValueError, match="mass"):
            self.world.add_body(mass=-1)
        with pytest.raises(ValueError, match="positions"):
            self.world.positions = np.full((len(self.bodies), 2), np.nan) if self.bodies else [1]

    @invariant()
    def holds(self) -> None:
        assert self.world.bodies == self.bodies
        assert [body.index for body in self.bodies] == list(range(len(self.bodies)))
        assert all(body.removed and body not in self.world for body in self.stale)
        for body, position in zip(self.bodies, self.world.positions, strict=True):
            assert tuple(position) == body.position
        # Impulses add up: errors of rounding only, on numbers below 1e3 or so.
        np.testing.assert_allclose(self.world.momentum, self.momentum, atol=1e-9)


TestBodies = Bodies.TestCase
TestBodies.settings = settings(max_examples=60, stateful_step_count=30, deadline=None)

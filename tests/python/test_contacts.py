"""Contacts, events, callbacks, hooks, sensors and platforms with one side, as Python sees them."""

import copy
import gc
import pickle
import weakref
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import culbuto as cb

DT = 1 / 60


def scene(**ball: Any) -> tuple[cb.World, cb.Body, cb.Body]:
    world = cb.World()
    ground = world.add_body(cb.Box(20, 1), kind="static", position=(0, -0.5), name="ground")
    body = world.add_body(cb.Box(1, 1), **{"position": (0, 0.5), **ball})
    return world, ground, body


def test_contacts_are_arrays_and_objects() -> None:
    world, ground, box = scene()
    world.step(DT, steps=60)
    contacts = world.contacts
    assert len(contacts) == 1
    assert contacts.bodies.tolist() == [[0, 1]]
    assert contacts.parts.tolist() == [[0, 0]]
    assert contacts.count.tolist() == [2]
    assert contacts.points.shape == (1, 2, 2)
    assert contacts.normals == pytest.approx(np.array([[0, 1]]))
    assert contacts.gaps == pytest.approx(np.zeros((1, 2)), abs=1e-6)
    weight = box.mass * 9.81
    assert contacts.normal_impulses.sum() == pytest.approx(weight * DT / 4)
    assert contacts.tangential_impulses == pytest.approx(np.zeros(1), abs=1e-9)
    assert contacts.forces == pytest.approx(np.array([[0, weight]]), abs=1e-6)
    assert contacts.sliding.tolist() == [False]
    (contact,) = contacts
    assert (contact.body_a, contact.body_b) == (ground, box)
    assert contact.force == pytest.approx((0, weight), abs=1e-6)
    assert len(contact.points) == 2
    assert contacts[-1].normal == contact.normal
    with pytest.raises(IndexError):
        contacts[1]
    assert len(box.contacts) == len(ground.contacts) == 1
    assert "Contact of" in repr(contact)
    ball = world.add_body(cb.Circle(0.2), position=(3, 0.2))
    world.step(DT)
    assert np.isnan(ball.contacts.points[0, 1]).all()
    ball.remove()
    with pytest.raises(cb.StaleHandleError):
        _ = ball.contacts


def test_events_are_arrays_and_objects() -> None:
    world, ground, ball = scene(position=(0, 2.5))
    world.step(DT, steps=60)
    events = world.events
    assert "1 begin, 0 end, 1 hit" in repr(events)
    (hit,), (begin,) = events.hit, events.begin
    assert (hit.kind, begin.kind) == ("hit", "begin")
    assert (hit.body_a, hit.body_b) == (ground, ball)
    assert hit.time == pytest.approx((4 / 9.81) ** 0.5, rel=1e-3)
    assert hit.approach_speed == pytest.approx((4 * 9.81) ** 0.5, rel=1e-3)
    assert hit.impulse >= ball.mass * hit.approach_speed * 0.99
    assert events.hit.times.tolist() == [hit.time]
    assert events.hit.bodies.tolist() == [[0, 1]]
    assert events.hit.points.shape == events.hit.normals.shape == (1, 2)
    ball.remove()
    world.step(DT)
    (end,) = world.events.end
    assert end.body_b is ball
    assert ball.removed
    assert world.events.end.bodies.tolist() == [[0, -1]]
    assert np.isnan(world.events.end.points).all()
    assert end.point is None


def test_callbacks_are_called_after_each_step_and_may_add_and_remove() -> None:
    world, _ground, ball = scene(position=(0, 2.5))
    seen: list[tuple[str, float]] = []

    @world.on_hit
    def shatter(event: cb.ContactEvent) -> None:
        seen.append((event.kind, world.time))
        assert event.body_b is ball
        ball.remove()
        for x in (-2, 2):
            world.add_body(cb.Circle(0.2), position=(x, 1))

    world.on_begin(lambda event: seen.append((event.kind, world.time)))
    world.step(DT, steps=40)
    assert [kind for kind, _ in seen] == ["hit", "begin"]  # of the one removed: told still
    assert seen[0][1] == seen[1][1] < 40 * DT
    assert len(world) == 3
    assert len(world.events.hit) == 1, "the events of all steps"
    world.off(shatter)
    with pytest.raises(ValueError, match="not called"):
        world.off(shatter)
    world.step(DT, steps=40)
    assert [kind for kind, _ in seen] == ["hit", "begin", "begin", "begin"]


def test_a_callback_of_one_body_hears_of_that_one() -> None:
    world, ground, ball = scene(position=(0, 1.0))
    other = world.add_body(cb.Box(1, 1), position=(3, 1.0))
    heard: list[cb.Body | None] = []
    world.on_begin(lambda event: heard.append(event.body_b), body=other)
    world.step(DT, steps=40)
    assert heard == [other]
    world.on_end(lambda event: heard.append(event.body_a), body=ground)
    ball.position = (0, 9)
    world.step(DT)
    assert heard == [other, ground]
    with pytest.raises(TypeError, match="function"):
        world.on_hit(3)  # type: ignore[type-var]


def test_what_a_callback_raises_ends_the_call_after_its_step() -> None:
    world, _, ball = scene(position=(0, 2.5))

    def fail(event: cb.ContactEvent) -> None:
        raise KeyError(event.kind)

    world.on_begin(fail)
    with pytest.raises(KeyError, match="begin"):
        world.step(DT, steps=100)
    assert 0 < world.time < 1
    assert len(world.events.begin) == 1
    assert ball.position.y == pytest.approx(0.5, abs=1e-2)
    world.step(DT, steps=10)


def test_a_collision_filter() -> None:
    world, ground, box = scene()
    asked = []

    def allow(a: cb.Body, i: int, b: cb.Body, j: int) -> bool:
        asked.append((a, i, b, j))
        return False

    world.step(DT)
    world.collision_filter = allow
    assert asked == [(ground, 0, box, 0)]
    assert world.collision_filter is allow
    world.step(DT, steps=20)
    assert box.position.y < 0.4
    twin = copy.copy(world)
    assert twin.collision_filter is allow
    assert pickle.loads(pickle.dumps(cb.World())).collision_filter is None  # noqa: S301
    world.collision_filter = None
    with pytest.raises(TypeError, match="function"):
        world.collision_filter = 3  # type: ignore[assignment]


def test_pre_solve_changes_and_disables() -> None:
    world, ground, box = scene(velocity=(3, 0))

    def smooth(contact: cb.PreSolve) -> None:
        assert (contact.body_a, contact.body_b) == (ground, box)
        assert contact.friction == (0.5, 0.5)
        contact.friction = 0.0
        assert contact.friction == (0.0, 0.0)
        assert contact.enabled
        assert len(contact.points) == len(contact.gaps) == 2

    world.pre_solve = smooth
    world.step(DT, steps=30)
    assert box.velocity.x == pytest.approx(3, abs=1e-12)
    world.pre_solve = lambda _: False
    world.step(DT, steps=30)
    assert box.position.y < 0


def test_hooks_that_fail_stop_the_step_and_change_nothing() -> None:
    world, _, box = scene(position=(0, 0.6))
    world.step(DT)

    def touch(_: cb.PreSolve) -> None:
        box.position = (0, 3)

    def spoil(contact: cb.PreSolve) -> None:
        contact.restitution = 3.0

    for hook, error in ((touch, RuntimeError), (spoil, ValueError)):
        world.pre_solve = hook
        before = pickle.dumps(world.snapshot())
        with pytest.raises(error):
            world.step(DT, steps=30)
        assert pickle.dumps(world.snapshot()) == before
        assert len(world.events.begin) == 0
    world.pre_solve = None
    world.step(DT, steps=30)
    assert len(world.events.begin) == 1


def test_sensors_and_overlaps() -> None:
    world, _, box = scene(position=(0, 3))
    goal = world.add_body(cb.Box(1, 1), kind="static", sensor=True, position=(0, 1.5))
    heard: list[str] = []
    world.on_sensor_begin(lambda event: heard.append(event.kind), body=goal)
    world.on_sensor_end(lambda event: heard.append(event.kind))
    world.step(DT, steps=25)
    assert heard == ["sensor_begin"]
    assert goal.overlaps == [box]
    assert box.overlaps == [goal]
    box.remove()
    world.step(DT)
    assert heard == ["sensor_begin", "sensor_end"]
    assert goal.overlaps == []


def test_a_one_way_platform_lets_through_from_below() -> None:
    world = cb.World()
    world.add_body(cb.Box(4, 0.2), kind="static", position=(0, -0.1), one_way=(0, 1))
    ball = world.add_body(cb.Circle(0.25), position=(0, -2), velocity=(0, 8))
    world.step(DT, steps=200)
    assert ball.position.y == pytest.approx(0.25, abs=1e-3)
    world.pre_solve = lambda _: False
    world.step(DT)
    world.pre_solve = None
    world.step(DT, steps=30)
    assert ball.position.y < -0.5


def test_a_world_with_hooks_that_know_it_is_freed() -> None:
    def make() -> weakref.ref[cb.World]:
        world, _, box = scene()
        world.pre_solve = lambda _: world is not None
        world.on_hit(lambda _: box.remove())
        world.step(DT)
        return weakref.ref(world)

    gone = make()
    gc.collect()
    assert gone() is None


@settings(max_examples=20, deadline=None)
@given(
    st.lists(
        st.tuples(st.floats(-3, 3), st.floats(0.6, 5), st.floats(-4, 4)), min_size=1, max_size=8
    )
)
def test_callbacks_and_arrays_tell_the_same(places: list[tuple[float, float, float]]) -> None:
    world, _, _ = scene()
    for x, y, v in places:
        world.add_body(cb.Circle(0.3), position=(x, y), velocity=(v, 0))
    quiet = copy.copy(world)
    heard: list[tuple[str, float]] = []
    for on in (world.on_begin, world.on_end, world.on_hit):
        on(lambda event: heard.append((event.kind, event.time)))
    world.step(DT, steps=40)
    quiet.step(DT, steps=40)
    assert (world.positions == quiet.positions).all()
    for mine, other in (
        (world.events.begin, quiet.events.begin),
        (world.events.end, quiet.events.end),
        (world.events.hit, quiet.events.hit),
    ):
        assert (mine.times == other.times).all()
        assert (mine.bodies == other.bodies).all()
        kinds = {event.kind for event in other}
        told = [time for kind, time in heard if kind in kinds]
        assert sorted(told) == sorted(other.times.tolist())

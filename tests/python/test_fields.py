"""Fields of the user's own: their physics, what they may return, what they may not touch."""

import copy
import math
import pickle
import threading
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

import culbuto as cb

Array = NDArray[np.float64]


def gravitation(state: cb.State) -> Array:
    """Of a sun at the origin, GM = 1 m³/s²."""
    r = np.linalg.norm(state.positions, axis=1)[:, None]
    force: Array = -state.masses[:, None] * state.positions / r**3
    return force


def depth(state: cb.State) -> float:
    return float(-np.sum(state.masses / np.linalg.norm(state.positions, axis=1)))


def magnetic(state: cb.State) -> Array:
    """Across the velocity: F = v × B, B = 3 kg/s."""
    return 3 * np.stack([state.velocities[:, 1], -state.velocities[:, 0]], axis=1)


class Spring:
    """A law with numbers of its own, which travels with its world."""

    def __init__(self, stiffness: float) -> None:
        self.stiffness = stiffness

    def __call__(self, state: cb.State) -> tuple[Array, Array]:
        return -self.stiffness * state.positions, -state.angles


def orbit() -> tuple[cb.World, cb.Body]:
    world = cb.World((0, 0))
    return world, world.add_body(mass=2, inertia=1.0, position=(1, 0), velocity=(0, 1))


def test_kepler() -> None:
    world, body = orbit()
    field = world.add_field(gravitation, potential=depth, velocity_dependent=False)
    assert (field.name, field.function) == ("gravitation", gravitation)
    assert (field.potential, field.conservative, field.velocity_dependent) == (depth, True, False)
    assert world.energy.total == pytest.approx(-1)
    world.advance(2 * math.pi, 1e-12)
    assert body.position == pytest.approx((1, 0), abs=1e-10)
    assert world.energy.total == pytest.approx(-1, abs=1e-11)
    assert world.energy.work == 0
    # The engine's own does the same, step for step.
    twin, other = orbit()
    central = twin.add_field(cb.Central((0, 0), 1, -2, per_mass=True))
    assert central.function == cb.Central((0, 0), 1, -2, per_mass=True)
    twin.advance(2 * math.pi, 1e-12)
    assert other.position == pytest.approx(tuple(body.position), abs=1e-11)


@pytest.mark.parametrize("method", [m.name for m in cb.methods()])
def test_fields_are_seen_by_every_method(method: str) -> None:
    world, body = orbit()
    world.method = method
    world.add_field(gravitation)
    world.step(1e-3, 100)
    # 100 steps of 1 ms, 4 substeps: explicit Euler is off by about t·h/2 = 1.25e-5.
    assert body.position == pytest.approx((math.cos(0.1), math.sin(0.1)), abs=3e-5)


def test_a_force_across_the_velocity_keeps_the_energy() -> None:
    world, body = orbit()
    world.add_field(magnetic)
    world.advance(10, 1e-12)
    assert body.kinetic_energy == pytest.approx(1, abs=1e-10)
    assert world.energy.work == pytest.approx(0, abs=1e-9)
    # Cyclotron: ω = −B/m = −1.5 rad/s, radius v/ω = 2/3 m about (1 + 2/3, 0) … turned by −15 rad.
    angle = math.pi - 15
    exact = (1 + 2 / 3 + 2 / 3 * math.cos(angle), 2 / 3 * math.sin(angle))
    assert body.position == pytest.approx(exact, abs=1e-9)


def test_torques_too() -> None:
    world, body = orbit()
    body.angle = 1
    world.add_field(Spring(2))
    world.advance(math.pi, 1e-12)
    assert body.angle == pytest.approx(-1, abs=1e-10)
    assert body.position == pytest.approx((-1, 0), abs=1e-10)
    assert world.fields[0].name == "Spring"


def test_the_state_is_that_of_the_bodies() -> None:
    world, _ = orbit()
    world.add_body([cb.Circle(1, center=(1, 0))], angle=1, angular_velocity=2)
    world.time = 5
    world.method = "rk4"  # begins with the forces at the start
    seen: list[cb.State] = []

    def see(state: cb.State) -> Array:
        seen.append(state)
        return np.zeros((2, 2))

    world.add_field(see)
    expected = [world.centers, world.angles, world.velocities, world.angular_velocities]
    expected += [world.masses, world.inertias]
    world.step(1)
    first = seen[0]
    assert (first.time, len(first)) == (5, 2)
    got = [first.positions, first.angles, first.velocities, first.angular_velocities]
    for a, b in zip([*got, first.masses, first.inertias], expected, strict=True):
        np.testing.assert_array_equal(a, b)
    with pytest.raises(AttributeError):
        first.time = 3  # type: ignore[misc]


@pytest.mark.parametrize(
    ("result", "message"),
    [
        (np.zeros((2, 2)), r"force of field \"bad\" has shape \(2, 2\); wanted .* \(1, 2\)"),
        (np.zeros(2), r"force of field \"bad\" has shape \(2,\)"),
        (None, r"force of field \"bad\""),
        ([(math.nan, 0)], r"force of field \"bad\" on body 0 is \(NaN, 0\)"),
        (([(1, 0)], [math.inf]), r"torque of field \"bad\" on body 0 is inf"),
        (([(1, 0)], [1, 2]), r"torque of field \"bad\" has shape \(2,\)"),
    ],
)
def test_what_it_returns_is_checked(result: Any, message: str) -> None:
    world, body = orbit()
    world.add_field(lambda _: result, name="bad")
    for act in (lambda: world.step(1), lambda: world.advance(1), lambda: world.record(1, 1)):
        with pytest.raises(ValueError, match=message):
            act()
        assert (body.position, world.time) == ((1, 0), 0)


def test_a_potential_is_checked() -> None:
    world, _ = orbit()
    world.add_field(gravitation, potential=lambda _: math.nan)
    with pytest.raises(ValueError, match='potential of field "gravitation" is NaN'):
        world.energy  # noqa: B018


class OwnError(Exception):
    pass


def test_its_errors_come_out_and_the_world_is_as_before() -> None:
    world, body = orbit()

    def fail(state: cb.State) -> Array:
        if state.time > 0.5:
            raise OwnError(state.time)
        return gravitation(state)

    world.add_field(fail)
    world.step(0.1)
    before = world.snapshot()
    with pytest.raises(OwnError) as caught:
        world.step(0.1, 10)
    assert caught.traceback[-1].name == "fail"
    other = before.to_world()
    np.testing.assert_array_equal(other.positions, world.positions)
    assert body.position == other.bodies[0].position
    assert world.time == other.time


def touching(world: cb.World, body: cb.Body) -> list[Callable[[], Any]]:
    return [
        lambda: body.position,
        lambda: setattr(body, "position", (0, 0)),
        lambda: world.positions,
        lambda: world.energy,
        lambda: world.step(1),
        lambda: world.add_body(mass=1),
        world.snapshot,
        lambda: world.fields[0].name,
        lambda: world.remove(body),
        lambda: copy.copy(world),
        lambda: pickle.dumps(world),
    ]


@pytest.mark.parametrize("which", range(11))
def test_a_field_that_touches_its_world_is_told_so(which: int) -> None:
    world, body = orbit()
    law: Any = lambda _: touching(world, body)[which]()  # noqa: E731
    world.add_field(law)
    outcome: list[BaseException] = []

    def run() -> None:
        try:
            world.step(1)
        except BaseException as error:
            outcome.append(error)

    thread = threading.Thread(target=run, daemon=True)
    thread.start()
    thread.join(20)
    assert not thread.is_alive(), "deadlock"
    assert isinstance(outcome[0], RuntimeError)
    assert "at work" in str(outcome[0])
    assert body.position == (1, 0)
    assert "Body" in repr(body)


def test_a_field_may_use_other_worlds() -> None:
    world, _ = orbit()
    other, body = orbit()

    def follow(state: cb.State) -> Array:
        other.step(0.01)
        return np.tile(body.position, (len(state), 1))

    world.add_field(follow, velocity_dependent=False)
    world.step(0.1)
    assert other.time > 0


def test_oscillating_acts_on_its_body_until_it_is_removed() -> None:
    world = cb.World((0, 0))
    first, body = (world.add_body(mass=2, inertia=3.0) for _ in range(2))
    push = cb.Oscillating(body, force=(1, 0), torque=1, hertz=0.5)
    field = world.add_field(push)
    assert field.function == push
    assert field.function.body is body  # type: ignore[union-attr]
    world.advance(1, 1e-12)
    # ∫ sin(π t) dt over a second is 2/π.
    assert body.velocity == pytest.approx((1 / math.pi, 0), abs=1e-11)
    assert body.angular_velocity == pytest.approx(2 / 3 / math.pi, abs=1e-11)
    assert first.velocity == (0, 0)
    body.remove()
    world.step(1)
    assert field.function is None
    with pytest.raises(cb.StaleHandleError):
        world.add_field(push)
    with pytest.raises(cb.StaleHandleError, match="another world"):
        cb.World().add_field(cb.Oscillating(first, (1, 0)))


def test_attraction_obeys_the_third_law() -> None:
    world = cb.World((0, 0))
    for i in range(3):
        world.add_body(mass=1 + i, position=(i, i * i))
    assert world.third_law_residual() is None
    world.add_field(cb.Attraction(2.0))
    world.step(0.01, 100)
    residual = world.third_law_residual()
    assert residual is not None
    assert residual < 1e-15
    assert world.momentum == pytest.approx((0, 0), abs=1e-14)
    world.add_field(lambda s: s.positions * 0 + 1, internal=True)
    assert world.third_law_residual() == pytest.approx(1)


def test_fields_are_removed() -> None:
    world, body = orbit()
    fields = [world.add_field(Spring(k)) for k in (1, 2, 3)]
    assert world.fields == fields
    fields[0].remove()
    assert world.fields == [fields[2], fields[1]]
    world.remove(fields[2])
    assert [field.removed for field in fields] == [True, False, True]
    world.advance(math.pi, 1e-12)  # 2 N/m on 2 kg
    assert body.position == pytest.approx((-1, 0), abs=1e-10)
    with pytest.raises(cb.StaleHandleError):
        fields[0].name  # noqa: B018
    with pytest.raises(TypeError, match="knows its potential"):
        world.add_field(cb.Attraction(1.0), internal=True)

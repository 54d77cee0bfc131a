"""The laws of mechanics, seen from Python.

ε is the rounding of one operation (2.2e-16). A law that holds whatever the step is asked for to
`rounding`: a few ε for each time a number is updated. What a method only approximates may be off
by (rate·h)^order, its local error, once for every 1/rate of time, where `rate` (1/s) is the fastest
that anything in the world changes: the angular frequency of the stiffest pair, or speed over
distance.
"""

import itertools
import math
from collections.abc import Callable
from dataclasses import dataclass
from random import Random

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.typing import NDArray

import culbuto as cb

Array = NDArray[np.float64]
EPSILON = float(np.finfo(float).eps)
FACTS = {facts.name: facts for facts in cb.methods()}
SOFTENING, STRENGTH, STIFFNESS = 0.5, 0.5, 2.0
H, STEPS = 0.01, 20
STAGES = 22  # most roundings of a number within a step: yoshida6 has 7 kicks, three in each

near = st.floats(-2, 2)
masses = st.floats(0.5, 5)
point = st.tuples(near, near)


@dataclass(frozen=True)
class Bodies:
    """Where bodies begin: one row each of x, y, angle, u, v, ω, mass."""

    rows: Array

    def world(self, method: str = "leapfrog", **settings: object) -> cb.World:
        world = cb.World((0, 0), method=method, substeps=1, closed_form=False)
        for name, value in settings.items():
            setattr(world, name, value)
        for x, y, angle, u, v, spin, mass in self.rows.tolist():
            world.add_body(
                cb.Box(0.4, 0.2), position=(x, y), angle=angle, velocity=(u, v),
                angular_velocity=spin, mass=mass, mask=0,  # free motion: they touch nothing
            )  # fmt: skip
        return world

    @property
    def frequency(self) -> float:
        """√(ΣGm/softening³ + n·k/m) (1/s): how fast neighbouring motions can part."""
        mass = self.rows[:, 6]
        pull, tie = STRENGTH * mass.sum() / SOFTENING**3, STIFFNESS * 5 / mass.min()
        return math.sqrt(pull + tie)

    @property
    def rate(self) -> float:
        """Frequency + speed/softening, the speed at the end included (1/s)."""
        speed = np.hypot(*self.rows[:, 3:5].T).max() + self.frequency**2 * SOFTENING * H * STEPS
        return float(self.frequency + speed / SOFTENING)

    def rounding(self, steps: int) -> float:
        """Of numbers of size 1 after so many steps: those made so far grow as motions part."""
        growth = (self.frequency + 1) * math.exp(self.frequency * H * steps)
        return 4 * EPSILON * STAGES * steps * growth


rows = st.lists(st.tuples(near, near, near, near, near, near, masses), min_size=2, max_size=5)
bodies = rows.map(lambda rows: Bodies(np.array(rows)))
methods = st.sampled_from(sorted(FACTS))


def attract(world: cb.World) -> None:
    world.add_field(cb.Attraction(STRENGTH, -2, SOFTENING))


def spring(world: cb.World) -> None:
    """Springs between all pairs, as code of one's own."""

    def force(state: cb.State) -> Array:
        apart = state.positions[:, None] - state.positions[None]
        total: Array = -STIFFNESS * apart.sum(axis=1)
        return total

    def potential(state: cb.State) -> float:
        apart = state.positions[:, None] - state.positions[None]
        return float(STIFFNESS / 4 * np.sum(apart**2))  # each pair is there twice

    world.add_field(force, potential=potential, velocity_dependent=False, internal=True)


FORCES: list[Callable[[cb.World], None]] = [attract, spring]


@pytest.mark.parametrize("act", FORCES)
@given(bodies, methods)
def test_isolated_bodies(act: Callable[[cb.World], None], start: Bodies, method: str) -> None:
    world, facts, rate = start.world(method), FACTS[method], start.rate
    act(world)
    before = world.momentum, world.angular_momentum(), world.energy
    world.step(H, STEPS)
    # Σm|v| and Σm|x||v| + I|ω|: what the sums are made of. A speed changes by rate²·softening·t at
    # most where they attract, by stiffness·n·distance/m·t where they are tied: 2·5·6/0.5·0.2 < 48.
    speed = 3 + 48 + rate**2 * SOFTENING * H * STEPS
    p, reach = world.mass * speed, 3 + speed * H * STEPS
    spin = p * reach + float(world.inertias.sum()) * 2
    joule = abs(before[2].kinetic) + abs(before[2].potential) + 1
    rounding = 4 * EPSILON * STEPS * STAGES
    assert (world.momentum - before[0]).length <= rounding * p
    truncation = (rate * H) ** facts.order * max(1, rate * H * STEPS)
    turned = abs(world.angular_momentum() - before[1])
    assert turned <= spin * (rounding + (0 if facts.symplectic else truncation))
    assert abs(world.energy.total - before[2].total) <= joule * (20 * truncation + 1e-13)
    assert world.energy.work == 0


@pytest.mark.parametrize("act", FORCES)
@given(bodies)
def test_the_third_law(act: Callable[[cb.World], None], start: Bodies) -> None:
    world = start.world()
    assert world.third_law_residual() is None
    act(world)
    # n² forces, each rounded three times; torques multiply by a position, which rounds once more.
    residual = world.third_law_residual()
    assert residual is not None
    assert residual <= 4 * EPSILON * len(world) ** 2


def test_a_field_that_lies_is_found_out() -> None:
    world = Bodies(np.ones((3, 7))).world()
    world.add_field(lambda state: np.ones((len(state), 2)), internal=True)
    assert world.third_law_residual() == pytest.approx(1, rel=0.1)


# Symmetries: a run of the changed world is the changed run.


def run(start: Bodies, method: str, gravity: cb.Vec2 | Array, shift: float = 0.0) -> Array:
    """Rows (n, 6) of where it ends."""
    settings = {"gravity": tuple(gravity), "air_density": 0.1}
    world = start.world(method, **settings)
    attract(world)
    world.add_field(cb.Central((shift, 0), 1, 1, per_mass=True))
    world.step(H, STEPS)
    columns = [world.positions, world.angles[:, None], world.velocities]
    return np.hstack([*columns, world.angular_velocities[:, None]])


def agree(a: Array, b: Array, start: Bodies, size: float = 4.0) -> None:
    np.testing.assert_allclose(a, b, rtol=0, atol=size * start.rounding(STEPS))


@given(bodies, methods, st.randoms(use_true_random=False))
def test_the_order_of_creation(start: Bodies, method: str, random: Random) -> None:
    order = list(range(len(start.rows)))
    random.shuffle(order)
    down = np.array([0, -9.81])
    there = run(start, method, down)[order]
    agree(run(Bodies(start.rows[order]), method, down), there, start)


@given(bodies, methods, st.floats(-100, 100))
def test_translation(start: Bodies, method: str, shift: float) -> None:
    moved = start.rows.copy()
    moved[:, 0] += shift
    down = np.array([0, -9.81])
    expected = run(start, method, down)
    expected[:, 0] += shift
    agree(run(Bodies(moved), method, down, shift), expected, start, 4 + abs(shift))


@given(bodies, methods, st.floats(-4, 4), st.booleans())
def test_rotation_and_mirror(start: Bodies, method: str, angle: float, mirror: bool) -> None:
    c, s = math.cos(angle), math.sin(angle)
    turn = np.array([[c, -s], [s, c]]) @ np.diag([1, -1 if mirror else 1])
    sense = -1 if mirror else 1

    def changed(rows: Array) -> Array:
        new = rows.copy()
        new[:, :2], new[:, 3:5] = rows[:, :2] @ turn.T, rows[:, 3:5] @ turn.T
        new[:, 2], new[:, 5] = sense * rows[:, 2] + angle, sense * rows[:, 5]
        return new

    down = np.array([0, -9.81])
    expected = changed(run(start, method, down))
    agree(run(Bodies(changed(start.rows)), method, turn @ down), expected, start)


@given(bodies, st.sampled_from(["leapfrog", "yoshida4", "yoshida6"]), st.sampled_from(FORCES))
def test_time_reversal(start: Bodies, method: str, act: Callable[[cb.World], None]) -> None:
    world = start.world(method)
    act(world)
    first = world.positions, world.angles, world.velocities, world.angular_velocities
    for _ in range(2):
        world.step(H, STEPS)
        world.velocities, world.angular_velocities = -world.velocities, -world.angular_velocities
    allowed = 4 * start.rounding(2 * STEPS)
    last = world.positions, world.angles, world.velocities, world.angular_velocities
    for a, b in zip(first, last, strict=True):
        np.testing.assert_allclose(a, b, rtol=0, atol=allowed)


@given(bodies, methods, st.floats(0.01, 100))
def test_similarity(start: Bodies, method: str, s: float) -> None:
    """Lengths times s and times times √s leave accelerations, and so the motion, as they are."""
    results = []
    for length in (1.0, s):
        time = math.sqrt(length)
        scale = np.array([length, length, 1, length / time, length / time, 1 / time, 1])
        world = Bodies(start.rows * scale).world(method, gravity=(0, -9.81))
        world.add_field(cb.Attraction(STRENGTH * length**2, -2, SOFTENING * length))
        world.add_field(cb.Central((0, 0), 3 / length, 1, per_mass=True))
        world.step(H * time, STEPS)
        turned = [world.angles, world.angular_velocities * time]
        results.append((world.positions / length, world.velocities * time / length, *turned))
    for a, b in zip(*results, strict=True):
        agree(a, b, start)


@given(
    st.sampled_from([None, *(name for name, f in FACTS.items() if f.exact_for_constant_force)]),
    st.tuples(point, point, point, masses, st.floats(1e-3, 1e3)),
)
def test_a_constant_force_is_exact(method: str | None, given: tuple[Array, ...]) -> None:
    position, velocity, force, mass, dt = (np.array(part) for part in given)
    world = cb.World((0, -9.81), method=method or "leapfrog", closed_form=method is None)
    body = world.add_body(
        position=position, velocity=velocity, force=force, torque=2.0, mass=float(mass), inertia=4.0
    )
    world.step(float(dt))
    a = force / mass + (0, -9.81)
    # Four substeps, each a few dozen roundings of terms no larger than these.
    size = 100 * EPSILON * (np.abs(position) + np.abs(velocity) * dt + np.abs(a) * dt**2 + 1e-300)
    assert np.all(np.abs(position + velocity * dt + a / 2 * dt**2 - body.position) <= size)
    size = 100 * EPSILON * (np.abs(velocity) + np.abs(a) * dt + 1e-300)
    assert np.all(np.abs(velocity + a * dt - body.velocity) <= size)
    assert body.angle == pytest.approx(0.25 * float(dt) ** 2, rel=100 * EPSILON)


@given(point, point, point, near)
def test_a_force_at_a_point_turns(
    place: tuple[float, float], at: tuple[float, float], force: tuple[float, float], angle: float
) -> None:
    world = cb.World((0, 0))
    body = world.add_body(
        [cb.Circle(0.5), cb.Box(1, 2, center=(1, 0))], position=place, angle=angle
    )
    arm = cb.Vec2(*at) - body.center_of_mass
    body.apply_force(force, at=at)
    world.step(0.5)
    assert body.angular_velocity == pytest.approx(
        0.5 * arm.cross(force) / body.inertia,
        abs=16 * EPSILON * (arm.length + 4) * math.hypot(*force) / body.inertia,
    )
    expected = cb.Vec2(*force) * (0.5 / body.mass)
    assert (body.velocity - expected).length <= 4 * EPSILON * expected.length


# Inertia. A polygon that the origin sees whole: vertices in steps of less than half a turn.


@st.composite
def polygons(draw: st.DrawFn) -> Array:
    n = draw(st.integers(4, 9))
    turns = [2 * math.pi * (i + draw(st.floats(0, 0.8))) / n for i in range(n)]
    radii = [draw(st.floats(0.5, 2)) for _ in turns]
    return np.array([(r * math.cos(t), r * math.sin(t)) for r, t in zip(radii, turns, strict=True)])


def joined(parts: list[cb.MassProperties]) -> cb.MassProperties:
    """Parts as one body: centres averaged, inertias moved to the common centre (Steiner)."""
    mass = sum(part.mass for part in parts)
    center = sum((part.center * part.mass for part in parts), cb.Vec2(0, 0)) / mass
    steiner = [part.mass * (part.center - center).length ** 2 for part in parts]
    return cb.MassProperties(mass, center, sum(part.inertia for part in parts) + sum(steiner))


def alike(a: cb.MassProperties, b: cb.MassProperties, reach: float = 3.0) -> None:
    """To 50 roundings of what lies within `reach` (m), mass and inertia being 1/4 at least."""
    allowed = 50 * EPSILON * b.mass * reach**2 * 4
    assert abs(a.mass - b.mass) <= allowed
    assert (a.center - b.center).length <= allowed
    assert abs(a.inertia - b.inertia) <= allowed * reach


def weighed(body: cb.Body) -> cb.MassProperties:
    return cb.MassProperties(body.mass, body.center_of_mass, body.inertia)


@given(polygons(), st.floats(-10, 10), st.floats(-10, 10), st.floats(-4, 4))
def test_inertia_does_not_change_with_place(
    vertices: Array, x: float, y: float, angle: float
) -> None:
    c, s = math.cos(angle), math.sin(angle)
    turn = np.array([[c, -s], [s, c]])
    own = cb.Polygon(vertices).mass_properties(1)
    moved = cb.Polygon(vertices @ turn.T + (x, y)).mass_properties(1)
    center = cb.Vec2(*(turn @ np.array(own.center) + (x, y)))
    alike(moved, replace_center(own, center), 3 + math.hypot(x, y))
    body = cb.World().add_body(cb.Polygon(vertices), position=(x, y), angle=angle)
    alike(weighed(body), replace_center(own, center), 3 + math.hypot(x, y))


def replace_center(of: cb.MassProperties, center: cb.Vec2) -> cb.MassProperties:
    return cb.MassProperties(of.mass, center, of.inertia)


@given(polygons(), polygons(), point, masses)
def test_parallel_axes(a: Array, b: Array, offset: tuple[float, float], density: float) -> None:
    """Of two polygons in one body, one denser."""
    shapes = [cb.Polygon(a), cb.Polygon(b + offset, density=density)]
    body = cb.World().add_body(shapes)
    expected = joined([shapes[0].mass_properties(1), shapes[1].mass_properties(density)])
    alike(weighed(body), expected, 6)


@given(polygons())
def test_split_and_joined(vertices: Array) -> None:
    pairs = itertools.pairwise([*vertices, vertices[0]])
    slices = [cb.Polygon([(0, 0), v, w]) for v, w in pairs]
    whole = cb.Polygon(vertices).mass_properties(1)
    alike(joined([part.mass_properties(1) for part in slices]), whole)
    alike(weighed(cb.World().add_body(slices)), whole)


@given(polygons())
def test_inertia_is_the_integral(vertices: Array) -> None:
    """Over cells of side s, by their middles.

    A cell that no edge cuts errs by ∫r² − r₀²s² = s⁴/6; one that is cut, by no more than itself,
    R²s² with R = 2 m + s. An edge of length L cuts at most √2·L/s + 3.
    """
    s = 0.01
    axis = np.arange(-2 + s / 2, 2, s)
    x, y = np.meshgrid(axis, axis)
    inside = np.zeros_like(x, bool)
    cut = 0.0
    for v, w in itertools.pairwise([*vertices, vertices[0]]):
        sector = (v[0] * y - v[1] * x >= 0) & (x * w[1] - y * w[0] >= 0)
        inside |= sector & ((w - v)[0] * (y - v[1]) - (w - v)[1] * (x - v[0]) >= 0)
        cut += math.sqrt(2) * float(np.hypot(*(w - v))) / s + 3
    own = cb.Polygon(vertices).mass_properties(1)
    assert abs(own.mass - s**2 * inside.sum()) <= cut * s**2
    polar = own.inertia + own.mass * own.center.length**2
    sampled = s**2 * float((x**2 + y**2)[inside].sum())
    assert abs(polar - sampled) <= cut * s**2 * (2 + s) ** 2 + own.mass * s**2 / 6

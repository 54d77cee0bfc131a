"""Fluids from Python."""

from __future__ import annotations

import copy
import pickle

import numpy as np
import pytest

import culbuto as cb

DT = 1 / 60


def sent(world: cb.World) -> cb.World:
    return pickle.loads(pickle.dumps(world))  # type: ignore[no-any-return] # noqa: S301


def tank(
    width: float = 1.0, height: float = 0.6, spacing: float = 0.05
) -> tuple[cb.World, cb.Fluid]:
    world = cb.World()
    world.add_body(cb.Box(width + 1, 0.5), kind="static", position=(width / 2, -0.25))
    for x in (-0.25, width + 0.25):
        world.add_body(cb.Box(0.5, 3), kind="static", position=(x, 1.5))
    water = cb.Box(width, height, center=(width / 2, height / 2))
    return world, world.add_fluid(water, spacing=spacing, viscosity=0.5)


def test_water_settles_and_shows_its_pressure_and_height() -> None:
    world, water = tank()
    n = len(water)
    assert n == 240
    world.step(DT, steps=60)
    assert water.positions.shape == (n, 2)
    assert np.sqrt(np.mean(water.velocities**2)) < 0.06
    level = world.height_at(0.5)
    assert level == pytest.approx(0.6, abs=0.03)
    pressure = world.pressure_at((0.5, 0.2))
    assert pressure == pytest.approx(1000 * 9.81 * 0.4, rel=0.15)
    assert world.pressure_at((0.5, 5.0)) is None
    assert world.height_at(9.0) is None
    force, _ = world.fluid_load(world.bodies[0])
    assert -force.y == pytest.approx(9.81 * n * water.particle_mass, rel=0.1)
    assert water.densities.shape == water.pressures.shape == (n,)
    assert world.threads == 1


def test_particles_keep_their_order_and_come_and_go() -> None:
    world = cb.World(gravity=(0, 0))
    drops = np.array([[0.0, 0.0], [3.0, 1.0], [-2.0, 5.0]])
    fluid = world.add_fluid(drops, spacing=0.1, density=800.0)
    fluid.velocities = [[1.0, 0.0], [0.0, 1.0], [0.0, 0.0]]
    world.step(0.5)
    expected = drops + 0.5 * np.array([[1.0, 0.0], [0.0, 1.0], [0.0, 0.0]])
    np.testing.assert_allclose(fluid.positions, expected, atol=1e-12)
    fluid.add([[9.0, 9.0]], velocity=(1, 1))
    fluid.remove_particles([1])
    np.testing.assert_allclose(fluid.positions, [*expected[[0, 2]], [9.0, 9.0]], atol=1e-12)
    assert world.mass == pytest.approx(3 * fluid.particle_mass)
    with pytest.raises(ValueError, match="particle"):
        fluid.remove_particles([7])
    world.remove(fluid)
    assert fluid.removed
    assert world.fluids == []
    with pytest.raises(cb.StaleHandleError):
        _ = fluid.positions


def test_copies_and_pickles_continue_bit_for_bit() -> None:
    world, _ = tank()
    body = world.add_body(cb.Circle(0.1), position=(0.5, 0.9), density=300)
    for _ in range(20):
        world.step(DT)
    others = [copy.copy(world), sent(world), world.snapshot().to_world()]
    for _ in range(5):
        world.step(DT)
    for other in others:
        for _ in range(5):
            other.step(DT)
        np.testing.assert_array_equal(other.fluids[0].positions, world.fluids[0].positions)
        np.testing.assert_array_equal(other.positions, world.positions)
    assert body.position.y < 0.9


def test_what_is_not_allowed_is_said() -> None:
    world, water = tank()
    with pytest.raises(ValueError, match="spacing"):
        world.add_fluid([[0.0, 0.0]], spacing=0.1)
    with pytest.raises(ValueError, match="density"):
        water.density = -1.0
    with pytest.raises(ValueError, match="tolerance"):
        world.advance(1.0, tolerance=1e-6)


def test_a_nozzle_a_drain_and_a_lifetime() -> None:
    world = cb.World(gravity=(0, 0))
    fluid = world.add_fluid(spacing=0.05, tension=0.2, adhesion=0.1, name="ink")
    assert (fluid.tension, fluid.adhesion, fluid.name) == (0.2, 0.1, "ink")
    fluid.inflows = [cb.Inflow((0, 0), (0, 0.2), (1, 0))]
    world.drains = [cb.Box(1, 1, center=(1, 0))]
    world.step(DT, steps=60)
    count = len(fluid)
    assert 40 <= count <= 52
    assert fluid.inflows[0].progress is not None
    assert world.drains == [cb.Box(1, 1, center=(1, 0))]
    assert world.surface_energy > 0
    fluid.lifetime = 0.1
    fluid.inflows = []
    world.step(DT, steps=10)
    assert len(fluid) == 0
    with pytest.raises(ValueError, match="velocity"):
        fluid.inflows = [cb.Inflow((0, 0), (0, 1), (0, 1))]
    fluid.tension = 0.0
    with pytest.raises(ValueError, match="tension"):
        fluid.tension = -1.0


def test_scene_files_hold_fluids() -> None:
    world, water = tank()
    water.inflows = [cb.Inflow((0.2, 0.4), (0.4, 0.4), (0, 1))]
    drop = world.add_fluid([[0.5, 1.0]], spacing=0.05, density=500, name="drop")
    drop.tension, drop.adhesion, drop.lifetime = 0.2, 0.1, 8.5 * DT
    world.drains = [cb.Circle(0.1, center=(0.9, 0.1))]
    world.step(DT, steps=5)
    file = cb.SceneFile.from_world(world)
    other = cb.SceneFile.from_json(file.to_json()).world()
    held = other.fluids[1]
    assert (held.name, held.density, held.viscosity) == ("drop", 500, drop.viscosity)
    assert (held.tension, held.adhesion, held.lifetime) == (0.2, 0.1, 8.5 * DT)
    assert len(held) == 1
    for each in (world, other):
        each.step(DT, steps=5)
    assert len(held) == 0
    for fluid, copied in zip(world.fluids, other.fluids, strict=True):
        np.testing.assert_array_equal(fluid.positions, copied.positions)


def test_pictures_show_particles() -> None:
    world, water = tank()
    picture = world._repr_svg_()
    assert picture.count('class="fluid"') == 1
    assert picture.count("h0") == len(water)

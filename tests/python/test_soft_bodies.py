"""Deformable bodies from Python."""

import copy
import pickle
import weakref
from collections.abc import Callable
from pathlib import Path
from typing import Any
from xml.etree import ElementTree as ET

import numpy as np
import pytest

import culbuto as cb
from culbuto.drawing import picture, svg
from culbuto.soft_drawing import COLOUR, SoftMark

DT = 1 / 60


def sent(world: cb.World) -> cb.World:
    return pickle.loads(pickle.dumps(world))  # type: ignore[no-any-return] # noqa: S301


def with_floor() -> cb.World:
    world = cb.World()
    world.add_body(cb.Box(40, 1), kind="static", position=(0, -0.5))
    return world


def jelly(world: cb.World, **given: Any) -> cb.SoftBody:
    usual = {
        "position": (0.0, 0.8),
        "density": 100.0,
        "youngs_modulus": 1e5,
        "damping_ratio": 0.3,
        "damping_frequency": 5.0,
    }
    return world.add_soft_body(cb.Box(1, 1), size=0.25, **{**usual, **given})


def ring(n: int = 32, radius: float = 0.6) -> np.ndarray[Any, np.dtype[np.float64]]:
    turn = np.linspace(0, 2 * np.pi, n, endpoint=False)
    return radius * np.stack([np.cos(turn), np.sin(turn)], axis=1)


def balloon(world: cb.World, **given: Any) -> cb.SoftBody:
    gas = {"gas_pressure": 1.02e5, "outside_pressure": 1e5, "gas_exponent": 1.4}
    skin = {"stretch_stiffness": 3e3, "density": 1.0, "damping_ratio": 0.3}
    return world.add_soft_body(ring(), closed=True, **{**gas, **skin, **given})


def test_a_cantilever_bends_as_timoshenko_says() -> None:
    length, height, e, nu, load = 1.0, 0.1, 1e8, 0.3, -100.0
    world = cb.World(gravity=(0, 0))
    # Critically damped at its own lowest frequency.
    hertz = 1.875**2 / (2 * np.pi * length**2) * np.sqrt(e * height**2 / 12 / 1000)
    beam = world.add_soft_body(
        cb.Box(length, height, center=(length / 2, 0)),
        size=0.05,
        youngs_modulus=e,
        poissons_ratio=nu,
        damping_ratio=1.0,
        damping_frequency=hertz,
    )
    beam.pinned = beam.rest[:, 0] < 1e-9
    end = np.flatnonzero(beam.rest[:, 0] > length - 1e-9)
    forces = np.zeros((len(beam), 2))
    forces[end, 1] = load / len(end)
    beam.forces = forces
    np.testing.assert_array_equal(beam.forces, forces)
    world.step(0.01, steps=300)
    # PL³/3EI + PL/κGA, κ of a rectangle by Cowper.
    kappa, shear = 10 * (1 + nu) / (12 + 11 * nu), e / (2 * (1 + nu))
    expected = load * length**3 / (3 * e * height**3 / 12) + load * length / (
        kappa * shear * height
    )
    deflection = float(np.mean(beam.positions[end, 1] - beam.rest[end, 1]))
    assert deflection == pytest.approx(expected, rel=0.02)
    assert beam.kinetic_energy < 1e-6 * beam.strain_energy
    # The work of a load that grows with the deflection.
    assert beam.strain_energy == pytest.approx(0.5 * load * deflection, rel=0.01)
    # Bending stress 6M/bh² at the clamped end, of which the means over elements show a part.
    assert 0.4 < beam.stresses[:, 0].max() / (6 * -load * length / height**2) < 1.0


def test_a_stretched_sheet_has_the_stress_and_strain_of_hookes_law() -> None:
    strain, e, nu = 1e-6, 1e7, 0.3
    thick = e * (1 - nu) / ((1 + nu) * (1 - 2 * nu))
    for plane, modulus in (("stress", e / (1 - nu**2)), ("strain", thick)):
        body = jelly(
            cb.World(gravity=(0, 0)),
            youngs_modulus=e,
            poissons_ratio=nu,
            plane=plane,
            position=(0, 0),
        )
        body.positions = body.rest * [1 + strain, 1]
        assert body.plane == plane
        n = len(body.triangles)
        np.testing.assert_allclose(body.strains, np.tile([strain, 0, 0], (n, 1)), atol=1e-9)
        np.testing.assert_allclose(body.stresses[:, 0], modulus * strain, rtol=1e-4)
        assert body.strain_energy == pytest.approx(0.5 * modulus * strain**2, rel=1e-4)


def test_momentum_and_energy_pass_between_soft_and_rigid() -> None:
    world = cb.World(gravity=(0, 0))
    soft = jelly(world, position=(0, 0), velocity=(3, 0.2), angular_velocity=2.0)
    box = world.add_body(cb.Box(0.7, 0.5), position=(2, 0.3), angular_velocity=-3.0, density=300.0)
    about = (0.4, -0.3)
    momentum, spin = world.momentum, world.angular_momentum(about)
    assert soft.momentum == pytest.approx((300, 20), rel=1e-12)
    assert soft.mass == pytest.approx(100)
    assert soft.node_masses.sum() == pytest.approx(100)
    assert soft.kinetic_energy == pytest.approx(0.5 * 100 * (9 + 0.04) + 0.5 * 100 / 6 * 4)
    assert world.mass == pytest.approx(soft.mass + box.mass)
    energy = world.energy
    world.step(DT, steps=120)
    assert np.linalg.norm(box.velocity) > 0.1
    assert world.momentum == pytest.approx(tuple(momentum), rel=1e-11)
    assert world.angular_momentum(about) == pytest.approx(spin, rel=1e-9)
    after = world.energy
    assert after.total + after.dissipated == pytest.approx(energy.total, rel=1e-9)


def test_a_dropped_jelly_comes_to_rest_on_the_floor() -> None:
    world = with_floor()
    soft = jelly(world, name="jelly")
    world.step(DT, steps=480)
    assert soft.positions[:, 1].min() == pytest.approx(soft.radius, abs=1e-4)
    assert np.abs(soft.velocities).max() < 0.02
    assert soft.center.y == pytest.approx(0.5, abs=0.01)
    assert soft.area == pytest.approx(1.0, abs=0.02)
    # Half of its weight is borne at half of its height.
    middle = np.abs(soft.rest[soft.triangles[:, :3], 1].mean(axis=1)) < 0.25
    assert soft.stresses[middle, 1].mean() == pytest.approx(-100 * 9.81 * 0.5, rel=0.1)


def test_meshes_are_of_shapes_outlines_and_triangles() -> None:
    world = cb.World()
    square = [(0, 0), (1, 0), (1, 1), (0, 1)]
    cut = world.add_soft_body(square, size=0.3)
    own = world.add_soft_body(square, triangles=np.array([[0, 1, 2], [0, 2, 3]]), pins=[0, 3])
    disk = world.add_soft_body(cb.Circle(0.5), size=0.1, angle=1.0)
    hole = cb.Polygon(square, holes=[[(0.4, 0.4), (0.6, 0.4), (0.6, 0.6), (0.4, 0.6)]])
    frame = world.add_soft_body(hole, size=0.3)
    assert world.soft_bodies == [cut, own, disk, frame]
    assert [round(body.area, 6) for body in (cut, own, frame)] == [1.0, 1.0, 0.96]
    assert disk.area == pytest.approx(np.pi / 4, rel=0.02)
    assert own.triangles[:, :3].tolist() == [[0, 1, 2], [0, 2, 3]]
    assert len(own) == 4 + 5
    assert np.flatnonzero(own.pinned).tolist() == [0, 3]
    np.testing.assert_array_equal(own.rest[:4], square)
    for body in (cut, own, disk, frame):
        middles = body.rest[body.triangles[:, [0, 1, 2]]] + body.rest[body.triangles[:, [1, 2, 0]]]
        np.testing.assert_allclose(body.rest[body.triangles[:, 3:]], middles / 2, atol=1e-12)
        assert body.border.shape[1] == 2
        assert body.rods.shape == (0, 2)


def test_a_rope_hangs_from_its_pins() -> None:
    world = cb.World()
    points = np.stack([np.zeros(21), np.linspace(0, -2, 21)], axis=1)
    rope = world.add_soft_body(
        points,
        stretch_stiffness=1e3,
        bending_stiffness=1e-3,
        density=0.5,
        pins=[0],
        damping_ratio=1.0,
        damping_frequency=4.0,
    )
    assert rope.triangles.shape == (0, 6)
    assert rope.rods.tolist() == [[i, i + 1] for i in range(20)]
    assert rope.mass == pytest.approx(1.0)
    world.step(DT, steps=600)
    # Its own weight draws it out by ρgL²/2EA.
    assert rope.positions[-1] == pytest.approx((0, -2 - 9.81 * 2 / 2e3), abs=1e-3)
    # The pin bears all but half a rod.
    assert rope.stresses[0, 0] == pytest.approx(9.81 * (1 - 0.5 / 20), rel=0.02)
    pinned = rope.pinned
    pinned[:] = False
    rope.pinned = pinned
    assert not rope.pinned.any()
    world.step(DT, steps=30)
    assert rope.momentum.y == pytest.approx(-9.81 / 2, rel=1e-2)


def test_a_balloon_bears_until_it_is_pricked() -> None:
    world = with_floor()
    skin = balloon(world, position=(0, 0.65))
    load = world.add_body(
        cb.Box(0.6, 0.4), position=(0, 1.8), density=200, lock_x=True, lock_rotation=True
    )
    world.step(DT, steps=600)
    assert load.position.y > 0.7
    pressure = skin.pressure
    assert pressure is not None
    assert pressure > 500
    skin.puncture()
    assert skin.pressure is None
    world.step(DT, steps=300)
    assert load.position.y < 0.4
    skin.inflate(1.02e5, outside=1e5, exponent=1.4)
    assert skin.pressure is not None


def test_it_is_an_object_of_its_world() -> None:
    world = cb.World()
    body, other = jelly(world), jelly(world, name="other")
    assert body == world.soft_bodies[0] != other
    assert len({body, other, world.soft_bodies[1]}) == 2
    assert weakref.ref(body)() is body
    vars(body)["colour"] = "red"
    assert vars(world.soft_bodies[0])["colour"] == "red"
    assert body.world is world
    assert (body.name, other.name) == (None, "other")
    assert repr(other) == f"<SoftBody 'other' of {len(other)} nodes>".replace("'", '"')
    assert (body.density, body.youngs_modulus, body.poissons_ratio) == (100.0, 1e5, 0.3)
    assert (body.damping_ratio, body.damping_frequency, body.yield_strain) == (0.3, 5.0, None)
    assert (body.friction, body.restitution) == ((0.5, 0.5), 0.0)
    world.remove(body)
    assert body.removed
    assert repr(body) == "<removed SoftBody>"
    assert world.soft_bodies == [other]
    with pytest.raises(cb.StaleHandleError, match="soft body"):
        _ = body.positions
    with pytest.raises(cb.StaleHandleError):
        body.remove()
    with pytest.raises(cb.StaleHandleError, match="another world"):
        cb.World().remove(other)
    other.remove()
    assert world.soft_bodies == []


WAYS: list[Callable[[cb.World], cb.World]] = [
    copy.copy, copy.deepcopy, sent, lambda world: world.snapshot().to_world(),
]  # fmt: skip


@pytest.mark.parametrize("way", WAYS)
def test_copies_and_pickles_continue_bit_for_bit(way: Callable[[cb.World], cb.World]) -> None:
    world = with_floor()
    jelly(world, position=(5, 0.6)).remove()
    soft, skin = jelly(world, angle=0.2), balloon(world, position=(2, 0.65))
    soft.pinned = np.arange(len(soft)) == 3
    world.step(DT, steps=20)
    other = way(world)
    for one in (world, other):
        one.step(DT, steps=10)
    assert len(other.soft_bodies) == 2
    for mine, theirs in zip((soft, skin), other.soft_bodies, strict=True):
        assert theirs.world is other
        np.testing.assert_array_equal(mine.positions, theirs.positions)
        np.testing.assert_array_equal(mine.pinned, theirs.pinned)
        assert mine.pressure == theirs.pressure


def test_objects_go_through_pickles_and_come_back_with_restore() -> None:
    world = with_floor()
    soft = jelly(world)
    vars(soft)["colour"] = "red"
    assert vars(copy.copy(world).soft_bodies[0])["colour"] == "red"
    for order in ((world, soft), (soft, world)):
        made = pickle.loads(pickle.dumps(order))  # noqa: S301
        new, body = sorted(made, key=lambda thing: isinstance(thing, cb.SoftBody))
        assert new.soft_bodies == [body]
        assert vars(body)["colour"] == "red"
    kept = world.snapshot()
    soft.remove()
    assert copy.deepcopy(soft).removed
    later = jelly(world, position=(3, 3))
    world.restore(kept)
    assert world.soft_bodies == [soft]
    assert not soft.removed
    assert later.removed
    other = cb.World()
    other.restore(kept)
    np.testing.assert_array_equal(other.soft_bodies[0].positions, soft.positions)


def test_scene_files_hold_it(tmp_path: Path) -> None:
    world = with_floor()
    body = jelly(world, name="jelly")
    world.add_joint(cb.DistanceJoint(None, body, points=[(0, 3), body.positions[0]]))
    world.step(DT, 20)
    path = tmp_path / "scene.json"
    world.save(path)
    other = cb.World.from_file(path)
    (copy,) = other.soft_bodies
    assert copy.name == "jelly"
    np.testing.assert_array_equal(copy.positions, body.positions)
    np.testing.assert_array_equal(copy.velocities, body.velocities)
    assert other.joints[0].body_b is copy
    world.step(DT, 5)
    other.step(DT, 5)
    np.testing.assert_allclose(copy.positions, body.positions, atol=1e-6)


SQUARE = [(0, 0), (1, 0), (1, 1), (0, 1)]
BAD: list[tuple[dict[str, Any], str]] = [
    ({"density": 0}, "density is 0.*above 0"),
    ({"youngs_modulus": float("nan")}, "youngs_modulus"),
    ({"poissons_ratio": 0.5, "plane": "strain"}, "poissons_ratio is 0.5.*below 0.5"),
    ({"plane": "bent"}, "plane is 'bent'; allowed: 'stress', 'strain'"),
    ({"damping_ratio": -1}, "damping_ratio"),
    ({"yield_strain": 0}, "yield_strain"),
    ({"size": None}, "size is missing"),
    ({"size": -1}, "size is -1.*above 0"),
    ({"size": 1e-6}, "less than 200000 nodes"),
    ({"triangles": [(0, 1, 2), (0, 2, 3)]}, "size is given; allowed: nothing beside triangles"),
    ({"size": None, "triangles": [(0, 1, 2)]}, "point 3 in no triangle"),
    ({"size": None, "triangles": [(0, 1, 9), (0, 2, 3)]}, "triangle 0.*numbers of three points"),
    ({"size": None, "triangles": [(0, 1, -2)]}, "triangles are none; allowed.*0 or above"),
    ({"size": None, "triangles": [(0, 1)]}, r"triangles are none; allowed: \(m, 3\)"),
    ({"pins": [100_000]}, "a pin is 100000.*number of a node"),
    ({"pins": [0.5]}, "pins are none; allowed: numbers of nodes"),
    ({"closed": True}, "closed is given; allowed: only with stretch_stiffness"),
    ({"bending_stiffness": 1}, "bending_stiffness is given"),
    ({"stretch_stiffness": 1e3}, "size is given; allowed: nothing for a rope"),
    ({"stretch_stiffness": 0, "size": None}, "stretch_stiffness is 0"),
    ({"gas_pressure": 1e5}, "gas is given.*closed rope"),
    ({"outside_pressure": 1e5}, "outside_pressure is given; allowed: only with gas_pressure"),
    ({"shape": cb.Segment((0, 0), (1, 0))}, "a shape with an area"),
    ({"shape": [(0, 0), (1, 1), (1, 0), (0, 1)]}, "simple"),
    ({"shape": [1, 2, 3]}, r"shape has shape \(3,\); wanted.*\(n, 2\)"),
    ({"friction": -1}, "friction"),
    ({"position": (0, float("inf"))}, "position"),
    ({"mask": -1}, "mask is -1"),
]


@pytest.mark.parametrize(("given", "message"), BAD, ids=lambda x: x if isinstance(x, str) else "")
def test_what_is_not_allowed_is_said(given: dict[str, Any], message: str) -> None:
    world = cb.World()
    with pytest.raises(ValueError, match=message):
        world.add_soft_body(**{"shape": SQUARE, "size": 0.5, **given})
    assert world.soft_bodies == []


def test_columns_that_do_not_fit_change_nothing() -> None:
    world = cb.World(gravity=(0, 0))
    body = jelly(world)
    n, before = len(body), body.positions
    for name in ("positions", "velocities", "forces"):
        with pytest.raises(ValueError, match=rf"{name} has shape .*\({n}, 2\)"):
            setattr(body, name, [[0.0, 0.0]])
        with pytest.raises(ValueError, match=name):
            setattr(body, name, np.full((n, 2), np.nan))
    with pytest.raises(ValueError, match=f"pinned has 1; allowed: .* {n} nodes"):
        body.pinned = [True]
    with pytest.raises(ValueError, match="pinned are none"):
        body.pinned = np.zeros(n)  # type: ignore[assignment]
    with pytest.raises(ValueError, match="closed rope"):
        body.inflate(1e5)
    with pytest.raises(ValueError, match="fixed step"):
        world.advance(1.0, tolerance=1e-6)
    np.testing.assert_array_equal(body.positions, before)
    assert not body.pinned.any()
    with pytest.raises(TypeError, match="deformable bodies, no int"):
        world.remove(3)  # type: ignore[arg-type]


def test_velocities_are_set_but_not_of_pins() -> None:
    world = cb.World(gravity=(0, 0))
    body = jelly(world, pins=[0])
    body.velocities = np.ones((len(body), 2))
    assert body.velocities[0].tolist() == [0, 0]
    assert (body.velocities[1:] == 1).all()
    world.step(DT)
    np.testing.assert_array_equal(body.positions[0], body.rest[0] + [0, 0.8])


def soft_groups(text: str) -> list[ET.Element]:
    root = ET.fromstring(text)  # noqa: S314 — our own
    return [g for g in root.iter("{http://www.w3.org/2000/svg}g") if g.get("class") == "soft"]


def test_it_is_in_the_picture_coloured_by_its_stress() -> None:
    world = cb.World()
    body = jelly(world, name="<it>")
    balloon(world, position=(3, 0))
    drawn = soft_groups(svg(world))
    assert [len(list(g)) for g in drawn] == [len(body.triangles) + 2, 1]
    assert "nan" not in ET.tostring(drawn[0], "unicode")
    assert set(SoftMark.of(body).colours) == {COLOUR}
    body.positions += 0.1 * body.rest[:, ::-1] * [1, 0]
    assert COLOUR not in SoftMark.of(body).colours
    motion = world.record(DT, 5)
    assert len(soft_groups(picture(world, motion))) == 2
    world.step(DT)
    assert not soft_groups(picture(world, motion))
    body.positions = np.zeros((len(body), 2))
    assert "nan" not in svg(world)


def test_it_is_drawn_on_axes() -> None:
    pytest.importorskip("matplotlib")
    from matplotlib.figure import Figure  # noqa: PLC0415

    world = cb.World()
    body = jelly(world)
    ax = world.draw(Figure().add_subplot())
    assert len(ax.collections) == 2
    low, high = ax.get_ylim()
    assert low < body.positions[:, 1].min() < body.positions[:, 1].max() < high


def test_joints_hold_its_points() -> None:
    world = cb.World(gravity=(0, -9.81))
    body = jelly(world, damping_ratio=1.0, damping_frequency=5.0)
    top = body.positions[:, 1].max()
    spring = world.add_joint(
        cb.DistanceJoint(None, body, points=[(0, top + 1), (0, top)], stiffness=1e4, damping=2e3)
    )
    assert (spring.body_a, spring.body_b) == (None, body)
    assert "the world and <SoftBody" in repr(spring)
    np.testing.assert_allclose(spring.points[1], (0, top), atol=1e-12)
    assert pickle.loads(pickle.dumps(world)).joints[0].body_b is not None  # noqa: S301 — our own
    world.step(DT, 60 * 20)
    assert spring.reaction_force.y == pytest.approx(body.mass * 9.81, rel=1e-3)
    assert spring.points[1].y < top
    rod = cb.RevoluteJoint(body, jelly(world, position=(9, 9)), point=(9, 9))
    with pytest.raises(ValueError, match="from the deformable body"):
        world.add_joint(rod)
    with pytest.raises(ValueError, match="a point does not turn"):
        world.add_joint(cb.WeldJoint(None, body, point=body.positions[0]))
    other = jelly(cb.World())
    with pytest.raises(cb.StaleHandleError, match="another world"):
        world.add_joint(cb.RevoluteJoint(None, other))
    body.remove()
    assert spring.removed
    assert not world.joints


def test_events_tell_what_touches_it() -> None:
    world = with_floor()
    body = jelly(world, position=(0, 1.52))
    world.step(DT, 40)
    events = world.soft_events
    begun = events.begin[0]
    assert (begun.body, begun.other, begun.part) == (body, world.bodies[0], 0)
    assert events.hit[0].approach_speed == pytest.approx((2 * 9.81) ** 0.5, rel=0.05)
    assert events.hit[0].normal == cb.Vec2(0, -1)
    assert "SoftContact of <SoftBody" in repr(begun)
    assert "begin" in repr(events)
    world.step(DT, 600)
    assert [contact.other for contact in world.soft_contacts] == [world.bodies[0]]
    assert world.soft_contacts[0].impulse == pytest.approx(body.mass * 9.81 * DT, rel=1e-3)
    other = jelly(world, position=(0, 2.5))
    world.step(DT, 60)
    assert {contact.other for contact in world.soft_contacts} == {world.bodies[0], other}
    other.remove()
    world.step(DT)
    assert len(world.soft_contacts) == 1


def test_queries_find_it() -> None:
    world = cb.World(gravity=(0, 0))
    a, b = (jelly(world, position=(x, 0), radius=0.0, category=c) for x, c in [(0, 1), (3, 2)])
    assert world.soft_bodies_at((0.2, 0.1)) == [a]
    assert world.soft_bodies_in((-1, -1), (4, 1)) == [a, b]
    hit = world.cast_ray_soft((-2, 0), (6, 0))
    assert hit is not None
    assert (hit.body, hit.normal) == (a, cb.Vec2(-1, 0))
    assert hit.fraction == pytest.approx(1.5 / 8)
    assert (far := world.cast_ray_soft((-2, 0), (6, 0), exclude=[a])) is not None
    assert far.body is b
    assert (other := world.cast_ray_soft((-2, 0), (6, 0), mask=2)) is not None
    assert other.body is b
    near = world.nearest_soft((0, 0.8))
    assert near is not None
    assert near.body is a
    assert near.distance == pytest.approx(0.3)
    assert world.nearest_soft((0, 0.8), 0.2) is None
    with pytest.raises(TypeError, match="allowed: mask, category, group, exclude"):
        world.soft_bodies_at((0, 0), sensors=True)  # type: ignore[call-arg]
    with pytest.raises(ValueError, match="lower corner"):
        world.soft_bodies_in((1, 0), (0, 1))


def test_what_it_is_like_to_touch_can_be_set() -> None:
    world = with_floor()
    body = jelly(world, position=(0, 0.52), velocity=(3, 0), friction=0.0)
    world.step(DT, 60)
    assert body.momentum.x == pytest.approx(3 * body.mass)
    body.friction = 0.8
    body.restitution = 0.1
    assert (body.friction, body.restitution) == ((0.8, 0.8), 0.1)
    world.step(DT, 60)
    assert abs(body.momentum.x) < body.mass
    with pytest.raises(ValueError, match="restitution"):
        body.restitution = 2.0
    body.mask = 0
    body.category, body.group = 4, -1
    assert (body.category, body.mask, body.group) == (4, 0, -1)
    world.step(DT, 60)
    assert body.center.y < -2

"""Objects from joints: what Python adds to a world, and what it gets of it."""

import copy
import math
import pickle
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

import culbuto as cb
from culbuto import builders

Build = Callable[[cb.World], builders.Assembly]

SQUARE = [(0, 0), (1, 0), (1, 1), (0, 1)]

EVERY: dict[str, Build] = {
    "rope": lambda world: builders.rope(world, (0, 0), (3, 0)),
    "points": lambda world: builders.rope(world, (0, 0), (3, 0), points=True),
    "chain": lambda world: builders.chain(world, (0, 0), (3, 0)),
    "bridge": lambda world: builders.bridge(world, (0, 0), (3, 0)),
    "ragdoll": lambda world: builders.ragdoll(world, 1.8, 75),
    "vehicle": lambda world: builders.vehicle(world, 1.6, 300),
    "lattice": lambda world: builders.lattice(world, SQUARE, 0.25, stiffness=100),
}


@pytest.fixture(params=list(EVERY.values()), ids=list(EVERY))
def every(request: pytest.FixtureRequest) -> Build:
    build: Build = request.param
    return build


def test_parts_are_the_objects_of_the_world(every: Build) -> None:
    world = cb.World()
    other = world.add_body(cb.Box(1, 1), position=(0, 20))
    hinge = world.add_joint(cb.RevoluteJoint(None, other))
    built = every(world)
    assert tuple(world.bodies)[1:] == built.bodies
    joints = tuple(world.joints)
    assert joints[0] is hinge
    assert len(joints) == len(built.joints) + 1
    assert all(a is b for a, b in zip(joints[1:], built.joints, strict=True))
    assert all(
        type(joint) is type(world.joints[joint.name]) for joint in built.joints if joint.name
    )


def test_what_moves_them_finds_them_in_step(every: Build) -> None:
    world = cb.World()
    built = every(world)
    world.step(1 / 60, 10)
    positions = np.array([body.position for body in built.bodies])
    assert np.array_equal(positions, world.positions)
    assert np.array_equal([joint.gap for joint in built.joints], world.joints.gaps)
    assert built.gap == world.joints.gaps.max()
    assert built.mass == pytest.approx(world.masses.sum(), rel=1e-12)


def test_a_second_one_in_a_used_world_moves_as_in_a_copy(every: Build) -> None:
    world = cb.World()
    every(world).remove()
    assert (len(world.bodies), len(world.joints)) == (0, 0)
    copied = copy.copy(world)
    again, other = every(world), every(copied)
    world.step(1 / 60, 20)
    copied.step(1 / 60, 20)
    here, there = ([tuple(body.position) for body in one.bodies] for one in (again, other))
    assert here == there


def test_they_are_pickled_with_their_world(every: Build) -> None:
    world = cb.World()
    world, built = pickle.loads(pickle.dumps((world, every(world))))  # noqa: S301
    assert tuple(world.bodies) == built.bodies
    assert [joint.gap for joint in built.joints] == list(world.joints.gaps)


@pytest.mark.parametrize("points", [False, True])
def test_a_rope_has_its_length_and_its_mass(points: bool) -> None:
    world = cb.World()
    rope = builders.rope(
        world, (0, 2), (3, 2), length=4, links=16, mass_per_length=0.2, points=points
    )
    assert rope.mass == pytest.approx(0.8, rel=1e-12)
    if points:
        lengths = np.linalg.norm(np.diff(world.positions, axis=0), axis=1)
    else:
        assert len(rope.bodies) == 16
        # From hinge to hinge, those at the ends included.
        lengths = np.linalg.norm(np.diff(world.joints.points[:, 0], axis=0), axis=1)
    assert lengths == pytest.approx(np.full(16, 0.25), rel=1e-9)


def test_ends_are_held_by_the_world_by_bodies_or_by_nothing() -> None:
    world = cb.World()
    crate = world.add_body(cb.Box(1, 1), position=(2, 0), angle=math.pi / 2)
    held = builders.rope(world, (0, 0), (crate, (0.5, 0)), length=3)
    assert (held.joints[0].body_a, held.joints[-1].body_a) == (None, crate)
    assert world.joints.points[-1] == pytest.approx(np.full((2, 2), (2, 0.5)), abs=1e-9)
    loose = builders.chain(world, (0, 5), (3, 5), pinned=(True, False))
    assert len(loose.joints) == len(loose.bodies)
    free = builders.bridge(world, (0, 9), (3, 9), pinned=(False, False))
    assert len(free.joints) == len(free.bodies) - 1


def test_bending_stiffness_is_shared_by_the_hinges() -> None:
    world = cb.World()
    rope = builders.rope(world, (0, 0), (2, 0), links=4, bending_stiffness=3, length=2.1)
    inner = [joint for joint in rope.joints if isinstance(joint, cb.RevoluteJoint)][1:-1]
    assert [joint.stiffness for joint in inner] == pytest.approx([3 / (2.1 / 4)] * 3)


def test_a_hinge_that_bears_too_much_breaks() -> None:
    world = cb.World()
    rope = builders.rope(world, (0, 0), (0, -2), pinned=(True, False), breaking_force=10)
    world.step(1 / 60)  # 2 kg hang on it
    assert rope.joints[0] in [broken.joint for broken in world.events.broken]
    assert rope.joints[0].removed
    assert rope.gap < 1e-6  # of those that are left
    rope.remove()
    assert len(world.bodies) == 0


def test_a_ragdoll_knows_its_bones() -> None:
    world = cb.World(gravity=(0, 0))
    ragdoll = builders.ragdoll(world, 1.8, 75, name="Ann", hertz=2, damping_ratio=0.5)
    assert ragdoll.mass == pytest.approx(75)
    assert {name: body.name for name, body in ragdoll.bones.items()} == {
        name: f"Ann {name}" for name in builders.BONES
    }
    assert all(joint.name == f"Ann {name}" for name, joint in ragdoll.hinges.items())
    shin = ragdoll.hinges["left shin"]
    assert (shin.body_a, shin.body_b) == (ragdoll.bones["left thigh"], ragdoll.bones["left shin"])
    assert isinstance(shin, cb.RevoluteJoint)
    assert shin.limits == (-2.4, 0)
    mirrored = builders.ragdoll(world, 1.8, 75, faces_left=True).hinges["left shin"]
    assert isinstance(mirrored, cb.RevoluteJoint)
    assert mirrored.limits == (0, 2.4)


def test_a_vehicle_stands_in_balance_and_drives() -> None:
    world = cb.World()
    world.add_body(cb.Segment((-50, 0), (50, 0)), kind="static", friction=1)
    car = builders.vehicle(world, 1.6, 300, driven=(True, True), max_torque=200)
    height = car.chassis.position.y
    world.step(1 / 60, 60)
    assert car.chassis.position.y == pytest.approx(height, abs=1e-3 * car.wheel_radius)
    car.drive(2)
    world.step(1 / 60, 300)
    # Nothing resists: in the end the wheels roll at the speed of the motor.
    assert car.chassis.velocity.x == pytest.approx(2, rel=1e-2)
    assert car.wheels[0].angular_velocity == pytest.approx(-2 / car.wheel_radius, rel=1e-2)


def test_a_vehicle_drives_as_far_as_it_may() -> None:
    world = cb.World()
    car = builders.vehicle(world, 1.6, 300)
    rear, front = car.axles
    assert isinstance(rear, cb.WheelJoint)
    assert isinstance(front, cb.WheelJoint)
    car.drive(3)
    assert (rear.motor_speed, front.motor_speed) == (-3 / car.wheel_radius, None)
    with pytest.raises(ValueError, match="finite"):
        car.drive(math.nan)
    front.remove()
    with pytest.raises(cb.StaleHandleError):
        car.drive(1)
    assert rear.motor_speed == -3 / car.wheel_radius


@pytest.mark.parametrize(
    ("pattern", "young", "poisson", "shear"),
    [
        ("triangular", 2 / math.sqrt(3), 1 / 3, math.sqrt(3) / 4),
        ("square", 1, 0, 0),
        ("braced_square", 4 / 3, 1 / 3, 1 / 2),
    ],
)
def test_a_lattice_reports_its_moduli(
    pattern: Any, young: float, poisson: float, shear: float
) -> None:
    world = cb.World()
    lattice = builders.lattice(world, SQUARE, 0.25, stiffness=100, pattern=pattern)
    assert lattice.stiffness == 100
    found = (lattice.young, lattice.poisson, lattice.shear)
    assert found == pytest.approx((100 * young, poisson, 100 * shear), rel=1e-12)
    assert lattice.mass == pytest.approx(lattice.area)  # 1 kg/m²
    by_young = builders.lattice(world, SQUARE, 0.25, young=lattice.young, pattern=pattern)
    assert by_young.stiffness == pytest.approx(100, rel=1e-12)


def test_a_lattice_leaves_holes_open() -> None:
    world = cb.World()
    hole = np.array([(0.3, 0.3), (0.7, 0.3), (0.7, 0.7), (0.3, 0.7)])
    lattice = builders.lattice(
        world, np.array(SQUARE), 0.1, stiffness=1, holes=[hole], pattern="square"
    )
    assert lattice.area == pytest.approx(1 - 0.4**2)


REFUSED: dict[str, tuple[Callable[[cb.World], object], type[Exception], str]] = {
    "too short": (lambda w: builders.rope(w, (0, 0), (3, 0), length=2), ValueError, "length is 2"),
    "taut": (lambda w: builders.chain(w, (0, 0), (3, 0), length=3), ValueError, "above 3 m"),
    "no links": (lambda w: builders.rope(w, (0, 0), (3, 0), links=0), ValueError, "links"),
    "links below 0": (lambda w: builders.rope(w, (0, 0), (3, 0), links=-1), ValueError, "links"),
    "no plank": (lambda w: builders.bridge(w, (0, 0), (3, 0), planks=0), ValueError, "links"),
    "a wire of nothing": (lambda w: builders.chain(w, (0, 0), (3, 0), wire=0), ValueError, "wire"),
    "no mass": (
        lambda w: builders.rope(w, (0, 0), (3, 0), mass_per_length=0), ValueError, "mass_per_length"
    ),
    "no number": (
        lambda w: builders.rope(w, (0, math.nan), (3, 0), mass_per_length=1), ValueError, "end"
    ),
    "no place": (lambda w: builders.rope(w, (0, 0), 3), TypeError, "argument 'end'"),  # type: ignore[arg-type]
    "a body alone": (lambda w: builders.rope(w, w.bodies[0], (3, 0)), TypeError, "'start'"),  # type: ignore[arg-type]
    "a free end of a body": (
        lambda w: builders.rope(w, (w.bodies[0], (0, 0)), (3, 0), pinned=(False, True)),
        ValueError, "not pinned",
    ),
    "a body elsewhere": (
        lambda w: builders.rope(w, (0, 0), (cb.World().add_body(mass=1), (0, 0))),
        cb.StaleHandleError, "another world",
    ),
    "points with a radius": (
        lambda w: builders.rope(w, (0, 0), (3, 0), points=True, radius=1), ValueError, "radius"
    ),
    "points that bend": (
        lambda w: builders.rope(w, (0, 0), (3, 0), points=True, bending_stiffness=1),
        ValueError, "bending",
    ),
    "no height": (lambda w: builders.ragdoll(w, 0, 75), ValueError, "height"),
    "springs below 0": (lambda w: builders.ragdoll(w, 1.8, 75, hertz=-1), ValueError, "hertz"),
    "wheels that overlap": (
        lambda w: builders.vehicle(w, 1.6, 300, wheel_base=0.1), ValueError, "wheel_base"
    ),
    "a cell that does not fit": (
        lambda w: builders.lattice(w, SQUARE, 3, stiffness=1), ValueError, "spacing"
    ),
    "no stiffness": (lambda w: builders.lattice(w, SQUARE, 0.5), TypeError, "either"),
    "two stiffnesses": (
        lambda w: builders.lattice(w, SQUARE, 0.5, stiffness=1, young=1), TypeError, "either"
    ),
    "no pattern": (
        lambda w: builders.lattice(w, SQUARE, 0.5, young=1, pattern="hex"),  # type: ignore[arg-type]
        ValueError, "'triangular'",
    ),
}  # fmt: skip


@pytest.mark.parametrize("refused", list(REFUSED.values()), ids=list(REFUSED))
def test_refusals_leave_the_world_as_it_was(
    refused: tuple[Callable[[cb.World], object], type[Exception], str],
) -> None:
    build, error, message = refused
    world = cb.World()
    crate = world.add_body(cb.Box(1, 1), position=(0, 20))
    world.add_joint(cb.RevoluteJoint(None, crate))
    before = pickle.dumps(world)
    with pytest.raises(error, match=message):
        build(world)
    assert pickle.dumps(world) == before


def test_a_body_that_is_gone_holds_no_end() -> None:
    world = cb.World()
    crate = world.add_body(cb.Box(1, 1))
    crate.remove()
    with pytest.raises(cb.StaleHandleError, match="removed"):
        builders.rope(world, (crate, (0, 0)), (3, 0))
    assert len(world.bodies) == 0

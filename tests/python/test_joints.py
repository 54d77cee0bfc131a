"""Joints: made of their bodies, live in a world, changed and read by name, one object each."""

import copy
import gc
import math
import pickle
import weakref
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

import culbuto as cb

NAN, INF = math.nan, math.inf


def bench() -> tuple[cb.World, cb.Body, cb.Body, cb.Body]:
    """A world without gravity, the ground, a turned body and another."""
    world = cb.World((0, 0))
    ground = world.add_body(kind="static", name="ground")
    a = world.add_body(cb.Box(1, 1), position=(1, 2), angle=math.pi / 2, name="a")
    b = world.add_body(cb.Box(1, 1), position=(4, 6), name="b")
    return world, ground, a, b


Make = Callable[[cb.Body | None, cb.Body], cb.Joint]

# One of each kind, all of whose parameters are read again below.
KINDS: dict[str, tuple[Make, dict[str, Any]]] = {
    "rod": (
        cb.DistanceJoint,
        {"length": 5, "hertz": 0, "damping_ratio": None, "stiffness": None, "min_length": 0,
         "max_length": None},
    ),
    "spring": (
        lambda a, b: cb.DistanceJoint(
            a, b, length=1, hertz=2, damping_ratio=0.1, min_length=0.5, max_length=7
        ),
        {"length": 1, "hertz": 2, "damping_ratio": 0.1, "min_length": 0.5, "max_length": 7},
    ),
    "constants": (
        lambda a, b: cb.DistanceJoint(a, b, stiffness=30, damping=2),
        {"hertz": None, "damping_ratio": None, "stiffness": 30, "damping": 2},
    ),
    "rope": (lambda a, b: cb.RopeJoint(a, b, max_length=6), {"max_length": 6}),
    "revolute": (
        lambda a, b: cb.RevoluteJoint(
            a, b, limits=(-1, 2), motor_speed=3, max_torque=4, hertz=5, rest_angle=0.5
        ),
        {"limits": (-1, 2), "motor_speed": 3, "max_torque": 4, "hertz": 5, "damping_ratio": 0,
         "rest_angle": 0.5, "reference_angle": -math.pi / 2},
    ),
    "prismatic": (
        lambda a, b: cb.PrismaticJoint(
            a, b, axis=(3, 4), limits=(0, 1), motor_speed=-1, max_force=9, stiffness=2,
            rest_translation=0.25, reference_angle=0.125,
        ),
        {"limits": (0, 1), "motor_speed": -1, "max_force": 9, "stiffness": 2, "damping": 0,
         "rest_translation": 0.25, "reference_angle": 0.125, "axis": (0.6, 0.8)},
    ),
    "weld": (
        lambda a, b: cb.WeldJoint(a, b, linear_hertz=3, linear_damping_ratio=1),
        {"linear_hertz": 3, "linear_damping_ratio": 1, "angular_hertz": 0},
    ),
    "loose weld": (
        lambda a, b: cb.WeldJoint(a, b, angular_stiffness=3, angular_damping=1),
        {"linear_hertz": 0, "angular_hertz": None, "angular_stiffness": 3, "angular_damping": 1},
    ),
    "wheel": (
        lambda a, b: cb.WheelJoint(a, b, hertz=4, damping_ratio=0.7, motor_speed=2),
        {"axis": (0, 1), "hertz": 4, "damping_ratio": 0.7, "motor_speed": 2, "max_torque": None,
         "limits": None},
    ),
    "grab": (
        lambda _, b: cb.GrabJoint(b, (4.5, 6), hertz=5, damping_ratio=0.7, max_force=100),
        {"target": (4.5, 6), "anchor_b": (0.5, 0), "hertz": 5, "max_force": 100},
    ),
    "motor": (
        lambda a, b: cb.MotorJoint(a, b, linear_offset=(1, 2), max_force=3, angular_hertz=1),
        {"linear_offset": (1, 2), "angular_offset": -math.pi / 2, "max_force": 3,
         "max_torque": None, "linear_hertz": 0, "angular_hertz": 1},
    ),
    "gear": (
        lambda a, b: cb.GearJoint(a, b, ratio=2),
        {"ratio": 2, "phase": math.pi},
    ),
    "pulley": (
        lambda a, b: cb.PulleyJoint(a, b, over=((1, 10), (4, 10)), ratio=2, slack=True),
        {"over": ((1, 10), (4, 10)), "ratio": 2, "length": 8 + 2 * 4, "slack": True},
    ),
    "rack": (
        lambda a, b: cb.RackJoint(a, b, world_axis=(0, 2), radius=0.5),
        {"radius": 0.5, "offset": 4 + 0.5 * math.pi / 2},
    ),
    "ratchet": (lambda a, b: cb.RatchetJoint(a, b, step=0.1), {"step": 0.1, "phase": 0}),
    "friction": (
        lambda a, b: cb.FrictionJoint(a, b, max_force=1, max_torque=2),
        {"max_force": 1, "max_torque": 2},
    ),
    "angle spring": (
        lambda a, b: cb.AngleSpringJoint(a, b, stiffness=3, rest_angle=1),
        {"stiffness": 3, "damping": 0, "hertz": None, "rest_angle": 1},
    ),
    "filter": (lambda a, b: cb.FilterJoint(a, b) if a else cb.FilterJoint(b, b), {}),
}  # fmt: skip


def apart(a: Any, b: Any) -> tuple[float, list[float]]:
    """Keeps the frames 5 m apart: C = |b − a|² − 25."""
    x, y = b[:2] - a[:2]
    return x * x + y * y - 25, [-2 * x, -2 * y, 0, 2 * x, 2 * y, 0]


KINDS["custom"] = (lambda a, b: cb.CustomJoint(a, b, apart), {})
every_kind = pytest.mark.parametrize("kind", KINDS)


def added(kind: str) -> tuple[cb.World, cb.Joint]:
    world, _, a, b = bench()
    return world, world.add_joint(KINDS[kind][0](a, b))


def seen(joint: cb.Joint) -> dict[str, object]:
    """Every parameter and read-out."""
    names = (name for name in dir(type(joint)) if not name.startswith("_"))
    values = {name: getattr(joint, name) for name in names}
    return {
        name: value
        for name, value in values.items()
        if name not in ("body_a", "body_b", "world") and not callable(value)
    }


def same(a: cb.World, b: cb.World) -> bool:
    return a.snapshot().__reduce__()[1][0] == b.snapshot().__reduce__()[1][0]


@every_kind
def test_what_is_given_is_read_again(kind: str) -> None:
    _, joint = added(kind)
    for name, value in KINDS[kind][1].items():
        got = getattr(joint, name)
        if value is None:
            assert got is None, name
        else:
            assert got is not None, name
            np.testing.assert_allclose(got, value, rtol=1e-15, err_msg=name)


@every_kind
def test_every_parameter_can_be_set_to_what_it_is(kind: str) -> None:
    world, joint = added(kind)
    before = world.snapshot()
    other = before.to_world()
    for name in KINDS[kind][1]:
        value = getattr(joint, name)
        if value is not None:
            setattr(joint, name, value)
    common: dict[str, object] = {
        "anchor_a": (0.25, 0), "anchor_b": (0, -0.25), "collide_connected": True,
        "breaking_force": 5.0, "breaking_torque": 6.0, "name": "knee",
    }  # fmt: skip
    for name, value in common.items():
        setattr(joint, name, value)
        assert getattr(joint, name) == value
    assert world.joints["knee"] is joint
    for name in ("anchor_a", "anchor_b"):
        setattr(joint, name, getattr(other.joints[0], name))
    for name in ("collide_connected", "breaking_force", "breaking_torque", "name"):
        setattr(joint, name, getattr(other.joints[0], name))
    assert seen(joint) == seen(other.joints[0])


@every_kind
def test_a_draft_is_read_and_set_as_well(kind: str) -> None:
    world, _, a, b = bench()
    joint = KINDS[kind][0](a, b)
    assert joint.world is None
    assert not joint.removed
    assert joint.body_b is b
    assert joint.kind
    joint.breaking_force = 3
    joint.name = "draft"
    with pytest.raises(cb.StaleHandleError, match="in no world yet"):
        joint.gap  # noqa: B018 — reading it is the point
    assert world.add_joint(joint) is joint
    assert (joint.breaking_force, joint.name, joint.world) == (3, "draft", world)
    with pytest.raises(ValueError, match="in a world already"):
        world.add_joint(joint)


@every_kind
@pytest.mark.parametrize("way", [copy.copy, copy.deepcopy, lambda x: pickle.loads(pickle.dumps(x))])  # noqa: S301
def test_worlds_take_their_joints_along(kind: str, way: Callable[[Any], Any]) -> None:
    world, joint = added(kind)
    vars(joint)["mark"] = [1]
    other = way(world)
    assert isinstance(other, cb.World)
    (copied,) = other.joints
    assert type(copied) is type(joint)
    assert copied is not joint
    assert vars(copied) == {"mark": [1]}
    assert copied.world is other
    assert copied.body_b is other.bodies[2]
    assert seen(copied) == seen(joint)
    assert same(world, other)
    for _ in range(3):
        world.step(0.01)
        other.step(0.01)
    assert same(world, other)


@every_kind
def test_joints_and_drafts_are_pickled(kind: str) -> None:
    world, joint = added(kind)
    lone = pickle.loads(pickle.dumps(joint))  # noqa: S301
    assert list(lone.world.joints) == [lone]
    assert seen(lone) == seen(joint)
    joint.remove()
    assert pickle.loads(pickle.dumps(joint)).removed  # noqa: S301
    draft = KINDS[kind][0](world.bodies[1], world.bodies[2])
    vars(draft)["mark"] = 1
    again = pickle.loads(pickle.dumps(draft))  # noqa: S301
    assert type(again) is type(draft)
    assert vars(again) == {"mark": 1}
    assert again.world is None
    body = again.body_b
    assert body is not None
    made = body.world.add_joint(again)
    assert seen(made) == seen(world.add_joint(draft))


@pytest.mark.parametrize("kind", [kind for kind in KINDS if kind != "custom"])
def test_a_scene_file_keeps_them(kind: str) -> None:
    world, joint = added(kind)
    joint.name = "it"
    again = cb.SceneFile.from_json(cb.SceneFile.from_world(world).to_json()).world()
    found = again.joints["it"]
    assert type(found) is type(joint)
    assert seen(found) == seen(joint)


def test_a_snapshot_brings_joints_back() -> None:
    world, _, a, b = bench()
    first = world.add_joint(cb.RevoluteJoint(a, b, name="first"))
    second = world.add_joint(cb.FilterJoint(a, b))
    kept = world.snapshot()
    a.remove()
    assert first.removed
    assert second.removed
    assert list(world.joints) == []
    world.restore(kept)
    assert list(world.joints) == [first, second]
    assert not first.removed
    assert first.body_a is a


def test_what_is_removed_says_so() -> None:
    world, ground, a, b = bench()
    one = world.add_joint(cb.RevoluteJoint(ground, a))
    two = world.add_joint(cb.RevoluteJoint(a, b))
    three = world.add_joint(cb.RevoluteJoint(None, b))
    four = world.add_joint(cb.FilterJoint(ground, b))
    one.remove()
    assert list(world.joints) == [four, two, three]  # the last takes its place
    assert one not in world.joints
    for touch in (lambda: one.gap, lambda: one.limits, one.remove, lambda: world.remove(one)):
        with pytest.raises(cb.StaleHandleError):
            touch()
    with pytest.raises(cb.StaleHandleError):
        one.limits = (0, 1)
    world.remove(two)
    b.remove()
    assert (three.removed, four.removed, len(world.joints)) == (True, True, 0)
    assert repr(three) == "<removed RevoluteJoint>"
    world.step(0.01)


def test_one_object_each() -> None:
    world, _, a, b = bench()
    joint = world.add_joint(cb.RevoluteJoint(a, b, name="hinge"))
    assert world.joints[0] is world.joints[-1] is world.joints["hinge"] is joint
    assert world.joints.find("hinge") is joint
    assert world.joints.find("no") is None
    assert joint in world.joints
    assert a not in world.joints
    assert {joint: 1}[world.joints[0]] == 1
    assert joint != world.add_joint(cb.RevoluteJoint(a, b))
    with pytest.raises(KeyError, match="no joint is called"):
        world.joints["knee"]
    with pytest.raises(IndexError, match="index 2 for 2 joints"):
        world.joints[2]
    with pytest.raises(TypeError, match="by place"):
        world.joints[1.5]  # type: ignore[index]
    assert repr(joint).startswith('<RevoluteJoint "hinge" of <dynamic Body "a" at')


def test_joints_do_not_keep_worlds_alive() -> None:
    def make() -> weakref.ref[cb.Joint]:
        world, _, a, b = bench()
        joint = world.add_joint(cb.RevoluteJoint(a, b))
        vars(joint)["self"] = joint
        vars(cb.RevoluteJoint(a, b))["world"] = world  # a draft in a circle
        return weakref.ref(joint)

    gone = make()
    gc.collect()
    assert gone() is None


def test_anchors_are_local_or_in_the_world() -> None:
    world, _, a, b = bench()  # a is turned by a quarter
    joint = world.add_joint(cb.DistanceJoint(a, b, points=((1, 3), (4, 6.5))))
    np.testing.assert_allclose(joint.anchor_a, (1, 0), atol=1e-15)
    assert joint.anchor_b == (0, 0.5)
    np.testing.assert_allclose(joint.points, [(1, 3), (4, 6.5)], rtol=1e-15)
    joint.points = ((1, 2), (4, 6))
    np.testing.assert_allclose([joint.anchor_a, joint.anchor_b], 0, atol=1e-15)
    hinge = world.add_joint(cb.RevoluteJoint(a, None, point=(2, 2)))
    assert hinge.anchor_b == (2, 2)
    np.testing.assert_allclose(hinge.anchor_a, (0, -1), atol=1e-15)
    slider = world.add_joint(cb.PrismaticJoint(a, b, world_axis=(2, 0)))
    np.testing.assert_allclose(slider.axis, (0, -1), atol=1e-15)
    np.testing.assert_allclose(slider.world_axis, (1, 0), atol=1e-15)
    slider.world_axis = (0, 3)
    np.testing.assert_allclose(slider.axis, (1, 0), atol=1e-15)
    for wrong in (
        lambda: cb.DistanceJoint(a, b, anchor_a=(0, 0), point=(0, 0)),
        lambda: cb.DistanceJoint(a, b, point=(0, 0), points=((0, 0), (0, 0))),
        lambda: cb.PrismaticJoint(a, b, axis=(1, 0), world_axis=(1, 0)),
        lambda: cb.PrismaticJoint(a, b),
    ):
        with pytest.raises(ValueError, match=r"give"):
            wrong()


def test_a_grabbed_point_follows_its_target() -> None:
    world, _, a, _ = bench()
    grab = world.add_joint(cb.GrabJoint(a, (1, 2), hertz=4, damping_ratio=1))
    grab.target = (3, 2)
    assert grab.gap == 0  # a spring holds nothing rigidly
    assert grab.energy > 0
    world.step(0.01, 500)
    np.testing.assert_allclose(a.position, (3, 2), atol=1e-6)
    by_anchor = world.add_joint(cb.GrabJoint(a, (0, 0), anchor=(0.5, 0.5)))
    assert by_anchor.anchor_b == (0.5, 0.5)


def test_springs_in_either_words() -> None:
    world, _, a, b = bench()
    joint = world.add_joint(cb.DistanceJoint(a, b, hertz=2, damping_ratio=0.5))
    mass = 0.5  # of two bodies of 1 kg against each other
    omega = 4 * math.pi
    assert joint.stiffness == pytest.approx(mass * omega**2)
    assert joint.damping == pytest.approx(2 * mass * 0.5 * omega)
    joint.hertz = 1
    assert joint.damping_ratio == 0.5
    assert joint.stiffness == pytest.approx(mass * omega**2 / 4)
    before = joint.damping
    joint.stiffness = 7
    assert (joint.stiffness, joint.damping, joint.hertz) == (7, before, None)
    joint.hertz = 0
    assert (joint.hertz, joint.stiffness) == (0, None)
    with pytest.raises(ValueError, match="hertz and damping_ratio"):
        joint.damping_ratio = 0.1
    joint.hertz = None
    assert joint.hertz is None
    hinge = world.add_joint(cb.RevoluteJoint(a, b))
    with pytest.raises(ValueError, match="above 0, or None"):
        hinge.hertz = 0
    hinge.max_torque = 5  # without a speed: a brake
    assert (hinge.motor_speed, hinge.max_torque) == (0, 5)
    hinge.motor_speed = None
    assert hinge.max_torque is None


# What is wrong, and a part of the message.
WRONG: list[tuple[Callable[[cb.World], cb.Joint], str]] = [
    (lambda w: cb.DistanceJoint(*w.bodies[:2], hertz=-1), "hertz is -1"),
    (lambda w: cb.DistanceJoint(*w.bodies[:2], hertz=NAN), "hertz is NaN"),
    (lambda w: cb.DistanceJoint(*w.bodies[:2], hertz=1, damping_ratio=-1), "damping_ratio is -1"),
    (lambda w: cb.DistanceJoint(*w.bodies[:2], stiffness=-1), "stiffness is -1"),
    (lambda w: cb.DistanceJoint(*w.bodies[:2], hertz=1, stiffness=1), "hertz and damping_ratio"),
    (lambda w: cb.DistanceJoint(*w.bodies[:2], damping=1), "hertz and damping_ratio"),
    (lambda w: cb.WeldJoint(*w.bodies[:2], linear_damping_ratio=1), "hertz and damping_ratio"),
    (lambda w: cb.AngleSpringJoint(*w.bodies[:2]), "needs hertz above 0"),
    (lambda w: cb.DistanceJoint(*w.bodies[:2], length=-1), "length is -1"),
    (lambda w: cb.DistanceJoint(*w.bodies[:2], min_length=2, max_length=1), "max_length is 1"),
    (lambda w: cb.RevoluteJoint(*w.bodies[:2], anchor_a=(INF, 0)), "anchor_a is"),
    (lambda w: cb.RevoluteJoint(*w.bodies[:2], anchor_b=(0, NAN)), "anchor_b is"),
    (lambda w: cb.RevoluteJoint(*w.bodies[:2], limits=(1, 0)), "upper limit is 0"),
    (lambda w: cb.RevoluteJoint(*w.bodies[:2], motor_speed=INF), "motor_speed is inf"),
    (lambda w: cb.RevoluteJoint(*w.bodies[:2], max_torque=-1), "max_torque is -1"),
    (lambda w: cb.RevoluteJoint(*w.bodies[:2], reference_angle=NAN), "reference_angle is NaN"),
    (lambda w: cb.PrismaticJoint(*w.bodies[:2], axis=(0, 0)), "axis is"),
    (lambda w: cb.PrismaticJoint(*w.bodies[:2], axis=(1, 0), max_force=-1), "max_force is -1"),
    (lambda w: cb.MotorJoint(*w.bodies[:2], linear_offset=(0, INF)), "linear_offset is"),
    (lambda w: cb.MotorJoint(*w.bodies[:2], angular_offset=INF), "angular_offset is"),
    (lambda w: cb.GearJoint(*w.bodies[:2], ratio=0), "ratio is 0"),
    (lambda w: cb.RackJoint(*w.bodies[:2], axis=(1, 0), radius=0), "radius is 0"),
    (lambda w: cb.RatchetJoint(*w.bodies[:2], step=0), "step is 0"),
    (lambda w: cb.PulleyJoint(*w.bodies[:2], over=((0, 0), (0, NAN))), "over is"),
    (lambda w: cb.FrictionJoint(*w.bodies[:2], max_force=-1, max_torque=0), "max_force is -1"),
    (lambda w: cb.RevoluteJoint(*w.bodies[:2], breaking_force=-1), "breaking_force is -1"),
    (lambda w: cb.RevoluteJoint(w.bodies[1], w.bodies[1]), "the same body twice"),
    (lambda _: cb.RevoluteJoint(None, None), "the world twice"),
    (lambda w: cb.RevoluteJoint(w.bodies[0], None), "dynamic body"),
]  # fmt: skip


@pytest.mark.parametrize(("make", "part"), WRONG, ids=[part for _, part in WRONG])
def test_what_is_wrong_leaves_the_world_as_it_was(
    make: Callable[[cb.World], cb.Joint], part: str
) -> None:
    world, _, a, b = bench()
    world.add_joint(cb.RevoluteJoint(a, b))
    before = world.snapshot().to_world()
    with pytest.raises(ValueError, match=part):
        world.add_joint(make(world))
    assert same(world, before)
    assert len(world.joints) == 1


def test_bodies_that_are_gone_or_elsewhere_are_named() -> None:
    world, ground, a, b = bench()
    draft = cb.RevoluteJoint(ground, a)
    a.remove()
    with pytest.raises(cb.StaleHandleError, match="body_b is no longer in its world"):
        world.add_joint(draft)
    with pytest.raises(cb.StaleHandleError, match="body_a belongs to another world"):
        world.add_joint(cb.RevoluteJoint(bench()[1], b))
    assert len(world.joints) == 0


def test_setting_what_is_wrong_changes_nothing() -> None:
    world, joint = added("revolute")
    assert isinstance(joint, cb.RevoluteJoint)
    before = seen(joint)
    attempts: list[tuple[str, object, type[Exception], str]] = [
        ("limits", (1, 0), ValueError, "upper limit is 0"),
        ("limits", 3, TypeError, "argument 'limits': expected two numbers"),
        ("motor_speed", NAN, ValueError, "motor_speed is NaN"),
        ("motor_speed", "fast", TypeError, "argument 'motor_speed'"),
        ("hertz", -1, ValueError, "hertz is -1"),
        ("anchor_a", (0, INF), ValueError, "anchor_a is"),
        ("anchor_a", (0, 1, 2), TypeError, "argument 'anchor_a'"),
        ("breaking_force", -1, ValueError, "breaking_force is -1"),
        ("collide_connected", 1, TypeError, "True or False"),
        ("name", 3, TypeError, "a str or None"),
        ("angle", 1, AttributeError, "can only be read"),
    ]
    for name, value, error, part in attempts:
        with pytest.raises(error, match=part):
            setattr(joint, name, value)
    assert seen(joint) == before
    draft = cb.RevoluteJoint(*world.bodies[:2])
    with pytest.raises(ValueError, match="upper limit"):
        draft.limits = (1, 0)
    assert draft.limits is None
    with pytest.raises(TypeError, match="no parameter 'colour'"):
        cb.RevoluteJoint(*world.bodies[:2], colour="red")  # type: ignore[call-arg]


def test_arrays_of_all() -> None:
    world, ground, a, b = bench()
    world.add_joint(cb.RevoluteJoint(ground, a, anchor_a=(1, 2)))
    world.add_joint(cb.DistanceJoint(b, None, length=7, stiffness=2))
    joints = world.joints
    assert joints.bodies.tolist() == [[0, 1], [2, -1]]
    np.testing.assert_array_equal(joints.points, [[(1, 2), (1, 2)], [(4, 6), (0, 0)]])
    for array in (joints.reaction_torques, joints.gaps, joints.energies):
        assert array.shape == (2,)
    assert joints.reaction_forces.shape == (2, 2)
    stretch = math.hypot(4, 6) - 7
    np.testing.assert_allclose(joints.energies, [0, 0.5 * 2 * stretch**2])
    assert cb.World().joints.points.shape == (0, 2, 2)


def test_a_hinge_holds_what_hangs_on_it() -> None:
    """A body at rest below its hinge: the hinge carries its weight and nothing turns."""
    world = cb.World((0, -10))
    bob = world.add_body(cb.Circle(0.1), mass=2, position=(0, -1))
    hinge = world.add_joint(cb.RevoluteJoint(None, bob, point=(0, 0)))
    world.step(1 / 60, 60)
    np.testing.assert_allclose(hinge.reaction_force, (0, 20), atol=1e-9)
    assert abs(hinge.reaction_torque) < 1e-9
    assert hinge.gap < 1e-12
    bob.velocity = (1, 0)
    bob.angular_velocity = 1
    assert hinge.speed == 1
    assert hinge.angle == 0


def test_friction_stops_straight_however_far_it_goes() -> None:
    """A disk on a table: F = ma over a way v²m/2F, along a line though it spins."""
    world = cb.World((0, 0))
    disk = world.add_body(cb.Circle(0.2), mass=1, velocity=(2, 0), angular_velocity=3)
    world.add_joint(cb.FrictionJoint(None, disk, max_force=1, max_torque=0))
    world.step(1 / 60, 180)
    np.testing.assert_allclose(disk.position, (2, 0), atol=1e-9)
    np.testing.assert_allclose(disk.velocity, 0, atol=1e-12)
    assert disk.angular_velocity == pytest.approx(3, abs=1e-12)


def test_a_spring_stays_while_a_motor_is_changed() -> None:
    """A spring's stiffness follows from where the bodies stand when it is set, not later."""
    world, ground, a, b = bench()
    wheel = world.add_joint(cb.WheelJoint(a, b, points=((1, 6), (4, 6)), hertz=3, motor_speed=1))
    before = wheel.stiffness
    b.position = (4, 9)
    wheel.motor_speed = 2
    assert wheel.stiffness == before
    wheel.hertz = 3
    assert wheel.stiffness == before
    wheel.damping_ratio = 0.5
    assert wheel.stiffness != before
    assert ground.kind == "static"


def on_a_circle(_: Any, b: Any) -> tuple[Any, Any]:
    """A point one metre from the origin that keeps facing it: two rows."""
    x, y, angle = b
    r = math.hypot(x, y)
    facing = math.remainder(angle - math.atan2(y, x), 2 * math.pi)
    jacobian = [[0, 0, 0, x / r, y / r, 0], [0, 0, 0, y / r**2, -x / r**2, 1]]
    return np.array([r - 1, facing]), np.array(jacobian)


WAYS: list[Callable[[cb.World], cb.World]] = [
    lambda world: world,
    copy.copy,
    copy.deepcopy,
    lambda world: pickle.loads(pickle.dumps(world)),  # noqa: S301
    lambda world: world.snapshot().to_world(),
]


@pytest.mark.parametrize("way", WAYS)
def test_a_joint_of_ones_own_is_a_pendulum(way: Callable[[cb.World], cb.World]) -> None:
    world = cb.World((0, -10))
    own = world.add_body(mass=1, inertia=0.5, position=(1, 0))
    hinged = world.add_body(mass=1, inertia=0.5, position=(1, 0))
    joint = world.add_joint(cb.CustomJoint(None, own, on_a_circle, rows=2))
    world.add_joint(cb.RevoluteJoint(None, hinged, point=(0, 0)))
    assert joint.constraint is on_a_circle
    other = way(world)
    gc.collect()
    other.step(1 / 240, 120)
    np.testing.assert_allclose(other.positions[0], other.positions[1], atol=1e-4)
    assert abs(other.positions[0][1]) > 0.5
    assert other.joints[0].gap < 1e-9
    with pytest.raises(cb.SceneFileError, match=r"joints\[0\].*code of your own"):
        cb.SceneFile.from_world(world)


def test_a_joint_of_ones_own_may_refer_to_its_world() -> None:
    def make() -> weakref.ref[cb.World]:
        world, _, a, b = bench()

        def constraint(first: Any, second: Any) -> tuple[float, list[float]]:
            assert world is not None
            return apart(first, second)

        world.add_joint(cb.CustomJoint(a, b, constraint))
        return weakref.ref(world)

    gone = make()
    gc.collect()
    assert gone() is None


# What a function gives, and what is said of that.
OWN: list[tuple[Callable[[Any, Any], Any], type[Exception], str]] = [
    (lambda _, b: (b[0] ** 2, [0, 0, 0, 1, 0, 0]), ValueError, r"∂C0/∂x of B .* is 1; allowed"),
    (lambda *_: 0.0, TypeError, "C and its Jacobian: a tuple"),
    (lambda *_: (0.0, [0, 0, 0]), ValueError, r"no array of floats of shape \(1, 6\)"),
    (lambda *_: ([0.0, 1.0], np.zeros((1, 6))), ValueError, r"C of the joint .* has shape"),
    (lambda *_: 1 / 0, ZeroDivisionError, "division"),
]


@pytest.mark.parametrize(("constraint", "error", "part"), OWN, ids=[part for *_, part in OWN])
def test_what_is_wrong_with_a_joint_of_ones_own_is_told(
    constraint: Any, error: type[Exception], part: str
) -> None:
    world, _, a, b = bench()
    with pytest.raises(error, match=part):
        world.add_joint(cb.CustomJoint(a, b, constraint))
    assert len(world.joints) == 0
    with pytest.raises(TypeError, match="wanted a function"):
        cb.CustomJoint(a, b, 3)  # type: ignore[arg-type]
    with pytest.raises(ValueError, match="1 to 3"):
        world.add_joint(cb.CustomJoint(a, b, apart, rows=4))


def test_a_joint_of_ones_own_that_fails_ends_the_step() -> None:
    world, _, a, b = bench()
    mood = {"bad": False, "nosy": False}

    def moody(first: Any, second: Any) -> tuple[float, list[float]]:
        if mood["nosy"]:
            world.step(1)
        return (1 / 0, []) if mood["bad"] else apart(first, second)

    joint = world.add_joint(cb.CustomJoint(a, b, moody))
    b.velocity = (0, 1)
    world.step(0.01)
    before = world.snapshot().to_world()
    for key, error in (("bad", ZeroDivisionError), ("nosy", RuntimeError)):
        mood[key] = True
        with pytest.raises(error):
            world.step(0.01)
        mood[key] = False
        assert same(world, before)
    assert joint in world.joints
    world.step(0.01)


def test_how_springs_swing_is_read_back() -> None:
    world, _, a, b = bench()
    joint = world.add_joint(cb.DistanceJoint(a, b, hertz=2, damping_ratio=0.25))
    (motion,) = joint.spring_motions(1 / 60)
    assert motion.row == 0
    for hertz in (motion.hertz, motion.stepped_hertz):
        assert hertz == pytest.approx(2, rel=1e-9)
    for ratio in (motion.damping_ratio, motion.stepped_damping_ratio):
        assert ratio == pytest.approx(0.25, rel=1e-9)
    b.mass = 4  # what hangs on it is another now: 1/(1 + 1/4) of the mass before, 1/2
    assert joint.spring_motions(1 / 60)[0].hertz == pytest.approx(2 * math.sqrt(0.5 / 0.8))
    (fast,) = world.add_joint(cb.DistanceJoint(a, b, hertz=1e4)).spring_motions(1 / 60)
    assert fast.hertz == pytest.approx(1e4)
    assert fast.stepped_hertz < 240  # no more than half a turn a substep
    with pytest.raises(ValueError, match="dt is 0"):
        joint.spring_motions(0)
    assert joint.spring_motions(0.1)[0] != motion

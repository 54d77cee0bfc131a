"""World and Body: what goes in comes out, and what is refused changes nothing."""

import gc
import math
import signal
import threading
import weakref
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import culbuto as cb

Body = cb.Body
World = cb.World


def three() -> tuple[World, list[Body]]:
    world = World()
    bodies = [
        world.add_body(cb.Box(1, 2), name="box", position=(1, 2), velocity=(3, 4)),
        world.add_body(kind="static", name="ground"),
        world.add_body([cb.Circle(1), cb.Circle(1, center=(2, 0))], angle=0.5, name="pair"),
    ]
    return world, bodies


SETTINGS: dict[str, Any] = {
    "gravity": (1, 2), "air_density": 1.2, "wind": (3, 0), "method": "rk4", "substeps": 7,
    "closed_form": False, "timing": True,
}  # fmt: skip
BODY: dict[str, Any] = {
    "kind": "dynamic", "position": (1, 2), "angle": 0.5, "velocity": (3, 4),
    "angular_velocity": -1.0, "density": 2.0, "mass": 5.0, "inertia": 3.0, "gravity_scale": 0.5,
    "linear_damping": 0.1, "angular_damping": 0.2, "drag_coefficient": 1.1, "force": (1, 0),
    "torque": 2.0, "name": "ball",
}  # fmt: skip


def test_settings_round_trip() -> None:
    world = World(**SETTINGS)
    other = World()
    for name, value in SETTINGS.items():
        assert getattr(world, name) == value
        assert getattr(other, name) != value
        setattr(other, name, value)
        assert getattr(other, name) == value
    world.time = 3
    assert world.time == 3


def test_a_body_is_as_it_was_made() -> None:
    world = World()
    body = world.add_body(cb.Circle(1), **BODY)
    other = world.add_body(cb.Circle(1))
    for name, value in BODY.items():
        assert getattr(body, name) == value
        if name not in {"kind"}:
            setattr(other, name, value)
            assert getattr(other, name) == value, name
    assert body.shapes == (cb.Circle(1),)
    assert body.world is world


@pytest.mark.parametrize("lock", ["lock_x", "lock_y", "lock_rotation"])
def test_locks(lock: str) -> None:
    world = World()
    body = world.add_body(cb.Circle(1), velocity=(1, 1), angular_velocity=1)
    assert not getattr(body, lock)
    setattr(body, lock, True)
    assert [body.lock_x, body.lock_y, body.lock_rotation].count(True) == 1
    assert [*body.velocity, body.angular_velocity].count(0) == 1
    arguments: Any = {lock: True}
    assert getattr(world.add_body(cb.Circle(1), **arguments), lock)


@pytest.mark.parametrize("width", ["silhouette", "bounding_box", 0.3])
def test_drag_width(width: Any) -> None:
    body = World().add_body(cb.Circle(1), drag_width=width)
    assert body.drag_width == width
    body.drag_width = "silhouette"
    body.drag_width = width
    assert body.drag_width == width


def test_a_compound_about_its_center_of_mass() -> None:
    _, (_, _, pair) = three()
    assert pair.local_center == pytest.approx((1, 0))
    assert pair.center_of_mass == pytest.approx((math.cos(0.5), math.sin(0.5)))
    assert pair.world_point((1, 0)) == pytest.approx(tuple(pair.center_of_mass))
    assert pair.local_point(pair.center_of_mass) == pytest.approx((1, 0))
    pair.angular_velocity = 2
    assert pair.velocity_at((0, 0)) == pytest.approx((2 * math.sin(0.5), -2 * math.cos(0.5)))
    pair.local_center = (0, 0)
    assert pair.center_of_mass == (0, 0)
    pair.local_center = None
    assert pair.local_center == pytest.approx((1, 0))
    pair.shapes = cb.Circle(2)
    assert pair.shapes == (cb.Circle(2),)


def test_forces_and_impulses() -> None:
    world = World((0, 0))
    body = world.add_body(mass=2, inertia=4)
    body.apply_force((2, 0), at=(0, 1))
    body.apply_torque(6)
    world.step(1)
    assert (body.velocity, body.angular_velocity) == ((1, 0), 1)  # −2 + 6 N·m on 4 kg·m²
    world.step(1)
    assert body.velocity == (1, 0)  # for one step only
    body.apply_impulse((0, 4))
    body.apply_angular_impulse(-4)
    assert (body.velocity, body.angular_velocity) == ((1, 2), 0)
    assert body.kinetic_energy == 5
    assert body.momentum == world.momentum == (2, 4)


def test_a_throw_is_exact() -> None:
    world = World()
    ball = world.add_body(cb.Circle(0.1), velocity=(12, 9))
    world.step(1 / 60, steps=120)
    # 120 steps, each of half a unit in the last place of 24 m
    assert ball.position == pytest.approx((24, 18 - 0.5 * 9.81 * 4), abs=120 * 2e-15)
    assert world.report().steps == 120
    assert world.report().smallest_step == math.inf
    assert world.energy.balance == pytest.approx(world.mass * 0.5 * 225, rel=1e-13)


COLUMNS = ["positions", "angles", "velocities", "angular_velocities", "forces", "torques"]


@pytest.mark.parametrize("name", COLUMNS)
def test_columns_are_the_bodies_own(name: str) -> None:
    single = {"velocities": "velocity", "angular_velocities": "angular_velocity"}
    attribute = single.get(name, name[:-1])
    world = World()
    bodies = [world.add_body([cb.Circle(1), cb.Circle(1, center=(2, 0))]) for _ in range(3)]
    vector = name in {"positions", "velocities", "forces"}
    values = np.arange(1.0, 7.0).reshape(3, 2) if vector else np.arange(1.0, 4.0)
    setattr(world, name, values)
    wanted: list[Any] = values.tolist()
    for body, value in zip(bodies, wanted, strict=True):
        assert getattr(body, attribute) == pytest.approx(tuple(value) if vector else value)
    read = getattr(world, name)
    np.testing.assert_allclose(read, values, rtol=1e-15)
    read[:] = -1
    np.testing.assert_allclose(getattr(world, name), values)  # it was a copy
    out = np.zeros_like(values)
    assert world.read(name, out=out) is out  # type: ignore[arg-type]
    np.testing.assert_array_equal(out, getattr(world, name))
    setattr(world, name, np.asfortranarray(values[::-1]))
    np.testing.assert_allclose(getattr(world, name), values[::-1])
    before = [world.read(column) for column in COLUMNS]  # type: ignore[arg-type]
    wrong = [values[:2], values[None], np.full_like(values, np.nan), "a", None]
    for bad in wrong:
        with pytest.raises(ValueError, match=name):
            setattr(world, name, bad)
    after = [world.read(column) for column in COLUMNS]  # type: ignore[arg-type]
    for a, b in zip(before, after, strict=True):
        np.testing.assert_array_equal(a, b)


def test_columns_that_are_only_read() -> None:
    world, bodies = three()
    np.testing.assert_array_equal(world.masses, [body.mass for body in bodies])
    np.testing.assert_array_equal(world.inertias, [body.inertia for body in bodies])
    np.testing.assert_array_equal(world.centers, [body.center_of_mass for body in bodies])
    with pytest.raises(AttributeError):
        world.masses = 1  # type: ignore[misc, assignment]


@pytest.mark.parametrize(
    "out",
    [
        np.zeros((2, 2)),
        np.zeros(6),
        np.zeros((3, 4))[:, ::2],
        np.zeros((3, 2), np.float32),
        [0] * 6,
    ],
)
def test_out_must_fit(out: Any) -> None:
    with pytest.raises((ValueError, TypeError), match="out"):
        three()[0].read("positions", out=out)


def test_out_must_be_writable_and_columns_known() -> None:
    out = np.zeros((3, 2))
    out.flags.writeable = False
    with pytest.raises(ValueError, match="out cannot be written"):
        three()[0].read("positions", out=out)
    with pytest.raises(ValueError, match="allowed: positions"):
        three()[0].read("masses")  # type: ignore[arg-type]


REFUSED: list[tuple[Callable[[Any, list[Body]], Any], type[Exception], str]] = [
    (lambda w, _: w.add_body(cb.Circle(1), mass=-1), ValueError, "mass is -1"),
    (lambda w, _: w.add_body(), ValueError, "mass of a dynamic body"),
    (lambda w, _: w.add_body(cb.Circle(1), kind="solid"), ValueError, "kind is 'solid'"),
    (lambda w, _: w.add_body(cb.Circle(1), position=(math.nan, 0)), ValueError, "position"),
    (lambda w, _: w.add_body(cb.Circle(1), drag_width="wide"), ValueError, "drag_width is 'wide'"),
    (lambda w, _: w.add_body(3), TypeError, "int"),
    (lambda w, _: w.add_body([cb.Circle(1), "a"]), TypeError, "str"),
    (lambda _, b: setattr(b[0], "velocity", (math.inf, 0)), ValueError, "velocity"),
    (lambda _, b: setattr(b[1], "velocity", (1, 0)), ValueError, "static"),
    (lambda _, b: setattr(b[0], "mass", 0), ValueError, "mass is 0"),
    (lambda _, b: setattr(b[0], "position", (1, 2, 3)), ValueError, "two numbers"),
    (lambda _, b: b[0].apply_force((math.nan, 0)), ValueError, "force"),
    (lambda w, _: w.step(0), ValueError, "dt is 0"),
    (lambda w, _: w.step(1, -1), ValueError, "steps is -1"),
    (lambda w, _: w.step(1e300, 10), cb.SimulationError, "no longer finite"),
    (lambda w, _: w.advance(1, tolerance=1), ValueError, "tolerance"),
    (lambda w, _: w.advance(1, times=[0.5, 0.2]), ValueError, "times"),
    (lambda w, _: w.record(0.1, 10, every=0), ValueError, "every is 0"),
    (lambda w, _: setattr(w, "method", "magic"), ValueError, "leapfrog"),
    (lambda w, _: setattr(w, "substeps", 0), ValueError, "substeps"),
    (lambda w, _: setattr(w, "gravity", (math.nan, 0)), ValueError, "gravity"),
    (lambda w, _: setattr(w, "time", math.inf), ValueError, "time"),
    (lambda w, _: setattr(w, "air_density", -1), ValueError, "air density"),
    (lambda w, _: w.remove(3), TypeError, "int"),
    (lambda w, _: w.remove(World().add_body(mass=1)), cb.StaleHandleError, "another world"),
    (lambda w, b: w.add_schedule(b[0], [0, 1], [(1, 0), (2, 0)]), ValueError, r"\(1, 2\)"),
    (lambda w, b: w.add_schedule(b[0], [1, 0], [(1, 0)]), ValueError, "increasing"),
    (lambda w, b: w.add_schedule(b[0], [0, 1]), ValueError, "forces, torques"),
    (lambda w, _: w.add_field(3), TypeError, "int"),
    (lambda w, _: w.add_field(cb.Central((0, 0), math.nan, 1)), ValueError, "strength"),
]


@pytest.mark.parametrize(("act", "error", "message"), REFUSED)
def test_what_is_refused_changes_nothing(
    act: Callable[[World, list[Body]], Any], error: type[Exception], message: str
) -> None:
    world, bodies = three()
    world.step(0.1)
    before = world.snapshot().__reduce__()[1]
    with pytest.raises(error, match=message):
        act(world, bodies)
    assert world.snapshot().__reduce__()[1] == before
    assert world.bodies == bodies
    assert world.fields == world.schedules == []


def test_bodies_are_themselves() -> None:
    world, bodies = three()
    assert len(world) == 3
    assert world
    assert World()
    assert list(world) == world.bodies == bodies
    assert all(a is b for a, b in zip(world.bodies, bodies, strict=True))
    assert [body.index for body in bodies] == [0, 1, 2]
    assert bodies[0] in world
    assert bodies[0] not in World()
    assert "box" not in world
    assert world.find("pair") is bodies[2]
    assert world.find("nothing") is None
    assert len(set(bodies)) == 3
    setattr(bodies[0], "tag", [1])  # noqa: B010
    assert vars(world.bodies[0]) == {"tag": [1]}


def test_removing() -> None:
    world, (box, ground, pair) = three()
    box.remove()
    assert box.removed
    assert world.bodies == [pair, ground]  # the last takes its place
    assert [pair.index, ground.index] == [0, 1]
    assert box not in world
    for use in (lambda: box.position, lambda: world.remove(box), box.remove):
        with pytest.raises(cb.StaleHandleError, match="removed"):
            use()
    with pytest.raises(cb.StaleHandleError):
        box.position = (0, 0)
    new = world.add_body(mass=1)  # in the slot of the old
    assert new is not box
    assert box.removed
    assert not new.removed
    assert box.world is world


def test_schedules_go_with_their_body() -> None:
    world, (box, _, pair) = three()
    schedules = [world.add_schedule(b, [0, 1, 2], [(1, 0), (2, 0)]) for b in (box, pair, box)]
    assert world.schedules == schedules
    assert [s.body for s in schedules] == [box, pair, box]
    np.testing.assert_array_equal(schedules[0].forces, [(1, 0), (2, 0)])
    np.testing.assert_array_equal(schedules[0].torques, [0, 0])
    np.testing.assert_array_equal(schedules[0].times, [0, 1, 2])
    box.remove()
    assert world.schedules == [schedules[1]]
    assert [s.removed for s in schedules] == [True, False, True]
    assert schedules[1].body is pair
    world.remove(schedules[1])
    assert world.schedules == []


def test_scheduled_forces_are_exact() -> None:
    world = World((0, 0))
    body = world.add_body(mass=2, inertia=1)
    world.add_schedule(body, [0.5, 1.5, math.inf], [(2, 0), (0, -2)], [0, 1])
    world.step(4)
    assert body.velocity == pytest.approx((1, -2.5), rel=1e-15)
    assert body.angular_velocity == pytest.approx(2.5, rel=1e-15)
    assert body.position == pytest.approx((0.5 + 2.5, -0.5 * 2.5**2), rel=1e-15)


def seeing(world: World) -> Callable[[cb.State], Any]:
    return lambda state: 0 * state.positions if world else None


def test_worlds_and_bodies_die_with_their_cycles() -> None:
    world, bodies = three()
    world.add_field(seeing(world))
    vars(world)["me"] = world
    vars(bodies[0])["friends"] = [bodies[1], world]
    vars(bodies[0])["kept"] = world.snapshot()
    alive: list[Any] = [weakref.ref(world), *map(weakref.ref, bodies)]
    gc.collect()
    assert all(ref() is not None for ref in alive)
    # A body alone keeps its world.
    body = bodies[0]
    del world, bodies
    gc.collect()
    assert [b.name for b in body.world.bodies] == ["box", "ground", "pair"]
    del body
    gc.collect()
    assert [ref() for ref in alive] == [None] * 4


def test_collecting_while_objects_are_made() -> None:
    threshold = gc.get_threshold()
    gc.set_threshold(1)
    try:
        world = World()
        for _ in range(200):
            vars(world.add_body(cb.Circle(1)))["own"] = world
        world.add_field(lambda state: 0 * state.positions)
        world.step(0.1)
    finally:
        gc.set_threshold(*threshold)
    assert len(world) == 200


def test_advance_reports_and_samples() -> None:
    world = World((0, 0), closed_form=False)
    body = world.add_body(mass=1, position=(1, 0), velocity=(0, 1))
    world.add_field(cb.Central((0, 0), 1, -2, per_mass=True))
    times = np.linspace(0, 2 * math.pi, 9)
    report = world.advance(2 * math.pi, 1e-12, times=times)
    assert body.position == pytest.approx((1, 0), abs=1e-10)
    assert report.estimate is not None
    assert 0 < report.estimate < 1e-9
    motion = report.trajectory
    assert motion is not None
    np.testing.assert_allclose(motion.times, times)
    exact = np.stack([np.cos(times), np.sin(times)], axis=-1)
    np.testing.assert_allclose(motion.positions[:, 0], exact, atol=1e-10)
    np.testing.assert_allclose(motion.velocities[:, 0, 0], -exact[:, 1], atol=1e-10)
    assert motion.angles.shape == motion.angular_velocities.shape == (9, 1)
    assert world.advance(1).trajectory is None
    assert "StepReport(duration=1.0" in repr(world.report())


def test_record_and_estimate() -> None:
    world = World(closed_form=False, air_density=1, timing=True)
    body = world.add_body(cb.Circle(1), velocity=(10, 10))
    twin = World(closed_form=False, air_density=1)
    other = twin.add_body(cb.Circle(1), velocity=(10, 10))
    motion = world.record(0.1, 10, every=4)
    assert len(motion) == 3
    twin.step(0.1, 8)
    assert tuple(motion.positions[-1, 0]) == other.position
    twin.step(0.1, 2, estimate=True)
    assert other.position == body.position
    estimate = twin.report().estimate
    assert estimate is not None
    assert 0 < estimate < 1e-2
    assert set(world.report().stages) == {"plan", "advance", "report"}
    assert "air drag" in world.explain()


def test_methods_are_listed_and_taken() -> None:
    for facts in cb.methods():
        world = World(method=facts.name, closed_form=False)
        world.add_body(mass=1)
        world.step(0.1)
        assert facts.name in world.explain()
        assert eval(repr(facts), vars(cb)) == facts  # noqa: S307
    assert cb.methods()[0].name == World().method


def test_stepper() -> None:
    world = World()
    stepper = cb.Stepper(100, time_scale=2, most_ticks=3)
    frame = stepper.frame(world, 0.0125)
    assert (frame.ticks, frame.fraction, frame.dropped) == (2, pytest.approx(0.5), 0)
    frame = stepper.frame(world, 0.05)
    assert (frame.ticks, frame.fraction) == (3, pytest.approx(0.5))
    assert frame.dropped == pytest.approx(0.07)
    assert world.time == pytest.approx(0.05)
    assert (stepper.tick, stepper.time_scale, stepper.most_ticks) == (0.01, 2, 3)
    with pytest.raises(ValueError, match="elapsed"):
        stepper.frame(world, -1)


def test_threads_share_a_world() -> None:
    world = World(closed_form=False, air_density=1)
    bodies = [world.add_body(cb.Circle(0.1), velocity=(1, 1)) for _ in range(20)]
    failures: list[BaseException] = []

    def work(act: Callable[[], object]) -> None:
        try:
            for _ in range(200):
                act()
        except BaseException as failure:
            failures.append(failure)

    def step() -> None:
        world.step(1 / 60, 5)

    def read() -> None:
        assert np.isfinite(world.positions).all()

    def push() -> None:
        bodies[3].apply_force((1, 0))

    def come_and_go() -> None:
        world.add_body(mass=1).remove()

    acts = [step, step, push, read, come_and_go, lambda: world.energy, world.snapshot]
    threads = [threading.Thread(target=work, args=[act], daemon=True) for act in acts]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join(60)
        assert not thread.is_alive()
    assert failures == []
    assert world.time == pytest.approx(2000 / 60)
    assert world.bodies == bodies


@given(st.lists(st.sampled_from(["add", "remove"]), max_size=30), st.randoms())
def test_body_order(acts: list[str], random: Any) -> None:
    world, expected = World(), []
    for act in acts:
        if act == "add":
            expected.append(world.add_body(mass=1))
        elif expected:
            index = random.randrange(len(expected))
            world.remove(expected[index])
            expected[index] = expected[-1]
            expected.pop()
        assert world.bodies == expected


@pytest.mark.skipif(not hasattr(signal, "setitimer"), reason="needs a timer of POSIX")
@pytest.mark.parametrize(
    "run",
    [
        lambda world: world.step(1e-6, 2**32 - 1),
        lambda world: world.record(1e-6, 2**32 - 1, every=2**31),
        lambda world: world.advance(1e9),
    ],
    ids=["step", "record", "advance"],
)
def test_a_long_run_can_be_interrupted(run: Callable[[World], object]) -> None:
    def stop(*_: object) -> None:
        raise KeyboardInterrupt

    world, (box, _, _) = three()
    for body in world:
        body.mask = 0  # they touch nothing
    # No closed form; round and round for ever.
    world.add_field(cb.Central((0, 0), 10, 1, per_mass=True))
    before = world.positions
    old = signal.signal(signal.SIGALRM, stop)
    signal.setitimer(signal.ITIMER_REAL, 0.2)
    try:
        with pytest.raises(KeyboardInterrupt):
            run(world)  # minutes
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0)
        signal.signal(signal.SIGALRM, old)
    np.testing.assert_array_equal(world.positions, before)
    assert world.time == 0
    box.apply_force((1, 0))
    world.step(1)
    assert world.time == 1

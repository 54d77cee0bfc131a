"""Studies of a user's own worlds: any reference, any executor."""

import json
import math
from collections.abc import Iterator
from concurrent.futures import Executor, ProcessPoolExecutor, ThreadPoolExecutor
from multiprocessing import get_context
from pathlib import Path

import numpy as np
import pytest

import culbuto as cb

G = 9.81


def pendulum() -> cb.World:
    world = cb.World(gravity=(0, -G))
    bob = world.add_body(cb.Circle(0.1), position=(1, 0))
    world.add_joint(cb.DistanceJoint(None, bob, anchor_a=(0, 0), anchor_b=(0, 0)))
    return world


def thrown() -> cb.World:
    world = cb.World(gravity=(0, -G))
    world.add_body(cb.Circle(0.1), velocity=(3, 4), angular_velocity=2)
    return world


def sliding() -> cb.World:
    world = cb.World()
    world.add_body(cb.Box(40, 1), kind="static", position=(0, -0.5), friction=0.5)
    world.add_body(cb.Box(1, 1), position=(0, 0.5), velocity=(3, 0), friction=0.5)
    return world


def parabola(t: float) -> list[tuple[float, float, float]]:
    return [(3 * t, 4 * t - G / 2 * t * t, 2 * t)]


def stop(t: float) -> list[tuple[float, float]]:
    slides = min(t, 3 / (0.5 * G))
    return [(0, -0.5), (3 * slides - 0.25 * G * slides**2, 0.5)]


def test_every_method_that_applies_has_rows() -> None:
    free = cb.study(thrown, duration=1, steps=[0.1], tolerances=[1e-6], repeats=1)
    assert free.methods == [facts.name for facts in cb.methods()]
    tied = cb.study(pendulum, duration=0.5, steps=[0.01], tolerances=[1e-6], repeats=1)
    holds = [facts.name for facts in cb.methods() if facts.joints]
    assert tied.methods == ["contact_step", *holds]
    met = cb.study(sliding, duration=1, steps=[0.01], repeats=1)
    assert met.methods == ["contact_step"]


def test_measured_orders_are_the_stated_ones() -> None:
    study = cb.study(pendulum, duration=1, repeats=1, tolerances=[])
    for order in study.order.values():
        # DOP853 is at rounding before its slope shows.
        assert order.measured is None or abs(order.measured - order.stated) < 0.7, order
    for name in ("contact_step", "yoshida4", "rk4"):
        measured = study.order[name].measured
        assert measured is not None
        assert abs(measured - study.order[name].stated) < 0.2


@pytest.mark.parametrize("shape", ["function", "array", "self"])
def test_a_reference_may_be_given_or_found(shape: str) -> None:
    times = np.linspace(0, 1, 9)
    references = {
        "function": parabola,
        "array": np.array([parabola(t) for t in times]),
        "self": "self",
    }
    study = cb.study(
        thrown, duration=1, steps=[1 / 8, 1 / 64], tolerances=[], repeats=1,
        methods=["explicit_euler", "leapfrog"], reference=references[shape], length=1.0,
    )  # fmt: skip
    # Explicit Euler is off by ½ght, the midpoint rule exact.
    coarse, fine, *exact = (row.error for row in study.rows)
    assert coarse == pytest.approx(G / 16, rel=1e-9)
    assert fine == pytest.approx(G / 128, rel=1e-9)
    assert max(exact) < 1e-13
    assert study.uncertainty < 1e-10
    assert study.order["leapfrog"].exact


def test_angles_count_by_the_size_of_the_body() -> None:
    def turned(t: float) -> list[tuple[float, float, float]]:
        return [(3 * t, 4 * t - G / 2 * t * t, 2 * t + 0.25)]

    study = cb.study(
        thrown, duration=1, steps=[0.1], tolerances=[], repeats=1, methods=["leapfrog"],
        reference=turned, length=1.0,
    )  # fmt: skip
    assert study.rows[0].error == pytest.approx(0.25 * 0.1, rel=1e-9)


def test_what_touches_has_its_error_against_the_exact_answer() -> None:
    study = cb.study(sliding, duration=1, steps=[1 / 60, 1 / 240], reference=stop, repeats=1)
    assert all(row.error < 1e-3 for row in study.rows)
    by_itself = cb.study(sliding, duration=1, steps=[1 / 60, 1 / 240], repeats=1)
    assert by_itself.uncertainty < 1e-5
    # The gap bounds what the reference found by itself is off.
    for exact, found in zip(study.rows, by_itself.rows, strict=True):
        assert abs(exact.error - found.error) <= by_itself.uncertainty + 1e-6


def test_errors_are_the_same_bits_every_time() -> None:
    first, second = (cb.study(pendulum, duration=1, repeats=1, tolerances=[1e-6]) for _ in "12")
    assert [row.error for row in first.rows] == [row.error for row in second.rows]


def test_the_world_stays_as_it_is() -> None:
    world = pendulum()
    cb.study(world, duration=1, steps=[0.1], repeats=1, tolerances=[])
    assert world.time == 0
    assert world.substeps == 4
    assert world.method == "leapfrog"
    assert np.array_equal(world.positions, [[1, 0]])


def test_a_scene_file_brings_its_duration(tmp_path: Path) -> None:
    path = tmp_path / "drop.json"
    thrown().save(path)
    file = json.loads(path.read_text("utf-8"))
    path.write_text(json.dumps({**file, "name": "drop", "run": {"duration": 0.5}}), "utf-8")
    study = cb.study(path, steps=[0.1], tolerances=[], repeats=1, methods=["leapfrog"])
    assert study.scene.duration == 0.5
    assert study.scene.title == "drop"
    assert study.rows[0].error < 1e-12


def dask() -> Iterator[Executor]:
    distributed = pytest.importorskip("distributed")
    with (
        distributed.LocalCluster(
            n_workers=1, threads_per_worker=1, processes=False, dashboard_address=None
        ) as cluster,
        distributed.Client(cluster) as client,
    ):
        yield client.get_executor()


def processes() -> Iterator[Executor]:
    with ProcessPoolExecutor(2, mp_context=get_context("spawn")) as pool:
        yield pool


def threads() -> Iterator[Executor]:
    with ThreadPoolExecutor(2) as pool:
        yield pool


@pytest.mark.filterwarnings("ignore")  # of Dask's own
@pytest.mark.parametrize("make", [threads, processes, dask])
def test_any_executor_gives_the_same_rows(make: object) -> None:
    alone = cb.study(pendulum(), duration=1, steps=[0.02, 0.01], tolerances=[1e-6], repeats=1)
    ball = cb.study("S1", steps=[0.1, 0.05], tolerances=[1e-6], repeats=1)
    for executor in make():  # type: ignore[operator]
        shared = cb.study(
            pendulum(), duration=1, steps=[0.02, 0.01], tolerances=[1e-6], repeats=1,
            executor=executor,
        )  # fmt: skip
        own = cb.study("S1", steps=[0.1, 0.05], tolerances=[1e-6], repeats=1, executor=executor)
    for one, two in ((alone, shared), (ball, own)):
        assert [(r.method, r.step, r.tolerance, r.error) for r in one.rows] == [
            (r.method, r.step, r.tolerance, r.error) for r in two.rows
        ]


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"scene": pendulum}, "duration is None"),
        ({"scene": pendulum, "duration": math.inf}, "duration is inf"),
        ({"scene": 3, "duration": 1}, "scene is 3"),
        ({"scene": dict, "duration": 1}, "a function that makes one"),
        ({"scene": pendulum, "duration": 1, "steps": [-1]}, "a step is -1"),
        ({"scene": pendulum, "duration": 1, "methods": ["magic"]}, "contact_step, rattle"),
        ({"scene": sliding, "duration": 1, "methods": ["rk4"]}, "in this world: contact_step"),
        ({"scene": pendulum, "duration": 1, "reference": "truth"}, "reference is 'truth'"),
        ({"scene": pendulum, "duration": 1, "reference": lambda _: [(0, 0), (1, 1)]}, "the shape"),
        ({"scene": pendulum, "duration": 1, "reference": lambda _: [(math.nan, 0)]}, "not finite"),
        ({"scene": pendulum, "duration": 1, "length": 0, "tolerances": []}, "length is 0"),
        ({"scene": "kepler", "duration": 1}, "duration is given"),
        ({"scene": pendulum, "duration": 1, "repeats": 0}, "repeats is 0"),
    ],
)
def test_says_what_is_wrong(arguments: dict[str, object], message: str) -> None:
    with pytest.raises(ValueError, match=message):
        cb.study(**{"steps": [0.1], **arguments})  # type: ignore[arg-type]


def test_a_plot_shows_how_far_the_reference_may_be_off() -> None:
    pytest.importorskip("matplotlib")
    study = cb.study(sliding, duration=1, steps=[1 / 60, 1 / 240], repeats=1)
    ax = study.plot()
    texts = [text.get_text() for text in ax.texts]
    assert "uncertainty of the reference" in texts

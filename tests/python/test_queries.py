"""What is where: queries agree with geometry that NumPy can do, and refuse what is none."""

import gc
import pickle
import weakref
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import culbuto as cb

NAN, INF = float("nan"), float("inf")
coordinate = st.floats(-10, 10)
point = st.tuples(coordinate, coordinate)
disks = st.lists(st.tuples(point, st.floats(0.1, 2)), min_size=1, max_size=8)


def world_of(disks: list[tuple[tuple[float, float], float]]) -> cb.World:
    """Disks that were added elsewhere, stepped, and then put where they are."""
    world = cb.World()
    for _, radius in disks:
        world.add_body(cb.Circle(radius))
    world.step(1 / 60)
    world.positions = [place for place, _ in disks]
    return world


def first_hit(
    start: np.ndarray, way: np.ndarray, disks: list[tuple[tuple[float, float], float]]
) -> float | None:
    """Fraction of the way at which a ray enters the first disk, by the quadratic formula."""
    fractions = []
    for center, radius in disks:
        arm = start - center
        a, b, c = way @ way, arm @ way, arm @ arm - radius**2
        if c <= 0:
            fractions.append(0.0)
        elif a > 0 and b < 0 and b * b >= a * c:
            fractions.append(c / (-b + np.sqrt(b * b - a * c)))
    return min((f for f in fractions if f <= 1), default=None)


@given(disks=disks, start=point, end=point)
def test_rays_enter_disks_where_algebra_says(disks: Any, start: Any, end: Any) -> None:
    world = world_of(disks)
    expected = first_hit(np.array(start), np.array(end) - start, disks)
    # A graze, or a start on a border, may go either way.
    radii = np.array([radius for _, radius in disks])
    shrunk, grown = (
        [(c, r * k) for (c, _), r in zip(disks, radii, strict=True)] for k in (1 - 1e-9, 1 + 1e-9)
    )
    near = [first_hit(np.array(start), np.array(end) - start, d) for d in (shrunk, grown)]
    if any((f is None) != (expected is None) for f in near):
        return
    hit = world.cast_ray(start, end)
    if expected is None or hit is None:
        assert hit is None
        assert expected is None
        return
    assert hit.fraction == pytest.approx(expected, abs=1e-6)
    assert hit.body in world
    if hit.fraction > 0:
        center, radius = disks[hit.body.index]
        assert np.hypot(*(np.array(hit.point) - center)) == pytest.approx(radius, abs=1e-9)
        assert hit.normal.dot(np.subtract(end, start)) <= 1e-9


@given(disks=disks, starts=st.lists(point, max_size=10), ends=st.lists(point, min_size=10))
def test_many_rays_are_as_one_after_the_other(disks: Any, starts: Any, ends: Any) -> None:
    world = world_of(disks)
    ends = ends[: len(starts)]
    starts, ends = np.reshape(starts, (-1, 2)), np.reshape(ends, (-1, 2))
    hits = world.cast_rays(starts, ends, mask=1)
    assert len(hits) == len(starts)
    for i, (start, end) in enumerate(zip(starts, ends, strict=True)):
        one = world.cast_ray(start, end)
        if one is None:
            assert (hits.bodies[i], hits.fractions[i]) == (-1, 1)
            assert (hits.points[i] == end).all()
            assert (hits.normals[i] == 0).all()
        else:
            assert (hits.bodies[i], hits.fractions[i]) == (one.body.index, one.fraction)
            assert tuple(hits.points[i]) == tuple(one.point)
            assert tuple(hits.normals[i]) == tuple(one.normal)
    if len(starts):
        assert (world.cast_rays(starts[0], ends).bodies >= -1).all()


@given(disks=disks, at=point, radius=st.floats(0.1, 3))
def test_points_disks_and_distances(disks: Any, at: Any, radius: float) -> None:
    world = world_of(disks)
    centers = np.array([center for center, _ in disks])
    radii = np.array([radius for _, radius in disks])
    gaps = np.hypot(*(centers - at).T) - radii
    if np.abs(gaps).min() < 1e-9 or np.abs(gaps - radius).min() < 1e-9:
        return
    assert [body.index for body in world.bodies_at(at)] == list(np.flatnonzero(gaps < 0))
    found = world.overlapping(cb.Circle(radius), position=at, angle=1)
    assert [body.index for body in found] == list(np.flatnonzero(gaps < radius))
    near = world.nearest(at)
    assert near is not None
    assert near.distance == pytest.approx(max(gaps.min(), 0), abs=1e-9)
    assert world.nearest(at, near.distance / 2 - 1e-9) is None if near.distance > 0.1 else True
    probe = world.add_body(cb.Circle(radius), position=at)
    for body, gap in zip(world.bodies, gaps, strict=False):
        apart = probe.distance_to(body)
        assert apart.distance == pytest.approx(gap - radius, abs=1e-9)
        along = np.subtract(apart.on_other, apart.on_self) @ np.array(apart.normal)
        assert along == pytest.approx(apart.distance, abs=1e-9)


def test_a_shape_is_cast_and_regions_are_seen() -> None:
    world = cb.World()
    wall = world.add_body(cb.Box(1, 4), kind="static", position=(5, 0))
    edge = world.add_body(cb.Polygon([(0, 0), (1, 0), (0, 1)]), kind="static", position=(0, 3))
    hit = world.cast_shape(cb.Circle(0.5), (8, 0))
    assert hit is not None
    assert hit.fraction == pytest.approx(0.5, abs=1e-12)
    assert hit == cb.RayHit(wall, 0, (4.5, 0), (-1, 0), hit.fraction)
    hits = world.cast_shape_all(cb.Box(1, 8), (8, 0), position=(-3, 0))
    assert [hit.body for hit in hits] == [edge, wall]
    assert world.bodies_in((0.8, 3.8), (2, 5)) == []
    assert world.bodies_in((0.8, 3.8), (2, 5), exact=False) == [edge]
    assert cb.Box(2, 2).distance_to(cb.Box(2, 2), position=(5, 0)).distance == 3


def test_what_is_seen_can_be_chosen() -> None:
    world = cb.World()
    kinds: list[dict[str, Any]] = [
        {"category": 2, "group": 5},
        {"group": -3, "mask": 4},
        {"sensor": True},
    ]
    a, b, c = (
        world.add_body(cb.Circle(0.5), kind="static", position=(2 * i, 0), **own)
        for i, own in enumerate(kinds)
    )

    def seen(**seen: Any) -> list[cb.Body]:
        return [hit.body for hit in world.cast_ray_all((-2, 0), (9, 0), **seen)]

    assert seen() == [a, b]
    assert seen(sensors=True) == [a, b, c]
    assert seen(mask=2) == [a]
    assert seen(category=8) == [a]
    assert seen(group=-3) == [a]
    assert seen(mask=1, group=5) == [a, b]
    assert seen(exclude=a) == [b]
    assert seen(exclude=[a, b], sensors=True) == [c]


def test_results_are_records() -> None:
    world = world_of([((3, 0), 1)])
    hit, near = world.cast_ray((0, 0), (4, 0)), world.nearest((0, 0))
    assert hit is not None
    assert near is not None
    assert repr(hit).startswith("RayHit(body=<dynamic Body at (3.0, 0.0)>, part=0, point=Vec2(2.0")
    twin, copy = pickle.loads(pickle.dumps((world, hit)))  # noqa: S301
    assert copy.body is twin.bodies[0]
    assert (copy.point, copy.fraction) == (hit.point, hit.fraction)
    hits = world.cast_rays((0, 0), [(4, 0), (0, 4)])
    assert repr(hits) == "<RayHits: 1 of 2 rays>"
    assert (pickle.loads(pickle.dumps(hits)).points == hits.points).all()  # noqa: S301


def test_a_body_that_keeps_its_hit_is_collected() -> None:
    world: Any = world_of([((3, 0), 1), ((6, 0), 1)])
    world.bodies[1].seen = [world.cast_ray((0, 0), (4, 0)), world.nearest((0, 0))]
    gone = weakref.ref(world)
    del world
    gc.collect()
    assert gone() is None


@pytest.mark.parametrize("bad", [NAN, INF, -INF])
def test_numbers_that_are_none_are_refused(bad: float) -> None:
    world = world_of([((0, 0), 1)])
    disk = cb.Circle(1)
    for call in (
        lambda: world.cast_ray((bad, 0), (0, 0)),
        lambda: world.cast_ray_all((0, 0), (0, bad)),
        lambda: world.cast_rays((0, 0), [(0, 1), (0, bad)]),
        lambda: world.cast_shape(disk, (bad, 0)),
        lambda: world.cast_shape_all(disk, (1, 0), angle=bad),
        lambda: world.bodies_at((0, bad)),
        lambda: world.bodies_in((0, 0), (bad, 1)),
        lambda: world.overlapping(disk, position=(bad, 0)),
        lambda: world.nearest((bad, 0)),
        lambda: disk.distance_to(disk, angle=bad),
    ):
        with pytest.raises(ValueError, match="allowed: "):
            call()
    with pytest.raises(ValueError, match="max_distance is NaN"):
        world.nearest((0, 0), NAN)


def test_what_makes_no_sense_is_refused() -> None:
    world, other = world_of([((0, 0), 1), ((5, 0), 1)]), world_of([((0, 0), 1)])
    body, gone = world.bodies
    with pytest.raises(ValueError, match="lower corner is 1"):
        world.bodies_in((1, 0), (0, 1))
    with pytest.raises(ValueError, match=r"starts has shape \(3, 2\); wanted .* \(2, 2\)"):
        world.cast_rays(np.zeros((3, 2)), np.zeros((2, 2)))
    with pytest.raises(ValueError, match="mask is -1"):
        world.cast_ray((0, 0), (1, 0), mask=-1)
    with pytest.raises(TypeError, match="unexpected keyword argument 'masks'; all queries take"):
        world.bodies_at((0, 0), masks=1)  # type: ignore[call-arg]
    with pytest.raises(TypeError, match="exclude is a Body or several of them, not int"):
        world.bodies_at((0, 0), exclude=3)  # type: ignore[arg-type]
    with pytest.raises(ValueError, match="the other body is the same body"):
        body.distance_to(body)
    with pytest.raises(cb.StaleHandleError, match="another world"):
        body.distance_to(other.bodies[0])
    with pytest.raises(cb.StaleHandleError, match="another world"):
        world.bodies_at((0, 0), exclude=other.bodies)
    gone.remove()
    with pytest.raises(cb.StaleHandleError, match="removed"):
        body.distance_to(gone)
    with pytest.raises(cb.StaleHandleError, match="removed"):
        world.cast_ray((0, 0), (1, 0), exclude=[gone])

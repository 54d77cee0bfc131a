"""Shapes as values of Python: what they print, equal, pickle, measure, and refuse."""

import copy
import math
import pickle
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

import culbuto as cb

TRIANGLE = [(0, 0), (3, 0), (0, 3)]
HOLE = [(0.5, 0.5), (1, 0.5), (0.5, 1)]
SHAPES: list[cb.Shape] = [
    cb.Circle(0.5),
    cb.Circle(0.5, center=(1, 2), density=3),
    cb.Box(1, 2),
    cb.Box(1, 2, center=(-1, 0), angle=0.3, density=0),
    cb.RegularPolygon(5, 1, center=(1, 1), angle=-0.1),
    cb.Polygon(TRIANGLE),
    cb.Polygon(np.array(TRIANGLE), holes=[HOLE], density=2),
    cb.RoundedPolygon(TRIANGLE, 0.1),
    cb.Capsule((0, 0), (1, 0), 0.25),
    cb.Segment((0, 0), (3, 4), density=2),
    cb.Arc((0, 0), 1, 0, math.pi),
    cb.Circle(0.5, friction=(0.7, 0.6), restitution=0, material="ice", mask=6, group=-1),
    cb.Box(1, 2, density=1, friction=0.3, tangent_speed=-2, one_way=(0, 1)),
    cb.Chain([(0, 0), (1, 0), (2, 1)]),
    cb.Chain(TRIANGLE, closed=True, one_sided=True, density=2),
]
every = pytest.mark.parametrize("shape", SHAPES, ids=repr)


@every
def test_survives_copies_pickles_repr_and_a_body(shape: cb.Shape) -> None:
    world = cb.World()
    body = world.add_body(shape, density=1, mass=1)
    copies = [copy.copy(shape), copy.deepcopy(shape), *body.shapes]
    copies += [pickle.loads(pickle.dumps(shape, n)) for n in (2, 3, 4, 5)]  # noqa: S301
    copies.append(eval(repr(shape), vars(cb)))  # noqa: S307
    for other in copies:
        assert type(other) is type(shape)
        assert other == shape
        assert hash(other) == hash(shape)
        assert other.density == shape.density
        assert other.second_moment == shape.second_moment


def test_differ_by_kind_numbers_and_density() -> None:
    assert len(set(SHAPES)) == len(SHAPES)
    assert cb.Circle(1) != cb.Circle(2)
    assert cb.Circle(1) != cb.Circle(1, density=1)
    assert cb.Circle(1, center=(0.0, -0.0)) == cb.Circle(1)
    assert hash(cb.Circle(1, center=(0.0, -0.0))) == hash(cb.Circle(1))
    assert cb.Circle(1) != 1


@every
def test_extents_agree_with_each_other(shape: cb.Shape) -> None:
    (left, low), (right, high) = shape.bounds
    assert shape.projection((7, 0)) == pytest.approx((left, right))
    assert shape.projection((0, 0.1)) == pytest.approx((low, high))
    assert shape.projected_width((0, -1)) == pytest.approx(high - low)
    points = np.concatenate(shape.outline(0.01))
    assert points.shape[1] == 2
    # An arc of 0.01 rad is left by its chord by at most r·(0.01)²/8.
    np.testing.assert_allclose(points.min(axis=0), (left, low), atol=1e-4)
    np.testing.assert_allclose(points.max(axis=0), (right, high), atol=1e-4)


@every
def test_mass_is_density_times_measure(shape: cb.Shape) -> None:
    mass, center, inertia = (
        getattr(shape.mass_properties(2), n) for n in ("mass", "center", "inertia")
    )
    assert (mass, center, inertia) == (2 * shape.measure, shape.centroid, 2 * shape.second_moment)
    assert (shape.area == shape.measure) == (type(shape) not in {cb.Segment, cb.Arc, cb.Chain})
    assert shape.perimeter > 0


def test_what_is_known() -> None:
    box = cb.Box(2, 4, center=(1, 0))
    assert (box.width, box.height, box.center, box.angle) == (2, 4, (1, 0), 0)
    np.testing.assert_array_equal(box.vertices, [(0, -2), (2, -2), (2, 2), (0, 2)])
    assert (box.area, box.perimeter, box.second_moment) == (8, 12, pytest.approx(8 * 20 / 12))
    assert box.contains((0, 0))
    assert not box.contains((-0.01, 0))
    polygon = cb.Polygon(TRIANGLE[::-1], holes=[HOLE])
    np.testing.assert_array_equal(np.sort(polygon.vertices, axis=0), np.sort(TRIANGLE, axis=0))
    assert polygon.area == 4.5 - 0.125
    assert len(polygon.holes) == 1
    assert sum(cb.Polygon(p).area for p in polygon.convex_pieces) == pytest.approx(polygon.area)
    assert [len(ring) for ring in polygon.outline()] == [4, 4]  # closed
    arc = cb.Arc((1, 2), 3, 0.5, -1)
    assert (arc.center, arc.radius, arc.start, arc.sweep) == ((1, 2), 3, 0.5, -1)
    chain = cb.Chain([(0, 0), (3, 4)], one_sided=True)
    assert (chain.closed, chain.one_sided, chain.measure) == (False, True, 5)
    np.testing.assert_array_equal(chain.points, [(0, 0), (3, 4)])
    segment = cb.Segment((0, 0), (3, 4))
    assert (segment.a, segment.b, segment.measure) == ((0, 0), (3, 4), 5)
    capsule = cb.Capsule((0, 0), (3, 4), 1)
    assert (capsule.a, capsule.b, capsule.radius) == ((0, 0), (3, 4), 1)
    regular = cb.RegularPolygon(6, 2)
    assert (regular.sides, regular.radius, len(regular.vertices)) == (6, 2, 6)
    rounded = cb.RoundedPolygon(TRIANGLE, 0.5)
    assert (rounded.radius, len(rounded.vertices)) == (0.5, 3)
    assert cb.Circle(2).projected_width((1, 1)) == pytest.approx(4)


@pytest.mark.parametrize(
    ("make", "error", "message"),
    [
        (lambda: cb.Circle(0), ValueError, "radius of the circle is 0"),
        (lambda: cb.Circle(math.nan), ValueError, "NaN"),
        (lambda: cb.Circle(1, density=-1), ValueError, "density is -1"),
        (lambda: cb.Box(1, -1), ValueError, "height of the box is -1"),
        (lambda: cb.RegularPolygon(2, 1), ValueError, "sides"),
        (lambda: cb.RegularPolygon(-1, 1), ValueError, "sides is -1"),
        (lambda: cb.Polygon([(0, 0), (1, 1), (1, 0), (0, 1)]), ValueError, "cross"),
        (lambda: cb.Polygon([1, 2, 3]), ValueError, r"vertices has shape \(3,\)"),
        (lambda: cb.RoundedPolygon(TRIANGLE, 0), ValueError, "above 0"),
        (lambda: cb.Arc((0, 0), 1, 0, 7), ValueError, "sweep"),
        (lambda: cb.Circle(1).projection((0, 0)), ValueError, "direction"),
        (lambda: cb.Circle(1).mass_properties(math.inf), ValueError, "density is inf"),
        (lambda: cb.Circle(1).outline(0), ValueError, "max_angle is 0"),
        (lambda: cb.Circle("1"), TypeError, "radius"),  # type: ignore[arg-type]
        (cb.Shape, TypeError, "Shape"),
    ],
)
def test_refuses(make: Callable[[], Any], error: type[Exception], message: str) -> None:
    with pytest.raises(error, match=message):
        make()


def test_are_immutable() -> None:
    with pytest.raises(AttributeError):
        cb.Circle(1).radius = 2  # type: ignore[misc]

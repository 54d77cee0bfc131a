"""Vec2: a vector space over the floats, at home among tuples and arrays."""

import copy
import math
import operator
import pickle
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from culbuto import Vec2

# Bounded, so that no product or sum overflows.
numbers = st.floats(-1e100, 1e100)
vectors = st.builds(Vec2, numbers, numbers)
# Whole numbers, on which float arithmetic is exact and so are the laws.
whole = st.integers(-1000, 1000)
exact = st.builds(Vec2, whole, whole)


@given(exact, exact, exact)
def test_addition_is_a_group(a: Vec2, b: Vec2, c: Vec2) -> None:
    assert a + b == b + a
    assert (a + b) + c == a + (b + c)
    assert a + (0, 0) == a == +a
    assert a - a == a + -a == (0, 0)


@given(exact, exact, whole, whole)
def test_scaling_distributes(a: Vec2, b: Vec2, s: int, t: int) -> None:
    assert s * (a + b) == s * a + b * s
    assert (s + t) * a == s * a + t * a
    assert s * (t * a) == (s * t) * a
    assert 1 * a == a / 1 == a


@given(exact, exact, exact, whole)
def test_products_are_bilinear(a: Vec2, b: Vec2, c: Vec2, s: int) -> None:
    assert a.dot(b) == b.dot(a)
    assert a.cross(b) == -b.cross(a)
    assert (s * a + c).dot(b) == s * a.dot(b) + c.dot(b)
    assert (s * a + c).cross(b) == s * a.cross(b) + c.cross(b)
    assert a.dot(b) ** 2 + a.cross(b) ** 2 == a.dot(a) * b.dot(b)


@given(vectors)
def test_length_and_angle_are_the_polar_form(v: Vec2) -> None:
    assert abs(v) == v.length == pytest.approx(math.hypot(*v), rel=1e-15)
    # libm's functions are within one unit in the last place each.
    assert v.angle == pytest.approx(math.atan2(v.y, v.x), rel=1e-15)


@given(vectors, numbers, numbers)
def test_tuples_stand_for_vectors(v: Vec2, x: float, y: float) -> None:
    other = Vec2(x, y)
    assert v + (x, y) == (x, y) + v == v + other
    assert v - (x, y) == v - other
    assert (x, y) - v == other - v
    forms: list[Any] = [(x, y), [x, y], np.array([x, y]), np.array([x, y], dtype=object)]
    for form in forms:
        assert other.dot(form) == other.dot(other)
        assert other.cross(form) == 0


@given(vectors)
def test_equals_and_hashes_like_the_tuple(v: Vec2) -> None:
    assert v == tuple(v)
    assert tuple(v) == v
    assert hash(v) == hash(tuple(v))
    assert v in {tuple(v)}
    assert v != Vec2(v.x + 1 + abs(v.x), v.y)
    assert v != [v.x, v.y]  # as a tuple is not equal to a list
    assert v != (v.x, v.y, 0)


@given(vectors)
def test_is_a_sequence_of_two(v: Vec2) -> None:
    x, y = v
    assert (x, y) == (v.x, v.y) == (v[0], v[1]) == (v[-2], v[-1])
    assert len(v) == 2
    for index in (2, -3):
        with pytest.raises(IndexError, match=str(index)):
            v[index]


@given(st.builds(Vec2, st.floats(), st.floats()))
def test_survives_copies_pickles_and_repr(v: Vec2) -> None:
    copies = [copy.copy(v), copy.deepcopy(v)]
    copies += [pickle.loads(pickle.dumps(v, n)) for n in range(pickle.HIGHEST_PROTOCOL + 1)]  # noqa: S301
    copies.append(eval(repr(v), {"Vec2": Vec2, "inf": math.inf, "NaN": math.nan}))  # noqa: S307
    for other in copies:
        assert type(other) is Vec2
        np.testing.assert_array_equal(other, v)  # NaN included


@given(vectors)
def test_round_trip_through_numpy(v: Vec2) -> None:
    array = np.asarray(v)
    assert array.shape == (2,)
    assert array.dtype == np.float64
    assert Vec2(*array) == v
    assert np.array([v, v]).shape == (2, 2)


def test_array_protocol() -> None:
    v = Vec2(1, 2)
    assert np.asarray(v, dtype=np.int32).dtype == np.int32
    assert v.__array__(copy=True).tolist() == [1, 2]
    with pytest.raises(ValueError, match="shared"):
        v.__array__(copy=False)


def test_numpy_scalars_scale_and_arrays_stay_arrays() -> None:
    v = Vec2(1, 2)
    for factor in (np.float64(2), np.float32(2), np.int64(2)):
        assert type(v * factor) is type(factor * v) is Vec2
        assert v * factor == factor * v == (2, 4)
        assert v / factor == (0.5, 1)
    points = np.ones((3, 2))
    for result in (v * points, points * v, v + points, points + v, v - points, points - v):
        assert isinstance(result, np.ndarray)
        assert result.shape == (3, 2)
    np.testing.assert_array_equal(v + points, np.tile([2, 3], (3, 1)))


def test_matches_by_position() -> None:
    match Vec2(1, 2):
        case Vec2(x, y):
            assert (x, y) == (1, 2)


def test_is_immutable() -> None:
    with pytest.raises(AttributeError):
        Vec2(1, 2).x = 3  # type: ignore[misc]


@pytest.mark.parametrize(
    ("wrong", "error", "message"),
    [
        ((1, 2, 3), ValueError, "expected two numbers, got 3"),
        ([], ValueError, "expected two numbers, got 0"),
        (np.zeros((3, 2)), ValueError, "expected two numbers, got 3"),
        (("1", "2"), TypeError, "str"),
        ([1, None], TypeError, "None"),
        ("12", TypeError, "str"),
        (None, TypeError, "expected two numbers, got NoneType"),
        (np.zeros((2, 2)), TypeError, "scalar"),
        ((10**400, 0), OverflowError, "too large"),
    ],
)
def test_says_what_is_wrong_with_an_argument(
    wrong: Any,
    error: type[Exception],
    message: str,
) -> None:
    with pytest.raises(error, match=message):
        Vec2(1, 2).dot(wrong)


@pytest.mark.parametrize(
    ("operation", "left", "right"),
    [
        (operator.mul, Vec2(1, 2), Vec2(1, 2)),
        (operator.mul, Vec2(1, 2), "a"),
        (operator.add, Vec2(1, 2), 1),
        (operator.add, Vec2(1, 2), (1, 2, 3)),
        (operator.truediv, 1, Vec2(1, 2)),
        (operator.lt, Vec2(1, 2), Vec2(1, 3)),
    ],
)
def test_has_no_other_operations(
    operation: Callable[[Any, Any], Any], left: object, right: object
) -> None:
    with pytest.raises(TypeError):
        operation(left, right)


def test_division_by_zero() -> None:
    with pytest.raises(ZeroDivisionError):
        Vec2(1, 2) / 0

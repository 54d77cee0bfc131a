"""How joints look in pictures: lines, rings and dots of a size that the picture gives."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, TypeAlias

import numpy as np
from numpy.typing import NDArray

from culbuto import joints
from culbuto._native import Body

if TYPE_CHECKING:
    from collections.abc import Callable

    from culbuto._native import SoftBody, World

Points = NDArray[np.float64]

COILS = 6  # of a spring
MOST_TEETH = 60  # of a ratchet; more would be a blur


@dataclass
class Mark:
    """What is drawn of a joint, in world coordinates (m).

    `lines` are polylines, closed where the first point is the last; `thin` ones are only a help to
    the eye. `rings` and `dots` are centres of circles, empty and full.
    """

    name: str
    kind: str
    lines: list[Points] = field(default_factory=list)
    thin: list[Points] = field(default_factory=list)
    rings: list[Points] = field(default_factory=list)
    dots: list[Points] = field(default_factory=list)

    @property
    def points(self) -> Points:
        """All of its points."""
        ends = np.reshape([*self.rings, *self.dots], (-1, 2))
        return np.concatenate([*self.lines, *self.thin, ends])


def marks(world: World, size: float) -> list[Mark]:
    """The joints as they are now; `size` (m) is the radius of a hinge."""
    return [_mark(joint, size) for joint in world.joints if type(joint) in _DRAWN]


def _mark(joint: joints.Joint, size: float) -> Mark:
    mark = Mark(joint.name or "", joint.kind)
    a, b = joint.points
    _DRAWN[type(joint)](mark, joint, (np.array(a), np.array(b)), size)
    return mark


def _turned(v: Points) -> Points:
    """By a quarter, counter-clockwise."""
    return np.array([-v[1], v[0]])


def _zigzag(a: Points, b: Points, size: float) -> Points:
    """A spring: straight at its ends, with coils between."""
    along = b - a
    length = float(np.hypot(*along))
    if length == 0:
        return np.array([a, b])
    steps = np.linspace(0.15, 0.85, 2 * COILS + 1)
    sides = np.resize([1.0, -1.0], len(steps)) * size
    sides[[0, -1]] = 0
    coils = a + np.outer(steps, along) + np.outer(sides, _turned(along) / length)
    return np.concatenate([[a], coils, [b]])


def _sagging(a: Points, b: Points, length: float) -> Points:
    """A rope: straight where it is taut, else a parabola of about its length."""
    apart = float(np.hypot(*(b - a)))
    # A shallow parabola of sag f over a span s is s + 8f²/3s long.
    sag = np.sqrt(3 * max(length**2 - apart**2, 0.0) / 16)
    t = np.linspace(0, 1, 25)
    return np.asarray(a + np.outer(t, b - a) - np.outer(4 * t * (1 - t), [0, sag]))


def _circle(
    center: Points, radius: Points | float, turns: float = 1.0, corners: int = 48
) -> Points:
    """A circle, or with many radii a spiral or a star."""
    angles = 2 * np.pi * turns * np.linspace(0, 1, corners + 1)
    return np.asarray(center + (radius * np.array([np.cos(angles), np.sin(angles)])).T)


def _spiral(center: Points, size: float) -> Points:
    """A spring that turns."""
    return _circle(center, np.linspace(0.5, 2.2, 61) * size, 2.5, 60)


def _center(body: Body | SoftBody | None, otherwise: Points) -> Points:
    """Of mass, of a body; the world and a point have none."""
    return np.array(body.center_of_mass) if isinstance(body, Body) else otherwise


_Ends: TypeAlias = tuple[Points, Points]


def _distance(mark: Mark, joint: joints.DistanceJoint, ends: _Ends, size: float) -> None:
    is_rod, is_free = joint.hertz == 0, joint.hertz is joint.stiffness is None
    if is_free:
        mark.thin.append(np.array(ends))
    else:
        mark.lines.append(np.array(ends) if is_rod else _zigzag(*ends, size))
    mark.dots.extend(ends)


def _rope(mark: Mark, joint: joints.RopeJoint, ends: _Ends, _: float) -> None:
    mark.lines.append(_sagging(*ends, joint.max_length))
    mark.dots.extend(ends)


def _revolute(mark: Mark, joint: joints.RevoluteJoint, ends: _Ends, size: float) -> None:
    mark.rings.append(ends[1])
    if joint.stiffness is not None:
        mark.lines.append(_spiral(ends[1], size))
    if joint.motor_speed is not None:
        # An arrow around the hinge, the way it is driven.
        way = 1 if joint.motor_speed >= 0 else -1
        arc = _circle(ends[1], 2.2 * size, 0.75 * way)
        tip, back = arc[-1], _turned(arc[-1] - ends[1]) * -way
        out = arc[-1] - ends[1]
        barbs = [tip + 0.45 * back + 0.35 * out, tip, tip + 0.45 * back - 0.35 * out]
        mark.lines.extend([arc, np.array(barbs)])


def _rail(
    mark: Mark, joint: joints.PrismaticJoint | joints.WheelJoint, a: Points, size: float
) -> Points:
    """The axis, as far as it is needed; its direction."""
    along = np.array(joint.world_axis)
    low, high = joint.limits or sorted((0.0, joint.translation))
    spare = 0.0 if joint.limits else 4 * size
    mark.thin.append(np.array([a + (low - spare) * along, a + (high + spare) * along]))
    return along


def _prismatic(mark: Mark, joint: joints.PrismaticJoint, ends: _Ends, size: float) -> None:
    a, b = ends
    along = _rail(mark, joint, a, size)
    long, wide = 1.8 * size * along, 1.1 * size * _turned(along)
    corners = [long + wide, wide - long, -long - wide, long - wide, long + wide]
    mark.lines.append(b + np.array(corners))
    if joint.stiffness is not None:
        mark.lines.append(_zigzag(a + joint.rest_translation * along - 8 * long, b - long, size))


def _weld(mark: Mark, _: joints.WeldJoint, ends: _Ends, size: float) -> None:
    for way in ([1, 1], [1, -1]):
        mark.lines.append(ends[1] + 1.2 * size * np.outer([-1, 1], way))


def _wheel(mark: Mark, joint: joints.WheelJoint, ends: _Ends, size: float) -> None:
    a, b = ends
    along = _rail(mark, joint, a, size)
    if joint.stiffness is not None:
        mark.lines.append(_zigzag(b, a + 9 * size * along, size))
    mark.rings.append(b)


def _grab(mark: Mark, _: joints.GrabJoint, ends: _Ends, size: float) -> None:
    target, point = ends
    mark.thin.append(np.array(ends))
    mark.dots.append(point)
    mark.rings.append(target)
    for way in ([1, 0], [0, 1]):
        mark.lines.append(target + 2 * size * np.outer([-1, 1], way))


def _motor(mark: Mark, joint: joints.MotorJoint, ends: _Ends, _: float) -> None:
    a, b = ends
    body, offset = joint.body_a, joint.linear_offset
    anchor = joint.anchor_a + offset
    target = body.world_point(anchor) if isinstance(body, Body) else anchor
    goal = np.array(target)
    mark.thin.extend([np.array([a, goal]), np.array([goal, b])])
    mark.dots.append(b)
    mark.rings.append(goal)


def _gear(mark: Mark, joint: joints.GearJoint, ends: _Ends, _: float) -> None:
    """The circles on which the gears would roll on each other."""
    a, b = _center(joint.body_a, ends[0]), _center(joint.body_b, ends[1])
    apart, ratio = float(np.hypot(*(b - a))), joint.ratio
    if ratio == -1:  # as through a belt
        mark.thin.append(np.array([a, b]))
        return
    mark.thin.append(_circle(a, abs(apart * ratio / (1 + ratio))))
    mark.thin.append(_circle(b, abs(apart / (1 + ratio))))


def _pulley(mark: Mark, joint: joints.PulleyJoint, ends: _Ends, _: float) -> None:
    over = [np.array(point) for point in joint.over]
    mark.lines.append(np.array([ends[0], *over, ends[1]]))
    mark.rings.extend(over)
    mark.dots.extend(ends)


def _rack(mark: Mark, joint: joints.RackJoint, ends: _Ends, size: float) -> None:
    a, b = ends
    along = np.array(joint.world_axis)
    # The line on which the pitch circle rolls, from A's anchor to where the pinion is.
    foot = b - joint.radius * _turned(along)
    ways = (foot - (a + np.dot(foot - a, _turned(along)) * _turned(along))) @ along
    low, high = sorted((0.0, float(ways)))
    low, high = low - 6 * size, high + 6 * size
    teeth = int((high - low) / size) if size > 0 else 1
    steps = np.linspace(low, high, teeth + 1)
    side = np.resize([0.4, -0.4], len(steps)) * size
    start = foot - ways * along
    mark.lines.append(start + np.outer(steps, along) + np.outer(side, _turned(along)))
    mark.thin.append(_circle(b, abs(joint.radius)))


def _ratchet(mark: Mark, joint: joints.RatchetJoint, ends: _Ends, size: float) -> None:
    """A wheel with as many teeth as there are notches, steep on the side that holds."""
    teeth = min(max(round(2 * np.pi / abs(joint.step)), 3), MOST_TEETH)
    tooth = [2.2, 3.0] if joint.step > 0 else [3.0, 2.2]
    angles = np.repeat(np.arange(teeth + 1), 2) * 2 * np.pi / teeth + joint.phase
    radii = np.resize(tooth[::-1], len(angles)) * size
    center = _center(joint.body_b, ends[1])
    mark.lines.append(center + (radii * np.array([np.cos(angles), np.sin(angles)])).T)


def _friction(mark: Mark, _: joints.FrictionJoint, ends: _Ends, size: float) -> None:
    for x in (-0.9, 0.0, 0.9):
        mark.lines.append(ends[1] + size * np.array([[x - 0.7, -1.2], [x + 0.7, 1.2]]))


def _angle_spring(mark: Mark, joint: joints.AngleSpringJoint, ends: _Ends, size: float) -> None:
    mark.lines.append(_spiral(_center(joint.body_b, ends[1]), size))


def _custom(mark: Mark, joint: joints.CustomJoint, ends: _Ends, _: float) -> None:
    a, b = _center(joint.body_a, ends[0]), _center(joint.body_b, ends[1])
    mark.thin.append(np.array([a, b]))


_DRAWN: dict[type[joints.Joint], Callable[..., None]] = {
    joints.DistanceJoint: _distance,
    joints.RopeJoint: _rope,
    joints.RevoluteJoint: _revolute,
    joints.PrismaticJoint: _prismatic,
    joints.WeldJoint: _weld,
    joints.WheelJoint: _wheel,
    joints.GrabJoint: _grab,
    joints.MotorJoint: _motor,
    joints.GearJoint: _gear,
    joints.PulleyJoint: _pulley,
    joints.RackJoint: _rack,
    joints.RatchetJoint: _ratchet,
    joints.FrictionJoint: _friction,
    joints.AngleSpringJoint: _angle_spring,
    joints.CustomJoint: _custom,
}

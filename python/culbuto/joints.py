"""What ties two bodies, or a body and the world. `docs/joints.md` is the guide.

A joint is made of its bodies and of what it does, and given to a world:

>>> import culbuto as cb
>>> world = cb.World()
>>> ground = world.add_body(kind="static")
>>> bob = world.add_body(cb.Circle(0.1), position=(1, 0))
>>> hinge = world.add_joint(cb.RevoluteJoint(ground, bob, point=(0, 0)))
>>> hinge.anchor_b
Vec2(-1.0, 0.0)

From then on it is what the world has: what is set on it acts at once, and what there is to be seen
of it can be read.

>>> hinge.limits = (-1, 1)
>>> hinge.motor_speed, hinge.angle
(None, 0.0)
>>> hinge.remove()
>>> hinge.removed
True

All of them take:

- two bodies, A and B, of which either may be None: the world. Either may be deformable, if the
  joint holds points and no angles: it then holds the point of the material that is nearest;
- where they are held: `anchor_a` and `anchor_b` (m) in the bodies' frames, or `points`, one for
  each, or one `point` for both, in the world; the bodies' origins, if nothing is given;
- `collide_connected`: whether A and B can touch each other;
- `breaking_force` (N) and `breaking_torque` (N·m) above which the joint breaks;
- `name`, which need not be unique.

Springs are given by `hertz` and `damping_ratio`, as what hangs on them swings, or by `stiffness`
(N/m, N·m/rad) and `damping` (N·s/m, N·m·s/rad). 0 Hz is rigid, None is no spring at all.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Generic, TypeAlias, TypedDict, TypeVar, cast, final, overload

from culbuto._native import Body, Vec2, _Joint

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    import numpy as np
    from numpy.typing import ArrayLike, NDArray
    from typing_extensions import Self, Unpack

    from culbuto._native import SoftBody

    _Part: TypeAlias = Body | SoftBody
    _Vector: TypeAlias = Vec2 | Sequence[float] | NDArray[Any]
    _Points: TypeAlias = Sequence[_Vector] | NDArray[Any]

    _Pose: TypeAlias = NDArray[np.float64]
    _Constraint: TypeAlias = Callable[[_Pose, _Pose], tuple[ArrayLike, ArrayLike]]

    class _Common(TypedDict, total=False):
        """What all joints with anchors take."""

        anchor_a: _Vector | None
        anchor_b: _Vector | None
        point: _Vector | None
        points: _Points | None
        collide_connected: bool
        breaking_force: float | None
        breaking_torque: float | None
        name: str | None

    class _Plain(TypedDict, total=False):
        """What joints without anchors take."""

        collide_connected: bool
        breaking_torque: float | None
        name: str | None

    class _Constants(_Common, total=False):
        """A spring by its constants, instead of hertz and damping_ratio."""

        stiffness: float | None
        damping: float

    class _TwoSprings(_Common, total=False):
        """How firmly a way and an angle are held; rigidly, if nothing is given."""

        linear_hertz: float | None
        linear_damping_ratio: float
        linear_stiffness: float | None
        linear_damping: float
        angular_hertz: float | None
        angular_damping_ratio: float
        angular_stiffness: float | None
        angular_damping: float


_Got = TypeVar("_Got")
_Set = TypeVar("_Set")


class _Readout(Generic[_Got]):
    """Something to be seen of a joint."""

    def __init__(self, about: str) -> None:
        self.__doc__ = about
        self._name = ""

    def __set_name__(self, owner: type, name: str) -> None:
        self._name = name

    @overload
    def __get__(self, joint: None, owner: type) -> Self: ...
    @overload
    def __get__(self, joint: Joint, owner: type) -> _Got: ...
    def __get__(self, joint: Joint | None, owner: type) -> Self | _Got:
        return self if joint is None else cast("_Got", joint._read(self._name))

    def __set__(self, joint: Joint, value: Any) -> None:  # noqa: ANN401 — nothing can be set
        raise AttributeError(f"{self._name} can only be read")


class _Parameter(_Readout[_Got], Generic[_Got, _Set]):
    """Something to be seen and set."""

    def __set__(self, joint: Joint, value: _Set) -> None:
        joint._write(self._name, value)


_Number = _Parameter[float, float]
_Maybe = _Parameter["float | None", "float | None"]
_Range = _Parameter["tuple[float, float] | None", "tuple[float, float] | None"]
_Place = _Parameter[Vec2, "_Vector"]
_Pair = _Parameter["tuple[Vec2, Vec2]", "_Points"]
_Flag = _Parameter[bool, bool]
_Text = _Parameter["str | None", "str | None"]


class Joint(_Joint):
    """What ties two bodies, or a body and the world: the base of the classes of all kinds.

    There is one object per joint, so joints are compared by identity and keep attributes of the
    user's own. A joint that was removed raises `StaleHandleError`.
    """

    anchor_a = _Place("Where it holds A, in A's frame (m); of a deformable one, in the world.")
    anchor_b = _Place("Where it holds B, in B's frame (m); of a deformable one, in the world.")
    points = _Pair("Where it holds A and B, in the world (m).")
    collide_connected = _Flag("Whether A and B can touch each other.")
    breaking_force = _Maybe("Force above which it breaks (N); None: never.")
    breaking_torque = _Maybe("Torque above which it breaks (N·m); None: never.")
    name = _Text("Name, or None.")

    reaction_force = _Readout[Vec2]("Mean force on B in the last step (N); A got its opposite.")
    reaction_torque = _Readout[float](
        "Mean torque on B about its anchor in the last step (N·m); A got its opposite."
    )
    gap = _Readout[float](
        "How far it is from what it holds rigidly (m; rad where it holds an angle)."
    )
    energy = _Readout[float]("Energy in its springs (J).")


class _Sprung(Joint):
    """A joint with one spring."""

    hertz = _Maybe("Frequency (Hz); 0: rigid; None: no spring, or one that is given by stiffness.")
    damping_ratio = _Maybe("0 swings for ever, 1 comes back without swinging; None beside hertz.")
    stiffness = _Maybe("N/m, or N·m/rad; None if there is no spring.")
    damping = _Maybe("N·s/m, or N·m·s/rad; None if there is no spring.")


class _TwiceSprung(Joint):
    """A joint that holds a way and an angle, each rigidly or by a spring."""

    linear_hertz = _Maybe("Frequency of the way (Hz); 0: rigid; None: free, or given by stiffness.")
    linear_damping_ratio = _Maybe("0 swings for ever, 1 comes back without swinging.")
    linear_stiffness = _Maybe("Stiffness of the way (N/m); None if it has no spring.")
    linear_damping = _Maybe("Damping of the way (N·s/m); None if it has no spring.")
    angular_hertz = _Maybe("Frequency of the angle (Hz); 0: rigid; None: free, or by stiffness.")
    angular_damping_ratio = _Maybe("0 swings for ever, 1 comes back without swinging.")
    angular_stiffness = _Maybe("Stiffness of the angle (N·m/rad); None if it has no spring.")
    angular_damping = _Maybe("Damping of the angle (N·m·s/rad); None if it has no spring.")


class _Axial(Joint):
    """A joint along an axis that is fixed to A."""

    axis = _Place("Direction in A's frame.")

    @property
    def world_axis(self) -> Vec2:
        """Direction in the world."""
        body = self.body_a
        if not isinstance(body, Body):
            return self.axis
        return body.world_point(self.axis) - body.position

    @world_axis.setter
    def world_axis(self, value: _Vector) -> None:
        self._write("world_axis", value)


class _Turning(Joint):
    """A joint in which B turns against A."""

    angle = _Readout[float]("Angle of B against A, from the reference angle (rad), not wrapped.")
    speed = _Readout[float]("Angular velocity of B against A (rad/s).")


class _Sliding(_Axial):
    """A joint in which B moves along an axis of A."""

    translation = _Readout[float]("Way of B's anchor along the axis from A's (m).")
    speed = _Readout[float]("Its rate (m/s).")


def _axis(
    axis: _Vector | None, world_axis: _Vector | None, usual: _Vector | None = None
) -> dict[str, _Vector]:
    """The one of both that is given."""
    if axis is not None and world_axis is not None:
        raise ValueError("give axis or world_axis, not both")
    if world_axis is not None:
        return {"world_axis": world_axis}
    axis = usual if axis is None else axis
    if axis is None:
        raise ValueError("give axis, a direction in A's frame, or world_axis")
    return {"axis": axis}


@final
class DistanceJoint(_Sprung):
    """Keeps the anchors at a distance: a rod, or a spring, between limits.

    Without a length it keeps them as far apart as they are.
    """

    def __init__(
        self,
        body_a: _Part | None,
        body_b: _Part | None,
        *,
        length: float | None = None,
        hertz: float | None = 0.0,
        damping_ratio: float = 0.0,
        min_length: float = 0.0,
        max_length: float | None = None,
        **others: Unpack[_Constants],
    ) -> None:
        self._make(
            "distance", body_a, body_b, length=length, hertz=hertz, damping_ratio=damping_ratio,
            min_length=min_length, max_length=max_length, **others,
        )  # fmt: skip

    length = _Maybe("Length at rest (m). None: as long as it is now.")
    min_length = _Number("Least length (m).")
    max_length = _Maybe("Greatest length (m); None: any.")
    current_length = _Readout[float]("Distance of the anchors (m).")
    speed = _Readout[float]("Its rate (m/s).")


@final
class RopeJoint(Joint):
    """Keeps the anchors no further apart than the length of a rope."""

    def __init__(
        self,
        body_a: _Part | None,
        body_b: _Part | None,
        *,
        max_length: float,
        **others: Unpack[_Common],
    ) -> None:
        self._make("distance", body_a, body_b, hertz=None, max_length=max_length, **others)

    max_length = _Number("Greatest length (m).")
    current_length = _Readout[float]("Distance of the anchors (m).")
    speed = _Readout[float]("Its rate (m/s).")


@final
class RevoluteJoint(_Sprung, _Turning):
    """A hinge: keeps the anchors together, and lets B turn about them.

    The angle can be limited, driven by a motor and drawn to a rest angle by a spring.
    """

    def __init__(
        self,
        body_a: _Part | None,
        body_b: _Part | None,
        *,
        limits: tuple[float, float] | None = None,
        motor_speed: float | None = None,
        max_torque: float | None = None,
        hertz: float | None = None,
        damping_ratio: float = 0.0,
        rest_angle: float = 0.0,
        reference_angle: float | None = None,
        **others: Unpack[_Constants],
    ) -> None:
        self._make(
            "revolute", body_a, body_b, limits=limits, motor_speed=motor_speed,
            max_torque=max_torque, hertz=hertz, damping_ratio=damping_ratio,
            rest_angle=rest_angle, reference_angle=reference_angle, **others,
        )  # fmt: skip

    limits = _Range("Lowest and highest angle (rad), or None.")
    motor_speed = _Maybe("Speed of the motor (rad/s); None: no motor.")
    max_torque = _Maybe("Most that the motor uses (N·m); None: whatever it takes.")
    rest_angle = _Number("Angle at which the spring is at rest (rad).")
    reference_angle = _Maybe("Angle of B against A that counts as 0 (rad). None: that of now.")


@final
class PrismaticJoint(_Sprung, _Sliding):
    """A slider: B's anchor moves along an axis fixed to A, and B does not turn against A.

    The way can be limited, driven by a motor and drawn to rest by a spring.
    """

    def __init__(
        self,
        body_a: _Part | None,
        body_b: _Part | None,
        *,
        axis: _Vector | None = None,
        world_axis: _Vector | None = None,
        limits: tuple[float, float] | None = None,
        motor_speed: float | None = None,
        max_force: float | None = None,
        hertz: float | None = None,
        damping_ratio: float = 0.0,
        rest_translation: float = 0.0,
        reference_angle: float | None = None,
        **others: Unpack[_Constants],
    ) -> None:
        self._make(
            "prismatic", body_a, body_b, **_axis(axis, world_axis), limits=limits,
            motor_speed=motor_speed, max_force=max_force, hertz=hertz,
            damping_ratio=damping_ratio, rest_translation=rest_translation,
            reference_angle=reference_angle, **others,
        )  # fmt: skip

    limits = _Range("Lowest and highest way along the axis (m), or None.")
    motor_speed = _Maybe("Speed of the motor (m/s); None: no motor.")
    max_force = _Maybe("Most that the motor uses (N); None: whatever it takes.")
    rest_translation = _Number("Way at which the spring is at rest (m).")
    reference_angle = _Maybe("Angle of B against A that is kept (rad). None: that of now.")


@final
class WeldJoint(_TwiceSprung, _Turning):
    """Keeps the anchors together and the angle: rigidly, or softly in each of both."""

    def __init__(
        self,
        body_a: _Part | None,
        body_b: _Part | None,
        *,
        reference_angle: float | None = None,
        **others: Unpack[_TwoSprings],
    ) -> None:
        self._make("weld", body_a, body_b, reference_angle=reference_angle, **others)

    reference_angle = _Maybe("Angle of B against A that is kept (rad). None: that of now.")


@final
class WheelJoint(_Sprung, _Sliding):
    """A wheel on a suspension: B turns about its anchor, and rides along an axis fixed to A.

    The axis is A's y axis, if nothing else is given. The spring is that of the suspension, the
    motor drives the turn.
    """

    def __init__(
        self,
        body_a: _Part | None,
        body_b: _Part | None,
        *,
        axis: _Vector | None = None,
        world_axis: _Vector | None = None,
        hertz: float | None = 0.0,
        damping_ratio: float = 0.0,
        limits: tuple[float, float] | None = None,
        motor_speed: float | None = None,
        max_torque: float | None = None,
        **others: Unpack[_Constants],
    ) -> None:
        self._make(
            "wheel", body_a, body_b, **_axis(axis, world_axis, (0.0, 1.0)), hertz=hertz,
            damping_ratio=damping_ratio, limits=limits, motor_speed=motor_speed,
            max_torque=max_torque, **others,
        )  # fmt: skip

    limits = _Range("Lowest and highest way along the axis (m), or None.")
    motor_speed = _Maybe("Speed at which the motor turns B against A (rad/s); None: no motor.")
    max_torque = _Maybe("Most that the motor uses (N·m); None: whatever it takes.")


@final
class GrabJoint(_Sprung):
    """Draws a point of a body to a target that can be moved: what a mouse does.

    The point is that which is at the target now, or `anchor` in the body's frame. A is the world.
    """

    def __init__(
        self,
        body: _Part,
        target: _Vector,
        *,
        anchor: _Vector | None = None,
        hertz: float | None = 0.0,
        damping_ratio: float = 0.0,
        max_force: float | None = None,
        **others: Unpack[_Constants],
    ) -> None:
        place: dict[str, _Vector] = (
            {"point": target} if anchor is None else {"target": target, "anchor_b": anchor}
        )
        self._make(
            "grab", None, body, **place, hertz=hertz, damping_ratio=damping_ratio,
            max_force=max_force, **others,
        )  # fmt: skip

    target = _Place("Where the point is drawn to, in the world (m).")
    max_force = _Maybe("Largest force (N); None: whatever it takes.")


@final
class MotorJoint(_TwiceSprung, _Turning):
    """Drives B's anchor to an offset from A's, in A's frame, and B's angle to a value."""

    def __init__(
        self,
        body_a: _Part | None,
        body_b: _Part | None,
        *,
        linear_offset: _Vector = (0.0, 0.0),
        angular_offset: float | None = None,
        max_force: float | None = None,
        max_torque: float | None = None,
        **others: Unpack[_TwoSprings],
    ) -> None:
        self._make(
            "motor", body_a, body_b, linear_offset=linear_offset, angular_offset=angular_offset,
            max_force=max_force, max_torque=max_torque, **others,
        )  # fmt: skip

    linear_offset = _Place("Where B's anchor is driven to, from A's and in A's frame (m).")
    angular_offset = _Maybe("Angle of B against A that it is driven to (rad). None: that of now.")
    max_force = _Maybe("Largest force (N); None: whatever it takes.")
    max_torque = _Maybe("Largest torque (N·m); None: whatever it takes.")


@final
class GearJoint(Joint):
    """Ties two turns: ratio·θ_a + θ_b stays.

    What turns the pair as a whole is taken up by the world, as by the case of a gearbox.
    """

    def __init__(
        self,
        body_a: _Part | None,
        body_b: _Part | None,
        *,
        ratio: float = 1.0,
        phase: float | None = None,
        **others: Unpack[_Plain],
    ) -> None:
        self._make("gear", body_a, body_b, ratio=ratio, phase=phase, **others)

    ratio = _Number("Teeth of A over teeth of B: above 0 where they turn against each other.")
    phase = _Maybe("What ratio·θ_a + θ_b is (rad). None: what it is now.")


@final
class PulleyJoint(Joint):
    """A rope from A's anchor over two fixed points to B's: l_a + ratio·l_b stays."""

    def __init__(
        self,
        body_a: _Part | None,
        body_b: _Part | None,
        *,
        over: _Points,
        ratio: float = 1.0,
        length: float | None = None,
        slack: bool = False,
        **others: Unpack[_Common],
    ) -> None:
        self._make(
            "pulley", body_a, body_b, over=over, ratio=ratio, length=length, slack=slack, **others
        )

    over = _Pair("Where the rope leaves for A and for B, in the world (m).")
    ratio = _Number("How many times B's side counts.")
    length = _Maybe("What l_a + ratio·l_b is (m). None: what it is now.")
    slack = _Flag("Whether the rope may go slack.")


@final
class RackJoint(_Sliding):
    """B, a pinion, rolls along a straight rack that is fixed to A.

    translation − radius·angle stays.
    """

    def __init__(
        self,
        body_a: _Part | None,
        body_b: _Part | None,
        *,
        radius: float,
        axis: _Vector | None = None,
        world_axis: _Vector | None = None,
        offset: float | None = None,
        **others: Unpack[_Common],
    ) -> None:
        self._make(
            "rack",
            body_a,
            body_b,
            **_axis(axis, world_axis),
            radius=radius,
            offset=offset,
            **others,
        )

    radius = _Number("Way along the axis per radian (m): the pitch radius; may be below 0.")
    offset = _Maybe("What translation − radius·angle is (m). None: what it is now.")


@final
class RatchetJoint(_Turning):
    """Lets B turn one way only, from notch to notch."""

    def __init__(
        self,
        body_a: _Part | None,
        body_b: _Part | None,
        *,
        step: float,
        phase: float = 0.0,
        **others: Unpack[_Plain],
    ) -> None:
        self._make("ratchet", body_a, body_b, step=step, phase=phase, **others)

    step = _Number("From one notch to the next (rad); below 0: clockwise.")
    phase = _Number("Where one of the notches is (rad).")


@final
class FrictionJoint(_Turning):
    """Resists any motion of the anchors against each other and any turn, up to a bound."""

    def __init__(
        self,
        body_a: _Part | None,
        body_b: _Part | None,
        *,
        max_force: float,
        max_torque: float,
        **others: Unpack[_Common],
    ) -> None:
        self._make("friction", body_a, body_b, max_force=max_force, max_torque=max_torque, **others)

    max_force = _Number("Largest force (N).")
    max_torque = _Number("Largest torque (N·m).")


@final
class AngleSpringJoint(_Sprung, _Turning):
    """Draws the angle of B against A to a value. `angle` is what it is away from it."""

    def __init__(
        self,
        body_a: _Part | None,
        body_b: _Part | None,
        *,
        hertz: float | None = None,
        damping_ratio: float = 0.0,
        stiffness: float | None = None,
        damping: float = 0.0,
        rest_angle: float | None = None,
        **others: Unpack[_Plain],
    ) -> None:
        self._make(
            "angle_spring", body_a, body_b, hertz=hertz, damping_ratio=damping_ratio,
            stiffness=stiffness, damping=damping, rest_angle=rest_angle, **others,
        )  # fmt: skip

    rest_angle = _Maybe("Angle of B against A at rest (rad). None: that of now.")


@final
class FilterJoint(Joint):
    """Nothing but that two bodies do not touch."""

    def __init__(self, body_a: Body, body_b: Body, *, name: str | None = None) -> None:
        self._make("filter", body_a, body_b, name=name)


@final
class CustomJoint(Joint):
    """Keeps C(q) = 0, by a function of your own.

    The function gets the poses of A and of B, each an array (3,) of x, y (m) and angle (rad) of its
    frame, and gives C and its Jacobian: of `rows` rows (1 to 3) an array (rows,) and an array
    (rows, 6) of ∂C/∂(x, y, angle) of A, then of B. One row may be a number and an array (6,). The
    Jacobian is compared with differences of C when the joint is added.

    >>> import culbuto as cb
    >>> def on_a_parabola(a, b):
    ...     x, y, _ = b
    ...     return y - x * x, [0, 0, 0, -2 * x, 1, 0]
    >>> world = cb.World()
    >>> bead = world.add_body(mass=1, position=(1, 1))
    >>> wire = world.add_joint(cb.CustomJoint(None, bead, on_a_parabola))
    >>> world.step(1 / 240, 240)
    >>> abs(bead.position.y - bead.position.x**2) < 1e-9
    True
    """

    def __init__(
        self,
        body_a: _Part | None,
        body_b: _Part | None,
        constraint: _Constraint,
        *,
        rows: int = 1,
        **others: Unpack[_Common],
    ) -> None:
        self._make("custom", body_a, body_b, **others)
        self._rule(constraint, rows)

    @property
    def constraint(self) -> _Constraint:
        """The function."""
        return cast("_Constraint", self._function)


_CLASSES: dict[str, type[Joint]] = {
    "distance": DistanceJoint,
    "rope": RopeJoint,
    "revolute": RevoluteJoint,
    "prismatic": PrismaticJoint,
    "weld": WeldJoint,
    "wheel": WheelJoint,
    "grab": GrabJoint,
    "motor": MotorJoint,
    "gear": GearJoint,
    "pulley": PulleyJoint,
    "rack": RackJoint,
    "ratchet": RatchetJoint,
    "friction": FrictionJoint,
    "angle_spring": AngleSpringJoint,
    "filter": FilterJoint,
    "custom": CustomJoint,
}


def class_of(kind: str) -> type[Joint]:
    """The class of a kind of joints."""
    return _CLASSES[kind]

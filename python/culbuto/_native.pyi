"""The engine. Import `culbuto` instead.

Quantities are in SI units, angles in radians. Vectors are given as a `Vec2`, a tuple or anything
of two numbers, arrays as anything NumPy makes an array of floats of. A number or a shape that is
not allowed is a `ValueError`, what was removed a `StaleHandleError`; a call that fails leaves the
world as it was.
"""

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from os import PathLike
from typing import (
    Any,
    ClassVar,
    Final,
    Literal,
    NoReturn,
    SupportsFloat,
    SupportsIndex,
    TypeAlias,
    TypedDict,
    TypeVar,
    final,
    type_check_only,
)

import numpy as np
from matplotlib.axes import Axes
from numpy.typing import ArrayLike, DTypeLike, NDArray
from typing_extensions import Self, Unpack, disjoint_base

from culbuto import builders
from culbuto.joints import Joint

__all__ = [
    "Arc",
    "Attraction",
    "Audit",
    "Body",
    "Box",
    "BrokenJoint",
    "Capsule",
    "Central",
    "Chain",
    "Circle",
    "Contact",
    "ContactEvent",
    "ContactEvents",
    "Contacts",
    "Distance",
    "Energy",
    "Events",
    "Facts",
    "Field",
    "Fluid",
    "Frame",
    "Inflow",
    "Joints",
    "MassProperties",
    "Nearest",
    "NearestSoft",
    "Oscillating",
    "PairOfMaterials",
    "Polygon",
    "PreSolve",
    "RayHit",
    "RayHits",
    "RegularPolygon",
    "RoundedPolygon",
    "SceneFile",
    "SceneFileError",
    "Schedule",
    "Segment",
    "Shape",
    "SimulationError",
    "Snapshot",
    "SoftBody",
    "SoftContact",
    "SoftEvents",
    "SoftRayHit",
    "SpringMotion",
    "StaleHandleError",
    "State",
    "StepReport",
    "Stepper",
    "Trajectory",
    "Vec2",
    "World",
    "_Joint",
    "__version__",
    "bridge",
    "catalogue",
    "chain",
    "exact_motion",
    "hard_scenes",
    "lattice",
    "measured_order",
    "methods",
    "open_scene",
    "ragdoll",
    "rope",
    "scene_error",
    "scene_schema",
    "stability_of",
    "study",
    "thrown_ball",
    "vehicle",
    "verify",
    "verify_laws",
]

__version__: Final[str]

_Float: TypeAlias = SupportsFloat | SupportsIndex
_Operand: TypeAlias = Vec2 | tuple[_Float, _Float]
_Vec2Arg: TypeAlias = Vec2 | Sequence[_Float] | NDArray[Any]
_Array: TypeAlias = NDArray[np.float64]
_Path: TypeAlias = str | PathLike[str]
_Kind: TypeAlias = Literal["dynamic", "static", "kinematic"]
_Width: TypeAlias = Literal["silhouette", "bounding_box"] | float
_Column: TypeAlias = Literal[
    "positions", "angles", "velocities", "angular_velocities", "forces", "torques"
]
_Rule: TypeAlias = Literal[
    "geometric_mean", "hypotenuse", "product", "minimum", "maximum", "average"
]
_ImpactLaw: TypeAlias = Literal["newton", "poisson", "stronge"]
_Solver: TypeAlias = Literal["sweep", "newton", "auto"]
_Friction: TypeAlias = float | _Vec2Arg
_Law: TypeAlias = Callable[[State], ArrayLike | tuple[ArrayLike, ArrayLike]]
_Potential: TypeAlias = Callable[[State], float]

@type_check_only
class _Own(TypedDict, total=False):
    """What a shape may have of its own; what is not given, or None, is the body's."""

    density: float | None
    """Mass per area (kg/m²), per length of a wire (kg/m)."""
    friction: _Friction | None
    """A number, or two: static and kinetic."""
    restitution: float | None
    """Speed after over speed before a collision, 0 to 1."""
    rolling_resistance: float | None
    """Arm by which the normal force opposes rolling (m)."""
    tangent_speed: float | None
    """Of the surface along its border, counter-clockwise (m/s)."""
    material: str | None
    """Name, for `World.set_pair`."""
    category: int | None
    """Bits of the categories it belongs to."""
    mask: int | None
    """Bits of the categories it touches."""
    group: int | None
    """Shapes of one group always touch if it is above 0, and never if it is below."""
    sensor: bool | None
    """It only notices what overlaps it."""
    one_way: _Vec2Arg | None
    """It stops only what comes from the side that this points to, in the body's frame."""

@type_check_only
class _SeenSofts(TypedDict, total=False):
    """Which deformable bodies a query sees; all, if nothing is given."""

    mask: int
    """Bits of the categories that are seen."""
    category: int
    """Bits of its own categories: it sees only bodies that have one of them in their masks."""
    group: int
    """Bodies of this group are all seen if it is above 0, and none if it is below."""
    exclude: Iterable[SoftBody]
    """Bodies that are not seen."""

class _Seen(TypedDict, total=False):
    """Which shapes a query sees; all but sensors, if nothing is given."""

    mask: int | None
    """Bits of the categories that are seen."""
    category: int | None
    """Bits of its own categories: it sees only shapes that have one of them in their masks."""
    group: int | None
    """Shapes of this group are all seen if it is above 0, and none if it is below."""
    sensors: bool | None
    """Whether sensors are seen."""
    exclude: Body | Iterable[Body] | None
    """Bodies that are not seen."""

class SceneFileError(ValueError): ...
class SimulationError(RuntimeError): ...
class StaleHandleError(LookupError): ...

@final
class Vec2:
    __array_priority__: ClassVar[float]
    __match_args__: ClassVar[tuple[str, str]]

    def __new__(cls, x: _Float, y: _Float) -> Vec2: ...
    @property
    def x(self) -> float: ...
    @property
    def y(self) -> float: ...
    @property
    def length(self) -> float: ...
    @property
    def angle(self) -> float: ...
    def dot(self, other: _Vec2Arg) -> float: ...
    def cross(self, other: _Vec2Arg) -> float: ...
    def __add__(self, value: _Operand, /) -> Vec2: ...
    def __radd__(self, value: tuple[_Float, _Float], /) -> Vec2: ...
    def __sub__(self, value: _Operand, /) -> Vec2: ...
    def __rsub__(self, value: tuple[_Float, _Float], /) -> Vec2: ...
    def __mul__(self, value: _Float, /) -> Vec2: ...
    def __rmul__(self, value: _Float, /) -> Vec2: ...
    def __truediv__(self, value: _Float, /) -> Vec2: ...
    # The slot serves both sides; nothing can be divided by a vector.
    def __rtruediv__(self, value: NoReturn, /) -> NoReturn: ...
    def __neg__(self) -> Vec2: ...
    def __pos__(self) -> Vec2: ...
    def __abs__(self) -> float: ...
    def __eq__(self, value: object, /) -> bool: ...
    def __ne__(self, value: object, /) -> bool: ...
    def __hash__(self) -> int: ...
    def __len__(self) -> int: ...
    def __getitem__(self, key: SupportsIndex, /) -> float: ...
    def __iter__(self) -> Iterator[float]: ...
    def __array__(
        self, dtype: DTypeLike | None = None, copy: bool | None = None
    ) -> NDArray[np.float64]: ...
    def __reduce__(self) -> tuple[type[Vec2], tuple[float, float]]: ...

@disjoint_base
class Shape:
    """Any shape: immutable, in the frame of the body it belongs to (lengths in m, angles in rad).

    Shapes are values: equal if they have the same kind, numbers, density and surface. All take the
    keywords `density`, `friction`, `restitution`, `rolling_resistance`, `tangent_speed`,
    `material`, `category`, `mask`, `group`, `sensor` and `one_way`; what is not given is the
    body's.
    """

    @property
    def density(self) -> float | None:
        """Mass per area (kg/m²), per length of a wire (kg/m); None: the body's."""
    @property
    def friction(self) -> tuple[float, float] | None:
        """Static and kinetic friction; None: the body's."""
    @property
    def restitution(self) -> float | None:
        """Speed after over speed before a collision, 0 to 1; None: the body's."""
    @property
    def rolling_resistance(self) -> float | None:
        """Arm by which the normal force opposes rolling (m); None: the body's."""
    @property
    def tangent_speed(self) -> float | None:
        """Speed of the surface along its border, counter-clockwise (m/s); None: the body's."""
    @property
    def material(self) -> str | None:
        """Name of the material; None: the body's."""
    @property
    def category(self) -> int | None:
        """Bits of the categories it belongs to; None: the body's."""
    @property
    def mask(self) -> int | None:
        """Bits of the categories it touches; None: the body's."""
    @property
    def group(self) -> int | None:
        """Group, 0 for none; None: the body's."""
    @property
    def sensor(self) -> bool | None:
        """Whether it only notices what overlaps it; None: as the body."""
    @property
    def one_way(self) -> Vec2 | None:
        """The side from which it stops what comes; None: all sides, or as the body."""
    @property
    def area(self) -> float:
        """Area (m²), 0 for wires."""
    @property
    def perimeter(self) -> float:
        """Length of the boundary, holes included; the length of a wire (m)."""
    @property
    def measure(self) -> float:
        """What density multiplies: the area (m²), or the length of a wire (m)."""
    @property
    def centroid(self) -> Vec2:
        """Centroid (m)."""
    @property
    def second_moment(self) -> float:
        """∫ r² about the centroid for unit density (m⁴; m³ for wires)."""
    @property
    def bounds(self) -> tuple[Vec2, Vec2]:
        """Lower left and upper right corner of the smallest box along the axes (m)."""
    @property
    def convex_pieces(self) -> list[_Array]:
        """Convex polygons that cover the shape without overlap, each (n, 2), counter-clockwise (m).

        Of a rounded polygon its core; none for circles, capsules and wires.
        """
    def contains(self, point: _Vec2Arg) -> bool:
        """Whether a point (m) belongs to the shape, border included. Wires hold no point."""
    def projection(self, direction: _Vec2Arg) -> tuple[float, float]:
        """Least and greatest coordinate along a direction (m); its length does not count."""
    def projected_width(self, direction: _Vec2Arg) -> float:
        """Extent along a direction (m)."""
    def mass_properties(self, density: float) -> MassProperties:
        """Mass, centre and inertia for a density in kg/m², or in kg/m for wires."""
    def distance_to(
        self, other: Shape, *, position: _Vec2Arg = ..., angle: float = 0.0
    ) -> Distance:
        """How far a shape is that is placed in the frame of this one, and where they are nearest.

        Below 0 where they overlap, as `Body.distance_to` has it.

        Args:
            other: The other shape.
            position: Where its frame stands in that of this shape (m).
            angle: By which it is turned (rad).
        """
    def outline(self, max_angle: float = 0.1) -> list[_Array]:
        """Polylines to draw, each (n, 2) (m): outline and holes, closed, or the wire.

        Arcs are drawn through points at most `max_angle` (rad) apart.
        """
    def __eq__(self, value: object, /) -> bool: ...
    def __ne__(self, value: object, /) -> bool: ...
    def __hash__(self) -> int: ...
    def __copy__(self) -> Shape: ...
    def __deepcopy__(self, _memo: object) -> Shape: ...
    def __getnewargs_ex__(self) -> tuple[tuple[Any, ...], dict[str, Any]]: ...

@final
class Circle(Shape):
    """A disk."""

    def __new__(
        cls,
        radius: float,
        *,
        center: _Vec2Arg = ...,
        **own: Unpack[_Own],
    ) -> Circle: ...
    @property
    def radius(self) -> float:
        """Radius (m)."""
    @property
    def center(self) -> Vec2:
        """Centre (m)."""

@final
class Box(Shape):
    """A rectangle."""

    def __new__(
        cls,
        width: float,
        height: float,
        *,
        center: _Vec2Arg = ...,
        angle: float = 0.0,
        **own: Unpack[_Own],
    ) -> Box: ...
    @property
    def width(self) -> float:
        """Width along x before turning (m)."""
    @property
    def height(self) -> float:
        """Height along y before turning (m)."""
    @property
    def center(self) -> Vec2:
        """Centre (m)."""
    @property
    def angle(self) -> float:
        """By which it is turned (rad)."""
    @property
    def vertices(self) -> _Array:
        """Corners (4, 2), counter-clockwise (m)."""

@final
class RegularPolygon(Shape):
    """A polygon of equal sides and angles; its first vertex lies in the direction `angle`."""

    def __new__(
        cls,
        sides: int,
        radius: float,
        *,
        center: _Vec2Arg = ...,
        angle: float = 0.0,
        **own: Unpack[_Own],
    ) -> RegularPolygon: ...
    @property
    def sides(self) -> int:
        """Number of sides."""
    @property
    def radius(self) -> float:
        """Distance of the vertices from the centre (m)."""
    @property
    def center(self) -> Vec2:
        """Centre (m)."""
    @property
    def angle(self) -> float:
        """Direction of the first vertex (rad)."""
    @property
    def vertices(self) -> _Array:
        """Vertices (n, 2), counter-clockwise (m)."""

@final
class Polygon(Shape):
    """A simple polygon, convex or not, with or without holes.

    Vertices (n, 2) may be given in either direction; crossing edges are a `ValueError`.
    """

    def __new__(
        cls,
        vertices: ArrayLike,
        *,
        holes: Iterable[ArrayLike] | None = None,
        **own: Unpack[_Own],
    ) -> Polygon: ...
    @property
    def vertices(self) -> _Array:
        """Vertices (n, 2), cleaned, counter-clockwise (m)."""
    @property
    def holes(self) -> list[_Array]:
        """Holes, each (n, 2), clockwise (m)."""

@final
class RoundedPolygon(Shape):
    """A convex polygon grown by a disk of this radius (above 0)."""

    def __new__(
        cls,
        vertices: ArrayLike,
        radius: float,
        **own: Unpack[_Own],
    ) -> RoundedPolygon: ...
    @property
    def vertices(self) -> _Array:
        """Vertices of the core (n, 2), cleaned, counter-clockwise (m)."""
    @property
    def radius(self) -> float:
        """Radius of the disk (m)."""

@final
class Capsule(Shape):
    """All points within `radius` of the segment from `a` to `b`."""

    def __new__(
        cls,
        a: _Vec2Arg,
        b: _Vec2Arg,
        radius: float,
        **own: Unpack[_Own],
    ) -> Capsule: ...
    @property
    def a(self) -> Vec2:
        """One end of the segment (m)."""
    @property
    def b(self) -> Vec2:
        """The other end (m)."""
    @property
    def radius(self) -> float:
        """Radius (m)."""

@final
class Segment(Shape):
    """A thin straight wire; its density is per length (kg/m)."""

    def __new__(
        cls,
        a: _Vec2Arg,
        b: _Vec2Arg,
        **own: Unpack[_Own],
    ) -> Segment: ...
    @property
    def a(self) -> Vec2:
        """One end (m)."""
    @property
    def b(self) -> Vec2:
        """The other end (m)."""

@final
class Arc(Shape):
    """A thin circular wire from the direction `start` over the signed angle `sweep` (rad).

    Its density is per length (kg/m).
    """

    def __new__(
        cls,
        center: _Vec2Arg,
        radius: float,
        start: float,
        sweep: float,
        **own: Unpack[_Own],
    ) -> Arc: ...
    @property
    def center(self) -> Vec2:
        """Centre of its circle (m)."""
    @property
    def radius(self) -> float:
        """Radius (m)."""
    @property
    def start(self) -> float:
        """Direction of its first point from the centre (rad)."""
    @property
    def sweep(self) -> float:
        """Angle from its first point to its last (rad), counter-clockwise above 0."""

@final
class Chain(Shape):
    """Thin straight wires through points (n, 2), one after another.

    Their density is per length (kg/m). What slides along them does not catch on the points between.
    With `closed`, a last one leads from the last point to the first. With `one_sided`, only the
    left side (from each point towards the next) is solid: ground drawn from left to right carries
    what is above it and lets through what comes from below.
    """

    def __new__(
        cls,
        points: ArrayLike,
        *,
        closed: bool = False,
        one_sided: bool = False,
        **own: Unpack[_Own],
    ) -> Chain: ...
    @property
    def points(self) -> _Array:
        """The points (n, 2) (m)."""
    @property
    def closed(self) -> bool:
        """Whether the last point is joined to the first."""
    @property
    def one_sided(self) -> bool:
        """Whether only the left side is solid."""

@final
class MassProperties:
    """Mass, centre of mass and moment of inertia."""

    __match_args__: ClassVar[tuple[str, str, str]]

    def __new__(cls, mass: float, center: _Vec2Arg, inertia: float) -> MassProperties: ...
    @property
    def mass(self) -> float:
        """Mass (kg)."""
    @property
    def center(self) -> Vec2:
        """Centre of mass (m)."""
    @property
    def inertia(self) -> float:
        """Moment of inertia about the centre of mass (kg·m²)."""
    def __eq__(self, value: object, /) -> bool: ...
    def __ne__(self, value: object, /) -> bool: ...
    def __reduce__(self) -> tuple[type[MassProperties], tuple[Any, ...]]: ...

@final
class PairOfMaterials:
    """What is known of two materials together: a row of a world's table. Order does not matter."""

    __match_args__: ClassVar[tuple[str, str, str, str]]

    def __new__(
        cls,
        a: str,
        b: str,
        friction: tuple[float, float] | None,
        restitution: float | None,
    ) -> PairOfMaterials: ...
    @property
    def a(self) -> str:
        """Name of the one."""
    @property
    def b(self) -> str:
        """Name of the other."""
    @property
    def friction(self) -> tuple[float, float] | None:
        """Static and kinetic friction; None: by the world's rule."""
    @property
    def restitution(self) -> float | None:
        """Restitution; None: by the world's rule."""
    def __eq__(self, value: object, /) -> bool: ...
    def __ne__(self, value: object, /) -> bool: ...
    def __reduce__(self) -> tuple[type[PairOfMaterials], tuple[Any, ...]]: ...

@final
class Energy:
    """Where a world's energy is (J). `balance` stays what it was, whatever happens."""

    __match_args__: ClassVar[tuple[str, str, str, str, str, str, str]]

    def __new__(
        cls,
        kinetic: float,
        potential: float,
        work: float,
        dissipated: float,
        correction_work: float,
        total: float,
        balance: float,
    ) -> Energy: ...
    @property
    def kinetic(self) -> float:
        """Σ ½mv² + ½Iω²."""
    @property
    def potential(self) -> float:
        """In gravity, against the origin, and in fields that have a potential."""
    @property
    def work(self) -> float:
        """Done on the bodies by forces without a potential, since the world was made."""
    @property
    def dissipated(self) -> float:
        """Taken by drag, damping, friction and impacts, since the world was made."""
    @property
    def correction_work(self) -> float:
        """Done where overlap was removed by moving bodies apart, since the world was made."""
    @property
    def total(self) -> float:
        """Kinetic and potential energy."""
    @property
    def balance(self) -> float:
        """total − work − correction_work + dissipated."""
    def __eq__(self, value: object, /) -> bool: ...
    def __ne__(self, value: object, /) -> bool: ...
    def __reduce__(self) -> tuple[type[Energy], tuple[Any, ...]]: ...

@final
class Facts:
    """What holds of a method."""

    __match_args__: ClassVar[tuple[str, str, str, str, str, str, str, str, str]]

    def __new__(
        cls,
        name: str,
        order: int,
        symplectic: bool,
        reversible: bool,
        exact_for_constant_force: bool,
        adaptive: bool,
        joints: bool,
        contacts: bool,
        about: str,
    ) -> Facts: ...
    @property
    def name(self) -> str:
        """Name, as `World.method` takes it."""
    @property
    def order(self) -> int:
        """Error after a fixed time falls as h^order."""
    @property
    def symplectic(self) -> bool:
        """The map of a step is symplectic (forces that come from a potential).

        Of semi-implicit Euler where nothing is joined.
        """
    @property
    def reversible(self) -> bool:
        """A run turned round comes back to its start."""
    @property
    def exact_for_constant_force(self) -> bool:
        """Exact for a force that is constant in time and place."""
    @property
    def adaptive(self) -> bool:
        """Chooses its own step to a tolerance."""
    @property
    def joints(self) -> bool:
        """Treats joints."""
    @property
    def contacts(self) -> bool:
        """Treats contacts."""
    @property
    def about(self) -> str:
        """What it does, in one sentence."""
    def __eq__(self, value: object, /) -> bool: ...
    def __ne__(self, value: object, /) -> bool: ...
    def __reduce__(self) -> tuple[type[Facts], tuple[Any, ...]]: ...

@final
class Central:
    """A pull of every body towards a point, −strength·r^exponent (N).

    Times the body's mass if `per_mass`. Gravitation of a sun (exponent −2, per mass), a spring (1),
    a constant pull (0).
    """

    __match_args__: ClassVar[tuple[str, str, str, str]]

    def __new__(
        cls,
        center: _Vec2Arg,
        strength: float,
        exponent: float,
        per_mass: bool = ...,
    ) -> Central: ...
    @property
    def center(self) -> Vec2:
        """The point (m)."""
    @property
    def strength(self) -> float:
        """N/m^exponent, or that per kg."""
    @property
    def exponent(self) -> float:
        """Power of the distance."""
    @property
    def per_mass(self) -> bool:
        """Whether the force is proportional to the mass it acts on."""
    def __eq__(self, value: object, /) -> bool: ...
    def __ne__(self, value: object, /) -> bool: ...
    def __reduce__(self) -> tuple[type[Central], tuple[Any, ...]]: ...

@final
class Attraction:
    """A pull of all bodies on one another, gravitation for exponent −2.

    −strength·m₁m₂·r/(r² + softening²)^((1 − exponent)/2) (N).
    """

    __match_args__: ClassVar[tuple[str, str, str]]

    def __new__(
        cls,
        strength: float,
        exponent: float = ...,
        softening: float = ...,
    ) -> Attraction: ...
    @property
    def strength(self) -> float:
        """N/(kg²·m^exponent)."""
    @property
    def exponent(self) -> float:
        """Power of the distance; −2 if not given."""
    @property
    def softening(self) -> float:
        """Length (m) below which the pull no longer grows."""
    def __eq__(self, value: object, /) -> bool: ...
    def __ne__(self, value: object, /) -> bool: ...
    def __reduce__(self) -> tuple[type[Attraction], tuple[Any, ...]]: ...

@final
class Oscillating:
    """A force and a torque on one body that vary as sin(2π·hertz·t + phase)."""

    def __new__(
        cls,
        body: Body,
        force: _Vec2Arg = ...,
        torque: float = 0.0,
        hertz: float = 1.0,
        phase: float = 0.0,
    ) -> Oscillating: ...
    @property
    def body(self) -> Body:
        """The body. The field acts on nothing once it is removed."""
    @property
    def force(self) -> Vec2:
        """Amplitude of the force through the centre of mass (N)."""
    @property
    def torque(self) -> float:
        """Amplitude of the torque (N·m)."""
    @property
    def hertz(self) -> float:
        """Frequency (Hz)."""
    @property
    def phase(self) -> float:
        """Phase at t = 0 (rad)."""
    def __eq__(self, value: object, /) -> bool: ...
    def __ne__(self, value: object, /) -> bool: ...
    def __reduce__(self) -> tuple[type[Oscillating], tuple[Any, ...]]: ...

@final
class State:
    """All bodies at one moment, in body order, as a field sees them. The arrays are copies."""

    @property
    def time(self) -> float:
        """World time (s)."""
    @property
    def positions(self) -> _Array:
        """Centres of mass (n, 2) (m)."""
    @property
    def angles(self) -> _Array:
        """Angles (n,) (rad)."""
    @property
    def velocities(self) -> _Array:
        """Velocities of the centres of mass (n, 2) (m/s)."""
    @property
    def angular_velocities(self) -> _Array:
        """Angular velocities (n,) (rad/s)."""
    @property
    def masses(self) -> _Array:
        """Masses (n,) (kg)."""
    @property
    def inertias(self) -> _Array:
        """Moments of inertia about the centres of mass (n,) (kg·m²)."""
    def __len__(self) -> int: ...

@final
class Body:
    """A body of a world. Worlds make bodies: `World.add_body`.

    There is one object per body, so bodies are compared by identity and keep attributes of the
    user's own. A body that was removed raises `StaleHandleError`.
    """

    @property
    def contacts(self) -> Contacts:
        """Where the body touched others after the last step."""
    @property
    def overlaps(self) -> list[Body]:
        """Bodies in its sensors, and whose sensors it is in, after the last step."""
    @property
    def position(self) -> Vec2:
        """Position of the body's frame (m)."""
    @position.setter
    def position(self, value: _Vec2Arg, /) -> None: ...
    @property
    def angle(self) -> float:
        """Angle of the body's frame (rad), not wrapped."""
    @angle.setter
    def angle(self, value: float, /) -> None: ...
    @property
    def size(self) -> float:
        """Largest distance of the outline from the centre of mass (m)."""
    @property
    def velocity(self) -> Vec2:
        """Velocity of the centre of mass (m/s)."""
    @velocity.setter
    def velocity(self, value: _Vec2Arg, /) -> None: ...
    @property
    def angular_velocity(self) -> float:
        """Angular velocity (rad/s)."""
    @angular_velocity.setter
    def angular_velocity(self, value: float, /) -> None: ...
    @property
    def center_of_mass(self) -> Vec2:
        """Centre of mass in the world (m)."""
    @property
    def force(self) -> Vec2:
        """Constant force through the centre of mass (N), until changed."""
    @force.setter
    def force(self, value: _Vec2Arg, /) -> None: ...
    @property
    def torque(self) -> float:
        """Constant torque (N·m), until changed."""
    @torque.setter
    def torque(self, value: float, /) -> None: ...
    @property
    def asleep(self) -> bool:
        """Whether the body sleeps: it rests and is left out until something wakes it."""
    @property
    def kinetic_energy(self) -> float:
        """½mv² + ½Iω² (J); 0 of a body that does not answer to forces."""
    @property
    def momentum(self) -> Vec2:
        """mv (kg·m/s)."""
    @property
    def kind(self) -> _Kind:
        """ "dynamic", "static" or "kinematic". Making a body static stops it."""
    @kind.setter
    def kind(self, value: _Kind, /) -> None: ...
    @property
    def name(self) -> str | None:
        """Name, or None."""
    @name.setter
    def name(self, value: str | None, /) -> None: ...
    @property
    def shapes(self) -> tuple[Shape, ...]:
        """The shapes, in the body's frame; empty for a point. May be set to one or None."""
    @shapes.setter
    def shapes(self, value: Shape | Iterable[Shape] | None, /) -> None: ...
    @property
    def mass(self) -> float:
        """Mass (kg). Setting None lets it follow from the densities again."""
    @mass.setter
    def mass(self, value: float | None, /) -> None: ...
    @property
    def inertia(self) -> float:
        """Moment of inertia about the centre of mass (kg·m²). None: as follows from the shapes."""
    @inertia.setter
    def inertia(self, value: float | None, /) -> None: ...
    @property
    def density(self) -> float:
        """Density of shapes that have none of their own (kg/m²; kg/m of wires)."""
    @density.setter
    def density(self, value: float, /) -> None: ...
    @property
    def local_center(self) -> Vec2:
        """Centre of mass in the body's frame (m). None: the shapes'. The frame stays."""
    @local_center.setter
    def local_center(self, value: _Vec2Arg | None, /) -> None: ...
    @property
    def lock_x(self) -> bool:
        """Whether the body cannot move along x. Locking stops it there."""
    @lock_x.setter
    def lock_x(self, value: bool, /) -> None: ...
    @property
    def lock_y(self) -> bool:
        """Whether the body cannot move along y. Locking stops it there."""
    @lock_y.setter
    def lock_y(self, value: bool, /) -> None: ...
    @property
    def lock_rotation(self) -> bool:
        """Whether the body cannot rotate. Locking stops its rotation."""
    @lock_rotation.setter
    def lock_rotation(self, value: bool, /) -> None: ...
    @property
    def gravity_scale(self) -> float:
        """How many times gravity acts."""
    @gravity_scale.setter
    def gravity_scale(self, value: float, /) -> None: ...
    @property
    def linear_damping(self) -> float:
        """Rate at which the velocity against the air decays (1/s)."""
    @linear_damping.setter
    def linear_damping(self, value: float, /) -> None: ...
    @property
    def angular_damping(self) -> float:
        """Rate at which the angular velocity decays (1/s)."""
    @angular_damping.setter
    def angular_damping(self, value: float, /) -> None: ...
    @property
    def drag_coefficient(self) -> float:
        """C in the air drag ½ρCAv²."""
    @drag_coefficient.setter
    def drag_coefficient(self, value: float, /) -> None: ...
    @property
    def drag_width(self) -> _Width:
        """A in the air drag ½ρCAv²: "silhouette", "bounding_box", or a width (m)."""
    @drag_width.setter
    def drag_width(self, value: _Width, /) -> None: ...
    @property
    def friction(self) -> tuple[float, float]:
        """Static and kinetic friction of shapes that have none of their own.

        May be set to one number for both.
        """
    @friction.setter
    def friction(self, value: _Friction, /) -> None: ...
    @property
    def restitution(self) -> float:
        """Speed after over speed before a collision, 0 to 1, of shapes without their own."""
    @restitution.setter
    def restitution(self, value: float, /) -> None: ...
    @property
    def rolling_resistance(self) -> float:
        """Arm (m) by which the normal force opposes rolling, of shapes without their own."""
    @rolling_resistance.setter
    def rolling_resistance(self, value: float, /) -> None: ...
    @property
    def tangent_speed(self) -> float:
        """Speed (m/s) of the surface along its border, counter-clockwise: a conveyor's belt."""
    @tangent_speed.setter
    def tangent_speed(self, value: float, /) -> None: ...
    @property
    def material(self) -> str | None:
        """Name of the material of shapes without their own. `World.set_pair` speaks of it."""
    @material.setter
    def material(self, value: str | None, /) -> None: ...
    @property
    def category(self) -> int:
        """Bits of the categories to which shapes belong that have none of their own."""
    @category.setter
    def category(self, value: int, /) -> None: ...
    @property
    def mask(self) -> int:
        """Bits of the categories that shapes touch that have no mask of their own."""
    @mask.setter
    def mask(self, value: int, /) -> None: ...
    @property
    def group(self) -> int:
        """Group of shapes that have none of their own, 0 for none.

        Two shapes of one group always touch if it is above 0, and never if it is below.
        """
    @group.setter
    def group(self, value: int, /) -> None: ...
    @property
    def sensor(self) -> bool:
        """Whether shapes that have no role of their own only notice what overlaps them."""
    @sensor.setter
    def sensor(self, value: bool, /) -> None: ...
    @property
    def one_way(self) -> Vec2 | None:
        """The side, in the body's frame, from which shapes stop what comes; None: all sides.

        Of shapes that have no role of their own. What is set to stop is no sensor any more.
        """
    @one_way.setter
    def one_way(self, value: _Vec2Arg | None, /) -> None: ...
    @property
    def world(self) -> World:
        """The world it is, or was, in."""
    @property
    def index(self) -> int:
        """Its place in body order, which arrays and lists follow."""
    @property
    def removed(self) -> bool:
        """Whether it was removed from its world."""
    def velocity_at(self, point: _Vec2Arg) -> Vec2:
        """Velocity (m/s) of the point of the body that is at a world point."""
    def world_point(self, local: _Vec2Arg) -> Vec2:
        """World coordinates of a point in the body's frame."""
    def local_point(self, world: _Vec2Arg) -> Vec2:
        """Coordinates in the body's frame of a world point."""
    def apply_force(self, force: _Vec2Arg, at: _Vec2Arg | None = None) -> None:
        """Adds a force (N) for the next step, through the centre of mass or at a world point."""
    def apply_torque(self, torque: float) -> None:
        """Adds a torque (N·m) for the next step."""
    def apply_impulse(self, impulse: _Vec2Arg, at: _Vec2Arg | None = None) -> None:
        """Changes the velocities at once by an impulse (N·s), at the centre or at a world point."""
    def apply_angular_impulse(self, impulse: float) -> None:
        """Changes the angular velocity at once by an angular impulse (N·m·s)."""
    def wake(self) -> None:
        """Wakes the body and the island that sleeps with it."""
    def sleep(self) -> None:
        """Lets the body sleep with all that it touched after the last step and that can move.

        They stop, and what that takes counts as dissipated. Nothing happens where sleeping is
        off or a field acts.
        """
    def distance_to(self, other: Body) -> Distance:
        """How far another body is, and where the two are nearest.

        Below 0 where they overlap: minus the most that a convex piece of one has to move to be
        clear of a piece of the other. A body without shapes is a point.
        """
    def remove(self) -> None:
        """Removes the body, and the joints and schedules on it, from its world."""
    def __reduce__(self) -> tuple[Callable[[World], Any], tuple[World], dict[str, Any]]: ...

@final
class RayHit:
    """Where a ray or a moving shape hits a shape."""

    __match_args__: Final = ("body", "part", "point", "normal", "fraction")
    def __new__(
        cls, body: Body, part: int, point: _Vec2Arg, normal: _Vec2Arg, fraction: float
    ) -> RayHit: ...
    @property
    def body(self) -> Body:
        """The body that is hit."""
    @property
    def part(self) -> int:
        """Which of its shapes, counted from 0."""
    @property
    def point(self) -> Vec2:
        """Point of that shape (m)."""
    @property
    def normal(self) -> Vec2:
        """Its outward unit normal there; of wires, on the side that is hit."""
    @property
    def fraction(self) -> float:
        """Part of the way up to the hit, 0 to 1."""
    def __eq__(self, value: object, /) -> bool: ...
    def __ne__(self, value: object, /) -> bool: ...
    def __reduce__(self) -> tuple[type[RayHit], tuple[Any, ...]]: ...

@final
class Nearest:
    """The shape that is nearest to a point."""

    __match_args__: Final = ("body", "part", "point", "distance")
    def __new__(cls, body: Body, part: int, point: _Vec2Arg, distance: float) -> Nearest: ...
    @property
    def body(self) -> Body:
        """The body."""
    @property
    def part(self) -> int:
        """Which of its shapes, counted from 0."""
    @property
    def point(self) -> Vec2:
        """Its nearest point (m): the one that was asked for, if the shape holds it."""
    @property
    def distance(self) -> float:
        """How far that is (m), 0 if the shape holds the point."""
    def __eq__(self, value: object, /) -> bool: ...
    def __ne__(self, value: object, /) -> bool: ...
    def __reduce__(self) -> tuple[type[Nearest], tuple[Any, ...]]: ...

@final
class Distance:
    """How far two things are apart."""

    __match_args__: Final = ("distance", "on_self", "on_other", "normal")
    def __new__(
        cls, distance: float, on_self: _Vec2Arg, on_other: _Vec2Arg, normal: _Vec2Arg
    ) -> Distance: ...
    @property
    def distance(self) -> float:
        """Distance (m), below 0 where they overlap."""
    @property
    def on_self(self) -> Vec2:
        """Nearest point of the one that was asked (m)."""
    @property
    def on_other(self) -> Vec2:
        """Nearest point of the other (m)."""
    @property
    def normal(self) -> Vec2:
        """Unit vector from the one to the other."""
    def __eq__(self, value: object, /) -> bool: ...
    def __ne__(self, value: object, /) -> bool: ...
    def __reduce__(self) -> tuple[type[Distance], tuple[Any, ...]]: ...

@final
class RayHits:
    """What many rays hit, as arrays with a row for each ray."""

    def __new__(
        cls, bodies: NDArray[np.int64], fractions: _Array, points: _Array, normals: _Array
    ) -> RayHits: ...
    @property
    def bodies(self) -> NDArray[np.int64]:
        """Places in body order (n,) of the bodies that are hit, −1 where nothing is."""
    @property
    def fractions(self) -> _Array:
        """Parts of the ways up to the hits (n,), 1 where nothing is hit."""
    @property
    def points(self) -> _Array:
        """Points that are hit (n, 2) (m), or the ends of the rays."""
    @property
    def normals(self) -> _Array:
        """Outward unit normals (n, 2), or zeros."""
    def __len__(self) -> int: ...
    def __reduce__(self) -> tuple[type[RayHits], tuple[Any, ...]]: ...

@final
class Field:
    """A field of a world. Worlds make them: `World.add_field`."""

    @property
    def name(self) -> str:
        """Name, for messages and `explain()`."""
    @property
    def function(self) -> _Law | Central | Attraction | Oscillating | None:
        """The user's function, or which of the engine's fields it is."""
    @property
    def potential(self) -> _Potential | None:
        """The user's potential, if there is one."""
    @property
    def conservative(self) -> bool:
        """Whether it has a potential; the work of other fields is booked as such."""
    @property
    def velocity_dependent(self) -> bool:
        """Whether the forces depend on velocities."""
    @property
    def internal(self) -> bool:
        """Whether the forces act between the bodies and sum to zero, torques too."""
    @property
    def world(self) -> World:
        """The world it is, or was, in."""
    @property
    def removed(self) -> bool:
        """Whether it was removed from its world."""
    def remove(self) -> None:
        """Removes the field from its world."""
    def __reduce__(self) -> tuple[Callable[[World], Any], tuple[World], dict[str, Any]]: ...

@final
class Schedule:
    """Forces on a body that are constant between given times. Made by `World.add_schedule`."""

    @property
    def body(self) -> Body | None:
        """The body it acts on."""
    @property
    def times(self) -> _Array:
        """Times (n + 1,) at which the force changes (s, world time)."""
    @property
    def forces(self) -> _Array:
        """Forces (n, 2) between those times (N)."""
    @property
    def torques(self) -> _Array:
        """Torques (n,) between those times (N·m)."""
    @property
    def world(self) -> World:
        """The world it is, or was, in."""
    @property
    def removed(self) -> bool:
        """Whether it was removed from its world."""
    def remove(self) -> None:
        """Removes the schedule from its world."""
    def __reduce__(self) -> tuple[Callable[[World], Any], tuple[World], dict[str, Any]]: ...

@final
class Fluid:
    """A fluid of particles. Made by `World.add_fluid`.

    Arrays hold its particles in the order in which they were added.
    """

    @property
    def density(self) -> float:
        """Density at rest (kg/m²)."""
    @density.setter
    def density(self, density: float) -> None: ...
    @property
    def viscosity(self) -> float:
        """Viscosity (Pa·s)."""
    @viscosity.setter
    def viscosity(self, viscosity: float) -> None: ...
    @property
    def tension(self) -> float:
        """Surface tension (N/m). Where two fluids meet, both pull."""
    @tension.setter
    def tension(self, tension: float) -> None: ...
    @property
    def adhesion(self) -> float:
        """Work of adhesion (N/m) to solids: σ(1 + cos θ) for a contact angle θ."""
    @adhesion.setter
    def adhesion(self, adhesion: float) -> None: ...
    @property
    def name(self) -> str | None:
        """Name; None if it has none."""
    @name.setter
    def name(self, name: str | None) -> None: ...
    @property
    def lifetime(self) -> float | None:
        """How long (s) its particles are there, from when they were added; None: for ever."""
    @lifetime.setter
    def lifetime(self, lifetime: float | None) -> None: ...
    @property
    def inflows(self) -> list[Inflow]:
        """Where it flows in. One at a segment where there was one goes on from its last row."""
    @inflows.setter
    def inflows(self, inflows: Sequence[Inflow]) -> None: ...
    @property
    def spacing(self) -> float:
        """Distance of its particles from one another at rest (m)."""
    @property
    def particle_mass(self) -> float:
        """Mass of each of its particles (kg)."""
    @property
    def positions(self) -> _Array:
        """Positions (n, 2) of its particles (m)."""
    @property
    def velocities(self) -> _Array:
        """Velocities (n, 2) of its particles (m/s). May be set; all or nothing."""
    @velocities.setter
    def velocities(self, values: ArrayLike) -> None: ...
    @property
    def densities(self) -> _Array:
        """Densities (n,) in the last substep (kg/m²); less at a free surface."""
    @property
    def pressures(self) -> _Array:
        """Pressures (n,) in the last substep (Pa)."""
    def add(self, points: ArrayLike | Shape, *, velocity: _Vec2Arg = ...) -> None:
        """Adds particles at points (n, 2) (m), or on a lattice in a shape."""
    def remove_particles(self, numbers: Sequence[int]) -> None:
        """Removes particles by their numbers, those of the arrays."""
    @property
    def world(self) -> World:
        """The world it is, or was, in."""
    @property
    def removed(self) -> bool:
        """Whether it was removed from its world."""
    def remove(self) -> None:
        """Removes the fluid from its world."""
    def __len__(self) -> int: ...
    def __bool__(self) -> bool: ...
    def __reduce__(self) -> tuple[Callable[[World], Any], tuple[World], dict[str, Any]]: ...

@final
class Inflow:
    """A nozzle: through a segment flows fluid with one velocity, whatever presses against it.

    Rows of particles are born two spacings behind the segment and keep that velocity until they
    have passed it.
    """

    __match_args__: ClassVar[tuple[str, str, str, str]]

    def __new__(
        cls,
        start: _Vec2Arg,
        end: _Vec2Arg,
        velocity: _Vec2Arg,
        progress: float | None = ...,
    ) -> Inflow: ...
    @property
    def start(self) -> Vec2:
        """One end of the segment (m)."""
    @property
    def end(self) -> Vec2:
        """The other (m)."""
    @property
    def velocity(self) -> Vec2:
        """Velocity (m/s) of what comes out; not along the segment."""
    @property
    def progress(self) -> float | None:
        """Way (m) of the last row since it was born; None: there was no row yet."""
    def __eq__(self, value: object, /) -> bool: ...
    def __ne__(self, value: object, /) -> bool: ...
    def __reduce__(self) -> tuple[type[Inflow], tuple[Any, ...]]: ...

@final
class SoftContact:
    """A deformable body and what it touches, began or ended to touch, or hit."""

    @property
    def time(self) -> float:
        """World time at the end of the step (s)."""
    @property
    def body(self) -> SoftBody:
        """The deformable body."""
    @property
    def other(self) -> Body | SoftBody:
        """What it touches: a body or a deformable one."""
    @property
    def part(self) -> int | None:
        """Which shape of a body, counted from 0; None of a deformable one."""
    @property
    def point(self) -> Vec2:
        """Where most of the load is, or where they are nearest (m)."""
    @property
    def normal(self) -> Vec2:
        """Unit vector from the deformable body to the other there."""
    @property
    def approach_speed(self) -> float:
        """How fast they came together (m/s). Of hits; 0 else."""
    @property
    def impulse(self) -> float:
        """Along the normals over the step (N·s)."""

@final
class SoftEvents:
    """What happened to deformable bodies during the last call that moved the world on."""

    @property
    def begin(self) -> list[SoftContact]:
        """Pairs that began to touch."""
    @property
    def end(self) -> list[SoftContact]:
        """Pairs that no longer touch."""
    @property
    def hit(self) -> list[SoftContact]:
        """Pairs that began to touch faster than the forces of a substep make them."""

@final
class SoftRayHit:
    """Where a ray hits a deformable body."""

    @property
    def body(self) -> SoftBody:
        """The body that is hit."""
    @property
    def point(self) -> Vec2:
        """Point of its border (m); the start of the ray where that is inside."""
    @property
    def normal(self) -> Vec2:
        """Its outward unit normal there."""
    @property
    def fraction(self) -> float:
        """Part of the way up to the hit, 0 to 1."""

@final
class NearestSoft:
    """The deformable body that is nearest to a point."""

    @property
    def body(self) -> SoftBody:
        """The body."""
    @property
    def point(self) -> Vec2:
        """Its nearest point (m): the one that was asked for, if the body holds it."""
    @property
    def distance(self) -> float:
        """How far that is (m), 0 if the body holds the point."""

@final
class SoftBody:
    """A deformable body. Made by `World.add_soft_body`.

    Arrays are by nodes, or by elements: its triangles, or the rods of a rope.
    """

    @property
    def positions(self) -> _Array:
        """Positions (n, 2) of its nodes (m). May be set; all or nothing."""
    @positions.setter
    def positions(self, values: ArrayLike) -> None: ...
    @property
    def velocities(self) -> _Array:
        """Velocities (n, 2) of its nodes (m/s). May be set; those of pinned nodes stay 0."""
    @velocities.setter
    def velocities(self, values: ArrayLike) -> None: ...
    @property
    def forces(self) -> _Array:
        """Constant forces (n, 2) on its nodes (N). May be set; all or nothing."""
    @forces.setter
    def forces(self, values: ArrayLike) -> None: ...
    @property
    def pinned(self) -> NDArray[np.bool_]:
        """Which of its nodes (n,) stay where they are. May be set; all or nothing."""
    @pinned.setter
    def pinned(self, values: NDArray[np.bool_] | Sequence[bool]) -> None: ...
    def inflate(self, pressure: float, *, outside: float = 0.0, exponent: float = 1.0) -> None:
        """Fills a closed rope with a gas.

        Args:
            pressure: In the area at rest (Pa).
            outside: Pressure outside (Pa).
            exponent: γ of pAᵞ = constant: 1, at a constant temperature, or above.
        """
    def puncture(self) -> None:
        """Pricks it: the gas in it is gone."""
    @property
    def name(self) -> str | None:
        """Name; None if it has none."""
    @property
    def rest(self) -> _Array:
        """Places (n, 2) of its nodes at rest (m), in its frame."""
    @property
    def triangles(self) -> _IntArray:
        """Its triangles (m, 6): nodes at corners, counter-clockwise, then on sides 01, 12, 20."""
    @property
    def rods(self) -> _IntArray:
        """Its rods (m, 2): the nodes at their ends."""
    @property
    def border(self) -> _IntArray:
        """Pieces of its border (b, 2), from node to node, the matter on the left; or its rods."""
    @property
    def density(self) -> float:
        """Mass per area (kg/m²); of ropes per length (kg/m)."""
    @property
    def youngs_modulus(self) -> float:
        """Young's modulus (Pa)."""
    @property
    def poissons_ratio(self) -> float:
        """Poisson's ratio."""
    @property
    def plane(self) -> Literal["stress", "strain"]:
        """What is zero across the plane."""
    @property
    def damping_ratio(self) -> float:
        """Part of critical damping at `damping_frequency`."""
    @property
    def damping_frequency(self) -> float:
        """Frequency at which `damping_ratio` holds (Hz)."""
    @property
    def yield_strain(self) -> float | None:
        """Difference of the principal strains beyond which it stays bent; None: never."""
    @property
    def friction(self) -> tuple[float, float]:
        """Static and kinetic friction. May be set, to one number for both."""
    @friction.setter
    def friction(self, friction: _Friction, /) -> None: ...
    @property
    def restitution(self) -> float:
        """Speed after over speed before a collision. May be set."""
    @restitution.setter
    def restitution(self, restitution: float, /) -> None: ...
    @property
    def category(self) -> int:
        """Bits of the categories to which it belongs. May be set."""
    @category.setter
    def category(self, bits: int, /) -> None: ...
    @property
    def mask(self) -> int:
        """Bits of the categories that it touches. May be set."""
    @mask.setter
    def mask(self, bits: int, /) -> None: ...
    @property
    def group(self) -> int:
        """Its group, 0 for none: those of one always touch above 0, never below. May be set."""
    @group.setter
    def group(self, group: int, /) -> None: ...
    @property
    def radius(self) -> float:
        """By how much its border is thicker than its nodes say (m)."""
    @property
    def mass(self) -> float:
        """Mass (kg)."""
    @property
    def node_masses(self) -> _Array:
        """What each of its nodes (n,) weighs where all move alike (kg)."""
    @property
    def center(self) -> Vec2:
        """Centre of mass (m)."""
    @property
    def momentum(self) -> Vec2:
        """Momentum (kg·m/s)."""
    def angular_momentum(self, about: _Vec2Arg) -> float:
        """Angular momentum about a point (kg·m²/s)."""
    @property
    def kinetic_energy(self) -> float:
        """Kinetic energy (J)."""
    @property
    def strain_energy(self) -> float:
        """Energy of what is strained, and of the gas in it (J)."""
    @property
    def area(self) -> float:
        """Area of its triangles (m²), or inside a rope that is filled."""
    @property
    def pressure(self) -> float | None:
        """Pressure of the gas in it above that outside (Pa); None without a gas."""
    @property
    def strains(self) -> _Array:
        """Green's strain (m, 3) of each triangle: xx, yy, xy in the axes of its frame.

        Of ropes each rod's relative stretch, as xx.
        """
    @property
    def stresses(self) -> _Array:
        """Cauchy's stress (m, 3) of each triangle (Pa): xx, yy, xy in the axes of the world.

        Without the viscous part. Of ropes each rod's tension (N), as xx.
        """
    @property
    def world(self) -> World:
        """The world it is, or was, in."""
    @property
    def removed(self) -> bool:
        """Whether it was removed from its world."""
    def remove(self) -> None:
        """Removes the body from its world."""
    def __len__(self) -> int: ...
    def __bool__(self) -> bool: ...
    def __reduce__(self) -> tuple[Callable[[World], Any], tuple[World], dict[str, Any]]: ...

@final
class SpringMotion:
    """How what hangs on a spring moves, whatever else holds its bodies left aside."""

    __match_args__: Final = (
        "row", "hertz", "damping_ratio", "stepped_hertz", "stepped_damping_ratio",
    )  # fmt: skip
    def __new__(
        cls,
        row: int,
        hertz: float,
        damping_ratio: float,
        stepped_hertz: float,
        stepped_damping_ratio: float,
    ) -> SpringMotion: ...
    @property
    def row(self) -> int:
        """Which row of the joint, counted from 0."""
    @property
    def hertz(self) -> float:
        """Frequency of the undamped swing by the law (Hz), with the mass that hangs on it now."""
    @property
    def damping_ratio(self) -> float:
        """Damping ratio by the law."""
    @property
    def stepped_hertz(self) -> float:
        """Frequency as the steps make it (Hz)."""
    @property
    def stepped_damping_ratio(self) -> float:
        """Damping ratio as the steps make it."""
    def __eq__(self, value: object, /) -> bool: ...
    def __ne__(self, value: object, /) -> bool: ...
    def __reduce__(self) -> tuple[type[SpringMotion], tuple[Any, ...]]: ...

@disjoint_base
class _Joint:
    """What the joints of all kinds are to the engine. Use `culbuto.Joint`."""

    def __new__(cls, *_arguments: object, **_keywords: object) -> Self: ...
    def _make(
        self,
        kind: str,
        body_a: Body | SoftBody | None,
        body_b: Body | SoftBody | None,
        **parameters: object,
    ) -> None:
        """Drafts a joint of a kind between two bodies; None is the world."""
    def _rule(self, function: Callable[..., Any], rows: int) -> None:
        """Gives a custom joint its function of the poses of A and B, and its number of rows."""
    @property
    def _function(self) -> Callable[..., Any] | None:
        """The function of a custom joint."""
    def _read(self, name: str) -> object:
        """A parameter, or something to be seen of it."""
    def _write(self, name: str, value: object) -> None:
        """Changes a parameter."""
    @property
    def kind(self) -> str:
        """The kind: "distance", "revolute", …"""
    @property
    def body_a(self) -> Body | SoftBody | None:
        """A; None: the world."""
    @property
    def body_b(self) -> Body | SoftBody | None:
        """B; None: the world."""
    @property
    def world(self) -> World | None:
        """The world it is, or was, in; None until it is added to one."""
    @property
    def removed(self) -> bool:
        """Whether it was removed from its world."""
    def spring_motions(self, dt: float) -> list[SpringMotion]:
        """How what hangs on its springs moves, by the law and as steps of dt (s) make it."""
    def remove(self) -> None:
        """Removes the joint from its world."""
    def __reduce__(self) -> tuple[Any, ...]: ...
    def __setstate__(self, state: dict[str, Any] | tuple[Any, ...]) -> None: ...

@final
class BrokenJoint:
    """A joint that broke: it bore more than it may, and is no longer in the world."""

    @property
    def joint(self) -> Joint:
        """The joint, which was removed."""
    @property
    def time(self) -> float:
        """World time at the end of the step in which it broke (s)."""
    @property
    def reaction_force(self) -> Vec2:
        """Mean force on B in that step (N)."""
    @property
    def reaction_torque(self) -> float:
        """Mean torque on B about its anchor in that step (N·m)."""

@final
class Joints:
    """The joints of a world, now and later: a view.

    In the order in which they were added, but that the last one takes the place of one that is
    removed. Arrays follow that order.
    """

    def __len__(self) -> int: ...
    def __getitem__(self, key: int | str, /) -> Joint: ...
    def __iter__(self) -> Iterator[Joint]: ...
    def __contains__(self, item: object, /) -> bool: ...
    def find(self, name: str) -> Joint | None:
        """The first joint of this name; None if there is none."""
    @property
    def bodies(self) -> _IntArray:
        """Places of A and B in body order (n, 2); −1 for the world."""
    @property
    def points(self) -> _Array:
        """Anchors of A and of B in the world (n, 2, 2) (m)."""
    @property
    def reaction_forces(self) -> _Array:
        """Mean forces on B in the last step (n, 2) (N)."""
    @property
    def reaction_torques(self) -> _Array:
        """Mean torques on B about its anchor in the last step (n,) (N·m)."""
    @property
    def gaps(self) -> _Array:
        """How far each is from what it holds (n,) (m; rad where it holds an angle)."""
    @property
    def energies(self) -> _Array:
        """Energies in the springs (n,) (J)."""

_AnyJoint = TypeVar("_AnyJoint", bound=_Joint)
_IntArray: TypeAlias = NDArray[np.int64]
_EventKind: TypeAlias = Literal["begin", "end", "hit", "sensor_begin", "sensor_end"]
_Listener = TypeVar("_Listener", bound=Callable[[ContactEvent], object])
_Filter: TypeAlias = Callable[[Body, int, Body, int], bool]
_Hook: TypeAlias = Callable[[PreSolve], bool | None]

@final
class Contact:
    """Where two bodies touch: one or two points with one normal."""

    @property
    def body_a(self) -> Body:
        """The body of the two that was added first."""
    @property
    def body_b(self) -> Body:
        """The other body."""
    @property
    def part_a(self) -> int:
        """Which shape of A, counted from 0."""
    @property
    def part_b(self) -> int:
        """Which shape of B, counted from 0."""
    @property
    def normal(self) -> Vec2:
        """Unit vector from A to B."""
    @property
    def points(self) -> list[Vec2]:
        """One or two points (m)."""
    @property
    def gaps(self) -> list[float]:
        """Gap at each point (m), below 0 where the surfaces overlap."""
    @property
    def normal_impulses(self) -> list[float]:
        """Impulse on B along the normal at each point, in the last substep (N·s)."""
    @property
    def tangential_impulse(self) -> float:
        """Impulse on B along the normal turned counter-clockwise (N·s)."""
    @property
    def force(self) -> Vec2:
        """Mean force on B over the last substep (N); that on A is its opposite."""
    @property
    def sliding(self) -> bool:
        """Whether the surfaces slid."""

@final
class Contacts:
    """Contacts at one moment, as arrays and one by one."""

    @property
    def bodies(self) -> _IntArray:
        """Places of A and B in body order (n, 2)."""
    @property
    def parts(self) -> _IntArray:
        """Which shape of each (n, 2), counted from 0."""
    @property
    def count(self) -> _IntArray:
        """Number of points of each (n,), 1 or 2."""
    @property
    def points(self) -> _Array:
        """Points (n, 2, 2) (m); NaN where there is no second."""
    @property
    def normals(self) -> _Array:
        """Unit vectors from A to B (n, 2)."""
    @property
    def gaps(self) -> _Array:
        """Gaps (n, 2) (m), below 0 in overlap; NaN where there is no second point."""
    @property
    def normal_impulses(self) -> _Array:
        """Impulses on B along the normal (n, 2), in the last substep (N·s)."""
    @property
    def tangential_impulses(self) -> _Array:
        """Impulses on B along the normal turned counter-clockwise (n,) (N·s)."""
    @property
    def forces(self) -> _Array:
        """Mean forces on B over the last substep (n, 2) (N)."""
    @property
    def sliding(self) -> NDArray[np.bool_]:
        """Whether the surfaces slid (n,)."""
    @property
    def items(self) -> list[Contact]:
        """One by one."""
    def __len__(self) -> int: ...
    def __getitem__(self, index: int, /) -> Contact: ...
    def __iter__(self) -> Iterator[Contact]: ...

@final
class ContactEvent:
    """Something that happened between two shapes.

    The body that was added first is A; of a sensor and what it notices, the sensor. A body that was
    removed since says so (`removed`).
    """

    @property
    def kind(self) -> _EventKind:
        """ "begin", "end", "hit", "sensor_begin" or "sensor_end"."""
    @property
    def time(self) -> float:
        """World time (s): of a hit its moment in the step, of all else the step's end."""
    @property
    def body_a(self) -> Body | None:
        """A; None if it was removed before and no object is left of it."""
    @property
    def body_b(self) -> Body | None:
        """B; None if it was removed before and no object is left of it."""
    @property
    def part_a(self) -> int:
        """Which shape of A, counted from 0."""
    @property
    def part_b(self) -> int:
        """Which shape of B, counted from 0."""
    @property
    def point(self) -> Vec2 | None:
        """Where they touch (m); None at ends and for sensors."""
    @property
    def normal(self) -> Vec2 | None:
        """Unit vector from A to B; None at ends and for sensors."""
    @property
    def approach_speed(self) -> float:
        """How fast they came together (m/s), of hits."""
    @property
    def impulse(self) -> float:
        """Along the normal (N·s): of a hit all, of a beginning the last substep's."""

@final
class ContactEvents:
    """Events of one kind, as arrays and one by one."""

    @property
    def times(self) -> _Array:
        """World times (n,) (s)."""
    @property
    def bodies(self) -> _IntArray:
        """Places of A and B in body order (n, 2); -1 for a body that was removed."""
    @property
    def parts(self) -> _IntArray:
        """Which shape of each (n, 2), counted from 0."""
    @property
    def points(self) -> _Array:
        """Points (n, 2) (m); NaN where there is none."""
    @property
    def normals(self) -> _Array:
        """Unit vectors from A to B (n, 2); NaN where there is none."""
    @property
    def approach_speeds(self) -> _Array:
        """How fast they came together (n,) (m/s), of hits."""
    @property
    def impulses(self) -> _Array:
        """Impulses along the normal (n,) (N·s)."""
    @property
    def items(self) -> list[ContactEvent]:
        """One by one."""
    def __len__(self) -> int: ...
    def __getitem__(self, index: int, /) -> ContactEvent: ...
    def __iter__(self) -> Iterator[ContactEvent]: ...

@final
class Events:
    """What happened during a call that moved the world on."""

    @property
    def begin(self) -> ContactEvents:
        """Shapes that began to touch."""
    @property
    def end(self) -> ContactEvents:
        """Shapes that no longer touch."""
    @property
    def hit(self) -> ContactEvents:
        """Impacts, and new contacts that came faster than a substep's forces make them."""
    @property
    def sensor_begin(self) -> ContactEvents:
        """Shapes that a sensor began to overlap."""
    @property
    def sensor_end(self) -> ContactEvents:
        """Shapes that a sensor no longer overlaps."""
    @property
    def broken(self) -> list[BrokenJoint]:
        """Joints that broke."""

@final
class PreSolve:
    """A contact that is about to be solved. What is set holds for this step."""

    @property
    def body_a(self) -> Body:
        """One body."""
    @property
    def body_b(self) -> Body:
        """The other body."""
    @property
    def part_a(self) -> int:
        """Which shape of A, counted from 0."""
    @property
    def part_b(self) -> int:
        """Which shape of B, counted from 0."""
    @property
    def normal(self) -> Vec2:
        """Unit vector from A to B."""
    @property
    def points(self) -> list[Vec2]:
        """One or two points (m)."""
    @property
    def gaps(self) -> list[float]:
        """Gap at each point (m), below 0 where the surfaces overlap."""
    @property
    def friction(self) -> tuple[float, float]:
        """Static and kinetic friction; may be set to one number for both as well."""
    @friction.setter
    def friction(self, value: float | tuple[float, float], /) -> None: ...
    @property
    def restitution(self) -> float:
        """Speed after over speed before, 0 to 1."""
    @restitution.setter
    def restitution(self, value: float, /) -> None: ...
    @property
    def rolling_resistance(self) -> float:
        """Arm (m) by which the normal force opposes rolling."""
    @rolling_resistance.setter
    def rolling_resistance(self, value: float, /) -> None: ...
    @property
    def tangent_speed(self) -> float:
        """Velocity (m/s) of B along the surface of A at which nothing slides."""
    @tangent_speed.setter
    def tangent_speed(self, value: float, /) -> None: ...
    @property
    def enabled(self) -> bool:
        """Whether the shapes resist one another."""
    @enabled.setter
    def enabled(self, value: bool, /) -> None: ...

@final
class Trajectory:
    """The motion of all bodies at a row of times. Bodies stand in body order."""

    def __new__(
        cls,
        times: _Array,
        positions: _Array,
        angles: _Array,
        velocities: _Array,
        angular_velocities: _Array,
    ) -> Trajectory: ...
    @property
    def times(self) -> _Array:
        """World times (k,) (s)."""
    @property
    def positions(self) -> _Array:
        """Positions of the bodies' frames (k, n, 2) (m)."""
    @property
    def angles(self) -> _Array:
        """Angles (k, n) (rad)."""
    @property
    def velocities(self) -> _Array:
        """Velocities of the centres of mass (k, n, 2) (m/s)."""
    @property
    def angular_velocities(self) -> _Array:
        """Angular velocities (k, n) (rad/s)."""
    def __len__(self) -> int: ...
    def __reduce__(self) -> tuple[type[Trajectory], tuple[_Array, ...]]: ...

@final
class StepReport:
    """What the last step or run took."""

    __match_args__: ClassVar[
        tuple[
            str,
            str,
            str,
            str,
            str,
            str,
            str,
            str,
            str,
            str,
            str,
            str,
            str,
            str,
            str,
            str,
            str,
            str,
            str,
        ]
    ]

    def __new__(
        cls,
        duration: float,
        steps: int,
        stiff_steps: int,
        rejected: int,
        evaluations: int,
        sweeps: int,
        solves: int,
        parts: int,
        factorisations: int,
        impacts: int,
        events: int,
        residual: float,
        overlap: float,
        gap: float,
        smallest_step: float,
        estimate: float | None,
        fallback: tuple[float, str] | None,
        stages: Mapping[str, float],
        trajectory: Trajectory | None = ...,
    ) -> StepReport: ...
    @property
    def duration(self) -> float:
        """World time that passed (s)."""
    @property
    def steps(self) -> int:
        """Steps of the methods, summed over what moves by itself; a closed form counts one."""
    @property
    def stiff_steps(self) -> int:
        """Of the steps, those of Radau's method in runs to a tolerance, where motion was stiff."""
    @property
    def rejected(self) -> int:
        """Steps that were tried again because their error was too large."""
    @property
    def evaluations(self) -> int:
        """Evaluations of the forces."""
    @property
    def sweeps(self) -> int:
        """Sweeps over the rows of contacts, summed over islands and substeps."""
    @property
    def solves(self) -> int:
        """Systems of the rows of joints solved by the methods, summed over islands."""
    @property
    def parts(self) -> int:
        """Most parts that a substep was divided into because of what joints bear.

        256 may not have been enough.
        """
    @property
    def factorisations(self) -> int:
        """Factorisations of the rows of contacts and joints together."""
    @property
    def impacts(self) -> int:
        """Impacts resolved."""
    @property
    def events(self) -> int:
        """Events located in time by runs to a tolerance.

        Shapes that met, contacts that let go, broke away or came to rest.
        """
    @property
    def residual(self) -> float:
        """Largest change of velocity in the last sweep of a substep (m/s): what rows still lack."""
    @property
    def overlap(self) -> float:
        """Deepest overlap of two shapes that touch, at the end (m)."""
    @property
    def gap(self) -> float:
        """How far some joint is from what it holds, at the end (m; rad where it holds an angle)."""
    @property
    def smallest_step(self) -> float:
        """Smallest step (s); infinite where only closed forms were needed."""
    @property
    def estimate(self) -> float | None:
        """Estimated relative error; None where it was not asked for."""
    @property
    def fallback(self) -> tuple[float, str] | None:
        """When (s) and why a run to a tolerance could not go from event to event at first.

        From there on steps were taken twice for a while. None where it always could.
        """
    @property
    def stages(self) -> dict[str, float]:
        """Seconds each stage took, where `World.timing` is on."""
    @property
    def trajectory(self) -> Trajectory | None:
        """The motion at the times that were asked for."""
    def rows(self) -> list[tuple[str, str]]:
        """Name and value of what there is to tell; what did not happen is left out."""
    def _repr_html_(self) -> str:
        """For notebooks."""
    def __eq__(self, value: object, /) -> bool: ...
    def __ne__(self, value: object, /) -> bool: ...
    def __reduce__(self) -> tuple[type[StepReport], tuple[Any, ...]]: ...

@final
class Frame:
    """What a frame of a `Stepper` amounted to."""

    __match_args__: ClassVar[tuple[str, str, str]]

    def __new__(cls, ticks: int, fraction: float, dropped: float) -> Frame: ...
    @property
    def ticks(self) -> int:
        """Steps taken."""
    @property
    def fraction(self) -> float:
        """Part of the next step that has passed: draw at old + fraction·(new − old)."""
    @property
    def dropped(self) -> float:
        """Time (s, scaled) given up because `most_ticks` was reached."""
    def __eq__(self, value: object, /) -> bool: ...
    def __ne__(self, value: object, /) -> bool: ...
    def __reduce__(self) -> tuple[type[Frame], tuple[Any, ...]]: ...

@final
class Stepper:
    """Turns the time between frames into whole steps: a fixed number of ticks a second.

    With a time scale (0 pauses), and a cap on how many ticks one frame catches up.
    """

    def __new__(
        cls, ticks_per_second: float, *, time_scale: float = 1.0, most_ticks: int = 8
    ) -> Stepper: ...
    @property
    def tick(self) -> float:
        """Length of a tick (s)."""
    @property
    def time_scale(self) -> float:
        """How much faster than real time the world runs; 0 pauses it."""
    @time_scale.setter
    def time_scale(self, value: float, /) -> None: ...
    @property
    def most_ticks(self) -> int:
        """Most ticks that a frame catches up; what is beyond is given up."""
    @most_ticks.setter
    def most_ticks(self, value: int, /) -> None: ...
    def frame(self, world: World, elapsed: float) -> Frame:
        """Takes the real time since the last frame (s) and does the steps that are due."""

@final
class Snapshot:
    """A world as it was at one moment: to go back to, to keep, to send. Continues bit for bit."""

    def __new__(
        cls,
        data: bytes,
        laws: Sequence[tuple[Any, ...]] = ...,
        rules: Sequence[tuple[Any, ...]] = ...,
    ) -> Snapshot: ...
    @property
    def time(self) -> float:
        """World time (s)."""
    def to_world(self) -> World:
        """A new world that continues from here."""
    def __len__(self) -> int: ...
    def __bool__(self) -> bool: ...
    def __copy__(self) -> Snapshot: ...
    def __reduce__(
        self,
    ) -> tuple[type[Snapshot], tuple[bytes, list[tuple[Any, ...]], list[tuple[Any, ...]]]]: ...

@final
class World:
    """Bodies, and the laws they move by. A world may be used from several threads."""

    def __new__(
        cls,
        gravity: _Vec2Arg = ...,
        *,
        air_density: float = 0.0,
        wind: _Vec2Arg = ...,
        method: str = "leapfrog",
        substeps: int = 4,
        closed_form: bool = True,
        friction_rule: _Rule = ...,
        restitution_rule: _Rule = ...,
        impact_law: _ImpactLaw = ...,
        solver: _Solver = ...,
        sleeping: bool = False,
        timing: bool = False,
    ) -> World: ...
    @property
    def contacts(self) -> Contacts:
        """Where solid shapes touched after the last step."""
    @property
    def events(self) -> Events:
        """What happened during the last call that moved the world on."""
    def on_begin(self, callback: _Listener, body: Body | None = None) -> _Listener:
        """Calls a function after the step in which two shapes begin to touch."""
    def on_end(self, callback: _Listener, body: Body | None = None) -> _Listener:
        """The same, when two shapes no longer touch."""
    def on_hit(self, callback: _Listener, body: Body | None = None) -> _Listener:
        """The same, for each hit."""
    def on_sensor_begin(self, callback: _Listener, body: Body | None = None) -> _Listener:
        """The same, when a sensor begins to overlap a shape."""
    def on_sensor_end(self, callback: _Listener, body: Body | None = None) -> _Listener:
        """The same, when a sensor no longer overlaps a shape."""
    def off(self, callback: Callable[[ContactEvent], object]) -> None:
        """No longer calls a function with events."""
    @property
    def collision_filter(self) -> _Filter | None:
        """(body_a, part_a, body_b, part_b) -> whether two shapes can touch at all."""
    @collision_filter.setter
    def collision_filter(self, value: _Filter | None, /) -> None: ...
    @property
    def pre_solve(self) -> _Hook | None:
        """Called with each contact before it is solved; False disables it for the step."""
    @pre_solve.setter
    def pre_solve(self, value: _Hook | None, /) -> None: ...
    @property
    def gravity(self) -> Vec2:
        """Gravity (m/s²)."""
    @gravity.setter
    def gravity(self, value: _Vec2Arg, /) -> None: ...
    @property
    def air_density(self) -> float:
        """Density of the air (kg/m²)."""
    @air_density.setter
    def air_density(self, value: float, /) -> None: ...
    @property
    def wind(self) -> Vec2:
        """Velocity of the air (m/s)."""
    @wind.setter
    def wind(self, value: _Vec2Arg, /) -> None: ...
    @property
    def method(self) -> str:
        """Name of the method that moves bodies at a fixed step; `culbuto.methods()` lists them."""
    @method.setter
    def method(self, value: str, /) -> None: ...
    @property
    def substeps(self) -> int:
        """Into how many equal substeps a step is divided, 1 to 65536."""
    @substeps.setter
    def substeps(self, value: int, /) -> None: ...
    @property
    def sweeps(self) -> int:
        """Most sweeps over the rows of contacts a substep, 1 to 10000; fewer where they settle."""
    @sweeps.setter
    def sweeps(self, value: int, /) -> None: ...
    @property
    def closed_form(self) -> bool:
        """Whether bodies under constant forces take the exact solution, whatever the method."""
    @closed_form.setter
    def closed_form(self, value: bool, /) -> None: ...
    @property
    def friction_rule(self) -> _Rule:
        """How the friction of two surfaces becomes that of the pair.

        "geometric_mean" √(ab), "hypotenuse" √(a² + b²), "product", "minimum", "maximum" or
        "average".
        """
    @friction_rule.setter
    def friction_rule(self, value: _Rule, /) -> None: ...
    @property
    def restitution_rule(self) -> _Rule:
        """How the restitution of two surfaces becomes that of the pair, at most 1."""
    @restitution_rule.setter
    def restitution_rule(self, value: _Rule, /) -> None: ...
    @property
    def impact_law(self) -> _ImpactLaw:
        """What restitution is a ratio of.

        "newton" velocities, "poisson" impulses, "stronge" works (its square).
        """
    @impact_law.setter
    def impact_law(self, value: _ImpactLaw, /) -> None: ...
    @property
    def solver(self) -> _Solver:
        """How the rows of contacts and joints are solved.

        "sweep" one contact after the other, "newton" all of an island at once, "auto" as the
        island asks for.
        """
    @solver.setter
    def solver(self, value: _Solver, /) -> None: ...
    @property
    def asleep(self) -> int:
        """How many bodies sleep."""
    @property
    def sleeping(self) -> bool:
        """Whether bodies that rest are left out of the work until something wakes them."""
    @sleeping.setter
    def sleeping(self, value: bool, /) -> None: ...
    @property
    def pairs(self) -> list[PairOfMaterials]:
        """The pairs of materials that are known, in the order in which they were set."""
    def set_pair(
        self,
        material_a: str,
        material_b: str,
        *,
        friction: _Friction | None = None,
        restitution: float | None = None,
    ) -> None:
        """Sets what two materials make together, instead of the rules.

        Their order does not matter; a pair of which nothing is given is forgotten.

        Args:
            material_a: Name of the one, as bodies and shapes have it.
            material_b: Name of the other; may be the same.
            friction: A number, or two: static and kinetic. None: by the rule.
            restitution: 0 to 1. None: by the rule.
        """
    @property
    def timing(self) -> bool:
        """Whether each stage of a step is timed, for `report()` and `explain()`."""
    @timing.setter
    def timing(self, value: bool, /) -> None: ...
    @property
    def time(self) -> float:
        """World time (s). Schedules and fields that depend on time go by it."""
    @time.setter
    def time(self, value: float, /) -> None: ...
    @property
    def bodies(self) -> list[Body]:
        """All bodies, in body order."""
    @property
    def fields(self) -> list[Field]:
        """All fields."""
    @property
    def schedules(self) -> list[Schedule]:
        """All schedules."""
    @property
    def positions(self) -> _Array:
        """Positions of the bodies' frames (n, 2) (m). May be set; all or nothing."""
    @positions.setter
    def positions(self, value: ArrayLike, /) -> None: ...
    @property
    def angles(self) -> _Array:
        """Angles (n,) (rad). May be set; all or nothing."""
    @angles.setter
    def angles(self, value: ArrayLike, /) -> None: ...
    @property
    def velocities(self) -> _Array:
        """Velocities of the centres of mass (n, 2) (m/s). May be set; all or nothing."""
    @velocities.setter
    def velocities(self, value: ArrayLike, /) -> None: ...
    @property
    def angular_velocities(self) -> _Array:
        """Angular velocities (n,) (rad/s). May be set; all or nothing."""
    @angular_velocities.setter
    def angular_velocities(self, value: ArrayLike, /) -> None: ...
    @property
    def forces(self) -> _Array:
        """Constant forces (n, 2) (N). May be set; all or nothing."""
    @forces.setter
    def forces(self, value: ArrayLike, /) -> None: ...
    @property
    def torques(self) -> _Array:
        """Constant torques (n,) (N·m). May be set; all or nothing."""
    @torques.setter
    def torques(self, value: ArrayLike, /) -> None: ...
    @property
    def masses(self) -> _Array:
        """Masses (n,) (kg)."""
    @property
    def inertias(self) -> _Array:
        """Moments of inertia about the centres of mass (n,) (kg·m²)."""
    @property
    def centers(self) -> _Array:
        """Centres of mass in the world (n, 2) (m)."""
    @property
    def energy(self) -> Energy:
        """Energies of the dynamic bodies."""
    @property
    def momentum(self) -> Vec2:
        """Σ mv over the dynamic bodies (kg·m/s)."""
    @property
    def mass(self) -> float:
        """Mass of the dynamic bodies (kg)."""
    @property
    def center_of_mass(self) -> Vec2:
        """Centre of mass of the dynamic bodies (m); the origin where there is none."""
    def angular_momentum(self, about: _Vec2Arg = ...) -> float:
        """Σ m(r − p) × v + Iω over the dynamic bodies (kg·m²/s), about a point p (m)."""
    def third_law_residual(self) -> float | None:
        """Largest net force and torque of the internal fields, over the sum of their forces.

        0 to rounding where they say the truth; None without such a field.
        """
    def add_body(
        self,
        shape: Shape | Iterable[Shape] | None = None,
        *,
        kind: _Kind = ...,
        position: _Vec2Arg = ...,
        angle: float = 0.0,
        velocity: _Vec2Arg = ...,
        angular_velocity: float = 0.0,
        density: float = 1.0,
        mass: float | None = None,
        inertia: float | None = None,
        center_of_mass: _Vec2Arg | None = None,
        lock_x: bool = False,
        lock_y: bool = False,
        lock_rotation: bool = False,
        gravity_scale: float = 1.0,
        linear_damping: float = 0.0,
        angular_damping: float = 0.0,
        drag_coefficient: float = 0.4,
        drag_width: _Width = ...,
        force: _Vec2Arg = ...,
        torque: float = 0.0,
        friction: _Friction = ...,
        restitution: float = 0.0,
        rolling_resistance: float = 0.0,
        tangent_speed: float = 0.0,
        material: str | None = None,
        category: int = 1,
        mask: int = 4_294_967_295,
        group: int = 0,
        sensor: bool = False,
        one_way: _Vec2Arg | None = None,
        name: str | None = None,
    ) -> Body:
        """Adds a body of a shape, of several (a compound) or of none (a point, with a mass).

        Args:
            shape: In the body's frame.
            kind: "dynamic", "static" or "kinematic".
            position: Of the body's frame (m).
            angle: Of the body's frame (rad).
            velocity: Of the centre of mass (m/s).
            angular_velocity: rad/s.
            density: Of shapes that have none of their own (kg/m²; kg/m of wires).
            mass: Instead of what follows from the densities (kg).
            inertia: About the centre of mass, instead of what follows from the shapes (kg·m²).
            center_of_mass: In the body's frame, instead of what follows from the shapes (m).
            lock_x: No motion along x.
            lock_y: No motion along y.
            lock_rotation: No rotation.
            gravity_scale: How many times gravity acts.
            linear_damping: Rate at which the velocity against the air decays (1/s).
            angular_damping: Rate at which the angular velocity decays (1/s).
            drag_coefficient: C in the air drag ½ρCAv².
            drag_width: A in it: "silhouette", "bounding_box", or a width (m).
            force: Constant, through the centre of mass (N).
            torque: Constant (N·m).
            friction: A number, or two: static and kinetic; 0.5. This and what follows are of
                shapes that have none of their own.
            restitution: Speed after over speed before a collision, 0 to 1.
            rolling_resistance: Arm by which the normal force opposes rolling (m).
            tangent_speed: Of the surface along its border, counter-clockwise, as a conveyor's
                belt (m/s).
            material: Name, for `set_pair`.
            category: Bits of the categories the shapes belong to.
            mask: Bits of the categories they touch: each one's category must be in the other's
                mask.
            group: Shapes of one group always touch if it is above 0, and never if it is below.
            sensor: They only notice what overlaps them.
            one_way: They stop only what comes from the side that this points to, in the body's
                frame.
            name: To find the body by.

        Raises:
            ValueError: For a number that is not allowed; it says which, and what is.
        """
    def add_field(
        self,
        field: _Law | Central | Attraction | Oscillating,
        *,
        potential: _Potential | None = None,
        velocity_dependent: bool = True,
        internal: bool = False,
        name: str | None = None,
    ) -> Field:
        """Adds a field of force, which acts on all bodies.

        Args:
            field: One of the engine's, or a function of a `State` that returns forces (n, 2) (N),
                or a tuple of forces and torques (n,) (N·m). What it raises comes out of the step.
            potential: A function of a `State` that returns the energy (J) whose gradient the forces
                are. Without it the forces do work.
            velocity_dependent: False saves evaluations where it is true.
            internal: Says that the forces act between the bodies and sum to zero, torques too.
            name: For messages; by default the function's.
        """
    def add_schedule(
        self,
        body: Body,
        times: ArrayLike,
        forces: ArrayLike | None = None,
        torques: ArrayLike | None = None,
    ) -> Schedule:
        """Adds forces (n, 2) (N) and torques (n,) (N·m) on a body, constant between given times.

        Times (n + 1,) are in s, world time; nothing acts before and after, and the last may be
        infinite. Steps end at each of them, so the motion is as exact as under a constant force.
        """
    def add_fluid(
        self,
        points: ArrayLike | Shape | None = None,
        *,
        spacing: float,
        density: float = 1000.0,
        viscosity: float = 0.0,
        tension: float = 0.0,
        adhesion: float = 0.0,
        name: str | None = None,
    ) -> Fluid:
        """Adds a fluid with particles at points (n, 2) (m), or on a lattice in a shape.

        The shape is given in the frame of the world. `spacing` is the distance of the particles at
        rest (m), the same for all fluids of a world; density is in kg/m², viscosity in Pa·s,
        tension and adhesion are in N/m. Without points, particles come by `inflows` or `add`.
        """
    @property
    def fluids(self) -> list[Fluid]:
        """All fluids."""
    @property
    def drains(self) -> list[Shape]:
        """Regions, in the frame of the world, that remove the particles which enter them."""
    @drains.setter
    def drains(self, drains: Sequence[Shape]) -> None: ...
    @property
    def surface_energy(self) -> float:
        """Energy of the surfaces of fluids (J), part of the potential energy."""
    @property
    def threads(self) -> int:
        """Threads that work on fluids, 1 unless set; runs have the same bits on any number."""
    @threads.setter
    def threads(self, threads: int) -> None: ...
    def pressure_at(self, point: _Vec2Arg) -> float | None:
        """Pressure of the fluids at a point (Pa); None where there is none."""
    def height_at(self, x: float) -> float | None:
        """Height of the highest free surface above a place x (m); None where there is none."""
    def fluid_load(self, body: Body) -> tuple[Vec2, float]:
        """Mean force (N) and torque (N·m, about its centre) on a body in the last step."""
    def add_soft_body(
        self,
        shape: Shape | ArrayLike,
        *,
        size: float | None = None,
        triangles: ArrayLike | None = None,
        position: _Vec2Arg = ...,
        angle: float = 0.0,
        velocity: _Vec2Arg = ...,
        angular_velocity: float = 0.0,
        density: float = 1000.0,
        youngs_modulus: float = 1e6,
        poissons_ratio: float = 0.3,
        plane: Literal["stress", "strain"] = ...,
        damping_ratio: float = 0.0,
        damping_frequency: float = 1.0,
        yield_strain: float | None = None,
        stretch_stiffness: float | None = None,
        bending_stiffness: float = 0.0,
        closed: bool = False,
        gas_pressure: float | None = None,
        outside_pressure: float = 0.0,
        gas_exponent: float = 1.0,
        gravity_scale: float = 1.0,
        pins: ArrayLike | None = None,
        radius: float | None = None,
        touches_itself: bool = False,
        friction: _Friction = ...,
        restitution: float = 0.0,
        tangent_speed: float = 0.0,
        material: str | None = None,
        category: int = 1,
        mask: int = 4_294_967_295,
        group: int = 0,
        name: str | None = None,
    ) -> SoftBody:
        """Adds a deformable body: a shape in triangles, triangles of one's own, or a rope.

        Args:
            shape: In the body's frame: a shape with an area or an outline (n, 2), to be cut into
                triangles; points (n, 2) of `triangles`; or points (n, 2) of a rope.
            size: About how long the sides of the triangles of a shape or an outline are (m).
            triangles: Numbers (m, 3) of the points at their corners. Nodes on sides come after.
            position: Of the body's frame (m).
            angle: Of the body's frame (rad).
            velocity: Of the centre of mass (m/s).
            angular_velocity: rad/s.
            density: kg/m²; of ropes kg/m.
            youngs_modulus: E (Pa). Bodies are of unit thickness.
            poissons_ratio: Above -1 and below 0.5 (0.5 itself in plane stress).
            plane: "stress", a thin sheet, or "strain", a slice of something long.
            damping_ratio: Part of critical damping at `damping_frequency`; other frequencies are
                damped in proportion to theirs.
            damping_frequency: Hz.
            yield_strain: Difference of the principal strains (logarithmic) beyond which it stays
                bent; None: never.
            stretch_stiffness: EA (N). Makes a rope, with a rod from each point to the next.
            bending_stiffness: EI of a rope (N·m²), which is straight at rest.
            closed: Whether the rope goes back to its first point.
            gas_pressure: Of the gas in a closed rope in its area at rest (Pa); None: no gas.
            outside_pressure: Against it (Pa).
            gas_exponent: γ of pAᵞ = constant, 1 to 10.
            gravity_scale: How many times gravity acts.
            pins: Numbers of nodes that stay where they are.
            radius: By how much its border is thicker than its nodes say (m); by default a fiftieth
                of the mean piece of its border.
            touches_itself: Whether its border touches itself.
            friction: A number, or two: static and kinetic; 0.5.
            restitution: Speed after over speed before a collision, 0 to 1.
            tangent_speed: Of the surface along its border (m/s).
            material: Name, for `set_pair`.
            category: Bits of the categories it belongs to.
            mask: Bits of the categories it touches.
            group: Bodies of one group always touch if it is above 0, and never if it is below.
            name: In pictures and messages.

        Raises:
            ValueError: For a number that is not allowed; it says which, and what is.
        """
    @property
    def soft_bodies(self) -> list[SoftBody]:
        """All deformable bodies."""
    def add_joint(self, joint: _AnyJoint) -> _AnyJoint:
        """Adds a joint that was drafted, and returns it.

        `world.add_joint(cb.DistanceJoint(ground, crate, hertz=2))`
        """
    @property
    def joints(self) -> Joints:
        """The joints of now and of later: a view."""
    @property
    def soft_contacts(self) -> list[SoftContact]:
        """What touches deformable bodies after the last step."""
    @property
    def soft_events(self) -> SoftEvents:
        """What began and ended to touch deformable bodies, and what hit them, in the last call."""
    def soft_bodies_at(self, point: _Vec2Arg, **seen: Unpack[_SeenSofts]) -> list[SoftBody]:
        """The deformable bodies that hold a point."""
    def soft_bodies_in(
        self, lower: _Vec2Arg, upper: _Vec2Arg, **seen: Unpack[_SeenSofts]
    ) -> list[SoftBody]:
        """The deformable bodies that share a point with the box between two corners."""
    def cast_ray_soft(
        self, start: _Vec2Arg, end: _Vec2Arg, **seen: Unpack[_SeenSofts]
    ) -> SoftRayHit | None:
        """The first deformable body on the way from `start` to `end`; None if it is free.

        A ray that starts inside one hits it at fraction 0.
        """
    def nearest_soft(
        self, point: _Vec2Arg, max_distance: float = ..., **seen: Unpack[_SeenSofts]
    ) -> NearestSoft | None:
        """The deformable body that is nearest; None if none is within `max_distance` (m)."""
    def remove(self, part: Body | Field | Fluid | Schedule | SoftBody | _Joint) -> None:
        """Removes a body (with its joints and schedules), or any other part."""
    def find(self, name: str) -> Body | None:
        """The first body of this name, in body order; None if there is none."""
    def cast_ray(self, start: _Vec2Arg, end: _Vec2Arg, **seen: Unpack[_Seen]) -> RayHit | None:
        """The first shape on the straight way from `start` to `end`; None if it is free.

        Shapes are solid: a ray that starts in one hits it at fraction 0. Wires are hit from both
        sides.
        """
    def cast_ray_all(self, start: _Vec2Arg, end: _Vec2Arg, **seen: Unpack[_Seen]) -> list[RayHit]:
        """All shapes on the straight way from `start` to `end`, in the order of the way.

        Each comes once, where the ray first enters it.
        """
    def cast_rays(self, starts: ArrayLike, ends: ArrayLike, **seen: Unpack[_Seen]) -> RayHits:
        """The first hits of many rays at once, from `starts` (n, 2) to `ends` (n, 2).

        One point will do for all starts. A ray that hits nothing has the body −1, the fraction 1,
        its own end as the point and the normal (0, 0). The interpreter is released meanwhile.
        """
    def cast_shape(
        self,
        shape: Shape,
        translation: _Vec2Arg,
        *,
        position: _Vec2Arg = ...,
        angle: float = 0.0,
        **seen: Unpack[_Seen],
    ) -> RayHit | None:
        """The first shape that a shape hits on its way; None if the way is free.

        It starts at `position` and `angle` and moves along `translation` (m) without turning. What
        it overlaps at the start it hits at fraction 0.
        """
    def cast_shape_all(
        self,
        shape: Shape,
        translation: _Vec2Arg,
        *,
        position: _Vec2Arg = ...,
        angle: float = 0.0,
        **seen: Unpack[_Seen],
    ) -> list[RayHit]:
        """All shapes that a shape would hit if nothing stopped it, in the order of the way."""
    def bodies_at(self, point: _Vec2Arg, **seen: Unpack[_Seen]) -> list[Body]:
        """The bodies that hold a point, in body order. Wires hold none."""
    def bodies_in(
        self,
        lower: _Vec2Arg,
        upper: _Vec2Arg,
        *,
        exact: bool = True,
        **seen: Unpack[_Seen],
    ) -> list[Body]:
        """The bodies that share a point with the box between two corners, in body order.

        With `exact=False` those with a shape whose own box along the axes does.
        """
    def overlapping(
        self,
        shape: Shape,
        *,
        position: _Vec2Arg = ...,
        angle: float = 0.0,
        **seen: Unpack[_Seen],
    ) -> list[Body]:
        """The bodies that share a point with a shape at a place, in body order."""
    def nearest(
        self, point: _Vec2Arg, max_distance: float = ..., **seen: Unpack[_Seen]
    ) -> Nearest | None:
        """The shape that is nearest to a point; None if none is within `max_distance` (m)."""
    def read(self, column: _Column, *, out: _Array | None = None) -> _Array:
        """Fills a contiguous array of floats of the right shape with a column, and returns it."""
    def step(self, dt: float, steps: int = 1, *, estimate: bool = False) -> None:
        """Moves the world on by `steps` steps of `dt` (s), at a fixed step.

        Forces applied for the next step act in the first. With `estimate` the error is estimated
        from a run at half the substep (three times the cost); `report()` tells it.
        """
    def advance(
        self, duration: float, tolerance: float = 1e-09, *, times: ArrayLike | None = None
    ) -> StepReport:
        """Moves the world on by a duration (s), to a relative tolerance (1e-15 to 0.1).

        The report holds an estimate of the error and, where `times` (k,) are given (s from now,
        increasing, within the duration), the motion at those.
        """
    def record(self, dt: float, steps: int, every: int = 1) -> Trajectory:
        """`steps` steps of `dt` (s), keeping the motion at the start and after every `every`."""
    def report(self) -> StepReport:
        """What the last step or run took."""
    @property
    def stages(self) -> list[str]:
        """Names of the stages that a step of this world runs now, in their order."""
    def explain(self) -> str:
        """The stages a step of this world runs, which bodies each moves, and how."""
    @staticmethod
    def from_file(path: _Path) -> World:
        """The world of a scene file.

        Raises:
            SceneFileError: For what is not allowed in it; the message says where.
            OSError: For a file that cannot be read.
        """
    def save(self, path: _Path) -> None:
        """Writes the world as it is to a scene file, over one that is there.

        `SceneFile.from_world` says what a file cannot hold, and gives the scene a name.
        """
    def snapshot(self) -> Snapshot:
        """Keeps the world as it is: `restore` goes back to it."""
    def restore(self, snapshot: Snapshot) -> None:
        """Goes back to a snapshot, of this world or of another.

        The objects of then are those of now again, the removed ones too; what was added since is
        gone. From another world's snapshot, or one that was pickled, bodies whose handles are the
        same keep their objects, and the rest is made anew.
        """
    def __len__(self) -> int: ...
    def __bool__(self) -> bool: ...
    def __iter__(self) -> Iterator[Body]: ...
    def __contains__(self, key: object, /) -> bool: ...
    def __copy__(self) -> World: ...
    def __reduce__(self) -> tuple[type[World], tuple[()], tuple[Any, ...]]: ...
    def __setstate__(self, state: tuple[Any, ...]) -> None: ...
    def _repr_svg_(self) -> str:
        """The world as it is, as an SVG: what a notebook shows of it."""
    def draw(self, ax: Axes, *, joints: bool = True, **style: object) -> Axes:
        """Draws the world as it is on matplotlib axes, in metres; `style` goes to the patches."""

@final
class SceneFile:
    """A world as a file holds it, and how it is meant to be run. There is none that makes no world.

    What cannot be read or written is a `SceneFileError` that says where; a file that cannot be
    opened, an `OSError`.
    """

    @staticmethod
    def read(path: _Path) -> SceneFile:
        """Reads a scene file."""
    @staticmethod
    def from_json(text: str) -> SceneFile:
        """Reads a scene from JSON text."""
    @staticmethod
    def from_world(
        world: World,
        *,
        name: str = "",
        about: str = "",
        dt: float = ...,
        duration: float = 10.0,
    ) -> SceneFile:
        """The scene that begins where a world is; the world made from it goes on to the same bits.

        Step `dt` and `duration` (s) are for whoever runs it. The world's energy books (work,
        dissipation) are not in it.

        Raises:
            SceneFileError: For what a file cannot hold: a field that is code of your own, one on a
                body that was removed, a force that waits for the next step.
        """
    @property
    def name(self) -> str:
        """Name of the scene; may be empty."""
    @property
    def about(self) -> str:
        """What is to be seen; may be empty."""
    @property
    def dt(self) -> float:
        """Length of a step (s) for whoever runs it."""
    @property
    def duration(self) -> float:
        """How long it is meant to be run (s)."""
    def world(self) -> World:
        """A new world of the scene, at its beginning."""
    def to_json(self) -> str:
        """The scene as JSON text: always the same for the same scene, numbers to their last bit."""
    def write(self, path: _Path) -> None:
        """Writes a scene file, over one that is there."""
    def __eq__(self, value: object, /) -> bool: ...
    def __ne__(self, value: object, /) -> bool: ...
    def __reduce__(self) -> tuple[Callable[[str], SceneFile], tuple[str]]: ...

def scene_schema() -> dict[str, Any]:
    """The JSON schema of scene files."""

def methods() -> list[Facts]:
    """Facts of every method, the default first."""

# The catalogue and the report, as JSON: `culbuto.catalogue` and `culbuto.study` make classes of it.

_End: TypeAlias = _Vec2Arg | tuple[Body, _Vec2Arg]

def rope(
    world: World,
    start: _End,
    end: _End,
    *,
    pinned: tuple[bool, bool] = ...,
    length: float | None = None,
    links: int = 20,
    mass_per_length: float = 1.0,
    points: bool = False,
    radius: float | None = None,
    bending_stiffness: float = 0.0,
    bending_damping: float = 0.0,
    breaking_force: float | None = None,
    name: str = ...,
) -> builders.Assembly:
    """Adds a rope of links, or of points with rods between them.

    It is laid out straight if it is as long as its ends are apart, else on an arc that hangs down.

    Args:
        world: To which it is added.
        start: A point of the world, or a body and a point in its frame (m).
        end: Likewise.
        pinned: Whether start and end are held; only points of the world can be free.
        length: m; None: as far as the ends are apart, and a thousandth more where both are fixed.
        links: Their number.
        mass_per_length: kg/m.
        points: Points with rods, which touch nothing, instead of links.
        radius: Half the thickness of links (m); None: a tenth of a link's length.
        bending_stiffness: EI of links (N·m²).
        bending_damping: Damping of bending (N·m²·s).
        breaking_force: Above which a joint breaks (N); None: never.
        name: Bodies are called "rope 0" and so on, joints "rope joint 0".

    Raises:
        ValueError: A number is not allowed, among them a length below the distance of the ends,
            or no slack between fixed ones.
        StaleHandleError: A body was removed, or belongs to another world.
    """

def chain(
    world: World,
    start: _End,
    end: _End,
    *,
    pinned: tuple[bool, bool] = ...,
    length: float | None = None,
    links: int = 20,
    mass_per_length: float = 1.0,
    wire: float | None = None,
    breaking_force: float | None = None,
    name: str = ...,
) -> builders.Assembly:
    """Adds a chain of links, seen from the side: one broad, the next on edge.

    Arguments and errors are those of `rope`, but for `wire`: its thickness (m); None: a third of
    the way from one link to the next.
    """

def bridge(
    world: World,
    start: _End,
    end: _End,
    *,
    pinned: tuple[bool, bool] = ...,
    length: float | None = None,
    planks: int = 12,
    mass_per_length: float = 1.0,
    thickness: float | None = None,
    breaking_force: float | None = None,
    name: str = ...,
) -> builders.Assembly:
    """Adds planks hinged end to end.

    Arguments and errors are those of `rope`, but for the number of `planks` and their `thickness`
    (m); None: a fifth of a plank's length.
    """

def ragdoll(
    world: World,
    height: float,
    mass: float,
    *,
    position: _Vec2Arg = ...,
    angle: float = 0.0,
    velocity: _Vec2Arg = ...,
    faces_left: bool = False,
    limits: bool = True,
    hertz: float | None = None,
    damping_ratio: float = 0.0,
    friction_torque: float = 0.0,
    group: int | None = None,
    breaking_force: float | None = None,
    name: str = ...,
) -> builders.Ragdoll:
    """Adds a human figure of eleven capsules and ten hinges, seen from the side, standing upright.

    Args:
        world: To which it is added.
        height: m.
        mass: Of the whole (kg).
        position: Where the soles stand (m).
        angle: Turn of the whole about that point (rad).
        velocity: Of all bones (m/s).
        faces_left: Instead of right: all limits the other way.
        limits: Whether the hinges have limits.
        hertz: Of the spring in each hinge, which draws it upright (Hz); None: no spring.
        damping_ratio: Of that spring.
        friction_torque: With which every hinge resists turning (N·m).
        group: Of all bones; below 0 they never touch each other. None: one of its own.
        breaking_force: Above which a hinge breaks (N); None: never.
        name: Bodies are called "ragdoll pelvis" and so on, hinges after what hangs on them.

    Raises:
        ValueError: A number is not allowed.
    """

def vehicle(
    world: World,
    length: float,
    mass: float,
    *,
    position: _Vec2Arg = ...,
    angle: float = 0.0,
    velocity: _Vec2Arg = ...,
    height: float | None = None,
    wheel_base: float | None = None,
    wheel_radius: float | None = None,
    wheel_mass: float | None = None,
    suspension_hertz: float = 2.0,
    suspension_damping_ratio: float = 0.7,
    suspension_travel: float | None = None,
    speed: float = 0.0,
    max_torque: float | None = None,
    driven: tuple[bool, bool] = ...,
    name: str = ...,
) -> builders.Vehicle:
    """Adds a chassis on two wheels, in the balance of its springs; the front is on the right.

    Args:
        world: To which it is added.
        length: Of the chassis (m).
        mass: Of the chassis (kg).
        position: The point of the ground midway between its wheels (m).
        angle: Of the ground (rad).
        velocity: With which it starts, wheels not turning (m/s).
        height: Of the chassis (m); None: a quarter of its length.
        wheel_base: Distance of the axles (m); None: 0.6 of the length.
        wheel_radius: m; None: an eighth of the length.
        wheel_mass: Of each (kg); None: a twentieth of the chassis.
        suspension_hertz: Frequency at which the chassis bounces (Hz).
        suspension_damping_ratio: Of that.
        suspension_travel: How far a wheel goes up and down (m); None: half its radius.
        speed: That the motor drives at, to the right (m/s).
        max_torque: On a driven wheel (N·m); None: an eighth of the weight times the wheel's radius.
        driven: Whether the rear wheel has a motor, and the front wheel.
        name: Bodies are called "vehicle chassis" and so on, joints "vehicle rear axle".

    Raises:
        ValueError: A number is not allowed.
    """

def lattice(
    world: World,
    outline: ArrayLike,
    spacing: float,
    *,
    stiffness: float | None = None,
    young: float | None = None,
    holes: Iterable[ArrayLike] | None = None,
    pattern: Literal["triangular", "square", "braced_square"] = ...,
    damping_ratio: float = 0.02,
    mass_per_area: float = 1.0,
    radius: float | None = None,
    velocity: _Vec2Arg = ...,
    breaking_force: float | None = None,
    name: str = ...,
) -> builders.Lattice:
    """Adds points that fill a polygon, with springs at rest between neighbours.

    Args:
        world: To which it is added.
        outline: A simple polygon (n, 2) in the world (m).
        spacing: Distance of neighbours (m). Cells not wholly inside are left out.
        stiffness: k of a spring between two points inside (N/m), or else
        young: Young's modulus times depth (N/m): one of the two is given.
        holes: Polygons, each (n, 2) (m).
        pattern: Triangles, squares, or squares with diagonals.
        damping_ratio: Of a spring between two points inside, alone.
        mass_per_area: kg/m².
        radius: Of the disks that touch what is around (m); None: half the spacing. 0: nothing does.
        velocity: Of all points (m/s).
        breaking_force: Above which a spring breaks (N); None: never.
        name: Bodies are called "lattice 0" and so on, joints "lattice joint 0".

    Raises:
        TypeError: Neither stiffness nor young is given, or both are.
        ValueError: The outline is no simple polygon, a number is not allowed, or no cell is inside.
    """

def catalogue() -> str:
    """Every scene of the catalogue."""

def open_scene(name: str) -> World:
    """The world of a scene of the catalogue."""

def verify(name: str) -> str:
    """A scene against its answer."""

def verify_laws(
    world: World, method: str, dt: float, duration: float, limits: Sequence[float]
) -> str:
    """The conservation laws on a run of a copy of a world."""

@final
class Audit:
    """The laws of a world from one moment on."""

    def __new__(cls, world: World) -> Audit: ...
    def look(self, world: World, limits: Sequence[float]) -> str:
        """Looks at the world again; the largest deviations so far."""

def study(
    name: str,
    ladders: tuple[Sequence[int], Sequence[float]],
    methods: Sequence[str],
    repeats: int,
) -> str:
    """Rows of error against run time, at numbers of steps a run and to tolerances."""

def measured_order(name: str, method: str) -> str:
    """The order of a method on a scene."""

def hard_scenes() -> list[tuple[str, str]]:
    """Numbers and names of the hard scenes."""

def stability_of(name: str, rates: Sequence[float]) -> str:
    """How a hard scene ends by each solver, at these numbers of steps a second."""

def thrown_ball(methods: Sequence[str], ticks: Sequence[int]) -> str:
    """Paths of a thrown ball."""

def exact_motion(name: str, times: NDArray[np.float64]) -> NDArray[np.float64]:
    """Positions and angles (k, n, 3) of a scene's bodies at times (s), as its answer has them."""

def scene_error(
    name: str,
    times: NDArray[np.float64],
    positions: NDArray[np.float64],
    angles: NDArray[np.float64],
) -> float:
    """Largest error of a recorded motion of a scene, as the report states it."""

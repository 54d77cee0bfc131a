"""Objects from joints: ropes, chains, bridges, ragdolls, vehicles, lattices of springs.

Each function adds ordinary bodies and joints to a world and returns them. `start` and `end` of what
is long are points of the world, or pairs of a body and a point in its frame (m); what is not
`pinned` there ends freely. A call that fails leaves the world as it was.

>>> import culbuto as cb
>>> world = cb.World()
>>> rope = cb.builders.rope(world, (0, 2), (3, 2), length=4, mass_per_length=0.2)
>>> world.step(1 / 60, steps=60)
>>> round(rope.mass, 12), len(rope.joints), rope.gap < 1e-9
(0.8, 21, True)

Friction, damping, filters and the like are set afterwards, body by body.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from culbuto._native import bridge, chain, lattice, ragdoll, rope, vehicle
from culbuto.joints import WheelJoint

if TYPE_CHECKING:
    from culbuto._native import Body
    from culbuto.joints import Joint

__all__ = [
    "Assembly",
    "Lattice",
    "Ragdoll",
    "Vehicle",
    "bridge",
    "chain",
    "lattice",
    "ragdoll",
    "rope",
    "vehicle",
]

BONES = (
    "pelvis", "chest", "head", "left upper arm", "left forearm", "right upper arm",
    "right forearm", "left thigh", "left shin", "right thigh", "right shin",
)  # fmt: skip


@dataclass(frozen=True)
class Assembly:
    """What was added: its bodies, in the order along the object, and its joints, likewise."""

    bodies: tuple[Body, ...]
    joints: tuple[Joint, ...]

    @property
    def mass(self) -> float:
        """Sum of the masses (kg)."""
        return sum(body.mass for body in self.bodies)

    @property
    def gap(self) -> float:
        """Largest `gap` of the joints that are left (m; rad where a joint holds an angle)."""
        return max((joint.gap for joint in self.joints if not joint.removed), default=0.0)

    def remove(self) -> None:
        """Takes what is left of it out of the world."""
        parts: list[Joint | Body] = [*self.bodies, *self.joints]
        for part in reversed(parts):
            if not part.removed:
                part.remove()


@dataclass(frozen=True)
class Ragdoll(Assembly):
    """A human figure: eleven bones, and the hinges by which all but the pelvis hang on another."""

    @property
    def bones(self) -> dict[str, Body]:
        """Bodies by name: "pelvis", "chest", "head", "left upper arm", "right shin" and so on."""
        return dict(zip(BONES, self.bodies, strict=True))

    @property
    def hinges(self) -> dict[str, Joint]:
        """Hinges by the bone that they hang on its parent; the pelvis has none."""
        return dict(zip(BONES[1:], self.joints, strict=True))


@dataclass(frozen=True)
class Vehicle(Assembly):
    """A chassis on a rear and a front wheel; the front is on the right."""

    wheel_radius: float

    @property
    def chassis(self) -> Body:
        """The chassis."""
        return self.bodies[0]

    @property
    def wheels(self) -> tuple[Body, ...]:
        """Rear and front wheel."""
        return self.bodies[1:]

    @property
    def axles(self) -> tuple[Joint, ...]:
        """Wheel joints from the chassis to the rear and the front wheel."""
        return self.joints

    def drive(self, speed: float) -> None:
        """Drives at another speed to the right (m/s); wheels without a motor roll on.

        Raises:
            StaleHandleError: An axle was removed.
            ValueError: The speed is not finite.
        """
        axles = [axle for axle in self.axles if isinstance(axle, WheelJoint)]
        for axle in [axle for axle in axles if axle.motor_speed is not None]:
            axle.motor_speed = -speed / self.wheel_radius


@dataclass(frozen=True)
class Lattice(Assembly):
    """Points and springs, and what they amount to as an elastic sheet under small strains.

    Moduli are those of plane stress, times the depth. For a spring of stiffness k inside:

    - "triangular": E = 2k/√3, ν = 1/3, G = √3k/4;
    - "square": E = k along the axes, ν = 0, G = 0;
    - "braced_square": E = 4k/3, ν = 1/3, G = k/2.

    (M. Ostoja-Starzewski, "Lattice models in micromechanics", Applied Mechanics Reviews 55, 2002.)
    """

    stiffness: float
    """k of a spring between two points inside (N/m)."""
    young: float
    """Young's modulus E (N/m)."""
    poisson: float
    """Poisson's ratio ν."""
    shear: float
    """Shear modulus G (N/m)."""
    area: float
    """Area of its cells (m²)."""

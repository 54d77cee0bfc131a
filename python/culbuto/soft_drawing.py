"""How deformable bodies look in pictures: triangles by their stress, and borders."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    from culbuto._native import SoftBody, World

Points = NDArray[np.float64]

COLOUR = "#2a9c9c"  # of what is not stressed, and of borders
STRESSED = "#d2483f"
AROUND = [0, 3, 1, 4, 2, 5]  # the nodes of a triangle as they follow one another
# Shear strain of full colour where no more is reached: what is nearly at rest looks so.
LEAST_STRAIN = 1e-3


@dataclass(frozen=True)
class SoftMark:
    """What is drawn of a deformable body, in world coordinates (m).

    `faces` (m, 6, 2) are the outlines of its triangles, `colours` theirs; `borders` (b, 2, 2) are
    the pieces of its border, or its rods.
    """

    name: str
    faces: Points
    colours: list[str]
    borders: Points

    @classmethod
    def of(cls, body: SoftBody) -> SoftMark:
        """A body as it is now."""
        at, triangles = body.positions, body.triangles
        faces = at[triangles[:, AROUND]]
        shear = np.nan_to_num(shears(body)[: len(triangles)])
        full = max(shear.max(initial=0.0), LEAST_STRAIN * body.youngs_modulus)
        return cls(body.name or "", faces, [_between(s / full) for s in shear], at[body.border])


def shears(body: SoftBody) -> Points:
    """Greatest shear stress (m,) of each element in the plane: half the principal difference."""
    xx, yy, xy = body.stresses.T
    return np.asarray(np.hypot(0.5 * (xx - yy), xy))


def soft_marks(world: World) -> list[SoftMark]:
    """The deformable bodies as they are now."""
    return [SoftMark.of(body) for body in world.soft_bodies]


def _between(part: float) -> str:
    """The colour at this part of the way from no stress to the greatest."""
    ends = [[int(colour[i : i + 2], 16) for i in (1, 3, 5)] for colour in (COLOUR, STRESSED)]
    mixed = (round(a + part * (b - a)) for a, b in zip(*ends, strict=True))
    return "#" + "".join(f"{channel:02x}" for channel in mixed)

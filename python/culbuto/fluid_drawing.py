"""How fluids look in pictures: particles as dots, one colour a fluid."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from culbuto._native import Fluid, World

Points = NDArray[np.float64]

COLOURS = ("#4a90d9", "#c98a2b", "#6fae5a", "#a86bb8")


@dataclass(frozen=True)
class FluidMark:
    """What is drawn of a fluid: where its particles are (m), how wide (m) and in which colour."""

    name: str
    points: Points
    width: float
    colour: str

    @classmethod
    def of(cls, fluid: Fluid, number: int) -> FluidMark:
        """A fluid as it is now, the one of this number in its world."""
        colour = COLOURS[number % len(COLOURS)]
        return cls(fluid.name or "", fluid.positions, fluid.spacing, colour)


def fluid_marks(world: World) -> list[FluidMark]:
    """The fluids as they are now."""
    return [FluidMark.of(fluid, number) for number, fluid in enumerate(world.fluids)]


def draw_fluids(world: World, ax: Axes) -> None:
    """Draws the fluids on matplotlib axes, in metres."""
    from matplotlib.collections import EllipseCollection  # noqa: PLC0415 — comes with an extra

    for mark in fluid_marks(world):
        size = np.full(len(mark.points), mark.width)
        dots = EllipseCollection(
            size,
            size,
            np.zeros_like(size),
            units="xy",
            offsets=mark.points,
            offset_transform=ax.transData,
            facecolors=mark.colour,
        )
        ax.add_collection(dots)

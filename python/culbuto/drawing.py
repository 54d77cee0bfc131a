"""Pictures of worlds: as SVG for notebooks and files, and on matplotlib axes.

Colours are of middle lightness on no background, so that they read on white and on black.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import chain
from typing import TYPE_CHECKING, Any
from xml.sax.saxutils import escape, quoteattr

import numpy as np
from numpy.typing import NDArray

from culbuto.fluid_drawing import FluidMark, draw_fluids, fluid_marks
from culbuto.joint_drawing import Mark, marks
from culbuto.soft_drawing import COLOUR, SoftMark, soft_marks

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from matplotlib.axes import Axes

    from culbuto._native import Body, Trajectory, World

Points = NDArray[np.float64]

COLOURS = {"dynamic": "#3584c8", "kinematic": "#cc7a29", "static": "#858585"}
PATH_COLOUR = "#b0579a"
JOINT_COLOUR = "#2e9d6a"
WIDTH = 640  # of a picture, in pixels
TALLEST = 640
DOT = 3.0  # radius in pixels of a body without a shape
HINGE = 4.0  # radius in pixels of a hinge
MOST_PATH_POINTS = 1000


@dataclass(frozen=True)
class Sketch:
    """What is drawn of a body at a moment, in world coordinates (m).

    `shapes` holds the outlines of each of its shapes, closed where the first point is the last.
    `mark` goes from the centre of mass in the direction of the body's x axis; it has no length
    where the body has no shape.
    """

    name: str
    kind: str
    shapes: tuple[tuple[Points, ...], ...]
    mark: Points

    @classmethod
    def of(cls, body: Body, position: Sequence[float], angle: float) -> Sketch:
        """A body, placed as given."""
        local = [shape.outline() for shape in body.shapes]
        extents = [np.ptp(ring, axis=0).max() for rings in local for ring in rings]
        cos, sin = np.cos(angle), np.sin(angle)
        turn = np.array([[cos, sin], [-sin, cos]])
        center = np.asarray(body.local_center)
        mark = np.array([center, center + np.array([0.3 * min(extents, default=0.0), 0.0])])
        placed = tuple(tuple(ring @ turn + position for ring in rings) for rings in local)
        return cls(body.name or "", body.kind, placed, mark @ turn + position)

    @property
    def points(self) -> Points:
        """All of its points."""
        return np.concatenate([*chain(*self.shapes), self.mark[:1]])


def sketches(world: World) -> list[Sketch]:
    """The bodies as they are now."""
    return [Sketch.of(body, tuple(body.position), body.angle) for body in world.bodies]


def svg(world: World, *, joints: bool = True) -> str:
    """The world as it is, as an SVG: shapes coloured by kind, centres of mass, orientation, joints.

    Triangles of deformable bodies are coloured by their stress.

    Args:
        world: The world.
        joints: Whether joints are drawn.
    """
    now, soft, wet = sketches(world), soft_marks(world), fluid_marks(world)
    canvas = _Canvas(_view(now, _reach(world, joints=joints)))
    tied = marks(world, HINGE / canvas.scale) if joints else []
    drawn = [*map(canvas.fluid, wet), *map(canvas.body, now)]
    return canvas.document([*drawn, *map(canvas.soft, soft), *map(canvas.joint, tied)])


def _reach(world: World, *, joints: bool) -> list[Points]:
    """Where fluids and deformable bodies are, and joints, whatever the size of their marks."""
    soft = [fluid.positions for fluid in world.fluids if fluid.positions.size]
    soft += [body.positions for body in world.soft_bodies]
    return [*soft, *(mark.points for mark in marks(world, 0.0))] if joints else soft


def picture(world: World, trajectory: Trajectory, *, joints: bool = True) -> str:
    """A motion as an SVG: the bodies at its start (faint) and at its end, and the paths between.

    Fluids, joints and deformable bodies are drawn at its end, if that is where the world is.
    """
    moving = [i for i, body in enumerate(world.bodies) if body.kind != "static"]

    def at(k: int) -> list[Sketch]:
        places = zip(trajectory.positions[k], trajectory.angles[k], strict=True)
        return [Sketch.of(b, x, a) for b, (x, a) in zip(world.bodies, places, strict=True)]

    start, end = at(0), at(-1)
    every = -(-len(trajectory.times) // MOST_PATH_POINTS)
    paths = [_centers(world.bodies[i], trajectory, i)[::every] for i in moving]
    there = trajectory.times[-1] == world.time
    there = there and np.array_equal(trajectory.positions[-1], world.positions)
    reach = _reach(world, joints=joints) if there else []
    canvas = _Canvas(_view(start + end, [*paths, *reach]))
    tied = marks(world, HINGE / canvas.scale) if joints and there else []
    return canvas.document([
        *map(canvas.fluid, fluid_marks(world) if there else []),
        *(canvas.body(start[i], faint=True) for i in moving),
        *(canvas.path(path) for path in paths),
        *map(canvas.body, end),
        *map(canvas.soft, soft_marks(world) if there else []),
        *map(canvas.joint, tied),
    ])  # fmt: skip


def _centers(body: Body, trajectory: Trajectory, i: int) -> Points:
    """Path of a body's centre of mass."""
    angles, (x, y) = trajectory.angles[:, i], body.local_center
    cos, sin = np.cos(angles), np.sin(angles)
    arm = np.stack([cos * x - sin * y, sin * x + cos * y], axis=1)
    return np.asarray(trajectory.positions[:, i] + arm)


def _view(drawn: Iterable[Sketch], paths: Sequence[Points]) -> Points:
    """Lower left and upper right corner (m) of what is shown.

    All of what moves, and so much of what does not as is near: a long floor does not make the rest
    small.
    """
    drawn = list(drawn)
    still = [sketch.points for sketch in drawn if sketch.kind == "static"]
    moving = [sketch.points for sketch in drawn if sketch.kind != "static"] + list(paths)
    if not still and not moving:
        return np.array([[-1.0, -1.0], [1.0, 1.0]])
    every = np.concatenate(moving + still)
    low, high = every.min(axis=0), every.max(axis=0)
    if moving and still:
        points = np.concatenate(moving)
        reach = max(0.3 * np.ptp(points, axis=0).max(), 1e-12)
        low = np.maximum(low, points.min(axis=0) - reach)
        high = np.minimum(high, points.max(axis=0) + reach)
    size = (high - low).max()
    margin = 0.06 * size if size > 0 else 1.0
    # Not thinner than an eighth of its length.
    spare = np.maximum(0.0, size / 8 - (high - low)) / 2
    return np.array([low - margin - spare, high + margin + spare])


def _closed(rings: Sequence[Points]) -> bool:
    """Whether the outlines bound an area; those of wires do not."""
    return all(np.array_equal(ring[0], ring[-1]) for ring in rings)


class _Canvas:
    """From metres, y up, to pixels, y down."""

    def __init__(self, view: Points) -> None:
        self.low, high = view
        self.scale = min(WIDTH / (high[0] - self.low[0]), TALLEST / (high[1] - self.low[1]))
        self.width, self.height = (high - self.low) * self.scale

    def _steps(self, points: Points) -> str:
        x, y = ((points - self.low) * self.scale).T
        # Beyond sight by far: some viewers draw nothing where numbers are huge.
        xs, ys = np.clip(x, -1e5, 1e5), np.clip(self.height - y, -1e5, 1e5)
        return " ".join(f"{x:.2f},{y:.2f}" for x, y in zip(xs, ys, strict=True))

    def _d(self, ring: Points) -> str:
        return f"M{self._steps(ring[:-1])}Z" if _closed([ring]) else f"M{self._steps(ring)}"

    def body(self, sketch: Sketch, *, faint: bool = False) -> str:
        """A body: its outlines filled, a dot at the centre of mass, a line that turns with it."""
        colour = COLOURS[sketch.kind]
        x, y = self._steps(sketch.mark[:1]).split(",")
        radius = DOT if not sketch.shapes else 1.8
        parts = [f"<title>{escape(sketch.name)}</title>"] if sketch.name else []
        for rings in sketch.shapes:
            fill = f'fill="{colour}" fill-opacity="0.22"' if _closed(rings) else 'fill="none"'
            outline = "".join(map(self._d, rings))
            parts.append(f'<path d="{outline}" {fill} fill-rule="evenodd"/>')
        if sketch.kind != "static" and sketch.shapes:
            parts.append(f'<path d="M{self._steps(sketch.mark)}"/>')
        if sketch.kind != "static" or not sketch.shapes:
            parts.append(f'<circle cx="{x}" cy="{y}" r="{radius}" fill="{colour}" stroke="none"/>')
        opacity = ' opacity="0.45"' if faint else ""
        kind = quoteattr(f"body {sketch.kind}")
        return f'<g class={kind} stroke="{colour}"{opacity}>{"".join(parts)}</g>'

    def fluid(self, mark: FluidMark) -> str:
        """A fluid: a dot for each particle."""
        title = f"<title>{escape(mark.name)}</title>" if mark.name else ""
        dots = "".join(f"M{self._steps(point[None])}h0" for point in mark.points)
        line = f'stroke-width="{max(mark.width * self.scale, 0.5):.2f}"'
        return f'<g class="fluid" stroke="{mark.colour}">{title}<path d="{dots}" {line}/></g>'

    def soft(self, mark: SoftMark) -> str:
        """A deformable body: its triangles filled, its border."""
        parts = [f"<title>{escape(mark.name)}</title>"] if mark.name else []
        for face, colour in zip(mark.faces, mark.colours, strict=True):
            look = f'fill="{colour}" fill-opacity="0.45" stroke="{colour}" stroke-width="0.4"'
            parts.append(f'<path d="M{self._steps(face)}Z" {look}/>')
        border = "".join(map(self._d, mark.borders))
        parts.append(f'<path d="{border}" fill="none"/>')
        return f'<g class="soft" stroke="{COLOUR}">{"".join(parts)}</g>'

    def path(self, points: Points) -> str:
        """The way of a centre of mass."""
        line = f'd="M{self._steps(points)}" fill="none" stroke="{PATH_COLOUR}"'
        return f'<path class="path" {line} stroke-width="1.2" stroke-opacity="0.9"/>'

    def joint(self, mark: Mark) -> str:
        """A joint: its lines, rings and dots."""
        parts = [f"<title>{escape(mark.name)}</title>"] if mark.name else []
        if mark.thin:
            thin = "".join(map(self._d, mark.thin))
            parts.append(f'<path d="{thin}" stroke-width="1" stroke-dasharray="4 3"/>')
        if mark.lines:
            parts.append(f'<path d="{"".join(map(self._d, mark.lines))}"/>')
        for points, radius, fill in ((mark.rings, HINGE, "none"), (mark.dots, 2.0, JOINT_COLOUR)):
            for point in points:
                x, y = self._steps(point[None]).split(",")
                parts.append(f'<circle cx="{x}" cy="{y}" r="{radius}" fill="{fill}"/>')
        kind = quoteattr(f"joint {mark.kind}")
        return f'<g class={kind} stroke="{JOINT_COLOUR}" fill="none">{"".join(parts)}</g>'

    def document(self, parts: Sequence[str]) -> str:
        """The SVG."""
        width, height = f"{self.width:.0f}", f"{self.height:.0f}"
        return "\n".join([
            f'<svg xmlns="http://www.w3.org/2000/svg" width="{width}" height="{height}" '
            f'viewBox="0 0 {width} {height}" style="max-width: 100%; height: auto" '
            'stroke-width="1.5" stroke-linejoin="round" stroke-linecap="round">',
            *parts,
            "</svg>\n",
        ])  # fmt: skip


def draw(world: World, ax: Axes, *, joints: bool = True, **style: Any) -> Axes:  # noqa: ANN401 — whatever a patch takes
    """Draws the world on matplotlib axes, in metres; `style` goes to the patches of shapes."""
    from matplotlib.collections import LineCollection, PolyCollection  # noqa: PLC0415
    from matplotlib.patches import PathPatch  # noqa: PLC0415 — comes with an extra
    from matplotlib.path import Path  # noqa: PLC0415

    draw_fluids(world, ax)
    now = sketches(world)
    for sketch in now:
        colour = COLOURS[sketch.kind]
        for rings in sketch.shapes:
            look = {"edgecolor": colour, "facecolor": colour + "38" if _closed(rings) else "none"}
            path = Path.make_compound_path(*map(Path, rings))
            ax.add_patch(PathPatch(path, label=sketch.name, **{**look, **style}))
        if sketch.kind != "static":
            ax.plot(*sketch.mark.T, color=colour, linewidth=1.2)
            ax.plot(*sketch.mark[0], marker="o", markersize=3, color=colour)
    for soft in soft_marks(world):
        ax.add_collection(PolyCollection(list(soft.faces), facecolors=soft.colours, alpha=0.45))
        ax.add_collection(LineCollection(list(soft.borders), colors=COLOUR, linewidths=1.2))
    low, high = _view(now, _reach(world, joints=joints))
    if joints:
        for mark in marks(world, 0.01 * float((high - low).max())):
            for line in mark.lines:
                ax.plot(*line.T, color=JOINT_COLOUR, linewidth=1.5)
            for line in mark.thin:
                ax.plot(*line.T, color=JOINT_COLOUR, linewidth=0.8, linestyle="--")
            for points, face in ((mark.rings, "none"), (mark.dots, JOINT_COLOUR)):
                x, y = np.reshape(points, (-1, 2)).T
                ax.plot(x, y, "o", color=JOINT_COLOUR, markerfacecolor=face, markersize=5)
    ax.set(xlim=(low[0], high[0]), ylim=(low[1], high[1]), xlabel="x (m)", ylabel="y (m)")
    ax.set_aspect("equal")
    return ax

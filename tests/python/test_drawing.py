"""Pictures of worlds."""

from xml.etree import ElementTree as ET

import numpy as np
import pytest

import culbuto as cb
from culbuto.drawing import picture, svg
from test_joints import KINDS, added

SVG = "{http://www.w3.org/2000/svg}"


def a_world() -> cb.World:
    """One body of every kind and shape, and a floor much longer than the rest."""
    world = cb.World()
    world.add_body(cb.Box(1e4, 1), kind="static", position=(0, -0.5), name="floor")
    shapes: list[cb.Shape] = [
        cb.Circle(0.5),
        cb.Box(1, 0.5),
        cb.RegularPolygon(5, 0.5),
        cb.Polygon([(0, 0), (2, 0), (2, 2), (0, 2)], holes=[[(0.5, 0.5), (1, 0.5), (1, 1)]]),
        cb.Capsule((0, 0), (1, 0), 0.2),
        cb.Segment((0, 0), (1, 1)),
        cb.Arc((0, 0), 1, 0, 2),
        cb.Chain([(0, 0), (1, 0), (2, 1)]),
    ]
    for i, shape in enumerate(shapes):
        world.add_body(shape, position=(2.5 * i, 3), angle=0.3, velocity=(1, 2), name=f"<{i}>")
    world.add_body(mass=1, position=(1, 5), name="point & dot")
    world.add_body(cb.Circle(0.2), kind="kinematic", position=(3, 5), velocity=(1, 0))
    return world


def bodies(svg: str) -> list[ET.Element]:
    root = ET.fromstring(svg)  # noqa: S314 — our own
    return [g for g in root.iter(f"{SVG}g") if g.get("class", "").startswith("body")]


def test_every_body_is_in_the_picture() -> None:
    world = a_world()
    drawn = bodies(world._repr_svg_())
    assert [g.get("class") for g in drawn] == [f"body {body.kind}" for body in world.bodies]
    titles = [title.text for g in drawn for title in g.iter(f"{SVG}title")]
    assert titles == [body.name for body in world.bodies if body.name]


def test_a_long_floor_does_not_make_the_rest_small() -> None:
    world = a_world()
    circle = bodies(world._repr_svg_())[1].find(f"{SVG}path")
    assert circle is not None
    steps = (circle.get("d") or "").strip("MZ").split()
    x = np.array([float(step.split(",")[0]) for step in steps])
    assert np.ptp(x) > 8  # pixels


def test_up_is_up() -> None:
    world = cb.World()
    for y in (0, 5):
        world.add_body(mass=1, position=(0, y))
    low, high = (g.find(f"{SVG}circle") for g in bodies(world._repr_svg_()))
    assert low is not None
    assert high is not None
    assert float(high.get("cy", 0)) < float(low.get("cy", 0))


def test_a_motion_has_start_end_and_paths() -> None:
    world = a_world()
    trajectory = world.record(0.01, 20)
    svg = picture(world, trajectory)
    moving = sum(body.kind != "static" for body in world.bodies)
    assert len(bodies(svg)) == moving + len(world)
    assert svg.count('class="path"') == moving


@pytest.mark.parametrize("world", [cb.World(), cb.scene("S12")])
def test_little_to_draw_is_drawn(world: cb.World) -> None:
    assert len(bodies(world._repr_svg_())) == len(world)


def joints(svg: str) -> list[ET.Element]:
    root = ET.fromstring(svg)  # noqa: S314 — our own
    return [g for g in root.iter(f"{SVG}g") if g.get("class", "").startswith("joint")]


@pytest.mark.parametrize("kind", KINDS)
def test_every_joint_but_a_filter_is_in_the_picture(kind: str) -> None:
    world, joint = added(kind)
    joint.name = "<it>"
    drawn = joints(world._repr_svg_())
    assert len(drawn) == (kind != "filter")
    for g in drawn:
        assert g.get("class") == f"joint {joint.kind}"
        assert [title.text for title in g.iter(f"{SVG}title")] == ["<it>"]
        assert list(g.iter(f"{SVG}path")) or list(g.iter(f"{SVG}circle"))
        assert "nan" not in ET.tostring(g, "unicode")
    assert not joints(svg(world, joints=False))
    motion = world.record(0.01, 5)
    assert len(joints(picture(world, motion))) == len(drawn)
    world.bodies[2].position = (5, 6)  # now the bodies are elsewhere than in the picture
    assert not joints(picture(world, motion))


def test_where_a_joint_holds_the_world_is_in_sight() -> None:
    world = cb.World()
    world.add_body(cb.Circle(0.1))
    world.add_joint(cb.DistanceJoint(None, world.bodies[0], anchor_a=(0, 100)))
    (rod,) = joints(svg(world))
    heights = [float(dot.get("cy", "nan")) for dot in rod.iter(f"{SVG}circle")]
    assert min(heights) > 0


def test_draws_on_axes() -> None:
    pytest.importorskip("matplotlib")
    from matplotlib.figure import Figure  # noqa: PLC0415

    ax = Figure().add_subplot()
    world = a_world()
    assert world.draw(ax, linewidth=2) is ax
    assert len(ax.patches) == sum(len(body.shapes) for body in world.bodies)
    assert {patch.get_linewidth() for patch in ax.patches} == {2}
    assert ax.get_aspect() == 1
    world.add_joint(cb.RevoluteJoint(None, world.bodies[1]))
    world.add_joint(cb.DistanceJoint(*world.bodies[1:3], hertz=1))
    lines = len(Figure().add_subplot().lines)
    for with_joints in (False, True):
        axes = world.draw(Figure().add_subplot(), joints=with_joints)
        assert (len(axes.lines) > lines) is True
        lines = len(axes.lines)

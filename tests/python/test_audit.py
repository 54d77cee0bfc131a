"""The live read-out: what a run took, and what it kept of the laws."""

from collections.abc import Callable
from functools import partial

import pytest

import culbuto as cb


def pile() -> cb.World:
    world = cb.World(gravity=(0, -9.81), timing=True)
    world.add_body(cb.Box(20, 1), kind="static", position=(0, -0.5))
    for k in range(3):
        world.add_body(cb.Box(1, 1), position=(0, 0.5 + k), friction=0.5)
    bob = world.add_body(cb.Circle(0.1), position=(6, 2))
    world.add_joint(cb.RevoluteJoint(None, bob, anchor_a=(5, 2), anchor_b=(-1, 0)))
    return world


def test_a_report_tells_what_happened_and_leaves_out_what_did_not() -> None:
    world = pile()
    world.step(1 / 60, steps=60)
    report = world.report()
    names = [name for name, _ in report.rows()]
    assert names[0] == "world time"
    assert {"sweeps", "smallest step", "overlap", "time", "of it"} <= set(names) | {"smallest step"}
    assert "events" not in names
    assert "estimated error" not in names
    text = str(report)
    assert "detect" in text
    assert len(text.splitlines()) == len(names)
    assert report._repr_html_().count("<tr>") == len(names)
    assert 0 < report.overlap < 1e-3
    assert report.gap < 1e-3
    deepest = max(-gap for contact in world.contacts for gap in contact.gaps)
    assert report.overlap == pytest.approx(max(deepest, 0), abs=1e-15)


def water() -> cb.World:
    world = cb.World(sleeping=True)
    world.add_body(cb.Box(2, 1), kind="static", position=(0, -0.5))
    world.add_fluid(cb.Box(0.4, 0.4, center=(0, 0.2)), spacing=0.1)
    return world


def jelly() -> cb.World:
    world = cb.World()
    world.add_soft_body(cb.Box(1, 1), size=0.5, youngs_modulus=1e5)
    return world


WORLDS = [cb.World, pile, water, jelly]
SCENES = [partial(cb.scene, name) for name in ("S1", "S9", "S12", "C2")]


@pytest.mark.parametrize("make", [*WORLDS, *SCENES])
def test_the_stages_that_a_world_names_are_those_that_run(make: Callable[[], cb.World]) -> None:
    world = make()
    world.timing = True
    named = world.stages
    world.step(1 / 60)
    assert set(named) == set(world.report().stages)
    if world.soft_bodies or world.fluids:
        assert "nothing moves" not in world.explain()


def test_an_estimate_is_told_if_asked_for() -> None:
    world = cb.scene("S12")
    world.step(0.01, steps=10, estimate=True)
    assert "estimated error" in str(world.report())


def test_an_audit_keeps_the_largest_deviations() -> None:
    world = pile()
    with cb.Audit(world) as audit:
        world.step(1 / 60, steps=60)
    # The block ends the audit; what is done by hand afterwards is not in it.
    speed = world.bodies[1].velocity
    world.bodies[1].velocity = (9, 9)
    energy = audit.laws[0]
    world.bodies[1].velocity = speed
    assert energy.name == "energy"
    assert energy.measured is not None
    text = str(audit)
    assert "kept to" in text
    assert "BROKEN" not in text
    assert "does not apply: a joint holds" in text
    assert audit._repr_html_().startswith("<table>")
    # What a user takes from a body by hand is not in the balance, and shows.
    world.bodies[1].velocity = (3, 0)
    laws = audit.look()
    assert laws[0].measured is not None
    assert laws[0].measured > 1e-3
    assert "BROKEN by" in str(audit)
    # The largest deviation counts, also once it is gone.
    world.bodies[1].velocity = (0, 0)
    again = audit.look()[0].measured
    assert again is not None
    assert again >= laws[0].measured


def test_what_goes_wrong_in_the_block_is_not_hidden() -> None:
    with pytest.raises(ZeroDivisionError), cb.Audit(pile()):
        _ = 1 / 0

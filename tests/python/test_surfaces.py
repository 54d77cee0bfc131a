"""How bodies touch: friction, restitution, filters and roles go in and come out; bad ones not."""

import copy
import json
import pickle
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

import culbuto as cb

NAN, INF = float("nan"), float("inf")
RULES = ["geometric_mean", "hypotenuse", "product", "minimum", "maximum", "average"]

coefficient = st.floats(0, 5)
share = st.one_of(st.just(1.0), st.floats(0, 1))
friction = st.tuples(coefficient, share).map(lambda pair: (pair[0], pair[0] * pair[1]))
bits = st.integers(0, 2**32 - 1)
component = st.floats(-1e6, 1e6)
side = st.tuples(component, component).filter(lambda v: v[0] ** 2 + v[1] ** 2 > 0)
SURFACE = {
    "friction": friction,
    "restitution": st.floats(0, 1),
    "rolling_resistance": st.floats(0, 10),
    "tangent_speed": st.floats(-1e6, 1e6),
    "material": st.text(st.characters(codec="utf-8"), max_size=5),
    "category": bits,
    "mask": bits,
    "group": st.integers(-(2**31), 2**31 - 1),
}
ROLE = st.sampled_from([{}, {"sensor": True}]) | side.map(lambda v: {"one_way": v})
own = st.builds(
    lambda some, role: {**some, **role}, st.fixed_dictionaries({}, optional=SURFACE), ROLE
)
DEFAULTS: dict[str, Any] = {
    "friction": (0.5, 0.5),
    "restitution": 0.0,
    "rolling_resistance": 0.0,
    "tangent_speed": 0.0,
    "material": None,
    "category": 1,
    "mask": 2**32 - 1,
    "group": 0,
    "sensor": False,
    "one_way": None,
}


def seen(thing: cb.Body | cb.Shape) -> dict[str, Any]:
    return {name: getattr(thing, name) for name in DEFAULTS}


@given(body=own, shape=own)
def test_what_is_given_is_read_and_goes_everywhere(
    body: dict[str, Any], shape: dict[str, Any]
) -> None:
    world = cb.World()
    made = cb.Circle(1, **shape)
    unset: dict[str, Any] = dict.fromkeys(DEFAULTS)
    if "one_way" in shape:
        unset["sensor"] = False
    assert seen(made) == unset | shape
    assert eval(repr(made), vars(cb)) == made  # noqa: S307
    placed = world.add_body([made, cb.Box(1, 1)], **body)
    worlds = [world, copy.copy(world), pickle.loads(pickle.dumps(world))]  # noqa: S301
    worlds.append(cb.SceneFile.from_json(cb.SceneFile.from_world(world).to_json()).world())
    for same in worlds:
        assert seen(same.bodies[0]) == DEFAULTS | body
        assert same.bodies[0].shapes == placed.shapes == (made, cb.Box(1, 1))

    changed = cb.World().add_body(cb.Circle(1))
    for name, value in body.items():
        setattr(changed, name, value)
    assert seen(changed) == DEFAULTS | body


def test_shapes_differ_by_their_surfaces() -> None:
    shapes = [
        cb.Circle(1),
        cb.Circle(1, friction=0.5),
        cb.Circle(1, friction=(0.5, 0.4)),
        cb.Circle(1, material="ice"),
        cb.Circle(1, group=0),
        cb.Circle(1, sensor=False),
        cb.Circle(1, sensor=True),
        cb.Circle(1, one_way=(0, 1)),
    ]
    assert len(set(shapes)) == len(shapes)
    assert cb.Circle(1, friction=0.5) == cb.Circle(1, friction=(0.5, 0.5))
    assert cb.Circle(1, friction=None, sensor=None) == cb.Circle(1)
    assert repr(cb.Circle(1, friction=0.5)) == "Circle(1.0, friction=0.5)"


def test_every_shape_takes_the_keywords() -> None:
    triangle = [(0, 0), (1, 0), (0, 1)]
    for shape in (
        cb.Circle(1, friction=0.1),
        cb.Box(1, 1, friction=0.1),
        cb.RegularPolygon(5, 1, friction=0.1),
        cb.Polygon(triangle, friction=0.1),
        cb.RoundedPolygon(triangle, 0.1, friction=0.1),
        cb.Capsule((0, 0), (1, 0), 0.1, friction=0.1),
        cb.Segment((0, 0), (1, 0), friction=0.1),
        cb.Arc((0, 0), 1, 0, 1, friction=0.1),
        cb.Chain(triangle, friction=0.1),
    ):
        assert shape.friction == (0.1, 0.1)
        assert eval(repr(shape), vars(cb)) == shape  # noqa: S307


BAD: list[tuple[dict[str, Any], type[Exception], str]] = [
    ({"friction": -1}, ValueError, "friction is -1; allowed"),
    ({"friction": NAN}, ValueError, "friction is NaN"),
    ({"friction": INF}, ValueError, "friction is inf"),
    ({"friction": (0.4, 0.5)}, ValueError, "kinetic friction is 0.5; allowed: 0 to the static"),
    ({"friction": (NAN, 0.5)}, ValueError, "static friction is NaN"),
    ({"friction": (0.5, -0.1)}, ValueError, "kinetic friction is -0.1"),
    ({"friction": (0.5, 0.4, 0.3)}, TypeError, "a number, or two"),
    ({"friction": "low"}, TypeError, "a number, or two"),
    ({"restitution": 1.1}, ValueError, "restitution is 1.1; allowed: 0 to 1"),
    ({"restitution": -0.1}, ValueError, "restitution is -0.1"),
    ({"restitution": NAN}, ValueError, "restitution is NaN"),
    ({"restitution": "high"}, TypeError, "restitution"),
    ({"rolling_resistance": -1}, ValueError, "rolling_resistance is -1"),
    ({"tangent_speed": INF}, ValueError, "tangent_speed is inf"),
    ({"material": 3}, TypeError, "material"),
    ({"category": -1}, ValueError, "category is -1; allowed: a whole number from 0"),
    ({"mask": 2**32}, ValueError, "mask is 4294967296"),
    ({"mask": 0.5}, TypeError, "mask"),
    ({"group": 2**31}, ValueError, "group is 2147483648; allowed"),
    ({"one_way": (0, 0)}, ValueError, "one_way is 0"),
    ({"one_way": (0, NAN)}, ValueError, r"one_way is \(0, NaN\)"),
    ({"one_way": (0, 1, 0)}, ValueError, "two numbers"),
    ({"one_way": (0, 1), "sensor": True}, ValueError, "not both"),
    ({"frction": 1}, TypeError, "unexpected keyword argument 'frction'"),
]


@pytest.mark.parametrize(("keywords", "error", "message"), BAD, ids=repr)
def test_what_is_not_allowed_says_what_is(
    keywords: dict[str, Any], error: type[Exception], message: str
) -> None:
    world = cb.World()
    with pytest.raises(error, match=message):
        cb.Circle(1, **keywords)
    with pytest.raises(error, match=message):
        world.add_body(cb.Circle(1), **keywords)
    assert not len(world)
    [name, *more] = keywords
    if not more and name in DEFAULTS:
        body = world.add_body(cb.Circle(1))
        if error is ValueError:
            with pytest.raises(error, match=message):
                setattr(body, name, keywords[name])
        else:
            with pytest.raises(error):
                setattr(body, name, keywords[name])
        assert seen(body) == DEFAULTS


def test_a_sensor_and_a_platform_take_turns() -> None:
    body = cb.World().add_body(cb.Circle(1))

    def role() -> tuple[bool, cb.Vec2 | None]:
        return body.sensor, body.one_way

    body.sensor = True
    body.one_way = None  # it was none
    assert role() == (True, None)
    body.one_way = (0, 2)
    assert role() == (False, cb.Vec2(0, 2))
    body.sensor = False  # it was none
    assert role() == (False, cb.Vec2(0, 2))
    body.sensor = True
    assert role() == (True, None)


def test_rules_and_laws_of_a_world() -> None:
    world = cb.World()
    assert world.friction_rule == "geometric_mean"
    assert world.restitution_rule == "maximum"
    assert world.impact_law == "newton"
    assert world.sleeping is False
    for rule in RULES:
        other = cb.World(friction_rule=rule, restitution_rule="product")  # type: ignore[arg-type]
        world.friction_rule = rule  # type: ignore[assignment]
        world.restitution_rule = rule  # type: ignore[assignment]
        assert world.friction_rule == world.restitution_rule == other.friction_rule == rule
        assert other.restitution_rule == "product"
    world.impact_law = "stronge"
    world.sleeping = True
    world.set_pair("ice", "steel", friction=(0.03, 0.02))
    again = pickle.loads(pickle.dumps(world))  # noqa: S301
    from_file = cb.SceneFile.from_json(cb.SceneFile.from_world(world).to_json()).world()
    for same in (again, copy.copy(world), from_file):
        assert (same.friction_rule, same.restitution_rule) == ("average", "average")
        assert (same.impact_law, same.sleeping) == ("stronge", True)
        assert same.pairs == world.pairs
    with pytest.raises(ValueError, match="the rule is 'mean'; allowed: 'geometric_mean', 'hyp"):
        world.friction_rule = "mean"  # type: ignore[assignment]
    with pytest.raises(ValueError, match="impact_law is 3; allowed: 'newton', 'poisson', 'stron"):
        world.impact_law = 3  # type: ignore[assignment]


def test_pairs_of_materials() -> None:
    world = cb.World()
    world.set_pair("ice", "steel", friction=(0.03, 0.02), restitution=0.3)
    world.set_pair("wood", "wood", friction=0.4)
    ice = cb.PairOfMaterials("ice", "steel", (0.03, 0.02), 0.3)
    wood = cb.PairOfMaterials("wood", "wood", (0.4, 0.4), None)
    assert world.pairs == [ice, wood]
    assert pickle.loads(pickle.dumps(ice)) == ice  # noqa: S301
    world.set_pair("steel", "ice", restitution=0.5)  # the same two
    assert world.pairs == [cb.PairOfMaterials("steel", "ice", None, 0.5), wood]
    for keywords, message in [
        ({"friction": -1}, 'friction of "a" and "b" is -1'),
        ({"friction": (0.1, 0.2)}, 'kinetic friction of "a" and "b" is 0.2; allowed: 0 to'),
        ({"restitution": 2}, 'restitution of "a" and "b" is 2; allowed: 0 to 1'),
        ({"restitution": NAN}, 'restitution of "a" and "b" is NaN'),
    ]:
        with pytest.raises(ValueError, match=message):
            world.set_pair("a", "b", **keywords)  # type: ignore[arg-type]
    world.set_pair("ice", "steel")  # forgotten
    assert world.pairs == [wood]


def test_a_file_may_name_materials(tmp_path: Path) -> None:
    path = tmp_path / "scene.json"
    disk = {"shape": {"circle": {"radius": 1}}}
    scene = {
        "culbuto": 1,
        "materials": {"ice": {"friction": {"static": 0.1, "kinetic": 0.05}}},
        "bodies": [{"material": "ice", "shapes": [disk, disk | {"friction": 0.3}]}],
    }
    path.write_text(json.dumps(scene), encoding="utf-8")
    body = cb.World.from_file(path).bodies[0]
    assert body.material == "ice"
    assert [shape.friction for shape in body.shapes] == [(0.1, 0.05), (0.3, 0.3)]

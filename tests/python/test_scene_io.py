"""Scene files from Python: there and back to the bit, and what is refused says where and why."""

import copy
import math
import pickle
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from click.testing import CliRunner
from hypothesis import assume, given
from hypothesis import strategies as st

import culbuto as cb
from culbuto.cli import main

EXAMPLES = sorted((Path(__file__).parents[2] / "docs" / "scenes").glob("*.json"))
COLUMNS = ["positions", "angles", "velocities", "angular_velocities", "forces", "torques"]


def same(a: cb.World, b: cb.World) -> None:
    assert a.time == b.time
    for column in [*COLUMNS, "masses", "inertias", "centers"]:
        np.testing.assert_array_equal(getattr(a, column), getattr(b, column), column)


number = st.floats(-1e3, 1e3)
positive = st.floats(0.01, 100)
vector = st.tuples(number, number)
shape = st.one_of(
    st.builds(cb.Circle, positive, center=vector),
    st.builds(cb.Box, positive, positive, center=vector, angle=number),
    st.builds(cb.Capsule, st.just((0, 0)), st.tuples(positive, number), positive),
    st.builds(cb.Segment, st.just((0, 0)), st.tuples(positive, number), density=positive),
)
body: st.SearchStrategy[dict[str, Any]] = st.fixed_dictionaries(
    {"shape": st.lists(shape, min_size=1, max_size=3)},
    optional={
        "kind": st.sampled_from(["dynamic", "static"]),
        "position": vector,
        "angle": number,
        "density": positive,
        "mass": positive,
        "force": vector,
        "torque": number,
        "lock_x": st.booleans(),
        "gravity_scale": number,
        "linear_damping": positive,
        "drag_width": st.sampled_from(["silhouette", "bounding_box", 0.3]),
        "name": st.sampled_from(["a", "b", 'β "\\\n']),
    },
)


@st.composite
def worlds(draw: st.DrawFn) -> cb.World:
    """A world with everything that files hold."""
    world = cb.World(
        draw(vector),
        air_density=draw(st.sampled_from([0.0, 1.2])),
        wind=draw(vector),
        method=draw(st.sampled_from([facts.name for facts in cb.methods()])),
        substeps=draw(st.integers(1, 3)),
        closed_form=draw(st.booleans()),
    )
    for given_body in draw(st.lists(body, max_size=3)):
        made = world.add_body(**given_body)
        if made.kind == "dynamic":
            x, y = draw(vector)
            made.velocity, made.angular_velocity = (0 if made.lock_x else x, y), draw(number)
    world.time = draw(number)
    if world.bodies:
        chosen = draw(st.sampled_from(world.bodies))
        world.add_field(cb.Oscillating(chosen, draw(vector), draw(positive), draw(positive)))
        world.add_schedule(chosen, [world.time, math.inf], [draw(vector)])
    world.add_field(cb.Central(draw(vector), draw(number), 1.0))
    world.add_field(cb.Attraction(draw(number), -2.0, 0.5))
    return world


def try_to_step(world: cb.World) -> bool:
    """False where the world is too stiff for its method; both of a pair say so."""
    try:
        world.step(1e-3, 3)
    except (cb.SimulationError, ValueError):
        return False
    return True


@given(worlds(), st.text(), st.text(), positive, positive)
def test_a_world_goes_on_bit_for_bit(
    world: cb.World, name: str, about: str, dt: float, duration: float
) -> None:
    try_to_step(world)
    file = cb.SceneFile.from_world(world, name=name, about=about, dt=dt, duration=duration)
    again = cb.SceneFile.from_json(file.to_json())
    assert again == file
    assert (again.name, again.about, again.dt, again.duration) == (name, about, dt, duration)
    twin = again.world()
    same(world, twin)
    assert [b.name for b in twin.bodies] == [b.name for b in world.bodies]
    # What contacts remember is not in the file: such a world starts its contacts anew.
    assume(len(world.contacts) == 0)
    assert try_to_step(world) == try_to_step(twin)
    same(world, twin)


def thrown() -> cb.World:
    world = cb.World(air_density=1.2)
    world.add_body(cb.Circle(0.1), name="ball", velocity=(3, 4))
    world.step(1 / 60, 7)
    return world


def test_files(tmp_path: Path) -> None:
    world, path = thrown(), tmp_path / "ball.json"
    file = cb.SceneFile.from_world(world, name="throw", dt=0.01)
    for place in (path, str(path)):
        file.write(place)
        assert cb.SceneFile.read(place) == file
        same(cb.World.from_file(place), world)
    world.save(path)
    same(cb.World.from_file(path), world)
    bare = cb.SceneFile.read(path)
    assert (bare.name, bare.about, bare.dt, bare.duration) == ("", "", 1 / 60, 10)
    assert bare != file
    assert repr(file) == '<SceneFile "throw" of 1 body>'
    for twin in (pickle.loads(pickle.dumps(file)), copy.deepcopy(file)):  # noqa: S301
        assert twin == file
    with pytest.raises(AttributeError):
        file.name = "fall"  # type: ignore[misc]
    assert file.world() is not file.world()


@pytest.mark.parametrize("path", EXAMPLES, ids=lambda path: path.stem)
def test_examples(path: Path) -> None:
    file = cb.SceneFile.read(path)
    assert cb.SceneFile.from_json(file.to_json()) == file
    same(file.world(), cb.World.from_file(path))


def test_the_schema_is_the_published_one() -> None:
    assert cb.scene_schema()["title"] == "Culbuto scene"
    assert cb.scene_schema()["properties"]["culbuto"]["const"] == 1


CROSSED = "[[0, 0], [1, 1], [1, 0], [0, 1]]"
CIRCLE = '"shape": {"circle": {"radius": 1}}'
BAD = [
    ('{"culbuto": 2}', "at culbuto: version 2 is not known"),
    ("{}", r"at \.: no version"),
    ('{"culbuto": 1, "plasmas": []}', "at plasmas: unknown field `plasmas`"),
    ('{"culbuto": 1, "fluids": [{"spacing": 0}]}', r"at fluids\[0\]\.spacing"),
    ('{"culbuto": 1, "bodies": [{"mass": 1, "colour": 3}]}', r"at bodies\[0\].*colour"),
    (
        f'{{"culbuto": 1, "bodies": [{{"shapes": [{{{CIRCLE}, "material": "wood"}}]}}]}}',
        r"at bodies\[0\]\.shapes\[0\]\.material: \"wood\" is not in",
    ),
    (
        f'{{"culbuto": 1, "bodies": [{{"shapes": [{{"shape": {{"polygon": '
        f'{{"vertices": {CROSSED}}}}}}}]}}]}}',
        r"at bodies\[0\]\.shapes\[0\]\.shape.*not simple",
    ),
    ('{"culbuto": 1, "gravity": [NaN, 0]}', r"at gravity|at \."),
    ('{"culbuto": 1, "gravity": [1e999, 0]}', "at gravity"),
    ('{"culbuto": 1, "bodies": [{"mass": -1}]}', r"at bodies\[0\]\.mass: mass is -1"),
    ('{"culbuto": 1, "run": {"dt": 0}}', "at run"),
    ("not JSON", r"at \.: a scene file is a JSON object"),
    ('{"culbuto": 1', r"at \."),
    ("", r"at \."),
]


@pytest.mark.parametrize(("text", "message"), BAD)
def test_what_is_refused_says_where(text: str, message: str, tmp_path: Path) -> None:
    path = tmp_path / "bad.json"
    path.write_text(text, encoding="utf-8")
    with pytest.raises(cb.SceneFileError, match=message):
        cb.SceneFile.from_json(text)
    with pytest.raises(cb.SceneFileError, match=message):
        cb.SceneFile.read(path)
    with pytest.raises(cb.SceneFileError, match=message):
        cb.World.from_file(path)


def test_text_that_is_not_utf_8(tmp_path: Path) -> None:
    path = tmp_path / "bad.json"
    path.write_bytes(b'{"culbuto": 1, "name": "\xff"}')
    with pytest.raises(cb.SceneFileError, match=r"at \.: .*utf-8"):
        cb.SceneFile.read(path)


def test_files_that_cannot_be_opened(tmp_path: Path) -> None:
    world, file = thrown(), cb.SceneFile.from_world(thrown())
    missing = tmp_path / "nowhere" / "scene.json"
    for read in (cb.SceneFile.read, cb.World.from_file):
        with pytest.raises(FileNotFoundError, match=r"scene\.json") as caught:
            read(missing)
        assert caught.value.filename == str(missing)
    for write in (world.save, file.write):
        with pytest.raises(FileNotFoundError, match=r"scene\.json"):
            write(missing)
        with pytest.raises(OSError, match=tmp_path.name):
            write(tmp_path)


@pytest.mark.parametrize(("key", "value"), [("dt", 0.0), ("dt", math.nan), ("duration", -1.0)])
def test_how_it_is_run_is_checked(key: str, value: float) -> None:
    arguments: Any = {key: value}
    with pytest.raises(cb.SceneFileError, match=f"at run.*{key} is"):
        cb.SceneFile.from_world(thrown(), **arguments)


def test_what_a_file_cannot_hold(tmp_path: Path) -> None:
    path = tmp_path / "scene.json"
    world = thrown()
    world.bodies[0].apply_force((1, 0))
    with pytest.raises(cb.SceneFileError, match=r"bodies\[0\].*next step only"):
        world.save(path)
    world.step(0.1)
    world.add_field(lambda state: 0 * state.positions, name="mine")
    before = world.snapshot().__reduce__()[1][0]
    for write in (world.save, lambda _: cb.SceneFile.from_world(world)):
        with pytest.raises(cb.SceneFileError, match=r'fields\[0\].*"mine" is code of your own'):
            write(path)
    assert world.snapshot().__reduce__()[1][0] == before
    assert not path.exists()


@pytest.mark.parametrize("name", [scene.name for scene in cb.scenes() if scene.has_motion])
def test_scenes_of_the_catalogue_are_files(name: str, tmp_path: Path) -> None:
    path, scene = tmp_path / "scene.json", cb.scene(name)
    told = CliRunner().invoke(main, ["run", name, "--duration", "0.1", "--save", str(path)])
    assert told.exit_code == 0, told.output
    assert f"wrote {path}" in told.output.replace("\n", "")
    file = cb.SceneFile.read(path)
    assert (file.name, file.duration) == (name, 0.1)
    twin = file.world()
    same(scene, twin)
    scene.step(file.dt, 5)
    twin.step(file.dt, 5)
    same(scene, twin)
    again = CliRunner().invoke(main, ["run", str(path)])
    assert again.exit_code == 0, again.output

"""The `culbuto` command as a shell sees it."""

import csv
import json
import subprocess
import sys
from pathlib import Path
from typing import Any
from xml.etree import ElementTree as ET

import numpy as np
import pytest
from click.testing import CliRunner, Result

import culbuto
from culbuto.cli import main

SPINNING = {
    "culbuto": 1,
    "name": "two disks",
    "gravity": [0, 0],
    "run": {"dt": 0.01, "duration": 0.5},
    "bodies": [
        {"name": "left", "shapes": [{"shape": {"circle": {"radius": 0.3}}}],
         "position": [-1, 0], "velocity": [0.5, 1], "angular_velocity": 3},
        {"name": "right", "shapes": [{"shape": {"box": {"width": 1, "height": 0.5}}}],
         "position": [1, 0], "velocity": [-0.5, 1]},
    ],
    "fields": [{"attraction": {"strength": 0.4, "exponent": -2, "softening": 0}}],
}  # fmt: skip


def call(*arguments: object, status: int = 0) -> Result:
    result = CliRunner().invoke(main, [str(argument) for argument in arguments])
    assert result.exit_code == status, result.output
    assert "Traceback" not in result.output
    assert result.exception is None or isinstance(result.exception, SystemExit)
    return result


@pytest.fixture
def file(tmp_path: Path) -> Path:
    path = tmp_path / "disks.json"
    path.write_text(json.dumps(SPINNING), encoding="utf-8")
    return path


def test_version() -> None:
    command = [sys.executable, "-m", "culbuto", "--version"]
    done = subprocess.run(command, capture_output=True, text=True, check=True)  # noqa: S603
    assert done.stdout == f"culbuto, version {culbuto.__version__}\n"


def test_scenes_lists_the_catalogue() -> None:
    listed = call("scenes").stdout
    assert all(scene.id in listed and scene.name in listed for scene in culbuto.scenes())


@pytest.mark.parametrize("name", [scene.id for scene in culbuto.scenes() if scene.has_motion])
def test_run_says_plan_laws_and_error(name: str) -> None:
    told = call("run", name).stdout
    for part in ("advance", "force evaluations", "energy − work + dissipated", "exact answer"):
        assert part in told


def test_run_writes_an_npz_and_a_picture(tmp_path: Path) -> None:
    call("run", "projectile", "--output", tmp_path, "--picture")
    with np.load(tmp_path / "projectile.npz") as motion:
        assert motion["names"].tolist() == ["body 0"]
        assert motion["times"].shape == (121,)
        assert motion["positions"].shape == motion["velocities"].shape == (121, 1, 2)
        assert motion["angles"].shape == motion["angular_velocities"].shape == (121, 1)
        # S1 at t = 2; the closed form leaves rounding only.
        np.testing.assert_allclose(motion["positions"][-1, 0], (24, -0.12), rtol=1e-12)
    ET.parse(tmp_path / "projectile.svg")  # noqa: S314 — our own


def test_csv_holds_the_same_numbers(tmp_path: Path, file: Path) -> None:
    call("run", file, "--output", tmp_path)
    call("run", file, "--output", tmp_path, "--format", "csv")
    with (tmp_path / "two-disks.csv").open(encoding="utf-8") as lines:
        rows = list(csv.DictReader(lines))
    with np.load(tmp_path / "two-disks.npz") as motion:
        assert len(rows) == 2 * len(motion["times"])
        assert [row["body"] for row in rows[:2]] == ["left", "right"] == motion["names"].tolist()
        x = np.array([float(row["x"]) for row in rows]).reshape(-1, 2)
        np.testing.assert_array_equal(x, motion["positions"][:, :, 0])


def test_run_takes_its_options(file: Path) -> None:
    told = call("run", file, "--dt", 0.05, "--substeps", 1, "--method", "rk4").stdout
    assert "0.5 s in 10 steps" in told
    assert "rk4, 1 substeps" in told
    assert "estimated error" in call("run", file, "--tolerance", 1e-9).stdout


def test_verify_passes_and_prints_json() -> None:
    assert "all pass" in call("verify", "S1", "silhouette").stdout
    [verdict] = json.loads(call("verify", "S1", "--json").stdout)
    assert verdict["name"] == "projectile"
    assert verdict["passed"]
    assert {row["method"] for row in verdict["methods"]} == {m.name for m in culbuto.methods()}


def test_laws_of_a_file(file: Path) -> None:
    both = ("--method", "leapfrog", "--method", "yoshida4")
    found = json.loads(call("verify", file, "--laws", "--json", *both).stdout)
    assert [laws["method"] for laws in found] == ["leapfrog", "yoshida4"]
    measured = {law["name"]: law["measured"] for law in found[0]["laws"]}
    assert measured["momentum"] < 1e-9
    assert measured["third law"] < 1e-12
    # Leapfrog keeps energy to O(dt²), not to the last bits.
    failed = call("verify", file, "--laws", "--energy", 1e-15, status=1)
    assert "FAIL" in failed.stdout
    assert "1 of 1 fail" in failed.stdout


def test_report_writes_rows_page_and_figure(tmp_path: Path) -> None:
    pytest.importorskip("matplotlib")
    pytest.importorskip("jinja2")
    call("report", "S1", "S18", "--quick", "--output", tmp_path)
    found = {str(path.relative_to(tmp_path)) for path in tmp_path.rglob("*.*")}
    assert found == {"rows.csv", "rows.json", "index.html", "figures/thrown-ball.svg"}


def test_report_without_the_extra_says_how_to_get_it(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    # The package `culbuto.cli` has a command of the name of the module.
    monkeypatch.setattr(sys.modules["culbuto.cli.report"], "find_spec", lambda _: None)
    said = call("report", "S1", "--quick", "--output", tmp_path).stderr
    assert "pip install 'culbuto[plot]'" in said
    assert {path.name for path in tmp_path.iterdir()} == {"rows.csv", "rows.json"}


def bad(**changes: Any) -> str:
    return json.dumps({**SPINNING, **changes})


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["run", "nothing"], "projectile (S1)"),
        (["run", "missing.json"], "missing.json"),
        (["run", "S18"], "scene of numbers"),
        (["run", "S1", "--dt", "-1"], "--dt is -1.0"),
        (["run", "S1", "--duration", "inf"], "--duration is inf"),
        (["run", "S1", "--method", "magic"], "leapfrog"),
        (["run", "S1", "--substeps", "0"], "substeps"),
        (["run", "S1", "--tolerance", "1e-6", "--dt", "0.1"], "leave out --dt"),
        (["run", "S1", "--tolerance", "7"], "tolerance"),
        (["verify", "nothing"], "projectile (S1)"),
        (["verify", "a.json"], "use --laws"),
        (["verify", "S1", "--energy", "1"], "go with --laws"),
        (["verify", "--laws"], "needs a scene"),
        (["verify", "S1", "--laws", "--energy", "-1"], "limit of energy"),
        (["verify", "S1", "--laws", "--dt", "nan"], "dt is nan"),
        (["report", "nothing"], "projectile (S1)"),
        (["fly"], "fly"),
    ],
)
def test_bad_usage_is_said_in_a_line(arguments: list[str], message: str) -> None:
    assert message in call(*arguments, status=2).stderr


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("{", "scene file"),
        (bad(gravity=[0, "down"]), "gravity"),
        (bad(bodies=[{"mass": -1}]), "bodies[0]"),
        (bad(culbuto=99), "99"),
    ],
)
def test_a_bad_file_is_named_by_place(tmp_path: Path, text: str, message: str) -> None:
    path = tmp_path / "bad.json"
    path.write_text(text, encoding="utf-8")
    assert message in call("run", path, status=2).stderr


def test_a_motion_that_cannot_go_on_is_status_1(tmp_path: Path) -> None:
    path = tmp_path / "far.json"
    ball = {"mass": 1, "position": [0, 0], "velocity": [1e308, 0]}
    path.write_text(bad(bodies=[ball], fields=[]), encoding="utf-8")
    assert "finite" in call("run", path, "--duration", 100, "--dt", 10, status=1).stderr

"""Where engines fall, by Culbuto's own solvers: the matrix, its rows and its page."""

import csv
from pathlib import Path

import pytest
from click.testing import CliRunner

from culbuto.cli import main
from culbuto.report.measure import Results, matrix
from culbuto.report.stability import engines, hard_scenes, line, write_rows


@pytest.fixture(scope="module")
def found() -> Results:
    return matrix(["K3", "x3", "fast spin"])


def test_sweeps_let_a_million_on_one_fall_and_newton_holds_it(found: Results) -> None:
    lines = {line.name: line for line in found.stability}
    assert list(lines) == [
        "1000 on 1",
        "10⁶ on 1",
        "stack of 1 mm",
        "stack of 1000 km",
        "fast spin",
    ]
    assert engines(found.stability) == ["culbuto", "culbuto-newton", "culbuto-auto"]
    million = [lines["10⁶ on 1"].cell(engine) for engine in engines(found.stability)]
    assert [cell.word for cell in million if cell] == ["falls", "stands", "stands"]
    newton = million[1]
    assert newton is not None
    assert newton.figure is not None
    assert newton.figure < 1e-6
    assert newton.largest_step == 1 / 15
    assert "<polygon" in newton.picture


def test_a_stack_of_another_size_is_the_same_stack(found: Results) -> None:
    small, large = (found.stability[k].cell("culbuto") for k in (2, 3))
    assert small is not None
    assert large is not None
    assert small.figure == pytest.approx(large.figure, rel=2e-2)  # √10⁻³ is rounded to three digits


def test_every_extreme_of_the_catalogue_has_a_row() -> None:
    whole = matrix(quick=True)
    numbers = {line.id for line in whole.stability}
    assert {f"X{k}" for k in range(1, 16)} <= numbers
    refused = next(line for line in whole.stability if line.id == "X9")
    assert refused.left_out is not None
    assert [cell.word for cell in refused.cells] == ["as asked"]


def test_verdicts_are_the_same_bits_every_time(found: Results) -> None:
    again = matrix(["K3", "x3", "fast spin"])
    assert [line.runs for line in again.stability] == [line.runs for line in found.stability]


def test_every_run_is_a_row(found: Results, tmp_path: Path) -> None:
    table, _ = write_rows(found.stability, tmp_path)
    with table.open(encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    assert len(rows) == 5 * 3 * 5
    assert {row["verdict"] for row in rows} == {"right", "creeps", "falls"}


def test_every_word_there_is(found: Results) -> None:
    entry = {
        "id": "K1", "name": "", "about": "", "figure": "", "seconds": 1.0, "left_out": None,
    }  # fmt: skip
    run = {"engine": "one", "step": 1 / 60, "figure": None, "picture": None}
    figures = {line.figure for line in found.stability}
    for verdict in ("right", "creeps", "falls", "explodes", "nan", "refuses"):
        for figure in figures:
            made = line({**entry, "figure": figure, "cells": [{**run, "verdict": verdict}]})
            assert made.cells[0].good == (verdict == "right")
            assert made.cells[0].word


def test_names_that_are_none_are_refused() -> None:
    with pytest.raises(ValueError, match="stack of 20"):
        hard_scenes(["no such"])


def test_the_command_writes_the_matrix_alone(tmp_path: Path) -> None:
    pytest.importorskip("jinja2")
    pytest.importorskip("matplotlib")
    done = CliRunner().invoke(main, ["report", "--stability", "K3", "--output", str(tmp_path)])
    assert done.exit_code == 0, done.output
    text = (tmp_path / "index.html").read_text("utf-8")
    assert 'id="stability"' in text
    assert 'id="overview"' not in text
    assert not (tmp_path / "rows.csv").exists()

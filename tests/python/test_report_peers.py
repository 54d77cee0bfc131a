"""Other engines in the report: rows, best settings, the matrix of hard scenes."""

import json
import math
from pathlib import Path
from typing import Any

import pytest

from culbuto.catalogue import find
from culbuto.report.measure import measure, write_rows
from culbuto.report.peers import Peers


def row(
    engine: str, setting: str, step: float, error: float | None, seconds: float
) -> dict[str, Any]:
    return {
        "scene": "projectile", "engine": engine, "setting": setting, "step": step, "error": error,
        "seconds": 2 * seconds, "seconds_per_second": seconds,
    }  # fmt: skip


def cell(engine: str, rate: int, verdict: str, figure: float | None) -> dict[str, Any]:
    square = [[0, 0], [1, 0], [1, 1], [0, 1]]
    picture = [square, [[-20, -1], [20, -1], [20, 0], [-20, 0]]] if rate == 60 else None
    return {
        "engine": engine, "step": 1 / rate, "verdict": verdict,
        "figure": figure, "picture": picture,
    }  # fmt: skip


FOUND = {
    "versions": [["culbuto", "culbuto 1"], ["box2d", "boxdd 2"], ["pymunk", "pymunk 3"]],
    "machine": "a machine",
    "build": "with `flags`",
    "rows": [
        row("culbuto", "4 substeps", 0.1, 1e-16, 1e-7),
        row("box2d", "4 substeps", 0.1, 1e-1, 1e-6),
        row("box2d", "4 substeps", 0.01, 1e-3, 1e-4),
        row("box2d", "1 substep", 0.1, 2e-1, 1e-6),
        row("box2d", "1 substep", 0.01, 5e-3, 3e-5),
        row("pymunk", "10 iterations", 0.1, None, 1e-6),
        row("pymunk", "50 iterations", 0.1, 0.3, 1e-5),
    ],
    "left_out": [{"scene": "kepler", "why": "a field acts"}],
    "missing": [["box2d-2", "no such module"]],
    "stability": [
        {
            "id": "K1", "name": "stack of 20", "about": "squares", "seconds": 10,
            "figure": "largest way over its size", "left_out": None,
            "cells": [
                cell("culbuto", 30, "right", 1e-3), cell("culbuto", 60, "right", 1e-3),
                cell("culbuto", 120, "right", 1e-4), cell("box2d", 30, "right", 1e-3),
                cell("box2d", 60, "creeps", 0.1), cell("box2d", 120, "right", 1e-3),
                cell("pymunk", 60, "nan", None),
            ],
        },
    ],
}  # fmt: skip


@pytest.fixture
def file(tmp_path: Path) -> Path:
    path = tmp_path / "peers.json"
    path.write_text(json.dumps(FOUND), "utf-8")
    return path


def test_the_best_setting_of_an_engine_is_drawn(file: Path) -> None:
    peers = Peers.read(file)
    assert peers.engines("projectile") == ["box2d", "pymunk"]
    assert {row.setting for row in peers.curve("projectile", "box2d")} == {"1 substep"}
    # One that never comes below 1 %: the least error.
    assert {row.setting for row in peers.curve("projectile", "pymunk")} == {"50 iterations"}
    assert peers.curve("kepler", "box2d") == []


def test_the_quickest_other_engine_is_named_and_ours_is_not_one(file: Path) -> None:
    peers = Peers.read(file)
    best = peers.quickest("projectile", 1e-2)
    assert best is not None
    assert (best.engine, best.setting) == ("box2d", "1 substep")
    assert peers.quickest("projectile", 1e-8) is None
    assert any(math.isinf(row.error) for row in peers.rows)


def test_the_matrix_says_how_a_scene_ends_and_up_to_which_step_it_is_right(file: Path) -> None:
    [line] = Peers.read(file).stability
    ours, box2d, pymunk = line.cells
    assert (ours.word, ours.good, ours.largest_step) == ("stands", True, 1 / 30)
    # Right at 1/30 by chance, wrong at 1/60: the largest step is one from which on all are right.
    assert (box2d.word, box2d.good, box2d.largest_step) == ("creeps", False, 1 / 120)
    assert (pymunk.word, pymunk.figure, pymunk.largest_step) == ("NaN", None, None)
    assert ours.picture.count("<polygon") == 2


def test_the_page_says_where_another_engine_is_quicker_and_why(file: Path, tmp_path: Path) -> None:
    pytest.importorskip("matplotlib")
    pytest.importorskip("jinja2")
    from dataclasses import replace  # noqa: PLC0415

    from culbuto.report.page import write_page  # noqa: PLC0415

    results = measure([find("projectile")], quick=True)
    peers = Peers.read(file)
    page, _ = write_page(replace(results, peers=peers), tmp_path / "ahead")
    assert "the quickest to each of these errors, or the only one" in page.read_text("utf-8")
    swift = replace(peers.rows[1], error=1e-9, seconds_per_second=1e-12)
    ahead = replace(peers, rows=(*peers.rows, swift))
    page, _ = write_page(replace(results, peers=ahead), tmp_path / "behind")
    text = page.read_text("utf-8")
    assert "Another engine is quicker here: projectile to" in text
    assert "Box2D 3" in text
    assert "times quicker, at 100 ms" in text or "times quicker, at 1/10 s" in text


def test_what_is_no_study_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "other.json"
    path.write_text("{}", "utf-8")
    with pytest.raises(ValueError, match="make report-peers"):
        Peers.read(path)


def test_the_page_has_them_and_says_who_is_missing(file: Path, tmp_path: Path) -> None:
    pytest.importorskip("matplotlib")
    pytest.importorskip("jinja2")
    from dataclasses import replace  # noqa: PLC0415

    from culbuto.report.page import write_page  # noqa: PLC0415

    results = measure([find("projectile"), find("kepler")], quick=True)
    alone, _ = write_page(results, tmp_path / "alone")
    assert "make report-peers" in alone.read_text("utf-8")
    peers = Peers.read(file)
    together = replace(results, peers=peers, stability=peers.stability)
    page, _ = write_page(together, tmp_path / "together")
    text = page.read_text("utf-8")
    assert "Without other engines: a field acts." in text
    assert "Box2D 3" in text
    assert "Left out: Box2D 2 (no such module)" in text
    assert 'id="stability"' in text
    assert "1 substep" in text
    _, data = write_rows(together, tmp_path)
    written = json.loads(data.read_text("utf-8"))
    assert len(written["rows_of_peers"]) == len(FOUND["rows"])
    assert written["peers"] == ["culbuto 1", "boxdd 2", "pymunk 3"]

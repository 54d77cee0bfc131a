"""The report: rows, page and figure."""

import csv
import json
import re
from dataclasses import replace
from html import unescape
from html.parser import HTMLParser
from pathlib import Path
from typing import Any
from xml.etree import ElementTree as ET

import pytest

import culbuto
from culbuto.catalogue import find
from culbuto.report.measure import Results, measure, write_rows
from culbuto.report.needs import counts
from culbuto.study import Row, study
from culbuto.study.runs import spread_of

NAMES = ("projectile", "kepler", "polygons")
VOID = {"meta", "br", "link", "img", "hr"}


@pytest.fixture(scope="module")
def results() -> Results:
    return measure([find(name) for name in NAMES], quick=True)


@pytest.fixture(scope="module")
def page(results: Results, tmp_path_factory: pytest.TempPathFactory) -> Path:
    pytest.importorskip("matplotlib")
    pytest.importorskip("jinja2")
    from culbuto.report.page import write_page  # noqa: PLC0415

    folder = tmp_path_factory.mktemp("report")
    write_page(results, folder)
    return folder


def test_errors_are_the_same_bits_every_time(results: Results) -> None:
    again = measure([find(name) for name in NAMES], quick=True)

    def key(row: Row) -> tuple[object, ...]:
        return (row.scene, row.method, row.step, row.tolerance, row.error, row.energy, row.steps)

    assert list(map(key, results.rows)) == list(map(key, again.rows))
    assert {row.scene for row in results.rows} == {"projectile", "kepler"}


def test_noise_is_how_far_timed_runs_of_a_row_are_apart(results: Results) -> None:
    from culbuto.report.page import noise  # noqa: PLC0415

    assert noise(results.rows) is None  # each was timed once
    assert spread_of([1.0, 2.0, 4.0, 8.0, 16.0]) == 6 / 4
    row = results.rows[0]
    rows = [replace(row, spread=k / 100) for k in range(1, 22)]
    assert noise(rows) == pytest.approx((0.11, 0.20))
    timed = study("S1", steps=[0.1], tolerances=[], methods=["leapfrog"], repeats=5)
    assert timed.rows[0].spread > 0


def test_rows_and_page_say_how_far_the_reference_may_be_off(results: Results, page: Path) -> None:
    text = (page / "index.html").read_text("utf-8")
    for result in results.scenes:
        assert result.scene.reference in text
        assert result.scene.uncertainty < 1e-13
    for row in results.rows:
        assert row.uncertainty == find(row.scene).uncertainty > 0
    assert find("falling_rod").uncertainty > find("kepler").uncertainty
    assert find("random_bins").uncertainty == 0


@pytest.mark.parametrize(
    ("value", "text"),
    [
        (None, "–"),
        (0.0, "0"),
        (float("inf"), "∞"),
        (9.96, "10"),
        (0.25, "0.25"),
        (2.31e-5, "2.3·10⁻⁵"),
        (9.99e-7, "10⁻⁶"),
        (5e-324, "4.9·10⁻³²⁴"),
    ],
)
def test_numbers_of_any_size(value: float | None, text: str) -> None:
    pytest.importorskip("jinja2")
    from culbuto.report.page import number  # noqa: PLC0415

    assert number(value) == text


def test_rows_are_read_back(results: Results, tmp_path: Path) -> None:
    table, data = write_rows(results, tmp_path)
    with table.open(encoding="utf-8") as file:
        lines = list(csv.DictReader(file))
    rows = json.loads(data.read_text("utf-8"))["rows"]
    assert len(lines) == len(rows) == len(results.rows)
    for line, entry, row in zip(lines, rows, results.rows, strict=True):
        assert Row.of(entry) == row
        assert float(line["error"]) == row.error
        assert line["method"] == row.method


class Elements(HTMLParser):
    """Checks that what is opened is closed, in order, and keeps ids and addresses."""

    def __init__(self) -> None:
        super().__init__()
        self.open: list[str] = []
        self.ids: list[str] = []
        self.addresses: list[str] = []

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        if tag not in VOID:
            self.open.append(tag)
        self.note(attrs)

    def handle_startendtag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:  # noqa: ARG002
        self.note(attrs)

    def handle_endtag(self, tag: str) -> None:
        assert self.open.pop() == tag

    def note(self, attrs: list[tuple[str, Any]]) -> None:
        for name, value in attrs:
            if name == "id":
                self.ids.append(value)
            if name in {"href", "src", "xlink:href"}:
                self.addresses.append(value)


def test_the_page_stands_by_itself(page: Path) -> None:
    text = (page / "index.html").read_text("utf-8")
    elements = Elements()
    elements.feed(text)
    assert elements.open == []
    assert len(elements.ids) == len(set(elements.ids))
    assert all(address.startswith("#") for address in elements.addresses)
    assert {address[1:] for address in elements.addresses} <= set(elements.ids)
    assert "http" not in text
    assert "@import" not in text
    assert not re.search(r"url\((?!#)", text)


def test_the_page_has_every_scene_and_method(page: Path) -> None:
    text = unescape((page / "index.html").read_text("utf-8"))
    for name in NAMES:
        assert f'<section id="{name}">' in text
        assert find(name).title in text
    for method in culbuto.methods():
        assert f"var(--{method.name.replace('_', '-')})" in text
    # Four panels of the thrown ball, and a drawing and two figures for each motion.
    assert text.count('role="img"') == 4 + 2 * 3


def test_every_colour_is_one_for_light_and_one_for_dark(page: Path) -> None:
    text = (page / "index.html").read_text("utf-8")
    body = text[text.index("<body>") :]
    assert not re.search(r"(fill|stroke): #(?!ffffff)[0-9a-f]{6}", body)
    for name in set(re.findall(r"var\((--[a-z0-9-]+)\)", text)):
        assert text.count(f"{name}:") == 2, name


def test_the_first_figure_is_a_file_of_its_own(page: Path) -> None:
    path = page / "figures/thrown-ball.svg"
    text = path.read_text("utf-8")
    ET.fromstring(text)  # noqa: S314 — our own
    assert "prefers-color-scheme: dark" in text
    assert "<text" in text  # letters stay letters


def test_the_page_says_what_ten_scenes_and_each_absent_feature_cost(
    results: Results, page: Path
) -> None:
    assert len(results.needs) == 10
    for need in results.needs:
        counted = need.counted
        assert counted is not None, f"{need.scene} was not counted: make needs"
        assert list(counted.stages) == list(need.stages)
        assert sum(counted.stages.values()) < 2 * counted.step
        full = counted.everything
        assert full is not None
        assert full.step > counted.step
        assert full.bytes > counted.bytes
    text = (page / "index.html").read_text("utf-8")
    found = counts()
    assert found.versions in unescape(text)
    assert {one.feature for one in found.features} >= {
        "air",
        "contact",
        "joint",
        "fluid",
        "sleeping",
    }
    for one in found.features:
        assert one.feature in text
        assert one.had == pytest.approx(one.never, rel=2e-3), "a feature that is absent costs"
        assert one.there > one.never or one.feature == "sleeping"

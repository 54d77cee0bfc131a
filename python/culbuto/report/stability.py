"""Where engines fall: the matrix of hard scenes, by Culbuto and by other engines."""

from __future__ import annotations

import csv
import json
from collections.abc import Sequence
from dataclasses import dataclass
from statistics import median
from typing import TYPE_CHECKING, Any

from culbuto import _native, catalogue
from culbuto._json import dumps

if TYPE_CHECKING:
    from collections.abc import Iterable
    from pathlib import Path

OURS = "culbuto"

USUAL = 1 / 60  # s
AT_ONCE = "culbuto-newton"
LONGEST = 8  # times the usual size: a floor, which does not decide what is seen

Outline = Sequence[Sequence[float]]

# What is said of a scene that does what it should, by what the figure behind it is.
RIGHT = {
    "largest way over its size": "stands",
    "widest gap over a link": "holds",
    "bodies that passed": "stopped",
    "part of the spin that is lost": "keeps",
    "distance from the answer over the size": "arrives",
    "energy gained, relative": "calm",
    "overlap over the size": "parted",
    "numbers that differ": "the same",
}
# What is said of one that does not, where the usual word would be odd.
ODD = {
    ("bodies that passed", "falls"): "pass",
    ("part of the spin that is lost", "falls"): "slows",
    ("part of the spin that is lost", "creeps"): "slows",
    ("distance from the answer over the size", "creeps"): "off",
    ("distance from the answer over the size", "falls"): "far off",
    ("energy gained, relative", "creeps"): "gains",
    ("energy gained, relative", "falls"): "sinks",
    ("overlap over the size", "creeps"): "overlaps",
    ("overlap over the size", "falls"): "overlaps",
    ("numbers that differ", "falls"): "differs",
}
WRONG = {
    "creeps": "creeps",
    "falls": "falls",
    "explodes": "explodes",
    "nan": "NaN",
    "refuses": "refuses",
}


@dataclass(frozen=True)
class Cell:
    """How a scene ends by an engine at the usual step; `largest_step` (s) at which it is right."""

    engine: str
    word: str
    good: bool
    figure: float | None
    largest_step: float | None
    picture: str


@dataclass(frozen=True)
class Line:
    """A scene, what is measured of it, and how it ends by each engine.

    `left_out` says why other engines cannot have it; `runs` are all runs as they were measured,
    and `seconds` None where the scene is no motion.
    """

    id: str
    name: str
    about: str
    figure: str
    seconds: float | None
    cells: tuple[Cell, ...]
    left_out: str | None = None
    runs: tuple[dict[str, Any], ...] = ()

    def cell(self, engine: str) -> Cell | None:
        """How it ends by an engine; None where there is no such run."""
        return next((cell for cell in self.cells if cell.engine == engine), None)


def engines(lines: Iterable[Line]) -> list[str]:
    """Names of the engines, in the order in which they come up."""
    return list(dict.fromkeys(cell.engine for line in lines for cell in line.cells))


def hard_scenes(chosen: Sequence[str] = ()) -> list[str]:
    """Names of the hard scenes with these names or numbers of the catalogue; all, without any.

    `ValueError` for a name that is none.
    """
    known = _native.hard_scenes()
    wanted = [name.casefold() for name in chosen]
    for name in wanted:
        if not any(name in (number.casefold(), own.casefold()) for number, own in known):
            there = ", ".join(f"{own} ({number})" for number, own in known)
            message = f"hard scene is {name!r}; allowed: {there}"
            raise ValueError(message)
    return [
        name
        for number, name in known
        if not wanted or number.casefold() in wanted or name.casefold() in wanted
    ]


def own(name: str, *, quick: bool = False) -> Line:
    """How a hard scene ends by Culbuto's own solvers; `quick`: at the usual step only."""
    return line(json.loads(_native.stability_of(name, [1 / USUAL] if quick else [])))


def asked_of_culbuto(lines: Iterable[Line]) -> list[Line]:
    """The extremes of the catalogue that are no motion: what is asked of Culbuto alone."""
    there = {line.id for line in lines}
    left = [s for s in catalogue.scenes() if s.id[0] == "X" and s.id.rstrip("j") not in there]
    return [_asked(scene) for scene in left]


def _asked(scene: catalogue.Scene) -> Line:
    verdict = catalogue.verify(scene.name)
    failed = sum(not check.passed for check in verdict.checks)
    word = "as asked" if verdict.passed else "not as asked"
    cell = Cell(OURS, word, verdict.passed, failed, None, "")
    figure = f"of {len(verdict.checks)} numbers that are asked, those that are missed"
    why = "not a motion: asked of Culbuto alone"
    return Line(scene.id, scene.title, scene.about, figure, None, (cell,), why)


def line(entry: dict[str, Any]) -> Line:
    """A line of what was measured, here or by the runner of other engines."""
    runs = entry["cells"]
    drawn = {run["engine"]: run["picture"] for run in runs if run["picture"]}
    view = _view(drawn.get(AT_ONCE) or next(iter(drawn.values()), []))
    made = (
        _cell([run for run in runs if run["engine"] == engine], entry["figure"], view)
        for engine in dict.fromkeys(run["engine"] for run in runs)
    )
    names = ("id", "name", "about", "figure", "seconds")
    bare = tuple({**run, "picture": None} for run in runs)
    said = {name: entry[name] for name in names}
    return Line(**said, cells=tuple(made), left_out=entry["left_out"], runs=bare)


def write_rows(lines: Iterable[Line], folder: Path) -> list[Path]:
    """Writes stability.csv and stability.json: every run of every line."""
    folder.mkdir(parents=True, exist_ok=True)
    table, data = folder / "stability.csv", folder / "stability.json"
    names = ("engine", "step", "verdict", "figure")
    rows = [
        {"id": line.id, "scene": line.name, **{name: run[name] for name in names}}
        for line in lines
        for run in line.runs
    ]
    with table.open("w", newline="", encoding="utf-8") as file:
        writer = csv.DictWriter(file, ("id", "scene", *names))
        writer.writeheader()
        writer.writerows(rows)
    data.write_text(dumps(rows), "utf-8")
    return [table, data]


def _cell(runs: list[dict[str, Any]], figure: str, view: Sequence[float]) -> Cell:
    # Scenes of another size than a metre have steps by the root of it: the middle one is meant.
    steps = sorted(runs, key=lambda run: run["step"])
    usual = next((run for run in steps if run["picture"]), steps[len(steps) // 2])
    good = usual["verdict"] == "right"
    wrong = usual["verdict"]
    word = RIGHT[figure] if good else ODD.get((figure, wrong)) or WRONG[wrong]
    # The largest step from which on all finer ones are right as well.
    largest = None
    for run in steps:
        if run["verdict"] != "right":
            break
        largest = run["step"]
    picture = _picture(usual["picture"] or [], view)
    return Cell(usual["engine"], word, good, usual["figure"], largest, picture)


def _box(outline: Outline) -> tuple[float, float, float, float]:
    xs, ys = zip(*outline, strict=True)
    return min(xs), min(ys), max(xs), max(ys)


def _view(outlines: Sequence[Outline]) -> tuple[float, float, float, float]:
    """What is seen: all of a usual size, and as much again around. x, y, width, height."""
    boxes = [_box(outline) for outline in outlines]
    if not boxes:
        return 0.0, 0.0, 1.0, 1.0
    usual = median(max(box[2] - box[0], box[3] - box[1]) for box in boxes)
    near = [b for b in boxes if max(b[2] - b[0], b[3] - b[1]) <= LONGEST * usual] or boxes
    low = [min(box[k] for box in near) for k in (0, 1)]
    high = [max(box[k] for box in near) for k in (2, 3)]
    size = max(high[k] - low[k] for k in (0, 1)) * 1.3
    x, y = (0.5 * (low[k] + high[k]) - 0.5 * size for k in (0, 1))
    return x, y, size, size


def _picture(outlines: Sequence[Outline], view: Sequence[float]) -> str:
    """Outlines in a view of 100 units, as an SVG to stand in a page."""
    x, y, width, height = view
    parts = []
    for outline in outlines:
        low_x, low_y, high_x, high_y = _box(outline)
        if high_x < x or low_x > x + width or high_y < y or low_y > y + height:
            continue
        points = " ".join(
            f"{_within(100 * (px - x) / width):.1f},{_within(100 - 100 * (py - y) / height):.1f}"
            for px, py in outline
        )
        parts.append(f'<polygon points="{points}"/>')
    return f'<svg class="end" viewBox="0 0 100 100" aria-hidden="true">{"".join(parts)}</svg>'


def _within(number: float) -> float:
    return min(max(number, -1e4), 1e4)

"""Where engines fall: the matrix of hard scenes, as benches/peers ran them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from statistics import median
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from collections.abc import Iterable

USUAL = 1 / 60  # s
OURS_AT_ONCE = "culbuto-newton"
LONGEST = 8  # times the usual size: a floor, which does not decide what is seen

Outline = Sequence[Sequence[float]]

# What is said of a scene that does what it should, by what the figure behind it is.
RIGHT = {
    "largest way over its size": "stands",
    "widest gap over a link": "holds",
    "bodies that passed": "stopped",
    "part of the spin that is lost": "keeps",
}
# What is said of one that does not, where "falls" would be odd.
FALLS = {"bodies that passed": "pass", "part of the spin that is lost": "slows"}
WRONG = {"creeps": "creeps", "falls": "falls", "explodes": "explodes", "nan": "NaN"}


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
    """A scene, what is measured of it, and how it ends by each engine."""

    name: str
    about: str
    figure: str
    seconds: float
    cells: tuple[Cell, ...]


def matrix(found: dict[str, Any]) -> tuple[Line, ...]:
    """The lines of what the runner wrote."""
    return tuple(_line(entry, found["cells"]) for entry in found["scenes"])


def _line(entry: dict[str, Any], cells: Iterable[dict[str, Any]]) -> Line:
    own = [cell for cell in cells if cell["scene"] == entry["name"]]
    engines = dict.fromkeys(cell["engine"] for cell in own)
    drawn = {cell["engine"]: cell["picture"] for cell in own if cell["picture"]}
    view = _view(drawn.get(OURS_AT_ONCE) or next(iter(drawn.values()), []))
    made = (
        _cell([cell for cell in own if cell["engine"] == engine], entry["figure"], view)
        for engine in engines
    )
    return Line(entry["name"], entry["about"], entry["figure"], entry["seconds"], tuple(made))


def _cell(runs: list[dict[str, Any]], figure: str, view: Sequence[float]) -> Cell:
    usual = min(runs, key=lambda run: abs(run["step"] - USUAL))
    good = usual["verdict"] == "right"
    wrong = {**WRONG, "falls": FALLS.get(figure, "falls")}
    word = RIGHT[figure] if good else wrong[usual["verdict"]]
    # The largest step from which on all finer ones are right as well.
    largest = None
    for run in sorted(runs, key=lambda run: run["step"]):
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

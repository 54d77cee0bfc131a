"""The tables of docs/accuracy.md: `accuracy.py DATA PAGE [ROWS]`.

With ROWS, the rows.json of a report, what the tables need of it is written to DATA first (`make
accuracy`). The tables stand between two comments in PAGE.
"""

import json
import sys
from datetime import date
from pathlib import Path
from typing import Any

BEGIN, END = "<!-- tables: make accuracy -->\n", "<!-- end of tables -->"
TARGETS = ("1e-2", "1e-4", "1e-8")

Entry = dict[str, Any]


def kept(report: Entry) -> Entry:
    """What the tables need of a report."""
    motions = [scene for scene in report["scenes"] if scene["duration"] is not None]
    return {
        **{name: report[name] for name in ("machine", "versions", "repeats")},
        "date": date.today().isoformat(),
        "scenes": [kept_scene(scene, report["rows"]) for scene in motions],
    }


def kept_scene(scene: Entry, rows: list[Entry]) -> Entry:
    """Errors as the engine comes, orders of methods, and the least times."""
    own = [row for row in rows if row["scene"] == scene["name"] and row["error"] is not None]
    errors = [check for check in scene["checks"] if check["what"].startswith("error, ")]
    return {
        **{name: scene[name] for name in ("id", "name", "dt", "tolerance", "uncertainty")},
        "errors": {check["column"]: [check["measured"], check["asked"]] for check in errors},
        "orders": {
            method["method"]: [method["order_stated"], method["order_measured"], method["exact"]]
            for method in scene["methods"]
        },
        "quickest": {target: quickest(own, float(target)) for target in TARGETS},
    }


def quickest(rows: list[Entry], target: float) -> list[Any] | None:
    """Seconds for each simulated second, and the method, of the quickest row within an error."""
    good = [row for row in rows if row["error"] <= target]
    best = min(good, key=lambda row: row["seconds_per_second"], default=None)
    return best and [best["seconds_per_second"], best["method"]]


def tables(data: Entry) -> str:
    """The tables in Markdown."""
    said = f"{data['versions']}; {data['machine']}; {data['date']}; `make accuracy`."
    return "\n\n".join([said, methods(data["scenes"]), errors(data["scenes"]), times(data)]) + "\n"


def table(head: list[str], lines: list[list[str]]) -> str:
    """A table whose first column is text and the others numbers."""
    rule = ["---", *["---:"] * (len(head) - 1)]
    return "\n".join("| " + " | ".join(line) + " |" for line in [head, rule, *lines])


def methods(scenes: list[Entry]) -> str:
    """Orders by method."""
    found: dict[str, list[list[Any]]] = {}
    for scene in scenes:
        for name, order in scene["orders"].items():
            found.setdefault(name, []).append(order)
    lines = []
    for name, orders in found.items():
        slopes = [slope for _, slope, _ in orders if slope is not None]
        span = f"{min(slopes):.2f} to {max(slopes):.2f}" if slopes else "–"
        exact = sum(is_exact for *_, is_exact in orders)
        lines.append([name, str(orders[0][0]), span, str(len(slopes)), str(exact)])
    return table(["method", "order stated", "measured", "on scenes", "exact on"], lines)


def errors(scenes: list[Entry]) -> str:
    """The engine as it comes, at each scene's fixed step and tolerance."""

    def cells(scene: Entry, column: str) -> list[str]:
        measured, asked = scene["errors"].get(column, (None, None))
        return [number(measured), number(asked)]

    def line(scene: Entry) -> list[str]:
        name, off = f"{scene['id']} {scene['name']}", number(scene["uncertainty"])
        return [name, *cells(scene, "fixed"), *cells(scene, "tolerance"), off]

    lines = [line(scene) for scene in scenes]
    head = ["scene", "fixed step", "asked", "tolerance", "asked", "the answer is off by"]
    return table(head, lines)


def times(data: Entry) -> str:
    """The least time for each simulated second below an error."""

    def cell(best: list[Any] | None) -> str:
        return "–" if best is None else f"{best[0] * 1e6:.3g} µs {best[1]}"

    lines = [
        [f"{s['id']} {s['name']}", *(cell(s["quickest"][target]) for target in TARGETS)]
        for s in data["scenes"]
    ]
    said = f"Least wall time for each simulated second below an error, median of {data['repeats']}."
    return f"{said}\n\n{table(['scene', *TARGETS], lines)}"


def number(value: float | None) -> str:
    """Two digits."""
    return "–" if value is None else "0" if value == 0 else f"{value:.1e}"


def page(text: str, data: Entry) -> str:
    """The page with the tables of a run."""
    before, _, rest = text.partition(BEGIN)
    return before + BEGIN + "\n" + tables(data) + "\n" + END + rest.partition(END)[2]


def main(data: Path, target: Path, rows: Path | None = None) -> None:
    """Writes the tables, after the data where there are rows."""
    if rows is not None:
        found = kept(json.loads(rows.read_text("utf-8")))
        data.write_text(json.dumps(found, indent=1, ensure_ascii=False) + "\n", "utf-8")
    found = json.loads(data.read_text("utf-8"))
    target.write_text(page(target.read_text("utf-8"), found), "utf-8")


if __name__ == "__main__":
    main(*map(Path, sys.argv[1:]))

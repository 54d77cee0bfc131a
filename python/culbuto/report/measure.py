"""What the report measures: verdicts and rows of error against run time."""

from __future__ import annotations

import csv
import os
import platform
from dataclasses import asdict, dataclass, fields
from pathlib import Path
from typing import TYPE_CHECKING

import culbuto
from culbuto import catalogue
from culbuto._json import dumps
from culbuto.report.needs import Need, needs
from culbuto.report.stability import asked_of_culbuto, hard_scenes, own
from culbuto.study import Row, Study, study

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from culbuto.catalogue import Scene, Verdict
    from culbuto.report.peers import Peers
    from culbuto.report.stability import Line

THROWN = "projectile"
THROW_METHODS = ("explicit_euler", "semi_implicit_euler", "leapfrog")
TICKS = (5, 10, 20, 60)
FINER_TICKS = (240, 1000, 4000, 16000)
REPEATS = 9  # timed runs of a row, of which the median counts


@dataclass(frozen=True)
class SceneResult:
    """A scene, what came of it, and its rows; no study where the answer is numbers."""

    scene: Scene
    verdict: Verdict
    study: Study | None


@dataclass(frozen=True)
class Results:
    """Everything the report shows.

    `throw` is the thrown ball at several ticks a second, None where only the matrix is asked for.
    """

    scenes: tuple[SceneResult, ...]
    throw: Study | None
    machine: str
    repeats: int
    needs: tuple[Need, ...] = ()
    peers: Peers | None = None
    stability: tuple[Line, ...] = ()

    @property
    def rows(self) -> list[Row]:
        """The rows of all scenes."""
        return [row for result in self.scenes if result.study for row in result.study.rows]


def measure(
    scenes: Sequence[Scene],
    *,
    quick: bool = False,
    done: Callable[[Scene], object] = lambda _: None,
) -> Results:
    """Runs the scenes, one after the other on one thread. `quick`: few steps, each timed once."""
    results = []
    for scene in scenes:
        found = _study(scene, quick=quick) if scene.has_motion else None
        results.append(SceneResult(scene, catalogue.verify(scene.name), found))
        done(scene)
    ticks = TICKS if quick else TICKS + FINER_TICKS
    throw = study(
        THROWN,
        steps=[1 / tick for tick in ticks],
        tolerances=[],
        methods=THROW_METHODS,
        repeats=1 if quick else REPEATS,
    )
    return Results(tuple(results), throw, machine(), 1 if quick else REPEATS, tuple(needs()))


def matrix(
    names: Sequence[str] = (),
    *,
    peers: Peers | None = None,
    quick: bool = False,
    done: Callable[[str], object] = lambda _: None,
) -> Results:
    """The hard scenes of these names or numbers (all, without any) by Culbuto's solvers.

    Those that `peers` have were run with the other engines and are not run again. `quick`: at
    one step only.
    """
    there = {} if peers is None else {line.name: line for line in peers.stability}
    lines = []
    for name in hard_scenes(names):
        lines.append(there.get(name) or own(name, quick=quick))
        done(name)
    if not names:
        lines += asked_of_culbuto(lines)
    return Results((), None, machine(), 1, peers=peers, stability=tuple(lines))


def _study(scene: Scene, *, quick: bool) -> Study:
    if not quick:
        return study(scene.name, repeats=REPEATS)
    steps = [(scene.duration or 1.0) / 2**k for k in range(4, 9)]
    return study(scene.name, steps=steps, tolerances=[1e-4, 1e-8], repeats=1)


def machine() -> str:
    """What the times were measured on."""
    system = f"{platform.system()}, {platform.machine()}"
    return f"{_processor()}, {os.cpu_count()} threads (one used) · {system}"


def _processor() -> str:
    info = Path("/proc/cpuinfo")
    if info.is_file():
        for line in info.read_text(encoding="utf-8").splitlines():
            if line.startswith("model name"):
                return line.partition(":")[2].strip()
    return platform.processor() or "unknown processor"


def versions() -> str:
    """What ran."""
    return f"Culbuto {culbuto.__version__} · Python {platform.python_version()}"


def write_rows(results: Results, folder: Path) -> list[Path]:
    """Writes rows.csv and rows.json, which also has the scenes and what was asked of them.

    Numbers are read back bit for bit.
    """
    folder.mkdir(parents=True, exist_ok=True)
    table, data = folder / "rows.csv", folder / "rows.json"
    with table.open("w", newline="", encoding="utf-8") as file:
        lines = csv.DictWriter(file, [field.name for field in fields(Row)])
        lines.writeheader()
        lines.writerows(asdict(row) for row in results.rows)
    said = {"versions": versions(), "machine": results.machine, "repeats": results.repeats}
    peers = results.peers
    others = [] if peers is None else [asdict(row) for row in peers.rows]
    said = {**said, "peers": [] if peers is None else list(peers.versions)}
    rows = [asdict(row) for row in results.rows]
    scenes = [{**asdict(r.scene), **asdict(r.verdict)} for r in results.scenes]
    all_of_it = {**said, "scenes": scenes, "rows": rows, "rows_of_peers": others}
    data.write_text(dumps(all_of_it), "utf-8")
    return [table, data]

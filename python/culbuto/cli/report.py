"""`culbuto report`."""

from __future__ import annotations

from dataclasses import replace
from importlib.util import find_spec
from pathlib import Path

import click
from rich.text import Text

from culbuto import catalogue
from culbuto.cli.output import console, progress
from culbuto.report import stability as hard
from culbuto.report.measure import Results, matrix, measure, write_rows
from culbuto.report.peers import Peers

NEEDED = ("matplotlib", "jinja2")


@click.command()
@click.argument("scenes", nargs=-1, metavar="[SCENE]...")
@click.option(
    "--output",
    type=click.Path(path_type=Path, file_okay=False),
    default=Path("report"),
    show_default=True,
    help="Folder to write to.",
)
@click.option(
    "--peers",
    type=click.Path(path_type=Path, dir_okay=False, exists=True),
    help="What benches/peers measured of other engines: see `make report-peers`.",
)
@click.option("--quick", is_flag=True, help="Few steps, each timed once: to try it out.")
@click.option(
    "--stability",
    is_flag=True,
    help="Only where engines fall: hard scenes at several steps, and how they end.",
)
def report(
    scenes: tuple[str, ...], *, output: Path, peers: Path | None, quick: bool, stability: bool
) -> None:
    """Measure error against run time, of all scenes or of those given, and write a page of it.

    Writes rows and stability as .csv and .json, index.html and figures/thrown-ball.svg.
    Without SCENE the page also shows how hard scenes end; with --stability nothing else.
    """
    others = None if peers is None else Peers.read(peers)
    written: list[Path] = []
    results = None if stability else _measured(scenes, others, quick=quick)
    if results is not None:
        written += write_rows(results, output)
    if stability or not scenes:
        found = _matrix(scenes, others, quick=quick)
        results = found if results is None else replace(results, stability=found.stability)
        written += hard.write_rows(found.stability, output)
    missing = [name for name in NEEDED if find_spec(name) is None]
    if results is not None and not missing:
        from culbuto.report.page import write_page  # noqa: PLC0415 — needs what may be missing

        written += write_page(results, output)
    for path in written:
        console().print(Text(f"wrote {path}"), soft_wrap=True)
    if missing:
        hint = f"no page without {' and '.join(missing)}: pip install 'culbuto[plot]'"
        console(stderr=True).print(Text(hint), soft_wrap=True)


def _measured(names: tuple[str, ...], others: Peers | None, *, quick: bool) -> Results:
    chosen = [catalogue.find(name) for name in names] or catalogue.scenes()
    with progress() as bar:
        task = bar.add_task("measuring", total=len(chosen))
        results = measure(chosen, quick=quick, done=lambda _: bar.advance(task))
    return replace(results, peers=others)


def _matrix(names: tuple[str, ...], others: Peers | None, *, quick: bool) -> Results:
    with progress() as bar:
        task = bar.add_task("hard scenes", total=len(hard.hard_scenes(names)))
        return matrix(names, peers=others, quick=quick, done=lambda _: bar.advance(task))

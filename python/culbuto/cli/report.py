"""`culbuto report`."""

from __future__ import annotations

from dataclasses import replace
from importlib.util import find_spec
from pathlib import Path

import click
from rich.text import Text

from culbuto import catalogue
from culbuto.cli.output import console, progress
from culbuto.report.measure import measure, write_rows
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
def report(scenes: tuple[str, ...], *, output: Path, peers: Path | None, quick: bool) -> None:
    """Measure error against run time, of all scenes or of those given, and write a page of it.

    Writes rows.csv, rows.json, index.html and figures/thrown-ball.svg.
    """
    others = None if peers is None else Peers.read(peers)
    chosen = [catalogue.find(name) for name in scenes] or catalogue.scenes()
    with progress() as bar:
        task = bar.add_task("measuring", total=len(chosen))
        results = measure(chosen, quick=quick, done=lambda _: bar.advance(task))
    results = replace(results, peers=others)
    written = write_rows(results, output)
    missing = [name for name in NEEDED if find_spec(name) is None]
    if not missing:
        from culbuto.report.page import write_page  # noqa: PLC0415 — needs what may be missing

        written += write_page(results, output)
    for path in written:
        console().print(Text(f"wrote {path}"), soft_wrap=True)
    if missing:
        hint = f"no page without {' and '.join(missing)}: pip install 'culbuto[plot]'"
        console(stderr=True).print(Text(hint), soft_wrap=True)

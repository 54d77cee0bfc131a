"""What the commands print with: tables on stdout, progress on stderr, numbers of few digits."""

from __future__ import annotations

import math
from contextlib import contextmanager
from typing import TYPE_CHECKING

from rich import box
from rich.console import Console
from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeElapsedColumn
from rich.table import Table

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator


def console(*, stderr: bool = False) -> Console:
    """A console; made when it is needed, so that it writes to the stdout of that moment."""
    return Console(stderr=stderr, highlight=False)


def table(*columns: str, right: Iterable[str] = (), title: str | None = None) -> Table:
    """An empty table whose columns named in `right` are aligned there."""
    made = Table(box=box.SIMPLE_HEAD, title=title, title_justify="left", pad_edge=False)
    numbers = set(right)
    for column in columns:
        made.add_column(column, justify="right" if column in numbers else "left")
    return made


def number(value: float | None) -> str:
    """Two digits of an error; a dash where there is none."""
    if value is None:
        return "–"
    if math.isinf(value):
        return "∞"
    return "0" if value == 0 else f"{value:.1e}"


def passed(ok: bool) -> str:
    """A verdict, coloured."""
    return "[green]pass[/]" if ok else "[bold red]FAIL[/]"


@contextmanager
def progress() -> Iterator[Progress]:
    """A progress bar on stderr that disappears when it is done."""
    columns = (
        TextColumn("{task.description}"),
        BarColumn(),
        MofNCompleteColumn(),
        TimeElapsedColumn(),
    )
    with Progress(*columns, console=console(stderr=True), transient=True) as bar:
        yield bar

"""`culbuto report`."""

from __future__ import annotations

import click


@click.command()
def report() -> None:
    """Measure error against run time and write it down."""

"""`culbuto scenes`."""

from __future__ import annotations

import click

from culbuto import catalogue
from culbuto.cli.output import console, table


@click.command()
def scenes() -> None:
    """List the scenes whose answer is known."""
    listed = table("id", "name", "what it is", "duration (s)", right=["duration (s)"])
    for scene in catalogue.scenes():
        duration = "numbers" if scene.duration is None else f"{scene.duration:.4g}"
        listed.add_row(scene.id, scene.name, scene.title, duration)
    console().print(listed)

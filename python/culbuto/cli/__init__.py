"""The `culbuto` command: one file for each of its commands."""

from __future__ import annotations

import click

import culbuto
from culbuto.cli.report import report
from culbuto.cli.run import run
from culbuto.cli.scenes import scenes
from culbuto.cli.verify import verify


class BadInput(click.ClickException):
    """What a command was given is not what it takes."""

    exit_code = 2


class Commands(click.Group):
    """Commands that say in a line what was wrong with what they were given."""

    def invoke(self, ctx: click.Context) -> object:
        """Runs the command: status 2 for bad input, 1 for a motion that cannot go on."""
        try:
            return super().invoke(ctx)
        except culbuto.SimulationError as error:
            raise click.ClickException(str(error)) from error
        except (ValueError, OSError) as error:
            raise BadInput(str(error)) from error


@click.group(cls=Commands, context_settings={"help_option_names": ["-h", "--help"]})
@click.version_option(culbuto.__version__, prog_name="culbuto")
def main() -> None:
    """Two-dimensional physics in double precision that says how wrong it is."""


for command in (scenes, run, verify, report):
    main.add_command(command)

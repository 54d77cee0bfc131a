"""The `culbuto` command."""

import click

import culbuto


@click.group(context_settings={"help_option_names": ["-h", "--help"]})
@click.version_option(culbuto.__version__, prog_name="culbuto")
def main() -> None:
    """Two-dimensional physics in double precision that says how wrong it is."""

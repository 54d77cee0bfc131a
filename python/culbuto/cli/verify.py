"""`culbuto verify`."""

from __future__ import annotations

import sys
from dataclasses import asdict, fields
from typing import Any

import click

from culbuto import catalogue
from culbuto._json import dumps
from culbuto.catalogue import Laws, Limits, MethodCheck, Verdict
from culbuto.cli.output import console, number, passed, progress, table
from culbuto.cli.source import is_file, open_source

Json = dict[str, Any]


@click.command()
@click.argument("scenes", nargs=-1, metavar="[SCENE|FILE]...")
@click.option("--json", "as_json", is_flag=True, help="Print JSON, and nothing else, on stdout.")
@click.option("--laws", is_flag=True, help="Measure conservation laws instead of answers.")
@click.option("--dt", type=float, help="With --laws: fixed step (s).")
@click.option("--duration", type=float, help="With --laws: world time (s).")
@click.option("--method", "methods", multiple=True, help="With --laws: method; may be repeated.")
@click.option("--energy", type=float, help="With --laws: deviation allowed, relative [0.001].")
@click.option("--momentum", type=float, help="The same of momentum [1e-9].")
@click.option("--angular-momentum", type=float, help="The same of angular momentum [1e-9].")
@click.option("--third-law", type=float, help="The same of Newton's third law [1e-12].")
def verify(scenes: tuple[str, ...], *, as_json: bool, laws: bool, **options: Any) -> None:  # noqa: ANN401
    """Check scenes of the catalogue against their answers; all of them by default.

    With --laws, check the conservation laws on any scenes, files of your own included. The status
    is 1 if anything fails.
    """
    if laws:
        ok = _verify_laws(scenes, options, as_json=as_json)
    else:
        ok = _verify_answers(scenes, options, as_json=as_json)
    sys.exit(0 if ok else 1)


def _verify_answers(names: tuple[str, ...], options: Json, *, as_json: bool) -> bool:
    if any(value not in (None, ()) for value in options.values()):
        message = "--dt, --duration, --method and limits go with --laws"
        raise click.UsageError(message)
    for name in names:
        if is_file(name):
            message = f"{name} is a file, which has no answer to be checked against; use --laws"
            raise click.UsageError(message)
    chosen = [catalogue.find(name) for name in names] or catalogue.scenes()
    with progress() as bar:
        tracked = bar.track(chosen, description="verifying")
        verdicts = [catalogue.verify(scene.name) for scene in tracked]
    if as_json:
        click.echo(dumps([asdict(verdict) for verdict in verdicts]))
    else:
        for verdict in verdicts:
            _print_verdict(verdict)
        _print_sum([verdict.passed for verdict in verdicts])
    return all(verdict.passed for verdict in verdicts)


def _print_verdict(verdict: Verdict) -> None:
    out = console()
    out.print(f"[bold]{verdict.id} {verdict.name}[/] · {verdict.title} · {passed(verdict.passed)}")
    asked = table("as it comes", "run", "measured", "asked", "", right=["measured", "asked"])
    for check in verdict.checks:
        cells = (check.what, check.column, number(check.measured), number(check.asked))
        asked.add_row(*cells, passed(check.passed))
    out.print(asked)
    if verdict.methods:
        numbers = ["error", "energy", "stated", "measured"]
        orders = table("by method", "error", "energy", "stated", "measured", "", right=numbers)
        for row in verdict.methods:
            cells = (row.method, number(row.error), number(row.energy), str(row.order_stated))
            orders.add_row(*cells, measured_order(row), passed(row.passed))
        out.print(orders)


def measured_order(row: MethodCheck) -> str:
    """Order of a method as it is printed."""
    if row.exact:
        return "exact"
    return "unclear" if row.order_measured is None else f"{row.order_measured:.2f}"


def _verify_laws(names: tuple[str, ...], options: Json, *, as_json: bool) -> bool:
    if not names:
        message = "--laws needs a scene: a file, or one of `culbuto scenes`"
        raise click.UsageError(message)
    limits = Limits(**{
        field.name: options[field.name]
        for field in fields(Limits)
        if options[field.name] is not None
    })  # fmt: skip
    found = [(name, laws) for name in names for laws in _laws_of(name, options, limits)]
    if as_json:
        click.echo(dumps([{"scene": name, **asdict(laws)} for name, laws in found]))
    else:
        for name, laws in found:
            _print_laws(name, laws)
        _print_sum([laws.passed for _, laws in found])
    return all(laws.passed for _, laws in found)


def _laws_of(name: str, options: Json, limits: Limits) -> list[Laws]:
    source = open_source(name)
    dt = source.dt if options["dt"] is None else options["dt"]
    duration = source.duration if options["duration"] is None else options["duration"]
    methods = options["methods"] or (source.world.method,)
    return [
        catalogue.verify_laws(
            source.world, method=method, dt=dt, duration=duration, limits=limits
        )
        for method in methods
    ]  # fmt: skip


def _print_laws(name: str, laws: Laws) -> None:
    out = console()
    out.print(f"[bold]{name}[/] by {laws.method} · {passed(laws.passed)}")
    rows = table("law", "measured", "allowed", "", "of what", right=["measured", "allowed"])
    for law in laws.laws:
        verdict = passed(law.passed) if law.measured is not None else "[dim]not here[/]"
        rows.add_row(law.name, number(law.measured), number(law.allowed), verdict, law.why)
    out.print(rows)


def _print_sum(results: list[bool]) -> None:
    failed = results.count(False)
    what = "[green]all pass[/]" if not failed else f"[bold red]{failed} of {len(results)} fail[/]"
    console().print(what)

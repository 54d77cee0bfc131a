"""`culbuto run`."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click
from rich.text import Text

from culbuto import _native
from culbuto._native import SceneFile
from culbuto.cli.output import console, number, progress, table
from culbuto.cli.source import Source, open_source
from culbuto.drawing import picture
from culbuto.recording import Recording, record_steps, record_to_tolerance

if TYPE_CHECKING:
    from culbuto._native import Energy, StepReport, Vec2, World


@click.command()
@click.argument("scene", metavar="SCENE|FILE")
@click.option("--dt", type=float, help="Fixed step (s); by default the scene's own.")
@click.option("--duration", type=float, help="World time to run (s); by default the scene's own.")
@click.option("--substeps", type=int, help="Into how many a step is divided [4].")
@click.option("--method", help="Method of fixed steps [leapfrog].")
@click.option("--tolerance", type=float, help="Run to this error instead of at a fixed step.")
@click.option("--output", type=click.Path(path_type=Path, file_okay=False), help="Write there.")
@click.option("--format", "form", type=click.Choice(["npz", "csv"]), default="npz")
@click.option("--picture", "draw", is_flag=True, help="Write a picture (SVG), too.")
@click.option("--save", type=click.Path(path_type=Path, dir_okay=False), help="Write a scene file.")
def run(scene: str, **options: Any) -> None:  # noqa: ANN401 — as click hands them
    """Run a scene of the catalogue, or a scene file, and say how well it went.

    The motion is written if --output is given, the picture if --picture is, and the scene as it
    begins, with the given step, duration and method, if --save is.
    """
    source = open_source(scene)
    _apply(source.world, options)
    source = _timed(source, options)
    duration = source.duration
    out = console()
    out.print(f"[bold]{source.name}[/] {source.title}".rstrip())
    out.print(Text(_plan(source.world, options["tolerance"]), style="dim"), soft_wrap=True)
    save: Path | None = options["save"]
    if save is not None:
        _scene_file(source).write(save)
    before = _state(source.world)
    recording = _record(source, options, duration)
    _print_report(recording)
    _print_laws(before, _state(source.world))
    if source.scene is not None:
        motion = recording.trajectory
        error = _native.scene_error(
            source.scene.name, motion.times, motion.positions, motion.angles
        )
        out.print(f"error against the exact answer: {number(error)} of {source.scene.length:g} m")
    if save is not None:
        out.print(Text(f"wrote {save}"), soft_wrap=True)
    for path in _write(source.name, recording, source.world, options):
        out.print(Text(f"wrote {path}"), soft_wrap=True)


def _above_zero(what: str, value: float) -> None:
    if not 0 < value < math.inf:
        message = f"--{what} is {value}; allowed: a finite number above 0"
        raise click.UsageError(message)


def _apply(world: World, options: dict[str, Any]) -> None:
    given = [name for name in ("dt", "substeps", "method") if options[name] is not None]
    if options["tolerance"] is not None and given:
        message = f"--tolerance chooses the steps itself; leave out --{given[0]}"
        raise click.UsageError(message)
    if options["method"] is not None:
        world.method = options["method"]
    if options["substeps"] is not None:
        world.substeps = options["substeps"]


def _timed(source: Source, options: dict[str, Any]) -> Source:
    """The source with the step and the duration that were asked for."""
    given = {name: options[name] for name in ("dt", "duration") if options[name] is not None}
    source = replace(source, **given)
    _above_zero("dt", source.dt)
    _above_zero("duration", source.duration)
    return source


def _scene_file(source: Source) -> SceneFile:
    return SceneFile.from_world(
        source.world, name=source.name, about=source.title, dt=source.dt, duration=source.duration
    )


def _plan(world: World, tolerance: float | None) -> str:
    """What runs."""
    plan = world.explain().rstrip()
    if tolerance is None:
        return plan
    return (
        f"{plan}\n  run      to a tolerance of {tolerance:g}: by DOP853 instead of {world.method}"
    )


def _record(source: Source, options: dict[str, Any], duration: float) -> Recording:
    if options["tolerance"] is not None:
        with console(stderr=True).status("running"):
            return record_to_tolerance(source.world, duration, options["tolerance"])
    steps = max(1, round(duration / source.dt))
    with progress() as bar:
        task = bar.add_task("running", total=steps)
        return record_steps(source.world, source.dt, steps, lambda n: bar.advance(task, n))


def _print_report(recording: Recording) -> None:
    report: StepReport = recording.report
    kept = len(recording.trajectory.times)
    parts = [
        f"{report.duration:.6g} s in {report.steps} steps of the method",
        f"{report.evaluations} force evaluations",
        f"{report.rejected} steps rejected" if report.rejected else "",
        f"smallest step {report.smallest_step:.3g} s" if report.evaluations else "",
        f"estimated error {number(report.estimate)}" if report.estimate is not None else "",
        f"{kept} moments kept",
    ]
    console().print(Text(" · ".join(filter(None, parts))), soft_wrap=True)


def _state(world: World) -> tuple[Energy, Vec2, float]:
    return world.energy, world.momentum, world.angular_momentum(world.center_of_mass)


def _print_laws(before: tuple[Energy, Vec2, float], after: tuple[Energy, Vec2, float]) -> None:
    """What is conserved, at start and end. Only the balance is so in every scene."""
    (energy0, momentum0, spin0), (energy1, momentum1, spin1) = before, after
    rows = table("", "start", "end", "change", right=["start", "end", "change"])
    quantities = [
        ("kinetic energy (J)", energy0.kinetic, energy1.kinetic),
        ("potential energy (J)", energy0.potential, energy1.potential),
        ("energy − work + dissipated (J)", energy0.balance, energy1.balance),
        ("momentum x (kg·m/s)", momentum0.x, momentum1.x),
        ("momentum y (kg·m/s)", momentum0.y, momentum1.y),
        ("angular momentum about the centre of mass (kg·m²/s)", spin0, spin1),
    ]
    for name, start, end in quantities:
        rows.add_row(name, f"{start + 0.0:.9g}", f"{end + 0.0:.9g}", number(end - start))
    console().print(rows)


def _write(name: str, recording: Recording, world: World, options: dict[str, Any]) -> list[Path]:
    stem = "".join(c if c.isalnum() or c in "-_" else "-" for c in name)
    folder: Path = options["output"] or Path()
    folder.mkdir(parents=True, exist_ok=True)
    written = []
    if options["output"] is not None:
        path = folder / f"{stem}.{options['form']}"
        save = recording.save_npz if options["form"] == "npz" else recording.save_csv
        save(path)
        written.append(path)
    if options["draw"]:
        path = folder / f"{stem}.svg"
        path.write_text(picture(world, recording.trajectory), encoding="utf-8")
        written.append(path)
    return written

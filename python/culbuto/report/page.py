"""The page: one file of HTML that needs nothing else."""

from __future__ import annotations

import math
import re
from datetime import date
from html import escape
from importlib.resources import files
from typing import TYPE_CHECKING, Any

import numpy as np

from culbuto import _native
from culbuto.drawing import picture
from culbuto.report import style
from culbuto.report.measure import Results, SceneResult, versions
from culbuto.report.needs import counts
from culbuto.report.stability import engines

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence
    from pathlib import Path

    from culbuto.catalogue import Check, MethodCheck, Scene, Verdict
    from culbuto.report.needs import Counts, Feature
    from culbuto.report.peers import Peers
    from culbuto.study import Row, Study

TARGETS = (1e-2, 1e-4, 1e-8)
PATH_POINTS = 200  # at most so many of a path are drawn, about


def number(value: float | None) -> str:
    """Two digits: 2.3·10⁻⁵."""
    if value is None:
        return "–"
    if math.isinf(value):
        return "∞"
    if value == 0:
        return "0"
    digits, _, exponent = f"{value:.1e}".partition("e")
    power = int(exponent)
    if -2 <= power <= 2:
        return f"{value:.2g}"
    raised = str(power).translate(str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹"))
    return f"10{raised}" if digits == "1.0" else f"{digits}·10{raised}"


def seconds(value: float) -> str:
    """A time in the unit that suits it."""
    for unit, size in (("s", 1.0), ("ms", 1e-3), ("µs", 1e-6)):
        if value >= size:
            return f"{value / size:.3g} {unit}"
    return f"{value / 1e-9:.3g} ns"


def whole(value: float) -> str:
    """A count in groups of three digits."""
    return f"{value:,.0f}".replace(",", "\u202f")


def size(value: int) -> str:
    """Bytes, in kilobytes where there are many."""
    return f"{value / 1000:.3g} kB" if value >= 1000 else f"{value} B"


def step(value: float) -> str:
    """A step (s): 1/60 s, or its digits where it is no part of a second."""
    parts = 1 / value
    whole = value < 1 and abs(parts - round(parts)) < 1e-6 * parts
    return f"1/{parts:.0f} s" if whole else seconds(value)


def quickest(study: Study, target: float) -> Row | None:
    """The row that takes the least time for an error of at most `target`."""
    good = [row for row in study.rows if row.error <= target]
    return min(good, key=lambda row: row.seconds_per_second, default=None)


def behind(scenes: Iterable[dict[str, Any]], peers: Peers) -> list[str]:
    """Where another engine takes less time for an error than we do, each with why."""
    found = []
    for scene in scenes:
        for target in TARGETS if scene["others"] else ():
            ours = quickest(scene["study"], target)
            other = peers.quickest(scene["scene"].name, target)
            if other is None or (ours and ours.seconds_per_second <= other.seconds_per_second):
                continue
            name = f"{scene['scene'].name.replace('_', ' ')} to {number(target)}: "
            if ours is None:
                why = f"only {label(other.engine)}; no run of ours comes so near"
            else:
                times = ours.seconds_per_second / other.seconds_per_second
                why = f"{label(other.engine)} {times:.2g} times quicker, at {step(other.step)}"
                why += f" where {label(ours.method)} takes {ours.steps} steps"
            found.append(name + why)
    return found


def order(row: MethodCheck) -> str:
    """The measured order of a method, as the page shows it."""
    if row.exact:
        return "exact"
    return "unclear" if row.order_measured is None else f"{row.order_measured:.2f}"


def worst(checks: Iterable[Check]) -> Check:
    """The check that comes nearest to what is asked, or fails most."""

    def share(check: Check) -> float:
        """Of what is asked; what asks for 0 is met or missed without a measure."""
        if check.asked == 0:
            return 0.0 if check.measured == 0 else math.inf
        return check.measured / check.asked

    return max(checks, key=share)


def noise(rows: Sequence[Row]) -> tuple[float, float] | None:
    """Spread of the timed runs of a row: of half of the rows, and of 95 % of them."""
    spreads = [row.spread for row in rows if row.spread > 0]
    if not spreads:
        return None
    half, most = np.percentile(spreads, (50, 95))
    return float(half), float(most)


def mark(method: str) -> str:
    """A method's mark in its colour, as a tiny SVG."""
    look = {**style.METHODS, **style.PEERS}.get(method)
    if look is None:
        return ""
    colour = f"var({style.css_name(method)})"
    return (
        '<svg class="mark" viewBox="-1.4 -1.4 2.8 2.8" aria-hidden="true">'
        f'<path d="{look.path}" style="fill: {colour}"/></svg>'
    )


def label(method: str) -> str:
    """A method's name for people."""
    looks = {**style.METHODS, **style.PEERS}
    return looks[method].label if method in looks else method


def write_page(results: Results, folder: Path) -> list[Path]:
    """Writes index.html and figures/thrown-ball.svg (needs matplotlib and jinja2)."""
    import jinja2  # noqa: PLC0415 — comes with an extra

    from culbuto.report import figures  # noqa: PLC0415 — matplotlib does, too

    template = files("culbuto.report").joinpath("page.html.j2").read_text("utf-8")
    environment = jinja2.Environment(
        autoescape=True, trim_blocks=True, lstrip_blocks=True, undefined=jinja2.StrictUndefined
    )
    helpers = (number, seconds, step, whole, size, quickest, behind, order, worst, mark, label)
    environment.globals.update({helper.__name__: helper for helper in helpers})
    panels = [
        style.inline(figure, f"throw{i}", "A thrown ball")
        for i, figure in enumerate(figures.throw_panels(results.throw) if results.throw else [])
    ]
    page = environment.from_string(template).render(
        results=results,
        versions=versions(),
        today=date.today().isoformat(),
        methods=_native.methods(),
        targets=TARGETS,
        panels=panels,
        scenes=[_scene(result, results.peers) for result in results.scenes],
        peers=results.peers,
        noise=noise(results.rows),
        matrix=results.stability,
        engines=engines(results.stability),
        **_counted(counts()),
        light=style.variables(dark=False),
        dark=style.variables(dark=True),
    )
    pictures = folder / "figures"
    pictures.mkdir(parents=True, exist_ok=True)
    index, throw = folder / "index.html", pictures / "thrown-ball.svg"
    index.write_text(page, "utf-8")
    if results.throw is None:
        return [index]
    title = "A thrown ball at several ticks a second, and error against run time"
    throw.write_text(style.standalone(figures.throw_figure(results.throw), title), "utf-8")
    return [index, throw]


def _counted(found: Counts) -> dict[str, Any]:
    """What was counted: features by name, and of each by world."""
    features: dict[str, dict[str, Feature]] = {}
    for one in found.features:
        features.setdefault(one.feature, {})[one.world] = one
    worlds = list(dict.fromkeys(one.world for one in found.features))
    return {"counts": found, "counted_features": features, "counted_worlds": worlds}


def drawing(scene: Scene) -> str:
    """The scene as it moves, from its start (faint) to its end, as an SVG to stand in a page."""
    world = scene.world()
    steps = max(1, round((scene.duration or 1.0) / (scene.dt or 1.0)))
    motion = world.record(
        (scene.duration or 1.0) / steps, steps, every=max(1, steps // PATH_POINTS)
    )
    text = re.sub(r' (xmlns="[^"]*"|width="\d+" height="\d+")', "", picture(world, motion))
    label = escape(f"{scene.title}: start, path and end", quote=True)
    return text.replace("<svg", f'<svg class="drawing" role="img" aria-label="{label}"', 1)


def _scene(result: SceneResult, peers: Peers | None) -> dict[str, Any]:
    """What the template needs of a scene."""
    drawn: list[str] = []
    if result.study is not None:
        from culbuto.report.figures import scene_figures  # noqa: PLC0415 — comes with an extra

        title = escape(result.scene.title, quote=True)
        names = (f"{result.scene.name}-time", f"{result.scene.name}-order")
        figures = scene_figures(result.study, peers)
        drawn = [style.inline(f, n, title) for f, n in zip(figures, names, strict=True)]
    as_it_comes = _as_it_comes(result.verdict)
    return {
        "drawing": drawing(result.scene) if result.study is not None else "",
        "others": [] if peers is None else peers.engines(result.scene.name),
        "result": result,
        "scene": result.scene,
        "verdict": result.verdict,
        "study": result.study,
        "figures": drawn,
        **as_it_comes,
    }


def _as_it_comes(verdict: Verdict) -> dict[str, Check | None]:
    """The engine's own error at the scene's fixed step, and with its tolerance."""
    errors = [check for check in verdict.checks if check.what.startswith("error, ")]
    found = {check.column: check for check in errors}
    return {"fixed": found.get("fixed"), "toleranced": found.get("tolerance")}

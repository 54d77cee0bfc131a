"""The figures, drawn with matplotlib."""

from __future__ import annotations

import math
from dataclasses import replace
from functools import partial
from itertools import groupby
from typing import TYPE_CHECKING

import matplotlib as mpl
import numpy as np
from matplotlib.figure import Figure
from matplotlib.layout_engine import ConstrainedLayoutEngine
from matplotlib.ticker import LogLocator, NullFormatter

from culbuto import _native
from culbuto.report.measure import THROW_METHODS, THROWN, TICKS
from culbuto.report.style import INK, LINE, METHODS, MUTED, PAPER, PEERS, RC, Look
from culbuto.study import Path, Row, Study, thrown_ball

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Sequence

    from matplotlib.axes import Axes

    from culbuto.report.peers import Peers

LEAST = 1e-17  # what is exact to the last bit is drawn there
MOST = 10.0  # beyond, nothing is drawn
ROUNDING = 1e-15
SMALL = 8  # points
# Of marks (points): explicit Euler looks out from under its twin, whose errors have the same size.
SIZES = {"closed_form": 11, "explicit_euler": 5.8}
RAISED = str.maketrans("123456789", "¹²³⁴⁵⁶⁷⁸⁹")
UNKNOWN = Look("", MUTED.light, MUTED.dark, ".", "")
TIME = "wall time per simulated second (s)"
ERROR = "error, relative"


def _look(method: str) -> Look:
    return METHODS.get(method) or replace(UNKNOWN, label=method)


def _drawn(error: float) -> float:
    return max(error, LEAST) if error <= MOST else math.nan


def _log_axes(ax: Axes) -> None:
    ax.set(xscale="log", yscale="log", ylim=(LEAST / 3, MOST))
    ax.yaxis.set_major_locator(LogLocator(numticks=20, base=1000.0))
    ax.xaxis.set_minor_formatter(NullFormatter())  # they would run into one another
    ax.axhspan(LEAST / 3, ROUNDING, color=LINE.light, alpha=0.45, linewidth=0)
    ax.text(
        0.995, LEAST / 2, "rounding", transform=ax.get_yaxis_transform(), ha="right", va="bottom",
        color=MUTED.light, fontsize=SMALL,
    )  # fmt: skip


def _uncertain(study: Study, ax: Axes) -> None:
    """What lies below shows the reference, not the method; of closed forms rounding says it."""
    if study.uncertainty > 100 * ROUNDING:
        ax.axhspan(LEAST / 3, study.uncertainty, color=LINE.light, alpha=0.45, linewidth=0)
        ax.text(
            0.995, study.uncertainty, "uncertainty of the reference",
            transform=ax.get_yaxis_transform(), ha="right", va="bottom", color=MUTED.light,
            fontsize=SMALL,
        )  # fmt: skip


def _curve(ax: Axes, method: str, x: Sequence[float], rows: Sequence[Row], name: str) -> None:
    """A row of marks joined by a line; dashed, with hollow marks, for tolerances."""
    look = _look(method)
    hollow = rows[0].tolerance is not None
    ax.plot(
        x, [_drawn(row.error) for row in rows], color=look.light, marker=look.marker,
        linestyle="--" if hollow else "-", label=name, markeredgewidth=0.9,
        markerfacecolor="none" if hollow else look.light,
        markersize=SIZES.get(method),
        zorder=4 if method == "closed_form" else 3,
    )  # fmt: skip


def _curves(study: Study) -> Iterable[tuple[str, bool, list[Row]]]:
    """Method, whether to tolerances, and rows."""
    # The exact solution last, on top of all.
    for method in sorted(study.methods, key=lambda method: method == "closed_form"):
        for tolerance in (False, True):
            if rows := study.curve(method, tolerance=tolerance):
                yield method, tolerance, rows


def plot_study(study: Study, ax: Axes | None = None) -> Axes:
    """Error against wall seconds for each simulated second, of every method, with a legend."""
    if ax is None:
        with mpl.rc_context(RC):
            ax = Figure(figsize=(6.4, 4.4), layout="constrained").add_subplot()
    plot_time(study, ax)
    ax.legend(fontsize=SMALL, loc="upper left", bbox_to_anchor=(1, 1))
    ax.set_title(study.scene.title)
    return ax


def plot_time(study: Study, ax: Axes) -> None:
    """Error against wall seconds for each simulated second."""
    _log_axes(ax)
    _uncertain(study, ax)
    for method, tolerance, rows in _curves(study):
        name = _look(method).label + (", to tolerances" if tolerance else "")
        _curve(ax, method, [row.seconds_per_second for row in rows], rows, name)
    ax.set(xlabel=TIME, ylabel=ERROR)


def plot_order(study: Study, ax: Axes) -> None:
    """Error against step, with the slopes of the orders there are."""
    _log_axes(ax)
    fixed = [(method, rows) for method, tolerance, rows in _curves(study) if not tolerance]
    fixed = [(method, rows) for method, rows in fixed if method != "closed_form"]
    for method, rows in fixed:
        _curve(ax, method, [row.step or math.nan for row in rows], rows, method)
    steps = sorted({row.step for _, rows in fixed for row in rows if row.step})
    used = {method for method, _ in fixed}
    orders = {facts.order for facts in _native.methods() if facts.name in used}
    if len(steps) > 1:
        _slopes(ax, steps[0], steps[-1], sorted(orders))
    ax.set(xlabel="step (s)")


def _slopes(ax: Axes, low: float, high: float, orders: Sequence[int]) -> None:
    """Faint lines error ∝ step^order from the upper right corner."""
    ax.set_xlim(low / 1.6, high * 1.6)
    for order in orders:
        reach = max(low / 1.6, high * (ROUNDING / MOST) ** (1 / order))
        end = MOST * (reach / high) ** order
        ax.plot(
            [high, reach], [MOST, end], color=MUTED.light, linewidth=0.7, linestyle=":", zorder=1
        )
        power = "h" if order == 1 else "h" + str(order).translate(RAISED)
        at_edge = reach <= low / 1.5
        ax.annotate(
            power, (reach, end), xytext=(3, 3) if at_edge else (2, 3), textcoords="offset points",
            color=MUTED.light, fontsize=SMALL, ha="left", va="bottom", zorder=5,
            bbox={"boxstyle": "square,pad=0.1", "facecolor": PAPER.light, "edgecolor": "none"},
        )  # fmt: skip


def _peers(ax: Axes, scene: str, peers: Peers) -> None:
    """Other engines at their best settings, in muted colours."""
    for engine in peers.engines(scene):
        rows, look = peers.curve(scene, engine), PEERS[engine]
        ax.plot(
            [row.seconds_per_second for row in rows], [_drawn(row.error) for row in rows],
            color=look.light, marker=look.marker, linestyle="-", linewidth=1.0, markersize=3.4,
            markerfacecolor="none", markeredgewidth=0.9, zorder=2,
            label=f"{look.label}, {rows[0].setting}",
        )  # fmt: skip


def scene_figures(study: Study, peers: Peers | None = None) -> tuple[Figure, Figure]:
    """Error against time, with other engines where there are any, and error against step."""
    with mpl.rc_context(RC):
        time, order = (
            Figure(figsize=size, layout="constrained") for size in ((4.3, 3.4), (3.3, 3.4))
        )
        ax = time.add_subplot(title="error against run time")
        plot_time(study, ax)
        if peers is not None:
            _peers(ax, study.scene.name, peers)
        plot_order(study, order.add_subplot(title="error against step"))
    return time, order


def throw_panels(throw: Study) -> list[Figure]:
    """The panels of the first figure, each a figure of its own."""
    drawn = _throw_drawers(throw)
    with mpl.rc_context(RC):
        figures = [Figure(figsize=(4.2, 2.9), layout="constrained") for _ in drawn]
        for figure, draw in zip(figures, drawn, strict=True):
            draw(figure.add_subplot())
    return figures


def throw_figure(throw: Study) -> Figure:
    """The first figure in one piece."""
    with mpl.rc_context(RC):
        spacious = ConstrainedLayoutEngine(w_pad=0.12, h_pad=0.12)
        figure = Figure(figsize=(9.0, 6.2), layout=spacious)
        for place, draw in enumerate(_throw_drawers(throw), start=1):
            draw(figure.add_subplot(2, 2, place))
    return figure


def _throw_drawers(throw: Study) -> list[Callable[[Axes], None]]:
    paths = thrown_ball(THROW_METHODS, TICKS)
    by_method = groupby(paths, key=lambda path: path.method)
    drawers = [partial(_plot_throw, list(group)) for _, group in by_method]
    return [*drawers, partial(_plot_throw_errors, throw)]


def _plot_throw(paths: list[Path], ax: Axes) -> None:
    """Where the ball goes at each number of ticks a second, against the exact parabola."""
    look = METHODS[paths[0].method]
    exact = _native.exact_motion(THROWN, np.linspace(0, 2, 101))[:, 0]
    ax.plot(*exact[:, :2].T, color=INK.light, linewidth=0.9, linestyle=(0, (4, 2)), zorder=4)
    for path, strength in zip(paths, (0.45, 0.6, 0.8, 1.0), strict=False):
        few = path.ticks_per_second <= 20
        ax.plot(
            *np.array(path.points).T, color=look.light, alpha=strength, linewidth=1.1,
            marker=look.marker if few else None, markersize=3.6, markeredgewidth=0,
        )  # fmt: skip
    _label_ends(ax, paths)
    ax.set(xlim=(0, 31), ylim=(-2.7, 8.4), xlabel="x (m)", ylabel="y (m)")
    default = _native.methods()[0].name
    ax.set_title(look.label + (", the default method" if paths[0].method == default else ""))
    ax.text(0.03, 0.06, "dashed: exact", transform=ax.transAxes, fontsize=SMALL, color=MUTED.light)


def _label_ends(ax: Axes, paths: list[Path]) -> None:
    """Ticks a second at the ends of the paths, moved apart where they would overlap."""
    ends = {path.points[-1][1]: str(path.ticks_per_second) for path in paths}
    if max(ends) - min(ends) < 1e-6:
        ends = {max(ends): f"{paths[0].ticks_per_second} to {paths[-1].ticks_per_second}"}
    apart, last = 0.76, -math.inf
    for i, y in enumerate(sorted(ends)):
        last = max(y, last + apart)
        unit = " ticks/s" if i == len(ends) - 1 else ""
        ax.text(24.6, last, ends[y] + unit, va="center", fontsize=SMALL, color=MUTED.light)


def _plot_throw_errors(throw: Study, ax: Axes) -> None:
    """Error against run time of those methods, and of the exact solution."""
    _log_axes(ax)
    for method, _, rows in _curves(throw):
        _curve(ax, method, [row.seconds_per_second for row in rows], rows, _look(method).label)
        if method == "closed_form":
            _note(ax, rows[0], "as the engine comes:\nclosed form, one step", (-6, 24))
        elif method == "leapfrog":
            _note(ax, rows[len(rows) // 2], "leapfrog: exact here,\nbut for rounding", (-20, 12))
        elif method == "explicit_euler":
            for row, ticks in list(zip(rows, TICKS, strict=False))[::3]:
                _note(ax, row, f"{ticks} ticks/s", (2, 5))
            text = "explicit and semi-implicit Euler:\nten times the time, a tenth of the error"
            _note(ax, rows[-1], text, (4, -30), "right")
    ax.set(xlabel=TIME, ylabel=ERROR, title="error against run time")


def _note(ax: Axes, row: Row, text: str, offset: tuple[float, float], ha: str = "left") -> None:
    ax.annotate(
        text, (row.seconds_per_second, _drawn(row.error)), xytext=offset,
        textcoords="offset points", fontsize=SMALL, color=MUTED.light, ha=ha, va="bottom",
        linespacing=1.15,
    )  # fmt: skip

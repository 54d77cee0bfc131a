"""Error against run time: a scene by several methods, at a row of steps and tolerances."""

from __future__ import annotations

import json
from functools import partial
from typing import TYPE_CHECKING

from culbuto import _native
from culbuto.catalogue import Scene, find
from culbuto.study.ladders import STEPS_A_RUN, TOLERANCES, allowed
from culbuto.study.rows import Order, Row, Study, Table
from culbuto.study.throw import Path, thrown_ball
from culbuto.study.worlds import Scale, case_of, known, plan, study_world

if TYPE_CHECKING:
    import pathlib
    from collections.abc import Callable, Iterable, Sequence
    from concurrent.futures import Executor

    from culbuto._native import World

__all__ = ["Order", "Path", "Row", "Study", "Table", "study", "thrown_ball"]


def study(  # noqa: PLR0913 — one keyword each
    scene: str | pathlib.Path | World | Callable[[], World],
    *,
    steps: Iterable[float] | None = None,
    tolerances: Iterable[float] | None = None,
    methods: Sequence[str] = (),
    repeats: int = 5,
    duration: float | None = None,
    reference: object = "self",
    length: float | None = None,
    executor: Executor | None = None,
) -> Study:
    """Runs a scene by each method, at each step and to each tolerance.

    Args:
        scene: Name or id of a scene of the catalogue; or any world, a function that makes one, or
            the path of a scene file. The world itself stays as it is.
        steps: Fixed steps (s), each taken as the nearest that divides the scene's duration; by
            default 2⁴ to 2¹⁴ steps a run (2⁴ to 2¹⁰ of a world).
        tolerances: For the methods that choose their own step; by default 1e-2 to 1e-12, none of a
            world in which bodies can meet.
        methods: Their names; none: all that apply. Bodies that meet are moved by "contact_step".
        repeats: Timed runs of each row, of which the median counts.
        duration: World time (s) that a world is run for; that of the file where one is given.
        reference: What a world's motion is compared with: a function of time (s) that gives the
            poses (n, 2 or 3) of the bodies, in m and rad; an array (k, n, 2 or 3) of those at equal
            parts of the run, its start and end included; or "self": runs finer than all rows.
        length: What errors of a world are relative to (m); by default the way of the body that
            goes farthest, or its size.
        executor: Any executor of `concurrent.futures` that the runs are handed to: threads,
            processes, Dask's. Rows that run side by side tell errors as well, times less well.

    Raises:
        ValueError: For what is not allowed, with what is.

    >>> import culbuto as cb
    >>> kepler = cb.study("kepler", steps=[0.01, 0.005], tolerances=[], methods=["leapfrog"])
    >>> [row.error < 0.02 for row in kepler.rows]
    [True, True]
    """
    if repeats < 1:
        message = f"repeats is {repeats}; allowed: 1 or more"
        raise ValueError(message)
    if isinstance(scene, str) and not scene.lower().endswith(".json"):
        of_a_world = {"duration": duration, "length": length}
        for name in (name for name, value in of_a_world.items() if value is not None):
            message = f"{name} is given for {scene!r}; allowed: for worlds, not for the catalogue"
            raise ValueError(message)
        return _of_catalogue(find(scene), (steps, tolerances), methods, repeats, executor)
    case = case_of(scene, duration)
    what = plan(case, (steps, tolerances), methods, reference)
    answer = known(case, reference, what)
    scale = Scale.of(case, answer, length)
    return study_world(case, what, (answer, scale), repeats, executor)


def _of_catalogue(
    entry: Scene,
    ladders: tuple[Iterable[float] | None, Iterable[float] | None],
    methods: Sequence[str],
    repeats: int,
    executor: Executor | None,
) -> Study:
    steps, tolerances = ladders
    counts = list(STEPS_A_RUN) if steps is None else _counts(entry, steps)
    limits = list(TOLERANCES) if tolerances is None else [float(limit) for limit in tolerances]
    run = partial(_native.study, entry.name)
    if executor is None:
        found = [run((counts, limits), list(methods), repeats)]
    else:
        modes: list[tuple[list[int], list[float]]] = [([count], []) for count in counts] + [
            ([], [limit]) for limit in limits
        ]
        futures = [executor.submit(run, mode, list(methods), repeats) for mode in modes]
        found = [future.result() for future in futures]
    rows = [Row.of(row) for part in found for row in json.loads(part)]
    # Each part has a row of the closed form; the first stands for all, and methods stay together.
    once = [row for k, row in enumerate(rows) if row.method != "closed_form" or k == 0]
    places = {name: k for k, name in enumerate(dict.fromkeys(row.method for row in once))}
    ordered = tuple(sorted(once, key=lambda row: places[row.method]))
    return Study(entry, ordered, entry.reference, entry.uncertainty)


def _counts(scene: Scene, steps: Iterable[float]) -> list[int]:
    duration = scene.duration or 0.0
    return [max(1, round(duration / allowed(step, duration))) for step in steps]

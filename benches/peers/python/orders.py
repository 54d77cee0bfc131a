"""A Python engine's side of the race: orders from the runner, a line of JSON each, and answers.

The orders: {"start": scene} makes the world of a scene; {"advance": [first, last, dt]} takes the
steps from the first to before the last and answers with their CPU time in seconds; "state" answers
with all bodies, "version" with the engine's. An answer is {"done": value} or {"failed": message}.
"""

from __future__ import annotations

import json
import math
import sys
from typing import Any, Protocol


class Race(Protocol):
    """A scene, and its world in an engine."""

    def __init__(self, scene: dict[str, Any]) -> None:
        """Makes the world."""

    def advance(self, first: int, last: int, dt: float) -> float:
        """Takes steps and gives their CPU time (s)."""

    def state(self) -> list[dict[str, Any]]:
        """All bodies, in the scene's order."""


def pushes(swing: dict[str, Any], step: int, dt: float) -> tuple[float, float]:
    """The velocity of what swings in a step."""
    now, then = (math.sin(swing["rate"] * dt * k) for k in (step, step + 1))
    x, y = swing["amplitude"]
    return (x * (then - now) / dt, y * (then - now) / dt)


def obey(engine: type[Race], version: str) -> None:
    """Answers until the orders end."""
    race: Race | None = None
    for line in sys.stdin:
        order = json.loads(line)
        done: object = None
        try:
            if order == "version":
                done = version
            elif race is not None and order == "state":
                done = race.state()
            elif race is not None and "advance" in order:
                done = race.advance(*order["advance"])
            else:
                race = engine(order["start"])
        except Exception as error:  # whatever an engine refuses is told
            answer = {"failed": f"{type(error).__name__}: {error}"}
        else:
            answer = {"done": done}
        print(json.dumps(answer), flush=True)

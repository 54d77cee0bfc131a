"""The scene a command is given: one of the catalogue, or a file."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from culbuto import catalogue
from culbuto._native import SceneFile

if TYPE_CHECKING:
    from culbuto._native import World


@dataclass(frozen=True)
class Source:
    """A world to run, and how it is meant to be run: step `dt` and `duration` (s).

    `scene` is that of the catalogue, None for a file.
    """

    name: str
    title: str
    world: World
    dt: float
    duration: float
    scene: catalogue.Scene | None


def is_file(argument: str) -> bool:
    """Whether an argument means a file: it ends in .json, or there is one of that name."""
    return argument.lower().endswith(".json") or Path(argument).is_file()


def open_source(argument: str) -> Source:
    """The scene that an argument means. `ValueError` or `OSError` says what is wrong with it."""
    if is_file(argument):
        file = SceneFile.read(argument)
        name = file.name or Path(argument).stem
        return Source(name, file.about, file.world(), file.dt, file.duration, None)
    scene = catalogue.find(argument)
    if scene.duration is None or scene.dt is None:
        message = f"{scene.name} is a scene of numbers, with no motion to run; see culbuto verify"
        raise ValueError(message)
    return Source(scene.name, scene.title, scene.world(), scene.dt, scene.duration, scene)

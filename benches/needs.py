"""What scenes and features cost in instructions and memory, for the report: `needs.py PROGRAM OUT`.

PROGRAM is the example `instructions`. Writes a JSON that the report's page is made with (`make
needs`), and ends with status 1 if a feature costs anything once it is gone.
"""

import json
import subprocess
import sys
import tempfile
from datetime import date
from pathlib import Path
from typing import Any

from callgrind import between_marks, bytes_at_the_end, instructions, version

import culbuto
from culbuto import catalogue
from culbuto.report.measure import machine, versions
from culbuto.report.needs import TYPICAL, everything, step_of

PROGRAM, OUT = sys.argv[1], Path(sys.argv[2])
FEW, MANY = 10, 40
# In a step that is taken again these come once more.
AGAIN = ["detect", "islands", "advance"]
# Differences up to here are nothing: allocations fall elsewhere, and a feature that acted changed
# the motion before it went.
NOTHING = 2e-3


def a_step(*world: str) -> float:
    """Instructions of a step, from two runs."""
    few, many = (instructions(PROGRAM, world[0], str(n), *world[1:]) for n in (FEW, MANY))
    return (many - few) / (MANY - FEW)


def by_stage(stages: list[str], *world: str) -> dict[str, float]:
    """Instructions of each stage a step, each with those of one reading of the clock."""
    steps = between_marks(PROGRAM, world[0], str(MANY), *world[1:], "--timed")[FEW:]
    sums = dict.fromkeys(stages, 0)
    for parts in steps:
        names = list(stages)
        if "detect" in names:
            after = names.index("advance") + 1
            times = (len(parts) // 2 - len(names)) // len(AGAIN)
            names[after:after] = AGAIN * times
        # Every second part lies between two stages.
        for name, count in zip(names, parts[1::2], strict=True):
            sums[name] += count
    return {name: total / len(steps) for name, total in sums.items()}


def counted(world: culbuto.World, dt: float) -> dict[str, Any]:
    """What a world costs."""
    with tempfile.TemporaryDirectory() as folder:
        path = str(Path(folder) / "scene.json")
        world.save(path)
        run = (path, "--dt", repr(dt))
        with_it, without = (
            bytes_at_the_end(PROGRAM, path, str(FEW), *more) for more in (("--keep",), ())
        )
        return {
            "step": a_step(*run),
            "stages": by_stage(world.stages, *run),
            "bytes": with_it - without,
        }


def scene(name: str) -> dict[str, Any]:
    """A scene as it is, and with everything."""
    found = catalogue.find(name)
    world, dt = found.world(), step_of(found)
    print(name, file=sys.stderr)
    return {"scene": name, **counted(world, dt), "everything": counted(everything(world), dt)}


def feature(line: str) -> dict[str, Any]:
    """A feature that a world never had, had, and has."""
    base, name = line.split("/")
    print(line, file=sys.stderr)
    costs = {how: a_step(f"{line}/{how}") for how in ("never", "had", "there")}
    return {"world": base, "feature": name, **costs}


def main() -> int:
    """Counts all."""
    rustc = subprocess.check_output(["rustc", "--version"], text=True).split()[1]
    lines = subprocess.check_output([PROGRAM, "features"], text=True).splitlines()
    found = {
        "machine": machine(),
        "versions": f"{versions()} · rustc {rustc} · {version()}",
        "date": date.today().isoformat(),
        "scenes": [scene(name) for name in TYPICAL],
        "features": [feature(line) for line in lines],
    }
    OUT.write_text(json.dumps(found, indent=1, ensure_ascii=False) + "\n", "utf-8")
    dear = [f for f in found["features"] if abs(f["had"] - f["never"]) > NOTHING * f["never"]]
    for one in dear:
        print(f"{one['feature']} costs {one['world']} something once it is gone: {one}")
    return bool(dear)


if __name__ == "__main__":
    sys.exit(main())

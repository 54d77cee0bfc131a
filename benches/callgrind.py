"""What valgrind counts of a program: instructions, whole or from mark to mark, and memory."""

from __future__ import annotations

import re
import subprocess
import tempfile
from pathlib import Path

# Calls before which callgrind writes down what it has counted since the last: reading the clock,
# and a mark of the program's own.
CLOCK, MARK = "clock_gettime", "getpid"


def instructions(*command: str) -> int:
    """Instructions of a whole run."""
    with tempfile.TemporaryDirectory() as folder:
        return _number(r"Collected : (\d+)", _callgrind(folder, command))


def between_marks(*command: str) -> list[list[int]]:
    """For each mark of a run, instructions between the readings of the clock that follow."""
    with tempfile.TemporaryDirectory() as folder:
        _callgrind(folder, command, f"--dump-before={CLOCK}*", f"--dump-before={MARK}*")
        parts: list[list[int]] = []
        for path in sorted(Path(folder).glob("out.*"), key=lambda path: int(path.suffix[1:])):
            text = path.read_text("utf-8")
            if f"--dump-before={MARK}" in text:
                parts.append([])
            elif parts:
                parts[-1].append(_number(r"^totals: (\d+)", text))
    return parts


def bytes_at_the_end(*command: str) -> int:
    """Memory on the heap that a run has not given back."""
    run = ["valgrind", "--tool=memcheck", "--leak-check=no", *command]
    output = subprocess.run(run, capture_output=True, text=True, check=True).stderr
    return _number(r"in use at exit: ([\d,]+) bytes", output)


def version() -> str:
    """Of valgrind."""
    return subprocess.check_output(["valgrind", "--version"], text=True).strip()


def _callgrind(folder: str, command: tuple[str, ...], *options: str) -> str:
    tool = ["valgrind", "--tool=callgrind", f"--callgrind-out-file={folder}/out", *options]
    return subprocess.run([*tool, *command], capture_output=True, text=True, check=True).stderr


def _number(pattern: str, text: str) -> int:
    found = re.search(pattern, text, re.MULTILINE)
    if not found:
        raise SystemExit(f"valgrind gave no count: {text}")
    return int(found[1].replace(",", ""))

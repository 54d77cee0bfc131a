"""Instructions a step, counted by valgrind: repeatable where the clock is not.

Prints a table in Markdown; docs/instructions.md holds one such run.
"""

import re
import subprocess
import sys
import tempfile
from pathlib import Path

PROGRAM = Path(sys.argv[1])
FEW, MANY = 20, 120


def instructions(name: str, steps: int) -> int:
    """Instructions of a whole run of a world."""
    with tempfile.TemporaryDirectory() as folder:
        command = [
            "valgrind",
            "--tool=callgrind",
            f"--callgrind-out-file={folder}/out",
            str(PROGRAM),
            name,
            str(steps),
        ]
        output = subprocess.run(command, capture_output=True, text=True, check=True).stderr
    found = re.search(r"Collected : (\d+)", output)
    if not found:
        raise SystemExit(f"valgrind gave no count: {output}")
    return int(found.group(1))


names = subprocess.run([PROGRAM], capture_output=True, text=True, check=True).stdout.splitlines()
print("| world | instructions a step |\n|---|---:|")
for name in names:
    cost = (instructions(name, MANY) - instructions(name, FEW)) / (MANY - FEW)
    print(f"| {name} | {cost:.1f} |")

"""Instructions a step, counted by valgrind: repeatable where the clock is not.

Prints a table in Markdown; docs/instructions.md holds one such run.
"""

import subprocess
import sys

from callgrind import instructions

PROGRAM = sys.argv[1]
FEW, MANY = 20, 120

names = subprocess.run([PROGRAM], capture_output=True, text=True, check=True).stdout.splitlines()
print("| world | instructions a step |\n|---|---:|")
for name in names:
    few, many = (instructions(PROGRAM, name, str(steps)) for steps in (FEW, MANY))
    print(f"| {name} | {(many - few) / (MANY - FEW):.1f} |")

"""Makes the pictures of docs/joints.md: what each block of code leaves, if a picture follows it.

Run it where culbuto is installed: python docs/joints/pictures.py
"""

import re
from pathlib import Path
from typing import Any

from culbuto import drawing

PAGE = Path(__file__).parents[1] / "joints.md"
BLOCK = re.compile(
    r"```python\n(?P<code>(?:(?!```).)*)```\n\n!\[.*?\]\((?P<picture>.*?)\)", re.DOTALL
)


def main() -> None:
    """Writes all pictures beside the page."""
    for block in BLOCK.finditer(PAGE.read_text(encoding="utf-8")):
        names: dict[str, Any] = {}
        exec("import culbuto as cb\n" + block["code"], names)  # noqa: S102 — the page's own code
        world, motion = names["world"], names.get("motion")
        svg = drawing.picture(world, motion) if motion else drawing.svg(world)
        (PAGE.parent / block["picture"]).write_text(svg, encoding="utf-8")


if __name__ == "__main__":
    main()

"""Every Python block of the README and the guide runs, in the order in which it is read.

The blocks of one file share their names. A block is left out only if the line before it is
`<!-- not run -->`.
"""

import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

ROOT = Path(__file__).parents[2]
DOCUMENTS = [ROOT / "README.md", *sorted((ROOT / "docs").rglob("*.md"))]
BLOCK = re.compile(r"^(<!-- not run -->\n)?```python\n(.*?)^```$", re.MULTILINE | re.DOTALL)


def blocks(document: Path) -> Iterator[tuple[int, str]]:
    """Line number and text of each Python block that is to run."""
    text = document.read_text(encoding="utf-8")
    for match in BLOCK.finditer(text):
        if not match[1]:
            yield text.count("\n", 0, match.start(2)), match[2]


@pytest.mark.parametrize(
    "document", [pytest.param(path, id=str(path.relative_to(ROOT))) for path in DOCUMENTS]
)
def test_python_blocks_run(document: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)  # for what a block writes
    names: dict[str, Any] = {"__name__": "__main__"}
    for lines_before, block in blocks(document):
        # Padded, so that a traceback gives the line of the document.
        exec(compile("\n" * lines_before + block, document, "exec"), names)


def test_a_block_is_left_out_only_when_marked(tmp_path: Path) -> None:
    document = tmp_path / "guide.md"
    document.write_text(
        "```python\na = 1\n```\n\n<!-- not run -->\n```python\nb = 2\n```\n", encoding="utf-8"
    )
    assert list(blocks(document)) == [(1, "a = 1\n")]

"""The tables of docs/accuracy.md are those of the run that is committed beside it."""

import json
import runpy
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
ACCURACY = runpy.run_path(str(ROOT / "benches" / "accuracy.py"))


def test_the_tables_are_those_of_the_committed_run() -> None:
    data = json.loads((ROOT / "docs" / "accuracy.json").read_text("utf-8"))
    text = (ROOT / "docs" / "accuracy.md").read_text("utf-8")
    assert ACCURACY["page"](text, data) == text, "written by hand, or not anew: make accuracy"
    assert data["machine"] in text
    assert data["versions"] in text


def test_the_quickest_row_within_an_error_is_kept() -> None:
    rows = [
        {"scene": "a", "method": method, "error": error, "seconds_per_second": seconds}
        for method, error, seconds in (("one", 1e-3, 1.0), ("two", 1e-9, 2.0), ("three", 1.0, 0.1))
    ]
    found = [ACCURACY["quickest"](rows, target) for target in (1e-2, 1e-8, 1e-12)]
    assert found == [[1.0, "one"], [2.0, "two"], None]


def test_a_number_of_a_row_is_two_digits() -> None:
    assert [ACCURACY["number"](x) for x in (None, 0, 1.26e-7)] == ["–", "0", "1.3e-07"]
    with pytest.raises(KeyError):
        ACCURACY["tables"]({})

"""The published schema accepts the example files, and refuses what the engine refuses."""

import copy
import json
from pathlib import Path

import jsonschema
import pytest

DOCS = Path(__file__).parents[2] / "docs"
SCHEMA = json.loads((DOCS / "scene.schema.json").read_text(encoding="utf-8"))
EXAMPLES = sorted((DOCS / "scenes").glob("*.json"))
VALIDATOR = jsonschema.Draft202012Validator(SCHEMA)


def test_the_schema_is_one() -> None:
    jsonschema.Draft202012Validator.check_schema(SCHEMA)


@pytest.mark.parametrize("path", EXAMPLES, ids=lambda path: path.stem)
def test_the_examples_are_valid(path: Path) -> None:
    VALIDATOR.validate(json.loads(path.read_text(encoding="utf-8")))


def test_the_guide_is_valid() -> None:
    guide = (DOCS / "scene-files.md").read_text(encoding="utf-8")
    VALIDATOR.validate(json.loads(guide.split("```json\n")[1].split("```")[0]))


@pytest.mark.parametrize(
    "change",
    [
        {"culbuto": 2},
        {"plasmas": []},
        {"joints": [{"joint": "filter"}]},
        {"joints": [{"bodies": [0, None], "joint": "custom"}]},
        {"joints": [{"bodies": [0, None], "joint": {"gear": {}}}]},
        {"joints": [{"bodies": [0, None], "joint": {"weld": {"linear": "stiff"}}}]},
        {"joints": [{"bodies": [0, None], "anchors": [[0], [0]], "joint": "filter"}]},
        {"gravity": [0]},
        {"settings": {"substeps": -1}},
        {"bodies": [{"mass": 1, "colour": 3}]},
        {"bodies": [{"position": [0, 0], "center_at": [0, 0]}]},
        {"bodies": [{"shapes": [{"shape": {"blob": {}}}]}]},
        {"bodies": [{"mass": 1, "friction": -1}]},
        {"bodies": [{"mass": 1, "friction": [0.5, 0.4]}]},
        {"bodies": [{"mass": 1, "friction": {"static": 0.5}}]},
        {"bodies": [{"mass": 1, "surface": {}}]},
        {"bodies": [{"mass": 1, "role": "ghost"}]},
        {"bodies": [{"mass": 1, "filter": {"mask": -1}}]},
        {"settings": {"mixing": {"friction": "mean"}}},
        {"settings": {"mixing": {"table": [{"a": "ice"}]}}},
        {"settings": {"impact_law": "hooke"}},
        {"schedules": [{"times": [0, 1]}]},
        {"fields": [{"magnetic": {}}]},
    ],
    ids=str,
)
def test_what_the_engine_refuses_is_invalid(change: dict[str, object]) -> None:
    scene = copy.deepcopy(json.loads(EXAMPLES[0].read_text(encoding="utf-8")))
    scene.update(change)
    assert not VALIDATOR.is_valid(scene)

"""What the studio opens and what is dropped on it, without a browser."""

import json
from pathlib import Path
from typing import Any

import pytest

from roadproof.errors import InputError
from roadproof.frontends.api.drafting import QUESTION
from roadproof.frontends.studio.dropping import drop
from roadproof.frontends.studio.showing import marks_of
from roadproof.frontends.studio.start_page import begin_with

EXAMPLES = Path(__file__).parents[2] / "examples"
DRIVE = EXAMPLES / "catalogue" / "tests" / "drives" / "braking.json"
SAMPLES = EXAMPLES / "catalogue" / "tests" / "samples"


def test_specifications_and_drives_are_opened_by_their_endings(tmp_path: Path) -> None:
    spec = tmp_path / "own.spec"
    spec.write_text('def near(a, b: vehicle) "near" := s(b) - s(a) <= 5 m\n', "utf-8")
    found = begin_with([spec, DRIVE])
    assert found.text == spec.read_text("utf-8")
    assert found.drives == ((DRIVE.name, json.loads(DRIVE.read_text("utf-8"))),)
    with pytest.raises(InputError, match=r"own\.txt: the studio opens"):
        begin_with([spec, tmp_path / "own.txt"])


def dropped(*paths: Path) -> dict[str, Any]:
    files = [{"name": x.name, "content": x.read_text("utf-8")} for x in paths]
    draft = {"base": "base", "text": "", "options": {}, "params": {}}
    asked = {"draft": draft, "set": "base", "formula": "scenario_4(SV,POV,L)", "files": files}
    return drop(asked, lambda stage: None)


def test_a_drive_is_shown_and_samples_are_monitored() -> None:
    assert dropped(DRIVE)["drive"]["schema"].startswith("roadproof/drive/")
    found = dropped(SAMPLES / "braking.csv")
    assert [x["role"] for x in found["view"]["formulas"]] == ["question"]


def test_marks_are_of_places_in_the_texts_of_the_editors_alone() -> None:
    place = {"source": QUESTION, "from": [1, 2], "to": [1, 5]}
    assert marks_of([place, place], "why") == [
        {"where": QUESTION, "from": [1, 2], "to": [1, 5], "kind": "why"}
    ]
    assert marks_of([{**place, "source": "iso34502.spec"}], "why") == []

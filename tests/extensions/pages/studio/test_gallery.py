"""The gallery of the studio: drives that are known without a search, and the files to choose from."""

import json
from pathlib import Path
from typing import Any

import pytest

from roadproof.evidence.drive_file import load_drive
from roadproof.extensions.pages.studio import gallery, jobs
from roadproof.extensions.pages.studio.pages import LARGEST_FILE, read_folder, read_start_files

EXAMPLES = Path(__file__).parents[4] / "examples"
DRIVES = EXAMPLES / "traffic" / "drives"


def cards(numbers: list[int], base: str = "base") -> dict[int, dict[str, Any]]:
    gallery._cards.cache_clear()
    told: Any = jobs.answer("gallery", {"draft": {"base": base}, "scenarios": numbers})
    return {x["number"]: x for x in told["cards"]}


@pytest.mark.parametrize("base", ["base", "extA", "ext"])
def test_shipped_drives_are_shown_without_a_search(base: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv("ROADPROOF_KNOWN")
    found = cards([1, 10, 24, 25], base)
    assert [*found] == [1, 10, 24]
    for number, card in found.items():
        assert card["drive"]["scenario"] == number
        assert card["drive"]["set"] == base
        assert card["picture"]["dangers"][0]["begins"] <= card["picture"]["horizon"]
        assert {*card["picture"]["vehicles"]} == {*card["drive"]["vehicles"]}


def test_cards_that_come_with_the_page_have_words_and_pictures_of_all_scenarios() -> None:
    shipped = read_start_files([]).as_data()["cards"]
    assert isinstance(shipped, dict)
    assert [*shipped] == ["base", "extA", "ext"]
    for named in shipped.values():
        assert [x["number"] for x in named] == [*range(1, 25)]
        for x in named:
            assert x["title"]
            assert x["sentence"]
            assert {*x["picture"]["vehicles"]} >= {"SV"}
            assert x["picture"]["road"]["lanelets"]


def test_scenarios_without_a_known_drive_have_none_and_nothing_is_searched() -> None:
    found = cards([1, 2])
    assert [*found] == [1, 2]
    assert not any("drive" in x or "picture" in x for x in found.values())
    assert found[1]["formula"] == "scenario_1(SV, POV, L)"


def test_files_of_a_folder_are_listed_and_others_left_out(tmp_path: Path) -> None:
    drive = (DRIVES / "scenario-01-base.json").read_text("utf-8")
    (tmp_path / "a.json").write_text(drive, "utf-8")
    (tmp_path / "broken.json").write_text("{", "utf-8")
    (tmp_path / "other.json").write_text('{"schema": "roadproof/proofs/1"}', "utf-8")
    (tmp_path / "large.json").write_text(drive + " " * LARGEST_FILE, "utf-8")
    (tmp_path / "own.spec").write_text("def near(a, b: vehicle) := s(b) - s(a) <= 5 m\n", "utf-8")
    (tmp_path / "broken.spec").write_bytes(b"\xff\xfe")
    found = read_folder(tmp_path)
    assert [name for name, _ in found.drives] == ["a.json"]
    assert [name for name, _ in found.specs] == ["own.spec"]
    assert found.text == ""
    assert found.as_data()["shows"] is False


def test_files_that_are_named_are_shown_and_a_folder_is_listed(tmp_path: Path) -> None:
    spec = tmp_path / "own.spec"
    spec.write_text("def near(a, b: vehicle) := s(b) - s(a) <= 5 m\n", "utf-8")
    found = read_start_files([spec, DRIVES])
    assert found.text == spec.read_text("utf-8")
    assert found.specs == (("own.spec", found.text),)
    assert [name for name, _ in found.drives] == [x.name for x in sorted(DRIVES.glob("*.json"))]
    assert found.drives[0][1]["formula"] == load_drive(sorted(DRIVES.glob("*.json"))[0]).formula
    assert json.loads(json.dumps(found.as_data()))["shows"] is True
    assert read_start_files([]).as_data()["shows"] is False

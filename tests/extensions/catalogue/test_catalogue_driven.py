"""What becomes of a test under a driver model rests on a drive: it is kept, judged, drawn, and made again."""

import json
import shutil
from pathlib import Path

import pytest

import roadproof as rp
from roadproof.extensions.catalogue.cataloguing import CatalogueAnswer
from roadproof.extensions.catalogue.driver_claims import confirmed_decision, driver_claim_name
from roadproof.extensions.traffic.evaluate.decisions import Decision
from roadproof.frontends.api.checking import check
from roadproof.verdict import ExitCode, Verdict
from sharing import made_once

DRIVES = Path(__file__).parents[3] / "examples/catalogue/tests/drives"
TESTS = [DRIVES / f"{x}.json" for x in ("cut-out", "braking", "cut-in-overtaking", "both-change-hard")]


def ask(out: Path | None = None) -> CatalogueAnswer:
    return rp.catalogue(*TESTS, among="1,2,4", classes=False, out=out, jobs=1)


@pytest.fixture(scope="module")
def folder() -> Path:
    return made_once("driven", lambda home: ask(home / "out")) / "out"


def test_each_decision_about_a_drive_has_its_drive(folder: Path) -> None:
    found = ask()
    assert {x.side for _, x in found.decisions} >= {"preventable", "undecided"}
    for test, x in found.decisions:
        answer = found.view.driven[driver_claim_name(test, x)]
        assert answer.verdict is Verdict.WITNESSED
        assert answer.drive is not None
        formula = answer.drive.file.formula
        assert formula.startswith("G not") == (x.side == "preventable")
        assert x.gap is None or x.side == "preventable"
    rows = found.as_data()["decisions"]
    assert isinstance(rows, list)
    assert all(isinstance(row, dict) and row["drive"] for row in rows)
    assert check(folder, jobs=1).exit_code is ExitCode.AS_EXPECTED


def test_a_drive_that_is_not_accepted_leaves_its_decision_in_doubt(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr("roadproof.engines.search.batches.drive_of_claim", lambda *_: None)
    found = ask()
    assert {x.side for _, x in found.decisions} == {"undecided"}
    assert {x.gap for _, x in found.decisions} == {None}


@pytest.mark.parametrize("change", ["another drive", "a slower SV", "gone"])
def test_a_drive_that_the_model_does_not_make_is_rejected(change: str, folder: Path, tmp_path: Path) -> None:
    copy = Path(shutil.copytree(folder, tmp_path / "out"))
    one, other, *_ = sorted(copy.glob("driven-*.json"))
    match change:
        case "another drive":
            one.write_bytes(other.read_bytes())
        case "a slower SV":
            content = json.loads(one.read_text("utf-8"))
            content["vehicles"]["SV"]["v_lon"] = "20"
            one.write_text(json.dumps(content), "utf-8")
        case _:
            one.unlink()
    checked = check(copy, jobs=1)
    expected = ExitCode.AS_EXPECTED if change == "gone" else ExitCode.UNEXPECTED
    assert checked.exit_code is expected
    [view] = checked.views.values()
    assert isinstance(view, CatalogueAnswer)
    sides = {driver_claim_name(test, x): x.side for test, x in view.decisions}
    assert sides[one.stem] == "undecided"


def test_two_drives_of_a_test_have_names_of_their_own() -> None:
    every = [
        Decision(scenario, vehicles, model, "preventable")
        for scenario in ("scenario_1", "scenario_4")
        for vehicles in (("SV", "POV"), ("POV", "SV"))
        for model in ("careful", "rss")
    ]
    names = {driver_claim_name(test, x) for test in ("a", "b", "a b", "a-b") for x in every}
    assert len(names) == 4 * len(every)
    assert confirmed_decision("a", every[0], {}) is every[0]
    assert driver_claim_name("a", every[0]).startswith("driven-test-a-")

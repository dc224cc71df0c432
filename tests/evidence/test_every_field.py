"""Folders of evidence with foreign files, other fields and damage: ``check`` rejects what shows no claim."""

import json
import shutil
from collections.abc import Callable
from itertools import islice
from pathlib import Path
from random import Random
from typing import Any

import pytest

import roadproof as rp
from evidence.folders import changes as folder_changes
from evidence.folders import (
    check,
    code,
    places,
    read,
    some_proofs,
    write,
)
from evidence.kinds import MAKE, copy_of
from examples import EVERY_CHANGE
from roadproof.engines.prove.properties import find_label, name_of_claim
from roadproof.errors import InputError
from roadproof.evidence.checking import Checker
from roadproof.evidence.finding import Acceptance
from roadproof.library.elaborate import read_claim
from roadproof.library.loading import bundled_library
from roadproof.questions.question import QUESTION
from roadproof.runtime.package_data import shipped_folder
from roadproof.verdict import ExitCode


def test_check_lists_what_it_does_not_check(tmp_path: Path) -> None:
    found = rp.explore("v_lon(SV) > 30 m/s", vary={"SV.a_lon.min": (-3, -1)}, steps=2, out=tmp_path, jobs=1)
    found.add_files(False)
    (tmp_path / "notes.txt").write_text("mine")
    checked = rp.check(tmp_path)
    [line] = [x for x in str(checked).splitlines() if x.startswith(f"not checked in {tmp_path}: ")]
    assert line.endswith("notes.txt")
    assert json.loads(json.dumps(checked.as_data()))["not_checked"][str(tmp_path)][-1] == "notes.txt"


# --- Evidence of one folder put in another: ``check`` rejects the folder


def files_of(folder: Path) -> list[Path]:
    """The certificates and drive files of a folder."""
    return [x for x in sorted(folder.rglob("*.json")) if x.name != QUESTION]


def _shown(file: Path) -> tuple[object, ...]:
    """What a file is evidence of; two files that say the same here may stand for each other."""
    said = read(file)
    road = said["road"]["name"] if "road" in said else ""
    starts = {name: {**x, "pieces": 0} for name, x in said.get("vehicles", {}).items()}
    claim = said.get("claim", said.get("formula"))
    return claim, said.get("set"), said.get("assuming"), said.get("parameters"), road, starts


def _same_drives(one: Path, other: Path) -> bool:
    """Whether both are drives of one formula, such as scenario 4 and not (scenario 4 <-> false)."""
    texts = [read(x).get("formula") for x in (one, other)]
    home = bundled_library().select()
    return all(texts) and len({read_claim(home, x).formula for x in texts}) == 1


OTHER_KINDS = 4


@pytest.mark.parametrize("kind", MAKE)
def test_evidence_of_any_folder_under_a_claim_of_another_is_rejected(kind: str, tmp_path: Path) -> None:
    """The file of a claim is that of a claim of some of the other kinds, and of its own kind."""
    folder = copy_of(kind, tmp_path / "this")
    assert {x.outcome for x in check(folder)} == {Acceptance.ACCEPTED}
    chance, accepted = Random(kind), []
    others = [x for x in MAKE if x != kind]
    for other in (kind, *(others if EVERY_CHANGE else chance.sample(others, OTHER_KINDS))):
        theirs = files_of(copy_of(other, tmp_path / "other" / other))
        pairs = [(a, b) for a in files_of(folder) for b in theirs if _shown(a) != _shown(b)]
        pairs = [(a, b) for a, b in pairs if not _same_drives(a, b)]
        assert pairs
        for mine, foreign in chance.sample(pairs, min(len(pairs), 2 if other == kind else 1)):
            before = mine.read_bytes()
            mine.write_bytes(foreign.read_bytes())
            if all(x.outcome is Acceptance.ACCEPTED for x in check(folder)):
                accepted.append((mine.name, other, foreign.name))
            mine.write_bytes(before)
    assert accepted == []


# --- Folders in which one thing was changed: none is accepted, but for changes that change nothing --


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    return some_proofs(tmp_path / "proofs")


def test_the_folder_is_accepted_and_names_each_claim(folder: Path) -> None:
    findings = check(folder)
    assert {x.outcome for x in findings} == {Acceptance.ACCEPTED}
    told = [(x.verdict, x.label) for x in findings]
    assert told == [
        ("PROVED", "P2 base"),
        ("PROVED", "P9 base"),
        ("REFUTED", "C5 base"),
        ("PROVED", "P1 scenario 4 base"),
        ("REFUTED", "C4 scenario 4 base"),
    ]
    assert str(findings[3]) == ("PROVED    P1 scenario 4 base  scenario_4(SV,POV,L) -> dangerArises(SV,POV)")


# Changes that are accepted, since what comes out is evidence of the same claim: by file, place and change
# ("" is any), and why.
SAME_ANSWERS = {
    "P1-scenario-04-base.json": {
        "formulas: twice": "a formula that no entry points to",
        "times: turned around": "the order of a list of names",
        "instances: turned around": "the order of a list of instances",
        "tableau": "the proof for Coq, which a solver is not asked about (tests/extensions/kernel)",
    },
    "C4-scenario-04-base.json": {
        "scenario: removed": "it names none",
        "horizon: longer": "boxes are apart until then, too; check says until when",
        "parameters.": "judged with another value, which check names",
        "road.name: ": "a name",
        "road.lanelets: turned around": "the order of lanelets",
        "road.lanelets.0.id: ": "a name",
        "road.lanelets.1.id: ": "a name",
        "road.lanelets.0.d.0: longer": "another road, on which the formula is judged",
        "road.lanelets.1.d.1: longer": "another road, on which the formula is judged",
        "road.adjacent.0: turned around": "a pair has no order",
        "vehicles.": "another drive, on which the formula is judged",
        "verdict: ": "what is told of the formula, and left out",
        "verdict.verdict: ": "left out",
        "verdict.view: ": "left out",
        "verdict.times: ": "left out",
        "verdict.natural: ": "check says that it was not checked",
    },
}


PARTS = 6  # of the changes, each tried by a test of its own, since one for all takes many minutes
TRIED = range(PARTS) if EVERY_CHANGE else (0, 3)


@pytest.mark.parametrize("part", TRIED)
@pytest.mark.parametrize("name", SAME_ANSWERS)
def test_no_change_is_accepted_that_changes_what_is_said(folder: Path, name: str, part: int) -> None:
    path = folder / name
    whole = read(path)
    claims = [(x.label, x.claim) for x in check(folder)]
    accepted, tried = [], 0
    all_changes = ((place, *x) for place in places(whole) for x in folder_changes(whole, place))
    for place, word, changed in islice(all_changes, part, None, PARTS):
        write(path, changed)
        findings = check(folder)
        tried += 1
        if all(x.outcome is Acceptance.ACCEPTED for x in findings):
            accepted.append(f"{'.'.join(map(str, place))}: {word}")
            assert {(x.label, x.claim) for x in findings} <= set(claims)
    assert tried > 300 // PARTS
    assert [x for x in accepted if not any(x.startswith(known) for known in SAME_ANSWERS[name])] == []


# --- attacks on the folder as a whole ------------------------------------------------------------


def asked_in(folder: Path) -> tuple[Any, list[Any]]:
    """The question of a folder, and the claims in it."""
    question = read(folder / QUESTION)
    return question, question["asked"]["claims"]


def relabelled(folder: Path) -> None:
    """P9 is P2's certificate under the name of P9."""
    write(folder / "P9-base.json", {**read(folder / "P2-base.json"), "property": "P9"})


def a_false_claim(folder: Path) -> None:
    """An entry for a false claim, with a file that proves another."""
    question, claims = asked_in(folder)
    claims.append({**claims[1], "claim": "scenario_3(SV,POV,L) -> false"})
    write(folder / QUESTION, question)
    name = name_of_claim("scenario_3(SV,POV,L) -> false", "base")
    shutil.copy(folder / "P2-base.json", folder / f"{name}.json")


def another_schema(folder: Path) -> None:
    write(folder / QUESTION, {**read(folder / QUESTION), "schema": "roadproof/question/9"})


def an_inner_folder(folder: Path) -> None:
    (folder / "inner").mkdir()
    shutil.move(folder / "P2-base.json", folder / "inner" / "P2-base.json")


def a_second_question_beside(folder: Path) -> None:
    shutil.copy(folder / QUESTION, folder / "question-2.json")


def a_link(folder: Path) -> None:
    shutil.move(folder / "P2-base.json", folder.parent / "elsewhere.json")
    (folder / "P2-base.json").symlink_to(folder.parent / "elsewhere.json")


def a_linked_folder(folder: Path) -> None:
    (folder / "more").symlink_to(folder.parent, target_is_directory=True)


def a_file_without_claim(folder: Path) -> None:
    shutil.copy(folder / "P2-base.json", folder / "P10-base.json")


def a_claim_less(folder: Path) -> None:
    question, claims = asked_in(folder)
    del claims[1]
    write(folder / QUESTION, question)


def refuted_is_proved(folder: Path) -> None:
    shutil.copy(folder / "P2-base.json", folder / "C4-scenario-04-base.json")


def other_options(folder: Path) -> None:
    question, _ = asked_in(folder)
    question["basis"]["options"]["lateral_sign"] = "literal"
    write(folder / QUESTION, question)


def a_parameter_out_of_bounds(folder: Path) -> None:
    path = folder / "C4-scenario-04-base.json"
    data = read(path)
    write(path, {**data, "parameters": {**data["parameters"], "b_max": "-8"}})


def an_unknown_parameter(folder: Path) -> None:
    path = folder / "C4-scenario-04-base.json"
    data = read(path)
    write(path, {**data, "parameters": {**data["parameters"], "rhoo": "1"}})


def the_same_key_twice(folder: Path) -> None:
    """A false claim in front of the true one: the last of two keys used to win."""
    path = folder / "P2-base.json"
    path.write_text(path.read_text("utf-8").replace('"claim":', '"claim": "false",\n "claim":', 1), "utf-8")


ATTACKS = {
    relabelled: "it proves danger(SV,POV) <-> danger(POV,SV)",
    a_false_claim: "it proves danger(SV,POV) <-> danger(POV,SV)",
    another_schema: "schema",
    an_inner_folder: "no claim of the question has this name",
    a_second_question_beside: "no claim of the question has this name",
    a_link: "a link is no evidence",
    a_linked_folder: "a link is no evidence",
    a_file_without_claim: "no claim of the question has this name",
    a_claim_less: "no claim of the question has this name",
    refuted_is_proved: "it proves danger(SV,POV) <-> danger(POV,SV)",
    other_options: "it was read with other options",
    a_parameter_out_of_bounds: "b_max=-8: iso34502.spec, line 9, column 1: the library demands b_max > 0",
    an_unknown_parameter: "there is no parameter 'rhoo'; did you mean 'rho'?",
    the_same_key_twice: "the key 'claim' is given twice",
}


@pytest.mark.parametrize("attack", ATTACKS, ids=lambda attack: attack.__name__)
def test_an_attack_on_a_folder_is_found(folder: Path, attack: Callable[[Path], None]) -> None:
    attack(folder)
    findings = check(folder)
    bad = [x for x in findings if x.outcome is not Acceptance.ACCEPTED]
    assert any(ATTACKS[attack] in x.reason for x in bad), [x.reason for x in bad]
    assert code(folder) in (3, 10)


def test_a_file_that_is_gone_leaves_its_claim_in_doubt(folder: Path) -> None:
    (folder / "P2-base.json").unlink()
    assert [x.verdict for x in check(folder) if x.label == "P2 base"] == ["UNKNOWN"]


DAMAGE = {
    "NUL": b'{"schema": "roadproof/certificate/1", "claim": "\\u0000"}',
    "a number of 5,000 digits": b'{"schema": "roadproof/drive/1", "scenario": ' + b"9" * 5000 + b"}",
    "NaN": b'{"schema": NaN}',
    "Infinity": b'{"schema": -Infinity}',
    "a number without end": b'{"schema": 1e999}',
    "UTF-16": '{"schema": "x"}'.encode("utf-16"),
    "deep": b"[" * 100_000,
    "not so deep": b"[" * 60 + b"]" * 60,
    "nothing": b"",
    "a list": b"[]",
    "large": b" " * 5_000_001,
}


@pytest.mark.parametrize("content", DAMAGE.values(), ids=DAMAGE.keys())
def test_a_damaged_file_does_not_take_the_folder_with_it(folder: Path, content: bytes) -> None:
    (folder / "P2-base.json").write_bytes(content)
    outcomes = [x.outcome for x in check(folder)]
    assert outcomes.count(Acceptance.ACCEPTED) == 4
    assert Acceptance.UNREADABLE in outcomes
    assert code(folder) == 3


def test_an_undecided_query_is_unknown(folder: Path) -> None:
    undecided = Checker(bundled_library(), lambda script: "unknown", find_label)
    finding = undecided.check(folder / "P2-base.json")
    assert (finding.outcome, finding.outcome.exit_code) == (Acceptance.UNDECIDED, ExitCode.UNKNOWN)
    assert str(finding).startswith("unknown ")


def test_a_fault_of_ours_is_said_and_the_others_are_checked(folder: Path) -> None:
    def fail(script: str) -> str:
        raise ZeroDivisionError("ours" * 100)

    finding = Checker(bundled_library(), fail, find_label).check(folder / "P2-base.json")
    assert (finding.outcome.exit_code, "ZeroDivisionError" in finding.reason) == (70, True)
    assert len(finding.reason) <= 300


def test_a_file_alone_says_what_it_is_of(folder: Path) -> None:
    assert [x.label for x in check(folder / "P2-base.json")] == ["P2 base"]
    data = read(folder / "P2-base.json")
    write(folder / "P2-base.json", {**data, "property": "P9"})
    assert "is called P9" in check(folder / "P2-base.json")[0].reason
    write(folder / "P2-base.json", {**data, "property": "whatever one likes"})
    assert [x.label for x in check(folder / "P2-base.json")] == ["P2 base"]


def test_a_folder_without_a_question_is_its_files(folder: Path) -> None:
    (folder / QUESTION).unlink()
    found = [(x.outcome, x.label) for x in check(folder) if x.label[:1] == "P"]
    assert found == [(Acceptance.ACCEPTED, x) for x in ("P1 scenario 4 base", "P2 base", "P9 base")]
    for path in folder.iterdir():
        path.unlink()
    with pytest.raises(InputError, match=r"holds no \.json file"):
        check(folder)
    (folder / "P2-base.json").symlink_to(shipped_folder("proofs") / "P2-base.json")
    assert [x.outcome for x in check(folder)] == [Acceptance.REJECTED]


def test_definitions_that_are_not_at_hand_are_said(folder: Path) -> None:
    data = read(folder / "P2-base.json")
    write(folder / "P2-base.json", {**data, "claim": "near(SV,POV) -> near(SV,POV)"})
    finding = check(folder / "P2-base.json")[0]
    assert finding.outcome is Acceptance.UNREADABLE
    assert "there is no definition 'near'" in finding.reason
    assert "--spec FILE" in finding.reason

"""Folders in which one thing was changed: none is accepted, but for changes that change nothing."""

import shutil
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from evidence.folders import changes, check, code, places, read, some_proofs, write
from roadproof.engines.prove.properties import find_label, template_properties
from roadproof.errors import InputError
from roadproof.evidence.checking import Checker
from roadproof.evidence.finding import Acceptance
from roadproof.library.loading import bundled_library
from roadproof.runtime.package_data import shipped
from roadproof.verdict import ExitCode


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    return some_proofs(tmp_path / "proofs")


def test_the_folder_is_accepted_and_names_each_claim(folder: Path) -> None:
    findings = check(folder)
    assert {x.outcome for x in findings} == {Acceptance.ACCEPTED}
    told = [(x.verdict, x.label) for x in findings]
    assert told == [
        ("PROVED", "P1 scenario 4 base"),
        ("PROVED", "P2 base"),
        ("PROVED", "P9 base"),
        ("REFUTED", "C4 scenario 4 base"),
        ("REFUTED", "C5 base"),
    ]
    assert str(findings[0]) == ("PROVED    P1 scenario 4 base  scenario_4(SV,POV,L) -> dangerArises(SV,POV)")


# Changes that are accepted, since what comes out is evidence of the same claim: by file, place and change
# ("" is any), and why.
EQUIVALENT = {
    "P1-scenario-04-base.json": {
        "formulas: twice": "a formula that no entry points to",
        "times: turned around": "the order of a list of names",
        "instances: turned around": "the order of a list of instances",
        "tableau": "the proof for Coq, which a solver is not asked about; see tests/kernel/test_refused.py",
    },
    "C4-scenario-04-base-drive.json": {
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
    "index.json": {
        "roadproof: ": "which version made the folder: nothing rests on it",
        "library: removed": "as in earlier folders: claims are read with the library at hand",
        "options: ": "what is not named is the default, which it is",
        "options.lateral_sign: removed": "the default",
        "options.lateral_rss: removed": "the default",
        "options.speed: removed": "the default",
        "options.rss_form: removed": "the default",
        "specs: null": "there are none",
        "specs: removed": "there are none",
        "claims: turned around": "the order of claims",
        "claims.4: removed": "a folder with one claim less, which check does not print",
        "claims.4.evidence: removed": "it is null",
        "claims.4.counterexample.parameters.": "another trace, which is judged",
        "claims.4.counterexample.instants.0.values": "another trace, which is judged",
    },
}


@pytest.mark.parametrize("name", EQUIVALENT)
def test_no_change_is_accepted_that_changes_what_is_said(folder: Path, name: str) -> None:
    path = folder / name
    whole = read(path)
    claims = [(x.label, x.claim) for x in check(folder)]
    accepted, tried = [], 0
    for place in places(whole):
        for word, changed in changes(whole, place):
            write(path, changed)
            findings = check(folder)
            tried += 1
            if all(x.outcome is Acceptance.ACCEPTED for x in findings):
                accepted.append(f"{'.'.join(map(str, place))}: {word}")
                assert {(x.label, x.claim) for x in findings} <= set(claims)
    assert tried > 300
    assert [x for x in accepted if not any(x.startswith(known) for known in EQUIVALENT[name])] == []


# --- attacks on the folder as a whole ------------------------------------------------------------


def entry(index: Any, label: str) -> Any:
    return next(x for x in index["claims"] if x["property"] == label)


def relabelled(folder: Path) -> None:
    """P9 is P2's certificate under the name of P9."""
    write(folder / "P9-base.json", {**read(folder / "P2-base.json"), "property": "P9"})


def deleted(folder: Path) -> None:
    (folder / "P1-scenario-04-base.json").unlink()
    (folder / "P2-base.json").unlink()


def a_false_claim(folder: Path) -> None:
    """An entry for a false claim, with a file that proves another."""
    index = read(folder / "index.json")
    claim = {"property": "claim", "claim": "scenario_3(SV,POV,L) -> false", "scenario": None}
    index["claims"].append({**entry(index, "P2"), **claim})
    write(folder / "index.json", index)


def named_alike(folder: Path) -> None:
    """A claim of one's own is called P3."""
    index = read(folder / "index.json")
    entry(index, "P2")["property"] = "P3"
    write(folder / "index.json", index)


def twice(folder: Path) -> None:
    index = read(folder / "index.json")
    index["claims"].append(entry(index, "P2"))
    write(folder / "index.json", index)


def outside(folder: Path) -> None:
    shutil.move(folder / "P2-base.json", folder.parent / "P2-base.json")
    index = read(folder / "index.json")
    entry(index, "P2")["evidence"] = "../P2-base.json"
    write(folder / "index.json", index)


def another_schema(folder: Path) -> None:
    write(folder / "index.json", {**read(folder / "index.json"), "schema": "roadproof/index/9"})


def two_indices(folder: Path) -> None:
    """What the outer index names is under an inner one, which says something else."""
    inner = folder / "inner"
    inner.mkdir()
    index = read(folder / "index.json")
    entry(index, "P2")["evidence"] = "inner/P2-base.json"
    shutil.move(folder / "P2-base.json", inner / "P2-base.json")
    write(inner / "index.json", {**index, "claims": []})
    write(folder / "index.json", index)


def a_second_index_beside(folder: Path) -> None:
    shutil.copy(folder / "index.json", folder / "index-2.json")


def a_link(folder: Path) -> None:
    shutil.move(folder / "P2-base.json", folder.parent / "elsewhere.json")
    (folder / "P2-base.json").symlink_to(folder.parent / "elsewhere.json")


def a_linked_folder(folder: Path) -> None:
    (folder / "more").symlink_to(folder.parent, target_is_directory=True)


def a_file_without_entry(folder: Path) -> None:
    shutil.copy(folder / "P2-base.json", folder / "P10-base.json")


def refuted_is_proved(folder: Path) -> None:
    index = read(folder / "index.json")
    entry(index, "C4")["verdict"] = "PROVED"
    write(folder / "index.json", index)


def proved_is_unknown(folder: Path) -> None:
    index = read(folder / "index.json")
    entry(index, "P2")["verdict"] = "UNKNOWN"
    write(folder / "index.json", index)


def other_options(folder: Path) -> None:
    write(folder / "index.json", {**read(folder / "index.json"), "options": {"lateral_sign": "literal"}})


def a_parameter_out_of_bounds(folder: Path) -> None:
    path = folder / "C4-scenario-04-base-drive.json"
    data = read(path)
    write(path, {**data, "parameters": {**data["parameters"], "b_max": "-8"}})


def an_unknown_parameter(folder: Path) -> None:
    path = folder / "C4-scenario-04-base-drive.json"
    data = read(path)
    write(path, {**data, "parameters": {**data["parameters"], "rhoo": "1"}})


def the_same_key_twice(folder: Path) -> None:
    """A false claim in front of the true one: the last of two keys used to win."""
    path = folder / "P2-base.json"
    path.write_text(path.read_text("utf-8").replace('"claim":', '"claim": "false",\n "claim":', 1), "utf-8")


ATTACKS = {
    relabelled: "is called P9, but its claim is that of P2",
    deleted: "is not there",
    a_false_claim: "says PROVED: scenario_3(SV,POV,L) -> false, but its file",
    named_alike: "is called P3, but its claim is that of P2",
    twice: "it says again what",
    outside: "is no file in the folder of the index",
    another_schema: "is none of an index",
    two_indices: "is not there, or another index is about it",
    a_second_index_beside: "its schema is 'roadproof/index/1'",
    a_link: "a link is no evidence",
    a_linked_folder: "a link is no evidence",
    a_file_without_entry: "no entry of the index names it",
    refuted_is_proved: "its file is a drive",
    proved_is_unknown: "UNKNOWN needs no evidence",
    other_options: "has lateral_sign=literal, but its file lateral_sign=rss",
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


def test_a_folder_without_an_index_is_its_files(folder: Path) -> None:
    (folder / "index.json").unlink()
    found = [(x.outcome, x.label) for x in check(folder)]
    assert found[1:] == [(Acceptance.ACCEPTED, x) for x in ("P1 scenario 4 base", "P2 base", "P9 base")]
    for path in folder.iterdir():
        path.unlink()
    with pytest.raises(InputError, match=r"holds no \.json file"):
        check(folder)
    (folder / "P2-base.json").symlink_to(shipped("proofs") / "P2-base.json")
    assert [x.outcome for x in check(folder)] == [Acceptance.REJECTED]


def test_definitions_that_are_not_at_hand_are_said(folder: Path) -> None:
    data = read(folder / "P2-base.json")
    write(folder / "P2-base.json", {**data, "claim": "near(SV,POV) -> near(SV,POV)"})
    finding = check(folder / "P2-base.json")[0]
    assert finding.outcome is Acceptance.UNREADABLE
    assert "there is no definition 'near'" in finding.reason
    assert "--spec FILE" in finding.reason


def test_the_shipped_index_names_every_claim() -> None:
    assert len(read(shipped("proofs") / "index.json")["claims"]) == len(template_properties())

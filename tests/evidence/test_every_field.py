"""Every field of every index and kept answer, changed alone: ``check`` rejects it, or lists the field."""

import json
import shutil
from collections.abc import Callable, Iterator
from copy import deepcopy
from itertools import combinations
from pathlib import Path
from random import Random
from typing import Any

import pytest

import roadproof as rp
from evidence.folders import (
    Place,
    check,
    code,
    conclusions,
    places,
    read,
    reseal,
    some_proofs,
    surveyed,
    write,
)
from evidence.folders import changes as folder_changes
from evidence.kinds import MAKE, copy_of
from roadproof.engines.prove.properties import find_label, name_of_claim
from roadproof.errors import InputError
from roadproof.evidence.checking import Checker
from roadproof.evidence.finding import Acceptance
from roadproof.library.loading import bundled_library
from roadproof.questions.data import KINDS as QUESTIONS
from roadproof.questions.data import QUESTION
from roadproof.runtime.package_data import shipped
from roadproof.verdict import ExitCode

# Without an index; and tests/analysis/test_catalogue_again.py changes that of a catalogue, beside its tests.
OLD = [kind for kind in MAKE if {"proofs": "prove"}.get(kind, kind) not in QUESTIONS]
"""Kinds of folders with an index; tests/questions/test_forgery.py forges the others."""
INDEXED = [kind for kind in OLD if kind != "catalogue"]
# Changes that leave what is said as true as it was, and why.
EQUIVALENT = {
    ("proofs", "claims[].part"): "the number of a claim of a user's, whose text is beside it",
    ("proofs", "claim.part"): "the same",
    ("witness", "outcome.parameters"): "of a proof, which is about all values",
}


def leaves(content: Any, at: Place = ()) -> Iterator[Place]:
    """The places of all values that hold no others; of every list itself, the first entry and the last."""
    if isinstance(content, dict) and content:
        for key, value in content.items():
            yield from leaves(value, (*at, key))
    elif isinstance(content, list) and content:
        yield at
        for k in sorted({0, len(content) - 1}):
            yield from leaves(content[k], (*at, k))
    else:
        yield at


def path_of(at: Place) -> str:
    """``explored[].values[].at[]``"""
    return "".join("[]" if isinstance(key, int) else f".{key}" for key in at).removeprefix(".")


def another(value: Any) -> Any:
    match value:
        case bool():
            return not value
        case int() | float():
            return value + 1
        case str():
            return value + "1" if not value or value[-1].isdigit() else f"{value} and x"
        case list():
            return value[1:] or ["x"]
        case dict():
            return {"x": "1"}
    return "x"


def changes(content: Any) -> Iterator[tuple[str, Any]]:
    """The content with each of its values changed alone, and the path of that value."""
    for at in leaves(content):
        changed = deepcopy(content)
        place = changed
        for key in at[:-1]:
            place = place[key]
        place[at[-1]] = another(place[at[-1]])
        yield path_of(at), changed


def is_listed(path: str, said: tuple[str, ...]) -> bool:
    return any(path == x or path.startswith((f"{x}.", f"{x}[")) for x in said)


def is_equivalent(kind: str, path: str) -> bool:
    return any(kind == known and is_listed(path, (field,)) for known, field in EQUIVALENT)


def not_checked(folder: Path) -> tuple[str, ...]:
    return surveyed(folder).told[0].not_checked


def is_accepted(folder: Path) -> bool:
    return all(x.outcome is Acceptance.ACCEPTED for x in check(folder))


def is_silent(folder: Path, field: str) -> bool:
    """Whether the folder is accepted, and ``field`` is not listed as unchecked."""
    said = surveyed(folder)
    if is_listed(field, said.told[0].not_checked):
        return False
    return all(x.outcome is Acceptance.ACCEPTED for x in conclusions(said))


@pytest.mark.parametrize("kind", INDEXED)
def test_no_field_is_changed_in_silence(kind: str, tmp_path: Path) -> None:
    folder = copy_of(kind, tmp_path)
    shutil.rmtree(folder / "answers")  # kept answers would tell that the index was changed
    (folder / "question.json").unlink()
    whole = read(folder / "index.json")
    assert is_accepted(folder)
    said = not_checked(folder)
    accepted: list[str] = []
    tried = 0
    for path, changed in changes(whole):
        if is_listed(path, said):
            continue
        write(folder / "index.json", changed)
        tried += 1
        if is_silent(folder, path):
            accepted.append(path)
    assert tried > 10
    assert not (left := [x for x in accepted if not is_equivalent(kind, x)]), "\n".join(left)


@pytest.mark.parametrize("beside", ["with the index", "without"])
@pytest.mark.parametrize("kind", OLD)
def test_no_field_of_a_kept_answer_is_changed_in_silence(kind: str, beside: str, tmp_path: Path) -> None:
    folder = copy_of(kind, tmp_path)
    if beside == "without":
        (folder / "index.json").unlink(missing_ok=True)
    assert is_accepted(folder)
    said = not_checked(folder)
    accepted: list[str] = []
    tried = 0
    for path in (folder / "question.json", *chosen(folder / "answers")):
        whole = read(path)
        for field, changed in changes(whole):
            if field == "seal" or is_listed(field, said):
                continue
            write(path, changed)
            for answer in (folder / "answers").iterdir() if path.name == "question.json" else [path]:
                reseal(answer)
            tried += 1
            if is_silent(folder, field):
                accepted.append(f"{path.name}: {field}")
        write(path, whole)
        for answer in (folder / "answers").iterdir():
            reseal(answer)
    assert tried > 3
    left = sorted(x for x in {*accepted} if not is_equivalent(kind, x.partition(": ")[2]))
    assert not left, "\n".join(left)


def chosen(answers: Path) -> list[Path]:
    """An answer of each shape."""
    found = {str([*changed_paths(read(x))]): x for x in sorted(answers.iterdir())}
    return [*found.values()]


def changed_paths(content: Any) -> list[str]:
    return sorted({path_of(x) for x in leaves(content)})


def test_check_lists_what_it_does_not_check(tmp_path: Path) -> None:
    found = rp.explore("v_lon(SV) > 30 m/s", vary={"SV.a_lon.min": (-3, -1)}, steps=2, out=tmp_path, jobs=1)
    found.add_files(False)
    (tmp_path / "notes.txt").write_text("mine")
    checked = rp.check(tmp_path)
    [line] = [x for x in str(checked).splitlines() if x.startswith(f"not checked in {tmp_path}: ")]
    assert line.endswith("notes.txt")
    assert json.loads(json.dumps(checked.as_data()))["not_checked"][str(tmp_path)][-1] == "notes.txt"


# --- Evidence of one entry put under another one, of every kind of index: ``check`` rejects the folder

MOST = 24  # pairs of entries of one kind
EVIDENCE = ("certificate", "drive", "evidence", "trace")
SAID = ("claim", "formula", "verdict", "premise", "conclusion", "gaps", "core")
"""What an entry says of its evidence, which an attacker exchanges with it."""
KINDS = [kind for kind in OLD if kind not in ("witness", "gaps")]  # these are in the second test


def holders(content: Any, at: Place = ()) -> Iterator[Place]:
    """The places of all objects that name evidence."""
    if isinstance(content, dict):
        if any(content.get(key) for key in EVIDENCE):
            yield at
        for key, value in content.items():
            yield from holders(value, (*at, key))
    elif isinstance(content, list):
        for k, value in enumerate(content):
            yield from holders(value, (*at, k))


def at_place(content: Any, place: Place) -> Any:
    for key in place:
        content = content[key]
    return content


def exchanged(whole: Any, one: Place, other: Place, keys: tuple[str, ...]) -> Any | None:
    """The index with these fields of two entries exchanged; None where that changes nothing."""
    changed = deepcopy(whole)
    first, second = at_place(changed, one), at_place(changed, other)
    for key in keys:
        values = first.pop(key, None), second.pop(key, None)
        for entry, value in zip((second, first), values, strict=True):
            if value is not None or key in at_place(whole, one):
                entry[key] = value
    return None if changed == whole else changed


@pytest.mark.parametrize("kind", KINDS)
def test_evidence_of_another_entry_is_rejected(kind: str, tmp_path: Path) -> None:
    folder = copy_of(kind, tmp_path)
    shutil.rmtree(
        folder / "answers", ignore_errors=True
    )  # kept answers would tell that the index was changed
    (folder / "question.json").unlink(missing_ok=True)
    whole = read(folder / "index.json")
    assert {x.outcome for x in check(folder)} == {Acceptance.ACCEPTED}
    places = [*holders(whole)]
    pairs = [(a, b) for a, b in combinations(places, 2) if a[: len(b)] != b and b[: len(a)] != a]
    Random(kind).shuffle(pairs)
    tried, accepted = 0, []
    for one, other in pairs[: MOST if kind != "catalogue" else MOST // 4]:
        for keys in (EVIDENCE, (*EVIDENCE, *SAID)):
            changed = exchanged(whole, one, other, keys)
            mine, theirs = at_place(whole, one), at_place(whole, other)
            if changed is None or _alike(mine, theirs) or (keys != EVIDENCE and _are_numbered(mine, theirs)):
                continue
            write(folder / "index.json", changed)
            tried += 1
            found = check(folder) if kind != "catalogue" else rp.check(folder, jobs=1).findings
            if all(x.outcome is Acceptance.ACCEPTED for x in found):
                accepted.append((one, other, keys == EVIDENCE))
    assert tried >= 1
    assert accepted == []


def _alike(one: dict[str, Any], other: dict[str, Any]) -> bool:
    """Whether two entries say the same, so that the evidence of each is that of the other."""
    said = [{x: entry.get(x) for x in ("claim", "formula")} for entry in (one, other)]
    return said[0] == said[1] and any(said[0].values())


def _are_numbered(one: dict[str, Any], other: dict[str, Any]) -> bool:
    """Whether two claims have nothing but a running number beside what they say and its evidence."""
    return one.get("property") == other.get("property") == "claim" and one["set"] == other["set"]


def files_of(folder: Path) -> list[Path]:
    """The certificates and drive files of a folder."""
    found = (x for x in sorted(folder.rglob("*.json")) if x.parent.name != "answers")
    return [x for x in found if x.name not in ("index.json", "question.json")]


def _shown(file: Path) -> tuple[object, ...]:
    """What a file is evidence of; two files that say the same here may stand for each other."""
    said = read(file)
    road = said["road"]["name"] if "road" in said else ""
    starts = {name: {**x, "pieces": 0} for name, x in said.get("vehicles", {}).items()}
    claim = said.get("claim", said.get("formula"))
    return claim, said["set"], said.get("assuming"), said.get("parameters"), road, starts


@pytest.mark.parametrize("kind", MAKE)
def test_evidence_of_any_index_under_an_entry_of_another_is_rejected(kind: str, tmp_path: Path) -> None:
    """The files of an entry are those of an entry of each of the other kinds, and of its own kind."""
    folder = copy_of(kind, tmp_path / "this")
    if (folder / "index.json").exists():
        shutil.rmtree(folder / "answers", ignore_errors=True)
        (folder / "question.json").unlink(missing_ok=True)
    assert {x.outcome for x in check(folder)} == {Acceptance.ACCEPTED}
    chance, accepted = Random(kind), []
    for other in MAKE:
        theirs = files_of(copy_of(other, tmp_path / "other" / other))
        pairs = [(a, b) for a in files_of(folder) for b in theirs if _shown(a) != _shown(b)]
        assert pairs
        for mine, foreign in chance.sample(pairs, min(len(pairs), 2 if other == kind else 1)):
            before = mine.read_bytes()
            mine.write_bytes(foreign.read_bytes())
            for answer in folder.glob("answers/*.json"):
                reseal(answer)
            found = check(folder) if kind != "catalogue" else rp.check(folder, jobs=1).findings
            if all(x.outcome is Acceptance.ACCEPTED for x in found):
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
        ("PROVED", "P1 scenario 4 base"),
        ("PROVED", "P2 base"),
        ("PROVED", "P9 base"),
        ("REFUTED", "C4 scenario 4 base"),
        ("REFUTED", "C5 base"),
    ]
    assert str(findings[0]) == ("PROVED    P1 scenario 4 base  scenario_4(SV,POV,L) -> dangerArises(SV,POV)")


# Changes that are accepted, since what comes out is evidence of the same claim: by file, place and change
# ("" is any), and why.
SAME_ANSWERS = {
    "P1-scenario-04-base.json": {
        "formulas: twice": "a formula that no entry points to",
        "times: turned around": "the order of a list of names",
        "instances: turned around": "the order of a list of instances",
        "tableau": "the proof for Coq, which a solver is not asked about; see tests/kernel/test_refused.py",
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


@pytest.mark.parametrize("name", SAME_ANSWERS)
def test_no_change_is_accepted_that_changes_what_is_said(folder: Path, name: str) -> None:
    path = folder / name
    whole = read(path)
    claims = [(x.label, x.claim) for x in check(folder)]
    accepted, tried = [], 0
    for place in places(whole):
        for word, changed in folder_changes(whole, place):
            write(path, changed)
            findings = check(folder)
            tried += 1
            if all(x.outcome is Acceptance.ACCEPTED for x in findings):
                accepted.append(f"{'.'.join(map(str, place))}: {word}")
                assert {(x.label, x.claim) for x in findings} <= set(claims)
    assert tried > 300
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
    (folder / "P2-base.json").symlink_to(shipped("proofs") / "P2-base.json")
    assert [x.outcome for x in check(folder)] == [Acceptance.REJECTED]


def test_definitions_that_are_not_at_hand_are_said(folder: Path) -> None:
    data = read(folder / "P2-base.json")
    write(folder / "P2-base.json", {**data, "claim": "near(SV,POV) -> near(SV,POV)"})
    finding = check(folder / "P2-base.json")[0]
    assert finding.outcome is Acceptance.UNREADABLE
    assert "there is no definition 'near'" in finding.reason
    assert "--spec FILE" in finding.reason

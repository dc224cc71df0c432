"""Answers that a run has kept in a folder: only those count that are as they were written."""

import json
import os
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Annotated, Any

import pytest
from jsonschema import Draft202012Validator
from roadproof.analysis.overlap import SCHEMA

from asking import prove
from evidence.folders import changes, check, places
from roadproof.errors import InputError
from roadproof.evidence.certificate import to_json
from roadproof.evidence.codec import Rule, read
from roadproof.evidence.codec import write as write_json
from roadproof.evidence.finding import NO_EVIDENCE as MISSING_EVIDENCE
from roadproof.evidence.finding import Acceptance, Finding, exit_code, summary
from roadproof.evidence.journal import ANSWERS, HEAD, answers_of, head_of, read_kept, seal_of
from roadproof.evidence.json_schema import schema_of
from roadproof.evidence.specifications import read_beside
from roadproof.evidence.strict import Fields
from roadproof.library.bind import default_values
from roadproof.library.loading import bundled_library
from roadproof.verdict import ExitCode

LIBRARY = bundled_library()
PAIRS = ((5, 6), (3, 4))


@cache
def certificate(pair: tuple[int, int]) -> str:
    a, b = pair
    made = prove(LIBRARY.select(), f"not (scenario_{a}(SV,POV,L) and scenario_{b}(SV,POV,L))").certificate
    assert made is not None
    return to_json(made)


def answer(pair: tuple[int, int], folder: Path) -> dict[str, Any]:
    a, b = pair
    name = f"impossible-{a}-{b}.json"
    (folder / name).write_text(certificate(pair), "utf-8")
    verdict = {
        "a": a,
        "b": b,
        "set_a": "base",
        "set_b": "base",
        "verdict": "IMPOSSIBLE",
        "formula": f"not (scenario_{a}(SV,POV,L) and scenario_{b}(SV,POV,L))",
        "core": [],
        "cores": [],
        "certificate": name,
        "drive": None,
        "reason": "",
        "seconds": 0.5,
    }
    return {"evidence": [name], "verdict": verdict}


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """A folder with a question and two answers."""
    made = tmp_path / "out"
    made.mkdir()
    parameters = {name: str(value) for name, value in sorted(default_values(LIBRARY).items())}
    said = {"set": "base", "lanes": "same", "roles": "same", "start": "same"}
    said |= {"options": dict(LIBRARY.select().options), "parameters": parameters, "specs": []}
    head = head_of(SCHEMA, "a question", said)
    records = [answer(pair, made) for pair in PAIRS]
    write(made, [head, *({**x, "seal": seal_of(x, "a question", made)} for x in records)])
    return made


def answers(folder: Path) -> tuple[list[Any], list[str]]:
    """The pairs that count, and what is wrong with the others."""
    kept = read_kept(folder)
    assert kept is not None
    read = list(answers_of(kept, LIBRARY))
    good = [x.record.content for x in read if x.record is not None and not x.fault]
    return [(x["verdict"]["a"], x["verdict"]["b"]) for x in good], [x.fault for x in read if x.fault]


def lines(folder: Path) -> list[Any]:
    """The question and its answers, in the order of ``PAIRS``."""
    paths = [folder / HEAD, *(folder / ANSWERS / f"{name_of(*pair)}.json" for pair in PAIRS)]
    return [json.loads(path.read_text("utf-8")) for path in paths]


def write(folder: Path, records: list[Any]) -> None:
    head, *answers = records
    (folder / ANSWERS).mkdir(exist_ok=True)
    (folder / HEAD).write_text(json.dumps(head), "utf-8")
    for pair, record in zip(PAIRS, answers, strict=True):
        (folder / ANSWERS / f"{name_of(*pair)}.json").write_text(json.dumps(record), "utf-8")


def name_of(a: int, b: int) -> str:
    return f"base-{a:02}-base-{b:02}"


def test_answers_are_kept_and_checked(folder: Path) -> None:
    assert answers(folder) == (sorted(PAIRS), [])
    findings = check(folder)
    assert [(x.outcome, x.verdict, x.label) for x in findings] == [
        (Acceptance.ACCEPTED, "IMPOSSIBLE", "scenarios 3@base and 4@base"),
        (Acceptance.ACCEPTED, "IMPOSSIBLE", "scenarios 5@base and 6@base"),
    ]


def test_a_verdict_that_was_exchanged_is_found(folder: Path) -> None:
    path = folder / ANSWERS / f"{name_of(5, 6)}.json"
    path.write_text(path.read_text("utf-8").replace("IMPOSSIBLE", "WITNESSED", 1), "utf-8")
    assert any(x.outcome is Acceptance.REJECTED and "seal" in x.reason for x in check(folder))
    kept, told = answers(folder)
    assert kept == [(3, 4)]
    assert "is not what" in told[0] or "are not what its seal was made for" in told[0]


def test_no_change_of_a_line_counts(folder: Path) -> None:
    """With the seal that was there; and, where the line says something else, with one that was made anew."""
    head, first, second = lines(folder)
    told_only = ("verdict.core", "verdict.cores", "verdict.reason", "verdict.seconds")
    tried, counting = 0, []
    for place in places(first):
        for word, changed in changes(first, place):
            name = f"{'.'.join(map(str, place))}: {word}"
            tried += 1
            write(folder, [head, changed, second])
            assert any(x.outcome is not Acceptance.ACCEPTED for x in check(folder)), name
            assert answers(folder)[0] == [(3, 4)], name
            if name.startswith(told_only) or "evidence" not in changed or place[0] in ("seal", "evidence"):
                continue
            try:
                sealed = {**changed, "seal": seal_of(changed, head["question"], folder)}
            except (TypeError, ValueError):
                continue
            write(folder, [head, sealed, second])
            if answers(folder)[0] != [(3, 4)]:
                counting.append(name)
    assert tried > 150
    assert counting == []


def test_other_evidence_is_found(folder: Path) -> None:
    (folder / "impossible-5-6.json").write_text(certificate((3, 4)), "utf-8")
    assert answers(folder)[0] == [(3, 4)]


def test_other_evidence_is_found_under_a_new_seal(folder: Path) -> None:
    head, first, second = lines(folder)
    (folder / "impossible-5-6.json").write_text(certificate((3, 4)), "utf-8")
    write(folder, [head, {**first, "seal": seal_of(first, head["question"], folder)}, second])
    assert any("but its file" in x.reason for x in check(folder))
    kept, told = answers(folder)
    assert kept == [(3, 4)]
    assert "but its file" in told[0]


def test_evidence_that_is_gone_is_asked_again(folder: Path) -> None:
    (folder / "impossible-5-6.json").unlink()
    kept, told = answers(folder)
    assert (kept, len(told)) == ([(3, 4)], 1)


def test_an_answer_cut_short_is_told(folder: Path) -> None:
    path = folder / ANSWERS / f"{name_of(3, 4)}.json"
    path.write_bytes(path.read_bytes()[:-40])
    kept, told = answers(folder)
    assert (kept, len(told)) == ([(5, 6)], 1)


def seals_are_not_compared(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("roadproof.evidence.journal.seal_of", lambda record, question, folder: record["seal"])


def evidence_is_not_looked_at(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("roadproof.evidence.journal.read_record", lambda *_: [])
    monkeypatch.setattr("roadproof.evidence.journal.faults_of_record", lambda *_: iter(()))


def test_the_seal_alone_and_the_evidence_alone_are_not_enough(
    folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    head, first, second = lines(folder)
    slower = {**first, "verdict": {**first["verdict"], "seconds": 9.0}}
    write(folder, [head, slower, second])
    with monkeypatch.context() as patch:
        seals_are_not_compared(patch)
        assert answers(folder)[0] == sorted(PAIRS)
    wrong = {**first, "verdict": {**first["verdict"], "verdict": "WITNESSED"}}
    sealed = {**wrong, "seal": seal_of(wrong, head["question"], folder)}
    write(folder, [head, sealed, second])
    with monkeypatch.context() as patch:
        evidence_is_not_looked_at(patch)
        assert answers(folder)[0] == sorted(PAIRS)
    write(folder, [head, sealed, second])
    assert answers(folder)[0] == [(3, 4)]


# --- Answers as dataclasses: what is read and refused, and the JSON Schema that follows -------------


@dataclass(frozen=True, kw_only=True)
class Sample:
    """Tuples of a length, names by rule, lists without repetition."""

    span: tuple[float, float | None]
    both: tuple[int, int]
    counts: Mapping[Annotated[str, Rule(pattern="^[0-9]+$")], int]
    names: Annotated[tuple[str, ...], Rule(least=1, unique=True)]


GOOD: Mapping[str, Any] = {"span": [0, None], "both": [1, 2], "counts": {"4": 1}, "names": ["a", "b"]}
CODEC_SCHEMA = Draft202012Validator(schema_of(Sample, Sample, "sample.json", "a sample"))


def test_what_is_read_is_written_again() -> None:
    assert write_json(read(Sample, GOOD, "here")) == GOOD
    assert CODEC_SCHEMA.is_valid(GOOD)


@pytest.mark.parametrize(
    ("field", "bad", "told"),
    [
        ("span", [0], "here, span: \\[0\\] is no list of 2 items"),
        ("span", [0, 1, 2], "is no list of 2 items"),
        ("span", [None, 0], "here, span, item 1: None is no number"),
        ("span", "ab", "is no list of 2 items"),
        ("both", [1, 2.5], "here, both, item 2: 2.5 is not a whole number"),
        ("counts", {"four": 1}, "here, counts: 'four' is no text like"),
        ("counts", {"4": "1"}, "here, counts.4: '1' is not a whole number"),
        ("names", ["a", "a"], "here, names: \\['a', 'a'\\] names something twice"),
        ("names", [], "it has 0 entries, and needs 1"),
    ],
)
def test_reader_and_schema_refuse_the_same(field: str, bad: object, told: str) -> None:
    with pytest.raises(InputError, match=told):
        read(Sample, {**GOOD, field: bad}, "here")
    assert not CODEC_SCHEMA.is_valid({**GOOD, field: bad})


# --- Journals as they are read ----------------------------------------------------------------------


def test_a_seal_is_of_the_question_too(folder: Path) -> None:
    head, *records = lines(folder)
    write(folder, [{**head, "question": "another question"}, *records])
    journal = read_kept(folder)
    assert journal is not None
    assert all("not what its seal was made for" in x.fault for x in journal.lines)


@pytest.mark.parametrize("change", [{"schema": "roadproof/journal/9"}, {"of": "roadproof/nothing/1"}])
def test_what_is_no_journal_is_refused(change: dict[str, str], folder: Path) -> None:
    head, *records = lines(folder)
    write(folder, [{**head, **change}, *records])
    with pytest.raises(InputError, match=r"schema=|there are journals of"):
        read_kept(folder)


def test_a_folder_without_a_question_has_no_kept_answers(tmp_path: Path) -> None:
    assert read_kept(tmp_path) is None


# --- What is said at the end of a check: how many claims came out how, and the exit code ------------


def finding(outcome: Acceptance, kind: str = "certificate") -> Finding:
    return Finding("x.json", kind, outcome)


def test_the_summary_counts_each_outcome() -> None:
    accepted, rejected = finding(Acceptance.ACCEPTED), finding(Acceptance.REJECTED)
    assert summary([accepted] * 3, "z3") == "3 of 3 accepted by z3 and the exact judge"
    assert summary([accepted, rejected, rejected], "z3").endswith(
        "1 of 3 accepted by z3 and the exact judge, 2 rejected"
    )
    other = [finding(x) for x in (Acceptance.UNDECIDED, Acceptance.UNREADABLE, Acceptance.FAULT)]
    assert summary(other, "cvc5").startswith("0 of 3 accepted by cvc5")
    assert summary(other, "cvc5").endswith(", 1 unknown, 1 unreadable, 1 our fault")


def test_answers_without_evidence_are_counted_apart() -> None:
    found = [finding(Acceptance.ACCEPTED), finding(Acceptance.ACCEPTED, MISSING_EVIDENCE)]
    assert summary(found, "z3") == "1 of 1 accepted by z3 and the exact judge; 1 without evidence"


def test_the_exit_code_is_that_of_the_gravest() -> None:
    assert exit_code([]) == ExitCode.UNKNOWN  # nothing was accepted
    assert exit_code(map(finding, Acceptance)) == ExitCode.OUR_FAULT
    assert exit_code([finding(Acceptance.UNDECIDED), finding(Acceptance.ACCEPTED)]) == ExitCode.UNKNOWN


# --- Specification files beside evidence: what they may do, and where they may lie ------------------

MORE = "def slower(a, b: vehicle) := v_lon(a) < v_lon(b)\n"
OTHER = "def danger(a, b: vehicle) := true\n"


def named(*names: str) -> Fields:
    return Fields({"specs": list(names)}, "index.json")


def test_a_file_that_adds_a_definition_is_read(tmp_path: Path) -> None:
    (tmp_path / "more.spec").write_text(MORE, "utf-8")
    library, paths = read_beside(named("more.spec"), tmp_path, ())
    assert "slower" in library.select().definitions
    assert paths == (tmp_path / "more.spec",)
    library, _ = read_beside(named("more.spec"), tmp_path, paths)  # given on the command line too
    assert "slower" in library.select().definitions


def test_without_files_there_is_the_library_alone(tmp_path: Path) -> None:
    for data in (None, Fields({}, "index.json"), named()):
        library, paths = read_beside(data, tmp_path, ())
        assert library.select().definitions.keys() == bundled_library().select().definitions.keys()
        assert paths == ()


def test_a_file_that_changes_a_definition_is_refused(tmp_path: Path) -> None:
    (tmp_path / "other.spec").write_text(OTHER, "utf-8")
    with pytest.raises(InputError, match="changes 'danger' of the library"):
        read_beside(named("other.spec"), tmp_path, ())


@pytest.mark.parametrize(
    "name", ["../more.spec", "below/more.spec", "below\\more.spec", ".", "..", "", "none", "link"]
)
def test_files_elsewhere_are_refused(name: str, tmp_path: Path) -> None:
    folder = tmp_path / "folder"
    for place in (tmp_path, folder / "below"):
        place.mkdir(parents=True, exist_ok=True)
        (place / "more.spec").write_text(MORE, "utf-8")
    (folder / "below\\more.spec").write_text(MORE, "utf-8")
    os.symlink(tmp_path / "more.spec", folder / "link")
    with pytest.raises(InputError, match=r"specs: (.* is no file in the folder|there is no file)"):
        read_beside(named(name), folder, ())

"""Answers of earlier versions, lines of one file: only those count that are as they were written."""

import json
from functools import cache
from pathlib import Path
from typing import Any

import pytest

from asking import prove
from evidence.folders import changes, check, places
from roadproof.analysis.overlap import SCHEMA
from roadproof.evidence.certificate import to_json
from roadproof.evidence.finding import Acceptance
from roadproof.evidence.journal import NAME, answers_of, head_of, read_kept, seal_of
from roadproof.library.bind import default_values
from roadproof.library.loading import bundled_library

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
    """A folder as earlier versions wrote it: a head, and a line an answer."""
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
    return [json.loads(line) for line in (folder / NAME).read_text("utf-8").splitlines()]


def write(folder: Path, records: list[Any]) -> None:
    (folder / NAME).write_text("".join(json.dumps(record) + "\n" for record in records), "utf-8")


def test_answers_are_kept_and_checked(folder: Path) -> None:
    assert answers(folder) == (list(PAIRS), [])
    findings = check(folder)
    assert [(x.outcome, x.verdict, x.label) for x in findings] == [
        (Acceptance.ACCEPTED, "IMPOSSIBLE", "scenarios 5@base and 6@base"),
        (Acceptance.ACCEPTED, "IMPOSSIBLE", "scenarios 3@base and 4@base"),
    ]


def test_a_verdict_that_was_exchanged_is_found(folder: Path) -> None:
    path = folder / NAME
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


def test_a_last_line_cut_short_is_left_out_without_a_word(folder: Path) -> None:
    path = folder / NAME
    path.write_bytes(path.read_bytes()[:-40])
    assert answers(folder) == ([(5, 6)], [])


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
        assert answers(folder)[0] == list(PAIRS)
    wrong = {**first, "verdict": {**first["verdict"], "verdict": "WITNESSED"}}
    sealed = {**wrong, "seal": seal_of(wrong, head["question"], folder)}
    write(folder, [head, sealed, second])
    with monkeypatch.context() as patch:
        evidence_is_not_looked_at(patch)
        assert answers(folder)[0] == list(PAIRS)
    write(folder, [head, sealed, second])
    assert answers(folder)[0] == [(3, 4)]

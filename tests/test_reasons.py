"""Reasons are an enumeration: each kind has its words once, and is used."""

import ast
import pickle
from collections.abc import Iterator
from pathlib import Path

import pytest

import roadproof
from roadproof.evidence.codec import read, write
from roadproof.evidence.finding import Acceptance, Finding
from roadproof.reasons import NO_REASON, ReasonKind, joined

PACKAGE = Path(roadproof.__file__).parent


def kinds_in(tree: ast.AST) -> Iterator[tuple[str, ast.expr | None]]:
    """Each kind that code names, and the first thing that it is called with."""
    called = {id(x.func): x for x in ast.walk(tree) if isinstance(x, ast.Call)}
    for x in ast.walk(tree):
        if isinstance(x, ast.Attribute) and isinstance(x.value, ast.Name) and x.value.id == "ReasonKind":
            given = called[id(x)].args if id(x) in called else []
            yield x.attr, given[0] if given else None


def test_every_kind_is_used_and_only_that_of_other_words_takes_whole_sentences() -> None:
    found = [x for path in PACKAGE.rglob("*.py") for x in kinds_in(ast.parse(path.read_text("utf-8")))]
    assert {name for name, _ in found} == {x.name for x in ReasonKind}
    texts = [x for name, x in found if name == "TOLD" and isinstance(x, ast.JoinedStr | ast.Constant)]
    assert not texts, ast.unparse(texts[0])


def test_a_reason_keeps_its_kind_and_values_between_processes() -> None:
    reason = ReasonKind.NOT_UNSAT("claim", "sat")
    again = pickle.loads(pickle.dumps(reason))
    assert (again, again.kind, again.values) == (reason, ReasonKind.NOT_UNSAT, ("claim", "sat"))
    assert again == "the query 'claim' was answered sat, not unsat"


def test_values_are_no_templates_and_too_few_are_refused() -> None:
    assert ReasonKind.TOLD("{0} of {}") == "{0} of {}"
    with pytest.raises(IndexError):
        ReasonKind.NOT_UNSAT("claim")


def test_reasons_are_joined_without_those_that_are_empty() -> None:
    one, other = ReasonKind.NO_STATE(), ReasonKind.NO_DRIVE()
    assert joined((NO_REASON, one)).kind is ReasonKind.NO_STATE
    assert joined((one, NO_REASON, other, one)) == f"{one}; {other}; {one}"
    assert joined(()) == ""
    assert not joined(())


def test_json_has_the_words_alone() -> None:
    finding = Finding("a.json", "drive", Acceptance.REJECTED, ReasonKind.LINK())
    data = write(finding)
    assert type(data["reason"]) is str
    again = read(Finding, data, "here")
    assert again == finding
    assert again.reason.kind is ReasonKind.TOLD

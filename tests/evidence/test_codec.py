"""The codec and its schemas, the summary of a check, and specification files beside evidence."""

import os
from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Annotated, Any

import pytest
from jsonschema import Draft202012Validator

from documents.json_schema import schema_of
from roadproof.errors import InputError
from roadproof.evidence.codec import Rule, read
from roadproof.evidence.codec import write as write_json
from roadproof.evidence.finding import NO_EVIDENCE as MISSING_EVIDENCE
from roadproof.evidence.finding import Acceptance, Finding, exit_code, summary
from roadproof.evidence.specifications import load_specs_beside
from roadproof.evidence.strict import Fields
from roadproof.library.loading import bundled_library
from roadproof.verdict import ExitCode

# --- Answers as dataclasses: what is read and refused, and the JSON Schema that follows -------------


@dataclass(frozen=True, kw_only=True)
class Sample:
    """Tuples of a length, names by rule, lists without repetition."""

    span: tuple[float, float | None]
    both: tuple[int, int]
    counts: Mapping[Annotated[str, Rule(pattern="^[0-9]+$")], int]
    names: Annotated[tuple[str, ...], Rule(least=1, unique=True)]


GOOD: Mapping[str, Any] = {"span": [0, None], "both": [1, 2], "counts": {"4": 1}, "names": ["a", "b"]}
CODEC_SCHEMA = Draft202012Validator(schema_of(Sample, "sample.json", "a sample"))


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
    missing = finding(Acceptance.ACCEPTED, MISSING_EVIDENCE)
    found = [finding(Acceptance.ACCEPTED), replace(missing, verdict="UNKNOWN")]
    line = summary(found, "z3")
    assert line == "1 of 1 accepted by z3 and the exact judge; 1 with nothing to check: 1 UNKNOWN"


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
    library, paths = load_specs_beside(named("more.spec"), tmp_path, ())
    assert "slower" in library.select().definitions
    assert paths == (tmp_path / "more.spec",)
    library, _ = load_specs_beside(named("more.spec"), tmp_path, paths)  # given on the command line too
    assert "slower" in library.select().definitions


def test_without_files_there_is_the_library_alone(tmp_path: Path) -> None:
    for data in (None, Fields({}, "index.json"), named()):
        library, paths = load_specs_beside(data, tmp_path, ())
        assert library.select().definitions.keys() == bundled_library().select().definitions.keys()
        assert paths == ()


def test_a_file_that_changes_a_definition_is_refused(tmp_path: Path) -> None:
    (tmp_path / "other.spec").write_text(OTHER, "utf-8")
    with pytest.raises(InputError, match="changes 'danger' of the library"):
        load_specs_beside(named("other.spec"), tmp_path, ())


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
        load_specs_beside(named(name), folder, ())

"""Answers as dataclasses: what is read and refused, and the JSON Schema that follows."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Annotated, Any

import pytest
from jsonschema import Draft202012Validator

from roadproof.errors import InputError
from roadproof.evidence.codec import Rule, read, write
from roadproof.evidence.json_schema import schema_of


@dataclass(frozen=True, kw_only=True)
class Sample:
    """Tuples of a length, names by rule, lists without repetition."""

    span: tuple[float, float | None]
    both: tuple[int, int]
    counts: Mapping[Annotated[str, Rule(pattern="^[0-9]+$")], int]
    names: Annotated[tuple[str, ...], Rule(least=1, unique=True)]


GOOD: Mapping[str, Any] = {"span": [0, None], "both": [1, 2], "counts": {"4": 1}, "names": ["a", "b"]}
SCHEMA = Draft202012Validator(schema_of(Sample, Sample, "sample.json", "a sample"))


def test_what_is_read_is_written_again() -> None:
    assert write(read(Sample, GOOD, "here")) == GOOD
    assert SCHEMA.is_valid(GOOD)


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
    assert not SCHEMA.is_valid({**GOOD, field: bad})

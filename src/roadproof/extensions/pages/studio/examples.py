"""Example questions of the studio: one click asks each, and the answer takes seconds."""

import tomllib
from collections.abc import Sequence
from dataclasses import dataclass
from importlib import resources
from typing import Final, Literal

from roadproof.evidence.codec import read
from roadproof.verdict import Verdict


@dataclass(frozen=True)
class Example:
    """A formula with the job to run on it; ``verdict``: the answer in the set base without edits."""

    title: str
    job: Literal["find", "prove"]
    formula: str
    verdict: Verdict


@dataclass(frozen=True)
class ExampleFile:
    """The file of examples."""

    example: tuple[Example, ...]


def _examples() -> Sequence[Example]:
    text = resources.files(__package__).joinpath("examples.toml").read_text("utf-8")
    return read(ExampleFile, tomllib.loads(text), "examples.toml").example


EXAMPLES: Final = _examples()

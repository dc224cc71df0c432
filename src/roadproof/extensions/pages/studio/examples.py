"""Questions to begin with: each is asked by a click, and answered in seconds."""

import tomllib
from collections.abc import Sequence
from dataclasses import dataclass
from importlib import resources
from typing import Final, Literal

from roadproof.verdict import Verdict


@dataclass(frozen=True)
class Example:
    """A formula with the question to ask of it; ``verdict``: the answer in the set base without edits."""

    title: str
    job: Literal["find", "prove"]
    formula: str
    verdict: Verdict


def _examples() -> Sequence[Example]:
    text = resources.files(__package__).joinpath("examples.toml").read_text("utf-8")
    entries = tomllib.loads(text)["example"]
    return [Example(**{**entry, "verdict": Verdict(entry["verdict"])}) for entry in entries]


EXAMPLES: Final = _examples()

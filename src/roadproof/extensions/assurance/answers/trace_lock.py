"""The lock file ``requirements.lock.json``: everything that each link of a trace rested on when it was
accepted.
"""

from collections.abc import Mapping
from typing import Annotated, Final, Literal

from roadproof.evidence.answers.shared import Version
from roadproof.evidence.codec import Doc, Rule
from roadproof.runtime.records import dataclass

SCHEMA: Final = "roadproof/trace-lock/1"


@dataclass(frozen=True, kw_only=True)
class LockedLink:
    """A link with the names of all parts that it rests on."""

    requirement: Annotated[str, Rule(least=1)]
    kind: str
    target: Annotated[str, Rule(least=1)]
    rests_on: Annotated[tuple[str, ...], Doc("Names among the parts.")]


@dataclass(frozen=True, kw_only=True)
class Lock:
    """The parts that all links rested on when they were accepted."""

    schema: Literal["roadproof/trace-lock/1"] = SCHEMA
    roadproof: Version
    parts: Annotated[
        Mapping[str, str],
        Doc("By name, the value of a parameter, or a digest of a definition, text, model or file."),
    ]
    links: tuple[LockedLink, ...]

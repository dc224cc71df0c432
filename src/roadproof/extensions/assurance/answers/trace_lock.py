"""``requirements.lock.json``: what every link of a trace rested on when it was accepted."""

from collections.abc import Mapping
from typing import Annotated, Final, Literal

from roadproof.evidence.answers.shared import Version
from roadproof.evidence.codec import Doc, Rule
from roadproof.runtime.records import dataclass

SCHEMA: Final = "roadproof/trace-lock/1"


@dataclass(frozen=True, kw_only=True)
class LockedLink:
    """A link, and the names of all that it rests on."""

    requirement: Annotated[str, Rule(least=1)]
    kind: str
    target: Annotated[str, Rule(least=1)]
    rests_on: Annotated[tuple[str, ...], Doc("Names among the parts.")]


@dataclass(frozen=True, kw_only=True)
class Lock:
    """What every link rested on."""

    schema: Literal["roadproof/trace-lock/1"] = SCHEMA
    roadproof: Version
    parts: Annotated[
        Mapping[str, str],
        Doc("By name, the value of a parameter, or a digest of a definition, text, model or file."),
    ]
    links: tuple[LockedLink, ...]

"""Requests of the page as data classes; every field is validated, since anything may be sent."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from fractions import Fraction
from typing import Any, TypeAlias

from roadproof.errors import UsageError
from roadproof.evidence.codec import read
from roadproof.extensions.pages.studio.drafting import BEFORE, EDIT, Draft
from roadproof.frontends.api.definitions import Definitions
from roadproof.frontends.settings.option import Settings
from roadproof.frontends.settings.questions import Prove, Witness

LONGEST_TEXT = 200_000
LATEST = 3600
MOST_DRIVES = 12
MOST_FILES = 12
MOST_WATCHES = 12
MOST_CARDS = 24
FORM: Mapping[str, tuple[type[Settings], tuple[str, ...]]] = {
    "find": (Witness, ("objective",)),
    "prove": (Prove, ("declared",)),
}
"""The options that the page offers for a job, with the settings class of its question."""
Answer: TypeAlias = dict[str, object]


@dataclass(frozen=True)
class File:
    """A file that was dropped on the page."""

    name: str
    content: str


@dataclass(frozen=True)
class Pair:
    """Vehicles of a dropped recording, and the frames to look at."""

    recording: str
    vehicles: tuple[int, ...]
    first: int
    last: int


@dataclass(frozen=True)
class ExplainedPart:
    """A part of the question by its index, and the instant (s) at which it is to be explained."""

    part: int
    at: float


@dataclass(frozen=True)
class StudioQuestion:
    """A question of the page; each job reads the fields that it needs. Raises ``UsageError``."""

    draft: Draft
    kind: str = ""
    set: str = EDIT
    formula: str = ""
    watches: tuple[str, ...] = ()
    settings: Mapping[str, object] = field(default_factory=dict)
    negated: bool = False
    count: int = 1
    forward: bool = False
    compare: bool = False
    fresh: bool = False
    drive: object = None
    explain: ExplainedPart | None = None
    files: tuple[File, ...] = ()
    pair: Pair | None = None
    name: str = ""
    scenarios: tuple[int, ...] = ()
    formulas: Mapping[str, str] = field(default_factory=dict)

    def __post_init__(self) -> None:
        for name, value in (
            ("text", self.draft.text),
            ("before", self.draft.before),
            ("formula", self.formula),
        ):
            if value is not None and len(value) > LONGEST_TEXT:
                raise UsageError(f"{name} has {len(value)} characters: at most {LONGEST_TEXT} are read")
        if not 1 <= self.count <= MOST_DRIVES:
            raise UsageError(f"count={self.count}: ask for 1 to {MOST_DRIVES}")
        if len(self.watches) > MOST_WATCHES:
            raise UsageError(f"watches={len(self.watches)}: at most {MOST_WATCHES} formulas are watched")
        if len(self.scenarios) > MOST_CARDS:
            raise UsageError(f"scenarios={len(self.scenarios)}: at most {MOST_CARDS} are shown at once")
        if self.explain is not None and not 0 <= self.explain.at <= LATEST:
            raise UsageError(f"at={self.explain.at}: explain an instant from 0 to {LATEST} s")

    @property
    def home(self) -> Definitions:
        """The definitions that are asked about: edit, before, or the set below them."""
        return self.draft.definitions(self.set if self.set in (EDIT, BEFORE) else self.draft.base)

    @property
    def explained(self) -> tuple[int, Fraction] | None:
        """The part to be explained, by its index, and the instant; None for none."""
        target = self.explain
        return None if target is None else (target.part, Fraction(target.at).limit_denominator(10**6))

    def options(self, job: str) -> dict[str, Any]:
        """Return the options that the page has chosen for a job. Raises ``UsageError``."""
        question, names = FORM[job]
        for name, value in self.settings.items():
            if name not in names or type(value) is not type(getattr(question, name)):
                raise UsageError(f"{name[:40]}={str(value)[:40]}: the page has no such option of {job}")
        return dict(self.settings)


def read_question(content: object) -> StudioQuestion:
    """Return the question of a request. Raises ``InputError``, ``UsageError``."""
    return read(StudioQuestion, content, "question")


def form() -> list[dict[str, object]]:
    """Return the options that the page offers, as it shows them."""
    return [
        {
            "job": job,
            "name": name,
            "help": question.options()[name].help,
            "choices": question.options()[name].choices,
            "default": getattr(question, name),
        }
        for job, (question, names) in FORM.items()
        for name in names
    ]

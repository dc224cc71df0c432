"""The subject of evidence: the kind of question that it answers, and the name of the subject.

Links of requirements match on these, never on labels, which are text for people.
"""

from enum import StrEnum
from typing import Final, Literal, NamedTuple, TypeAlias

from roadproof.runtime.records import dataclass


class SubjectKind(StrEnum):
    """The kinds of subjects; OTHER: a claim or drive that no requirement can name by itself."""

    PROPERTY = "property"
    TEST = "test"
    RUN = "run"
    """The drive of a test that is given as a formula."""
    FACT = "fact"
    """A relation between a test and a scenario, such as that it excludes one."""
    DRIVEN = "driven"
    """A test with a driver model in place of SV, named as links name it: ``TEST: MODEL``."""
    PLATE = "plate"
    OTHER = ""


OF_TESTS = (SubjectKind.TEST, SubjectKind.RUN, SubjectKind.FACT)


class Subject(NamedTuple):
    """A kind of subject with its name and spec set; an empty set is the set of the whole question."""

    kind: SubjectKind = SubjectKind.OTHER
    name: str = ""
    set: str = ""


OTHER: Final = Subject()

TestOutcome: TypeAlias = Literal["scenarios", "nothing", "unreadable", ""]
"""What a concrete test shows: at least one scenario, none, or its file cannot be read; empty of all else."""


TestedSide: TypeAlias = Literal["preventable", "unpreventable", "not covered", "undecided", "partly"]


@dataclass(frozen=True, kw_only=True)
class DriverSide:
    """The fate of a scenario that a test shows, under a driver model.

    ``gap``: the least gap that SV leaves (m); None where it touches POV or never is beside it. ``instant``,
    ``speed``: when SV touches POV (s), and how much faster it then is (m/s).
    """

    driver: str
    scenario: str
    side: TestedSide
    gap: float | None = None
    instant: float | None = None
    speed: float | None = None

"""Claims: all that an engine is asked, as one closed value with a digest.

A ``Claim`` holds the elaborated formula, in which every definition is written out, the bounds and values of
exactly the parameters that occur in it, and how it is asked: of all traces, of drives to be found, of a given
trace, or of initial values of a driver model. Two claims are equal where an engine cannot tell them apart, so
a digest is a sound key for answers that are kept. ``text`` is for people: no answer depends on it.
"""

from abc import ABC, abstractmethod
from collections.abc import Iterable, Mapping
from dataclasses import field
from fractions import Fraction
from typing import TYPE_CHECKING, Any, ClassVar, Final, Literal, Protocol, TypeAlias, runtime_checkable

from roadproof.library.elaborate import read_claim
from roadproof.library.motion import is_moving, under_limits, values_said
from roadproof.library.specification import Library, Query, Specification
from roadproof.logic.formula import Application, Formula, children, intervals
from roadproof.logic.rewrite import parameters_of
from roadproof.logic.terms import Parameter, Term, leaves
from roadproof.runtime.canonical import digest
from roadproof.runtime.records import dataclass
from roadproof.verdict import Verdict
from roadproof.world.drive import Drive
from roadproof.world.road import Road
from roadproof.world.units import UNITS
from roadproof.world.vehicle import Vehicle

if TYPE_CHECKING:
    from roadproof.evidence.answer import Answer
    from roadproof.evidence.drive_file import DriveFile

Objective: TypeAlias = Literal["any", "smooth", "margin", "mild", "severe", "short"]
Engine: TypeAlias = Literal["milp", "smt"]
HELP: Final = "help-"
"""How names of claims begin that only help with others: a doubt about one is none about the question."""
Means: TypeAlias = Literal["search", "proof", "known"]
"""How drives are asked for: a search, a proof that there is none, or drives that are known."""


@dataclass(frozen=True)
class OccurringParameter:
    """A parameter that a formula mentions: its unit, its bound against 0, and its value in SI units."""

    name: str
    unit: str
    bound: str
    value: Fraction


@dataclass(frozen=True)
class Valid:
    """The formula is to hold on all traces; on motions within limits where ``moving``.

    ``restricted``: the formula under the limits and values that are assumed, where any are. ``within``: on
    drives only, as they are looked for. ``assuming``: the words that say what is assumed.
    """

    moving: bool = False
    values: tuple[tuple[str, Fraction], ...] = ()
    restricted: Formula | None = None
    within: "Exists | None" = None
    assuming: tuple[str, ...] = field(default=(), compare=False)


@dataclass(frozen=True)
class Exists:
    """A drive is to be found on which the formula holds: where, with whom, for how long, and which one.

    ``road`` None: the usual road of the formula; ``vehicles``: models by name, "" for all others; ``limits``:
    other limits than theirs; ``dt`` None: the coarsest step that fits. ``unlike``: drives from which it is to
    differ; ``trees``: whether trees are wanted that show that there is none. ``apart``: until when boxes stay
    apart (s), where that is longer than the horizon. ``like``: the motions that it is to have on ``road``, in
    ``lanes``, where they are given. Effort is no part of a claim.
    """

    road: Road | None = None
    lanes: Mapping[str, str] = field(default_factory=dict)
    vehicles: Mapping[str, Vehicle] = field(default_factory=dict)
    limits: Mapping[str, Mapping[str, Fraction]] = field(default_factory=dict)
    horizon: Fraction = Fraction(6)
    dt: Fraction | None = None
    reach: Fraction = Fraction(80)
    collisions: bool = False
    natural: bool = True
    objective: Objective = "smooth"
    engine: Engine = "milp"
    solver: str = "highs"
    refinements: int = 2
    explain: bool = True
    unlike: tuple[Drive, ...] = ()
    trees: bool = False
    apart: Fraction | None = None
    by: Means = "search"
    like: Drive | None = None


class Judgement(Protocol):
    """What a trace shows, as a definition for ``evidence.codec``."""

    @property
    def verdict(self) -> Verdict:
        """COVERED where it shows something that is asked for, else GAPS."""


class Judge(Protocol):
    """What a given trace shows: it can be sent to another process, and says the same each time."""

    @property
    def kind(self) -> type:
        """The definition for ``evidence.codec`` of what it says."""

    def __call__(self) -> Judgement:
        """Return what the trace shows."""


@runtime_checkable
class Confirming(Protocol):
    """A judge that can tell whether something is so without looking for all that is."""

    def confirms(self, shows: Any) -> bool:
        """Return whether all that is said is so."""


@dataclass(frozen=True)
class On:
    """It is asked what a given trace shows.

    ``files``: SHA-256 of every file that it is read from; ``asked``: a digest of all else that the answer
    depends on: formulas with their definitions, values, roles, driver models. ``judge`` answers.
    """

    files: tuple[str, ...]
    asked: str
    judge: Judge = field(compare=False, repr=False)


class OwnMode(ABC):
    """How a claim of an extension is asked: a frozen dataclass, of which the digest of the claim is made.

    ``is_open``: whether the evidence says numbers that the formula leaves open.
    """

    is_open: ClassVar[bool] = False

    @abstractmethod
    def settle(self, claim: "Claim") -> "Answer":
        """Return the answer to a claim of this mode. Raises ``BudgetExceeded``."""

    @abstractmethod
    def verdict_of(self, evidence: object) -> Verdict | None:
        """Return the verdict that this evidence shows; None where it decides no claim of this mode."""

    def is_shown_by(self, claim: "Claim", drive: "DriveFile") -> bool:
        """Return whether a drive is about a claim of this mode."""
        return claim.read(drive.formula) == claim.formula


Mode: TypeAlias = Valid | Exists | On | OwnMode


@dataclass(frozen=True)
class Claim:
    """A formula with its free names, how it is asked, and the parameters that occur in it.

    ``query`` is the formula as it is written, and ``home`` has the definitions that its text is read with.
    """

    formula: Formula
    vehicles: tuple[str, ...]
    lanes: tuple[str, ...]
    mode: Mode
    parameters: tuple[OccurringParameter, ...]
    query: Query = field(compare=False, repr=False)
    home: Specification = field(compare=False, repr=False)

    @property
    def text(self) -> str:
        """The claim as people read it."""
        return self.query.text

    @property
    def values(self) -> Mapping[str, Fraction]:
        """The values that evidence has to have; none where the claim is about all values."""
        is_about_all = isinstance(self.mode, Valid) and self.mode.within is None
        return {} if is_about_all else {x.name: x.value for x in self.parameters}

    def read(self, text: str) -> Formula:
        """Return what a text says in the definitions of the claim; its own is not read again.

        Raises ``TextError``.
        """
        return self.formula if text == self.text else read_claim(self.home, text).formula

    def digest(self) -> str:
        """64 hexadecimal digits that no other claim has."""
        return digest(self)


def claim_of(home: Specification, query: Query, mode: Mode, values: Mapping[str, Fraction]) -> Claim:
    """Return the claim of a query that is read in ``home``.

    ``values``: parameters with another value than the declared one (SI).
    """
    more = [mode.restricted] if isinstance(mode, Valid) and mode.restricted is not None else []
    occurring = parameters_in(home.library, (query.formula, *more), values)
    return Claim(query.formula, query.vehicles, query.lanes, mode, occurring, query, home)


def valid_under(
    specification: Specification,
    query: Query,
    assuming: tuple[str, ...] = (),
    within: Exists | None = None,
    at: Mapping[str, Fraction] | None = None,
) -> Claim:
    """Return the claim that ``query`` holds on all traces under what is assumed, or on drives ``within``.

    ``at``: other values of parameters (SI) than the declared ones, on drives. Raises ``InputError``.
    """
    values = tuple(values_said(specification, assuming).items())
    restricted = under_limits(specification, query, assuming).formula if assuming else None
    mode = Valid(is_moving(assuming), values, restricted, within, tuple(assuming))
    return claim_of(specification, query, mode, (at or {}) if within is not None else {})


def parameters_in(
    library: Library,
    formulas: Iterable[Formula],
    values: Mapping[str, Fraction],
    terms: Iterable[Term] = (),
    more: Iterable[str] = (),
) -> tuple[OccurringParameter, ...]:
    """The parameters that occur in formulas and terms, and ``more``, by name, with their values (SI)."""
    names = {name for formula in formulas for name in _names_in(formula)} | {*more}
    names |= {leaf.name for term in terms for leaf in leaves(term) if isinstance(leaf, Parameter)}
    return tuple(_occurring(library, name, values) for name in sorted(names))


def _names_in(formula: Formula) -> set[str]:
    """The names of the parameters that occur, as ``parameters_of``, which applied definitions remember."""
    names, waiting = set[str](), [formula]
    while waiting:
        current = waiting.pop()
        inside = () if isinstance(current, Application) else children(current)
        waiting.extend(inside)
        if not inside:
            names.update(parameters_of(current))
        for interval in intervals(current):
            bounds = (interval.low, *(() if interval.high is None else (interval.high,)))
            names.update(x.name for term in bounds for x in leaves(term) if isinstance(x, Parameter))
    return names


def _occurring(library: Library, name: str, values: Mapping[str, Fraction]) -> OccurringParameter:
    declared = library.parameters[name]
    value = values.get(name, declared.value * UNITS[declared.unit][0])
    return OccurringParameter(name, declared.unit, declared.bound, value)

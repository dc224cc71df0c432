"""Claims: complete questions to an engine, as closed values with a digest.

A ``Claim`` holds the elaborated formula, with every definition expanded, and the bounds and values of exactly
the parameters that occur in it. Its mode says what is asked: about all traces, drives to find, a given trace,
or initial values of a driver model. Two claims are equal if an engine cannot tell them apart, so a digest is
a sound key for stored answers. ``text`` is for people: no answer depends on it.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Iterable, Mapping
from dataclasses import field
from fractions import Fraction
from typing import TYPE_CHECKING, Any, ClassVar, Final, Literal, Protocol, TypeAlias, runtime_checkable

from roadproof.library.elaborate import read_claim
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

if TYPE_CHECKING:
    from roadproof.evidence.answer import ClaimAnswer
    from roadproof.evidence.drive_file import DriveFile
    from roadproof.world.vehicle import Vehicle

Objective: TypeAlias = Literal["any", "smooth", "margin", "mild", "severe", "short", "typical"]
Engine: TypeAlias = Literal["milp", "smt"]
HELP: Final = "help-"
"""The prefix of names of auxiliary claims; an UNKNOWN for one of them leaves the question decided."""
Means: TypeAlias = Literal["search", "proof", "known"]
"""The means to decide an existence claim: a search, a proof that no drive exists, or known drives."""


@dataclass(frozen=True)
class OccurringParameter:
    """A parameter that a formula mentions: its unit, its bound against 0, and its value in SI units."""

    name: str
    unit: str
    bound: str
    value: Fraction


@dataclass(frozen=True)
class Valid:
    """The mode of claims that must hold on all traces; on all motions within limits if ``moving``.

    ``restricted``: the formula under the assumed limits and values, if any. ``within``: the class of drives
    that the claim is restricted to, as in a search for them. ``assuming``: the assumptions as text.
    """

    moving: bool = False
    values: tuple[tuple[str, Fraction], ...] = ()
    restricted: Formula | None = None
    within: Exists | None = None
    assuming: tuple[str, ...] = field(default=(), compare=False)


@dataclass(frozen=True)
class Exists:
    """The mode of claims that ask for a drive on which the formula holds; effort is no part of a claim.

    ``road`` None: the usual road of the formula. ``vehicles``: models by name, "" for all others. ``limits``:
    limits that replace those of the models. ``dt`` None: the coarsest step that fits. ``reach``: the greatest
    initial distance (m). ``unlike``: drives from which the new one must differ. ``trees``: whether a
    NONE-WITHIN needs refutation trees. ``apart``: the time up to which boxes stay apart (s), if that is
    longer than the horizon. ``like``: prescribed motions, on ``road`` and in ``lanes``.
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


class TraceJudgement(Protocol):
    """The result of judging a given trace; its class is a definition for ``evidence.codec``."""

    @property
    def verdict(self) -> Verdict:
        """COVERED if the trace shows a requested item, else GAPS."""


class TraceJudge(Protocol):
    """A judge of one trace: it can be sent to another process, and its judgement is always the same."""

    @property
    def kind(self) -> type:
        """The class of the judgement, for ``evidence.codec``."""

    @property
    def relies_on(self) -> Iterable[str]:
        """The entries of extensions, as ``module:name``, whose code the judgement depends on."""

    def __call__(self) -> TraceJudgement:
        """Return the judgement of the trace."""


@runtime_checkable
class ConfirmingJudge(Protocol):
    """A judge that can confirm a judgement without searching for all that the trace shows."""

    def confirms(self, shows: Any) -> bool:
        """Return whether every statement of a judgement is true of the trace."""


@dataclass(frozen=True)
class On:
    """The mode of claims about a given trace, answered by ``judge``.

    ``files``: SHA-256 of every file of the trace. ``asked``: a digest of everything else that the answer
    depends on: formulas with their definitions, values, roles, driver models.
    """

    files: tuple[str, ...]
    asked: str
    judge: TraceJudge = field(compare=False, repr=False)


class OwnMode(ABC):
    """A mode that an extension adds: a frozen dataclass, which the digest of the claim includes.

    ``is_open``: whether the evidence determines numbers that the formula leaves open.
    """

    is_open: ClassVar[bool] = False

    @property
    def relies_on(self) -> Iterable[str]:
        """The entries of other extensions, as ``module:name``, whose code answers depend on."""
        return ()

    @abstractmethod
    def decide(self, claim: Claim) -> ClaimAnswer:
        """Return the answer to a claim of this mode. Raises ``BudgetExceeded``."""

    @abstractmethod
    def verdict_of(self, evidence: object) -> Verdict | None:
        """Return the verdict that this evidence shows; None if it decides no claim of this mode."""

    def is_shown_by(self, claim: Claim, drive: DriveFile) -> bool:
        """Return whether a drive file is about a claim of this mode."""
        return claim.read(drive.formula) == claim.formula


Mode: TypeAlias = Valid | Exists | On | OwnMode


@dataclass(frozen=True)
class Claim:
    """A formula with its free names, the mode of the question, and the parameters that occur.

    ``query`` is the formula as written, and ``home`` has the definitions that its text is read with.
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
        """The parameter values that evidence must have; empty if the claim is about all values."""
        is_about_all = isinstance(self.mode, Valid) and self.mode.within is None
        return {} if is_about_all else {x.name: x.value for x in self.parameters}

    def read(self, text: str) -> Formula:
        """Return the formula of a text in the claim's definitions. Raises ``TextError``."""
        return self.formula if text == self.text else read_claim(self.home, text).formula

    def digest(self) -> str:
        """Return 64 hexadecimal digits that identify the claim."""
        return digest(self)


def claim_of(home: Specification, query: Query, mode: Mode, values: Mapping[str, Fraction]) -> Claim:
    """Return the claim of a query that is read in ``home``.

    ``values``: parameters whose value differs from the declared one (SI).
    """
    restricted = [mode.restricted] if isinstance(mode, Valid) and mode.restricted is not None else []
    occurring = parameters_in(home.library, (query.formula, *restricted), values)
    return Claim(query.formula, query.vehicles, query.lanes, mode, occurring, query, home)


def parameters_in(
    library: Library,
    formulas: Iterable[Formula],
    values: Mapping[str, Fraction],
    terms: Iterable[Term] = (),
    further_names: Iterable[str] = (),
) -> tuple[OccurringParameter, ...]:
    """Return the parameters that occur in formulas and terms, and ``further_names``, sorted by name.

    ``values``: parameters whose value differs from the declared one (SI).
    """
    names = {name for formula in formulas for name in _names_in(formula)} | {*further_names}
    names |= {leaf.name for term in terms for leaf in leaves(term) if isinstance(leaf, Parameter)}
    return tuple(_occurring(library, name, values) for name in sorted(names))


def _names_in(formula: Formula) -> set[str]:
    """Return the names of the parameters that occur; applied definitions have them memoised."""
    names, waiting = set[str](), [formula]
    while waiting:
        current = waiting.pop()
        subformulas = () if isinstance(current, Application) else children(current)
        waiting.extend(subformulas)
        if not subformulas:
            names.update(parameters_of(current))
        for interval in intervals(current):
            bounds = (interval.low, *(() if interval.high is None else (interval.high,)))
            names.update(x.name for term in bounds for x in leaves(term) if isinstance(x, Parameter))
    return names


def _occurring(library: Library, name: str, values: Mapping[str, Fraction]) -> OccurringParameter:
    declared = library.parameters[name]
    value = values.get(name, declared.value * UNITS[declared.unit][0])
    return OccurringParameter(name, declared.unit, declared.bound, value)

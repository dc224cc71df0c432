"""The view of the answers about a vehicle under test: the finding about each target."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import field, replace
from functools import cached_property
from typing import TYPE_CHECKING

from roadproof.evidence.answer import ClaimAnswer
from roadproof.evidence.judged import JudgedDrive
from roadproof.extensions.closed_loop.claim_names import FAILS, POSSIBLE, SHOWN, SIMULATED, claim_name
from roadproof.extensions.closed_loop.data import SCHEMA, FalsifyData, Finding, TargetResult
from roadproof.extensions.closed_loop.driver_drives import confirmed, verdict_data
from roadproof.extensions.closed_loop.search.problem import prevents
from roadproof.extensions.closed_loop.simulations_file import SimulationsFile
from roadproof.extensions.traffic.evaluate.decisions import Decision
from roadproof.library.scenarios import name_of, number_in
from roadproof.questions.question import Answers, EvidencePlace, heading_of
from roadproof.reasons import NO_REASON, Reason
from roadproof.runtime.records import dataclass

if TYPE_CHECKING:
    from roadproof.extensions.closed_loop.question import FalsifyQuestion


@dataclass(frozen=True)
class TargetView:
    """A scenario or a class: its finding with the answers behind it.

    ``decisions``: those of driver models on the failing drive, each confirmed by a judged drive; ``driven``:
    these drives by model. ``simulated``: the answer about all simulations, None where there was no search.
    ``shown_by``: the names of all drives of the controller that show it.
    """

    name: str
    title: str
    finding: Finding
    simulated: ClaimAnswer | None = None
    failing: ClaimAnswer | None = None
    shown: ClaimAnswer | None = None
    shown_by: tuple[str, ...] = ()
    decisions: tuple[Decision, ...] = ()
    driven: Mapping[str, ClaimAnswer] = field(default_factory=dict)
    reason: Reason = NO_REASON

    @property
    def simulations(self) -> SimulationsFile | None:
        """All simulations of the search; None where there was none, or its process ended."""
        evidence = None if self.simulated is None else self.simulated.evidence
        return evidence if isinstance(evidence, SimulationsFile) else None

    @property
    def is_scenario(self) -> bool:
        """Return whether it is a scenario, not a class."""
        return number_in(self.name) is not None

    @property
    def preventable_by(self) -> tuple[str, ...]:
        """The driver models that prevent the failure."""
        return tuple(x.driver for x in self.decisions if x.side == "preventable")

    @property
    def drive(self) -> JudgedDrive | None:
        """The failing drive, or else one that shows the target."""
        for answer in (self.failing, self.shown):
            if answer is not None and answer.drive is not None:
                return answer.drive
        return None


@dataclass(frozen=True)
class FalsifyView:
    """All targets, scenarios first."""

    targets: tuple[TargetView, ...]
    classes_asked: bool

    @cached_property
    def failures(self) -> tuple[TargetView, ...]:
        """The scenarios in which the controller fails."""
        return tuple(x for x in self.targets if x.finding == "FAILS")

    @property
    def classes(self) -> tuple[TargetView, ...]:
        """The classes that are not impossible."""
        return tuple(x for x in self.targets if not x.is_scenario and x.finding != "IMPOSSIBLE")

    @property
    def classes_shown(self) -> int:
        """The number of classes that a drive of the controller shows."""
        return sum(bool(x.shown_by) for x in self.classes)

    @property
    def simulations(self) -> int:
        """The number of all simulations."""
        return sum(x.simulations.count for x in self.targets if x.simulations is not None)


def view_of(question: FalsifyQuestion, known: Answers) -> FalsifyView:
    """Return what became of each target."""
    shown = question.names_shown(known)
    names = [*map(name_of, question.settings.scenarios), *question.classes]
    return FalsifyView(
        tuple(_target(question, name, known, tuple(shown.get(name, ()))) for name in names),
        question.settings.classes,
    )


def _target(question: FalsifyQuestion, name: str, known: Answers, shown_by: tuple[str, ...]) -> TargetView:
    possible, simulated, failing, shown = (
        known.get(claim_name(part, name)) for part in (POSSIBLE, SIMULATED, FAILS, SHOWN)
    )
    made = TargetView(
        name,
        question.title(name),
        "NOT SHOWN",
        simulated,
        failing,
        shown,
        shown_by,
    )
    if failing is not None and failing.drive is not None:
        decisions = question.decisions(name, failing.drive)
        decisions, driven = confirmed(decisions, question.driven(name, failing.drive), known)
        made = replace(made, decisions=decisions, driven=driven)
        if question.settings.wanted == "any" or prevents(made.decisions):
            return replace(made, finding="FAILS")
    if possible is not None and possible.certificate is not None:
        return replace(made, finding="IMPOSSIBLE")
    if made.simulations is not None and made.simulations.fault:
        return replace(made, finding="ERROR", reason=_why(failing, shown))
    if made.simulations is None and simulated is not None and not shown_by:
        return replace(made, finding="ERROR", reason=simulated.reason)
    if shown_by:
        return replace(made, finding="SHOWN", reason=NO_REASON)
    return replace(made, reason=_why(shown, possible))


def _why(*answers: ClaimAnswer | None) -> Reason:
    """Return the first reason among answers."""
    return next((x.reason for x in answers if x is not None and x.reason), NO_REASON)


def data_of(
    question: FalsifyQuestion, view: FalsifyView, place: EvidencePlace, seconds: float
) -> FalsifyData:
    """Return the view as ``--json`` prints it."""
    basis = question.basis
    return FalsifyData(
        **heading_of(SCHEMA, basis),
        set=basis.specification.set_name,
        **basis.common_data(),
        request=question.settings,
        seconds=seconds,
        targets=tuple(_data(x, place) for x in view.targets),
        classes_shown=view.classes_shown,
        classes_possible=len(view.classes),
    )


def _data(x: TargetView, place: EvidencePlace) -> TargetResult:
    file, failing = x.simulations, x.failing
    has_drive = failing is not None and failing.drive is not None
    return TargetResult(
        name=x.name,
        title=x.title,
        finding=x.finding,
        simulations=0 if file is None else file.count,
        first_failure=0 if file is None else file.first_failure,
        first_preventable=0 if file is None else file.first_preventable,
        nearest=None if file is None else file.nearest,
        shown_by=x.shown_by,
        failing=place(claim_name(FAILS, x.name), failing) if has_drive and failing is not None else None,
        values={} if file is None else file.values,
        driven={name: place(claim_name(FAILS, x.name, name), y) for name, y in x.driven.items() if y.drive},
        simulated=None if x.simulated is None else place(claim_name(SIMULATED, x.name), x.simulated),
        drivers=tuple(map(verdict_data, x.decisions)),
        reason=x.reason,
    )

"""The view of the answers about a controller in place of recorded vehicles."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import field, replace
from functools import cached_property
from typing import TYPE_CHECKING

from roadproof.evidence.answer import ClaimAnswer
from roadproof.evidence.judged import JudgedDrive
from roadproof.extensions.closed_loop.claim_names import BREAKS, KEEPS, claim_name
from roadproof.extensions.closed_loop.driver_drives import confirmed, verdict_data
from roadproof.extensions.closed_loop.resimulation.data import (
    SCHEMA,
    OccurrenceFinding,
    OccurrenceResult,
    RecordedOccurrence,
    ResimulationData,
)
from roadproof.extensions.closed_loop.resimulation.occurrence import least_gap
from roadproof.extensions.closed_loop.resimulation.tested import samples_of, shown_numbers
from roadproof.extensions.traffic.evaluate.decisions import Decision
from roadproof.questions.question import Answers, EvidencePlace, heading_of
from roadproof.reasons import NO_REASON, Reason
from roadproof.runtime.records import dataclass
from roadproof.world.motion import states_at

if TYPE_CHECKING:
    from roadproof.extensions.closed_loop.resimulation.question import ResimulationQuestion


@dataclass(frozen=True)
class OccurrenceView:
    """An occurrence: its finding with the answers behind it.

    ``shows``: the numbers of the scenarios that the drive of the controller shows. ``gap``: its least gap to
    a POV in its way at the steps (m). ``decisions``: those of driver models on a failing drive, each
    confirmed by a judged drive; ``driven``: these drives by model.
    """

    occurrence: RecordedOccurrence
    finding: OccurrenceFinding
    answer: ClaimAnswer | None = None
    shows: tuple[int, ...] = ()
    gap: float | None = None
    decisions: tuple[Decision, ...] = ()
    driven: Mapping[str, ClaimAnswer] = field(default_factory=dict)
    reason: Reason = NO_REASON

    @property
    def id(self) -> str:
        """The name of the occurrence."""
        return self.occurrence.id

    @property
    def drive(self) -> JudgedDrive | None:
        """The drive of the controller."""
        return None if self.answer is None else self.answer.drive

    @property
    def claim_name(self) -> str:
        """The name of the claim that the drive answers."""
        return claim_name(BREAKS if self.finding == "FAILS" else KEEPS, self.id)

    @property
    def preventable_by(self) -> tuple[str, ...]:
        """The driver models that prevent the failure."""
        return tuple(x.driver for x in self.decisions if x.side == "preventable")


@dataclass(frozen=True)
class ResimulationView:
    """All occurrences, in the order of recordings and frames."""

    occurrences: tuple[OccurrenceView, ...]

    @cached_property
    def failures(self) -> tuple[OccurrenceView, ...]:
        """The occurrences in which the controller fails."""
        return tuple(x for x in self.occurrences if x.finding == "FAILS")


def view_of(question: ResimulationQuestion, known: Answers) -> ResimulationView:
    """Return what became of each occurrence."""
    return ResimulationView(tuple(_view(question, x, known) for x in question.settings.occurrences))


def _view(question: ResimulationQuestion, x: RecordedOccurrence, known: Answers) -> OccurrenceView:
    breaks, keeps = (known.get(claim_name(part, x.id)) for part in (BREAKS, KEEPS))
    for answer, finding in ((breaks, "FAILS"), (keeps, "KEPT")):
        if answer is not None and answer.drive is not None:
            made = OccurrenceView(
                x,
                finding,  # type: ignore[arg-type]
                answer,
                shown_numbers(answer.drive.file, tuple(x.vehicles), question.formulas),
                _gap(answer.drive, x, question),
            )
            if finding == "KEPT":
                return made
            decisions = question.decisions(x, answer.drive)
            decisions, driven = confirmed(decisions, question.driven(x, answer.drive), known)
            return replace(made, decisions=decisions, driven=driven)
    reasons = [y.reason for y in (keeps, breaks) if y is not None and y.reason]
    return OccurrenceView(x, "ERROR", reason=reasons[0] if reasons else NO_REASON)


def _gap(drive: JudgedDrive, x: RecordedOccurrence, question: ResimulationQuestion) -> float | None:
    dt = question.settings.dt
    times = [k * dt for k in range(int(x.seconds / dt) + 1)]
    motions = {name: drive.file.drive.vehicles[name] for name in x.vehicles}
    tracks = {name: samples_of(states_at(motion, times)) for name, motion in motions.items()}
    return least_gap(tracks, {name: (float(m.length), float(m.width)) for name, m in motions.items()})


def data_of(
    question: ResimulationQuestion, view: ResimulationView, place: EvidencePlace, seconds: float
) -> ResimulationData:
    """Return the view as ``--json`` prints it."""
    basis = question.basis
    return ResimulationData(
        **heading_of(SCHEMA, basis),
        set=basis.specification.set_name,
        **basis.common_data(),
        request=question.settings,
        seconds=seconds,
        occurrences=tuple(_data(x, place) for x in view.occurrences),
    )


def _data(x: OccurrenceView, place: EvidencePlace) -> OccurrenceResult:
    return OccurrenceResult(
        id=x.id,
        finding=x.finding,
        drive=None if x.answer is None else place(x.claim_name, x.answer),
        shows=x.shows,
        gap=x.gap,
        driven={name: place(claim_name(BREAKS, x.id, name), y) for name, y in x.driven.items() if y.drive},
        drivers=tuple(map(verdict_data, x.decisions)),
        reason=x.reason,
    )

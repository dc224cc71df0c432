"""What scenarios are to each other: which hold together, which imply which, what could be left out."""

from collections.abc import Iterator
from dataclasses import replace
from functools import cached_property
from typing import Unpack

from roadproof.errors import UsageError
from roadproof.evidence.kinds import Evidence
from roadproof.frontends.api.answer import Picture, picture
from roadproof.frontends.api.definitions import Among, Definitions, definitions_of, load
from roadproof.frontends.api.pictures import drawn
from roadproof.frontends.api.questioned import QuestionAnswers, evidence_of
from roadproof.frontends.api.settings import basis_of, positive
from roadproof.frontends.report import order as order_report
from roadproof.frontends.report import overlap as overlap_report
from roadproof.frontends.report.numbers import count, took
from roadproof.frontends.report.sheet import Sheet, as_csv
from roadproof.frontends.settings import studies as settings
from roadproof.frontends.settings.keywords import OrderKeywords, OverlapKeywords
from roadproof.frontends.settings.option import takes
from roadproof.library.words import Called, called_in
from roadproof.questions.order.question import Compared, OrderQuestion, OrderView
from roadproof.questions.overlap import Meeting, OverlapQuestion, OverlapView, PairVerdict
from roadproof.verdict import ExitCode, Verdict, exit_code


class Overlaps(QuestionAnswers[OverlapView]):
    """Which pairs of scenarios can hold together: a drive, or a proof that there is none, for each."""

    pieces = "groups of pairs"

    @property
    def pairs(self) -> tuple[PairVerdict, ...]:
        """The verdicts in the order of the pairs."""
        return self.view.pairs

    @property
    def verdicts(self) -> dict[str, Verdict]:
        return {f"{x.a}, {x.b}": x.verdict for x in self.pairs}

    @property
    def evidence(self) -> tuple[Evidence, ...]:
        return tuple(evidence_of(y) for x in self.pairs for y in x.evidence.values())

    @cached_property
    def words(self) -> Called:
        """What the scenarios are called."""
        basis, numbers = self.question.basis, {y.number for x in self.pairs for y in (x.a, x.b)}
        return called_in(basis.specification, basis.set_names, numbers)

    @property
    def across(self) -> bool:
        """Whether the pairs are of two spec sets."""
        return len(self.question.basis.set_names) > 1

    @property
    def exit_code(self) -> ExitCode:
        return exit_code((x.verdict, x.verdict) for x in self.pairs)

    @property
    def _sheet(self) -> Sheet[PairVerdict]:
        return overlap_report.sheet_of(self.pairs, self.words)

    def each_picture(self) -> Iterator[tuple[str, Picture]]:
        """The heat map."""
        meeting, sets = self.view.meeting, ",".join(self.question.basis.set_names)
        how = f"lanes {meeting.lanes}, roles {meeting.roles}, start {meeting.start}"
        title = f"Which scenarios hold together: set {sets}; {how}"
        yield "overlap", picture(overlap_report.draw_overlap(self.pairs, title, self.across, self.words))

    def files(self, pictures: bool) -> dict[str, bytes]:
        table = {"overlap.csv": as_csv(self._sheet).encode()}
        return table | drawn(self.pictures() if pictures else {})

    def __str__(self) -> str:
        said = count(len(self.pairs), "pair") + took(self.seconds or None)
        return f"{overlap_report.as_text(self.pairs, self.across, self.words)}\n{said}"


@takes(settings.Overlap)
def overlap(
    among: Among = None, using: Definitions | None = None, **options: Unpack[OverlapKeywords]
) -> Overlaps:
    """Which scenarios of one spec set can hold together, or those of one set with those of another.

    ``among``: scenarios such as "1,3-8" (all where None); ``lanes``, ``roles``, ``start``: the same for
    both, or any; ``horizon``: seconds of driving searched (6; 9 where ``start`` is any). ``preventable``,
    ``unpreventable``: as for ``witness``. ``out``: a folder in
    which answers are kept as they come; ``say`` is told of kept ones that do not count. Raises
    ``InputError``, ``UsageError``.
    """
    given = settings.Overlap.of(options)
    home = given.modified(definitions_of(using), among)
    if len(home.sets) > 2:
        raise UsageError(f"{', '.join(home.sets)}: name one spec set, or two different ones")
    # What happens one after the other takes longer than what happens at once.
    usual = 9 if given.start == "any" else 6
    horizon = positive("horizon", usual if given.horizon is None else given.horizon, "s")
    basis = replace(basis_of(home, given, given.vehicles), horizon=horizon)
    asked = Meeting(among=home.among(among) or None, lanes=given.lanes, roles=given.roles, start=given.start)
    question = OverlapQuestion(basis, asked)
    if not question.pairs:
        raise UsageError(f"--among {among} selects no pair: select at least two scenarios")
    return Overlaps.settled(question, given)


class Orders(QuestionAnswers[OrderView]):
    """Which scenarios imply which: every implication proved, every other one refuted by a drive."""

    pieces = "families of scenarios"

    @property
    def verdicts(self) -> dict[str, Verdict]:
        """Of every implication between two of the formulas that was asked by itself."""
        order = self.view
        found = {f"{x.above} -> {x.below}": Verdict.PROVED for x in order.proved}
        found |= {f"{above} -> {below}": Verdict.REFUTED for above, below, _ in order.missing}
        return found | {f"{x.above} -> {x.below}": Verdict.UNKNOWN for x in order.doubts}

    @property
    def evidence(self) -> tuple[Evidence, ...]:
        answers = [x.answer for x in self.view.proved] + [x.answer for x in self.view.drives]
        return tuple(map(evidence_of, answers))

    @property
    def _sheet(self) -> Sheet[tuple[str, Verdict]]:
        return order_report.sheet_of(self.verdicts)

    @cached_property
    def words(self) -> Called:
        """What the scenarios are called."""
        numbers = {node.number for kind in self.view.kinds for node in kind.nodes}
        return called_in(self.question.basis.specification, self.question.basis.set_names, numbers)

    def each_picture(self) -> Iterator[tuple[str, Picture]]:
        """The Hasse diagram."""
        sets = ", ".join(self.question.basis.set_names)
        title = f"implications in {sets}; an arrow leads to what is implied"
        yield "order", picture(order_report.draw_order(self.view, title, self.words))

    def files(self, pictures: bool) -> dict[str, bytes]:
        graph = {"order.dot": order_report.as_dot(self.view, self.words).encode()}
        return graph | drawn(self.pictures() if pictures else {})

    def __str__(self) -> str:
        return order_report.as_text(self.view, self.seconds, self.words)


@takes(settings.Order)
def order(among: Among = None, using: Definitions | None = None, **options: Unpack[OrderKeywords]) -> Orders:
    """Which scenarios imply which, in the sets of ``using`` (base, extA and ext). Raises as ``overlap``."""
    given = settings.Order.of(options)
    home = using or load("base", "extA", "ext")
    basis = basis_of(home, given, given.vehicles)
    return Orders.settled(OrderQuestion(basis, Compared(among=home.among(among))), given)

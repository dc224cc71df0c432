"""Two formulas side by side: which implies which, by a proof or a drive in each direction."""

from collections.abc import Callable, Iterator
from contextlib import closing
from dataclasses import replace

from roadproof.engines.prove.prover import prove
from roadproof.engines.search.ask import ask, reads_all
from roadproof.engines.search.constant_motion import steady_drive
from roadproof.engines.search.dense_candidates import falsifying_drive
from roadproof.engines.search.outcome import Search
from roadproof.engines.search.refute import sampled_drive
from roadproof.evidence.answers import compare as kept
from roadproof.evidence.answers.compare import Relation
from roadproof.evidence.certificate import certificate_data
from roadproof.evidence.judged import JudgedDrive
from roadproof.evidence.settled import Settled
from roadproof.library.bind import values_with
from roadproof.library.compose import both, implication, negation
from roadproof.library.motion import Assumption, value_texts
from roadproof.library.specification import Query
from roadproof.logic.formula import is_state
from roadproof.logic.rewrite import is_cubic_state, parameters_of
from roadproof.reasons import NO_REASON, Reason, Why, joined
from roadproof.runtime.budget import BudgetExceeded, Effort
from roadproof.runtime.executors import LostJob
from roadproof.runtime.process_pool import answers_of
from roadproof.runtime.progress import about
from roadproof.runtime.records import dataclass
from roadproof.runtime.worker import is_worker
from roadproof.verdict import ClaimVerdict, Verdict

DIRECTIONS = ("first implies second", "second implies first")
BRIEF = 0.25  # units of work for a proof before sampled states are looked at
PROOF = 5.0  # units of work for a proof before a drive is looked for


@dataclass(frozen=True)
class Direction(Settled[ClaimVerdict]):
    """``claim`` is ``F1 -> F2``: PROVED with a certificate, REFUTED with a drive, or neither."""

    claim: Query

    @property
    def kept(self) -> kept.Direction:
        """As the answer has it."""
        return kept.Direction(
            claim=self.claim.text,
            verdict=self.verdict,
            reason=self.reason,
            certificate=None if self.certificate is None else certificate_data(self.certificate),
            drive=None if self.drive is None else self.drive.as_data(),
        )


@dataclass(frozen=True)
class Comparison:
    """How the first formula relates to the second: stronger is to imply it and not the reverse.

    ``sets``: the spec sets that the two are of.
    """

    first: Query
    second: Query
    relation: Relation
    forward: Direction
    backward: Direction
    sets: tuple[str, str]

    @property
    def directions(self) -> dict[str, Direction]:
        """Both directions, each with a name."""
        return dict(zip(DIRECTIONS, (self.forward, self.backward), strict=True))


def compare(
    search: Search,
    other: Query,
    set_name: str | None = None,
    jobs: int = 1,
    each: Callable[[str, Direction], object] | None = None,
) -> Comparison:
    """Compare the formula of a search with another, both read with the search's specification.

    ``set_name``: the spec set of the other, where that is another one (``compose.taken_from``). Drives
    that tell them apart are looked for in the search's setting. With two ``jobs`` both directions are asked
    at once, each in a process of its own and with its own work and clock; ``each`` is told of a direction
    when its answer is there. Raises as ``ask`` does.
    """
    found: dict[str, Direction] = {}
    for name, direction in answers(search, other, jobs):
        found[name] = direction
        if each is not None:
            each(name, direction)
    forward, backward = (found[name] for name in DIRECTIONS)
    mine = search.specification.set_name
    relation = _relation(forward, backward)
    return Comparison(search.query, other, relation, forward, backward, (mine, set_name or mine))


def answers(search: Search, other: Query, jobs: int = 1) -> Iterator[tuple[str, Direction]]:
    """The answers to both directions by name, as they come. The iterator is to be used up or closed."""
    questions = [
        _Question(name, search, *pair)
        for name, pair in zip(DIRECTIONS, [(search.query, other), (other, search.query)], strict=True)
    ]
    if jobs < 2 or is_worker():
        yield from ((x.name, _imply(x)) for x in questions)
        return
    with closing(answers_of(_imply, questions, jobs)) as found:
        for place, answer in found:
            question = questions[place]
            yield question.name, question.doubt(answer.reason) if isinstance(answer, LostJob) else answer


@dataclass(frozen=True)
class _Question:
    """Does ``one`` imply ``other``?"""

    name: str
    search: Search
    one: Query
    other: Query

    @property
    def claim(self) -> Query:
        return implication(self.one, self.other)

    def doubt(self, reason: Reason) -> Direction:
        return Direction(self.claim, verdict=Verdict.UNKNOWN, reason=reason)


def _relation(forward: Direction, backward: Direction) -> Relation:
    match forward.verdict, backward.verdict:
        case Verdict.PROVED, Verdict.PROVED:
            return "equivalent"
        case Verdict.PROVED, Verdict.REFUTED:
            return "stronger"
        case Verdict.REFUTED, Verdict.PROVED:
            return "weaker"
        case Verdict.REFUTED, Verdict.REFUTED:
            return "incomparable"
        case _:
            return "unknown"


def _imply(question: _Question) -> Direction:
    """Which of the two is so; UNKNOWN where the clock cuts the search off."""
    against = both(question.one, negation(question.other))
    try:
        with about(question.name):
            return _decide(replace(question.search, query=against), question.claim)
    except BudgetExceeded as late:
        return question.doubt(late.reason)


def _constant(against: Search, claim: Query) -> JudgedDrive | None:
    """Constant motion against a claim about one instant that no engine reads and no quick proof decides."""
    if not is_cubic_state(claim.formula) or reads_all(against):
        return None
    specification, effort = against.specification, against.search_options.effort
    if prove(specification, claim, effort.of(min(BRIEF, effort.units))).holds:
        return None
    known = values_with(specification.library, against.setting.values)
    return sampled_drive(specification, claim, known, against.setting)


def _at_values(against: Search, claim: Query, effort: Effort) -> Direction | None:
    """A claim about one instant that no engine can search: decided with the values of the search put in."""
    specification = against.specification
    known = values_with(specification.library, against.setting.values)
    values = {name: known[name] for name in parameters_of(claim.formula)}
    said = value_texts(specification, values)
    result = prove(specification, claim, effort, assumed=Assumption(said))
    if result.holds:
        reason = joined((result.reason, Why.WITH(", ".join(said)) if said else NO_REASON))
        return Direction(claim, verdict=Verdict.PROVED, reason=reason, certificate=result.certificate)
    if result.countermodel is None:
        return None
    drive = steady_drive(specification, claim, result.countermodel, known)
    return None if drive is None else Direction(claim, verdict=Verdict.REFUTED, drive=drive)


def _decide(against: Search, claim: Query) -> Direction:
    """Ask for a proof first, which takes a moment where there is one, then for a drive against the claim."""
    effort = against.search_options.effort.running()
    against = replace(against, search_options=replace(against.search_options, effort=effort))
    drive = _constant(against, claim)
    if drive is not None:
        return Direction(claim, verdict=Verdict.REFUTED, drive=drive)
    proof = prove(against.specification, claim, effort.of(min(PROOF, effort.units)))
    if proof.holds and proof.certificate is not None:
        return Direction(claim, verdict=Verdict.PROVED, reason=proof.reason, certificate=proof.certificate)
    if is_state(claim.formula) and not reads_all(against):
        direction = _at_values(against, claim, effort)
        return direction or Direction(claim, verdict=Verdict.UNKNOWN, reason=Why.NO_STATE())
    found = ask(against)
    drive = found.drives[0] if found.drives else None
    if found.verdict is Verdict.NONE_WITHIN:
        drive = falsifying_drive(against)
    if drive is not None:
        return Direction(claim, verdict=Verdict.REFUTED, drive=drive)
    if found.impossibility is not None:
        return Direction(claim, verdict=Verdict.PROVED, certificate=found.impossibility.certificate)
    verdict: ClaimVerdict = (
        Verdict.PROVED_BOUNDED if found.verdict is Verdict.NONE_WITHIN else Verdict.UNKNOWN
    )
    return Direction(claim, verdict=verdict, reason=found.reason)

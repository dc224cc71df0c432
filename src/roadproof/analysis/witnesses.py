"""Drives for scenarios and formulas, each looked for by itself and kept."""

from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import replace
from functools import cached_property
from typing import ClassVar

from roadproof.analysis.study.evidence_store import EvidenceStore, Question, readings
from roadproof.engines.search.outcome import Outcome, Search, undecided
from roadproof.errors import InputError
from roadproof.evidence.answers import drives as kept
from roadproof.evidence.answers.drives import SCHEMA
from roadproof.library.alike import like_of
from roadproof.library.elaborate import StatedQuery, read_claim
from roadproof.library.scenarios import Scenario, applied
from roadproof.logic.show import declared
from roadproof.reasons import Reason
from roadproof.runtime.canonical import digest
from roadproof.runtime.records import dataclass
from roadproof.verdict import Verdict


@dataclass(frozen=True)
class WitnessStudy:
    """Searches for drives, as a ``study.frame.Study``.

    ``finish`` is told of each outcome under its name, in the process that found it.
    """

    record_type: ClassVar[type[kept.Record]] = kept.Record
    searches: tuple[Search, ...]
    finish: Callable[[str, Outcome], None] | None = None

    @cached_property
    def names(self) -> tuple[str, ...]:
        """The names under which outcomes are kept, and which files begin with, in order."""
        return tuple(name_of(number, search) for number, search in enumerate(self.searches, 1))

    @cached_property
    def named(self) -> dict[str, Search]:
        """The searches by name; what is asked twice is there once."""
        return dict(zip(self.names, self.searches, strict=True))

    @property
    def question(self) -> Question:
        """Definitions and readings; how each drive was looked for is kept with its answer."""
        specification = self.searches[0].specification
        return Question(SCHEMA, readings(specification), {}, specification.library)

    def pieces(self, known: Mapping[str, Outcome]) -> Sequence[tuple[str, ...]]:
        """The names that are left; those of which one search may answer several are in one piece."""
        left = {name: search for name, search in self.named.items() if name not in known}
        if len(left) == 1:
            return [tuple(left)]
        groups: dict[object, list[str]] = {}
        for name, search in left.items():
            number = search.scenario
            group = name if number is None else like_of(search.specification, number)
            groups.setdefault(group, []).append(name)
        return [tuple(names) for names in groups.values()]

    def settle(self, piece: tuple[str, ...]) -> dict[str, Outcome]:
        from roadproof.engines.search.ask import answer  # here: known answers need not wait for numpy

        found: dict[str, Outcome] = {}
        for name in piece:
            found[name] = answer(self.named[name])
            if self.finish is not None:
                self.finish(name, found[name])
        return found

    def parts(self, piece: tuple[str, ...]) -> Sequence[tuple[str, ...]]:
        return [(name,) for name in piece]

    def doubt(self, piece: tuple[str, ...], reason: Reason) -> dict[str, Outcome]:
        return {name: undecided(self.named[name], reason) for name in piece}

    def is_sure(self, answer: Outcome) -> bool:
        """Whether all drives that were asked for are there, or a proof that there is none."""
        return answer.verdict is Verdict.IMPOSSIBLE or (bool(answer.drives) and not answer.reason)

    def wanted(self, known: Mapping[str, Outcome]) -> Collection[str]:
        return self.named

    def key(self, name: str) -> str:
        """A scenario may take the drive of one that differs from it in its road sector only."""
        search = self.named[name]
        home, number, sibling = search.specification, search.scenario, None
        if number is not None:
            first = like_of(home, number)
            query = applied(home, Scenario(first, home.set_name))
            sibling = replace(search, query=query).claim.digest(), first
        called = home.set_name, number, home.options
        return digest(_asked(search), sibling, called, search.search_options.effort)

    def prepare(self) -> None:
        from roadproof.engines.search import ask as ask  # for all processes that are forked
        from roadproof.engines.solve.milp import prepare

        prepare()

    def record(self, name: str, answer: Outcome, shelf: EvidenceStore) -> kept.Record:
        shown = answer.impossibility
        values = self.named[name].setting.values
        outcome = kept.OutcomeRecord(
            scenario=answer.scenario,
            set=answer.set_name,
            formula=answer.query.text,
            parameters={name: str(value) for name, value in sorted(values.items())},
            road=answer.road,
            verdict=answer.verdict,
            reason=answer.reason,
            natural=answer.natural,
            drives=tuple(
                shelf.drive(f"{stem}.json", judged)
                for stem, judged in zip(stems(name, answer), answer.drives, strict=True)
            ),
            certificate=None if shown is None else shelf.certificate(_proof(name), shown.certificate),
            core=() if shown is None else shown.told,
            minimal=shown is not None and shown.minimal,
            seconds={stage: round(value, 4) for stage, value in answer.seconds.items()},
            sizes=dict(answer.sizes),
        )
        return kept.Record(name=name, outcome=outcome, asked=_asked(self.named[name]))

    def recall(self, record: kept.Record, shelf: EvidenceStore) -> tuple[str, Outcome]:
        name, said = record.name, record.outcome
        search = self.named.get(name)
        if search is not None and record.asked != _asked(search):
            raise InputError(f"the answer '{name}' is that to another search")
        home = self.searches[0].specification.in_set(said.set)
        query = StatedQuery(home, said.formula) if search is None else search.query
        certificate = shelf.read_certificate(said.certificate)
        shown = None
        if certificate is not None:
            from roadproof.engines.search.impossible import Impossibility

            parts = (read_claim(home, declared(query.claim.given) + part) for part in said.core)
            shown = Impossibility(
                tuple(part.formula for part in parts), said.minimal, certificate, certificate
            )
        return name, Outcome(
            said.scenario,
            said.set,
            query,
            said.road,
            said.verdict,
            said.reason,
            tuple(x for x in map(shelf.read_drive, said.drives) if x is not None),
            said.natural,
            said.seconds,
            said.sizes,
            shown,
        )


def stems(name: str, outcome: Outcome) -> list[str]:
    """How the files of each drive of an outcome begin."""
    several = len(outcome.drives) > 1
    return [f"{name}-{k}" if several else name for k in range(1, len(outcome.drives) + 1)]


def evidence_files(name: str, outcome: Outcome) -> list[str]:
    """The files that show an outcome."""
    proof = [] if outcome.impossibility is None else [_proof(name)]
    return [*(f"{stem}.json" for stem in stems(name, outcome)), *proof]


def _proof(name: str) -> str:
    return f"impossible-{name}.json"


def none_within_file(name: str) -> str:
    """The file that shows a NONE-WITHIN, where there is one."""
    return f"none-within-{name}.json"


def name_of(number: int, search: Search) -> str:
    """Under which name what was found is kept, and how its files begin."""
    scenario = search.scenario
    what = f"formula-{number:02d}" if scenario is None else f"scenario-{scenario:02d}"
    return f"{what}-{search.specification.set_name}"


def _asked(search: Search) -> str:
    """A short text that changes with the claim of a search, and with its text and the values that are kept
    with its answer; not with the effort.
    """
    return digest(search.claim.digest(), search.query.text, search.setting.values)[:16]

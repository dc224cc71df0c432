"""Which parts of a scenario could be left out: every occurrence, replaced by true and by false.

A replacement is redundant where the formula stays equivalent on all traces, which is proved, and
needed where a judged drive tells the two apart. Drives found for one question are tried on the next,
and those for one scenario on the scenarios that differ from it in the road sector only.
"""

from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass, field, replace
from typing import Any

from roadproof.analysis.placing import Shown, as_data, show_elsewhere
from roadproof.analysis.requests import Asked, Request, applied, ask
from roadproof.effort import Effort, Late
from roadproof.evidence.certificate import to_json
from roadproof.evidence.drive_file import read_drive
from roadproof.evidence.judged import judge_file
from roadproof.evidence.refutation import trace_data
from roadproof.judge.exact import judge
from roadproof.logic import formula as f
from roadproof.logic.formula import Formula, is_state, subformulas
from roadproof.logic.restore import as_syntax
from roadproof.logic.show import text
from roadproof.prove.prover import prove
from roadproof.spec.bind import bind, default_values
from roadproof.spec.elaborate import read_claim
from roadproof.spec.library import Specification
from roadproof.spec.scenarios import Scenario, vehicles_of, without_sectors
from roadproof.verdict import Verdict
from roadproof.witness.question import Means, usual_road

# How many drives are tried on other roads for a change inside a road sector.
MOVED = 5


@dataclass(frozen=True)
class Change:
    """One occurrence of a part replaced by a truth value; ``where``: the definitions around it.

    ``weakens``: what is left holds wherever the whole formula does; else it holds only there.
    """

    where: tuple[str, ...]
    part: str
    value: bool
    changed: str
    weakens: bool


@dataclass(frozen=True)
class Finding:
    """PROVED: the change may be made. REFUTED: it matters, as a drive shows, or else a trace. UNKNOWN.

    ``trace`` is a judged countermodel over points in time, where no drive was found. ``assuming``: a
    condition on the trace under which the change may be made, part of ``claim``; empty where it always may.
    ``late``: cut off by the clock, so that nothing was looked for in vain.
    """

    node: Scenario
    change: Change
    verdict: Verdict
    claim: str
    certificate: str | None = None
    drive: Mapping[str, Any] | None = None
    trace: Mapping[str, Any] | None = None
    reason: str = ""
    assuming: str = ""
    late: bool = False


def changes_of(formula: Formula, whole: bool = False) -> Iterator[Change]:
    """Every occurrence of a part of ``formula``, but itself, by true and by false, from the outside in.

    A definition of one instant that compares numbers, or uses no other one, is one part unless
    ``whole``: ``rssViolation``, ``aheadOf``, ``atLane``.
    """

    def walk(
        current: Formula,
        rebuild: Callable[[Formula], Formula],
        where: tuple[str, ...],
        positive: bool,
        root: bool,
    ) -> Iterator[Change]:
        if isinstance(current, f.Named) and (whole or not _is_simple(current)):
            label = f"{current.name}({','.join(current.arguments)})"
            yield from walk(current.body, rebuild, (*where, label), positive, root)
            return
        if isinstance(current, f.Truth) or (isinstance(current, f.Named) and current.body == f.TRUE):
            return
        if not root:
            shown = text(as_syntax(current))
            for value in (True, False):
                changed = text(as_syntax(rebuild(f.Truth(value))))
                yield Change(where, shown, value, changed, value == positive)
        parts = () if isinstance(current, f.Named) else f.children(current)
        for place, part in enumerate(parts):
            inside = _inside(current, parts, place, rebuild)
            yield from walk(part, inside, where, positive != isinstance(current, f.Not), False)

    yield from walk(formula, lambda x: x, (), True, True)


def _inside(
    around: Formula, parts: tuple[Formula, ...], place: int, rebuild: Callable[[Formula], Formula]
) -> Callable[[Formula], Formula]:
    return lambda new: rebuild(f.with_children(around, (*parts[:place], new, *parts[place + 1 :])))


def _is_simple(formula: f.Named) -> bool:
    below = list(subformulas(formula.body))
    numbers = any(isinstance(x, f.Compare) for x in below)
    roads = any(isinstance(x, f.Occupies) for x in below)
    alone = not any(isinstance(x, f.Named) for x in below)
    return is_state(formula) and (alone or (numbers and not roads))


@dataclass(frozen=True)
class Learned:
    """What one scenario leaves to those that differ from it in the road sector only.

    By the changed formula, without sectors: drives that told it apart; ``vain``: looked for in vain.
    """

    drives: Mapping[Formula, Shown] = field(default_factory=dict)
    vain: frozenset[Formula] = frozenset()


def examine(
    asked: Asked, node: Scenario, whole: bool = False, learned: Learned = Learned()
) -> tuple[Finding, ...]:
    """The findings on every change of a scenario, in the order of ``changes_of``."""
    return tuple(_Examining(asked, node, learned).run(whole))


def learn(asked: Asked, drives: Iterable[tuple[str, Shown]], vain: Iterable[str]) -> Learned:
    """What the findings on one scenario teach about its likes; changed formulas are given as text."""
    _, specification = asked.load()
    return Learned(
        {_key(specification, changed): shown for changed, shown in drives},
        frozenset(_key(specification, changed) for changed in vain),
    )


def _in_sector(change: Change) -> bool:
    return any(name.startswith("roadSector_") for name in (*change.where, change.part))


def _key(specification: Specification, changed: str) -> Formula:
    return without_sectors(read_claim(specification, changed).formula)


class _Examining:
    def __init__(self, asked: Asked, node: Scenario, learned: Learned = Learned()) -> None:
        self.asked = asked
        self.library, self.specification = asked.load()
        self.values = {**default_values(self.library), **asked.values}
        self.node = node
        self.text = applied(node, self.specification, vehicles_of(self.specification, node))
        self.learned = learned
        self.mine: list[Shown] = []

    def run(self, whole: bool) -> Iterator[Finding]:
        formula = read_claim(self.specification, self.text).formula
        changes = list(changes_of(formula, whole))
        known: dict[str, Finding] = {}
        try:
            self._collect()
        except Late as late:
            known = {x.changed: self._doubt(x, late) for x in changes}
        for change in changes:
            if change.changed not in known:
                try:
                    known[change.changed] = self._decide(change)
                except Late as late:
                    known[change.changed] = self._doubt(change, late)
            yield replace(known[change.changed], change=change)

    def _doubt(self, change: Change, late: Late) -> Finding:
        claim = f"{self.text} <-> ({change.changed})"
        return Finding(self.node, change, Verdict.UNKNOWN, claim, reason=str(late), late=True)

    def _collect(self) -> None:
        """Drives of this scenario, and drives for earlier ones put on a road of its sector."""
        distinct = {repr(shown.data["vehicles"]): shown for shown in self.learned.drives.values()}
        for shown in distinct.values():
            placed = show_elsewhere(shown, self.text, self.library)
            if placed is not None:
                self.mine.append(placed)
        if not self.mine:
            found = self._ask(self.text)
            if found is not None:
                self.mine.append(found)

    def _candidates(self, change: Change) -> Iterator[tuple[Shown, bool]]:
        """Known drives that may tell a change apart, and whether they are to be tried on other roads too."""
        yield from ((shown, False) for shown in self.mine)
        if _in_sector(change):
            yield from ((shown, True) for shown in self.mine[:MOVED])
        else:
            twin = self.learned.drives.get(_key(self.specification, change.changed))
            yield from [] if twin is None else [(twin, True)]

    def _decide(self, change: Change) -> Finding:
        apart = f"{self.text} and not ({change.changed})"
        if change.weakens:
            apart = f"({change.changed}) and not {self.text}"
        for shown, elsewhere in self._candidates(change):
            told = self._tells_apart(shown, apart, elsewhere)
            if told is not None:
                return Finding(self.node, change, Verdict.REFUTED, apart, None, told.data)
        claim = f"{self.text} <-> ({change.changed})"
        result = prove(
            self.specification,
            read_claim(self.specification, claim),
            self._proof(),
            f"redundancy-{self.node}",
        )
        if result.verdict in (Verdict.PROVED, Verdict.VACUOUS) and result.certificate is not None:
            return Finding(self.node, change, Verdict.PROVED, claim, to_json(result.certificate))
        moving = self._redundant_in_motion(change)
        if moving is not None:
            return moving
        vain = not _in_sector(change) and _key(self.specification, change.changed) in self.learned.vain
        found = None if vain else self._ask(apart)
        if found is not None:
            self.mine.append(found)
            return Finding(self.node, change, Verdict.REFUTED, apart, None, found.data)
        within = (
            f"no drive was found with {self.asked.effort.units:g} units of work, {self.asked.horizon} s ahead"
        )
        within += ", for the same scenario on another road" if vain else ""
        if result.countermodel is not None:
            trace = trace_data(result.countermodel)
            return Finding(self.node, change, Verdict.REFUTED, claim, trace=trace, reason=within)
        reason = f"{within}, and no proof with {self.asked.proof:g}: {result.reason}"
        return Finding(self.node, change, Verdict.UNKNOWN, claim, reason=reason)

    def _redundant_in_motion(self, change: Change) -> Finding | None:
        """A proof for traces on which a vehicle that leaves L has a first moment outside it.

        Every drive is one: it does not jump, and a lane is an open set, since touching is not occupying.
        """
        vehicles = vehicles_of(self.specification, self.node)
        assuming = " and ".join(f"((atLane({x},L) U not atLane({x},L)) or G atLane({x},L))" for x in vehicles)
        there = f"({assuming} and {self.text} -> ({change.changed}))"
        back = f"({assuming} and ({change.changed}) -> {self.text})"
        claim, label = f"{there} and {back}", f"redundancy-{self.node}"
        result = prove(self.specification, read_claim(self.specification, claim), self._proof(), label)
        if result.verdict is not Verdict.PROVED or result.certificate is None:
            return None
        certificate = to_json(result.certificate)
        return Finding(self.node, change, Verdict.PROVED, claim, certificate, assuming=assuming)

    def _tells_apart(self, shown: Shown, formula: str, elsewhere: bool) -> Shown | None:
        """The drive judged on ``formula`` where it is, or also on roads of other zones."""
        file = replace(read_drive(dict(shown.data), "drive"), formula=formula, scenario=None)
        query = read_claim(self.specification, formula)
        if not set(query.vehicles) <= set(file.drive.vehicles):
            return None
        if elsewhere:
            return show_elsewhere(shown, formula, self.library)
        values = {**self.values, **file.values}
        if not judge(bind(query.formula, file.road, file.lanes, values), file.drive).holds:
            return None
        ruling = judge_file(file, self.library)
        return Shown(formula, as_data(file, ruling)) if ruling.accepted else None

    def _proof(self) -> Effort:
        return self.asked.effort.of(self.asked.proof)

    def _ask(self, formula: str) -> Shown | None:
        means = Means("smooth", effort=self.asked.effort, explain=False)
        options, specs, horizon = self.asked.options, self.asked.specs, self.asked.horizon
        road = usual_road(read_claim(self.specification, self.text).formula).name
        request = Request(
            formula, self.asked.sets[0], options, specs, self.values, road, horizon=horizon, means=means
        )
        drives = ask(request).drives
        return Shown(formula, drives[0].as_data()) if drives else None

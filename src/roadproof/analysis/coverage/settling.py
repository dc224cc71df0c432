"""A drive or a proof for every class of gaps: from the catalogue, from the prover, from a search."""

from collections.abc import Iterator, Sequence
from dataclasses import replace
from itertools import islice, product
from typing import Any

from roadproof.analysis.coverage.catalogue import HORIZON, catalogue
from roadproof.analysis.coverage.claims import STARTS, caught, missed, some_scenario
from roadproof.analysis.coverage.classes import (
    Answer,
    Classes,
    Found,
    Gap,
    Group,
    Survey,
    exchanged,
    near_miss,
)
from roadproof.analysis.coverage.minimal import simplest
from roadproof.analysis.coverage.parts import Part
from roadproof.analysis.coverage.trial import Trials
from roadproof.analysis.placing import Shown, as_data, show_elsewhere
from roadproof.analysis.requests import Request, ask
from roadproof.effort import Late
from roadproof.errors import UsageError
from roadproof.evidence.certificate import to_json
from roadproof.evidence.drive_file import DriveFile
from roadproof.evidence.judged import judge_file
from roadproof.judge.exact import judge
from roadproof.judge.replay import first_breach, first_overlap
from roadproof.logic.formula import transform
from roadproof.prove.prover import prove
from roadproof.spec.bind import bind, default_values
from roadproof.spec.elaborate import read_claim
from roadproof.verdict import Verdict
from roadproof.witness.question import Means
from roadproof.world.drive import Drive
from roadproof.world.models import load_road, load_vehicle

# Units of work for a proof before any search, and after it.
FIRST_PROOF = 2.0
LONG_PROOF = 30.0


def find_in_catalogue(survey: Survey, road_name: str, start: int, step: int) -> list[Found]:
    """The gaps among every ``step``-th drive of the catalogue; of those alike the ones with least effort."""
    road, car = load_road(road_name), load_vehicle("car")
    classes, trials = Classes(survey.asked), Trials(survey.asked, survey.wider)
    begins = bind(read_claim(trials.specification, STARTS).formula, road, {}, trials.values)
    gap = read_claim(trials.specification, missed(trials.numbers_on(road))).formula
    gap = transform(bind(gap, road, {}, trials.values), lambda part: part)
    best: dict[tuple[str, tuple[str, ...]], Found] = {}
    for drive in islice(catalogue(road, car), start, None, step):
        if not judge(begins, drive).holds or not judge(gap, drive).holds:
            continue
        if first_overlap(drive, HORIZON) or first_breach(drive, dict.fromkeys(drive.vehicles, car), None):
            continue
        options = trials.specification.options
        file = DriveFile(None, survey.asked.sets[0], "", HORIZON, {}, trials.values, options, road, drive)
        found = Found(file, trials.first(file), classes.of(file))
        key = (found.first, found.classes)
        if key not in best or found.effort < best[key].effort:
            best[key] = found
    return list(best.values())


def settle_group(survey: Survey, group: Group, known: Sequence[Found] = ()) -> list[Answer]:
    """The answers for the classes of a group, in the order of its parts; ``known``: gaps to begin with."""
    key = repr((survey.asked, survey.wider))
    if key not in _prepared:
        _prepared.clear()
        _prepared[key] = _Prepared(survey)
    return _Settling(survey, group, known, _prepared[key]).run()


class _Prepared:
    """What is read from the library for a survey."""

    def __init__(self, survey: Survey) -> None:
        self.library, self.specification = survey.asked.load()
        self.values = {**default_values(self.library), **survey.asked.values}
        self.classes = Classes(survey.asked)
        self.trials = Trials(survey.asked, survey.wider)


_prepared: dict[str, _Prepared] = {}  # once a process, since it takes a second


class _Settling:
    def __init__(self, survey: Survey, group: Group, known: Sequence[Found], ready: _Prepared) -> None:
        self.survey = survey
        self.asked = survey.asked
        self.group = group
        self.known = list(known)
        self.library, self.specification = ready.library, ready.specification
        self.sectors = ready.classes.sectors
        self.values, self.classes, self.trials = ready.values, ready.classes, ready.trials
        self.numbers = tuple(n for sector in self.sectors for n in sector)

    def run(self) -> list[Answer]:
        """Conditions first: a gap for one is one for its component, too."""
        conditions = [self._answer(part) for part in self.group.conditions]
        return [self._answer(self.group.component, self.survey.wider), *conditions]

    def _answer(self, part: Part | None, wider: Sequence[str] = ()) -> Answer:
        """As ``_settle``; in doubt where the clock cuts it off."""
        try:
            return self._settle(part, wider)
        except Late as late:
            return Answer(part, Verdict.UNKNOWN, reason=str(late))

    def _settle(self, part: Part | None, wider: Sequence[str] = ()) -> Answer:
        """A gap for the class, or a proof; with ``wider``, a gap for each set that may be the first."""
        if not self._of(part):
            proved = self._prove(part, FIRST_PROOF)
            if proved is not None:
                return proved
            reason = self._look(part, "", self.survey.roads, self.asked.effort.units)
            if reason:
                return self._prove(part, LONG_PROOF) or Answer(part, Verdict.UNKNOWN, reason=reason)
        for first in wider:
            if all(found.first != first for found in self._of(part)):
                self._look(part, first, self.survey.roads[:1], self.asked.effort.units / 2)
        best: dict[str, Found] = {}
        for found in sorted(self._of(part), key=lambda found: found.effort):
            best.setdefault(found.first, found)
        if not wider:
            best = dict(list(best.items())[:1])
        order = [*self.survey.wider, ""]
        chosen = sorted(best.values(), key=lambda found: order.index(found.first))
        gaps = tuple(self._gap(part, found) for found in chosen)
        return Answer(part, Verdict.WITNESSED, gaps, none_for=tuple(x for x in wider if x not in best))

    def _of(self, part: Part | None) -> list[Found]:
        """The known gaps of the class."""
        return [found for found in self.known if self.classes.has(part, found.classes)]

    def _prove(self, part: Part | None, units: float) -> Answer | None:
        """That the class of ``part`` is empty, in every road sector; ``units`` for a look at the first."""
        attempts = [self._all_are_near()] if part is None else [self._is_redundant(part), self._no_gaps(part)]
        for claims in attempts:
            if (
                prove(
                    self.specification, read_claim(self.specification, claims[0]), self.asked.effort.of(units)
                ).certificate
                is None
            ):
                continue
            claim = " and ".join(claims)
            long = self.asked.effort.of(max(LONG_PROOF, units) * len(self.sectors))
            result = prove(self.specification, read_claim(self.specification, claim), long, "gap")
            if result.verdict in (Verdict.PROVED, Verdict.VACUOUS) and result.certificate is not None:
                return Answer(part, Verdict.IMPOSSIBLE, (), claim, to_json(result.certificate))
        return None

    def _is_redundant(self, part: Part) -> list[str]:
        """That the scenario holds without the part only where it holds, a claim for each road sector."""
        return [
            f"({counterpart.without} -> scenario_{counterpart.scenario}(SV,POV,L))"
            for counterpart, _ in self.classes.counterparts(part)
        ]

    def _no_gaps(self, part: Part) -> list[str]:
        """That near misses of ``part`` are no gaps, in either role: claims for each road sector.

        Danger is the same in either order, but that is not taken for granted.
        """
        return [
            f"({counterpart.without} and F danger({pair}) -> {some_scenario(sector)})"
            for counterpart, sector in self.classes.counterparts(part)
            for pair in ("SV,POV", "POV,SV")
        ]

    def _all_are_near(self) -> list[str]:
        """That a gap is a near miss but for a single condition, a claim for each road sector."""
        claims = []
        for sector in self.sectors:
            parts = [p for number in sector for p in self.classes.by_number[number] if p.finest]
            near = " or ".join(f"({x})" for p in parts for x in (p.without, exchanged(p.without)))
            start = f"roadSector_{sector[0]}(SV,POV) and atLane(SV,L) and {STARTS}"
            claims.append(f"({start} -> {some_scenario(sector)} or {near})")
        return claims

    def _look(self, part: Part | None, first: str, roads: Sequence[str], units: float) -> str:
        """Look for a gap on the roads in turn, with so much work each; why none was found, or empty."""
        reasons = []
        for name in roads:
            numbers = self.trials.numbers_on(load_road(name))
            for counterpart in self._on(part, numbers):
                request = Request(
                    self._formula(counterpart, numbers, first),
                    self.asked.sets[0],
                    self.asked.options,
                    self.asked.specs,
                    self.values,
                    name,
                    horizon=self.asked.horizon,
                    means=Means("smooth", effort=self.asked.effort.of(units), explain=False),
                )
                try:
                    outcome = ask(request)
                except UsageError as error:  # an interval that is off the grid, a comparison too steep
                    reasons.append(f"no search on {name}: {error}")
                    continue
                if outcome.drives:
                    file = simplest(outcome.drives[0].file, self.library)
                    self.known.append(Found(file, self.trials.first(file), self.classes.of(file)))
                    return ""
                reasons.append(f"{outcome.reason or 'none'} on {name}")
        return f"{'; '.join(reasons)}; {units:g} units of work each, {self.asked.horizon} s of driving"

    def _on(self, part: Part | None, numbers: Sequence[int]) -> list[Part | None]:
        """The counterparts of a part among these scenarios."""
        if part is None:
            return [None]
        return [p for p, _ in self.classes.counterparts(part) if p.scenario in numbers]

    def _formula(self, part: Part | None, numbers: Sequence[int], first: str = "") -> str:
        """What a gap of the class satisfies; with ``first`` one that this set is the first to catch."""
        written = [missed(numbers)]
        if part is None:
            parts = [p for number in numbers for p in self.classes.by_number[number] if p.finest]
            written += [f"not {near_miss(p)}" for p in parts]
        else:
            written.append(part.without)
        if first:
            before = self.survey.wider[: self.survey.wider.index(first)]
            written += [caught(numbers, first), *(f"not {caught(numbers, name)}" for name in before)]
        return " and ".join(written)

    def _gap(self, part: Part | None, found: Found) -> Gap:
        """The drive as evidence for the class, judged on the scenarios of all road sectors."""
        counterpart, turned = self._turned(part, found.file)
        formula = self._formula(counterpart, self.numbers)
        file = replace(turned, formula=formula, scenario=None)
        ruling = judge_file(file, self.library)
        assert ruling.accepted, ruling.reason
        data = as_data(file, ruling)
        smallest = self.trials.smallest(file)
        whole = part is None or not part.condition
        elsewhere = dict(self._elsewhere(part, Shown(formula, data))) if whole else {}
        return Gap(file.road.name, formula, data, found.first, smallest, found.classes, elsewhere)

    def _turned(self, part: Part | None, file: DriveFile) -> tuple[Part | None, DriveFile]:
        """The sector, the roles and the lane in which the scenario of ``part`` is missed by it alone."""
        if part is None:
            return None, replace(file, lanes={})
        mine, theirs = file.drive.vehicles["SV"], file.drive.vehicles["POV"]
        exchanged = Drive({"SV": theirs, "POV": mine})
        for counterpart, _ in self.classes.counterparts(part):
            query = read_claim(self.specification, counterpart.without).formula
            for drive, lane in product((file.drive, exchanged), file.road.lanes):
                bound = bind(query, file.road, {"L": lane}, self.values)
                if judge(bound, drive).holds:
                    return counterpart, replace(file, drive=drive, lanes={"L": lane})
        raise AssertionError(f"the drive is no near miss of {part.key}")

    def _elsewhere(self, part: Part | None, shown: Shown) -> Iterator[tuple[str, dict[str, Any]]]:
        """The same motions on other roads, where a counterpart is missed as nearly."""
        counterparts = self._on(part, self.numbers)[::-1]
        home = shown.data["road"]["name"]
        for road in (name for name in self.survey.elsewhere if name != home):
            for counterpart in counterparts:
                formula = self._formula(counterpart, self.numbers)
                placed = show_elsewhere(shown, formula, self.library, (road,))
                if placed is not None:
                    yield road, placed.data
                    break

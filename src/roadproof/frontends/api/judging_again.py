"""The answer of a catalogue compared with its tests: each is judged again, and every figure derived again."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import get_args

from roadproof.analysis.basis import ProofResult
from roadproof.analysis.catalogue.entries import Abstract, Request, read_request
from roadproof.analysis.catalogue.examination import Examination, examine
from roadproof.analysis.catalogue.fact import Fact, read_fact
from roadproof.analysis.catalogue.meaning import GAPS, AboutGaps, Kept, Meanings
from roadproof.analysis.catalogue.result import DerivedResult
from roadproof.analysis.catalogue.showing import names_shown
from roadproof.analysis.catalogue.sides import decisions_of, read_side_name
from roadproof.analysis.coverage.answers import ClassAnswer, name_of, names_of
from roadproof.analysis.study.evidence_store import EvidenceStore, inside
from roadproof.analysis.study.pool import Progress
from roadproof.engines.search.measure import Sense
from roadproof.errors import InputError, RoadproofError
from roadproof.evidence.answers import coverage
from roadproof.evidence.answers.catalogue_index import SCHEMA, AbstractTest, ConcreteTest, Index, KeptFact
from roadproof.evidence.codec import read, write
from roadproof.evidence.finding import Acceptance, Finding
from roadproof.evidence.folder import INDEX, FolderStatements
from roadproof.evidence.strict import Fields, JsonObject, read_json
from roadproof.evidence.subject import OTHER, DriverSide, Subject, SubjectKind, subject_of_fact
from roadproof.frontends.api.definitions import Definitions
from roadproof.frontends.api.restricting import drivers_of
from roadproof.frontends.api.settings import basis_of
from roadproof.frontends.report.catalogue import tables
from roadproof.frontends.settings.studies import Catalogue
from roadproof.library.scenarios import name_of as scenario_name
from roadproof.library.specification import Library
from roadproof.reasons import NO_REASON, Reason, Why
from roadproof.runtime.executors import Jobs
from roadproof.runtime.records import dataclass

_DERIVED = (
    "targets",
    "not_tested",
    "figures",
    "decisions",
    "ranges",
    "faults",
    "doubts",
    "alike",
    "contradictions",
    "notes",
)
_ASKED = ("scenarios", "options", "parameters")


@dataclass(frozen=True)
class Comparison:
    """``findings`` on the tests and on what is derived from them; ``compared``: what was compared with what
    is derived, of the files beside the index and of the fields that other answers do not have compared.
    """

    findings: tuple[Finding, ...]
    compared: tuple[str, ...] = ()


def compare(told: FolderStatements, jobs: Jobs = None, progress: Progress | None = None) -> Comparison | None:
    """What judging the tests again shows of a folder; None where its index is not that of a catalogue."""
    index, library = told.index, told.library
    if index is None or library is None or index.text("schema") != SCHEMA:
        return None
    where = str(told.folder / INDEX)
    try:
        request = read_request(index.get("request"), f"{where}, request")
        home = _definitions(index, library, request)
        numbers = tuple(Fields({"n": x}, f"{where}, scenarios").whole("n") for x in index.items("scenarios"))
        basis = basis_of(replace(home, sets=home.sets[:1]), Catalogue())
        drivers = drivers_of(home, request.drivers)
        made = examine(request, basis, numbers, home.specification, drivers, jobs, progress, fresh=True)
        facts = tuple(_facts(index, told.folder, made.study))
        gaps = dict(_gaps(index, made.study))
    except RoadproofError as error:
        return Comparison((Finding(where, "index", Acceptance.UNDECIDED, Why.NOT_AGAIN(error)),))
    known: dict[str, Kept] = {"facts": facts, **gaps}
    again = DerivedResult(made, known)
    now = read(Index, inside(write(again.index({}, 0.0)), told.folder), where)
    findings = [*_tests(index, now, where), *_about_facts(made, facts, where), *_whole(index, now, where)]
    written = tables(again)
    for name, content in written.items():
        path = told.folder / name
        if path.is_file() and path.read_bytes() != content:
            findings.append(_rejected(str(path), Why.OTHER_TABLE()))
    return Comparison(tuple(findings), ("parameters", *written))


def _definitions(index: Fields, library: Library, request: Request) -> Definitions:
    """What the answer was asked with. Raises ``InputError``."""
    if request.sets[:1] != (index.text("set"),):
        raise InputError(f"{index.where}: set={index.text('set')}, but request.sets={request.sets}")
    specification = library.select(request.sets[0], index.named_texts("options"))
    said = index.mapping("parameters")
    values = {name: Fields(said, f"{index.where}, parameters").rational(name) for name in said}
    return Definitions(specification, request.sets, values)


def _facts(index: Fields, folder: Path, study: Meanings) -> Iterator[Fact]:
    """The facts of an index with their drives; certificates are checked as files. Raises ``InputError``."""
    shelf, home = EvidenceStore(None, study.question), study.basis.specification
    for number, content in enumerate(index.items("facts"), 1):
        said = read(KeptFact, content, f"{index.where}, fact {number}")
        drive = read_json(folder / said.drive) if isinstance(said.drive, str) else said.drive
        yield read_fact(replace(said, certificate=None, drive=drive), home, shelf)


def _gaps(index: Fields, study: Meanings) -> Iterator[tuple[str, Kept]]:
    """What an index says of gaps; its evidence is checked as files. Raises ``InputError``."""
    if study.survey is None or study.gaps is None:
        return
    found = Fields(index.mapping("gaps"), f"{index.where}, gaps")
    claims = {x.query.text: x for x in study.survey.claims}
    if len(found.items("claims")) != len(claims):
        raise InputError(f"{found.where}: with gaps asked for there are {len(claims)} claims")
    for number, content in enumerate(found.items("claims"), 1):
        where = f"{found.where}, claim {number}"
        said = read(coverage.Claim, content, where)
        if said.claim not in claims:
            raise InputError(f"{where}: coverage does not rest on this claim")
        claim = claims[said.claim]
        answer = ProofResult(claim.query, verdict=said.verdict, reason=said.reason)
        yield GAPS + name_of(claim), AboutGaps(answer)
    parts = (
        {}
        if not found.items("classes")
        else {tuple(names_of(x).values()): x for x in study.gaps.parts.values()}
    )
    for number, content in enumerate(found.items("classes"), 1):
        where = f"{found.where}, class {number}"
        one = read(coverage.KeptClass, content, where)
        key = tuple(getattr(one, name) for name in names_of(None))
        if key not in parts:
            raise InputError(f"{where}: there is no such class of gaps, or it is said twice")
        answers = (ClassAnswer(parts.pop(key), verdict=one.verdict, reason=one.reason),)
        yield f"{GAPS}class-{number}", AboutGaps(answers)


# --- tests ---------------------------------------------------------------------------------------


def _tests(index: Fields, again: Index, where: str) -> Iterator[Finding]:
    """A finding for each test that is in the index or among the tests now."""
    said = {str(x.get("id")): x for x in index.items("tests") if isinstance(x, dict)}
    now = {x.id: x for x in again.tests}
    if len(said) < len(index.items("tests")):
        yield _rejected(where, Why.ONE_ID())
    for name, test in now.items():
        decided = (x for x in again.decisions if x.test == name)
        sides = tuple(DriverSide(driver=x.driver, scenario=x.scenario, side=x.side) for x in decided)
        yield replace(_of_test(name, said.get(name), test, where), drivers=sides)
    for name in said:
        if name not in now:
            yield _rejected(where, Why.TEST_GONE(), name, _test(name))


def _of_test(name: str, said: JsonObject | None, now: ConcreteTest | AbstractTest, where: str) -> Finding:
    if said is None:
        return _rejected(where, Why.TEST_UNKNOWN(), name, _test(name))
    if isinstance(now, ConcreteTest) and said.get("sha256") != now.sha256:
        return _rejected(
            where, (Why.FILE_CHANGED if now.sha256 else Why.FILE_GONE)(now.file), name, _test(name)
        )
    data = write(now)
    wrong = [key for key in dict.fromkeys((*said, *data)) if said.get(key) != data.get(key)]
    if wrong:
        return _rejected(where, Why.JUDGED_OTHERWISE(", ".join(wrong)), name, _test(name))
    found = Finding(
        where, "index", Acceptance.ACCEPTED, label=f"test {name}", subject=SubjectKind.TEST, name=name
    )
    if isinstance(now, AbstractTest):
        return replace(found, verdict="READ", claim=now.formula)
    shown = ", ".join(dict.fromkeys(x.what for x in now.shown)) or "no scenario"
    how = "read again" if now.fault else "judged again in dense time" if now.dense else "monitored again"
    return replace(
        found,
        kind="test",
        verdict="JUDGED",
        claim=f"cannot be read: {now.fault}" if now.fault else f"shows {shown}",
        checked=(how, "its file is unchanged"),
        shows="unreadable" if now.fault else "scenarios" if now.shown else "nothing",
    )


# --- what is derived -----------------------------------------------------------------------------


def _about_facts(made: Examination, facts: Sequence[Fact], where: str) -> Iterator[Finding]:
    """What is wrong with facts though their evidence is accepted, and which are missing."""
    entries = {x.id: x for x in made.tests.entries if isinstance(x, Abstract)}
    for fact in facts:
        reason = _wrong(fact, entries, made)
        if reason:
            yield _rejected(
                where,
                reason,
                f"{fact.test} {fact.relation} {fact.other}".strip(),
                subject_of_fact(fact.test, fact.relation),
            )
    ends = {(x.other, x.term) for x in facts if x.term}
    for reach in made.study.reaches:
        if (reach.target, reach.term) not in ends:
            yield _rejected(where, Why.NO_RANGE(reach.term), reach.target)
    for name, entry in entries.items():
        those = [x for x in facts if x.test == name]
        alone = [x for x in those if not x.other]
        if len(alone) != 1:
            yield _rejected(where, Why.RUNS_UNSAID(), name, _test(name))
        elif alone[0].relation == "runs":
            known = {x.other for x in those}
            missing = [x for x in made.study.asked.scenarios_of(entry.query.vehicles) if x not in known]
            if missing:
                yield _rejected(where, Why.NOTHING_SAID(", ".join(missing)), name, _test(name))


def _wrong(fact: Fact, entries: Mapping[str, Abstract], made: Examination) -> Reason:
    """Why a fact is not about its test, or its drive does not show what it says; empty where it does."""
    asked = made.study.asked
    if fact.test:
        entry = entries.get(fact.test)
        if entry is None:
            return Why.NO_ABSTRACT_TEST()
        expected = entry.query
    else:
        expected = asked.query_of(fact.other)
    if not fact.test and fact.relation in ("reaches", "open"):
        known = {(x.target, x.term) for x in made.study.reaches}
        if (fact.other, fact.term) not in known or fact.sense not in get_args(Sense):
            return Why.RANGE_UNASKED()
    elif fact.term or fact.sense or fact.at is not None:
        return Why.NUMBER_UNASKED()
    if fact.premise.formula != expected.formula:
        return Why.OTHER_PREMISE(fact.test or fact.other)
    if fact.test and fact.other not in entries:
        reason = _wrong_target(fact, made)
        if reason:
            return reason
    if fact.drive is None or fact.relation == "reaches":
        return Why.DRIVES_LACKING() if fact.also else NO_REASON
    shown = {*names_shown(fact.drive, asked)}
    return NO_REASON if shown == {*fact.also} else Why.DRIVE_SHOWS(", ".join(sorted(shown)) or "nothing")


def _wrong_target(fact: Fact, made: Examination) -> Reason:
    """Why a fact of a test speaks of nothing that was asked, or its drive is on the other side of a model."""
    asked, target = made.study.asked, fact.other
    scenarios = {*map(scenario_name, asked.numbers)}
    side = read_side_name(target)
    if side is None:
        beside = {f"{x}@{y.specification.set_name}" for x in scenarios for y in made.study.beside}
        is_asked = target in ("", *scenarios, *beside, *asked.named.values())
        return NO_REASON if is_asked else Why.UNASKED(target)
    scenario, wanted, model = side
    drivers = made.study.drivers
    if drivers is None or model not in drivers.models or scenario not in scenarios:
        return Why.UNASKED(target)
    if fact.conclusion is not None and fact.conclusion.formula != asked.query_of(scenario).formula:
        return Why.OTHER_CONCLUSION(scenario)
    if fact.drive is None:
        return NO_REASON
    found = decisions_of([fact.drive], [scenario], asked, drivers)
    if any((x.driver, x.side) == (model, wanted) for x in found):
        return NO_REASON
    return Why.OTHER_SIDE(wanted, model)


def _whole(index: Fields, again: Index, where: str) -> Iterator[Finding]:
    """Whether all that follows from tests and facts is as it is derived now; one finding where it is."""
    said, now, gaps = index.content, write(again), write(again.gaps)
    wrong = [key for key in (*_ASKED, *_DERIVED) if said.get(key) != now[key]]
    # Further files of --spec are read for other evidence.
    named = index.texts("specs") if index.has("specs") else ()
    wrong += [] if {*named} <= {*again.specs} else ["specs"]
    found = Fields(index.mapping("gaps"), f"{where}, gaps").content
    evidence = ("claims", "classes")  # what the reader of the index checks with their files
    wrong += [
        f"gaps.{key}"
        for key in dict.fromkeys((*found, *gaps))
        if key not in evidence and found.get(key) != gaps.get(key)
    ]
    for key in wrong:
        yield _rejected(where, Why.DERIVED_OTHERWISE(key))
    if not wrong:
        kinds = (x for x in again.figures if not x.sector)
        told = ", ".join(f"{x.kind} {x.tested} of {x.total} (set {x.set_name})" for x in kinds)
        checked = ("derived again from tests and facts",)
        yield Finding(
            where, "test", Acceptance.ACCEPTED, NO_REASON, "DERIVED", "what is tested", told, checked
        )


def _test(name: str) -> Subject:
    return Subject(SubjectKind.TEST, name)


def _rejected(where: str, reason: Reason, label: str = "", subject: Subject = OTHER) -> Finding:
    return Finding(
        where, "index", Acceptance.REJECTED, reason, label=label, subject=subject.kind, name=subject.name
    )

"""The template values of a scenario's page: all statements about it, each with its source."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import TypeAlias

from roadproof.extensions.drivers.models import course_in
from roadproof.extensions.drivers.preventable.data import PlateData
from roadproof.extensions.pages.atlas.answers import OBJECTIVES, Answers, EvidenceSource, name_in
from roadproof.extensions.pages.atlas.notation import as_html, head_as_html, text_as_html
from roadproof.extensions.pages.atlas.pictures import AtlasPicture
from roadproof.extensions.pages.atlas.traffic import SOURCE, frequencies
from roadproof.extensions.pages.page.plates import plane_of
from roadproof.extensions.surveys.coverage import schema as coverage
from roadproof.library.scenarios import Scenario, apply_scenario
from roadproof.library.specification import Specification
from roadproof.library.uses import PartsOfClaim, parts_of_claim
from roadproof.library.words import Words
from roadproof.logic.show import decimal
from roadproof.questions.overlap_data import PairData
from roadproof.verdict import Verdict

CAREFUL = "careful"
_DECIDED = (Verdict.WITNESSED, Verdict.IMPOSSIBLE)
_Pair: TypeAlias = tuple[Words, EvidenceSource, PairData]


@dataclass(frozen=True)
class SourcedStatement:
    """A verdict on a statement, which is HTML, with its source; ``text``: the statement in words."""

    verdict: str
    html: str
    source: EvidenceSource
    text: str = ""
    set: str = ""


@dataclass(frozen=True)
class ShownDefinition:
    """A definition: its head and body as HTML, and its description."""

    name: str
    head: str
    doc: str
    body: str


def scenario_values(answers: Answers, pictures: Mapping[str, AtlasPicture], number: int) -> dict[str, object]:
    """Return the template values of a scenario's page."""
    home = answers.home.alone
    words = answers.home.words(number)
    drives = {x: answers.drives[x][number] for x in OBJECTIVES if number in answers.drives.get(x, {})}
    before = [n for n in answers.numbers if n < number]
    after = [n for n in answers.numbers if n > number]
    pairs = [*_pairs(answers, number)]
    return {
        "words": words,
        "before": answers.home.words(before[-1]) if before else None,
        "after": answers.home.words(after[0]) if after else None,
        "drives": {x: (pictures[y.source.file], y.source) for x, y in drives.items()},
        "definitions": definitions_shown(home, number),
        "parameters": _parameters(home, number),
        "claims": claims(answers, number),
        "partners": [
            (partner, pictures[source.file], source)
            for partner, source, x in pairs
            if x.verdict is Verdict.WITNESSED
        ],
        "excluded": _excluded(pairs),
        "open_pairs": [
            (partner, x.reason, source) for partner, source, x in pairs if x.verdict not in _DECIDED
        ],
        "implications": _implications(answers, number),
        "parts": _parts(answers, number),
        "plates": _plates(answers, number),
        "gaps": [x for x in all_gaps(answers, pictures) if x.gap_class.scenario == number],
        "frequencies": frequencies(number, words.sector),
        "traffic_source": SOURCE,
    }


# --- the formula ----------------------------------------------------------------------------------


def definitions_shown(home: Specification, number: int) -> list[ShownDefinition]:
    """Return the definition of a scenario and those that it uses, in reading order."""
    used = _used(home, number).definitions
    names = {x.name for x in used}
    return [
        ShownDefinition(x.name, head_as_html(x), home.describe(x), as_html(x.body, names - {x.name}, "d-"))
        for x in used
    ]


def _parameters(home: Specification, number: int) -> list[tuple[str, str, str]]:
    """Return the parameters of a scenario: name as HTML, value with unit, and description."""
    parameters = _used(home, number).parameters
    return [(text_as_html(x.name), f"{decimal(x.value)} {x.unit}", x.doc) for x in parameters]


def _used(home: Specification, number: int) -> PartsOfClaim:
    return parts_of_claim(home, apply_scenario(home, Scenario(number, home.set_name)).claim)


# --- claims, pairs, implications, parts -------------------------------------------------------------


@dataclass(frozen=True)
class PropertyVerdicts:
    """A property as HTML, with its verdict and source in each spec set."""

    name: str
    title: str
    html: str
    verdicts: Mapping[str, tuple[str, EvidenceSource]]


def claims(answers: Answers, number: int | None) -> list[PropertyVerdicts]:
    """Return the properties of a scenario with their verdicts; for None, those of no single scenario."""
    groups: dict[tuple[str, str], dict[str, tuple[str, EvidenceSource]]] = {}
    titles: dict[tuple[str, str], str] = {}
    for x in () if answers.proofs is None else answers.proofs.verdicts:
        if x.scenario == number:
            arguments = x.property if number is None else f"{x.property} {number}"
            flag = "" if x.set in answers.home.sets else f" --set {x.set}"
            source = answers.source("prove", arguments + flag, "proofs", x.evidence)
            name = f"{x.property} {x.part}".strip()
            titles.setdefault((name, x.claim), answers.titles.get(f"{x.property}@{x.set}", ""))
            groups.setdefault((name, x.claim), {})[x.set] = x.verdict, source
    return [
        PropertyVerdicts(key[0], titles[key], text_as_html(key[1]), verdicts)
        for key, verdicts in groups.items()
    ]


def _pairs(answers: Answers, number: int) -> Iterator[_Pair]:
    """Yield the pairs of a scenario with others."""
    for x in () if answers.overlap is None else answers.overlap.verdicts:
        if number in (x.a, x.b):
            source = answers.source("overlap", f"--among {x.a},{x.b}", "overlap", name_in(x.evidence))
            yield answers.home.words(x.b if x.a == number else x.a), source, x


def _excluded(pairs: Sequence[_Pair]) -> dict[tuple[str, ...], list[tuple[Words, EvidenceSource]]]:
    """Return the scenarios that exclude this one, by the conflicting parts as HTML."""
    groups: dict[tuple[str, ...], list[tuple[Words, EvidenceSource]]] = {}
    for words, source, pair in pairs:
        if pair.verdict is Verdict.IMPOSSIBLE:
            groups.setdefault(tuple(map(text_as_html, pair.core)), []).append((words, source))
    return groups


def _implications(answers: Answers, number: int) -> list[SourcedStatement]:
    """Return the proved implications from or to a scenario, in any set."""
    statements = []
    for x in () if answers.order is None else answers.order.proved:
        ends = [end.partition("@") for end in x.pair]
        if str(number) in [end[0] for end in ends]:
            among = f"--among {','.join({y[0]: 0 for y in ends})}"
            source = answers.source("order", among, "order", name_in([x.certificate]))
            statements.append(
                SourcedStatement(
                    "PROVED",
                    f"{text_as_html(x.claim)}",
                    source,
                    " implies ".join(end.replace("@", " in ") for end in x.pair),
                )
            )
    return statements


def _parts(answers: Answers, number: int) -> list[SourcedStatement]:
    """Return the changes of a scenario's parts: first redundant parts, then undecided ones, then
    needed ones.
    """
    statements = []
    for x in () if answers.redundancy is None else answers.redundancy.verdicts:
        if x.scenario == number:
            file = name_in([] if x.evidence is None else [x.evidence])
            source = answers.source("redundancy", f"--among {number}", "redundancy", file)
            location = f"{x.where[-1]}, with {str(x.value).lower()} in place of" if x.where else ""
            statements.append(SourcedStatement(x.verdict, text_as_html(x.part), source, location))
    return sorted(statements, key=lambda x: (x.verdict != Verdict.PROVED, x.verdict == Verdict.REFUTED))


# --- plates and gaps ------------------------------------------------------------------------------


def _plates(answers: Answers, number: int) -> dict[str, object] | None:
    """Return the plates of a careful driver in the manoeuvre of a scenario, None where it has none."""
    manoeuvre = course_in(number)
    index = None if manoeuvre is None else answers.plates.get(manoeuvre)
    if index is None:
        return None
    careful = [x for x in index.plates if x.model == CAREFUL]
    return {
        "manoeuvre": manoeuvre,
        "plane": plane_of(index),
        "answer": index,
        "shown": [(x.fixed, [x], _sides(answers, f"{manoeuvre}", x)) for x in careful],
        "lemmas": [
            SourcedStatement(
                x.verdict,
                text_as_html(x.claim),
                answers.source(
                    "preventable", str(manoeuvre), f"plates-{manoeuvre}", name_in([x.certificate])
                ),
                x.title,
            )
            for x in index.lemmas
            if CAREFUL in x.name
        ],
    }


def _sides(answers: Answers, manoeuvre: str, plate: PlateData) -> list[tuple[str, EvidenceSource]]:
    """Return the drives on both sides of a plate's boundary."""
    shown_by = [x for x in plate.shown if isinstance(x.drive, str)]
    return [(x.side, _source_of_plates(answers, manoeuvre, x.drive)) for x in shown_by]


def _source_of_plates(answers: Answers, manoeuvre: str, file: object) -> EvidenceSource:
    name = name_in([] if file is None else [file])
    return answers.source("preventable", manoeuvre, f"plates-{manoeuvre}", name)


@dataclass(frozen=True)
class GapClass:
    """A class of disturbances that no scenario describes, with a drive if there is one.

    ``condition``: the part of the scenario that fails, as HTML.
    """

    gap_class: coverage.CountedClass
    condition: str
    source: EvidenceSource
    drawn: AtlasPicture | None


def all_gaps(answers: Answers, pictures: Mapping[str, AtlasPicture]) -> list[GapClass]:
    """Return the classes of gaps of the set."""
    if answers.coverage is None:
        return []
    files = {x.number: x.drive for x in answers.coverage.gaps}
    gaps = []
    for x in answers.coverage.classes:
        file = files[x.gaps[0]] if x.gaps else x.certificate
        source = answers.source("coverage", "", "coverage", None if file is None else name_in([file]))
        formula, _, home = x.condition.rpartition(" in ")  # such as "aheadOf(SV, POV) in cutIn"
        is_inside = bool(formula) and home.isidentifier()
        condition = (
            f"{text_as_html(formula)} in {text_as_html(home)}" if is_inside else text_as_html(x.condition)
        )
        gaps.append(GapClass(x, condition, source, pictures.get(source.file)))
    return gaps

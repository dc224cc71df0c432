"""The values of a scenario's page: all statements about it, each with its source."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import TypeAlias

from roadproof.extensions.drivers.models import course_in
from roadproof.extensions.drivers.preventable.data import PlateData
from roadproof.extensions.pages.atlas.answers import OBJECTIVES, Answers, Source, name_in
from roadproof.extensions.pages.atlas.notation import as_html, head_as_html, shown
from roadproof.extensions.pages.atlas.pictures import DrivePicture
from roadproof.extensions.pages.atlas.traffic import SOURCE, frequencies
from roadproof.extensions.pages.page.plates import plane_of
from roadproof.extensions.surveys.coverage import kept as coverage
from roadproof.library.scenarios import Scenario, applied
from roadproof.library.specification import Specification
from roadproof.library.uses import Used, used_in
from roadproof.library.words import Words
from roadproof.logic.show import decimal
from roadproof.questions.overlap import PairData
from roadproof.verdict import Verdict

CAREFUL = "careful"
_DECIDED = (Verdict.WITNESSED, Verdict.IMPOSSIBLE)
_Pair: TypeAlias = tuple[Words, Source, PairData]


@dataclass(frozen=True)
class Statement:
    """A verdict on something, as HTML, with its source; ``told``: in words."""

    verdict: str
    html: str
    source: Source
    told: str = ""
    set: str = ""


@dataclass(frozen=True)
class Unfolded:
    """A definition: its head and body as HTML, and what it says in words."""

    name: str
    head: str
    doc: str
    body: str


def scenario_values(answers: Answers, drawn: Mapping[str, DrivePicture], number: int) -> dict[str, object]:
    """What the template of the page shows."""
    home = answers.home.alone
    words = answers.home.words(number)
    found = {x: answers.drives[x][number] for x in OBJECTIVES if number in answers.drives.get(x, {})}
    before = [n for n in answers.numbers if n < number]
    after = [n for n in answers.numbers if n > number]
    pairs = [*_pairs(answers, number)]
    return {
        "words": words,
        "before": answers.home.words(before[-1]) if before else None,
        "after": answers.home.words(after[0]) if after else None,
        "drives": {x: (drawn[y.source.file], y.source) for x, y in found.items()},
        "definitions": unfolded(home, number),
        "parameters": _parameters(home, number),
        "claims": claims(answers, number),
        "partners": [
            (with_, drawn[source.file], source)
            for with_, source, x in pairs
            if x.verdict is Verdict.WITNESSED
        ],
        "excluded": _excluded(pairs),
        "open_pairs": [(with_, x.reason, source) for with_, source, x in pairs if x.verdict not in _DECIDED],
        "implications": _implications(answers, number),
        "parts": _parts(answers, number),
        "plates": _plates(answers, number),
        "gaps": [x for x in all_gaps(answers, drawn) if x.found.scenario == number],
        "frequencies": frequencies(number, words.sector),
        "traffic_source": SOURCE,
    }


# --- the formula ----------------------------------------------------------------------------------


def unfolded(home: Specification, number: int) -> list[Unfolded]:
    """The definition of a scenario, and those that it uses, in reading order."""
    used = _used(home, number).definitions
    names = {x.name for x in used}
    return [
        Unfolded(x.name, head_as_html(x), home.describe(x), as_html(x.body, names - {x.name}, "d-"))
        for x in used
    ]


def _parameters(home: Specification, number: int) -> list[tuple[str, str, str]]:
    """The parameters of a scenario: name as HTML, value with unit, and words."""
    found = _used(home, number).parameters
    return [(shown(x.name), f"{decimal(x.value)} {x.unit}", x.doc) for x in found]


def _used(home: Specification, number: int) -> Used:
    return used_in(home, applied(home, Scenario(number, home.set_name)).claim)


# --- claims, pairs, implications, parts -------------------------------------------------------------


@dataclass(frozen=True)
class Claim:
    """A property as HTML, with its verdict and source in each spec set."""

    name: str
    title: str
    html: str
    found: Mapping[str, tuple[str, Source]]


def claims(answers: Answers, number: int | None) -> list[Claim]:
    """What is proved or refuted about a scenario, or in general where None."""
    groups: dict[tuple[str, str], dict[str, tuple[str, Source]]] = {}
    titles: dict[tuple[str, str], str] = {}
    for x in () if answers.proofs is None else answers.proofs.verdicts:
        if x.scenario == number:
            arguments = x.property if number is None else f"{x.property} {number}"
            flag = "" if x.set in answers.home.sets else f" --set {x.set}"
            source = answers.source("prove", arguments + flag, "proofs", x.evidence)
            name = f"{x.property} {x.part}".strip()
            titles.setdefault((name, x.claim), answers.titles.get(f"{x.property}@{x.set}", ""))
            groups.setdefault((name, x.claim), {})[x.set] = x.verdict, source
    return [Claim(key[0], titles[key], shown(key[1]), found) for key, found in groups.items()]


def _pairs(answers: Answers, number: int) -> Iterator[_Pair]:
    """The pairs of a scenario with others."""
    for x in () if answers.overlap is None else answers.overlap.verdicts:
        if number in (x.a, x.b):
            source = answers.source("overlap", f"--among {x.a},{x.b}", "overlap", name_in(x.evidence))
            yield answers.home.words(x.b if x.a == number else x.a), source, x


def _excluded(pairs: Sequence[_Pair]) -> dict[tuple[str, ...], list[tuple[Words, Source]]]:
    """The scenarios that exclude this one, by the parts that conflict, as HTML."""
    groups: dict[tuple[str, ...], list[tuple[Words, Source]]] = {}
    for words, source, pair in pairs:
        if pair.verdict is Verdict.IMPOSSIBLE:
            groups.setdefault(tuple(map(shown, pair.core)), []).append((words, source))
    return groups


def _implications(answers: Answers, number: int) -> list[Statement]:
    """The proved implications from or to a scenario, in any set."""
    made = []
    for x in () if answers.order is None else answers.order.proved:
        ends = [end.partition("@") for end in x.pair]
        if str(number) in [end[0] for end in ends]:
            among = f"--among {','.join({y[0]: 0 for y in ends})}"
            source = answers.source("order", among, "order", name_in([x.certificate]))
            made.append(
                Statement(
                    "PROVED",
                    f"{shown(x.claim)}",
                    source,
                    " implies ".join(end.replace("@", " in ") for end in x.pair),
                )
            )
    return made


def _parts(answers: Answers, number: int) -> list[Statement]:
    """The changes of a scenario's parts: those that change nothing, those in doubt, those that matter."""
    made = []
    for x in () if answers.redundancy is None else answers.redundancy.verdicts:
        if x.scenario == number:
            file = name_in([] if x.evidence is None else [x.evidence])
            source = answers.source("redundancy", f"--among {number}", "redundancy", file)
            told = f"{x.where[-1]}, with {str(x.value).lower()} in place of" if x.where else ""
            made.append(Statement(x.verdict, shown(x.part), source, told))
    return sorted(made, key=lambda x: (x.verdict != Verdict.PROVED, x.verdict == Verdict.REFUTED))


# --- plates and gaps ------------------------------------------------------------------------------


def _plates(answers: Answers, number: int) -> dict[str, object] | None:
    """The plates of a careful driver in the manoeuvre of a scenario, if it has one."""
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
            Statement(
                x.verdict,
                shown(x.claim),
                answers.source(
                    "preventable", str(manoeuvre), f"plates-{manoeuvre}", name_in([x.certificate])
                ),
                x.title,
            )
            for x in index.lemmas
            if CAREFUL in x.name
        ],
    }


def _sides(answers: Answers, manoeuvre: str, plate: PlateData) -> list[tuple[str, Source]]:
    """The drives on both sides of a plate."""
    shown_by = [x for x in plate.shown if isinstance(x.drive, str)]
    return [(x.side, _source_of_plates(answers, manoeuvre, x.drive)) for x in shown_by]


def _source_of_plates(answers: Answers, manoeuvre: str, file: object) -> Source:
    found = name_in([] if file is None else [file])
    return answers.source("preventable", manoeuvre, f"plates-{manoeuvre}", found)


@dataclass(frozen=True)
class Gap:
    """A class of disturbances that no scenario describes, with a drive if there is one.

    ``condition``: the part that fails, as HTML.
    """

    found: coverage.CountedClass
    condition: str
    source: Source
    drawn: DrivePicture | None


def all_gaps(answers: Answers, drawn: Mapping[str, DrivePicture]) -> list[Gap]:
    """The classes of gaps of the set."""
    if answers.coverage is None:
        return []
    files = {x.number: x.drive for x in answers.coverage.gaps}
    made = []
    for x in answers.coverage.classes:
        file = files[x.gaps[0]] if x.gaps else x.certificate
        source = answers.source("coverage", "", "coverage", None if file is None else name_in([file]))
        formula, _, home = x.condition.rpartition(" in ")  # such as "aheadOf(SV, POV) in cutIn"
        is_inside = bool(formula) and home.isidentifier()
        condition = f"{shown(formula)} in {shown(home)}" if is_inside else shown(x.condition)
        made.append(Gap(x, condition, source, drawn.get(source.file)))
    return made

"""Writes assurance cases from a template that is filled in with folders of evidence."""

import json
import os
import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from fnmatch import fnmatchcase
from fractions import Fraction
from pathlib import Path

from roadproof.errors import InputError
from roadproof.evidence.answer import ClaimAnswer
from roadproof.evidence.claim import HELP
from roadproof.evidence.codec import read
from roadproof.evidence.strict import Fields
from roadproof.extensions.drivers.manoeuvres import MANOEUVRES
from roadproof.extensions.drivers.preventable.data import PreventableData
from roadproof.library.scenarios import EVERY_SCENARIO
from roadproof.questions.checking import QuestionFolder, is_question, read_folder
from roadproof.questions.views import view_data
from roadproof.verdict import Verdict
from roadproof.world.units import UNITS

TEMPLATES = ("catalogue-coverage",)
Table = Mapping[str, str | Sequence[str] | bool | int]
_MOST = 6  # values of a quantity that a goal names
_PROPERTIES = "P*"  # the template properties in an index of proofs
_MODEL = "careful"  # the driver model that the argument is about


@dataclass(frozen=True)
class _EvidenceUse:
    """The goal and the solution that a kind of evidence gets in the template."""

    goal: str
    solution: str
    expect: tuple[str, ...]
    select: tuple[str, ...] = ()


_SCENARIOS: Mapping[str, _EvidenceUse] = {
    "coverage": _EvidenceUse(
        "The scenarios of set {set} miss no danger between two vehicles that arises from safety",
        "Coverage of set {set}, proved for all time",
        ("COVERED",),
    ),
    "verdicts": _EvidenceUse(
        "{claims} of template {properties} hold in the formal scenarios",
        "Proofs of the template properties",
        ("PROVED",),
        (_PROPERTIES,),
    ),
    "witness": _EvidenceUse("{drives} can happen", "Judged drives of {drives}", ("WITNESSED",)),
    "overlap": _EvidenceUse(
        "Of {pairs} of scenarios of set {set} it is known whether both can hold at once",
        "Overlaps of set {set}",
        ("WITNESSED", "IMPOSSIBLE"),
    ),
}
_TESTS: Mapping[str, _EvidenceUse] = {
    "catalogue": _EvidenceUse(
        "The tests show {targets} of set {set} and are what they claim",
        "Review of the test catalogue",
        ("COVERED",),
        (EVERY_SCENARIO,),
    )
}
_DRIVER: Mapping[str, _EvidenceUse] = {
    "preventable": _EvidenceUse(
        "The boundary of preventable collisions {boundary} in {manoeuvre}, {plates}",
        "{drives} on both sides of the boundary in {manoeuvre}{lemmas}",
        ("WITNESSED", "DERIVED"),
        (f"{_MODEL}*",),
    )
}


@dataclass(frozen=True)
class _Branch:
    """A part of the argument, which a case has where there is evidence for it.

    ``contexts``: the ids of those in which its goal is stated.
    """

    title: str
    goal: str
    strategy: str
    uses: Mapping[str, _EvidenceUse]
    contexts: tuple[str, ...]


_BRANCHES = (
    _Branch(
        "formal scenarios",
        "the formal scenarios have the properties below",
        "Argument over the properties of the formal scenarios",
        _SCENARIOS,
        ("C1", "C2", "A1"),
    ),
    _Branch(
        "test catalogue",
        "tests show the formal scenarios below",
        "Argument over the review of the tests",
        _TESTS,
        ("C1", "C2", "A1"),
    ),
    _Branch(
        f"{_MODEL} driver",
        f"the collisions that driver model {_MODEL} prevents are known for the manoeuvres and values below",
        "Argument over the manoeuvres with evidence",
        _DRIVER,
        ("C1", "A2"),
    ),
)
_CONTEXTS: Mapping[str, Table] = {
    "C1": {"context": "The traffic disturbance scenarios of ISO 34502, formal in signal temporal logic"},
    "C2": {"context": "Danger: two vehicles are closer than their RSS distances for minDanger"},
    "A1": {"assumption": "The formal scenarios say what ISO 34502 means"},
    "A2": {"assumption": f"Driver model {_MODEL} drives as a competent and careful human driver does"},
}


def fill_template(name: str, evidence: Sequence[Path], home: Path) -> str:
    """Return the TOML text of a case for folders of evidence; the case will be in folder ``home``.

    It has goals for what the evidence shows, and an undeveloped goal for the rest of a folder. Raises
    ``InputError`` for a folder that the template cannot use.
    """
    if name not in TEMPLATES:
        raise InputError(f"template={name!r}; there is {', '.join(TEMPLATES)}")
    folders = [EvidenceFolder.read(x, home) for x in evidence]
    uses = {kind for branch in _BRANCHES for kind in branch.uses}
    for x in folders:
        if x.kind not in uses:
            accepted = ", ".join("prove" if kind == "verdicts" else kind for kind in sorted(uses))
            raise InputError(f"{x.path} has answers of {x.kind}; template {name} takes those of {accepted}")
    return as_toml(dict(tables(folders)))


@dataclass(frozen=True)
class EvidenceFolder:
    """A folder of evidence: the ``kind`` of its answers, and ``words`` that fill in the template.

    ``lemmas``: whether it has lemmas. ``entries``: the number of entries that the argument is about; 0 where
    it shows nothing. ``select``: their names, where they are not all. ``left``: the names of the others.
    """

    path: str
    kind: str
    words: Mapping[str, str]
    lemmas: bool = False
    entries: int = 0
    select: tuple[str, ...] = ()
    left: tuple[str, ...] = ()

    @staticmethod
    def read(folder: Path, home: Path) -> "EvidenceFolder":
        """Return what the template needs to know of a folder. Raises ``InputError`` for a folder without
        answers.
        """
        path = Path(os.path.relpath(folder, home)).as_posix()
        if not is_question(folder):
            raise InputError(f"{folder} has no answers: name a folder that a command has written with --out")
        stored = read_folder(folder)
        data = Fields(view_data(stored.question, stored.answers, Path()), str(folder))
        kind = [*data.text("schema").split("/"), ""][1]
        match kind:
            case "preventable":
                return _folder_of_plates(path, read(PreventableData, data.content, str(folder)))
            case "catalogue":
                return _folder_of_tests(path, data, _count(stored))
            case "coverage":
                is_shown = data.text("verdict") in _SCENARIOS[kind].expect
                left = () if is_shown else (f"{data.text('verdict')} for set {data.text('set')}",)
                words = {"set": data.text("set")}
                return EvidenceFolder(path, kind, words, entries=_count(stored) * is_shown, left=left)
            case _:  # open: kinds of answers whose claims count one by one, or are refused
                return _folder_of_claims(path, kind, data, stored)


def _count(stored: QuestionFolder) -> int:
    """Return how many findings ``check`` has for a folder."""
    return len(stored.files) + len([*stored.undecided])


def _folder_of_claims(path: str, kind: str, data: Fields, stored: QuestionFolder) -> EvidenceFolder:
    """Return the folder of answers whose claims the argument is about one by one."""
    if kind not in _SCENARIOS:
        return EvidenceFolder(path, kind, {})
    expect = _SCENARIOS[kind].expect
    groups: dict[str, dict[str, ClaimAnswer]] = {}
    for name, answer in stored.answers.items():
        label = stored.question.label(name)
        if not name.startswith(HELP) and (kind != "verdicts" or fnmatchcase(label, _PROPERTIES)):
            groups.setdefault(label if kind == "overlap" else name, {})[name] = answer  # parts of a pair
    if not groups:
        raise InputError(f"{path} has no claim of a template property: run prove with names such as P2")
    shown = [x for x in groups if _is_shown(groups[x].values(), expect)]
    left = tuple(
        f"{x}: {', '.join(dict.fromkeys(str(y.verdict) for y in groups[x].values()))}"
        for x in groups
        if x not in shown
    )
    labels = (stored.question.label(name) for x in shown for name in groups[x])
    properties = dict.fromkeys(re.split(r"[-\s]", label)[0] for label in labels)
    is_numbered = all(x.get("scenario") is not None for x in data.items("verdicts") if isinstance(x, dict))
    words = {
        "set": stored.question.basis.specification.set_name,
        "claims": _number(len(shown), "claim"),
        "properties": f"propert{'y' if len(properties) == 1 else 'ies'} {', '.join(properties)}",
        "drives": _number(len(shown), "scenario" if is_numbered else "formula"),
        "pairs": _number(len(shown), "pair"),
    }
    files = [name for x in shown for name, y in groups[x].items() if str(y.verdict) in expect]
    select = tuple(f"{x}.json" for x in files) if left else ()
    entries = len(files) if left or kind == "verdicts" else _count(stored)
    return EvidenceFolder(path, kind, words, entries=entries, select=select, left=left)


def _is_shown(answers: Iterable[ClaimAnswer], expect: Sequence[str]) -> bool:
    """Return whether answers to the parts of a question show it: a drive of one, or a proof of each."""
    verdicts = {str(x.verdict) for x in answers}
    return Verdict.WITNESSED in {*expect} & verdicts or verdicts <= {*expect}


def _folder_of_tests(path: str, data: Fields, count: int) -> EvidenceFolder:
    """Return the folder of a catalogue: the scenarios that its tests show, if all tests are as they claim."""
    every = (Fields(x, path).text("name") for x in data.items("targets"))
    names = [x for x in every if fnmatchcase(x, EVERY_SCENARIO)]
    missing = {*data.texts("not_tested")}
    tested = [x for x in names if x not in missing]
    left = [f"no test shows {x}" for x in names if x in missing]
    if faults := len(data.items("faults")):
        left.insert(0, f"{_number(faults, 'fault')} of tests that are not what they claim")
    words = {"set": data.text("set"), "targets": _number(len(tested), "scenario")}
    entries = count if tested and not faults else 0
    select = tuple(tested) if len(tested) < len(names) else ()
    return EvidenceFolder(path, "catalogue", words, entries=entries, select=select, left=tuple(left))


def _folder_of_plates(path: str, index: PreventableData) -> EvidenceFolder:
    """Return the folder of plates and lemmas. Raises ``InputError`` where no plate is of the model."""
    plates = [x for x in index.plates if x.model == _MODEL]
    if not plates:
        raise InputError(
            f"{path} has no plate of driver model {_MODEL}: run preventable with --model {_MODEL}"
        )
    quantities = MANOEUVRES[index.manoeuvre].quantities
    fixed: dict[str, list[str]] = {}
    for plate in plates:
        for name, value in plate.fixed.items():
            unit = quantities[name].unit
            text = f"{float(Fraction(value) / UNITS[unit][0]):g} {unit}"
            if text not in fixed.setdefault(name, []):
                fixed[name].append(text)
    values = "; ".join(
        f"{name} = {', '.join(x[:_MOST])}{', …' * (len(x) > _MOST)}" for name, x in fixed.items()
    )
    drives, count = sum(y.drive is not None for x in plates for y in x.shown), len(index.lemmas)
    words = {
        "manoeuvre": index.manoeuvre,
        "plates": f"{_number(len(plates), 'plate')}{f' at {values}' if values else ''}",
        "drives": _number(drives, "drive"),
        "boundary": "follows from the motion" if count else "is shown by drives, without a lemma,",
        "lemmas": f", and {_number(count, 'lemma')} about its formula" if count else "",
    }
    return EvidenceFolder(path, "preventable", words, count > 0, len(plates) + drives + count)


def _number(count: int, what: str) -> str:
    return f"{count} {what}{'s' * (count != 1)}"


def tables(folders: Sequence[EvidenceFolder]) -> Iterator[tuple[str, Table]]:
    """Yield the elements of the case by id; a branch without a folder is left out."""
    uses = {kind: use for branch in _BRANCHES for kind, use in branch.uses.items()}
    branches = {
        f"{k}": (branch, those)
        for k, branch in enumerate(_BRANCHES, 2)
        if (those := [x for kind in branch.uses for x in folders if x.kind == kind])
    }
    contexts = [x for x in _CONTEXTS if any(x in branch.contexts for branch, _ in branches.values())]
    goal = _sentence([branch.goal for branch, _ in branches.values()])
    yield "G1", {"goal": goal, "supported-by": ["S1"], "in-context-of": contexts}
    yield from ((x, _CONTEXTS[x]) for x in contexts)
    titles = [branch.title for branch, _ in branches.values()]
    yield "S1", {"strategy": f"Argument over {_listed(titles)}", "supported-by": [f"G{k}" for k in branches]}
    count = 0
    for number, (branch, those) in branches.items():
        inner: dict[str, Table] = {}
        goals: list[str] = []
        for x in those:
            if x.entries:
                count += 1
                goals.append(f"G{number}.{len(goals) + 1}")
                shown = uses[x.kind].goal.format(**x.words)
                inner[goals[-1]] = {"goal": shown, "supported-by": [f"Sn{count}"]}
                inner[f"Sn{count}"] = _solution(x, uses[x.kind])
            if x.left:
                goals.append(f"G{number}.{len(goals) + 1}")
                inner[goals[-1]] = {"goal": _left_text(x), "undeveloped": True}
        yield f"G{number}", {"goal": _sentence([branch.goal]), "supported-by": [f"S{number}"]}
        yield f"S{number}", {"strategy": branch.strategy, "supported-by": goals}
        yield from inner.items()


def _left_text(folder: EvidenceFolder) -> str:
    names = f"{'; '.join(folder.left[:_MOST])}{'; …' * (len(folder.left) > _MOST)}"
    return f"Still to be shown, of {folder.path}: {names}"


def _listed(parts: Sequence[str]) -> str:
    return " and ".join(filter(None, (", ".join(parts[:-1]), parts[-1])))


def _sentence(parts: Sequence[str]) -> str:
    """Return clauses as one sentence."""
    text = ", and ".join(parts)
    return text[:1].upper() + text[1:]


def _solution(folder: EvidenceFolder, use: _EvidenceUse) -> Table:
    select = folder.select or use.select
    names = {"select": (*select, *("lemma*",) * folder.lemmas)} if select else {}
    return {
        "solution": use.solution.format(**folder.words),
        "evidence": folder.path,
        "expect": (*use.expect, *("PROVED",) * folder.lemmas),
        **names,
        "entries": folder.entries,
    }


def as_toml(tables: Mapping[str, Table]) -> str:
    """Return a case as TOML; texts are quoted as in JSON, which TOML reads alike."""
    title = str(tables["S1"]["strategy"]).removeprefix("Argument over ")
    blocks = [f"title = {_value(title[:1].upper() + title[1:])}\n"]
    for name, table in tables.items():
        header = f'["{name}"]' if "." in name else f"[{name}]"
        blocks.append("\n".join([header, *(f"{key} = {_value(x)}" for key, x in table.items()), ""]))
    return "\n".join(blocks)


def _value(value: str | Sequence[str] | bool | int) -> str:
    if isinstance(value, tuple) and len(value) == 1:
        value = str(value[0])
    return json.dumps(value, ensure_ascii=False)

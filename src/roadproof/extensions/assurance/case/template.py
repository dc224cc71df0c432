"""Writes assurance cases from a template that is filled in with folders of evidence."""

import json
import os
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from fnmatch import fnmatchcase
from fractions import Fraction
from pathlib import Path

from roadproof.errors import InputError
from roadproof.evidence.codec import read
from roadproof.evidence.strict import Fields
from roadproof.extensions.drivers.manoeuvres import MANOEUVRES
from roadproof.extensions.drivers.preventable.data import PreventableData
from roadproof.library.scenarios import EVERY_SCENARIO
from roadproof.questions.checking import is_question, read_folder
from roadproof.questions.views import view_data
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
_BRANCHES: Sequence[tuple[str, str, Mapping[str, _EvidenceUse]]] = (
    (
        "The formal scenarios have the properties below",
        "Argument over the properties of the formal scenarios",
        _SCENARIOS,
    ),
    ("Tests show the formal scenarios below", "Argument over the review of the tests", _TESTS),
    (
        f"The collisions that driver model {_MODEL} prevents are known for the manoeuvres and values below",
        "Argument over the manoeuvres with evidence",
        _DRIVER,
    ),
)
_TOP = (
    "Tests show the formal traffic disturbance scenarios below, and the collisions that driver model "
    f"{_MODEL} prevents are known for the manoeuvres and values below"
)
_CONTEXTS: Mapping[str, Table] = {
    "C1": {"context": "The traffic disturbance scenarios of ISO 34502, formal in signal temporal logic"},
    "C2": {"context": "Danger: two vehicles are closer than their RSS distances for minDanger"},
    "A1": {"assumption": "The formal scenarios say what ISO 34502 means"},
    "A2": {"assumption": f"Driver model {_MODEL} drives as a competent and careful human driver does"},
}


def fill_template(name: str, evidence: Sequence[Path], home: Path) -> str:
    """Return the TOML text of a case for folders of evidence; the case will be in folder ``home``.

    Goals without evidence are undeveloped. Raises ``InputError`` for a folder that the template cannot use.
    """
    if name not in TEMPLATES:
        raise InputError(f"template={name!r}; there is {', '.join(TEMPLATES)}")
    folders = [_EvidenceFolder.read(x, home) for x in evidence]
    uses = {kind for _, _, uses in _BRANCHES for kind in uses}
    for x in folders:
        if x.kind not in uses:
            accepted = ", ".join("prove" if kind == "verdicts" else kind for kind in sorted(uses))
            raise InputError(f"{x.path} has answers of {x.kind}; template {name} takes those of {accepted}")
    return _as_toml("Test catalogue and careful driver", dict(_tables(folders)))


@dataclass(frozen=True)
class _EvidenceFolder:
    """A folder of evidence: the ``kind`` of its answers, and ``words`` that fill in the template.

    ``lemmas``: whether it has lemmas; ``entries``: the number of entries that the argument is about.
    """

    path: str
    kind: str
    words: Mapping[str, str]
    lemmas: bool = False
    entries: int | None = None

    @staticmethod
    def read(folder: Path, home: Path) -> "_EvidenceFolder":
        """Return what the template needs to know of a folder. Raises ``InputError`` for a folder without
        answers.
        """
        path = Path(os.path.relpath(folder, home)).as_posix()
        if not is_question(folder):
            raise InputError(f"{folder} has no answers: name a folder that a command has written with --out")
        stored = read_folder(folder)
        data = Fields(view_data(stored.question, stored.answers, Path()), str(folder))
        kind = [*data.text("schema").split("/"), ""][1]
        if kind == "preventable":
            return _folder_of_plates(path, read(PreventableData, data.content, str(folder)))
        return _folder_of_answer(path, kind, data, len(stored.files) + len([*stored.undecided]))


def _folder_of_answer(path: str, kind: str, data: Fields, entries: int) -> _EvidenceFolder:
    """Return the folder of an answer with the words for its goal; ``entries``: how many findings ``check``
    has for it.
    """
    match kind:
        case "coverage":
            return _EvidenceFolder(path, kind, {"set": data.text("set")}, entries=entries)
        case "verdicts":
            names = [Fields(x, path).text("property") for x in data.items("verdicts")]
            properties_named = [x for x in names if fnmatchcase(x, _PROPERTIES)]
            if not properties_named:
                raise InputError(
                    f"{path} has no claim of a template property: run prove with names such as P2"
                )
            listed = ", ".join(dict.fromkeys(properties_named))
            properties = f"propert{'y' if len({*properties_named}) == 1 else 'ies'} {listed}"
            words = {"properties": properties, "claims": _number(len(properties_named), "claim")}
            return _EvidenceFolder(path, kind, words, entries=len(properties_named))
        case "witness":
            numbers = [x.get("scenario") for x in data.items("verdicts") if isinstance(x, dict)]
            word = "scenario" if all(x is not None for x in numbers) else "formula"
            return _EvidenceFolder(path, kind, {"drives": _number(len(numbers), word)}, entries=entries)
        case "overlap":
            pairs = len(data.items("verdicts"))
            words = {"set": data.text("set"), "pairs": _number(pairs, "pair")}
            return _EvidenceFolder(path, kind, words, entries=entries)
        case "catalogue":
            names = [Fields(x, path).text("name") for x in data.items("targets")]
            count = sum(fnmatchcase(x, EVERY_SCENARIO) for x in names)
            words = {"set": data.text("set"), "targets": _number(count, "scenario")}
            return _EvidenceFolder(path, kind, words, entries=entries)
    return _EvidenceFolder(path, kind, {})


def _folder_of_plates(path: str, index: PreventableData) -> _EvidenceFolder:
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
    return _EvidenceFolder(path, "preventable", words, count > 0, len(plates) + drives + count)


def _number(count: int, what: str) -> str:
    return f"{count} {what}{'s' * (count != 1)}"


def _tables(folders: Sequence[_EvidenceFolder]) -> Iterator[tuple[str, Table]]:
    goals = [f"G{k}" for k in range(2, 2 + len(_BRANCHES))]
    yield "G1", {"goal": _TOP, "supported-by": ["S1"], "in-context-of": [*_CONTEXTS]}
    yield from _CONTEXTS.items()
    strategy = "Argument over scenarios, tests and driver"
    yield "S1", {"strategy": strategy, "supported-by": goals}
    count = 0
    for goal, (text, way, uses) in zip(goals, _BRANCHES, strict=True):
        matches = [(x, uses[x.kind]) for kind in uses for x in folders if x.kind == kind]
        if not matches:
            yield goal, {"goal": text, "undeveloped": True}
            continue
        inner = [f"{goal}.{k}" for k in range(1, 1 + len(matches))]
        yield goal, {"goal": text, "supported-by": [f"S{goal[1:]}"]}
        yield f"S{goal[1:]}", {"strategy": way, "supported-by": inner}
        for sub, (x, use) in zip(inner, matches, strict=True):
            count += 1
            yield sub, {"goal": use.goal.format(**x.words), "supported-by": [f"Sn{count}"]}
            yield f"Sn{count}", _solution(x, use)


def _solution(folder: _EvidenceFolder, use: _EvidenceUse) -> Table:
    select = {"select": (*use.select, *("lemma*",) * folder.lemmas)} if use.select else {}
    entries = {} if folder.entries is None else {"entries": folder.entries}
    return {
        "solution": use.solution.format(**folder.words),
        "evidence": folder.path,
        "expect": (*use.expect, *("PROVED",) * folder.lemmas),
        **select,
        **entries,
    }


def _as_toml(title: str, tables: Mapping[str, Table]) -> str:
    """Return tables as TOML; texts are quoted as in JSON, which TOML reads alike."""
    blocks = [f"title = {_value(title)}\n"]
    for name, table in tables.items():
        header = f'["{name}"]' if "." in name else f"[{name}]"
        blocks.append("\n".join([header, *(f"{key} = {_value(x)}" for key, x in table.items()), ""]))
    return "\n".join(blocks)


def _value(value: str | Sequence[str] | bool | int) -> str:
    if isinstance(value, tuple) and len(value) == 1:
        value = str(value[0])
    return json.dumps(value, ensure_ascii=False)

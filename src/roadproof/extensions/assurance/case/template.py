"""Cases from a template, filled in with folders of evidence."""

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
class _Use:
    """The use of a kind of evidence: the goal that it supports, and the solution."""

    goal: str
    solution: str
    expect: tuple[str, ...]
    select: tuple[str, ...] = ()


_SCENARIOS: Mapping[str, _Use] = {
    "coverage": _Use(
        "The scenarios of set {set} miss no danger between two vehicles that arises from safety",
        "Coverage of set {set}, proved for all time",
        ("COVERED",),
    ),
    "verdicts": _Use(
        "{claims} of template {properties} hold in the formal scenarios",
        "Proofs of the template properties",
        ("PROVED",),
        (_PROPERTIES,),
    ),
    "witness": _Use("{drives} can happen", "Judged drives of {drives}", ("WITNESSED",)),
    "overlap": _Use(
        "Of {pairs} of scenarios of set {set} it is known whether both can hold at once",
        "Overlaps of set {set}",
        ("WITNESSED", "IMPOSSIBLE"),
    ),
}
_TESTS: Mapping[str, _Use] = {
    "catalogue": _Use(
        "The tests show {targets} of set {set} and are what they claim",
        "Review of the test catalogue",
        ("COVERED",),
        (EVERY_SCENARIO,),
    )
}
_DRIVER: Mapping[str, _Use] = {
    "preventable": _Use(
        "The boundary of preventable collisions {boundary} in {manoeuvre}, {plates}",
        "{drives} on both sides of the boundary in {manoeuvre}{lemmas}",
        ("WITNESSED", "DERIVED"),
        (f"{_MODEL}*",),
    )
}
_BRANCHES: Sequence[tuple[str, str, Mapping[str, _Use]]] = (
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
_BESIDE: Mapping[str, Table] = {
    "C1": {"context": "The traffic disturbance scenarios of ISO 34502, formal in signal temporal logic"},
    "C2": {"context": "Danger: two vehicles are closer than their RSS distances for minDanger"},
    "A1": {"assumption": "The formal scenarios say what ISO 34502 means"},
    "A2": {"assumption": f"Driver model {_MODEL} drives as a competent and careful human driver does"},
}


def fill_template(name: str, evidence: Sequence[Path], home: Path) -> str:
    """The text of a case in ``home`` for folders of evidence.

    Goals without evidence are undeveloped. Raises ``InputError`` for a folder of which it has no use.
    """
    if name not in TEMPLATES:
        raise InputError(f"template={name!r}; there is {', '.join(TEMPLATES)}")
    found = [_Given.read(x, home) for x in evidence]
    uses = {kind for _, _, uses in _BRANCHES for kind in uses}
    for x in found:
        if x.kind not in uses:
            told = ", ".join("prove" if kind == "verdicts" else kind for kind in sorted(uses))
            raise InputError(f"{x.path} has answers of {x.kind}; template {name} takes those of {told}")
    return _as_toml("Test catalogue and careful driver", dict(_tables(found)))


@dataclass(frozen=True)
class _Given:
    """A folder of evidence: ``kind`` of its answers, and words that the template puts in.

    ``lemmas``: whether it has lemmas; ``entries``: how many entries the argument is about.
    """

    path: str
    kind: str
    words: Mapping[str, str]
    lemmas: bool = False
    entries: int | None = None

    @staticmethod
    def read(folder: Path, home: Path) -> "_Given":
        """What a folder has. Raises ``InputError`` where it has no answers."""
        path = Path(os.path.relpath(folder, home)).as_posix()
        if not is_question(folder):
            raise InputError(f"{folder} has no answers: name a folder that a command has written with --out")
        found = read_folder(folder)
        data = Fields(view_data(found.question, found.answers, Path()), str(folder))
        kind = [*data.text("schema").split("/"), ""][1]
        if kind == "preventable":
            return _of_plates(path, read(PreventableData, data.content, str(folder)))
        return _of_answer(path, kind, data, len(found.files) + len([*found.undecided]))


def _of_answer(path: str, kind: str, data: Fields, entries: int) -> _Given:
    """The parts of a whole answer, which its goal names; ``entries``: how many lines ``check`` has for it."""
    match kind:
        case "coverage":
            return _Given(path, kind, {"set": data.text("set")}, entries=entries)
        case "verdicts":
            names = [str(x["property"]) for x in data.items("verdicts") if isinstance(x, dict)]
            own = [x for x in names if fnmatchcase(x, _PROPERTIES)]
            if not own:
                raise InputError(
                    f"{path} has no claim of a template property: run prove with names such as P2"
                )
            told = ", ".join(dict.fromkeys(own))
            properties = f"propert{'y' if len({*own}) == 1 else 'ies'} {told}"
            words = {"properties": properties, "claims": _number(len(own), "claim")}
            return _Given(path, kind, words, entries=len(own))
        case "witness":
            numbers = [x.get("scenario") for x in data.items("verdicts") if isinstance(x, dict)]
            word = "scenario" if all(x is not None for x in numbers) else "formula"
            return _Given(path, kind, {"drives": _number(len(numbers), word)}, entries=entries)
        case "overlap":
            pairs = len(data.items("verdicts"))
            words = {"set": data.text("set"), "pairs": _number(pairs, "pair")}
            return _Given(path, kind, words, entries=entries)
        case "catalogue":
            names = [str(x["name"]) for x in data.items("targets") if isinstance(x, dict)]
            count = sum(fnmatchcase(x, EVERY_SCENARIO) for x in names)
            words = {"set": data.text("set"), "targets": _number(count, "scenario")}
            return _Given(path, kind, words, entries=entries)
    return _Given(path, kind, {})


def _of_plates(path: str, index: PreventableData) -> _Given:
    """The plates and lemmas of a folder. Raises ``InputError`` where none is of the model."""
    plates = [x for x in index.plates if x.model == _MODEL]
    if not plates:
        raise InputError(
            f"{path} has no plate of driver model {_MODEL}: run preventable with --model {_MODEL}"
        )
    known = MANOEUVRES[index.manoeuvre].quantities
    fixed: dict[str, list[str]] = {}
    for plate in plates:
        for name, value in plate.fixed.items():
            unit = known[name].unit
            told = f"{float(Fraction(value) / UNITS[unit][0]):g} {unit}"
            if told not in fixed.setdefault(name, []):
                fixed[name].append(told)
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
    return _Given(path, "preventable", words, count > 0, len(plates) + drives + count)


def _number(count: int, what: str) -> str:
    return f"{count} {what}{'s' * (count != 1)}"


def _tables(found: Sequence[_Given]) -> Iterator[tuple[str, Table]]:
    goals = [f"G{k}" for k in range(2, 2 + len(_BRANCHES))]
    yield "G1", {"goal": _TOP, "supported-by": ["S1"], "in-context-of": [*_BESIDE]}
    yield from _BESIDE.items()
    strategy = "Argument over scenarios, tests and driver"
    yield "S1", {"strategy": strategy, "supported-by": goals}
    count = 0
    for goal, (text, way, uses) in zip(goals, _BRANCHES, strict=True):
        given = [(x, uses[x.kind]) for kind in uses for x in found if x.kind == kind]
        if not given:
            yield goal, {"goal": text, "undeveloped": True}
            continue
        inner = [f"{goal}.{k}" for k in range(1, 1 + len(given))]
        yield goal, {"goal": text, "supported-by": [f"S{goal[1:]}"]}
        yield f"S{goal[1:]}", {"strategy": way, "supported-by": inner}
        for sub, (x, use) in zip(inner, given, strict=True):
            count += 1
            yield sub, {"goal": use.goal.format(**x.words), "supported-by": [f"Sn{count}"]}
            yield f"Sn{count}", _solution(x, use)


def _solution(given: _Given, use: _Use) -> Table:
    table: dict[str, str | Sequence[str] | bool | int] = {
        "solution": use.solution.format(**given.words),
        "evidence": given.path,
        "expect": (*use.expect, *("PROVED",) * given.lemmas),
    }
    if use.select:
        table["select"] = (*use.select, *("lemma*",) * given.lemmas)
    if given.entries is not None:
        table["entries"] = given.entries
    return table


def _as_toml(title: str, tables: Mapping[str, Table]) -> str:
    """Tables as TOML; texts are quoted as in JSON, which TOML reads alike."""
    blocks = [f"title = {_value(title)}\n"]
    for name, table in tables.items():
        header = f'["{name}"]' if "." in name else f"[{name}]"
        blocks.append("\n".join([header, *(f"{key} = {_value(x)}" for key, x in table.items()), ""]))
    return "\n".join(blocks)


def _value(value: str | Sequence[str] | bool | int) -> str:
    if isinstance(value, tuple) and len(value) == 1:
        value = str(value[0])
    return json.dumps(value, ensure_ascii=False)

"""Cases from a template, filled in with folders of evidence."""

import json
import os
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from roadproof.errors import InputError
from roadproof.evidence.folder import INDEX
from roadproof.evidence.journal import HEAD
from roadproof.evidence.strict import LARGEST_INDEX, Fields, read_json
from roadproof.library.scenarios import EVERY_SCENARIO

TEMPLATES = ("catalogue-coverage",)
Table = Mapping[str, str | Sequence[str] | bool]


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
    "index": _Use(
        "The formal scenarios have the properties that their names promise",
        "Proofs of the template properties",
        ("PROVED",),
        ("P*",),
    ),
    "witness": _Use("The scenarios can happen", "Judged drives of scenarios", ("WITNESSED",)),
    "overlap": _Use(
        "The pairs of scenarios that can hold at once are known",
        "Overlaps of set {set}",
        ("WITNESSED", "IMPOSSIBLE"),
    ),
}
_TESTS: Mapping[str, _Use] = {
    "catalogue": _Use(
        "The tests show every scenario and are what they claim",
        "Review of the test catalogue",
        ("COVERED",),
        (EVERY_SCENARIO,),
    )
}
_DRIVER: Mapping[str, _Use] = {
    "preventable": _Use(
        "The boundary of preventable collisions is exact for {manoeuvre}",
        "Plates and lemmas of {manoeuvre}",
        ("WITNESSED", "PROVED"),
        ("careful*", "lemma*"),
    )
}
_BRANCHES: Sequence[tuple[str, str, Mapping[str, _Use]]] = (
    (
        "The scenarios contain the reasonably foreseeable traffic disturbances",
        "Argument over the properties of the formal scenarios",
        _SCENARIOS,
    ),
    ("The catalogue tests the scenarios", "Argument over the review of the tests", _TESTS),
    (
        "A competent and careful driver prevents the preventable collisions",
        "Argument over manoeuvres",
        _DRIVER,
    ),
)
_TOP = (
    "The catalogue covers the reasonably foreseeable traffic disturbances of ISO 34502, and a competent and "
    "careful driver prevents the preventable collisions"
)
_BESIDE: Mapping[str, Table] = {
    "C1": {"context": "The traffic disturbance scenarios of ISO 34502, formal in signal temporal logic"},
    "C2": {"context": "Danger: two vehicles are closer than their RSS distances for minDanger"},
    "A1": {"assumption": "The formal scenarios say what ISO 34502 means"},
    "J1": {"justification": "A collision that is missed is missed by the scenarios, the tests or the driver"},
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
            told = ", ".join("prove" if kind == "index" else kind for kind in sorted(uses))
            raise InputError(f"{x.path} has answers of {x.kind}; template {name} takes those of {told}")
    return _as_toml("Test catalogue and careful driver", dict(_tables(found)))


@dataclass(frozen=True)
class _Given:
    """A folder of evidence: ``kind`` of its answers, and words that the template puts in."""

    path: str
    kind: str
    words: Mapping[str, str]

    @staticmethod
    def read(folder: Path, home: Path) -> "_Given":
        """What a folder has. Raises ``InputError`` where it has no answers."""
        for name, key in ((INDEX, "schema"), (HEAD, "of")):
            if (folder / name).is_file():
                data = Fields(read_json(folder / name, LARGEST_INDEX), str(folder / name))
                words: dict[str, str] = {
                    x: str(data.content[x]) for x in ("set", "manoeuvre") if x in data.content
                }
                kind = [*data.text(key).split("/"), ""][1]
                return _Given(Path(os.path.relpath(folder, home)).as_posix(), kind, words)
        raise InputError(f"{folder} has no answers: name a folder that a command has written with --out")


def _tables(found: Sequence[_Given]) -> Iterator[tuple[str, Table]]:
    goals = [f"G{k}" for k in range(2, 2 + len(_BRANCHES))]
    yield "G1", {"goal": _TOP, "supported-by": ["S1"], "in-context-of": ["C1", "C2", "A1"]}
    yield from _BESIDE.items()
    strategy = "Argument over scenarios, tests and driver"
    yield "S1", {"strategy": strategy, "supported-by": goals, "in-context-of": ["J1"]}
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
            solution = {"solution": use.solution.format(**x.words), "evidence": x.path, "expect": use.expect}
            yield f"Sn{count}", {**solution, **({"select": use.select} if use.select else {})}


def _as_toml(title: str, tables: Mapping[str, Table]) -> str:
    """Tables as TOML; texts are quoted as in JSON, which TOML reads alike."""
    blocks = [f"title = {_value(title)}\n"]
    for name, table in tables.items():
        header = f'["{name}"]' if "." in name else f"[{name}]"
        blocks.append("\n".join([header, *(f"{key} = {_value(x)}" for key, x in table.items()), ""]))
    return "\n".join(blocks)


def _value(value: str | Sequence[str] | bool) -> str:
    if isinstance(value, tuple) and len(value) == 1:
        value = str(value[0])
    return json.dumps(value, ensure_ascii=False)

"""Folders of evidence for tests, and what comes out where they are checked in this process."""

import json
import shutil
from collections.abc import Iterator
from copy import deepcopy
from functools import cache
from pathlib import Path
from typing import Any

from roadproof.engines.solve import smt
from roadproof.evidence.finding import Finding, exit_code
from roadproof.frontends.api.checking import check as check_all
from roadproof.questions.data import read_question
from roadproof.questions.question import QUESTION
from roadproof.runtime.budget import Effort
from roadproof.runtime.package_data import shipped_folder

# A template property, one more that is like it, the guarantee, a control with a drive and one with a trace.
CHOSEN = ("P1-scenario-04-base", "P2-base", "P9-base", "C4-scenario-04-base", "C5-base")


@cache
def answer(script: str) -> str:
    return smt.check_sat(script, meter=Effort(20).meter())


def check(*paths: Path, specs: tuple[Path, ...] = ()) -> list[Finding]:
    """The findings, as ``roadproof check`` prints them."""
    return list(check_all(*paths, specs=specs, jobs=1).findings)


def code(*paths: Path) -> int:
    return exit_code(check(*paths))


def some_proofs(folder: Path) -> Path:
    """A folder with the evidence of ``CHOSEN`` and the question that asks for it."""
    folder.mkdir(parents=True, exist_ok=True)
    question = json.loads((shipped_folder("proofs") / QUESTION).read_text("utf-8"))
    names = [x.name for x in read_question(shipped_folder("proofs")).tasks]
    claims = question["asked"]["claims"]
    question["asked"]["claims"] = [x for name, x in zip(names, claims, strict=True) if name in CHOSEN]
    for name in CHOSEN:
        shutil.copy(shipped_folder("proofs") / f"{name}.json", folder)
    write(folder / QUESTION, question)
    return folder


def read(path: Path) -> Any:
    return json.loads(path.read_text("utf-8"))


def write(path: Path, data: object) -> None:
    path.write_text(json.dumps(data), "utf-8")


Place = tuple[str | int, ...]


def places(data: Any, at: Place = ()) -> Iterator[Place]:
    """Where something can be changed: every field, and of every list the first entry and the last."""
    if at:
        yield at
    if isinstance(data, dict):
        for key in data:
            yield from places(data[key], (*at, key))
    elif isinstance(data, list) and data:
        for k in sorted({0, len(data) - 1}):
            yield from places(data[k], (*at, k))


def changes(data: Any, at: Place) -> Iterator[tuple[str, Any]]:
    """``data`` with the value at a place changed in several ways, each with a word for it."""
    *above, last = at
    value = data
    for key in at:
        value = value[key]
    others: dict[str, Any] = {
        "null": None,
        "a number": 7,
        "a truth value": True,
        "a list": [],
        "an object": {},
    }
    match value:
        case bool():
            others |= {
                "turned": not value,
                "a text for it": str(value).lower(),
                "a number for it": int(value),
            }
        case str():
            others |= {"empty": "", "longer": f"{value}1", "another text": "x", "arabic": "\u0663"}
            others |= {"NUL": f"{value}\x00", "half a character": "\ud800", "digits": "9" * 5000}
        case int():
            others |= {
                "one more": value + 1,
                "negative": -1,
                "a text for it": str(value),
                "broken": value + 0.5,
            }
        case list():
            others |= {"one less": value[1:], "twice": [*value, *value[:1]], "turned around": value[::-1]}
            others |= {"one strange more": [*value, {}]}
        case dict():
            others |= {"one more field": {**value, "more": "1"}, "one less": dict(list(value.items())[1:])}
    for word, other in others.items():
        if type(other) is not type(value) or other != value:
            changed = deepcopy(data)
            place = changed
            for key in above:
                place = place[key]
            place[last] = other
            yield word, changed
    changed = deepcopy(data)
    place = changed
    for key in above:
        place = place[key]
    del place[last]
    yield "removed", changed

"""What a link rests on, by name, and which of it is another than the lock file says.

A lock file says what every link rested on when it was accepted: the text of its requirement, its evidence,
definitions, parameters, vehicle models and the version of roadproof. A proof holds for every value of a
parameter and every vehicle, so it rests on how a parameter is declared, and not on its value; one that
assumes values or motion rests on them.
"""

import re
from collections.abc import Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, field, replace
from fractions import Fraction
from pathlib import Path
from typing import TypeAlias

from roadproof.errors import InputError
from roadproof.evidence.codec import read, write
from roadproof.evidence.strict import LARGEST_INDEX, JsonObject, read_json
from roadproof.extensions.assurance.answers.trace_lock import Lock, LockedLink
from roadproof.extensions.assurance.requirements.checked_evidence import CheckedEvidence
from roadproof.extensions.assurance.requirements.matching import Target
from roadproof.extensions.assurance.requirements.requirement import Link, Requirement
from roadproof.library.bind import default_values
from roadproof.library.elaborate import apply_definition
from roadproof.library.motion import split
from roadproof.library.scenarios import name_of
from roadproof.library.specification import Specification
from roadproof.library.uses import Used, used_in
from roadproof.logic.parse import parse_claim
from roadproof.logic.rewrite import without_names
from roadproof.runtime.canonical import digest
from roadproof.runtime.version import VERSION
from roadproof.world.vehicle import Vehicle

Parts: TypeAlias = dict[str, str]
"""Digests and values by name."""
_FILES = ("file ", "answer ")
_TOOL, _VALUE, _DRIVES = "roadproof", "value of ", ("scenario", "test", "driver", "plate")
_MEANING, _WHY = "meaning of ", ("definition ", "parameter ")
_NAME = re.compile(r"[A-Za-z_]\w*(?:@\w+)?")


@dataclass(frozen=True)
class Surroundings:
    """What evidence is compared with: the definitions and values in force, and vehicle models by vehicle.

    ``folder``: where the names of files begin.
    """

    home: Specification
    folder: Path
    values: Mapping[str, Fraction] = field(default_factory=dict)
    vehicles: Mapping[str, Vehicle] = field(default_factory=dict)


def parts_of(
    requirement: Requirement, target: Target, evidence: Sequence[CheckedEvidence], around: Surroundings
) -> Parts:
    """All that a link rests on, by name."""
    written = digest(requirement.title, requirement.text)[:16]
    parts = {_TOOL: VERSION, f"text of {requirement.id}": written}
    link = target.link
    if link.kind == "claim" or link.kind == "scenario":
        name = link.target.partition("@")[0]
        text = name_of(int(name)) if name.isdecimal() else link.target
        parts |= _of_text(target.specification, text, around, link.kind == "scenario")
    for x in evidence:
        assumes = x.meaning is not None and bool(x.meaning.assuming)
        parts |= _of_text(x.specification, x.finding.claim, around, x.is_drive or assumes)
        if link.kind == "driver":
            parts[f"driver verdicts of test {x.finding.name}"] = digest(x.finding.drivers)[:16]
        if x.digest:
            parts[f"file {_relative(x.path, around.folder)}"] = x.digest
        else:
            shown = digest(x.finding.verdict, x.finding.claim)[:16]
            parts[f"answer {x.finding.label} in {_relative(x.path, around.folder)}"] = shown
    if link.kind in _DRIVES or any(x.is_drive for x in evidence):
        parts |= dict(_models(evidence, target, around))
    return parts


def _of_text(specification: Specification, text: str, around: Surroundings, has_values: bool) -> Parts:
    """The meaning of a text, and the definitions and parameters that it is made of.

    ``has_values``: their values count, too.
    """
    beside = _beside(specification, around.home)
    parts: Parts = {}
    for title, used in _read(specification, text):
        parts[f"{_MEANING}{title}{beside}"] = digest(without_names(used.query.formula))[:16]
        parts |= dict(_named(used, specification, beside, around, has_values))
    return parts


def _read(specification: Specification, text: str) -> Iterator[tuple[str, Used]]:
    """A claim as it is elaborated; of another text, such as a label, each definition that it names."""
    try:
        claim = parse_claim(split(text)[1])
        yield " ".join(text.split()), used_in(specification, claim)
        return
    except InputError:
        names = dict.fromkeys(_NAME.findall(text))
    for name in names:
        home = specification.in_set(name.partition("@")[2] or specification.set_name)
        if name.partition("@")[0] in home.definitions:
            with suppress(InputError):
                query = apply_definition(home, name.partition("@")[0])
                yield name, used_in(home, query.claim)


def _beside(specification: Specification, home: Specification) -> str:
    """What tells definitions of another set, or in other readings, from those of the trace."""
    other = [f"{n}={v}" for n, v in specification.options.items() if home.options.get(n, v) != v]
    inside = "" if specification.set_name == home.set_name else f"@{specification.set_name}"
    return inside + (f" with {', '.join(other)}" if other else "")


def _named(
    used: Used, specification: Specification, beside: str, around: Surroundings, has_values: bool
) -> Iterator[tuple[str, str]]:
    for x in used.definitions:
        name = x.name if "@" in x.name else x.name + beside
        yield f"definition {name}", digest(replace(x, doc=""))[:16]
    values = default_values(specification.library) | dict(around.values)
    for p in used.parameters:
        yield f"parameter {p.name}", digest(replace(p, doc="", value=Fraction(0)))[:16]
        if has_values:
            yield f"{_VALUE}{p.name}", str(values[p.name])


def _models(
    evidence: Sequence[CheckedEvidence], target: Target, around: Surroundings
) -> Iterator[tuple[str, str]]:
    """The vehicle models of the vehicles in drives; of all where no drive is there."""
    seen = {name for x in evidence for name in x.vehicles} or set(around.vehicles)
    for name, model in around.vehicles.items():
        if name in seen:
            yield f"vehicle model of {name}", digest(model)[:16]


def _relative(path: Path, folder: Path) -> str:
    """A path as seen from the folder of the requirements, which says the same on every machine."""
    here, base = path.resolve(), folder.resolve()
    return here.relative_to(base).as_posix() if here.is_relative_to(base) else path.as_posix()


# --- the lock file -------------------------------------------------------------------------------


Key: TypeAlias = tuple[str, str, str]
"""Requirement, kind and target of a link."""


def key_of(requirement: Requirement, link: Link) -> Key:
    """Under which a lock file has a link."""
    return requirement.id, link.kind, link.target


def lock_path(file: Path) -> Path:
    """The lock file of a file, or a folder, of requirements."""
    return file.with_name(f"{file.stem}.lock.json")


def read_lock(path: Path) -> dict[Key, Parts] | None:
    """What each link rested on; None where there is no lock file. Raises ``InputError``."""
    if not path.exists():
        return None
    lock = read(Lock, read_json(path, LARGEST_INDEX), str(path))
    found: dict[Key, Parts] = {}
    for x in lock.links:
        missing = next((name for name in x.rests_on if name not in lock.parts), None)
        if missing is not None:
            raise InputError(
                f"{path}: {x.requirement} rests on '{missing}', which is not among the parts; "
                "accept the links again"
            )
        found[x.requirement, x.kind, x.target] = {name: lock.parts[name] for name in x.rests_on}
    return found


def lock_data(links: Mapping[Key, Parts]) -> JsonObject:
    """The content of a lock file."""
    parts = {name: value for x in links.values() for name, value in x.items()}
    return write(
        Lock(
            roadproof=VERSION,
            parts=dict(sorted(parts.items())),
            links=tuple(
                LockedLink(requirement=r, kind=kind, target=target, rests_on=tuple(sorted(x)))
                for (r, kind, target), x in links.items()
            ),
        )
    )


def differences(before: Parts, now: Parts) -> tuple[str, ...]:
    """What a link rested on and is another now, in words.

    What is new beside it changes nothing. A definition that nothing names any more is gone with the evidence,
    or with a change of the definition that named it. That a claim means something else is said where no
    change of a definition or parameter tells why.
    """
    changed = [
        name
        for name, value in before.items()
        if now.get(name) != value and (name in now or name.startswith(_FILES))
    ]
    why = [name for name in changed if name.startswith(_WHY)]
    return tuple(
        _difference(name, before[name], now.get(name))
        for name in changed
        if not (why and name.startswith(_MEANING))
    )


def _difference(name: str, before: str, now: str | None) -> str:
    if now is None:
        return f"{name} is gone"
    if name.startswith(_VALUE):
        return f"parameter {name.removeprefix(_VALUE)}: {before} -> {now}"
    return f"{name}: {before} -> {now}" if name == _TOOL else f"{name} changed"

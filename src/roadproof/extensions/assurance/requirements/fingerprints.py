"""Computes what a link rests on, part by part, and compares it with a lock file.

A lock file records what every link rested on when it was accepted: the text of its requirement, its evidence,
definitions, parameters, vehicle models and the version of roadproof. A proof holds for every value of a
parameter and every vehicle, so it rests on the declaration of a parameter, and not on its value. A proof that
assumes values or motion rests on them, too.
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
from roadproof.library.motion import split_claim
from roadproof.library.scenarios import name_of
from roadproof.library.specification import Specification
from roadproof.library.uses import PartsOfClaim, parts_of_claim
from roadproof.logic.parse import parse_claim
from roadproof.logic.rewrite import without_names
from roadproof.runtime.canonical import digest
from roadproof.runtime.version import VERSION
from roadproof.world.vehicle import Vehicle

Parts: TypeAlias = dict[str, str]
"""Digests and values by the name of the part."""
_FILES = ("file ", "answer ")
_TOOL, _VALUE, _DRIVES = "roadproof", "value of ", ("scenario", "test", "driver", "plate")
_MEANING, _WHY = "meaning of ", ("definition ", "parameter ")
_NAME = re.compile(r"[A-Za-z_]\w*(?:@\w+)?")


@dataclass(frozen=True)
class TraceContext:
    """The definitions, parameter values and vehicle models that evidence is compared with.

    ``folder``: the folder that relative file names start from. ``vehicles``: models by vehicle name.
    """

    home: Specification
    folder: Path
    values: Mapping[str, Fraction] = field(default_factory=dict)
    vehicles: Mapping[str, Vehicle] = field(default_factory=dict)


def parts_of(
    requirement: Requirement, target: Target, evidence: Sequence[CheckedEvidence], context: TraceContext
) -> Parts:
    """Return all parts that a link rests on, by name."""
    written = digest(requirement.title, requirement.text)[:16]
    parts = {_TOOL: VERSION, f"text of {requirement.id}": written}
    link = target.link
    if link.kind == "claim" or link.kind == "scenario":
        name = link.target.partition("@")[0]
        text = name_of(int(name)) if name.isdecimal() else link.target
        parts |= _parts_of_text(target.specification, text, context, link.kind == "scenario")
    for x in evidence:
        assumes = x.meaning is not None and bool(x.meaning.assuming)
        parts |= _parts_of_text(x.specification, x.finding.claim, context, x.is_drive or assumes)
        if link.kind == "driver":
            parts[f"driver verdicts of test {x.finding.name}"] = digest(x.finding.drivers)[:16]
        if x.digest:
            parts[f"file {_relative(x.path, context.folder)}"] = x.digest
        else:
            shown = digest(x.finding.verdict, x.finding.claim)[:16]
            parts[f"answer {x.finding.label} in {_relative(x.path, context.folder)}"] = shown
    if link.kind in _DRIVES or any(x.is_drive for x in evidence):
        parts |= dict(_vehicle_model_parts(evidence, target, context))
    return parts


def _parts_of_text(specification: Specification, text: str, context: TraceContext, has_values: bool) -> Parts:
    """Return the parts for a text: its meaning, and its definitions and parameters.

    ``has_values``: include the values of parameters.
    """
    suffix = _origin_suffix(specification, context.home)
    parts: Parts = {}
    for title, used in _elaborated(specification, text):
        parts[f"{_MEANING}{title}{suffix}"] = digest(without_names(used.query.formula))[:16]
        parts |= dict(_definition_parts(used, specification, suffix, context, has_values))
    return parts


def _elaborated(specification: Specification, text: str) -> Iterator[tuple[str, PartsOfClaim]]:
    """Yield the claim of a text as elaborated; for other texts, such as labels, each definition that it
    names.
    """
    try:
        claim = parse_claim(split_claim(text)[1])
        yield " ".join(text.split()), parts_of_claim(specification, claim)
        return
    except InputError:
        names = dict.fromkeys(_NAME.findall(text))
    for name in names:
        home = specification.in_set(name.partition("@")[2] or specification.set_name)
        if name.partition("@")[0] in home.definitions:
            with suppress(InputError):
                query = apply_definition(home, name.partition("@")[0])
                yield name, parts_of_claim(home, query.claim)


def _origin_suffix(specification: Specification, home: Specification) -> str:
    """Return the suffix of definition names from another set, or under other options, than the trace's."""
    options = [f"{n}={v}" for n, v in specification.options.items() if home.options.get(n, v) != v]
    set_suffix = "" if specification.set_name == home.set_name else f"@{specification.set_name}"
    return set_suffix + (f" with {', '.join(options)}" if options else "")


def _definition_parts(
    used: PartsOfClaim, specification: Specification, suffix: str, context: TraceContext, has_values: bool
) -> Iterator[tuple[str, str]]:
    for x in used.definitions:
        name = x.name if "@" in x.name else x.name + suffix
        yield f"definition {name}", digest(replace(x, doc=""))[:16]
    values = default_values(specification.library) | dict(context.values)
    for p in used.parameters:
        yield f"parameter {p.name}", digest(replace(p, doc="", value=Fraction(0)))[:16]
        if has_values:
            yield f"{_VALUE}{p.name}", str(values[p.name])


def _vehicle_model_parts(
    evidence: Sequence[CheckedEvidence], target: Target, context: TraceContext
) -> Iterator[tuple[str, str]]:
    """Yield the parts for the models of the vehicles in drives; for all models where there is no drive."""
    seen = {name for x in evidence for name in x.vehicles} or set(context.vehicles)
    for name, model in context.vehicles.items():
        if name in seen:
            yield f"vehicle model of {name}", digest(model)[:16]


def _relative(path: Path, folder: Path) -> str:
    """Return a path relative to the folder of the requirements, so that it is the same on every machine."""
    here, base = path.resolve(), folder.resolve()
    return here.relative_to(base).as_posix() if here.is_relative_to(base) else path.as_posix()


# --- the lock file -------------------------------------------------------------------------------


Key: TypeAlias = tuple[str, str, str]
"""The requirement, kind and target of a link."""


def key_of(requirement: Requirement, link: Link) -> Key:
    """Return the key of a link in a lock file."""
    return requirement.id, link.kind, link.target


def lock_path(file: Path) -> Path:
    """Return the lock file of a file, or a folder, of requirements."""
    return file.with_name(f"{file.stem}.lock.json")


def read_lock(path: Path) -> dict[Key, Parts] | None:
    """Return the parts that each link rested on, None where there is no lock file. Raises ``InputError``."""
    if not path.exists():
        return None
    lock = read(Lock, read_json(path, LARGEST_INDEX), str(path))
    links: dict[Key, Parts] = {}
    for x in lock.links:
        missing = next((name for name in x.rests_on if name not in lock.parts), None)
        if missing is not None:
            raise InputError(
                f"{path}: {x.requirement} rests on '{missing}', which is not among the parts; "
                "accept the links again"
            )
        links[x.requirement, x.kind, x.target] = {name: lock.parts[name] for name in x.rests_on}
    return links


def lock_data(links: Mapping[Key, Parts]) -> JsonObject:
    """Return the content of a lock file."""
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
    """Return texts for the parts that changed since a link was accepted.

    New parts change nothing. A definition that is no longer named has gone with its evidence, or with a
    change of the definition that named it. A changed meaning is reported only where no changed definition or
    parameter explains it.
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

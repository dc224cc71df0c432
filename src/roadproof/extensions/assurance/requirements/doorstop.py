"""Reads requirements of Doorstop: a folder with ``.doorstop.yml`` and one item in each other YAML file.

The name of a file is the UID of its item. Links to evidence are further attributes: claims, scenarios, tests,
drivers, plates and evidence, each a text or a list.
"""

from collections.abc import Mapping
from pathlib import Path

from roadproof.errors import InputError
from roadproof.extensions.assurance.answers.trace import RequirementPlace
from roadproof.extensions.assurance.requirements.requirement import Requirement, RequirementSet, with_fields
from roadproof.extensions.assurance.requirements.yaml_file import Item, Value, read_yaml

SETTINGS = ".doorstop.yml"


def read_doorstop(folder: Path) -> RequirementSet:
    """Return the active normative items of a folder and its subfolders. Raises ``InputError``."""
    homes = sorted(x.parent for x in folder.rglob(SETTINGS))
    if not homes:
        raise InputError(f"{folder}: there is no {SETTINGS} in it, so it is no folder of Doorstop")
    requirements: list[Requirement] = []
    notes: list[str] = []
    for path in (x for home in homes for x in sorted(home.glob("*.yml")) if x.name != SETTINGS):
        item = read_yaml(path)
        if _is_off(item, "active"):
            notes.append(f"{path}: the item is not active and is left out")
        elif _is_off(item, "normative"):
            notes.append(f"{path}: the item is not normative, such as a heading, and is left out")
        else:
            requirements.append(_requirement(path, item))
    return RequirementSet(folder, tuple(requirements), notes=tuple(notes))


def _is_off(item: Mapping[str, Value], name: str) -> bool:
    value = item.get(name)
    return isinstance(value, str) and value.lower() in ("false", "no", "off")  # as in YAML 1.1


def _requirement(path: Path, item: Mapping[str, Value]) -> Requirement:
    written = Requirement(
        path.stem,
        _text(item.get("text", "")),
        RequirementPlace(file=str(path)),
        _text(item.get("header", "")),
        tuple(x.text for x in _listed(item.get("links", ()))),
    )
    fields = {name: "\n".join(map(_written, _listed(value))) for name, value in item.items()}
    return with_fields(written, fields)


def _text(value: Value) -> str:
    return value if isinstance(value, str) else "\n".join(map(_written, value))


def _listed(value: Value) -> tuple[Item, ...]:
    if isinstance(value, str):
        return (Item(value),) if value else ()
    return value


def _written(item: Item) -> str:
    return item.text if item.value is None else f"{item.text}: {item.value}"

"""``roadproof list``: what the library holds."""

import argparse
import re
from collections.abc import Iterable
from fractions import Fraction
from itertools import groupby
from typing import Any

from roadproof.cli.options import (
    add_json_option,
    add_specification_options,
    load_library_of,
    select_specification,
    write_json,
)
from roadproof.logic.show import decimal
from roadproof.spec.elaborate import signature
from roadproof.spec.library import Specification
from roadproof.verdict import ExitCode

SUMMARY = "list scenarios, definitions, spec sets, options and parameters"
SCHEMA = "roadproof/list/1"

_EXAMPLES = """\
examples:
  roadproof list
  roadproof list --set ext --json -
  roadproof list --spec mine.spec
"""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.epilog = _EXAMPLES
    add_specification_options(parser)
    add_json_option(parser)


def run(args: argparse.Namespace) -> int:
    specification = select_specification(args, load_library_of(args))
    inventory = take_inventory(specification)
    if args.json:
        write_json(inventory, args.json)
    if args.json != "-":
        print(_as_text(inventory))
    return ExitCode.AS_EXPECTED


def take_inventory(specification: Specification) -> dict[str, Any]:
    """What there is to talk about under one spec set and choice of options, as plain data."""
    library = specification.library
    scenarios = [name for name in specification.definitions if re.fullmatch(r"scenario_\d+", name)]
    others = [d for name, d in specification.definitions.items() if name not in scenarios]
    return {
        "schema": SCHEMA,
        "set": specification.set_name,
        "scenarios": [
            {
                "name": name,
                "arguments": list(signature(specification, name)),
                "doc": specification.describe(specification.definitions[name]),
            }
            for name in scenarios
        ],
        "definitions": [
            {
                "name": definition.name,
                "parameters": [{"name": b.name, "sort": b.sort} for b in definition.parameters],
                "doc": specification.describe(definition),
            }
            for definition in others
        ],
        "sets": [{"name": s.name, "extends": s.parent, "doc": s.doc} for s in library.sets.values()],
        "options": [
            {"name": o.name, "values": list(o.values), "chosen": specification.options[o.name], "doc": o.doc}
            for o in library.options.values()
        ],
        "parameters": [
            {"name": p.name, "value": str(p.value), "unit": p.unit, "bound": p.bound, "doc": p.doc}
            for p in library.parameters.values()
        ],
    }


def _as_text(inventory: dict[str, Any]) -> str:
    scenarios = [(f"{s['name']}({', '.join(s['arguments'])})", s["doc"]) for s in inventory["scenarios"]]
    sets = [(_extends(s), s["doc"]) for s in inventory["sets"]]
    options = [(f"{o['name']} = {' | '.join(o['values'])}", o["doc"]) for o in inventory["options"]]
    parameters = [(_value(p), p["doc"]) for p in inventory["parameters"]]
    return "\n\n".join(
        [
            _block(f"Scenarios (set {inventory['set']})", scenarios),
            _block("Definitions", _definitions(inventory["definitions"])),
            _block("Spec sets", sets),
            _block("Options (the first value is the default)", options),
            _block("Parameters", parameters),
        ]
    )


def _definitions(definitions: Iterable[dict[str, Any]]) -> list[tuple[str, str]]:
    """One row a definition; those that differ in a number at the end only share a row."""
    families: dict[str, list[dict[str, Any]]] = {}
    for definition in definitions:
        stem, _, index = definition["name"].rpartition("_")
        families.setdefault(f"{stem}_i" if index.isdigit() else definition["name"], []).append(definition)
    rows: list[tuple[str, str]] = []
    for family, members in families.items():
        if len(members) < 3:
            rows += [(f"{m['name']}({_parameters(m)})", m["doc"]) for m in members]
        else:
            indices = sorted(int(m["name"].rpartition("_")[2]) for m in members)
            last = members[-1]["doc"] if len({m["doc"] for m in members}) == 1 else "parts of the template"
            rows.append((family, f"{last}, i = {indices[0]}..{indices[-1]}"))
    return rows


def _parameters(definition: dict[str, Any]) -> str:
    groups = groupby(definition["parameters"], key=lambda parameter: parameter["sort"])
    return ", ".join(f"{', '.join(p['name'] for p in group)}: {sort}" for sort, group in groups)


def _extends(spec_set: dict[str, Any]) -> str:
    parent = spec_set["extends"]
    return f"{spec_set['name']} extends {parent}" if parent else str(spec_set["name"])


def _value(parameter: dict[str, Any]) -> str:
    value = Fraction(parameter["value"])
    sign = "-" if value < 0 else ""
    return f"{parameter['name']} = {sign}{decimal(abs(value))} {parameter['unit']}"


def _block(title: str, rows: Iterable[tuple[str, str]]) -> str:
    """A title and two columns."""
    known = list(rows)
    width = max((len(left) for left, _ in known), default=0)
    return "\n".join([title, *(f"  {left:<{width}}  {right}".rstrip() for left, right in known)])

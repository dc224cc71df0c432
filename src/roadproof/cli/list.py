"""``roadproof list``: what the library holds."""

import argparse
import re
from collections.abc import Iterable
from typing import Any

from roadproof.cli.options import (
    add_json_option,
    add_specification_options,
    load_library_of,
    select_specification,
    write_json,
)
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
    if args.json != "-":
        print(_as_text(inventory))
    if args.json:
        write_json(inventory, args.json)
    return ExitCode.AS_EXPECTED


def take_inventory(specification: Specification) -> dict[str, Any]:
    """What there is to talk about under one spec set and choice of options, as plain data."""
    library = specification.library
    scenarios = [name for name in specification.definitions if re.fullmatch(r"scenario_\d+", name)]
    return {
        "schema": SCHEMA,
        "set": specification.set_name,
        "scenarios": [
            {
                "name": name,
                "arguments": list(signature(specification, name)),
                "doc": specification.definitions[name].doc,
            }
            for name in scenarios
        ],
        "definitions": [
            {
                "name": name,
                "parameters": [{"name": b.name, "sort": b.sort} for b in definition.parameters],
                "doc": definition.doc,
            }
            for name, definition in specification.definitions.items()
            if name not in scenarios
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
    definitions = [(f"{d['name']}({_parameters(d)})", d["doc"]) for d in inventory["definitions"]]
    sets = [
        (s["name"] + (f" extends {s['extends']}" if s["extends"] else ""), s["doc"])
        for s in inventory["sets"]
    ]
    options = [(f"{o['name']} = {' | '.join(o['values'])}", o["doc"]) for o in inventory["options"]]
    parameters = [(f"{p['name']} = {p['value']} {p['unit']}", p["doc"]) for p in inventory["parameters"]]
    return "\n\n".join(
        [
            _block(f"Scenarios (set {inventory['set']})", scenarios),
            _block("Definitions", definitions),
            _block("Spec sets", sets),
            _block("Options (the first value is the default)", options),
            _block("Parameters", parameters),
        ]
    )


def _parameters(definition: dict[str, Any]) -> str:
    return ", ".join(f"{p['name']}: {p['sort']}" for p in definition["parameters"])


def _block(title: str, rows: Iterable[tuple[str, str]]) -> str:
    """A title and two columns; nothing trails a row without a second one."""
    known = list(rows)
    width = min(46, max((len(left) for left, _ in known), default=0))
    return "\n".join([title, *(f"  {left:<{width}}  {right}".rstrip() for left, right in known)])

"""``roadproof list``: what the library holds."""

import argparse
from collections.abc import Iterable, Iterator
from itertools import groupby
from typing import TYPE_CHECKING

from roadproof.frontends.cli.basis import read_definitions
from roadproof.frontends.cli.options import write_json
from roadproof.frontends.settings.commands import List
from roadproof.library.elaborate import signatures
from roadproof.library.scenarios import number_in
from roadproof.library.specification import Specification
from roadproof.library.words import words_of
from roadproof.logic.show import decimal
from roadproof.logic.syntax import Definition, ParameterDeclaration, SetBlock
from roadproof.verdict import ExitCode

if TYPE_CHECKING:
    from roadproof.evidence.strict import JsonObject

SUMMARY = "list scenarios, definitions, spec sets, options and parameters"

EXAMPLES = """\
examples:
  roadproof list
  roadproof list --set ext --json -
  roadproof list --spec mine.spec
"""
OPTIONS = List


def run(args: argparse.Namespace) -> int:
    """Run the command; return its exit code."""
    specification = read_definitions(args, List).specification
    if args.json:
        write_json(take_inventory(specification), args.json)
    if args.json != "-":
        print(_as_text(specification))
    return ExitCode.AS_EXPECTED


def take_inventory(specification: Specification) -> "JsonObject":
    """Return the names of one spec set and choice of options, as plain data."""
    from roadproof.evidence.answers import library as library_data
    from roadproof.evidence.answers.shared import BindingData
    from roadproof.evidence.codec import write
    from roadproof.evidence.heading import heading

    library = specification.library
    scenarios = [name for name in specification.definitions if number_in(name) is not None]
    others = [d for name, d in specification.definitions.items() if name not in scenarios]
    answer = library_data.LibraryData(
        **heading(library_data.SCHEMA, library),
        set=specification.set_name,
        scenarios=tuple(
            library_data.ScenarioData(
                name=name,
                arguments=tuple(roles),
                doc=specification.describe(specification.definitions[name]),
                words=words_of(specification, number_in(name) or 0),
            )
            for name, roles in signatures(specification, scenarios).items()
        ),
        definitions=tuple(
            library_data.DefinitionData(
                name=definition.name,
                parameters=tuple(BindingData(name=b.name, sort=b.sort) for b in definition.parameters),
                doc=specification.describe(definition),
            )
            for definition in others
        ),
        sets=tuple(
            library_data.SpecificationSetData(name=s.name, extends=s.parent, doc=s.doc)
            for s in library.sets.values()
        ),
        options=tuple(
            library_data.OptionData(
                name=o.name, values=o.values, chosen=specification.options[o.name], doc=o.doc
            )
            for o in library.options.values()
        ),
        parameters=tuple(
            library_data.ParameterData(name=p.name, value=str(p.value), unit=p.unit, bound=p.bound, doc=p.doc)
            for p in library.parameters.values()
        ),
    )
    return write(answer)


def _as_text(specification: Specification) -> str:
    library = specification.library
    others = [d for name, d in specification.definitions.items() if number_in(name) is None]
    options = [(f"{o.name} = {' | '.join(o.values)}", o.doc) for o in library.options.values()]
    return "\n\n".join(
        [
            _block(f"Scenarios (set {specification.set_name})", _scenarios(specification)),
            _block("Definitions", _definitions(others, specification)),
            _block("Spec sets", [(_extends(s), s.doc) for s in library.sets.values()]),
            _block("Options (the first value is the default)", options),
            _block("Parameters", [(value_of(p), p.doc) for p in library.parameters.values()]),
        ]
    )


def _scenarios(specification: Specification) -> Iterator[tuple[str, str]]:
    """One row a scenario, below the road sector where it happens."""
    numbers = ((name, number_in(name)) for name in specification.definitions)
    words = {name: words_of(specification, number) for name, number in numbers if number is not None}
    roles = signatures(specification, words)
    for where, group in groupby(words.items(), key=lambda item: item[1].sector):
        yield from [(where, "")] if where else []
        for name, one in group:
            does = ", ".join(filter(None, (one.sv, one.pov)))
            texts = dict.fromkeys(filter(None, (one.title, does)))
            yield f"{'  ' if where else ''}{name}({', '.join(roles[name])})", ": ".join(texts)


def _definitions(definitions: Iterable[Definition], specification: Specification) -> list[tuple[str, str]]:
    """One row a definition; those that differ in a number at the end only share a row."""
    families: dict[str, list[Definition]] = {}
    for definition in definitions:
        stem, _, index = definition.name.rpartition("_")
        families.setdefault(f"{stem}_i" if index.isdigit() else definition.name, []).append(definition)
    rows: list[tuple[str, str]] = []
    for family, members in families.items():
        docs = [specification.describe(m) for m in members]
        if len(members) < 3:
            rows += [(f"{m.name}({_parameters(m)})", doc) for m, doc in zip(members, docs, strict=True)]
        else:
            indices = sorted(int(m.name.rpartition("_")[2]) for m in members)
            last = docs[-1] if len({*docs}) == 1 else "parts of the template"
            rows.append((family, f"{last}, i = {indices[0]}..{indices[-1]}"))
    return rows


def _parameters(definition: Definition) -> str:
    groups = groupby(definition.parameters, key=lambda parameter: parameter.sort)
    return ", ".join(f"{', '.join(p.name for p in group)}: {sort}" for sort, group in groups)


def _extends(spec_set: SetBlock) -> str:
    return f"{spec_set.name} extends {spec_set.parent}" if spec_set.parent else spec_set.name


def value_of(parameter: ParameterDeclaration) -> str:
    """A parameter with its value and unit."""
    sign = "-" if parameter.value < 0 else ""
    return f"{parameter.name} = {sign}{decimal(abs(parameter.value))} {parameter.unit}"


def _block(title: str, rows: Iterable[tuple[str, str]]) -> str:
    """A title and two columns."""
    known = list(rows)
    width = max((len(left) for left, _ in known), default=0)
    return "\n".join([title, *(f"  {left:<{width}}  {right}".rstrip() for left, right in known)])

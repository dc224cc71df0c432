"""Classes as a specification file, and the claims that they are exclusive and cover the scenarios."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import combinations
from textwrap import wrap
from typing import Literal

from roadproof.analysis.classify.cells import Cell, text_of
from roadproof.analysis.classify.classes import SET_NAME, Classes, Group, name_of, what_axis, where_axis
from roadproof.errors import InputError
from roadproof.spec.library import Library, Source, Specification, build_library

WIDTH = 110
FILE_NAME = "classes.spec"


@dataclass(frozen=True)
class Claim:
    """A claim about the classes, to be read with their text; ``name`` is fit for a file."""

    name: str
    kind: Literal["exclusive", "covers", "empty"]
    text: str


def write_classes(classes: Classes, specification: Specification, below: Sequence[str] = ()) -> str:
    """The text of a specification file; its definitions are new, and are to be read with set ``classes``.

    ``below``: names of the specification files that it needs under it. Raises ``InputError`` where the
    library has one of the names already.
    """
    made = list(_definitions(classes, specification))
    for name, _ in made:
        if name in specification.definitions:
            raise InputError(
                f"there is a definition '{name}' already: rename it to have classes of that name"
            )
    base = specification.set_name
    lines = [
        *_head(classes, specification, below),
        "",
        f'set {SET_NAME} extends {base} "classes of {base}" {{}}',
        "",
    ]
    return "\n".join([*lines, *(text for _, text in made)]) + "\n"


def with_classes(text: str, specification: Specification) -> Specification:
    """The set of the classes, under the options of ``specification``."""
    library: Library = build_library([Source(FILE_NAME, text)], specification.library)
    return library.select(SET_NAME, specification.options)


def _head(classes: Classes, specification: Specification, below: Sequence[str]) -> Iterator[str]:
    files = " ".join(f"--spec {name}" for name in (*below, FILE_NAME))
    options = "".join(
        f" --option {name}={value}"
        for name, value in specification.options.items()
        if value != specification.library.options[name].values[0]
    )
    numbers = sorted(number for group in classes.plan.groups for number in group.rows)
    told = [
        f"{len(classes.all())} classes of scenarios {ranges(numbers)} of set {specification.set_name}.",
        f"Read with {files} --set {SET_NAME}{options}; in other sets the names mean other things.",
        "A class says of one trace, its vehicles and a lane L which of these scenarios hold, and that no "
        "others between the same vehicles do. Classes of the same vehicles exclude each other, and a "
        "scenario is the union of its classes.",
    ]
    if classes.plan.has_places:
        told.append(
            "A class is something that happens, and where. Any two of the definitions what_ of the same "
            "vehicles exclude each other, and so do any two of where_."
        )
    for group in classes.plan.groups[1:]:
        told.append(
            f"Classes of {', '.join(group.vehicles)} are apart: they exclude each other, and say nothing of "
            "the pairs among these vehicles, each of which is in a class of pairs or in none."
        )
    for paragraph in told:
        yield from wrap(paragraph, WIDTH, initial_indent="# ", subsequent_indent="#   ")


def ranges(numbers: Sequence[int]) -> str:
    """``1-8, 12`` for 1 to 8 and 12."""
    runs: list[list[int]] = []
    for number in numbers:
        if runs and runs[-1][-1] == number - 1:
            runs[-1].append(number)
        else:
            runs.append([number])
    return ", ".join(f"{run[0]}-{run[-1]}" if len(run) > 1 else str(run[0]) for run in runs)


def _definitions(classes: Classes, specification: Specification) -> Iterator[tuple[str, str]]:
    plan = classes.plan
    prefix = "what" if plan.has_places else "class"
    for group, cells in zip(plan.groups, classes.what, strict=True):
        axis = what_axis(plan, group, specification)
        for cell in cells:
            doc = f"exactly {_listed(cell.holds)}: {_happening(specification, cell)}"
            yield _definition(name_of(prefix, cell), _head_of(group), doc, text_of(axis, cell))
    if not plan.has_places:
        return
    axis = where_axis(plan, ("SV", "POV"))
    for place in classes.where:
        doc = _listed([_doc(specification, f"roadSector_{n}") or str(n) for n in place.holds]) + " only"
        yield _definition(
            f"where_{classes.place(place)}", "SV: vehicle, POV: vehicles", doc, text_of(axis, place)
        )
    for group in plan.groups:
        for one in classes.of(group):
            assert one.where is not None
            what, where = name_of("what", one.what), f"where_{classes.place(one.where)}"
            body = f"{what}{group.arguments} and {where}({', '.join(group.vehicles)})"
            doc = f"exactly scenario{'s' * (len(one.scenarios) > 1)} {_listed(one.scenarios)}"
            yield _definition(one.name, _head_of(group), doc, body)


def _definition(name: str, parameters: str, doc: str, body: str) -> tuple[str, str]:
    head = f'def {name}({parameters}) "{doc}"'
    line = f"{head} := {body}"
    return name, line if len(line) <= WIDTH else f"{head}\n  := {body}"


def _head_of(group: Group) -> str:
    return f"{', '.join(group.vehicles)}: vehicle, L: lane"


def _listed(items: Sequence[object]) -> str:
    *most, last = map(str, items)
    return f"{', '.join(most)} and {last}" if most else last


def describe(specification: Specification, number: int) -> str:
    """What happens in a scenario, in the words of its parts."""
    docs = [_doc(specification, f"{kind}_{number}") for kind in ("behaviourSV", "behaviourPOV")]
    return ", ".join(filter(None, docs)) or _doc(specification, f"scenario_{number}") or f"scenario {number}"


def _happening(specification: Specification, cell: Cell) -> str:
    return "; ".join(describe(specification, number) for number in cell.holds)


def _doc(specification: Specification, name: str) -> str:
    definition = specification.definitions.get(name)
    return "" if definition is None else specification.describe(definition)


def claims_of(classes: Classes, empty: Mapping[tuple[str, ...], Sequence[str]]) -> list[Claim]:
    """All that is claimed of the classes; ``empty``: claims about cells left out, by vehicles of the group.

    Exclusive: any two classes; where there are several road sectors, any two cells of what happens, and any
    two of where. Covers: a scenario holds exactly where one of its classes does; where there are several road
    sectors, where one of its cells of what happens and one of its cells of where do. A class is by definition
    one of each, so this says the same of the classes.
    """
    claims: list[Claim] = []
    for group, cells in zip(classes.plan.groups, classes.what, strict=True):
        claims += _claims_of(classes, group, cells)
        count = len(group.vehicles)
        for number, text in enumerate(empty.get(group.vehicles, ()), 1):
            claims.append(Claim(f"empty-{count}-vehicles-{number}", "empty", text))
    return claims


def _claims_of(classes: Classes, group: Group, cells: Sequence[Cell]) -> Iterator[Claim]:
    prefix = "what" if classes.plan.has_places else "class"
    yield from _exclusive([name_of(prefix, cell) for cell in cells], group.arguments, "")
    if not classes.plan.has_places:
        for number in group.rows:
            those = _either([one.formula for one in classes.of(group) if number in one.scenarios])
            text = f"scenario_{number}{group.arguments} <-> {those}"
            yield Claim(f"covers-scenario-{number:02}", "covers", text)
        return
    vehicles = f"({', '.join(group.vehicles)})"
    where = {cell: f"where_{classes.place(cell)}" for cell in classes.where}
    yield from _exclusive(list(where.values()), vehicles, f"-{len(group.vehicles)}-vehicles")
    for number, (disturbance, sector) in group.rows.items():
        scenario = f"scenario_{number}{group.arguments}"
        happens = [name_of("what", cell) for cell in cells if disturbance in cell.holds]
        one_of = _either([f"{name}{group.arguments}" for name in happens])
        there = _either([f"{name}{vehicles}" for cell, name in where.items() if sector in cell.holds])
        # As three implications: the prover takes them one by one, which is quicker than an equivalence.
        text = (
            f"({scenario} -> {one_of}) and ({scenario} -> {there}) and ({one_of} and {there} -> {scenario})"
        )
        yield Claim(f"covers-scenario-{number:02}", "covers", text)


def _either(formulas: Sequence[str]) -> str:
    return f"({' or '.join(formulas)})" if formulas else "false"


def _exclusive(names: Sequence[str], arguments: str, mark: str) -> Iterator[Claim]:
    for a, b in combinations(names, 2):
        yield Claim(f"exclusive-{a}-{b}{mark}", "exclusive", f"not ({a}{arguments} and {b}{arguments})")

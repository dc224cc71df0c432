"""Classes as a specification file, and the claims that they are exclusive and cover the scenarios."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import combinations
from textwrap import wrap

from roadproof.errors import InputError
from roadproof.evidence.specifications import specification_names
from roadproof.extensions.surveys.classify.cells import Cell, query_of
from roadproof.extensions.surveys.classify.classes import (
    FILE_NAME,
    SET_NAME,
    Classes,
    ScenarioGroup,
    what_axis,
    where_axis,
)
from roadproof.extensions.surveys.classify.data import Kind
from roadproof.library.elaborate import read_claim
from roadproof.library.loading import build_library
from roadproof.library.scenarios import name_of
from roadproof.library.specification import Query, Source, Specification
from roadproof.library.words import spans

WIDTH = 110

HEADINGS: Mapping[Kind, str] = {
    "exclusive": "any two classes exclude each other",
    "covers": "each scenario is the union of its classes",
    "empty": "combinations of scenarios that do not occur",
}


@dataclass(frozen=True)
class ClassClaim:
    """A claim about the classes; ``name`` is fit for a file."""

    name: str
    kind: Kind
    query: Query


def write_classes(classes: Classes, specification: Specification) -> str:
    """Return the text of a specification file that defines the classes in the set ``classes``.

    Raises ``InputError`` where the library has one of the names already.
    """
    made = list(_definitions(classes, specification))
    for name, _ in made:
        if name in specification.definitions:
            raise InputError(
                f"there is a definition '{name}' already: rename it to have classes of that name"
            )
    base = specification.set_name
    lines = [
        *_head(classes, specification),
        "",
        f'set {SET_NAME} extends {base} "classes of {base}" {{}}',
        "",
    ]
    return "\n".join([*lines, *(text for _, text in made)]) + "\n"


def with_classes(text: str, specification: Specification) -> Specification:
    """Return the set of the classes, whose text becomes a file of the library, with the same options."""
    source = Source(FILE_NAME, text)
    library = build_library([source], specification.library)
    library = replace(library, files=(*specification.library.files, source))
    return library.select(SET_NAME, specification.options)


def _head(classes: Classes, specification: Specification) -> Iterator[str]:
    below = specification_names(specification.library)
    files = " ".join(f"--spec {name}" for name in (*below, FILE_NAME))
    options = "".join(
        f" --option {name}={value}"
        for name, value in specification.options.items()
        if value != specification.library.options[name].values[0]
    )
    plan = classes.plan
    paragraphs = [
        f"{len(classes.all())} classes of scenarios {spans(plan.numbers, least=2)} of set {plan.set_name}.",
        f"Read with {files} --set {SET_NAME}{options}; in other sets the names mean other things.",
        "A class says of one trace, its vehicles and a lane L which of these scenarios hold, and that no "
        "others between the same vehicles do. Classes of the same vehicles exclude each other, and a "
        "scenario is the union of its classes.",
    ]
    if plan.has_places:
        paragraphs.append(
            "A class is something that happens, and where. Any two of the definitions what_ of the same "
            "vehicles exclude each other, and so do any two of where_."
        )
    for group in plan.groups[1:]:
        paragraphs.append(
            f"Classes of {', '.join(group.vehicles)} are apart: they exclude each other, and say nothing of "
            "the pairs among these vehicles, each of which is in a class of pairs or in none."
        )
    for paragraph in paragraphs:
        yield from wrap(paragraph, WIDTH, initial_indent="# ", subsequent_indent="#   ")


def _definitions(classes: Classes, specification: Specification) -> Iterator[tuple[str, str]]:
    plan = classes.plan
    for group, cells in zip(plan.groups, classes.what, strict=True):
        axis = what_axis(plan, group, specification)
        for cell in cells:
            happening = "; ".join(plan.happenings[number] for number in cell.holds)
            doc = f"exactly {_listed(cell.holds)}: {happening}"
            yield _definition(plan.what(cell.holds), _head_of(group), doc, query_of(axis, cell).text)
    if not plan.has_places:
        return
    axis = where_axis(plan, specification)
    for place in classes.where:
        doc = _listed([plan.places[n] or str(n) for n in place.holds]) + " only"
        head = "SV: vehicle, POV: vehicles"
        yield _definition(plan.where(place.holds), head, doc, query_of(axis, place).text)
    for group in plan.groups:
        for one in classes.of(group):
            assert one.where is not None
            what, where = plan.what(one.what.holds), plan.where(one.where.holds)
            body = f"{what}{group.arguments} and {where}({', '.join(group.vehicles)})"
            doc = f"exactly scenario{'s' * (len(one.scenarios) > 1)} {_listed(one.scenarios)}"
            yield _definition(one.name, _head_of(group), doc, body)


def _definition(name: str, parameters: str, doc: str, body: str) -> tuple[str, str]:
    head = f'def {name}({parameters}) "{doc}"'
    line = f"{head} := {body}"
    return name, line if len(line) <= WIDTH else f"{head}\n  := {body}"


def _head_of(group: ScenarioGroup) -> str:
    return f"{', '.join(group.vehicles)}: vehicle, L: lane"


def _listed(items: Sequence[object]) -> str:
    *most, last = map(str, items)
    return f"{', '.join(most)} and {last}" if most else last


# --- claims -------------------------------------------------------------------------------------


def claims_of(
    classes: Classes, empty: Mapping[tuple[str, ...], Sequence[Query]], specification: Specification
) -> tuple[ClassClaim, ...]:
    """Return the claims about the classes; ``specification`` is the set of the classes.

    ``empty``: formulas of cells that were left out, by vehicles of the group. Exclusive: any two classes
    exclude each other; with several road sectors, any two cells of disturbances, and any two of sectors.
    Covers: a scenario holds exactly where one of its classes does. With several road sectors, it holds where
    one of its cells of disturbances and one of its cells of sectors do. A class is by definition one of
    each, so this is equivalent.
    """
    claims: list[tuple[str, Kind, str]] = []
    for group, cells in zip(classes.plan.groups, classes.what, strict=True):
        claims += _claims_of(classes, group, cells)
        for number, query in enumerate(empty.get(group.vehicles, ()), 1):
            claims.append((f"empty-{len(group.vehicles)}-vehicles-{number}", "empty", f"not ({query.text})"))
    return tuple(ClassClaim(name, kind, read_claim(specification, text)) for name, kind, text in claims)


def _claims_of(
    classes: Classes, group: ScenarioGroup, cells: Sequence[Cell]
) -> Iterator[tuple[str, Kind, str]]:
    plan = classes.plan
    yield from _exclusive([plan.what(cell.holds) for cell in cells], group.arguments, "")
    if not plan.has_places:
        for number in group.rows:
            those = _either([one.formula for one in classes.of(group) if number in one.scenarios])
            text = f"{name_of(number)}{group.arguments} <-> {those}"
            yield f"covers-scenario-{number:02}", "covers", text
        return
    vehicles = f"({', '.join(group.vehicles)})"
    places = [plan.where(cell.holds) for cell in classes.where]
    yield from _exclusive(places, vehicles, f"-{len(group.vehicles)}-vehicles")
    for number, (disturbance, sector) in group.rows.items():
        scenario = f"{name_of(number)}{group.arguments}"
        happens = [plan.what(cell.holds) for cell in cells if disturbance in cell.holds]
        where = [plan.where(cell.holds) for cell in classes.where if sector in cell.holds]
        one_of = _either([f"{name}{group.arguments}" for name in happens])
        there = _either([f"{name}{vehicles}" for name in where])
        # As three implications: the prover takes them one by one, which is quicker than an equivalence.
        text = (
            f"({scenario} -> {one_of}) and ({scenario} -> {there}) and ({one_of} and {there} -> {scenario})"
        )
        yield f"covers-scenario-{number:02}", "covers", text


def _either(formulas: Sequence[str]) -> str:
    return f"({' or '.join(formulas)})" if formulas else "false"


def _exclusive(names: Sequence[str], arguments: str, mark: str) -> Iterator[tuple[str, Kind, str]]:
    for a, b in combinations(names, 2):
        yield f"exclusive-{a}-{b}{mark}", "exclusive", f"not ({a}{arguments} and {b}{arguments})"


def claims_text(claims: Sequence[ClassClaim]) -> str:
    """Return the claims as a file for ``prove --claims``: paragraphs under a comment for each kind."""
    lines = [f"# To be proved with --spec {FILE_NAME} --set {SET_NAME}.", ""]
    for kind, heading in HEADINGS.items():
        those = [claim.query.text for claim in claims if claim.kind == kind]
        if those:
            lines += [f"# {heading}", "", *(line for text in those for line in (text, ""))]
    return "\n".join(lines)

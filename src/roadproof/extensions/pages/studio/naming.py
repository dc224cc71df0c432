"""Jobs for the editor: known names, the meaning of a name, and the errors of a text."""

from roadproof.errors import RoadproofError
from roadproof.evidence.codec import write
from roadproof.extensions.pages.studio.drafting import mistakes
from roadproof.extensions.pages.studio.requests import Answer, StudioQuestion
from roadproof.library.elaborate import read_claim, signature
from roadproof.library.scenario_references import read_query
from roadproof.library.scenarios import number_in, scenario_number
from roadproof.library.specification import Specification, source_of
from roadproof.library.words import words_of
from roadproof.logic.first_instant import first_instant_warnings
from roadproof.logic.restore import as_syntax
from roadproof.logic.show import decimal, text
from roadproof.logic.syntax import Definition, ParameterDeclaration
from roadproof.world.signals import SIGNALS, SIZES

WIDTH = 84
LONGEST_EXPANSION = 4000  # characters of a definition that is written out


def names(question: StudioQuestion) -> Answer:
    """Return every name for completion: definitions, parameters, signals, sets, options and scenarios."""
    home = question.home.specification
    library = home.library
    return {
        "definitions": [_described(home, x) for x in home.definitions.values()],
        "parameters": [
            {"name": p.name, "value": _value(p), "bound": p.bound, "doc": p.doc}
            for p in library.parameters.values()
        ],
        "signals": [{"name": n, "doc": about.unit} for n, about in SIGNALS.items()]
        + [{"name": n, "doc": unit} for n, unit in SIZES.items()],
        "sets": [{"name": s.name, "parent": s.parent, "doc": s.doc} for s in library.sets.values()],
        "options": [
            {"name": o.name, "values": list(o.values), "doc": o.doc} for o in library.options.values()
        ],
        "scenarios": [
            write(words_of(home, number))
            for name in home.definitions
            if (number := number_in(name)) is not None
        ],
    }


def _value(parameter: ParameterDeclaration) -> str:
    return f"{decimal(abs(parameter.value)) or parameter.value} {parameter.unit}"


def _described(home: Specification, definition: Definition) -> Answer:
    parameters = ", ".join(f"{b.name}: {b.sort}" for b in definition.parameters)
    return {"name": definition.name, "parameters": parameters, "doc": home.describe(definition)}


def definition(question: StudioQuestion) -> Answer:
    """Return one definition: its origin, its text, and its expansion."""
    home, name = question.home.specification, question.name
    known = home.library.parameters.get(name)
    if known is not None:
        bound = f" where {name} {known.bound} 0" if known.bound else ""
        return {
            "name": name,
            "text": f"param {name} = {_value(known)}{bound}",
            "doc": known.doc,
            "expansion": "",
        }
    declared = home.definitions.get(name)
    if declared is None:
        return {"name": name, "text": "", "doc": "", "expansion": ""}
    return {
        "name": name,
        "text": text(declared, WIDTH),
        "doc": home.describe(declared),
        "from": source_of(home.library, declared).name,
        "expansion": _expansion(home, name),
    }


def _expansion(home: Specification, name: str) -> str:
    """Return a definition without other definitions in it; empty where that fails, cut off where
    it is long.
    """
    try:
        roles = signature(home, name)
        sorts = {b.name: b.sort for b in home.definitions[name].parameters}
        given = "; ".join(f"{role}: {sorts.get(role, 'vehicle')}" for role in roles)
        head = f"given {given}: " if given else ""
        formula = read_claim(home, f"{head}{name}({', '.join(roles)})").formula
        written = text(as_syntax(formula, expand=True), WIDTH)
    except RoadproofError:
        return ""
    return written if len(written) <= LONGEST_EXPANSION else f"{written[:LONGEST_EXPANSION]} …"


def read(question: StudioQuestion) -> Answer:
    """Return the errors of a draft and of its formulas, and a description of each formula."""
    entries = [
        {
            "where": x.where,
            "message": x.message,
            "hint": x.hint,
            "at": (at := x.position) and [[at.line, at.column], [at.end_line, at.end_column]],
        }
        for x in mistakes(question.draft, question.formulas)
    ]
    return {"mistakes": entries, "formulas": _about(question)}


def _about(question: StudioQuestion) -> Answer:
    """Return the name, vehicles and lanes of each readable formula."""
    try:
        home = question.home.specification
    except RoadproofError:
        return {}
    about: Answer = {}
    for name, formula in question.formulas.items():
        try:
            query = read_query(home, formula)[1]
        except RoadproofError:
            continue
        number = scenario_number(query)
        words = None if number is None else words_of(home, number)
        about[name] = {
            "text": query.text,
            "name": "" if words is None else words.name,
            "sentence": "; ".join(first_instant_warnings(query.formula)) if words is None else words.sentence,
            "vehicles": list(query.vehicles),
            "lanes": list(query.lanes),
        }
    return about

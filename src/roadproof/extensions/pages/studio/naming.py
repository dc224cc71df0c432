"""Words for the editor: what there is to be named, what a name means, and what is wrong with a text."""

from roadproof.errors import RoadproofError
from roadproof.evidence.codec import write
from roadproof.extensions.pages.studio.drafting import mistakes
from roadproof.extensions.pages.studio.requests import Answer, Ask
from roadproof.library.elaborate import read_claim, signature
from roadproof.library.scenario_references import read_query
from roadproof.library.scenarios import number_in, scenario_number
from roadproof.library.specification import Specification, source_of
from roadproof.library.words import words_of
from roadproof.logic.first_instant import told_first_instants
from roadproof.logic.show import as_syntax, decimal, text
from roadproof.logic.syntax import Definition, ParameterDeclaration
from roadproof.world.signals import SIGNALS, SIZES

WIDTH = 84
LONGEST_EXPANSION = 4000  # characters of a definition that is written out


def names(ask: Ask) -> Answer:
    """Everything that can be named, for completion: definitions, parameters, signals, sets."""
    home = ask.home.specification
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


def definition(ask: Ask) -> Answer:
    """One definition: where it is from, its text, and written out."""
    home, name = ask.home.specification, ask.name
    known = home.library.parameters.get(name)
    if known is not None:
        bound = f" where {name} {known.bound} 0" if known.bound else ""
        return {
            "name": name,
            "text": f"param {name} = {_value(known)}{bound}",
            "doc": known.doc,
            "expansion": "",
        }
    found = home.definitions.get(name)
    if found is None:
        return {"name": name, "text": "", "doc": "", "expansion": ""}
    return {
        "name": name,
        "text": text(found, WIDTH),
        "doc": home.describe(found),
        "from": source_of(home.library, found).name,
        "expansion": _expansion(home, name),
    }


def _expansion(home: Specification, name: str) -> str:
    """A definition of a formula without other definitions; nothing of a number, or of a long one."""
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


def read(ask: Ask) -> Answer:
    """What is wrong with a draft and with the formulas that are asked of it, and what they are called."""
    told = [
        {
            "where": x.where,
            "message": x.message,
            "hint": x.hint,
            "at": (at := x.position) and [[at.line, at.column], [at.end_line, at.end_column]],
        }
        for x in mistakes(ask.draft, ask.formulas)
    ]
    return {"mistakes": told, "formulas": _about(ask)}


def _about(ask: Ask) -> Answer:
    """What each formula that can be read is called."""
    try:
        home = ask.home.specification
    except RoadproofError:
        return {}
    about: Answer = {}
    for name, formula in ask.formulas.items():
        try:
            query = read_query(home, formula)[1]
        except RoadproofError:
            continue
        number = scenario_number(query)
        words = None if number is None else words_of(home, number)
        about[name] = {
            "text": query.text,
            "name": "" if words is None else words.name,
            "sentence": "; ".join(told_first_instants(query.formula)) if words is None else words.sentence,
            "vehicles": list(query.vehicles),
            "lanes": list(query.lanes),
        }
    return about

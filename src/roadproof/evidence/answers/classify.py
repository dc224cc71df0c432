"""The index and the answers of ``roadproof classify``: classes with drives, and claims about them."""

from collections.abc import Iterator, Mapping

from roadproof.evidence.answers.entry import Common, Entry, evidence_name, shows_of, shows_of_claim
from roadproof.evidence.answers.proofs import unchecked_of
from roadproof.evidence.answers.reader import Background, Reader
from roadproof.evidence.strict import Fields
from roadproof.logic import formula as f
from roadproof.logic.formula import Formula
from roadproof.spec.elaborate import apply_definition
from roadproof.spec.scenarios import LANE, name_of, number_in

SCHEMA = "roadproof/classify/1"
CLASSES = "classes"  # the spec set of the file that defines them
_CLASS = ("name", "vehicles", "scenarios", "happens", "where", "description", "formula", "verdict", "reason")
_CLASS_MORE = ("situations", "traces", "drive")
_DOUBT = ("about", "reason")
_OF_CLASS = tuple(f"classes[].{x}" for x in ("happens", "where", "description", "reason"))
_OF_CLAIM = tuple(f"claims[].{x}" for x in ("reason", "seconds"))
_CLAIM = ("name", "kind", "claim", "verdict", "reason", "certificate", "seconds")


def read(data: Fields, background: Background) -> Iterator[Entry]:
    """The entries of an index or a kept answer. Raises ``InputError``."""
    common = background.at(CLASSES)
    for number, content in enumerate(data.items("classes"), 1):
        line = Fields(content, f"{data.where}, class {number}", (*_CLASS, *_CLASS_MORE))
        verdict, name = line.text("verdict"), line.text("name")
        shows = shows_of(verdict, line.where, drive="drive")
        yield Entry(
            common,
            line.where,
            ("class", name),
            verdict,
            name,
            shows,
            line.text("formula"),
            evidence_name(line, "drive"),
            fault=_not_of_class(line, common),
        )
    for number, content in enumerate(data.items("claims"), 1):
        line = Fields(content, f"{data.where}, claim {number}", _CLAIM)
        verdict, name, claim = line.text("verdict"), line.text("name"), line.text("claim")
        shows = shows_of_claim(verdict, line.where)
        yield Entry(
            common,
            line.where,
            ("claim", name),
            verdict,
            line.text("kind"),
            shows,
            claim,
            evidence_name(line, "certificate"),
            unchecked=unchecked_of(verdict),
            fault=_not_of_name(line, common),
        )
    for number, content in enumerate(data.items("doubts") if data.has("doubts") else (), 1):
        line = Fields(content, f"{data.where}, doubt {number}", _DOUBT)
        yield Entry(common, line.where, ("doubt", number), "UNKNOWN", line.text("about"), "nothing", "")


def _not_of_class(line: Fields, common: Common) -> str:
    """Why the formula of a class is not the definition of its name and vehicles, or nothing."""
    name, specification = line.text("name"), common.specification
    if name not in specification.definitions:
        return f"{line.where}: there is no definition '{name[:60]}' in its specification files"
    query = apply_definition(specification, name, (*line.texts("vehicles"), LANE))
    if common.formula(line.text("formula")) == query.formula:
        return ""
    return f"{line.where}: its formula is not {name}: {line.text('formula')[:120]}"


def _not_of_name(line: Fields, common: Common) -> str:
    """Why a claim is not the one that its name and kind say, or nothing.

    What excludes each other is named; of a scenario and its classes the scenario is.
    """
    name, kind, claim = line.text("name"), line.text("kind"), line.text("claim")
    beginning = {"exclusive": "exclusive-", "covers": "covers-scenario-", "empty": "empty-"}
    if kind not in beginning or not name.startswith(beginning[kind]):
        return f"{line.where}: its name {name[:60]} is none of kind {kind[:20]}"
    formula = common.formula(claim)
    named = _outer_names(formula)
    told = name.removeprefix(beginning[kind])
    if kind == "exclusive":
        inside = formula.body if isinstance(formula, f.Not) else None
        parts = inside.parts if isinstance(inside, f.And) else ()
        said = [x.name for x in parts if isinstance(x, f.Named)]
        if len(parts) != 2 or len(said) != 2 or not (told + "-").startswith(f"{said[0]}-{said[1]}-"):
            return f"{line.where} is called {name[:60]}, but its claim is {claim[:120]}"
    elif kind == "covers" and not (told.isdecimal() and name_of(int(told)) in named):
        return f"{line.where} is called {name[:60]}, but its claim is {claim[:120]}"
    return ""


def _outer_names(formula: Formula) -> set[str]:
    """The definitions that a formula applies itself, without those that their bodies apply."""
    if isinstance(formula, f.Named):
        return {formula.name}
    return {name for part in f.children(formula) for name in _outer_names(part)}


def _faults(data: Fields, background: Background, formulas: Mapping[str, str]) -> Iterator[str]:
    """What the index says as a whole otherwise than its definitions and claims."""
    if data.text("text") not in [x.text for x in background.library.files]:
        yield "the text of its classes is not that of a specification file beside it"
    common = background.at(CLASSES)
    home = common.library.sets[CLASSES].parent
    if data.text("set") != home:
        yield f"its classes are of set {home}, but it says {data.text('set')[:40]}"
    covered: dict[int, set[str]] = {}
    for content in data.items("claims"):
        line = Fields(content, data.where)
        if line.text("kind") == "covers":
            number = int(line.text("name").removeprefix("covers-scenario-"))
            covered[number] = _outer_names(common.formula(line.text("claim")))
    if data.items("claims") and sorted(covered) != data.items("scenarios"):
        yield "its scenarios are not those of which its claims say that classes cover them"
    for content in data.items("classes") if covered else ():
        line = Fields(content, data.where)
        name = line.text("name")
        formula = common.formula(line.text("formula"))
        parts = _outer_names(formula.body) if isinstance(formula, f.Named) else set()
        of_places = not any(number_in(x) for x in parts)  # what happens, and where
        of = sorted(n for n, names in covered.items() if name in names or (of_places and parts <= names))
        if line.items("scenarios") != of:
            yield f"{name} is said to be of scenarios {line.items('scenarios')}, but its claims say {of}"


READER = Reader(
    SCHEMA,
    ("set", "options", "parameters", "scenarios", "specs"),
    ("view", "text", "classes", "claims", "shares", "seconds", "doubts"),
    read,
    ("classes", "claims"),
    read,
    _faults,
    unchecked=(
        *("seconds", "shares", "doubts[].about", "doubts[].reason"),
        *(*_OF_CLASS, "classes[].situations", "classes[].traces", *_OF_CLAIM),
    ),
    unchecked_kept=("classes[].scenarios", *_OF_CLASS, *_OF_CLAIM, "said.set", "said.scenarios"),
)

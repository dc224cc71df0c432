"""``roadproof show``: a scenario, a definition or a formula, as text, LaTeX or JSON."""

import argparse
import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction

from roadproof.errors import InputError
from roadproof.evidence.answers import show as show_data
from roadproof.evidence.answers.tree import claim_node, definition_node
from roadproof.evidence.codec import write
from roadproof.evidence.heading import heading
from roadproof.evidence.strict import JsonObject
from roadproof.frontends.cli.basis import read_definitions
from roadproof.frontends.cli.list import value_of
from roadproof.frontends.cli.options import write_json
from roadproof.frontends.cli.terminal import width_of_terminal
from roadproof.frontends.settings.commands import Show
from roadproof.library.elaborate import read_claim, signature
from roadproof.library.quantity import DURATION
from roadproof.library.scenario_references import number_by_name, numbers_by_name, refuse_unknown
from roadproof.library.scenarios import name_of, number_in
from roadproof.library.specification import Specification, unknown_name
from roadproof.library.uses import parts_of_claim
from roadproof.library.words import Words, words_of
from roadproof.logic import formula as f
from roadproof.logic import syntax
from roadproof.logic.first_instant import first_instant_warnings
from roadproof.logic.latex import align, latex
from roadproof.logic.parse import parse_claim
from roadproof.logic.restore import as_syntax, term_as_syntax
from roadproof.logic.show import text
from roadproof.logic.syntax import Binding, Claim, Definition, ParameterDeclaration, SetBlock
from roadproof.verdict import ExitCode

SUMMARY = "show a scenario, a definition or a formula"

_WIDTH = 100  # of a line, or less on a narrow terminal
_NAME = re.compile(r"([A-Za-z_]\w*)(?:@([A-Za-z_]\w*))?")
EXAMPLES = """\
examples:
  roadproof show 4                                scenario 4, deceleration ahead, and its definitions
  roadproof show cut-in                           the six scenarios with a cut-in, by its ISO 34502 name
  roadproof show cutIn --set ext                  a definition as spec set ext has it
  roadproof show 4 --expand                       scenario_4 as one formula without definitions
  roadproof show 'scenario_8(SV,POV,L) -> F danger(SV,POV)' --format latex
"""
OPTIONS = Show


@dataclass(frozen=True)
class ScenarioIntroduction:
    """A scenario in words, and the set that it is of where that changes another."""

    words: Words
    other: SetBlock | None


@dataclass(frozen=True)
class Exhibit:
    """The content of ``show``: a claim, or definitions with the parameters that they speak of, or all three.

    ``about``: the scenario that it is, in words; ``hints``: first instants that it asks for.
    """

    claim: Claim | None
    definitions: tuple[Definition, ...] = ()
    parameters: tuple[ParameterDeclaration, ...] = ()
    about: ScenarioIntroduction | None = None
    hints: tuple[str, ...] = ()


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "what", metavar="WHAT", help="a scenario's number or name, a definition's name, or a formula"
    )


def run(args: argparse.Namespace) -> int:
    """Run the command; return its exit code."""
    specification, what = read_definitions(args, Show).specification, args.what.strip()
    numbers = numbers_by_name(specification, what)
    if args.format == "json" or not numbers:
        number_by_name(
            specification, what
        )  # refuses a name of several, as JSON shows one thing, and half a name
    exhibits = [_find(specification, x, args.expand) for x in map(str, numbers or (what,))]
    if args.format == "json":
        write_json(_as_json(exhibits[0], specification), "-")
    else:
        show = _as_latex if args.format == "latex" else _as_text
        print("\n\n".join(map(show, exhibits)))
    return ExitCode.AS_EXPECTED


def _find(specification: Specification, what: str, expand: bool) -> Exhibit:
    """``what``, elaborated before it is shown so that mistakes in it are found. Raises ``InputError``."""
    named = _NAME.fullmatch(name_of(int(what)) if re.fullmatch(r"[0-9]{1,4}", what) else what)
    if named is None or named[0] in ("true", "false"):
        return _find_claim(specification, what, expand)
    if named[2] is not None:
        specification = specification.in_set(named[2])
    number = number_in(named[1])
    if number is not None:
        refuse_unknown(specification, number)
    exhibit = _find_definition(specification, named[1], expand)
    return exhibit if number is None else replace(exhibit, about=_about(specification, number))


def _about(specification: Specification, number: int) -> ScenarioIntroduction:
    block = specification.library.sets[specification.set_name]
    return ScenarioIntroduction(words_of(specification, number), block if block.parent else None)


def _find_claim(specification: Specification, what: str, expand: bool) -> Exhibit:
    claim = parse_claim(what)
    formula = read_claim(specification, what).formula
    if expand:
        shown = Claim(claim.given, as_syntax(formula, expand=True))
        return Exhibit(shown, hints=first_instant_warnings(formula))
    used = parts_of_claim(specification, claim)
    described = _described(specification, used.definitions)
    return Exhibit(claim, described, used.parameters, hints=first_instant_warnings(formula))


def _find_definition(specification: Specification, name: str, expand: bool) -> Exhibit:
    if name not in specification.definitions:
        raise InputError(unknown_name("definition", name, specification.definitions))
    claim = _application(specification, specification.definitions[name])
    if not expand:
        stated = text(_compared(claim) if _is_number(specification, claim) else claim)
        used = parts_of_claim(specification, read_claim(specification, stated).claim)
        return Exhibit(None, _described(specification, used.definitions), used.parameters)
    if not _is_number(specification, claim):
        return Exhibit(Claim(claim.given, as_syntax(read_claim(specification, text(claim)).formula, True)))
    comparison = read_claim(specification, text(_compared(claim))).formula
    assert isinstance(comparison, f.Compare), "a number compared with zero is a comparison"
    return Exhibit(Claim(claim.given, term_as_syntax(comparison.left)))


def _described(specification: Specification, definitions: Sequence[Definition]) -> tuple[Definition, ...]:
    """The definitions with what their descriptions mention written out."""
    return tuple(replace(definition, doc=specification.describe(definition)) for definition in definitions)


def _application(specification: Specification, definition: Definition) -> Claim:
    """``definition`` applied to its own parameters, the members of a group of vehicles one by one."""
    roles = signature(specification, definition.name)
    given: list[Binding] = []
    for binding in definition.parameters:
        is_group = binding.sort == "vehicles"
        members = len(roles) - len(definition.parameters) + 1 if is_group else 1
        sort = "vehicle" if is_group else binding.sort
        given += [Binding(role, sort) for role in roles[len(given) : len(given) + members]]
    second = syntax.Literal_(Fraction(1), "s")
    arguments = tuple(second if x.sort == DURATION else syntax.Name(x.name) for x in given)
    declared = tuple(x for x in given if x.sort != DURATION)
    return Claim(declared, syntax.Call(definition.name, arguments))


def _compared(claim: Claim) -> Claim:
    """A claim about a number, which alone would be none."""
    return Claim(claim.given, syntax.Binary(">=", claim.body, syntax.Literal_(Fraction(0))))


def _is_number(specification: Specification, claim: Claim) -> bool:
    """Return whether the claim compares as a number does; mistakes elsewhere in it are ignored."""
    try:
        read_claim(specification, text(_compared(claim)))
    except InputError:
        return False
    return True


def _as_text(exhibit: Exhibit) -> str:
    width = min(_WIDTH, width_of_terminal() or _WIDTH)
    blocks = [
        "\n".join(f"# {line}" for line in _introduction(exhibit.about)),
        "" if exhibit.claim is None else text(exhibit.claim, width),
        "\n".join(text(definition, width) for definition in exhibit.definitions),
        "\n".join(_declaration(parameter) for parameter in exhibit.parameters),
        "\n".join(f"# {hint}" for hint in exhibit.hints),
    ]
    return "\n\n".join(block for block in blocks if block)


def _introduction(about: ScenarioIntroduction | None) -> Iterator[str]:
    """The sentence first; what a set changes is said last."""
    if about is None:
        return
    if about.words.sentence:
        yield about.words.sentence
        yield str(about.words)
    if about.other is not None and about.other.doc:
        yield f"set {about.other.name}: {about.other.doc}"


def _declaration(parameter: ParameterDeclaration) -> str:
    bound = f" where {parameter.name} {parameter.bound} 0" if parameter.bound else ""
    return f'param {value_of(parameter)}{bound} "{parameter.doc}"'


def _as_latex(exhibit: Exhibit) -> str:
    blocks = [
        "" if exhibit.claim is None else f"\\[\n{latex(exhibit.claim)}\n\\]",
        align(exhibit.definitions) if exhibit.definitions else "",
    ]
    return "\n\n".join(block for block in blocks if block)


def _as_json(exhibit: Exhibit, specification: Specification) -> JsonObject:
    claim = exhibit.claim
    answer = show_data.ShowData(
        **heading(show_data.SCHEMA, specification.library),
        set=specification.set_name,
        options=specification.options,
        scenario=None if exhibit.about is None else exhibit.about.words,
        formula=None
        if claim is None
        else show_data.ShownFormulaData(text=text(claim), tree=claim_node(claim)),
        definitions=tuple(
            show_data.ShownDefinitionData(name=x.name, text=text(x), tree=definition_node(x))
            for x in exhibit.definitions
        ),
        parameters=tuple(
            show_data.ShownParameterData(name=p.name, value=str(p.value), unit=p.unit, doc=p.doc)
            for p in exhibit.parameters
        ),
    )
    return write(answer)

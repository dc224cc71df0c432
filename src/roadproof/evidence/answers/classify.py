"""The index and the answers of ``roadproof classify``: classes with drives, and claims about them."""

from collections.abc import Iterator, Mapping
from dataclasses import replace
from functools import partial
from typing import Annotated, Final, Literal, TypeAlias

from roadproof.evidence.answers import shared
from roadproof.evidence.answers.entry import Common, Entry, evidence_name, shows_of, shows_of_claim
from roadproof.evidence.answers.proofs import unchecked_of
from roadproof.evidence.answers.reader import Background, Reader, unchecked
from roadproof.evidence.codec import LEFT_OUT, UNCHECKED, Doc, Key, Rule
from roadproof.library.compose import both, either, equivalence, implication, negation
from roadproof.library.elaborate import apply_definition, signature
from roadproof.library.scenarios import LANE, Scenario, applied, name_of, number_in, numbers_of, vehicles_of
from roadproof.logic import formula as f
from roadproof.logic.formula import Formula
from roadproof.reasons import NO_REASON
from roadproof.runtime.records import dataclass
from roadproof.verdict import ProofVerdict, Verdict

SCHEMA: Final = "roadproof/classify/1"
CLASSES = "classes"  # the spec set of the file that defines them
Word: TypeAlias = Literal[Verdict.WITNESSED, Verdict.UNKNOWN]
Kind: TypeAlias = Literal["exclusive", "covers", "empty"]
Numbers: TypeAlias = Annotated[tuple[shared.Number, ...], Doc("Numbers of scenarios.")]
_BEGINNING: Mapping[Kind, str] = {"exclusive": "exclusive-", "covers": "covers-scenario-", "empty": "empty-"}


@dataclass(frozen=True, kw_only=True)
class KeptClass:
    """A class, with a drive for it where one was found."""

    name: Annotated[str, Rule(pattern="^[A-Za-z_][A-Za-z0-9_]*$"), Doc("The name of its definition.")]
    vehicles: Annotated[
        tuple[str, ...], Rule(least=2), Doc("The vehicles to which the definition is applied.")
    ]
    scenarios: Annotated[Numbers, UNCHECKED, Doc("The scenarios that hold in the class.")]
    happens: Annotated[
        Numbers, UNCHECKED, Doc("What happens: scenarios, each the first with its disturbance.")
    ]
    where: Annotated[
        str | None, UNCHECKED, Doc("The road sectors, such as main; null where they make no difference.")
    ]
    description: Annotated[str, UNCHECKED, Doc("What happens, in words.")]
    formula: Annotated[shared.Formula, Doc("The definition applied to the vehicles and L.")]
    verdict: Word
    reason: shared.Reason = NO_REASON
    drive: shared.KeptDrive = None

    def expected(self, common: Common) -> list[Formula]:
        """That the definition of its name holds of its vehicles and L."""
        if self.name not in common.specification.definitions:
            return []
        return [apply_definition(common.specification, self.name, (*self.vehicles, LANE)).formula]


@dataclass(frozen=True, kw_only=True)
class CountedClass(KeptClass):
    """A class, with how often it occurs in recordings."""

    scenarios: Annotated[Numbers, Doc("The scenarios that hold in the class.")]
    situations: Annotated[
        shared.Count | None, UNCHECKED, Doc("Situations of the class; null where no shares are counted.")
    ] = None
    traces: Annotated[
        shared.Count | None, UNCHECKED, Doc("Traces with such a situation; null where no shares are counted.")
    ] = None


@dataclass(frozen=True, kw_only=True)
class Claim:
    """A claim about the classes."""

    name: Annotated[str, Rule(least=1), Doc("What the claim is called, and its file.")]
    kind: Annotated[
        Kind,
        Doc("Classes exclude each other; they cover the same as the scenarios; a combination never occurs."),
    ]
    claim: shared.Formula
    verdict: ProofVerdict
    reason: shared.Reason = NO_REASON
    certificate: shared.KeptCertificate = None
    seconds: shared.Seconds = 0.0

    @property
    def scenario(self) -> int | None:
        """The number of the scenario that classes cover; None in the name of another claim."""
        told = self.name.removeprefix(_BEGINNING[self.kind])
        return int(told) if self.kind == "covers" and told.isdecimal() else None

    def expected(self, common: Common) -> list[Formula]:
        """What the name and the kind say. Of a cover, the claim itself says which classes there are."""
        match self.kind:
            case "exclusive":
                return self._exclusive(common)
            case "covers":
                return self._covers(common)
            case "empty":
                formula = common.formula(self.claim)
                return [formula] if isinstance(formula, f.Not) else []

    def _exclusive(self, common: Common) -> list[Formula]:
        """That two definitions never hold of the same; of road sectors the name tells how many vehicles."""
        home = common.specification
        _, *names = self.name.split("-")
        if len(names) not in (2, 4) or not {*names[:2]} <= home.definitions.keys():
            return []
        arguments = {signature(home, names[0])}
        if names[3:] == ["vehicles"]:
            groups = {vehicles_of(home, Scenario(n, common.set_name)) for n in numbers_of(home)}
            arguments = {x for x in groups if str(len(x)) == names[2]}
        applied_to = ([apply_definition(home, name, those) for name in names[:2]] for those in arguments)
        return [negation(both(*pair)).formula for pair in applied_to]

    def _covers(self, common: Common) -> list[Formula]:
        """That the scenario is the union of the named classes, or of what happens and where."""
        home, number = common.specification, self.scenario
        if number not in numbers_of(home):
            return []
        scenario = applied(home, Scenario(number, common.set_name))
        named = [x for x in _outer_names(common.formula(self.claim)) if x != name_of(number)]
        places = [name for name in named if LANE not in signature(home, name)]
        arguments = (*vehicles_of(home, Scenario(number, common.set_name)), LANE)
        happens = either(*(apply_definition(home, x, arguments) for x in named if x not in places))
        there = either(*(apply_definition(home, x, arguments[:-1]) for x in places))
        both_ways = implication(scenario, happens), implication(scenario, there)
        in_parts = both(*both_ways, implication(both(happens, there), scenario))
        return [equivalence(scenario, happens).formula, in_parts.formula]


@dataclass(frozen=True, kw_only=True)
class Situations:
    """Situations by how many vehicles they are of."""

    pairs: Annotated[shared.Count, Key("2"), LEFT_OUT, Doc("Of two vehicles.")] = 0
    triples: Annotated[shared.Count, Key("3"), LEFT_OUT, Doc("Of three vehicles.")] = 0


@dataclass(frozen=True, kw_only=True)
class Shares:
    """What was counted in recordings."""

    source: Annotated[str, Doc("What was counted, in words.")]
    recordings: Annotated[tuple[str, ...], Doc("The names of the recordings.")]
    end: Annotated[Literal["clip"], Doc("Traces are read to their end and no further.")] = "clip"
    traces: Annotated[shared.Count, Doc("Traces on which danger arises.")]
    covered: Annotated[shared.Count, Doc("Those with a class.")]
    repeated: Annotated[shared.Count, Doc("Traces that an earlier recording shows, left out.")] = 0
    situations: Situations
    broken: Annotated[tuple[str, ...], Doc("Situations that are not of one class: our fault.")]


@dataclass(frozen=True, kw_only=True)
class Doubt:
    """What would be known of the division if a job had not been lost, or cut off by the clock."""

    about: Annotated[str, UNCHECKED, Doc("What is in doubt.")]
    reason: shared.Reason


@dataclass(frozen=True, kw_only=True)
class Preamble:
    """What an index says once for all classes."""

    set: shared.SetName
    options: shared.Options
    parameters: shared.Parameters
    specs: shared.Specifications
    scenarios: Annotated[Numbers, Doc("The scenarios that are divided.")]


@dataclass(frozen=True, kw_only=True)
class Index(Preamble, shared.Heading):
    """Classes of scenarios that exclude each other, and what is proved of them."""

    schema: Literal["roadproof/classify/1"] = SCHEMA
    view: shared.Dense = "dense"
    text: Annotated[
        str, Doc("The classes as a specification file; empty where the division was cut off.")
    ] = ""
    classes: tuple[CountedClass, ...]
    claims: tuple[Claim, ...]
    shares: Annotated[Shares | None, UNCHECKED, Doc("What was counted; null with --no-shares.")] = None
    doubts: Annotated[
        tuple[Doubt, ...], Rule(least=1), LEFT_OUT, Doc("About the division; left out where there is none.")
    ] = ()
    seconds: shared.Seconds = 0.0


@dataclass(frozen=True, kw_only=True)
class Record:
    """A kept answer: one class, or one claim."""

    classes: tuple[KeptClass, ...]
    claims: tuple[Claim, ...]


def _entries(answer: Index | Record, background: Background) -> Iterator[Entry]:
    common, where = background.at(CLASSES), background.where
    for number, one in enumerate(answer.classes, 1):
        yield _of_class(one, f"{where}, class {number}", common)
    for number, claim in enumerate(answer.claims, 1):
        yield _of_claim(claim, f"{where}, claim {number}", common)
    for number, doubt in enumerate(answer.doubts if isinstance(answer, Index) else (), 1):
        place, key = f"{where}, doubt {number}", ("doubt", number)
        yield Entry(common, place, key, "UNKNOWN", doubt.about, "nothing", "", expected=list)


def _of_class(said: KeptClass, where: str, common: Common) -> Entry:
    fault = ""
    if said.name not in common.specification.definitions:
        fault = f"{where}: there is no definition '{said.name[:60]}' in its specification files"
    elif common.formula(said.formula) not in said.expected(common):
        fault = f"{where}: its formula is not {said.name}: {said.formula[:120]}"
    return Entry(
        common,
        where,
        ("class", said.name),
        said.verdict,
        said.name,
        shows_of(said.verdict, where, drive="drive"),
        said.formula,
        evidence_name(where, "drive", said.drive),
        fault=fault,
        expected=partial(said.expected, common),
    )


def _of_claim(said: Claim, where: str, common: Common) -> Entry:
    fault = ""
    if not said.name.startswith(_BEGINNING[said.kind]):
        fault = f"{where}: its name {said.name[:60]} is none of kind {said.kind}"
    elif common.formula(said.claim) not in said.expected(common):
        fault = f"{where} is called {said.name[:60]}, but its claim is {said.claim[:120]}"
    return Entry(
        common,
        where,
        ("claim", said.name),
        said.verdict,
        said.kind,
        shows_of_claim(said.verdict, where),
        said.claim,
        evidence_name(where, "certificate", said.certificate),
        unchecked=unchecked_of(said.verdict),
        fault=fault,
        expected=partial(said.expected, common),
    )


def _outer_names(formula: Formula) -> tuple[str, ...]:
    """The definitions that a formula applies itself, without those that their bodies apply."""
    if isinstance(formula, f.Application):
        return (formula.name,)
    return tuple(dict.fromkeys(name for part in f.children(formula) for name in _outer_names(part)))


def _faults(index: Index, background: Background, formulas: Mapping[str, str]) -> Iterator[str]:
    """What the index says as a whole otherwise than its definitions and claims."""
    common = background.at(CLASSES)
    if index.text not in [x.text for x in background.library.files]:
        yield "the text of its classes is not that of a specification file beside it"
    home = common.library.sets[CLASSES].parent
    if index.set != home:
        yield f"its classes are of set {home}, but it says {index.set[:40]}"
    covered = {
        x.scenario: {*_outer_names(common.formula(x.claim))} for x in index.claims if x.scenario is not None
    }
    if index.claims and sorted(covered) != [*index.scenarios]:
        yield "its scenarios are not those of which its claims say that classes cover them"
    for one in index.classes if covered else ():
        formula = common.formula(one.formula)
        parts = {*_outer_names(formula.body)} if isinstance(formula, f.Application) else set()
        of_places = not any(number_in(x) for x in parts)  # what happens, and where
        of = tuple(
            sorted(n for n, names in covered.items() if one.name in names or (of_places and parts <= names))
        )
        if one.scenarios != of:
            yield f"{one.name} is said to be of scenarios {[*one.scenarios]}, but its claims say {[*of]}"


READER = replace(
    Reader.of(Index, Preamble, Record, _entries, faults=_faults),
    unchecked_kept=(*unchecked(Record), "said.set", "said.scenarios"),
)

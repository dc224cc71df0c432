"""The files of certificates, as they stand in JSON."""

from collections.abc import Iterator, Mapping
from functools import reduce
from itertools import groupby
from operator import or_
from typing import Annotated, Final, Literal, TypeAlias, get_args

from roadproof.evidence.answers.shared import Assuming, Dense, Formula, OneScenario, Options, SetName
from roadproof.evidence.codec import LEFT_OUT, Doc, Remedy, Rule
from roadproof.evidence.json_schema import Plain
from roadproof.library.motion import ALL_SCHEMAS
from roadproof.runtime.records import dataclass

SCHEMA: Final = "roadproof/certificate/2"
Term: TypeAlias = Annotated[str, Rule(least=1)]
Place: TypeAlias = Annotated[int, Rule(minimum=0), Remedy("there is no formula of that number")]
Sign: TypeAlias = Annotated[Literal["+", "-"], Remedy("a sign must be + or -")]
NamedSite: TypeAlias = tuple[str, Place, Sign, str] | tuple[str, Place, Sign, str, str]
InstancedSite: TypeAlias = (
    tuple[Place, Sign, str, tuple[str, ...]] | tuple[Place, Sign, str, str, tuple[str, ...]]
)
TableauRule: TypeAlias = Literal[
    "Close",
    "CloseTruth",
    "CloseLinear",
    "CloseRoad",
    "CloseRoads",
    "CloseZones",
    "Alpha",
    "Beta",
    "Timing",
    "New",
    "Inst",
    "InstUntil",
    "NewRoad",
    "InstRoad",
    "Cut",
    "Fact",
]
"""The rules of proofs/kernel/Tableau.v."""
TableauLine: TypeAlias = Annotated[
    str, Rule(pattern=rf"^({'|'.join(get_args(TableauRule))}) [A-Za-z0-9_ ,*/-]+$")
]


@dataclass(frozen=True, kw_only=True)
class Axiom:
    """A fact about motion or an induction over time, by the name of its schema."""

    schema: str
    arguments: Options


# Schemas by what they take: how a schema of JSON calls both, and says what they are.
_AXIOMS = (
    ("Sides", "Sides", "How two terms may come to be equal.", "Two terms that are compared."),
    ("Leaves", "Formula", "How a formula comes to be false.", "A formula."),
    (
        *("Growth", "Growth", "How far a term gains on another in a time."),
        "Two terms, the speed at which one gains on the other, and a time.",
    ),
    (
        *("GrowthTwice", "GrowthTwice"),
        "How far a term gains on another in a time, where the speed grows.",
        "As before, with the growth of the speed.",
    ),
    ("Steps", "Steps", "An induction in steps of time.", "A formula with an interval of time."),
    ("Lasts", "Lasting", "An induction over a time that lasts.", "A formula with a time."),
)


def _kinds_of_axioms() -> Iterator[type]:
    """Definitions for the JSON Schema alone: one for all schemas of motion that take the same arguments."""
    groups = groupby(ALL_SCHEMAS.items(), lambda x: x[1])
    for (taken, those), (name, of, doc, of_doc) in zip(groups, _AXIOMS, strict=True):
        fields = [(x, Formula if x == "inside" else Term) for x in taken]
        arguments = _definition(f"Of{of}", of_doc, dict(fields))
        schema = Literal[tuple(x for x, _ in those)]  # type: ignore[valid-type]
        yield _definition(f"{name}Axiom", doc, {"schema": schema, "arguments": arguments})


def _definition(name: str, doc: str, fields: Mapping[str, object]) -> type:
    about = {"__annotations__": dict(fields), "__doc__": doc, "__module__": __name__}
    made: type = dataclass(frozen=True, kw_only=True)(type(name, (), about))
    return made


@dataclass(frozen=True, kw_only=True)
class Lemma:
    """A clause that holds at every instant."""

    clause: Annotated[
        tuple[Annotated[tuple[str, bool], Remedy("no pair of an atom and a truth value")], ...],
        Doc("Atoms, each with the truth value of which one must hold."),
    ]
    at: Annotated[tuple[str, ...], Doc("The moments at which it is used.")]


@dataclass(frozen=True, kw_only=True)
class Query:
    """A query that is to be answered unsat."""

    title: Annotated[str, Doc("Of what it is a query.")]
    smtlib: Annotated[tuple[str, ...], Doc("The lines of a script in SMT-LIB 2.")]


@dataclass(frozen=True, kw_only=True)
class Certificate:
    """The claim, and the instances and lemmas from which the stored queries are derived again; each query is
    to be answered unsat.
    """

    schema: Literal["roadproof/certificate/2"] = SCHEMA
    property: Annotated[str, Doc("Template property such as P1, another name, or empty.")]
    scenario: OneScenario
    claim: Formula
    assuming: Annotated[Assuming, Remedy("leave 'assuming' out"), LEFT_OUT] = ()
    axioms: Annotated[
        tuple[Annotated[Axiom, Plain(reduce(or_, _kinds_of_axioms()))], ...] | None,
        LEFT_OUT,
        Doc(
            "The facts about motion and the inductions over time that the proof uses; inductions are true on "
            "every trace; formulas are made anew of schema and arguments (docs/explanation/motion.md)."
        ),
    ] = None
    unused: Annotated[
        tuple[Formula, ...],
        Rule(least=1),
        LEFT_OUT,
        Doc(
            "Limits under assuming that are no premises: the queries prove the claim without them. Left out "
            "where all limits are premises."
        ),
    ] = ()
    pinned: Annotated[
        tuple[Formula, ...],
        Rule(least=1),
        LEFT_OUT,
        Doc(
            "Values of parameters that the claim's own premise demands, such as minDanger = 0.6 s; they are "
            "put in before the queries are derived."
        ),
    ] = ()
    reading: Annotated[
        Literal["lanelets", "names"] | None,
        LEFT_OUT,
        Doc(
            "Which parts of the claim are predicates. Left out: definitions and quantifiers over lanelets "
            "about one instant. lanelets: the proof looks through these quantifiers. names: definitions "
            "about several instants are predicates, too."
        ),
    ] = None
    set: SetName
    options: Options
    view: Annotated[Dense, Remedy("a certificate is about dense time")]
    assumptions: Annotated[
        tuple[str, ...], Doc("Declared bounds of parameters that were used, such as minSafe >= 0.")
    ]
    formulas: Annotated[tuple[str, ...], Doc("A table of formulas, which times and instances name by place.")]
    times: Annotated[
        tuple[NamedSite, ...],
        Doc(
            "Name of a moment, then where it comes from: place in formulas, sign, moment, and instance where "
            "it is inside one."
        ),
    ]
    instances: Annotated[
        tuple[InstancedSite, ...],
        Doc("A quantifier as in times, then the terms that it is instantiated with."),
    ]
    lemmas: Annotated[tuple[Lemma, ...], Doc("Clauses that the queries use.")]
    queries: Annotated[
        tuple[Query, ...],
        Plain(Annotated[tuple[Query, ...], Rule(least=1)]),
        Doc("What is to be answered unsat: the claim, and each case of each lemma."),
    ]
    tableau: Annotated[
        tuple[str, ...] | None,
        Plain(Annotated[tuple[TableauLine, ...], Rule(least=1)] | None),
        Doc(
            "The proof for Coq, a line a node: a rule of proofs/kernel/Tableau.v with what it is told, "
            "children after it; null where none was found."
        ),
    ]

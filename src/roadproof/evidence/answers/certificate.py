"""The JSON form of certificates."""

from collections.abc import Iterator, Mapping
from functools import reduce
from itertools import groupby
from operator import or_
from typing import Annotated, Literal, TypeAlias, get_args

from roadproof.core_record import CERTIFICATE
from roadproof.evidence.answers.shared import Assuming, Dense, Formula, OneScenario, Options, SetName
from roadproof.evidence.codec import LEFT_OUT, Doc, ErrorHint, Rule
from roadproof.evidence.schema_notes import DescribedBy
from roadproof.library.assumption import ALL_SCHEMAS
from roadproof.runtime.records import dataclass

Term: TypeAlias = Annotated[str, Rule(least=1)]
Place: TypeAlias = Annotated[int, Rule(minimum=0), ErrorHint("there is no formula of that number")]
Sign: TypeAlias = Annotated[Literal["+", "-"], ErrorHint("a sign must be + or -")]
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
class AxiomData:
    """A fact about motion or an induction over time, by the name of its schema."""

    schema: str
    arguments: Options


# For each group of motion schemas with the same arguments: names of two definitions, and their descriptions.
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
    """Yield definitions for the JSON Schema alone, one for all motion schemas with the same arguments."""
    groups = groupby(ALL_SCHEMAS.items(), lambda schema: schema[1])
    for (argument_names, schemas), (name, of, doc, of_doc) in zip(groups, _AXIOMS, strict=True):
        fields = [(x, Formula if x == "inside" else Term) for x in argument_names]
        arguments = _definition(f"Of{of}", of_doc, dict(fields))
        schema = Literal[tuple(schema_name for schema_name, _ in schemas)]  # type: ignore[valid-type]
        yield _definition(f"{name}Axiom", doc, {"schema": schema, "arguments": arguments})


def _definition(name: str, doc: str, fields: Mapping[str, object]) -> type:
    attributes = {"__annotations__": dict(fields), "__doc__": doc, "__module__": __name__}
    definition: type = dataclass(frozen=True, kw_only=True)(type(name, (), attributes))
    return definition


@dataclass(frozen=True, kw_only=True)
class StateLemmaData:
    """A clause that holds at every instant."""

    clause: Annotated[
        tuple[Annotated[tuple[str, bool], ErrorHint("no pair of an atom and a truth value")], ...],
        Doc("Atoms, each with the truth value of which one must hold."),
    ]
    at: Annotated[tuple[str, ...], Doc("The moments at which it is used.")]


@dataclass(frozen=True, kw_only=True)
class QueryData:
    """A query that a solver must answer with unsat."""

    title: Annotated[str, Doc("Of what it is a query.")]
    smtlib: Annotated[tuple[str, ...], Doc("The lines of a script in SMT-LIB 2.")]


@dataclass(frozen=True, kw_only=True)
class CertificateData:
    """The claim, and the instances and lemmas from which the stored queries are derived again; each query
    must be unsatisfiable.
    """

    schema: Literal["roadproof/certificate/2"] = CERTIFICATE
    property: Annotated[str, Doc("Template property such as P1, another name, or empty.")]
    scenario: OneScenario
    claim: Formula
    assuming: Annotated[Assuming, ErrorHint("leave 'assuming' out"), LEFT_OUT] = ()
    axioms: Annotated[
        tuple[Annotated[AxiomData, DescribedBy(reduce(or_, _kinds_of_axioms()))], ...] | None,
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
    view: Annotated[Dense, ErrorHint("a certificate is about dense time")]
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
    lemmas: Annotated[tuple[StateLemmaData, ...], Doc("Clauses that the queries use.")]
    queries: Annotated[
        tuple[QueryData, ...],
        DescribedBy(Annotated[tuple[QueryData, ...], Rule(least=1)]),
        Doc("What is to be answered unsat: the claim, and each case of each lemma."),
    ]
    tableau: Annotated[
        tuple[str, ...] | None,
        DescribedBy(Annotated[tuple[TableauLine, ...], Rule(least=1)] | None),
        Doc(
            "The proof for Coq, a line a node: a rule of proofs/kernel/Tableau.v with what it is told, "
            "children after it; null where none was found."
        ),
    ]

"""The order of scenarios as plain data."""

from typing import TYPE_CHECKING, Annotated, Final, Literal, TypeAlias

from roadproof.evidence.answers import headings, shared
from roadproof.evidence.codec import Doc, Key, Rule
from roadproof.questions.basis import Basis
from roadproof.questions.question import EvidencePlace, heading_of
from roadproof.runtime.records import dataclass

if TYPE_CHECKING:
    from roadproof.questions.order.deciding import Edge
    from roadproof.questions.order.question import OrderView

SCHEMA: Final = "roadproof/order/2"
Position: TypeAlias = Annotated[int, Rule(minimum=1)]


@dataclass(frozen=True, kw_only=True)
class Implication:
    """The fact that one scenario implies another."""

    above: Annotated[shared.ScenarioName, Key("from")]
    below: Annotated[shared.ScenarioName, Key("to")]

    @property
    def pair(self) -> tuple[str, str]:
        """The two names."""
        return self.above, self.below


@dataclass(frozen=True, kw_only=True)
class EdgeData(Implication):
    """A proof that one scenario implies another."""

    claim: shared.Formula
    certificate: shared.CertificateField


@dataclass(frozen=True, kw_only=True)
class RefutationData:
    """A drive on which one scenario holds and others do not, by number."""

    number: Position
    holds: shared.ScenarioName
    fails: Annotated[
        tuple[shared.ScenarioName, ...], Rule(least=1), Doc("The scenarios that are false on the drive.")
    ]
    drive: shared.DriveField


@dataclass(frozen=True, kw_only=True)
class MissingImplication(Implication):
    """A pair of which the first scenario does not imply the second."""

    drives: Annotated[tuple[Position, ...], Rule(least=1), Doc("The numbers of drives that show so.")]


@dataclass(frozen=True, kw_only=True)
class UndecidedImplicationData(Implication):
    """An implication that is neither proved nor refuted."""

    reason: shared.Reason


@dataclass(frozen=True, kw_only=True)
class OrderData(headings.AnswerHeading):
    """The implications between scenarios."""

    schema: Literal["roadproof/order/2"] = SCHEMA
    sets: shared.SetNames
    options: shared.Options
    parameters: shared.Parameters
    specs: shared.Specifications
    view: shared.Dense = "dense"
    kinds: Annotated[
        tuple[Annotated[tuple[shared.ScenarioName, ...], Rule(least=1)], ...],
        Doc("Scenarios that are one formula; the first stands for all."),
    ]
    proved: tuple[EdgeData, ...]
    edges: Annotated[tuple[EdgeData, ...], Doc("Those proved that do not follow from others.")]
    missing: tuple[MissingImplication, ...]
    drives: tuple[RefutationData, ...]
    doubts: tuple[UndecidedImplicationData, ...]
    seconds: shared.Seconds = 0.0


def order_data(basis: Basis, view: "OrderView", place: EvidencePlace, seconds: float) -> OrderData:
    """Return the view as ``--json`` prints it."""
    return OrderData(
        **heading_of(SCHEMA, basis),
        sets=basis.set_names,
        **basis.common_data(),
        kinds=tuple(tuple(map(str, kind.nodes)) for kind in view.kinds),
        proved=tuple(_edge(x, place) for x in view.proved),
        edges=tuple(_edge(x, place) for x in view.edges),
        missing=tuple(
            MissingImplication(above=str(above), below=str(below), drives=tuple(k + 1 for k in places))
            for above, below, places in view.missing
        ),
        drives=tuple(
            RefutationData(
                number=k,
                holds=str(x.node),
                fails=tuple(sorted({*map(str, x.others)})),
                drive=place(x.name, x.answer),
            )
            for k, x in enumerate(view.drives, 1)
        ),
        doubts=tuple(
            UndecidedImplicationData(above=str(x.above), below=str(x.below), reason=x.reason)
            for x in view.doubts
        ),
        seconds=round(seconds, 1),
    )


def _edge(x: "Edge", place: EvidencePlace) -> EdgeData:
    return EdgeData(
        above=str(x.above), below=str(x.below), claim=x.claim.text, certificate=place(x.name, x.answer)
    )

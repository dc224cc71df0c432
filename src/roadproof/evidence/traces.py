"""Traces inside an index, read strictly and judged again: counterexamples where no drive was found."""

from collections.abc import Sequence

from roadproof.errors import RoadproofError
from roadproof.evidence.answers.trace import Trace
from roadproof.evidence.codec import read
from roadproof.evidence.drive_file import road_of
from roadproof.evidence.finding import Acceptance
from roadproof.evidence.periodic import Loop
from roadproof.evidence.refutation import Countermodel, Instant, fault_of
from roadproof.library.bind import values_with
from roadproof.library.elaborate import read_claim
from roadproof.library.motion import under_limits
from roadproof.library.specification import Specification


def judge_trace(
    content: object, specification: Specification, claim: str, where: str, said: Sequence[str] = ()
) -> tuple[Acceptance, str]:
    """Whether a trace refutes a claim under what is ``said``, judged; and why where it does not."""
    try:
        query = under_limits(specification, read_claim(specification, claim), said)
        trace = read_trace(content, where)
        values_with(specification.library, trace.parameters)
        fault = fault_of(trace, query.formula, specification.library.bounds)
    except RoadproofError as error:
        return Acceptance.UNREADABLE, str(error)
    return (
        (Acceptance.REJECTED, f"its trace does not refute it: {fault}")
        if fault
        else (Acceptance.ACCEPTED, "")
    )


def read_trace(content: object, where: str) -> Countermodel:
    """The inverse of ``refutation.trace_data``. Raises ``InputError``."""
    place = f"{where}, trace"
    said = read(Trace, content, place)
    return Countermodel(
        tuple(Instant(x.time, x.values, dict.fromkeys(x.true, True), x.after) for x in said.instants),
        said.parameters,
        "before" if said.between == "the state of the instant before" else "after",
        None if said.road is None else road_of(said.road, f"{place}, road"),
        None if said.repeats is None else Loop(said.repeats.start, said.repeats.period),
    )

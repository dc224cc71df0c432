"""Traces inside an index, read strictly and judged again: counterexamples where no drive was found."""

from collections.abc import Sequence
from fractions import Fraction

from roadproof.errors import InputError, RoadproofError
from roadproof.evidence.drive_file import read_road
from roadproof.evidence.finding import Acceptance
from roadproof.evidence.periodic import Loop
from roadproof.evidence.refutation import Countermodel, Held, Instant, fault_of
from roadproof.evidence.strict import Fields, rational
from roadproof.library.bind import values_with
from roadproof.library.elaborate import read_claim
from roadproof.library.motion import under_limits
from roadproof.library.specification import Specification

_BETWEEN: dict[str, Held] = {
    "the state of the instant before": "before",
    "the state of the instant after": "after",
}
MOST_INSTANTS = 1000


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
    data = Fields(
        content, f"{where}, trace", ("kind", "between", "parameters", "road", "repeats", "instants")
    )
    if data.text("kind") != "trace":
        raise InputError(f"{data.where}: kind={data.text('kind')[:40]!r}; a drive is a file beside the index")
    if data.text("between") not in _BETWEEN:
        raise InputError(
            f"{data.where}: between='{data.text('between')[:60]}' must be {' or '.join(_BETWEEN)}"
        )
    if len(data.items("instants")) > MOST_INSTANTS:
        raise InputError(f"{data.where}: more than {MOST_INSTANTS} instants")
    return Countermodel(
        tuple(_instant(x, f"{data.where}, instant {k}") for k, x in enumerate(data.items("instants"), 1)),
        _numbers(data, "parameters"),
        _BETWEEN[data.text("between")],
        read_road(data.get("road"), f"{data.where}, road") if data.has("road") else None,
        _loop(data.get("repeats"), f"{data.where}, repeats") if data.has("repeats") else None,
    )


def _instant(content: object, where: str) -> Instant:
    data = Fields(content, where, ("time", "true", "values", "after"))
    after = _numbers(data, "after") if data.has("after") else None
    truths = dict.fromkeys(data.texts("true"), True)
    return Instant(data.rational("time"), _numbers(data, "values"), truths, after)


def _loop(content: object, where: str) -> Loop:
    data = Fields(content, where, ("from", "period"))
    return Loop(data.rational("from"), data.rational("period"))


def _numbers(data: Fields, field: str) -> dict[str, Fraction]:
    given = data.mapping(field)
    return {name: rational(value, f"{data.where}, {field}.{name}") for name, value in given.items()}

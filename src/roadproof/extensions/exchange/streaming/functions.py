"""The functions of one monitor in C: what a sample shows, one sample more, reset, step and finish.

``observe`` finds the truth of the leaves in a sample. ``advance`` takes it, or what counts after the end of
the trace, and returns the newest value. ``finish`` advances a copy of the state to the end of all windows:
once where all that is to come counts against the formula (strong), once where it counts for it (weak).
"""

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from textwrap import indent

from roadproof.extensions.exchange.streaming import arithmetic, evaluation
from roadproof.extensions.exchange.streaming.evaluation import bytes_of
from roadproof.extensions.exchange.streaming.plan import Constant, Plan
from roadproof.extensions.exchange.streaming.sample import SampleField, Source
from roadproof.logic.formula import Compare

_VARIABLES = (
    *("0xAAAAAAAAAAAAAAAAu", "0xCCCCCCCCCCCCCCCCu", "0xF0F0F0F0F0F0F0F0u"),
    *("0xFF00FF00FF00FF00u", "0xFFFF0000FFFF0000u", "0xFFFFFFFF00000000u"),
)
"""The table of each variable: in row k it has bit i of k."""


@dataclass(frozen=True)
class StreamMonitor:
    """One formula as functions in C: ``label_step`` and others. ``told``: the formula as text."""

    identifier: str
    told: str
    plan: Plan

    @property
    def memory(self) -> int:
        """Bytes of the state."""
        return bytes_of(self.plan)

    @property
    def rest(self) -> int:
        """Return how many verdicts ``finish`` writes at most, and 1 where it writes none."""
        return 1 if self.plan.at_start else max(1, self.plan.delay)


def heads(name: str, monitor: StreamMonitor) -> list[str]:
    """The heads of reset, step and finish."""
    identifier = monitor.identifier
    rest = f"{name}_verdict rest[{identifier.upper()}_REST]"
    return [
        f"void {identifier}_reset({identifier}_state *state)",
        f"{name}_verdict {identifier}_step({identifier}_state *state, const {name}_sample *sample)",
        f"uint32_t {identifier}_finish(const {identifier}_state *state, {rest})",
    ]


def functions(name: str, monitor: StreamMonitor, fields: Mapping[Source, SampleField]) -> str:
    """All functions of a monitor, one after the other."""
    identifier, (reset, step, finish) = monitor.identifier, heads(name, monitor)
    size = f"sizeof({identifier}_state) == {identifier.upper()}_BYTES"
    return "\n\n".join(
        [
            f"typedef char {identifier}_size[({size}) ? 1 : -1];",
            _function(
                f"static int {identifier}_observe(const {name}_sample *sample, uint8_t *seen)",
                _observe(monitor, fields),
            ),
            _function(
                f"static uint32_t {identifier}_advance({identifier}_state *state, const uint8_t *seen, "
                "uint32_t ended, uint64_t pad)",
                _advance(monitor.plan),
            ),
            _function(reset, [f"static const {identifier}_state fresh = {{ 0 }};", "*state = fresh;"]),
            _function(step, _step(name.upper(), monitor)),
            _function(finish, _finish(name.upper(), monitor)),
        ]
    )


def helpers_for(body: str) -> str:
    """The functions that are called in ``body`` or by another that is, one after the other."""
    helpers: list[str] = []
    for name, text in reversed([*arithmetic.HELPERS.items(), *evaluation.HELPERS.items()]):
        if re.search(rf"\b{name}\(", body + "".join(helpers)):
            helpers.append(text)
    return "\n\n".join(reversed(helpers))


def _function(head: str, lines: Sequence[str]) -> str:
    """A function; parameters that no line mentions are named for compilers that warn of them."""
    text = "\n".join(lines)
    names = [x for x in ("sample", "seen", "ended", "pad", "state") if re.search(rf"\b{x}\b", head)]
    unused = "".join(f"(void){x};\n" for x in names if not re.search(rf"\b{x}\b", text))
    return f"{head}\n{{\n{indent(unused + text, '    ')}\n}}"


def _observe(monitor: StreamMonitor, fields: Mapping[Source, SampleField]) -> list[str]:
    leaves = list(enumerate(monitor.plan.leaves))
    compared = [(k, leaf) for k, leaf in leaves if isinstance(leaf, Compare)]
    flags: dict[object, str] = {source: field.name for source, field in fields.items()}
    return [
        "int fine = 1;",
        *arithmetic.range_checks(compared, fields),
        *arithmetic.comparisons(compared, fields),
        *(f"seen[{k}] = sample->{flags[leaf]} != 0;" for k, leaf in leaves if not isinstance(leaf, Compare)),
        "return fine;",
    ]


def _advance(plan: Plan) -> list[str]:
    """``ended``: which sample after the end of the trace this is, 0 inside; ``pad``: values there."""
    ceiling = max(max(node.delay, node.ready) for node in plan.nodes) + 2
    count = f"state->count += state->count < {ceiling};"
    body, last = list(evaluation.statements(plan)), len(plan.nodes) - 1
    if not plan.at_start:
        root = plan.nodes[last].operation
        return [count, *body, f"return {int(root.value) if isinstance(root, Constant) else f'n{last}'};"]
    return [
        f"uint64_t next[{plan.variables}] = {{ {', '.join(_VARIABLES[: plan.variables])} }};",
        f"uint8_t row[{plan.rows}];",
        count,
        *body,
        f"if (state->count == {plan.delay + 1}) {{",
        f"    state->first[0] = n{last};",
        f"}} else if (state->count > {plan.delay + 1}) {{",
        f"    find_rows(row, {plan.rows}, next, {plan.variables});",
        f"    state->first[0] = rewrite(state->first[0], row, {plan.rows});",
        "}",
        f"return {_first('state->', 'pad & 1', plan)};",
    ]


def _first(owner: str, weak: str, plan: Plan) -> str:
    """The value at the first sample, where what is to come counts for the formula or against it."""
    return f"(uint32_t)({owner}first[0] >> ({weak} ? {plan.weak} : {plan.strong}) & 1)"


def _step(big: str, monitor: StreamMonitor) -> list[str]:
    identifier, plan = monitor.identifier, monitor.plan
    open_ = f" || (!holds && {_first('state->', '1', plan)})" if plan.at_start else ""
    return [
        f"uint8_t seen[{max(1, len(plan.leaves))}];",
        "uint32_t holds;",
        f"if (state->rejected || !{identifier}_observe(sample, seen)) {{",
        "    state->rejected = 1;",
        f"    return {big}_UNKNOWN;",
        "}",
        f"holds = {identifier}_advance(state, seen, 0, 0);",
        f"if (state->count <= {plan.delay}{open_}) {{",
        f"    return {big}_UNKNOWN;",
        "}",
        f"return holds ? {big}_TRUE : {big}_FALSE;",
    ]


def _finish(big: str, monitor: StreamMonitor) -> list[str]:
    plan, delay, identifier = monitor.plan, monitor.plan.delay, monitor.identifier
    if not delay and not plan.at_start:
        return ["(void)rest;", "(void)state;", "return 0;"]
    begin, end = f"for (k = 1; k <= {delay}; ++k) {{", "}"
    advance = f"    holds = {identifier}_advance(&copy, seen, k, view ? ~(uint64_t)0 : 0);"
    if plan.at_start:
        count = "1"
        newest = f"uint32_t holds = {_first('copy.', 'view', plan)};"
        work = [newest, begin, advance, end, *_judge(big, "0")]
    else:
        count = f"state->count < {delay} ? state->count : {delay}"
        judged = (
            f"    {line}" for line in _judge(big, f"k + count - {delay + 1}", f"k + count > {delay} && ")
        )
        work = ["uint32_t holds;", begin, advance, *judged, end]
    return [
        f"static const uint8_t seen[{max(1, len(plan.leaves))}] = {{ 0 }};",
        f"const uint32_t count = {count};",
        "uint32_t k;",
        "uint32_t view;",
        "for (k = 0; k < count; ++k) {",
        f"    rest[k] = {big}_UNKNOWN;",
        "}",
        "for (view = 0; view < 2 && state->count > 0 && !state->rejected; ++view) {",
        f"    {identifier}_state copy = *state;",
        *(f"    {line}" for line in work),
        "}",
        "return count;",
    ]


def _judge(big: str, place: str, known: str = "") -> list[str]:
    """Return the lines that decide: true where the strong view holds, false where the weak one does not."""
    return [f"if ({known}holds != view) {{", f"    rest[{place}] = holds ? {big}_TRUE : {big}_FALSE;", "}"]

"""Monitors as a header and a source file in C99, without allocation and without libraries."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from fractions import Fraction
from textwrap import wrap

from roadproof.errors import InputError
from roadproof.extensions.exchange.streaming.evaluation import members_of
from roadproof.extensions.exchange.streaming.functions import StreamMonitor, functions, heads, helpers_for
from roadproof.extensions.exchange.streaming.plan import plans_of
from roadproof.extensions.exchange.streaming.sample import SampleField, Source, fields_of
from roadproof.logic.formula import Formula

FLAGS = "-std=c99 -O2 -ffp-contract=off"
"""Options of the compiler with which verdicts are those of the monitor."""
_FRAME = """\
/* Made by roadproof; {name}.h says what it is. */

#include "{name}.h"

#include <float.h>
{more}
#if defined(__FAST_MATH__) || (defined(FLT_EVAL_METHOD) && FLT_EVAL_METHOD != 0)
#error "verdicts need IEEE arithmetic in double: leave out -ffast-math; on x86 add -msse2 -mfpmath=sse"
#endif

{body}
"""


@dataclass(frozen=True)
class CSource:
    """Monitors for samples every ``dt`` seconds, the fields of a sample, and the name of the files."""

    name: str
    dt: Fraction
    monitors: tuple[StreamMonitor, ...]
    fields: Mapping[Source, SampleField]

    @property
    def files(self) -> dict[str, str]:
        """The texts of the header and of the source file, by name."""
        return {f"{self.name}.h": "\n".join(_header(self)), f"{self.name}.c": _source(self)}


def compile_c(
    formulas: Mapping[str, tuple[str, Formula]], dt: Fraction, name: str, most_bytes: int
) -> CSource:
    """Monitors in C for formulas by identifier, each with its text; ``name`` is that of the files.

    Parameters have values. Raises ``InputError`` for formulas that no monitor takes (``plan_of``,
    ``fields_of``) and for a state of more than ``most_bytes``.
    """
    plans = plans_of({identifier: formula for identifier, (_, formula) in formulas.items()}, dt)
    monitors = tuple(
        StreamMonitor(identifier, text, plans[identifier]) for identifier, (text, _) in formulas.items()
    )
    for monitor in monitors:
        if monitor.memory > most_bytes:
            steps = sum(node.kept for node in monitor.plan.nodes)
            raise InputError(
                f"{monitor.told}: at a step of {float(dt):g} s the monitor needs {monitor.memory} bytes, to "
                f"remember {steps} values, and the limit is {most_bytes}; raise --memory, shorten the "
                "intervals or take a longer --dt"
            )
    return CSource(name, dt, monitors, fields_of(formula for _, formula in formulas.values()))


def _header(source: CSource) -> Iterator[str]:
    name, big = source.name, source.name.upper()
    step = f"Monitors for samples every {float(source.dt):g} s, made by roadproof."
    yield from _comment(
        f"{step} C99, no allocation, no library.",
        f"Compile with {FLAGS}: arithmetic then is that of roadproof's monitor to the last bit.",
        "A sample is rejected where a value is no finite number, a size is not greater than 0, or a signal "
        "is outside of its declared range. From then on every verdict is UNKNOWN, until reset.",
    )
    yield from ("", f"#ifndef {big}_H", f"#define {big}_H", "", "#include <stdint.h>", "")
    yield from ("#ifdef __cplusplus", 'extern "C" {', "#endif", "")
    yield f"typedef enum {{ {big}_FALSE, {big}_UNKNOWN, {big}_TRUE }} {name}_verdict;"
    yield from ("", *_comment("One sample; a flag is 0 or not."), "typedef struct {")
    for field in source.fields.values():
        yield f"    {'uint8_t' if field.flag else 'double'} {field.name}; /* {_comment_text(field.about)} */"
    if not source.fields:
        yield "    uint8_t unused;"
    yield f"}} {name}_sample;"
    for monitor in source.monitors:
        yield from ("", *_declarations(source, monitor))
    yield from ("", "#ifdef __cplusplus", "}", "#endif", "", "#endif", "")


def _declarations(source: CSource, monitor: StreamMonitor) -> Iterator[str]:
    big, plan = monitor.identifier.upper(), monitor.plan
    yield from _comment(monitor.told, _verdict_note(monitor, source.dt))
    yield f"#define {big}_DELAY {plan.delay}u"
    yield f"#define {big}_REST {monitor.rest}u"
    yield f"#define {big}_BYTES {monitor.memory}u"
    yield "typedef struct {"
    yield from (f"    {member.declaration}" for member in members_of(plan))
    yield f"}} {monitor.identifier}_state;"
    yield from (f"{head};" for head in heads(source.name, monitor))


def _verdict_note(monitor: StreamMonitor, dt: Fraction) -> str:
    """Return the note on the subject of verdicts and the cost of a sample."""
    plan = monitor.plan
    late = f"{plan.delay} samples ({float(plan.delay * dt):g} s)"
    work = f" A sample costs {plan.look_ups} look-ups in tables." if plan.look_ups else ""
    cost = f"finish costs as much as {2 * plan.delay} samples and changes nothing: call it at any time.{work}"
    if plan.at_start:
        return (
            f"Verdicts are about the first sample. step returns one at most {late} after the samples decide "
            "it, and the same from then on. finish writes the verdict on the samples so far, at once, and "
            f"returns 1. {cost}"
        )
    if not plan.delay:
        return "step returns the verdict about its sample. finish writes none, and returns 0."
    return (
        f"step returns the verdict about the sample {late} before, and UNKNOWN while there is none. finish "
        f"writes the verdicts about the last samples, at most {plan.delay}, UNKNOWN where later samples "
        f"decide, and returns how many. {cost}"
    )


def _source(source: CSource) -> str:
    parts = []
    for monitor in source.monitors:
        parts.append("\n".join([*_comment(monitor.told), functions(source.name, monitor, source.fields)]))
    body = "\n\n".join(parts)
    helpers = helpers_for(body)
    more = "#include <math.h>\n" if "INFINITY" in helpers else ""
    return _FRAME.format(name=source.name, more=more, body="\n\n".join(x for x in (helpers, body) if x))


def _comment(*paragraphs: str) -> Iterator[str]:
    lines = [line for text in paragraphs for line in wrap(_comment_text(text), 95)]
    ends = ["/* ", *(" * " for _ in lines[1:])]
    *first, last = (f"{begin}{line}" for begin, line in zip(ends, lines, strict=True))
    yield from (*first, f"{last} */")


def _comment_text(text: str) -> str:
    """Text for a comment, in which no comment begins or ends."""
    return text.replace("*/", "* /").replace("/*", "/ *")

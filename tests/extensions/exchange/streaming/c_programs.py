"""Monitors in C as programs: compiled, run on batches of traces, and compared with the monitor."""

import shutil
import subprocess
from collections.abc import Iterator, Sequence
from pathlib import Path

import numpy as np
import pytest

from roadproof.extensions.exchange.streaming.c_files import CSource
from roadproof.extensions.exchange.streaming.functions import StreamMonitor
from roadproof.logic import terms as t
from roadproof.logic.rewrite import without_names
from roadproof.semantics.sampled import Batch, compile

COMPILER = shutil.which("gcc") or shutil.which("clang") or shutil.which("cc")
needs_compiler = pytest.mark.skipif(COMPILER is None, reason="no C compiler: install gcc or clang")
STRICT = ("-std=c99", "-Wall", "-Wextra", "-Werror", "-pedantic", "-ffp-contract=off")
SANITIZED = (*STRICT, "-O1", "-g", "-fsanitize=address,undefined", "-fno-sanitize-recover=all")
FALSE, UNKNOWN, TRUE = range(3)

_HEAD = """\
#include "{name}.h"
#include <stdio.h>
#include <stdlib.h>

static void put(int verdict)
{{
    putchar(verdict);
}}
"""
_ROUND = """
static void run_{label}(const {name}_sample *samples, uint32_t count)
{{
    {label}_state state;
    {name}_verdict rest[{big}_REST];
    uint32_t k, i, left;
    {label}_reset(&state);
    for (k = 0; k < count; ++k) {{
        put({label}_step(&state, &samples[k]));
        for (i = 0; i < {big}_REST; ++i) {{
            rest[i] = 9;
        }}
        left = {label}_finish(&state, rest);
        put((int)left);
        for (i = 0; i < {big}_REST; ++i) {{
            put(rest[i]);
        }}
    }}
}}
"""


def _main(source: CSource) -> str:
    """A program that reads traces, and for each formula and sample writes what step and finish say."""
    name = source.name
    rounds = [_ROUND.format(name=name, label=x.identifier, big=x.identifier.upper()) for x in source.monitors]
    calls = "".join(f"        run_{x.identifier}(samples, count);\n" for x in source.monitors)
    return (
        _HEAD.format(name=name)
        + "".join(rounds)
        + f"""
int main(void)
{{
    uint32_t count;
    while (fread(&count, sizeof count, 1, stdin) == 1) {{
        {name}_sample *samples = malloc(count * sizeof *samples);
        if (samples == NULL || fread(samples, sizeof *samples, count, stdin) != count) {{
            return 1;
        }}
{calls}        free(samples);
    }}
    return 0;
}}
"""
    )


def build(source: CSource, folder: Path, flags: Sequence[str] = (*STRICT, "-O1")) -> Path:
    """The program of some monitors, compiled in ``folder``."""
    folder.mkdir(parents=True, exist_ok=True)
    for name, text in source.files.items():
        (folder / name).write_text(text)
    (folder / "main.c").write_text(_main(source))
    program = folder / "program"
    assert COMPILER is not None
    line = [COMPILER, *flags, str(folder / "main.c"), str(folder / f"{source.name}.c"), "-o", str(program)]
    made = subprocess.run(line, capture_output=True, text=True)
    assert made.returncode == 0, made.stderr
    return program


def samples_of(source: CSource, batch: Batch, trace: int) -> np.ndarray:
    """The samples of one trace as the C struct has them; what the batch has not is 0."""
    fields = [(x.name, "u1" if x.flag else "f8") for x in source.fields.values()] or [("unused", "u1")]
    length = int(batch.lengths[trace])
    made = np.zeros(length, dtype=np.dtype(fields, align=True))
    given = {without_names(formula): values for formula, values in batch.given.items()}
    for leaf, field in source.fields.items():
        match leaf:
            case t.Size(name, vehicle):
                made[field.name] = batch.sizes.get((name, vehicle), np.zeros(batch.traces))[trace]
            case t.Signal(name, vehicle) | t.CustomSignal(name, vehicle):
                columns = batch.signals.get((name, vehicle))
                made[field.name] = 0 if columns is None else columns[:length, trace]
            case _:
                made[field.name] = given[leaf][:length, trace] if leaf in given else 0
    return made


def said(source: CSource, program: Path, batch: Batch) -> dict[str, np.ndarray]:
    """As ``answers``, of the traces of a batch."""
    return answers(source, program, [samples_of(source, batch, k) for k in range(batch.traces)])


def answers(source: CSource, program: Path, traces: Sequence[np.ndarray]) -> dict[str, np.ndarray]:
    """By formula, what step said, how many verdicts finish wrote, and which: (sample, …, trace)."""
    fed = b"".join(np.uint32(len(x)).tobytes() + x.tobytes() for x in traces)
    ran = subprocess.run([str(program)], input=fed, capture_output=True)
    assert ran.returncode == 0, ran.stderr.decode()
    data, at, longest = np.frombuffer(ran.stdout, dtype=np.uint8), 0, max(map(len, traces))
    found = {x.identifier: np.full((longest, 2 + x.rest, len(traces)), 99) for x in source.monitors}
    for k, samples in enumerate(traces):
        for monitor in source.monitors:
            size = (2 + monitor.rest) * len(samples)
            found[monitor.identifier][: len(samples), :, k] = data[at : at + size].reshape(len(samples), -1)
            at += size
    assert at == len(data)
    return found


def expected(monitor: StreamMonitor, batch: Batch) -> Iterator[np.ndarray]:
    """The monitor's verdicts on all prefixes, the shortest first: (traces,), or at all samples of it."""
    made = compile({"it": monitor.plan.formula})
    seen = made.observe(batch)
    at = "start" if monitor.plan.at_start else "all"
    for n in range(1, batch.samples + 1):
        cut = seen.cut(np.minimum(batch.lengths, n))
        answer = made.evaluate(cut, at=at).answers["it"]
        yield np.where(answer.true, TRUE, np.where(answer.false, FALSE, UNKNOWN))


def differences(source: CSource, program: Path, batch: Batch) -> Iterator[str]:
    """Where C and the monitor part: at every sample of every trace, for step and for finish."""
    found = said(source, program, batch)
    for monitor in source.monitors:
        yield from parted(monitor, batch, found[monitor.identifier])


def parted(monitor: StreamMonitor, batch: Batch, found: np.ndarray) -> Iterator[str]:
    """As ``differences`` of one formula, with what was ``found``."""
    delay, right = monitor.plan.delay, list(expected(monitor, batch))
    for n, last in enumerate(right):
        inside = n < batch.lengths
        step, count, rest = found[n, 0], found[n, 1], found[n, 2:]
        if monitor.plan.at_start:
            before = right[n - delay] if n >= delay else np.full(batch.traces, UNKNOWN)
            late = (before == UNKNOWN) & ((step == UNKNOWN) | (step == last))
            wrong = (rest[0] != last) | (count != 1) | ~((step == before) | late)
        else:
            some = min(n + 1, delay)
            due = last[n - delay] if n >= delay else np.full(batch.traces, UNKNOWN)
            wrong = (step != due) | (count != some) | (rest[:some] != last[n + 1 - some : n + 1]).any(axis=0)
        for trace in np.flatnonzero(wrong & inside):
            yield f"{monitor.told}, trace {trace}, sample {n}: {found[n, :, trace]} for {last[..., trace]}"

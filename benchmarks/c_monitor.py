"""How fast monitors in C are: nanoseconds that a sample costs each of 7 scenarios, beside the monitor.

    python benchmarks/c_monitor.py [--traces N] [--compiler CC] [--flags '-O2 …'] [--json FILE]

The traces are those of ``benchmarks/monitor.py``. Every verdict of ``finish`` is compared with the monitor's.
"""

import argparse
import json
import shlex
import subprocess
import sys
import tempfile
from pathlib import Path
from time import perf_counter

import numpy as np
from monitor import random_batch, scenarios

from roadproof.extensions.exchange.streaming.c_files import FLAGS, CSource, compile_c
from roadproof.logic import terms as t
from roadproof.logic.rewrite import without_names
from roadproof.semantics.sampled import Batch, compile

ROUNDS = 5
_MAIN = """\
#define _POSIX_C_SOURCE 199309L
#include "monitor.h"
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

static double now(void)
{{
    struct timespec at;
    clock_gettime(CLOCK_MONOTONIC, &at);
    return (double)at.tv_sec * 1e9 + (double)at.tv_nsec;
}}

int main(int count, char **words)
{{
    const uint32_t traces = (uint32_t)atoi(words[1]), length = (uint32_t)atoi(words[2]);
    monitor_sample *samples = malloc((size_t)traces * length * sizeof *samples);
    double begin, took, best;
    uint32_t i, k, round;
    monitor_verdict rest[1];
    if (count != 3 || samples == NULL
        || fread(samples, sizeof *samples, (size_t)traces * length, stdin) != (size_t)traces * length) {{
        return 1;
    }}
{rounds}    return 0;
}}
"""
_ROUND = """\
    for (round = 0, best = 1e300; round < {rounds}; ++round) {{
        begin = now();
        for (i = 0; i < traces; ++i) {{
            {label}_state state;
            {label}_reset(&state);
            for (k = 0; k < length; ++k) {{
                {label}_step(&state, &samples[(size_t)i * length + k]);
            }}
            {label}_finish(&state, rest);
            if (round == 0) {{
                fputc(rest[0], stderr);
            }}
        }}
        took = (now() - begin) / ((double)traces * length);
        best = took < best && round > 0 ? took : best;
    }}
    printf("{label} %.1f\\n", best);
"""


def samples_of(source: CSource, batch: Batch) -> np.ndarray:
    """All traces one after the other as the C struct has them."""
    fields = [(x.name, "u1" if x.flag else "f8") for x in source.fields.values()]
    made = np.zeros((batch.traces, batch.samples), dtype=np.dtype(fields, align=True))
    given = {without_names(formula): values for formula, values in batch.given.items()}
    for leaf, field in source.fields.items():
        match leaf:
            case t.Size(name, vehicle):
                made[field.name] = batch.sizes[name, vehicle][:, None]
            case t.Signal(name, vehicle) | t.CustomSignal(name, vehicle):
                made[field.name] = batch.signals[name, vehicle].T
            case _:
                made[field.name] = given[leaf].T
    return made


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--traces", type=int, default=2_000)
    parser.add_argument("--samples", type=int, default=375)
    parser.add_argument("--compiler", default="cc")
    parser.add_argument("--flags", default=FLAGS)
    parser.add_argument("--json", type=Path)
    options = parser.parse_args()

    formulas = scenarios()
    batch = random_batch(formulas, options.traces, options.samples, 1)
    source = compile_c({name: (name, x) for name, x in formulas.items()}, batch.dt, "monitor", 65_536)
    with tempfile.TemporaryDirectory() as folder:
        home = Path(folder)
        for name, text in source.files.items():
            (home / name).write_text(text)
        rounds = "".join(_ROUND.format(label=name, rounds=ROUNDS) for name in formulas)
        (home / "main.c").write_text(_MAIN.format(rounds=rounds))
        line = [options.compiler, *shlex.split(options.flags), home / "main.c", home / "monitor.c"]
        subprocess.run([*line, "-o", home / "main"], check=True)
        size = (
            subprocess.run(
                [
                    options.compiler,
                    *shlex.split(options.flags),
                    "-c",
                    home / "monitor.c",
                    "-o",
                    home / "monitor.o",
                ],
                check=True,
            )
            and (home / "monitor.o").stat().st_size
        )
        words = [home / "main", str(options.traces), str(options.samples)]
        ran = subprocess.run(
            words, input=samples_of(source, batch).tobytes(), check=True, capture_output=True
        )

    found = np.frombuffer(ran.stderr, dtype=np.uint8).reshape(len(formulas), options.traces)
    start = perf_counter()
    monitor = compile(formulas).evaluate(batch)
    whole = (perf_counter() - start) * 1e9 / (batch.traces * batch.samples * len(formulas))
    for verdicts, answer in zip(found, monitor.answers.values(), strict=True):
        if not np.array_equal(verdicts, np.where(answer.true, 2, np.where(answer.false, 0, 1))):
            print("verdicts differ from those of the monitor", file=sys.stderr)
            return 30
    figures = {name: float(x) for name, x in (row.split() for row in ran.stdout.decode().splitlines())}
    for monitor_in_c in source.monitors:
        cost = f"{figures[monitor_in_c.label]:8.1f} ns a sample"
        print(f"{monitor_in_c.label:12s} {cost}, state {monitor_in_c.memory} bytes")
    print(f"monitor in Python, {batch.traces} traces at once: {whole:.1f} ns a sample and formula")
    print(f"{found.size} verdicts agree; monitor.o has {size} bytes")
    if options.json:
        options.json.write_text(json.dumps(figures, indent=2) + "\n")
    return 0


if __name__ == "__main__":
    sys.exit(main())

"""``python -m operators.agreement``: do all readers of formulas say the same of random formulas?

``--count`` formulas are read; with a C compiler their monitors in C are compiled and run, too, and with
ROADPROOF_RTAMT_PYTHON they are put to rtamt. The table is docs/data/tests/operators.csv.
"""

import argparse
import csv
import sys
import tempfile
from collections import Counter
from collections.abc import Iterator, Sequence
from pathlib import Path

from extensions.exchange.streaming.c_programs import COMPILER, build, differences
from operators import readers, rtamt_text
from operators.cases import DT, case
from roadproof.errors import InputError
from roadproof.extensions.exchange.streaming.c_files import compile_c
from roadproof.logic.formula import Formula

TABLE = Path(__file__).parents[2] / "docs/data/tests/operators.csv"
IN_ONE_PROGRAM = 50
PAIRS = {
    "monitor, windows cut at the end": "the definition read sample by sample",
    "monitor, three-valued": "the definition read sample by sample",
    "encoder": "the definition where the last sample lasts",
    "exact judge": "the same, on values that last until the next sample",
    "monitor in C": "the monitor, after each sample",
    "rtamt 0.4.10, discrete time": "the monitor, windows cut at the end",
}
"""Each reader, and with what it is compared."""


def compared(number: int) -> Iterator[tuple[str, int, int]]:
    """Yield each reader with how many verdicts were compared, and how many differ."""
    formula, batch = case(number)
    clip, truncated = (readers.recursive(formula, batch, x) for x in ("clip", "truncated"))
    pairs = {
        "monitor, windows cut at the end": (readers.monitored(formula, batch, "clip"), clip),
        "monitor, three-valued": (readers.monitored(formula, batch, "truncated"), truncated),
        "encoder": (readers.encoded(formula, batch), readers.lasting(formula, batch)),
        "exact judge": (
            readers.judged(formula, batch),
            readers.lasting(readers.for_steps(formula), batch),
        ),
    }
    for reader, (one, other) in pairs.items():
        every = [(x, y) for a, b in zip(one, other, strict=True) for x, y in zip(a, b, strict=True)]
        yield reader, len(every), sum(x != y for x, y in every)


def in_c(numbers: Sequence[int]) -> tuple[int, int, int]:
    """Return how many formulas C took, how many verdicts were compared, and how many differ."""
    taken: dict[str, Formula] = {}
    for number in numbers:
        formula = case(number)[0]
        try:
            compile_c({"it": ("it", formula)}, DT, "monitor", 65_536)
        except InputError:
            continue  # too many operators without a bound, or looking back at one
        taken[f"formula_{number}"] = formula
    source = compile_c({name: (name, x) for name, x in taken.items()}, DT, "monitor", 65_536)
    batch = case(numbers[0])[1]
    with tempfile.TemporaryDirectory() as folder:
        program = build(source, Path(folder), ("-std=c99", "-O0"))
        wrong = sum(1 for _ in differences(source, program, batch))
    return len(taken), len(taken) * int(batch.lengths.sum()), wrong


def in_rtamt(numbers: Sequence[int]) -> tuple[int, int, int]:
    """Return how many formulas rtamt reads alike, how many verdicts were compared, and how many differ."""
    asked: list[tuple[str, dict[str, list[float]]]] = []
    expected: list[list[bool | None]] = []
    formulas = 0
    for number in numbers:
        formula, batch = case(number)
        longest = int(batch.lengths.argmax())
        try:
            text = rtamt_text.rtamt_text(formula)
        except rtamt_text.NoTextError:
            continue
        if batch.lengths[longest] == 1:
            continue  # on a single sample rtamt ends with an error
        formulas += 1
        asked.append((text, {x: list(y) for x, y in readers.trace(batch, longest).items()}))
        expected.append(readers.monitored(formula, batch, "clip")[longest])
    found = rtamt_text.verdicts(asked)
    pairs = [(x, y) for a, b in zip(found, expected, strict=True) for x, y in zip(a, b, strict=True)]
    return formulas, len(pairs), sum(x != y for x, y in pairs)


def rows(count: int) -> Iterator[tuple[str, str, int, int, int]]:
    """Yield for each reader: with what it is compared, formulas, verdicts, differences."""
    verdicts, wrong = Counter[str](), Counter[str]()
    for number in range(count):
        for reader, asked, different in compared(number):
            verdicts[reader] += asked
            wrong[reader] += different
        if number % 500 == 499:
            print(f"{number + 1} formulas read, {wrong.total()} differences", file=sys.stderr)
    for reader in verdicts:
        yield reader, PAIRS[reader], count, verdicts[reader], wrong[reader]
    if COMPILER is not None:
        batches = [range(k, min(count, k + IN_ONE_PROGRAM)) for k in range(0, count, IN_ONE_PROGRAM)]
        sums = [sum(x) for x in zip(*map(in_c, batches), strict=True)]
        yield "monitor in C", PAIRS["monitor in C"], *sums  # type: ignore[misc]
    if rtamt_text.PYTHON:
        reader = "rtamt 0.4.10, discrete time"
        yield reader, PAIRS[reader], *in_rtamt(range(count))


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--count", type=int, default=20_000, help="formulas (default: 20000)")
    parser.add_argument("--out", type=Path, default=TABLE, help="the table")
    given = parser.parse_args()
    with given.out.open("w", newline="", encoding="utf-8") as file:
        table = csv.writer(file, lineterminator="\n")
        table.writerow(("reader", "compared with", "formulas", "verdicts", "differences"))
        for row in rows(given.count):
            table.writerow(row)
            print(*row, sep=" · ")


if __name__ == "__main__":
    main()

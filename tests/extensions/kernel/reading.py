"""Printed text read by Coq: as the tree that was printed, and as a claim about traces of steps."""

import re
from collections.abc import Mapping, Sequence
from fractions import Fraction
from pathlib import Path

from extensions.kernel import raw
from roadproof.extensions.kernel.coq import ready
from roadproof.extensions.kernel.printer import FIXED_SPACE, Formals, Printer
from roadproof.extensions.kernel.source import HEAD, Module
from roadproof.logic.formula import Formula

SOURCES = Path(__file__).parents[3] / "proofs" / "kernel"
STEPS = SOURCES / "Steps.v"


def monitor_theory() -> str:
    """Recorded.v and Monitor.v as one text, for Coq without compiled files of them."""
    texts = [(SOURCES / f"{name}.v").read_text("ascii") for name in ("Recorded", "Monitor")]
    return "\n".join(texts).replace("From Roadproof Require Import Recorded.\n", "")


def printed(number: int, formula: Formula, formals: Formals) -> str:
    """A module with the formula as its claim."""
    printer = Printer(formals)
    shown = printer.formula(formula)
    body = [*printer.things, *printer.definitions, f"Definition claim : formula := {shown}."]
    return f"Module m{number}.\n" + "\n".join(body).replace(FIXED_SPACE, " ") + f"\nEnd m{number}.\n"


def compared(formulas: Sequence[Formula], formals: Formals) -> str:
    """A file in which Coq says of each printed formula whether it is the one of ``raw``."""
    out = [HEAD]
    for number, formula in enumerate(formulas):
        out.append(printed(number, formula, formals))
        out.append(f"Definition raw{number} : formula := {raw.formula(formula)}.\n")
    pairs = "; ".join(f"same m{n}.claim raw{n}" for n in range(len(formulas)))
    return "".join(out) + f"Eval vm_compute in [{pairs}].\n"


def answers(source: str) -> list[str]:
    """The words of the lists that Coq computes in a file. Raises ``AssertionError`` where it refuses it."""
    with ready() as coq:
        ran = coq.run(source)
    assert ran.code == 0, ran.errors[:500]
    return re.findall(r"\b(true|false|None)\b", re.sub(r": list .*", "", ran.output))


CLOSING = "\nQed.\nEnd "


def sort_out(accepted: Sequence[Module], refused: Sequence[Module]) -> None:
    """Raises ``AssertionError`` unless Coq takes the theorems of the first and none of the others.

    All stand in one file; where ``judge`` is asked, each that is refused costs a file of its own.
    """
    texts = [x.text for x in accepted]
    for x in refused:
        assert x.text.count(CLOSING) == 1
        texts.append(x.text.replace(CLOSING, "\nFail Qed.\nAbort.\nEnd "))
    with ready() as coq:
        ran = coq.run(HEAD + "".join(texts))
    assert ran.code == 0, ran.errors[:500]


# --- traces --------------------------------------------------------------------------------------


def judged(
    pairs: Sequence[tuple[Formula, Sequence[Mapping[str, object]]]],
    dt: Fraction,
    parameters: Mapping[str, Fraction],
) -> str:
    """A file in which Coq says of each formula whether it is true on each of its traces.

    A trace is plain data: ``signals`` by ``s(SV)`` and the like, with their values, and ``sizes``.
    """
    steps = STEPS.read_text("ascii")
    out = [steps, HEAD, f"Definition parametric_ : string -> Q := {_chosen(parameters)}.\n"]
    for number, (formula, traces) in enumerate(pairs):
        out.append(printed(number, formula, {}))
        asked = "; ".join(_trace(x, dt) for x in traces)
        out.append(f"Eval vm_compute in (map (fun t => answer t m{number}.claim) [{asked}]).\n")
    return "".join(out)


def _trace(trace: Mapping[str, object], dt: Fraction) -> str:
    signals, sizes = trace["signals"], trace["sizes"]
    last = len(next(iter(signals.values()))) - 1
    course = _by_name(signals, raw.SIGNALS | {"": "Own _"}, lambda x: f"[{'; '.join(map(_q, x))}]", "[]")
    sized = _by_name(sizes, raw.SIZES, _q, _q(Fraction(1)))
    return f"(Build_trace {_q(dt)} {last}%nat {course} {sized} parametric_)"


def _by_name(values, words, shown, other):
    """A function of a word and a vehicle."""
    found = other
    for vehicle in sorted({key.partition("(")[2].removesuffix(")") for key in values}):
        known = {name: values[key] for name in words if (key := f"{name}({vehicle})") in values}
        cases = " | ".join(
            f"{word} => {shown(known[x]) if x in known else other}" for x, word in words.items()
        )
        found = f'if String.eqb a "{vehicle}" then match n with {cases} end else {found}'
    return f"(fun n a => {found})"


def _chosen(values: Mapping[str, Fraction]) -> str:
    found = _q(Fraction(0))
    for name, value in values.items():
        found = f'(if String.eqb p "{name}" then {_q(value)} else {found})'
    return f"(fun p => {found})"


def _q(value: Fraction) -> str:
    return f"(Qmake ({value.numerator})%Z {value.denominator}%positive)"

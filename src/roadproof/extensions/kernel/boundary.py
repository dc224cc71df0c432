"""The check by Coq of a driver model's boundary: a formula holds in a state exactly if the motion collides.

The formula is printed like that of any claim. The motion is defined in proofs/kernel/Prescribed.v. The proof
uses a theorem about numbers from proofs/kernel/Boundary.v, Following.v or Responding.v.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

from roadproof.evidence.kernels import KernelVerdict
from roadproof.extensions.kernel.accept import AXIOMS, axioms_of
from roadproof.extensions.kernel.coq import Coq
from roadproof.extensions.kernel.names import literal
from roadproof.extensions.kernel.printer import Printer
from roadproof.extensions.kernel.source import claim_lines, claim_text, comment_lines, wrapped
from roadproof.extensions.kernel.statement import bounds_of, formals_of
from roadproof.library.elaborate import read_claim
from roadproof.library.specification import Specification
from roadproof.logic.rewrite import parameters_of
from roadproof.reasons import NO_REASON, Reason, ReasonKind

_HEAD = """\
From Coq Require Import Reals QArith String List.
From Roadproof Require Import Meaning Text.
From Roadproof Require Prescribed Boundary Following Responding Aeb Reading.
Import ListNotations.
Open Scope string_scope.
Open Scope nat_scope.
Open Scope term_scope.
Open Scope formula_scope.
"""
# The motions in a cut-in and in a deceleration.
_IN = "{p}cut_in W now ({p}DRIVER) {a} {b}"
_BEHIND = "{p}decelerates W now ({p}DRIVER) {a} {b}"
_READINGS = ("aeb", "gate", "perception", "threshold")
# What Prescribed.v calls the readings of AEB.
_AEB = {"replace": "in_place", "max": "greater", "add": "together"}


@dataclass(frozen=True)
class _BoundaryProof:
    """A theorem of a file in proofs/kernel, and the motion of Prescribed.v that it is about.

    In ``motion``, {p} is the prefix of names from Prescribed.v; {a}, {b} and {c} are vehicles. ``at_most``:
    two parameters of which the first must not exceed the second.
    """

    theorem: str
    motion: str
    at_most: tuple[str, str] | None = None

    def of(self, vehicles: Sequence[str], prefix: str = "") -> str:
        """Return the motion of these vehicles."""
        return self.motion.format(p=prefix, a=vehicles[0], b=vehicles[1], c=vehicles[-1])


@dataclass(frozen=True)
class Boundary:
    """A ``formula`` about ``vehicles``, SV first, that holds in a state exactly if a ``course`` from it
    collides.

    A model drives SV. ``course`` and ``model`` have their names on the command line: ``cut-in``, ``careful``.
    """

    course: str
    model: str
    formula: str
    vehicles: tuple[str, ...]


@dataclass(frozen=True)
class BoundaryTheorem:
    """The theorem that ``formula`` holds in a state if and only if ``motion`` collides, given the
    ``supposed``.

    ``source``: the file for Coq, with the printed formula and the proof.
    """

    formula: str
    motion: str
    supposed: tuple[str, ...]
    source: str

    def __str__(self) -> str:
        return f"{' and '.join(self.supposed)} -> ({self.formula} <-> {self.motion})"


@dataclass(frozen=True)
class BoundaryRuling:
    """Coq's verdict on the boundary of a model; ``theorem`` is None if the kernel has none."""

    model: str
    verdict: KernelVerdict
    theorem: BoundaryTheorem | None = None
    reason: Reason = NO_REASON
    axioms: tuple[str, ...] = ()
    seconds: float = 0.0

    @property
    def source(self) -> str:
        """The file for Coq; empty if there is no theorem."""
        return "" if self.theorem is None else self.theorem.source

    def __str__(self) -> str:
        if self.theorem is None or self.verdict is not KernelVerdict.ACCEPTED:
            return f"kernel: {self.verdict}  boundary of {self.model}: {self.reason}"
        axioms = ", ".join(self.axioms) or "none"
        return (
            f"kernel: {self.verdict}  boundary of {self.model}, for all states and parameters:\n"
            f"  {self.theorem}\n  axioms: {axioms}"
        )


def theorem_for(specification: Specification, boundary: Boundary) -> BoundaryTheorem | None:
    """Return the theorem about a boundary; None if the kernel has none.

    Raises ``InputError`` for a formula that cannot be printed.
    """
    entry = _entry(boundary.course, boundary.model, specification.options)
    if entry is None:
        return None
    vehicles = boundary.vehicles
    query = read_claim(specification, boundary.formula)
    printer = Printer(formals_of(specification))
    claim = claim_text(printer, query.formula)
    names = tuple(printer.vehicle(x) for x in vehicles)
    bounds = bounds_of(specification, parameters_of(query.formula))
    # The vehicle in the middle of a cut-out says by its place alone when the other is seen.
    places = (0, len(vehicles) - 1)
    source = [
        *comment_lines([f"{boundary.model}, {boundary.course}:", _options_text(specification.options)]),
        *claim_lines(claim, bounds),
        "",
        *_theorem(printer, entry, names, [names[x] for x in places]),
    ]
    return BoundaryTheorem(
        boundary.formula,
        entry.of(vehicles).replace(" W now", ""),
        (
            *(f"v_lon({vehicles[x]}) >= 0" for x in places),
            *([" <= ".join(entry.at_most)] if entry.at_most else []),
        ),
        _HEAD + "\n".join(source) + "\n",
    )


def judge_boundary(coq: Coq, specification: Specification, boundary: Boundary) -> BoundaryRuling:
    """Return Coq's ruling on a boundary."""
    model = boundary.model
    theorem = theorem_for(specification, boundary)
    if theorem is None:
        return BoundaryRuling(model, KernelVerdict.UNKNOWN, reason=_no_theorem(boundary, specification))
    run = coq.run(theorem.source)
    if run.code:
        reason = ReasonKind.COQ_SAYS(" ".join(run.errors.split()))
        return BoundaryRuling(model, KernelVerdict.REFUSED, theorem, reason, seconds=run.seconds)
    axioms = axioms_of(run.output)
    if axioms is None or set(axioms) - AXIOMS:
        reason = ReasonKind.AXIOMS(", ".join(axioms or ("unknown axioms",)))
        return BoundaryRuling(model, KernelVerdict.REFUSED, theorem, reason, seconds=run.seconds)
    return BoundaryRuling(model, KernelVerdict.ACCEPTED, theorem, NO_REASON, axioms, run.seconds)


def _no_theorem(boundary: Boundary, specification: Specification) -> Reason:
    return ReasonKind.NO_THEOREM(boundary.course, _options_text(specification.options))


def _entry(course: str, model: str, options: Mapping[str, str]) -> _BoundaryProof | None:
    aeb, gate, perception, threshold = (options[f"cc_{x}"] for x in _READINGS)
    gated = "no_gate" if gate == "none" else gate
    match course, model:
        case "cut-in", "r157" | "eu1426":
            return _BoundaryProof(f"Boundary.{model}_boundary", _IN.replace("DRIVER", f"{model} W now {{a}}"))
        case "cut-in", "rss":
            return _BoundaryProof("Responding.rss_boundary", _IN.replace("DRIVER", "rss W now {a}"))
        case "cut-in", "careful" if aeb == "none":
            driver = f"careful W now {{p}}by_{perception} {{p}}{gated} {{a}} {{b}}"
            return _BoundaryProof("Boundary.unaided_boundary", _IN.replace("DRIVER", driver))
        case "cut-in", "careful" if aeb != "add" or gate == "none":
            reading = f"{{p}}{_AEB[aeb]} {{p}}by_{perception} {{p}}{gated}"
            driver = f"careful_with_aeb W now {reading} {{a}} {{b}}"
            return _BoundaryProof(
                "Aeb.aeb_boundary", _IN.replace("DRIVER", driver), ("cc_braking", "aeb_braking")
            )
        case "cut-out", "careful":
            motion = "{p}cut_out W now ({p}careful_behind W now {a}) {a} {b} {c}"
            return _BoundaryProof("Boundary.cut_out_boundary", motion)
        case "deceleration", "careful":
            only_hard = str(threshold == "hard").lower()
            driver = f"careful_following W now {only_hard} {{a}} {{b}}"
            return _BoundaryProof("Following.following_boundary", _BEHIND.replace("DRIVER", driver))
        case "deceleration", "rss":
            driver = "rss_following W now {a}"
            return _BoundaryProof("Responding.rss_following_boundary", _BEHIND.replace("DRIVER", driver))
        case _:  # open: courses and models for which the kernel has no theorem
            return None


def _theorem(
    printer: Printer, entry: _BoundaryProof, names: Sequence[str], moving_forward: Sequence[str]
) -> Iterator[str]:
    yield "Theorem proved : forall (W : world) (named : string -> element W) (now : R), respects W bounds ->"
    for word in moving_forward:
        yield f"  (0 <= Prescribed.speed W now {word})%R ->"
    if entry.at_most is not None:
        low, high = map(literal, entry.at_most)
        yield f"  (parameter W {low} <= parameter W {high})%R ->"
    yield f"  (holds W named (unbound W) now claim <-> {entry.of(names, 'Prescribed.')})."
    yield "Proof."
    yield "  intros W named now B. unfold respects, bounds in B. Roadproof.Reading.bounds_in B. intros."
    yield f"  eapply iff_trans; [|apply Roadproof.{entry.theorem}; repeat split; assumption]."
    printed_names = [x.split()[1] for x in (*printer.things, *printer.definitions)]
    unfolded = " ".join(x for x in printed_names if x not in names)
    yield from wrapped(f"  cbv beta iota zeta delta [claim {unfolded}].")
    yield "  Roadproof.Reading.reads."
    yield "Qed."
    yield "Print Assumptions proved."


def _options_text(options: Mapping[str, str]) -> str:
    return ", ".join(f"{x}={y}" for x, y in sorted(options.items()) if x.startswith("cc_"))

"""Formulas of driver models against the motions of proofs/kernel/Prescribed.v, as Coq proves them."""

from functools import cache
from pathlib import Path

import pytest

import roadproof as rp
from extensions.kernel.needs import needs_coq
from extensions.kernel.reading import answers, compared
from roadproof.evidence.kernels import KernelVerdict
from roadproof.extensions.drivers.manoeuvres import MANOEUVRES
from roadproof.extensions.drivers.models import unpreventable
from roadproof.extensions.kernel.boundary import Boundary, judge_boundary, theorem_for
from roadproof.extensions.kernel.coq import Coq, CoqRun, ready
from roadproof.extensions.kernel.printer import FIXED_SPACE, Printer
from roadproof.extensions.kernel.statement import formals_of
from roadproof.library.elaborate import read_claim
from roadproof.library.loading import load_library
from roadproof.library.specification import Library, Source, Specification

PERCEPTIONS, GATES = ("time", "distance", "overlap"), ("none", "before_perception", "before_delay")
CELLS = [
    ("cut-in", "r157", {}),
    ("cut-in", "eu1426", {}),
    *(("cut-in", "careful", {"cc_perception": x, "cc_gate": y}) for x in PERCEPTIONS for y in GATES),
    *(("cut-in", "careful", {"cc_aeb": x}) for x in ("replace", "max", "add")),
    ("cut-in", "careful", {"cc_aeb": "max", "cc_gate": "before_delay", "cc_perception": "overlap"}),
    ("cut-in", "careful", {"cc_aeb": "replace", "cc_gate": "before_perception", "cc_perception": "distance"}),
    ("cut-out", "careful", {}),
    ("deceleration", "careful", {"cc_threshold": "any"}),
    ("deceleration", "careful", {"cc_threshold": "hard"}),
    ("cut-in", "rss", {}),
    ("deceleration", "rss", {}),
]
WITHOUT = [
    ("cut-in", "careful", {"cc_aeb": "add", "cc_gate": "before_delay"}),
    ("cut-in", "fsm", {}),
]


@cache
def library(*changes: str) -> Library:
    sources = [Source(f"changed-{k}.spec", x) for k, x in enumerate(changes)]
    return load_library([Path("driver"), *sources])


def specification(options: dict[str, str], *changes: str) -> Specification:
    return library(*changes).select("base", options)


def boundary(manoeuvre: str, model: str) -> Boundary:
    vehicles = MANOEUVRES[manoeuvre].vehicles
    return Boundary(manoeuvre, model, unpreventable(manoeuvre, model, vehicles), vehicles)


@needs_coq
@pytest.mark.parametrize(("manoeuvre", "model", "options"), CELLS)
def test_formula_and_motion_are_proved_equal(manoeuvre, model, options):
    with ready() as coq:
        ruling = judge_boundary(coq, specification(options), boundary(manoeuvre, model))
    assert ruling.verdict is KernelVerdict.ACCEPTED, ruling.reason
    assert "<->" in str(ruling)
    assert "ClassicalDedekindReals.sig_forall_dec" in ruling.axioms


@pytest.mark.parametrize(("manoeuvre", "model", "options"), CELLS)
def test_the_theorem_speaks_of_the_formula_of_the_specification(manoeuvre, model, options):
    """Its text is the printer's, definition by definition, and nothing is between it and the claim."""
    home = specification(options)
    formula = read_claim(home, unpreventable(manoeuvre, model, MANOEUVRES[manoeuvre].vehicles)).formula
    printer = Printer(formals_of(home))
    claim = printer.formula(formula).replace(FIXED_SPACE, " ")
    source = theorem_for(home, boundary(manoeuvre, model)).source
    flat = " ".join(source.split())
    for definition in (*printer.things, *printer.definitions):
        assert " ".join(definition.replace(FIXED_SPACE, " ").split()) in flat
    assert f"Definition claim : formula := {claim}." in flat
    assert source.count("Definition claim ") == source.count("holds W named (unbound W) now claim <->") == 1


@needs_coq
def test_printed_boundaries_are_read_back():
    home = specification({})
    said = {unpreventable(x, y, MANOEUVRES[x].vehicles) for x, y, _ in CELLS}
    formulas = [read_claim(home, x).formula for x in sorted(said)]
    assert answers(compared(formulas, formals_of(home))) == ["true"] * len(formulas)


# A strict comparison made wide, a forgotten ramp, another gap, a delay that is left out.
WRONG = [
    (
        "cut-in",
        "eu1426",
        "def stillFaster(v, w: m/s, q, y: s, W: unitless, T: s, A: m/s^2)\n"
        "  := v > w and (y <= q or (2*(v - w) >= A*T and 2*A*(y - q) <= W*(2*(v - w) + A*T))\n"
        "     or (2*(v - w) < A*T and A*(y - q)^2 < 2*T*W^2*(v - w)))",
    ),
    (
        "cut-in",
        "r157",
        "def r157_in(a, b: vehicle, y: m, w: m/s) := comesIn(a, b, y, w) and hits(v_lon(a), v_lon(b),\n"
        "  gapTo(a, b), bothLengths(a, b), intrusion(y)/(1 m/s), y/(1 m/s), w/(1 m/s), 0 s, r157_braking)",
    ),
    (
        "cut-out",
        "careful",
        "def careful_out(a, c: vehicle, w: m/s) := w > 0 and gains(v_lon(a), v_lon(c),\n"
        "  gapTo(a, c) + length(a),\n"
        "  (cc_wander + (cc_evaluation + cc_delay)*w)/(1 m/s), w/(1 m/s), cc_ramp, cc_braking)",
    ),
    (
        "deceleration",
        "careful",
        "def gainsBraking(v, w: m/s, b: m/s^2, g: m, q, T: s, A: m/s^2)\n"
        "  := standsLater(v, w, b, g, q, T, A) or meetsInFull(v, w, b, g, q, T, A)",
    ),
    (
        "cut-in",
        "careful",
        "when cc_aeb = none {\n"
        "  def careful_aided(v, u: m/s, g, y, z: m, w: m/s) := aidedLate(v, u, g, y, z, w)\n}",
    ),
    (
        "cut-in",
        "rss",
        "def rss_gains(v, u: m/s, g, y: m, w: m/s) := v > u\n"
        "  and 2*b_min*(w*(g - a_max*rho^2/2) - (v - u)*(y + rho*w)) < w*(v + a_max*rho - u)^2",
    ),
    (
        "cut-out",
        "careful",
        "def gainsByRamp(u: m/s, g: m, q: s, W: unitless, T: s, A: m/s^2)\n"
        "  := W*g < u*q or 8*A*(W*g - u*q)^2 < 8*T*W^2*u^3",
    ),
]


@needs_coq
@pytest.mark.parametrize(("manoeuvre", "model", "changed"), WRONG)
def test_another_formula_is_not_proved(manoeuvre, model, changed):
    with ready() as coq:
        ruling = judge_boundary(coq, specification({}, changed), boundary(manoeuvre, model))
    assert ruling.verdict is KernelVerdict.REFUSED
    assert "coqc says" in str(ruling)


@pytest.mark.parametrize("said", ["Axioms:\nnobody.knows : False\n", "no word of axioms"])
def test_a_proof_on_other_axioms_is_refused(said):
    class Other(Coq):
        def run(self, source: str) -> CoqRun:
            return CoqRun(0, said, "", 0.1)

    ruling = judge_boundary(Other("coqc", "8.16", Path()), specification({}), boundary("cut-in", "r157"))
    assert ruling.verdict is KernelVerdict.REFUSED


@needs_coq
def test_a_theory_with_another_motion_does_not_compile():
    """The motion is no more than the proofs need: braking in half the ramp is another boundary."""
    theories = Path(__file__).parents[3] / "proofs" / "kernel"
    text = (theories / "Prescribed.v").read_text("ascii")
    changed = text.replace("then A * s / T else A.", "then A * s / (2 * T) else A.")
    assert changed != text
    braking = (
        (theories / "Braking.v").read_text("ascii").replace("From Roadproof Require Import Prescribed.", "")
    )
    with ready() as coq:
        assert coq.run(text + braking).code == 0
        assert coq.run(changed + braking).code != 0


@pytest.mark.parametrize(("manoeuvre", "model", "options"), WITHOUT)
def test_other_boundaries_have_no_theorem(manoeuvre, model, options):
    assert theorem_for(specification(options), boundary(manoeuvre, model)) is None


@needs_coq
@pytest.mark.parametrize("rates", [5, [5, 10]])
def test_a_braking_that_grows_has_no_theorem(rates):
    """The formula and the motion of a braking that is there at once say nothing of its plates."""
    found = rp.preventable(
        "deceleration", ["careful"], at={"dGdt": rates}, lines=2, lemmas=False, kernel="coq", jobs=1
    )
    [ruling] = found.boundaries
    assert ruling.verdict is KernelVerdict.UNKNOWN
    assert ruling.reason.startswith("no theorem for gradual-deceleration ")

"""Instants that no derivation names: irrational ones, and what comes right after an instant, put to Coq.

On the drive s(SV) = t^2/2 - 1, which is 0 at the square root of 2, and v_lon(SV) = t.
"""

from dataclasses import replace
from fractions import Fraction

import pytest

import roadproof as rp
from extensions.kernel.needs import needs_coq, needs_ocaml
from extensions.kernel.test_drives import ONE, accepted_whole, refused
from roadproof.evidence.countermodel import NOWHERE
from roadproof.evidence.drive_file import load_drive
from roadproof.evidence.judged import judge_file
from roadproof.extensions.kernel import extracted, ocaml
from roadproof.extensions.kernel.derivation import coq_derivation
from roadproof.extensions.kernel.derivations.derive import derive
from roadproof.extensions.kernel.derivations.parts import NoDerivationError
from roadproof.extensions.kernel.derivations.prepare import prepare
from roadproof.extensions.kernel.drive import drive_statement
from roadproof.extensions.kernel.world import world_lines
from roadproof.frontends.api.checking import check
from roadproof.library.loading import bundled_library
from roadproof.reasons import ReasonKind
from roadproof.world.drive import Drive

# Each true of the drive, with the rule that it takes.
TRUE = {
    "F (s(SV) >= 0 m and s(SV) <= 0 m)": "Crossing",
    "F[1 s, 2 s] (s(SV) >= 0 m and s(SV) <= 0 m)": "Crossing",
    "not G (s(SV) > 0 m or s(SV) < 0 m)": "Crossing",
    "(s(SV) < 0 m) U (s(SV) >= 0 m)": "Crossing",
    "(s(SV) < 0 m) U[1 s, 3 s] (s(SV) <= 0 m and 0 m <= 2*s(SV))": "Crossing",
    "not ((s(SV) <= 0 m) U (s(SV) > 0 m))": "Crossing",
    "not ((s(SV) < 0 m) U[0 s, 2 s] (s(SV) > 0 m))": "Crossing",
    "not ((v_lon(SV) <= 1 m/s) U (v_lon(SV) > 1 m/s))": "Soon",
    "not ((v_lon(SV) <= 1 m/s) U[0.5 s, 2 s] (v_lon(SV) > 1 m/s))": "Soon",
    "G[2 s, rho] false": "Plain",
    "not F[2 s, rho] true and not (true U[2 s, rho] true)": "Plain",
}
# Each false of the drive, and near to one of them.
FALSE = (
    "F (s(SV) >= 0 m and s(SV) <= 0 m and v_lon(SV) < 1 m/s)",
    "F[0 s, 1 s] (s(SV) >= 0 m and s(SV) <= 0 m)",
    "F[2 s, 3 s] (s(SV) >= 0 m and s(SV) <= 0 m)",
    "(s(SV) < 0 m) U (s(SV) > 0 m)",
    "(v_lon(SV) < 1 m/s) U (s(SV) >= 0 m)",
    "not ((s(SV) <= 0 m) U (s(SV) >= 0 m))",
    "not ((v_lon(SV) <= 1 m/s) U (v_lon(SV) >= 1 m/s))",
    "F[2 s, rho] true",
    "not G[2 s, rho] false",
)


def file_of(formula):
    one = load_drive(ONE)
    motion = replace(one.drive.vehicles["SV"], s=Fraction(-1), v_lon=Fraction(0))
    last = replace(motion.pieces[-1], duration=None, a_lon=Fraction(1))
    drive = Drive({"SV": replace(motion, pieces=(last,))})
    return replace(one, scenario=None, drive=drive, formula=formula, values={"rho": Fraction(1)})


def derived(formula):
    what = drive_statement(file_of(formula), bundled_library())
    return what, derive(what.formula, what.file.drive, what.file.road, what.file.lanes, what.values)


@pytest.mark.parametrize(("formula", "rule"), TRUE.items())
def test_a_derivation_is_found_by_the_rule_for_it(formula, rule):
    assert judge_file(file_of(formula), bundled_library()).accepted
    assert f"rule='{rule}'" in str(derived(formula)[1])


@pytest.mark.parametrize("formula", FALSE)
def test_what_is_false_has_no_derivation(formula):
    ruling = judge_file(file_of(formula), bundled_library())
    assert ruling.reason.kind is ReasonKind.DOES_NOT_HOLD
    with pytest.raises(NoDerivationError):
        derived(formula)


def wrong(step):
    """The derivation with one step of Soon or Crossing told something else, or put in another place."""
    if step.rule == "Soon":
        begin, end = step.arguments
        yield replace(step, arguments=(end, begin))
        yield replace(step, arguments=("3", "4"))
    if step.rule == "Crossing":
        begin, end, polynomial = step.arguments
        yield replace(step, arguments=(end, begin, polynomial))
        yield replace(step, arguments=("0", "1", polynomial))
        yield replace(step, arguments=("3", "4", polynomial))
        yield replace(step, arguments=(begin, end, "[-7; 0; 5]"))
        yield replace(step, arguments=(begin, end, "[]"))
    for place, child in enumerate(step.children):
        for other in wrong(child):
            yield replace(step, children=(*step.children[:place], other, *step.children[place + 1 :]))


@needs_coq
def test_coq_accepts_these_and_refuses_them_changed():
    """Refused are the formulas that are false, by every derivation, and wrong derivations of true ones."""
    made, asked, count = [], [], 0
    for place, (formula, rule) in enumerate(TRUE.items()):
        what, derivation = derived(formula)
        accepted = prepare(f"m{place}", what.file, bundled_library()).module
        assert accepted is not None
        others = ["\n".join(coq_derivation(x)) for x in wrong(derivation)]
        assert others or rule == "Plain"
        count += len(others)
        asked = [("the_drive", "claim", x) for x in others]
        made += [accepted, refused(f"n{place}", what, derivation, asked)]
    assert count >= 30
    accepted_whole(made)


@needs_coq
def test_a_false_formula_is_refused_with_the_derivations_of_true_ones():
    made = []
    derivations = ["\n".join(coq_derivation(derived(x)[1])) for x in TRUE]
    for place, formula in enumerate(FALSE):
        what = drive_statement(file_of(formula), bundled_library())
        asked = [("the_drive", "claim", x) for x in derivations]
        made.append(refused(f"m{place}", what, derived(next(iter(TRUE)))[1], asked))
    accepted_whole(made)


@needs_ocaml
def test_the_extracted_program_agrees():
    modules = {
        f"m{place}": prepare(f"m{place}", file_of(x), bundled_library(), extracted.drive)
        for place, x in enumerate(TRUE)
    }
    with ocaml.ready() as program:
        judged = extracted.judge(program, modules)
    assert {str(x) for x in judged.rulings.values()} == {"accepted"}


# --- Drives of no vehicle on no road ----------------------------------------------------------------

CLAIMS = ("false", "rho < 1 s", "F[0 s, 1 s] some M in lanes: false", "F[rho, 2 s] true")


def nowhere(formula, rho):
    one = file_of(formula)
    return replace(one, lanes={}, values={"rho": Fraction(rho)}, road=NOWHERE, drive=Drive({}))


@needs_coq
@needs_ocaml
@pytest.mark.parametrize("claim", CLAIMS)
def test_a_drive_that_refutes_a_claim_about_no_vehicle_is_accepted(claim, tmp_path):
    found = rp.prove(f"assuming motion: {claim}", jobs=1, out=tmp_path)
    assert (str(found.verdict), found.rows()[0]["refuted_by"]) == ("REFUTED", "drive")
    for kernel in ("coq", "extracted"):
        (finding,) = check(tmp_path, kernel=kernel, jobs=1).findings
        assert (str(finding.outcome), finding.kernel) == ("accepted", "accepted"), finding.reason


@needs_coq
def test_a_claim_that_is_true_on_no_road_is_refused():
    """By the derivation that it is false with other values of parameters."""
    made = []
    for place, (claim, rho) in enumerate([("rho < 1 s", "1/2"), ("F[rho, 2 s] true", "1")]):
        what = drive_statement(nowhere(f"not ({claim})", 3), bundled_library())
        derivation = derive(what.formula, what.file.drive, what.world.road, {}, what.values)
        other = drive_statement(nowhere(f"not ({claim})", rho), bundled_library())
        printed = " ".join(["(", *world_lines(other.world), ")"])
        made.append(refused(f"m{place}", what, derivation, [(printed, "claim", "reasons")]))
    accepted_whole(made)

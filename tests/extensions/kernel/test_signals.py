"""Signals of a specification, kinds of vehicles and jerk, in claims and drives that are put to Coq."""

import random
from dataclasses import replace
from fractions import Fraction

import roadproof as rp
from examples import some
from extensions.kernel.drives import (
    HEAD,
    ROAD,
    agrees_with_the_judge,
    cases,
    derived,
    example,
    own_asked,
    own_drives,
)
from extensions.kernel.needs import needs_coq
from judge.cases import formulas, jerk_comparisons, jerk_drives
from roadproof.evidence.kernels import KernelVerdict
from roadproof.extensions.kernel.accept import judge, prepare
from roadproof.extensions.kernel.coq import ready
from roadproof.library.bind import bind
from roadproof.semantics.exact import judge as judge_drive
from roadproof.world.drive import Drive

SPEC = """
signal red: bool "the light is red"
signal gap(a: vehicle): m in [-50, 500] "to the line"
signal pull(a: vehicle): m/s^3 in [-15, 15] "how fast its acceleration changes"
signal hard(a: vehicle): bool derived by abs(pull(a)) > 5 m/s^3
def runsRed(a: vehicle) := gap(a) > 0 U (red and gap(a) <= 0)
"""
TRUE = [
    "runsRed(SV) -> F red",
    "runsRed(SV) -> F gap(SV) <= 0 m",
    "G (hard(SV) -> pull(SV) <= 15 m/s^3)",
    "G gap(SV) - gap(POV) <= 550 m",
    "F not red or G[1 s, 2 s] red",
    "kind(SV) = truck -> G not kind(SV) = car",
    "kind(SV) = kind(POV) and kind(POV) = bus -> kind(SV) = bus",
    "G j_lon(SV) > 1 m/s^3 -> F j_lon(SV) > 0 m/s^3",
]


def library(tmp_path, text=SPEC):
    (tmp_path / "own.spec").write_text(text, "utf-8")
    return rp.load(specs=[tmp_path / "own.spec"])


@needs_coq
def test_what_a_drive_with_jerk_shows_coq_accepts():
    """Comparisons of any degree up to six in time, with irrational instants."""
    given = cases(some(40), formulas(jerk_comparisons, leaves=4, past=False), jerk_drives)
    agrees_with_the_judge(given, len(given) - 4)


@needs_coq
def test_what_drives_with_own_signals_and_kinds_show_coq_accepts():
    given = cases(some(50), own_asked, own_drives)
    agrees_with_the_judge(given, len(given) - 4)


def damaged(drive):
    """The drive with a value of a signal, a kind or a jerk changed."""
    for key, course in drive.custom_signals.items():
        for place, (start, value) in enumerate(course):
            other = Fraction(1) - value if key == ("red", "") else 1 - value
            yield Drive(
                drive.vehicles,
                {**drive.custom_signals, key: (*course[:place], (start, other), *course[place + 1 :])},
            )
    for name, motion in drive.vehicles.items():
        yield Drive({**drive.vehicles, name: replace(motion, kind="bus")}, drive.custom_signals)
        for place, piece in enumerate(motion.pieces[:-1]):
            pieces = (
                *motion.pieces[:place],
                replace(piece, j_lon=piece.j_lon + 5),
                *motion.pieces[place + 1 :],
            )
            yield Drive({**drive.vehicles, name: replace(motion, pieces=pieces)}, drive.custom_signals)


@needs_coq
def test_a_damaged_drive_is_refused():
    """With the derivation of the drive as it was."""
    out, count = [HEAD], 0
    for formula, drive in cases(120, own_asked, own_drives):
        derivation = derived(formula, drive)
        for other in damaged(drive) if derivation is not None else ():
            if not judge_drive(bind(formula, ROAD, {}, {}), other).holds:
                out.append(example(f"no_{count}", formula, other, derivation, False))
                count += 1
    assert count >= 20
    with ready() as coq:
        ran = coq.run("".join(out))
    assert (ran.code, ran.errors) == (0, "")


@needs_coq
def test_claims_with_own_signals_and_kinds_are_accepted(tmp_path):
    found = rp.prove(*TRUE, using=library(tmp_path), kernel="coq", drive=False, jobs=1)
    assert [str(x) for x in found.kernel.rulings.values()] == ["accepted"] * len(TRUE)


@needs_coq
def test_a_proof_that_needs_a_declared_bound_fails_without_it(tmp_path):
    """The same certificates, read with a specification that declares wider bounds, or none."""
    claims = [x for x in TRUE if "15" in x or "550" in x]
    found = rp.prove(*claims, using=library(tmp_path), kernel="coq", drive=False, jobs=1)
    certificates = [x.certificate for x in found.answers]
    wider = library(tmp_path, SPEC.replace("[-15, 15]", "[-15, 16]").replace("in [-50, 500]", ""))
    prepared = {f"n{k}": prepare(f"n{k}", x, wider.library) for k, x in enumerate(certificates)}
    with ready() as coq:
        judged = judge(coq, prepared)
    assert len(claims) == 2
    assert [x.verdict for x in judged.rulings.values()] == [KernelVerdict.UNKNOWN, KernelVerdict.UNKNOWN]


ATOMS = [
    "red",
    "gap(SV) > 3 m",
    "kind(SV) = truck",
    "pull(SV) <= 15 m/s^3",
    "hard(SV)",
    "not red",
    "gap(POV) < 501 m",
]


def random_claims(count):
    """Claims that hold for reasons of time, of bounds, of both."""
    r = random.Random(7)
    atom = lambda: r.choice(ATOMS)  # noqa: E731
    forms = [
        lambda p, q, x: f"G[0 s, {x} s] ({p}) -> F ({p} or {q})",
        lambda p, q, x: f"({p}) U[0 s, {x} s] ({q}) -> F[0 s, {x} s] ({q})",
        lambda p, q, x: f"G ({p}) and F ({q}) -> F ({p} and {q})",
        lambda p, q, x: f"G (pull(SV) < {15 + x} m/s^3 or {p})",
        lambda p, q, x: f"kind(SV) = bus and F ({p}) -> F (not kind(SV) = car and ({p}))",
        lambda p, q, x: f"not F[0 s, {x} s] ({p}) <-> G[0 s, {x} s] not ({p})",
    ]
    return [r.choice(forms)(atom(), atom(), r.randint(1, 9)) for _ in range(count)]


@needs_coq
def test_random_claims_are_accepted(tmp_path):
    claims = [*dict.fromkeys(random_claims(30))]
    found = rp.prove(*claims, using=library(tmp_path), kernel="coq", drive=False, jobs=1)
    assert len(claims) >= 25
    assert [str(x) for x in found.kernel.rulings.values()] == ["accepted"] * len(claims)

"""Traces that refute claims, put to Coq: accepted where the claim is false on them, and refused elsewhere."""

from dataclasses import replace
from fractions import Fraction

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

import roadproof as rp
from extensions.kernel import raw
from extensions.kernel.drives import HEAD
from extensions.kernel.needs import needs_coq, needs_ocaml
from judge.cases import comparisons, formulas
from roadproof.evidence.countermodel import Countermodel, Instant, Loop, trace_data
from roadproof.evidence.finding import Acceptance
from roadproof.evidence.kernels import KernelVerdict
from roadproof.evidence.refutation import when_true
from roadproof.extensions.kernel.coq import ready
from roadproof.extensions.kernel.derivation import DerivationStep, Later, coq_derivation, sign, timed
from roadproof.extensions.kernel.derivations.derive import derive_on
from roadproof.extensions.kernel.derivations.prepare import prepare_trace
from roadproof.extensions.kernel.derivations.traces import TraceShapes
from roadproof.extensions.kernel.trace import TraceQuestion, TraceStatement, trace_statement, world_of
from roadproof.extensions.kernel.world import ANYWHERE, world_lines
from roadproof.frontends.api.checking import check
from roadproof.library.loading import bundled_library
from roadproof.logic import formula as f
from roadproof.logic import terms as t

FALSE = [
    "v_lon(SV) > 0 -> G v_lon(SV) > 0",
    "F danger(SV,POV) -> danger(SV,POV)",
    "atLane(SV,L) -> G atLane(SV,L)",
    "(some l in lanes: atLane(SV,l)) -> every l in lanes: atLane(SV,l)",
    "F[0, 2 s] a_lon(SV) > 1 m/s^2 -> G[1 s, 2 s] a_lon(SV) > 1 m/s^2",
    "kind(SV) = truck -> F kind(POV) = truck",
    "(v_lon(SV) > 3 m/s U[1 s, 2 s] v_lon(SV) > 6 m/s) -> v_lon(SV) > 3 m/s",
    "scenario_1(SV,POV,L) -> scenario_4(SV,POV,L)",
    "given v: m/s: v_lon(SV) > v -> v_lon(POV) > v",
]
REPEATING = [
    "G F v_lon(SV) > 3 m/s -> F G v_lon(SV) > 3 m/s",
    "(G F atLane(SV,L)) -> F G atLane(SV,L)",
    "(G F[0, 2 s] v_lon(SV) > 3 m/s) -> v_lon(SV) > 3 m/s or F G v_lon(SV) > 3 m/s",
    "G (v_lon(SV) > 3 m/s -> F v_lon(SV) < 2 m/s) -> not G F v_lon(SV) > 3 m/s",
]


@needs_coq
@needs_ocaml
def test_refuting_traces_of_proofs_are_accepted(tmp_path):
    every = FALSE + REPEATING
    found = rp.prove(*every, drive=False, out=tmp_path, jobs=1)
    assert {str(x) for x in found.verdicts.values()} == {"REFUTED"}
    for kernel in ("coq", "extracted"):
        findings = check(tmp_path, kernel=kernel, jobs=1).findings
        assert [(x.outcome, x.kernel) for x in findings] == [(Acceptance.ACCEPTED, "accepted")] * len(every)


# --- random traces -------------------------------------------------------------------------------

states = st.fixed_dictionaries(
    {
        f"{name}({vehicle})": st.integers(-3, 6).map(Fraction)
        for name in ("s", "d", "v_lon", "v_lat", "a_lon", "a_lat")
        for vehicle in "AB"
    }
)
times = st.sets(st.integers(1, 6), max_size=3).map(lambda x: [Fraction(n, 2) for n in sorted({0, *x})])


@st.composite
def traces(draw, repeating=False):
    instants = [Instant(time, draw(states), {}, draw(st.one_of(st.none(), states))) for time in draw(times)]
    if not repeating:
        return Countermodel(tuple(instants), {}, draw(st.sampled_from(["before", "after"])))
    start, more = draw(st.sampled_from([x.time for x in instants])), Fraction(draw(st.integers(1, 4)), 4)
    loop = Loop(start, instants[-1].time - start + more)
    return Countermodel(tuple(instants), {}, "before", loop=loop)


def is_true(formula, trace):
    return when_true(formula, trace).at(Fraction(0))


def cases(count, repeating):
    """Triples of a formula, a trace on which it is false, and another one on which it is true, or None."""
    found = []

    @settings(
        max_examples=count,
        derandomize=True,
        database=None,
        deadline=None,
        suppress_health_check=list(HealthCheck),
    )
    @given(
        formulas(comparisons, leaves=5, past=False),
        traces(repeating),
        st.lists(traces(repeating), min_size=4, max_size=4),
    )
    def collect(formula, trace, others):
        formula = f.Not(formula) if is_true(formula, trace) else formula
        found.append((formula, trace, next((x for x in others if is_true(formula, x)), None)))

    collect()
    return found


def refuted_by(formula, trace):
    world = world_of(trace, ("A", "B"), (), ANYWHERE, {})
    return TraceStatement("", "base", trace, formula, world, {}, {})


def example(name, what, derivation, answer):
    """That Coq's checker answers so of the opposite of a formula."""
    lines = [
        f"Definition {name} : drive :=",
        *world_lines(what.world),
        ".",
        f"Example {name}_is : accepts {name} [] (Not {raw.formula(what.formula)})",
        *coq_derivation(derivation),
        f"= {str(answer).lower()}.",
        "Proof. vm_compute. reflexivity. Qed.",
    ]
    return "\n".join(lines) + "\n"


@needs_coq
@pytest.mark.parametrize("repeating", [False, True])
def test_coq_says_of_random_traces_what_the_judge_says(repeating):
    """The same derivation is refused on a trace on which the formula is true."""
    given, out, damaged = cases(150 if repeating else 60, repeating), [HEAD], 0
    for number, (formula, trace, other) in enumerate(given):
        what = refuted_by(formula, trace)
        derivation = derive_on(TraceShapes({}, what), f.Not(formula), ANYWHERE, {})
        out.append(example(f"yes_{number}", what, derivation, True))
        if other is not None:
            out.append(example(f"no_{number}", refuted_by(formula, other), derivation, False))
            damaged += 1
    if repeating:
        assert min("".join(out).count(rule) for rule in ("(Round", "(Earlier")) >= 15
    assert len(given) >= 50
    assert damaged >= 15
    with ready() as coq:
        ran = coq.run("".join(out))
    assert (ran.code, ran.errors) == (0, "")


# --- rounds ----------------------------------------------------------------------------------------


def speeds(start, period, *values):
    """v_lon(A) is each of these for a second; from ``start`` on they repeat."""
    instants = (Instant(Fraction(k), {"v_lon(A)": Fraction(x)}, {}) for k, x in enumerate(values))
    return Countermodel(tuple(instants), {}, "before", loop=Loop(Fraction(start), Fraction(period)))


def window(low, high, body):
    return f.Eventually(f.Interval(t.Number(Fraction(low)), t.Number(Fraction(high))), body)


def fast(op, value):
    return f.Compare(t.Signal("v_lon", "A"), op, t.Number(Fraction(value)))


def after(seconds, step):
    return timed("Moment", Later(Fraction(seconds)), step)


def earlier(rounds, step):
    return DerivationStep("Earlier", (str(rounds),), (step,))


HALF = Fraction(1, 2)
ALTERNATING = speeds(0, 2, 1, 0)
SLOW_FOR_EVER = speeds(1, 1, 9, 0)
# What is asked, on which trace, by which derivation, and whether it is accepted.
ROUNDS = {
    "two seconds later": (window(2, 2, fast(">", 0)), ALTERNATING, after(2, earlier(1, sign(()))), True),
    "three rounds later": (window(7, 7, fast("<=", 0)), ALTERNATING, after(7, earlier(3, sign(()))), True),
    "too many rounds": (window(7, 7, fast("<=", 0)), ALTERNATING, after(7, earlier(4, sign(()))), False),
    "steps of the first round": (window(2, 2, fast("<=", 0)), ALTERNATING, after(2, sign(())), False),
    "before the rounds": (
        window(3 * HALF, 3 * HALF, fast(">", 3)),
        SLOW_FOR_EVER,
        after(3 * HALF, earlier(1, sign(()))),
        False,
    ),
    "looking back": (
        window(5 * HALF, 5 * HALF, window(-1, -1, fast(">", 3))),
        SLOW_FOR_EVER,
        after(5 * HALF, earlier(1, after(-1, sign(())))),
        False,
    ),
    "no rounds": (
        window(2, 2, fast("<=", 0)),
        replace(ALTERNATING, loop=None),
        after(2, earlier(1, sign(()))),
        False,
    ),
}


@needs_coq
def test_rounds_are_counted_within_what_repeats_and_only_ahead():
    out = [HEAD]
    for number, (formula, trace, derivation, answer) in enumerate(ROUNDS.values()):
        turned = DerivationStep("Turn", (), (DerivationStep("Turn", (), (derivation,)),))
        out.append(example(f"round_{number}", refuted_by(f.Not(formula), trace), turned, answer))
    with ready() as coq:
        ran = coq.run("".join(out))
    assert (ran.code, ran.errors) == (0, "")


# --- what is refused, and what is only unknown -----------------------------------------------------


def jumping(**changed):
    """v_lon(SV) is 1, 0 at 2 s, and 1 again after it."""
    at, after = {"v_lon(SV)": Fraction(1)}, {"v_lon(SV)": Fraction(0)}
    instants = (Instant(Fraction(0), at, {}), Instant(Fraction(2), after, {}, at))
    return replace(Countermodel(instants, {}, "before"), **changed)


def at(time):
    return Countermodel((Instant(time, {"v_lon(SV)": Fraction(0)}, {}),), {}, "before")


def sized(*lengths):
    instants = (Instant(Fraction(k), {"length(SV)": Fraction(x)}, {}) for k, x in enumerate(lengths))
    return Countermodel(tuple(instants), {}, "before")


def asked(claim, trace):
    return TraceQuestion(claim, "base", {}, (), trace_data(trace), "here")


def test_a_claim_that_is_true_on_its_trace_has_no_module():
    for claim, has in [("G v_lon(SV) > 0", True), ("G[0, 1 s] v_lon(SV) > 0", False)]:
        made = prepare_trace("one", asked(claim, jumping()), bundled_library())
        assert (made.module is not None) == has


@pytest.mark.parametrize(
    ("claim", "trace", "word", "reason"),
    [
        ("nobody(SV)", jumping(), KernelVerdict.REFUSED, "it cannot be put to the kernel"),
        (
            "G v_lon(SV) > 0",
            jumping(loop=Loop(Fraction(0), Fraction(2))),
            KernelVerdict.REFUSED,
            "repeats itself",
        ),
        ("given v: m/s: v > 0", jumping(), KernelVerdict.REFUSED, "does not say what v is"),
        ("G v_lon(SV) > 0", at(Fraction(1)), KernelVerdict.REFUSED, "must ascend from 0"),
        ("length(SV) > 0", sized(-1), KernelVerdict.REFUSED, "not greater than 0"),
        ("length(SV) > 0", sized(1, 2), KernelVerdict.REFUSED, "changes"),
    ],
)
def test_what_is_refused_or_unknown(claim, trace, word, reason):
    refusal = prepare_trace("one", asked(claim, trace), bundled_library()).refusal
    assert refusal.verdict is word
    assert reason in refusal.reason


def test_what_is_printed_says_claim_trace_and_theorem():
    text = prepare_trace("one", asked("G v_lon(SV) > 0", jumping()), bundled_library()).module.text
    assert "Definition claim : formula := G (v_lon SV > 0)." in text
    assert '(Speed_lon, "SV", [(0, 1, 1); (2, 0, 1)])' in text
    assert "Theorem proved : ~ Roadproof.Meaning.valid bounds claim." in text
    other = prepare_trace(
        "one", asked("G v_lon(SV) > 0", jumping(interpolation="after")), bundled_library()
    ).module.text
    assert '(Speed_lon, "SV", [(0, 1, 0); (2, 0, 1)])' in other
    assert [*trace_statement(asked("G v_lon(SV) > 0", jumping()), bundled_library()).world.vehicles] == ["SV"]

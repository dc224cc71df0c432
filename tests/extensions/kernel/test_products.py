"""Nonlinear facts about one instant: by sums of products that are found, and that Coq adds up again."""

import random
import re
from collections.abc import Iterator
from contextlib import ExitStack
from fractions import Fraction
from fractions import Fraction as F
from itertools import pairwise
from math import isqrt

import pytest
import z3

import roadproof as rp
from extensions.kernel.needs import needs_coq
from planting import plant
from roadproof.evidence.certificate_file import read_certificate
from roadproof.evidence.times import Moment
from roadproof.extensions.kernel import cone, source
from roadproof.extensions.kernel.accept import prepare
from roadproof.extensions.kernel.coq import ready
from roadproof.extensions.kernel.derivation import Crossing, Fixed, Later, Soon
from roadproof.extensions.kernel.derivation import DerivationMoment as DerivedMoment
from roadproof.extensions.kernel.derivations.parts import NoDerivationError, between, breaks, covered, moments
from roadproof.extensions.kernel.derivations.signs import TimePart
from roadproof.extensions.kernel.instant import find_instant_proof
from roadproof.extensions.kernel.linear import GOAL, LinearConstraints
from roadproof.extensions.kernel.source import HEAD
from roadproof.library.elaborate import read_claim
from roadproof.library.loading import bundled_library
from roadproof.logic.rewrite import without_names
from roadproof.runtime.package_data import shipped_folder
from roadproof.semantics.exact.algebraic import Point, Root
from roadproof.semantics.exact.truth import Cut, TruthSet

CLAIMS = """
given x, y: m: 2*x*y <= x^2 + y^2
given x, y: unitless: x >= 0.3*y + 0.7 and y >= x/7 - 0.1 and x >= 0 -> (x - 0.3*y)*(7.1*y - x + 0.71) >= 0
given x, y, z: m: x*y + y*z + z*x <= x^2 + y^2 + z^2
given u, v: m/s: 0 m/s <= u and u <= v and b_min <= b_max -> u^2/(2*b_max) <= v^2/(2*b_min)
given v: m/s; t: s: 0 s <= t and 0 m/s <= v -> v*t - b_max*t^2/2 <= v^2/(2*b_max)
given a, b: m/s: a > 0 m/s and b > 0 m/s -> (a + b)^2 > a^2 + b^2
given x: unitless: x^3 >= 0 -> x >= 0
given x: unitless: max(x, 0)*min(x, 0) = 0
G (v_lon(SV) > 2 m/s and s(POV) - s(SV) > 10 m -> (s(POV) - s(SV))*v_lon(SV) > 20 m * 1 m/s)
scenario_4(SV,POV,L) -> F (danger(SV,POV) and v_lon(SV)^2 + v_lon(POV)^2 >= 2*v_lon(SV)*v_lon(POV))
""".strip().splitlines()
# True, of degree 6, and no sum of squares (Motzkin).
NOT_FOUND = "given x, y: unitless: 3*x^2*y^2 <= x^4*y^2 + x^2*y^4 + 1"
BY_PRODUCTS = ("P7-left-base", "P8-rear-base", "P3-scenario-03-extA")


@needs_coq
def test_nonlinear_claims_of_users_are_accepted_by_products_alone_and_who_is_not_names_the_lemma():
    found = rp.prove(*CLAIMS, NOT_FOUND, kernel="coq", drive=False, jobs=1)
    said = [entry["kernel"]["says"] for entry in found.as_data()["verdicts"]]
    assert said == ["accepted"] * len(CLAIMS) + ["unknown (lemma 1)"]
    for answer, tactics in zip(found.answers, [0] * len(CLAIMS) + [1], strict=True):
        text = prepare("one", answer.certificate, found.library).module.text
        assert text.count("some_instant") == tactics
        assert text.count("Products.settled") >= 1 - tactics


FRACTIONS = CLAIMS[1]


def test_multipliers_are_whole_numbers():
    """Coq multiplies fractions much more slowly; only what makes a given constraint whole may be one."""
    texts = [prepare("one", _proved(claim), bundled_library()).module.text for claim in CLAIMS[:4]]
    text = " ".join(" ".join(texts).split())
    assert set(re.findall(r"\(number_ \d+ (\d+)\)(?! \(given_)", text)) == {"1"}
    assert len(set(re.findall(r"\(number_ \d+ \d+\) \(given_", text))) > 3


@needs_coq
@pytest.mark.parametrize(
    ("right", "wrong"), [("q / prod(", "q * prod("), ("len(self.scales) - 1 - place", "place")]
)
def test_sums_that_are_written_wrongly_are_not_accepted(monkeypatch, right, wrong):
    name = "proof_text" if "prod" in right else "_given"
    plant(monkeypatch, cone.AbsurdSum, name, right, wrong)
    found = rp.prove(FRACTIONS, kernel="coq", drive=False, jobs=1)
    (entry,) = found.as_data()["verdicts"]
    assert entry["kernel"]["says"] in ("refused", "unknown (lemma 1)")


def test_of_a_large_fact_without_a_reason_the_tactics_are_not_asked(monkeypatch):
    found = rp.prove(NOT_FOUND, drive=False, jobs=1)
    certificate = found.answers[0].certificate
    assert "some_instant" in prepare("one", certificate, found.library).module.text
    monkeypatch.setattr(source, "MOST_COMPARISONS", 0)
    prepared = prepare("one", certificate, found.library)
    assert prepared.module is None
    assert str(prepared.refusal) == "unknown (lemma 1)"
    assert "more than 0 comparisons: Coq's own tactics are not asked" in prepared.refusal.reason
    assert prepare("one", _proved(CLAIMS[0]), found.library).module is not None


def _proved(claim):
    return rp.prove(claim, drive=False, jobs=1).answers[0].certificate


def module_of(name):
    certificate = read_certificate(shipped_folder("proofs") / f"{name}.json")
    return prepare("one", certificate, bundled_library()).module.text


def asked(text):
    """A module with the question whether its first reason is accepted, and that reason."""
    before, _, rest = text.partition("Lemma fact_1_holds")
    call = re.search(r"settled (bounds\s+\[.*?\]\s+fact_1)\s+(\(.*?\))\s+_\)\.\n\s+vm_cast", rest, re.DOTALL)
    return before, " ".join(call[1].split()), " ".join(call[2].split())


@needs_coq
@pytest.mark.parametrize("name", BY_PRODUCTS)
def test_changed_reasons_are_refused(name):
    """One number, sign, rule or case is another; what is accepted nevertheless is counted and told."""
    r = random.Random(name)
    text = module_of(name)
    assert "some_instant" not in text
    before, claimed, find_instant_proof = asked(text)
    numbers = re.finditer(r"\b\d+\b", find_instant_proof)
    changes = [(m.start(), m.end(), str(int(m[0]) + r.choice([1, 2]))) for m in numbers]
    changes += [(m.start(), m.end(), "false") for m in re.finditer(r"\btrue\b", find_instant_proof)]
    changes += [(m.start(), m.end(), f"{m[1]}0") for m in re.finditer(r"(\(Reads )\d+", find_instant_proof)]
    tried = [find_instant_proof] + [
        find_instant_proof[:i] + new + find_instant_proof[j:]
        for i, j, new in r.sample(changes, min(24, len(changes)))
    ]
    out = [HEAD, before]
    for place, changed in enumerate(tried):
        out.append(f"Definition reason_{place} : Roadproof.Products.reason := {changed}.\n")
        out.append(f"Eval vm_compute in (Roadproof.Products.settles {claimed} reason_{place}).\n")
    with ready() as coq:
        ran = coq.run("".join(out) + "End one.\n")
    assert ran.code == 0, ran.errors[:500]
    answers = re.findall(r"= (true|false)\n", ran.output)
    assert len(answers) == len(tried)
    assert answers[0] == "true"
    # A larger multiplier of what is at least 0, a size that is read twice: as good a proof.
    assert answers[1:].count("false") >= len(tried) * 2 // 3, answers


@pytest.mark.parametrize(
    "claim",
    [
        "given x: unitless: x^2 > 0",  # false where x is 0
        "given x, y: unitless: x*y <= x^2",
        "given x, y, z, w: unitless: ((x + y + z + w)^8)^8 + 1 > 0",  # too many products
        f"given x: unitless: x < {10**190}*{10**190} or x > 5",  # more than a float can say
    ],
)
def test_no_reason_is_found_for_what_is_false_or_too_large(claim):
    fact = without_names(read_claim(bundled_library().select(), claim).formula)
    assert find_instant_proof(fact, {}, ()) is None


# --- Linear constraints against z3: what follows is found, and its multipliers add up to something absurd


def moment(r):
    names = sorted(r.sample("abcde", r.randint(1, 3)))
    factors = [Fraction(r.choice([-2, -1, -1, 1, 1, 3])) / r.choice([1, 1, 2]) for _ in names]
    return Moment(tuple(zip(names, factors, strict=True)), Fraction(r.randint(-3, 3)))


def term(x):
    parts = (z3.RealVal(str(q)) * z3.Real(n) for n, q in x.parts)
    return sum(parts, z3.RealVal(str(x.constant)))


def holds(strict, x):
    return term(x) > 0 if strict else term(x) >= 0


def is_absurd(witness, constraints):
    total, strict = Moment(), False
    for number, factor in witness:
        assert factor > 0
        is_strict, x = constraints[number]
        total += Moment(tuple((n, factor * q) for n, q in x.parts), factor * x.constant)
        strict |= is_strict
    return not total.parts and (total.constant < 0 or (strict and total.constant == 0))


@pytest.mark.parametrize("seed", range(6))
def test_what_follows_is_found_with_multipliers(seed):
    r, found = random.Random(seed), 0
    for _ in range(10):
        linear, solver, constraints = LinearConstraints(), z3.Solver(), {}
        with ExitStack() as added:
            for number in range(r.randint(3, 10)):
                strict, x = r.random() < 0.4, moment(r)
                constraints[number] = (strict, x)
                solver.push()
                solver.add(holds(strict, x))
                inside = ExitStack()
                inside.enter_context(linear.taken_back())
                witness = linear.add(number, strict, x)
                assert (witness is not None) == (solver.check() == z3.unsat)
                if witness is not None:
                    assert is_absurd(witness, constraints)
                    inside.close()
                    solver.pop()
                    del constraints[number]
                    continue
                added.push(inside)
                for _ in range(4):
                    goal, above = moment(r), r.random() < 0.4
                    witness = linear.entails(goal, above)
                    solver.push()
                    solver.add(z3.Not(holds(above, goal)))
                    assert (witness is not None) == (solver.check() == z3.unsat)
                    solver.pop()
                    if witness is not None:
                        found += 1
                        assert is_absurd(witness, {**constraints, GOAL: (not above, Moment() - goal)})
    assert found > 3


# --- Parts of time with a moment that serves each, against sampling of random truth sets ------------

END = 12
STEP = F(1, 8)
MOST_LOST = 3
"""Of 400: a side that begins right after the last instant of the first window needs one moment for each."""


def truth(rng: random.Random, roots: float = 0.0, most: int = 6) -> TruthSet:
    """Of up to so many cuts at quarters, open and closed, single instants and gaps of one instant too.

    ``roots``: the share of cuts at square roots of whole numbers, which are irrational.
    """
    cuts = set()
    for _ in range(rng.randrange(most + 1)):
        point: Point = F(rng.randrange(0, 4 * END), 4)
        if rng.random() < roots:
            square = rng.choice([n for n in range(2, END**2) if isqrt(n) ** 2 != n])
            point = Root((-square, 0, 1), F(isqrt(square)), F(isqrt(square) + 1))
        cuts.add(Cut(point, rng.random() < 0.5))
    return TruthSet(tuple(sorted(cuts)))


def instants(begin: Cut, end: Cut | None) -> Iterator[F]:
    """Rational instants of a part: at its ends where they belong to it, and every 1/8 s between."""
    last = F(END) if end is None else end.point
    assert isinstance(begin.point, F)
    assert isinstance(last, F)
    time = begin.point
    while time <= last:
        if (time > begin.point or not begin.after) and (time < last or end is None or end.after):
            yield time
        time += STEP


def follow(parts: list[TimePart], whole: TimePart) -> None:
    """They begin and end where the whole does, and each where the one before ends."""
    assert (parts[0].begin, parts[-1].end) == (whole.begin, whole.end)
    for one, other in pairwise(parts):
        assert one.end == other.begin
        assert one.begin < other.begin


def at(moment: DerivedMoment, time: F) -> F:
    return moment.time if isinstance(moment, Fixed) else time + moment.time


def root_of(crossing: Crossing) -> Root:
    return Root(crossing.polynomial, crossing.begin, crossing.end)


def sampled(low: F, high: F) -> Iterator[F]:
    """From ``low`` on, before ``high``."""
    time = low
    while time < high:
        yield time
        time += STEP


def windows(rng: random.Random) -> tuple[F, F | None]:
    low = F(rng.randrange(0, 8), 4)
    return low, None if rng.random() < 0.2 else low + F(rng.randrange(0, 12), 4)


def whole(rng: random.Random) -> TimePart:
    begin = F(rng.randrange(0, 8), 4)
    if rng.random() < 0.2:
        return TimePart(Cut(begin, rng.random() < 0.5), None)
    after = rng.random() < 0.5
    end = begin + F(rng.randrange(1, 12), 4)
    return TimePart(Cut(begin, after), Cut(end, rng.random() < 0.5))


@pytest.mark.parametrize("roots", [0.0, 0.5])
@pytest.mark.parametrize("block", range(3))
def test_a_moment_of_a_part_serves_each_of_its_instants(block: int, roots: float) -> None:
    rng, found, refused, lost, crossings = random.Random(block), 0, 0, 0, 0
    for _ in range(60 if roots else 400):
        right, left, window, part = truth(rng, roots), truth(rng, roots), windows(rng), whole(rng)
        low, high = window
        try:
            made = [*moments(part, window, right, left)]
        except NoDerivationError:
            refused += 1
            lost += until_everywhere(part, window, right, left)
            continue
        found += 1
        follow([x for x, _ in made], part)
        for piece, moment in made:
            for time in instants(piece.begin, piece.end):
                if isinstance(moment, Crossing):
                    crossings += 1
                    assert time + low <= moment.begin
                    assert high is None or moment.end <= time + high
                    assert right.at(root_of(moment))
                    assert all(left.at(x) for x in (*sampled(time + low, moment.begin), moment.begin))
                    continue
                moved = at(moment, time)
                assert time + low <= moved, (piece, moment)
                assert high is None or moved <= time + high
                assert right.at(moved)
                assert all(left.at(x) for x in sampled(time + low, moved))
    assert found > 5
    assert refused > 5
    assert roots or lost <= MOST_LOST
    assert not crossings or roots


def until_everywhere(part: TimePart, window: tuple[F, F | None], right: TruthSet, left: TruthSet) -> bool:
    """Whether an until holds at all instants, by sampling at eighths: with cuts at quarters that is exact."""
    low, high = window
    for time in instants(part.begin, part.end):
        last = F(3 * END) if high is None else time + high
        good = False
        for moved in [*sampled(time + low, last), last]:
            if right.at(moved):
                good = True
                break
            if not left.at(moved):
                break
        if not good:
            return False
    return True


@pytest.mark.parametrize("roots", [0.0, 0.5])
@pytest.mark.parametrize("block", range(3))
def test_a_break_of_a_part_is_one_at_each_of_its_instants(block: int, roots: float) -> None:
    """The left side fails at the moment, and the right side does not come up to then; or it never comes."""
    rng, fixed, later, never_comes, lost = random.Random(100 + block), 0, 0, 0, 0
    for _ in range(60 if roots else 400):
        never, failing, window, part = truth(rng, roots), truth(rng, roots), windows(rng), whole(rng)
        low, high = window
        try:
            made = [*breaks(part, window, never, failing)]
        except NoDerivationError:
            lost += broken_everywhere(part, window, never, failing)
            continue
        follow([x for x, _ in made], part)
        for piece, moment in made:
            fixed += isinstance(moment, Fixed)
            later += isinstance(moment, Later)
            never_comes += moment is None
            for time in instants(piece.begin, piece.end):
                if moment is None:
                    last = F(3 * END) if high is None else time + high
                    assert all(never.at(x) for x in (*sampled(time + low, last), last))
                elif isinstance(moment, Soon | Crossing):
                    assert time + low <= moment.begin < moment.end
                    change = moment.begin if isinstance(moment, Soon) else root_of(moment)
                    assert all(
                        never.at(x) for x in (*sampled(time + low, moment.begin), moment.begin, change)
                    )
                    assert failing.at(between(change, moment.end))
                else:
                    moved = at(moment, time)
                    assert moved >= time + low
                    assert failing.at(moved)
                    assert all(never.at(x) for x in (*sampled(time + low, moved), moved))
    assert roots or min(fixed, later, never_comes) >= 3
    assert roots or lost <= MOST_LOST


def broken_everywhere(part: TimePart, window: tuple[F, F | None], never: TruthSet, failing: TruthSet) -> bool:
    """Whether at all instants the right side does not come, or the left one fails before."""
    low, high = window
    for time in instants(part.begin, part.end):
        last = F(3 * END) if high is None else time + high
        broken = True
        for moved in [*sampled(time + low, last), last]:
            if not never.at(moved):
                broken = False
                break
            if failing.at(moved):
                break
        if not broken:
            return False
    return True


@pytest.mark.parametrize("roots", [0.0, 0.5])
@pytest.mark.parametrize("block", range(2))
def test_each_covered_part_lies_in_its_set(block: int, roots: float) -> None:
    rng, found = random.Random(200 + block), 0
    for _ in range(60 if roots else 400):
        sets, part = [truth(rng, roots) for _ in range(3)], whole(rng)
        try:
            made = [*covered(part, sets)]
        except NoDerivationError:
            assert roots or not all(any(x.at(t) for x in sets) for t in instants(part.begin, part.end))
            continue
        found += 1
        follow([x for x, _ in made], part)
        for piece, place in made:
            for time in instants(piece.begin, piece.end):
                among = sets if isinstance(place, Root) else [sets[place]]
                assert any(x.at(time) for x in among), (piece, place)
            assert roots or not isinstance(place, Root)
    assert found > 5

"""Nonlinear facts about one instant: by sums of products that are found, and that Coq adds up again."""

import random
import re

import pytest

import roadproof as rp
from kernel.needs import needs_coq
from planting import plant
from roadproof.evidence.certificate import read_certificate
from roadproof.evidence.kernel import cone, source
from roadproof.evidence.kernel.accept import prepare
from roadproof.evidence.kernel.coq import ready
from roadproof.evidence.kernel.instant import reason
from roadproof.evidence.kernel.printer import Printer
from roadproof.evidence.kernel.source import HEAD
from roadproof.library.elaborate import read_claim
from roadproof.library.loading import bundled_library
from roadproof.logic.rewrite import without_names
from roadproof.runtime.package_data import shipped

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
# True, and products of more factors than are tried.
NOT_FOUND = "given v: m/s: 0 m/s <= v and b_min <= b_max -> 0 m <= dRSS_lon(v,v) - v*rho"
BY_PRODUCTS = ("P7-left-base", "P8-rear-base", "P3-scenario-03-extA")


@needs_coq
def test_nonlinear_claims_of_users_are_accepted_by_products_alone_and_who_is_not_names_the_lemma():
    found = rp.prove(*CLAIMS, NOT_FOUND, kernel="coq", drive=False, jobs=1)
    said = [entry["kernel"]["says"] for entry in found.as_data()["verdicts"]]
    assert said == ["accepted"] * len(CLAIMS) + ["unknown (lemma 1)"]
    for answer, tactics in zip(found.answers, [0] * len(CLAIMS) + [1], strict=True):
        text = prepare("one", answer.settled.result.certificate, found.study.library).module.text
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
    name = "written" if "prod" in right else "_given"
    plant(monkeypatch, cone.Sum, name, right, wrong)
    found = rp.prove(FRACTIONS, kernel="coq", drive=False, jobs=1)
    (entry,) = found.as_data()["verdicts"]
    assert entry["kernel"]["says"] in ("refused", "unknown (lemma 1)")


def test_of_a_large_fact_without_a_reason_the_tactics_are_not_asked(monkeypatch):
    found = rp.prove(NOT_FOUND, drive=False, jobs=1)
    certificate = found.answers[0].settled.result.certificate
    assert "some_instant" in prepare("one", certificate, found.study.library).module.text
    monkeypatch.setattr(source, "MOST_COMPARISONS", 1)
    prepared = prepare("one", certificate, found.study.library)
    assert prepared.module is None
    assert str(prepared.refusal) == "unknown (lemma 1)"
    assert "more than 1 comparisons: Coq's own tactics are not asked" in prepared.refusal.reason
    assert prepare("one", _proved(CLAIMS[0]), found.study.library).module is not None


def _proved(claim):
    return rp.prove(claim, drive=False, jobs=1).answers[0].settled.result.certificate


def module_of(name):
    certificate = read_certificate(shipped("proofs") / f"{name}.json")
    return prepare("one", certificate, bundled_library()).module.text


def asked(text):
    """A module with the question whether its first reason is accepted, and that reason."""
    before, _, rest = text.partition("Lemma fact_1_holds")
    call = re.search(r"settled (bounds \[.*?\] fact_1) (\(.*?\))\s+_\)\.\n\s+vm_cast", rest, re.DOTALL)
    return before, " ".join(call[1].split()), " ".join(call[2].split())


@needs_coq
@pytest.mark.parametrize("name", BY_PRODUCTS)
def test_changed_reasons_are_refused(name):
    """One number, sign, rule or case is another; what is accepted nevertheless is counted and told."""
    r = random.Random(name)
    text = module_of(name)
    assert "some_instant" not in text
    before, claimed, reason = asked(text)
    numbers = re.finditer(r"\b\d+\b", reason)
    changes = [(m.start(), m.end(), str(int(m[0]) + r.choice([1, 2]))) for m in numbers]
    changes += [(m.start(), m.end(), "false") for m in re.finditer(r"\btrue\b", reason)]
    changes += [(m.start(), m.end(), f"{m[1]}0") for m in re.finditer(r"(\(Reads )\d+", reason)]
    tried = [reason] + [
        reason[:i] + new + reason[j:] for i, j, new in r.sample(changes, min(24, len(changes)))
    ]
    out = [HEAD, before]
    for place, changed in enumerate(tried):
        out.append(f"Definition reason_{place} : Roadproof.Products.reason := {changed}.\n")
        out.append(f"Eval vm_compute in (Roadproof.Products.settles {claimed} reason_{place}).\n")
    with ready() as coq:
        ran = coq.run("".join(out) + "End one.\n")
    assert ran.code == 0, ran.complained[:500]
    answers = re.findall(r"= (true|false)\n", ran.said)
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
    printer = Printer()
    printer.formula(fact)
    assert reason(fact, {}, printer.term) is None

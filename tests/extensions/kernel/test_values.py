"""Values of parameters that a claim's own premise demands: Coq puts in these, and no others."""

from dataclasses import replace

import roadproof as rp
from extensions.kernel.needs import needs_coq
from extensions.kernel.reading import answers, printed, sort_out
from roadproof.extensions.kernel.accept import find_tableau, prepare
from roadproof.extensions.kernel.source import HEAD
from roadproof.library.elaborate import read_claim
from roadproof.library.loading import bundled_library
from tables import read_table

DEMANDED = read_table(__file__, "demanded")
SAID = read_table(__file__, "said")


@needs_coq
def test_proofs_with_demanded_values_are_accepted():
    said = rp.prove(*DEMANDED, kernel="coq", drive=False, jobs=1).as_data()["verdicts"]
    assert [x["kernel"]["says"] for x in said] == ["accepted"] * len(DEMANDED)


@needs_coq
def test_values_that_no_premise_demands_are_refused():
    """The same tableau, for a claim with another value, without a value, and with a value of its own."""
    (answer,) = rp.prove(DEMANDED[1], drive=False, jobs=1).answers
    certificate = answer.certificate
    assert certificate.pinned == ("minDanger = 0.6 s",)
    whole = replace(certificate, tableau=find_tableau(certificate, bundled_library()))
    text = prepare("one", whole, bundled_library()).module.text
    assert "minDanger >= (3 # 5)" in text
    assert '[("minDanger", (q 3 5))] claim tableau' in text
    others = []
    conclusion = whole.claim.partition("->")[2].strip()
    for claim in (conclusion, f"minDanger = 0.4 s -> {conclusion}", f"minDanger >= 0.6 s -> {conclusion}"):
        others.append(replace(whole, claim=claim))
    others.append(replace(whole, pinned=("minDanger = 0.7 s",)))
    sort_out(*([prepare(f"m{id(x)}", x, bundled_library()).module for x in y] for y in ([whole], others)))


@needs_coq
def test_which_values_a_claim_demands():
    """As Coq computes it: bounds from both sides, of what has to hold where the claim is false."""
    specification = bundled_library().select("base")
    modules = [
        printed(n, read_claim(specification, claim).formula, {}) for n, (claim, _, _) in enumerate(SAID)
    ]
    asked = "; ".join(
        f'Values.all_demanded [("minDanger", {value})%Q] m{n}.claim' for n, (_, value, _) in enumerate(SAID)
    )
    found = answers(f"{HEAD}{''.join(modules)}Eval vm_compute in [{asked}].\n")
    assert found == [str(demands).lower() for _, _, demands in SAID]

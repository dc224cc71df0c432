"""Claims with untils inside untils: Coq accepts their tableaux, and not those of others."""

from dataclasses import replace

import roadproof as rp
from extensions.kernel.needs import needs_coq
from extensions.kernel.reading import sort_out
from proving.claims import spelled
from roadproof.extensions.kernel.accept import find_tableau, prepare
from roadproof.library.loading import bundled_library
from tables import read_table

VALID = read_table(__file__, "valid")
FALSE = "(p or q) U r -> (p U q) U r"


@needs_coq
def test_untils_inside_untils_are_accepted():
    asked = {"using": rp.load("base"), "kernel": "coq", "drive": False, "jobs": 1}
    said = rp.prove(*map(spelled, VALID), **asked).as_data()["verdicts"]
    assert {x["claim"]: x["kernel"]["says"] for x in said} == dict.fromkeys(map(spelled, VALID), "accepted")


@needs_coq
def test_the_converse_is_refused_with_the_same_tableau():
    (answer,) = rp.prove(spelled(VALID[0]), using=rp.load("base"), drive=False, jobs=1).answers
    certificate = answer.certificate
    tableau = find_tableau(certificate, bundled_library())
    claims = {"right": certificate.claim, "wrong": spelled(FALSE)}
    asked = {x: replace(certificate, claim=y, tableau=tableau) for x, y in claims.items()}
    right, wrong = (prepare(x, y, bundled_library()).module for x, y in asked.items())
    sort_out([right], [wrong])

"""Claims with untils inside untils: Coq accepts their tableaux, and not those of others."""

from dataclasses import replace

import roadproof as rp
from kernel.needs import needs_coq
from kernel.test_accept import ruling
from proving.claims import spelled
from roadproof.evidence.kernel.accept import Word, find_tableau
from roadproof.library.loading import bundled_library
from tables import read_table

VALID = read_table(__file__, "valid")
FALSE = "(p or q) U r -> (p U q) U r"


def proved(*claims):
    return rp.prove(*map(spelled, claims), using=rp.load("base"), kernel="coq", drive=False, jobs=1)


@needs_coq
def test_untils_inside_untils_are_accepted():
    said = proved(*VALID).as_data()["verdicts"]
    assert {x["claim"]: x["kernel"]["says"] for x in said} == dict.fromkeys(map(spelled, VALID), "accepted")


@needs_coq
def test_the_converse_is_refused_with_the_same_tableau():
    (answer,) = proved(VALID[0]).answers
    certificate = answer.settled.result.certificate
    tableau = find_tableau(certificate, bundled_library())
    assert ruling(replace(certificate, tableau=tableau)).word is Word.ACCEPTED
    assert ruling(replace(certificate, claim=spelled(FALSE), tableau=tableau)).word is Word.REFUSED

"""Reads the certificate that decides a claim."""

from roadproof.evidence.answer import assumed_by, vacuities
from roadproof.evidence.certificate import Certificate
from roadproof.evidence.certificate_file import read_certificate_data
from roadproof.evidence.certify import fault_of_queries
from roadproof.evidence.claim import Claim, Exists, Valid
from roadproof.evidence.readers.about_claim import require, require_options, shortened
from roadproof.logic import formula as f
from roadproof.logic.formula import Formula
from roadproof.logic.parts import parts_of


def certificate_for(claim: Claim, content: object, where: str) -> Certificate:
    """Return the certificate of a file. Raises ``InputError`` if its queries do not follow from the claim."""
    file = read_certificate_data(content, where)
    require_options(claim, file.set_name, file.options, where)
    require(
        file.assumed.texts == assumed_by(claim) or _assumes_values(claim, file),
        where,
        f"it assumes {', '.join(file.assumed.texts) or 'nothing'}",
    )
    shown = claim.read(file.claim)
    claimed = (claim.formula, *(x.formula for x in vacuities(claim)))
    is_proof = isinstance(claim.mode, Valid) and shown in claimed
    require(is_proof or _denies_parts(claim, shown), where, f"it proves {shortened(file.claim)}")
    known = claim.query if file.claim == claim.text else None
    fault = fault_of_queries(file, claim.home.library, known)
    require(fault is None, where, "" if fault is None else fault[1])
    return file


def _assumes_values(claim: Claim, file: Certificate) -> bool:
    """Return whether a certificate about drives assumes the parameter values of its claim."""
    if not isinstance(claim.mode, Exists):
        return False
    from roadproof.evidence.assuming import values_of  # here: most certificates assume nothing

    return file.assumed.texts == values_of(claim)


def _denies_parts(claim: Claim, shown: Formula) -> bool:
    """Return whether a formula says that some conjuncts of a claim never hold together."""
    if not isinstance(claim.mode, Exists) or not isinstance(shown, f.Not):
        return False
    return {*parts_of(shown.body)} <= {*parts_of(claim.formula)}

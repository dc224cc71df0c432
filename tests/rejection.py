"""The verdict of the check of a certificate, for tests."""

from collections.abc import Callable

from roadproof.evidence.certificate import Certificate
from roadproof.evidence.certify import check_certificate
from roadproof.evidence.finding import Acceptance
from roadproof.library.specification import Library
from roadproof.reasons import Reason


def rejection_reason(certificate: Certificate, library: Library, ask: Callable[[str], str]) -> Reason | None:
    """Return why the certificate is not accepted; None if it is.

    ``ask`` answers sat, unsat or unknown to an SMT-LIB script.
    """
    outcome, reason = check_certificate(certificate, library, ask)
    return None if outcome is Acceptance.ACCEPTED else reason

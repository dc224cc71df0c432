"""Claims with assumptions, which are texts in the certificate and in the answer."""

from collections.abc import Mapping
from fractions import Fraction

from roadproof.evidence.claim import Claim, Exists, Valid, claim_of
from roadproof.library.assumption import assumes_motion
from roadproof.library.motion import under_limits, value_texts, values_in
from roadproof.library.specification import Query, Specification


def valid_under(
    specification: Specification,
    query: Query,
    assuming: tuple[str, ...] = (),
    within: Exists | None = None,
    at: Mapping[str, Fraction] | None = None,
) -> Claim:
    """Return the claim that ``query`` holds on all traces under the assumptions, or on all drives ``within``.

    ``at``: parameter values (SI) that differ from the declared ones, for drives only. Raises ``InputError``.
    """
    values = tuple(values_in(specification, assuming).items())
    restricted = under_limits(specification, query, assuming).formula if assuming else None
    mode = Valid(assumes_motion(assuming), values, restricted, within, tuple(assuming))
    return claim_of(specification, query, mode, (at or {}) if within is not None else {})


def values_of(claim: Claim) -> tuple[str, ...]:
    """Return the parameter values of a claim about drives as text, such as ``minDanger = 0.6 s``."""
    return value_texts(claim.home, {x.name: x.value for x in claim.parameters})

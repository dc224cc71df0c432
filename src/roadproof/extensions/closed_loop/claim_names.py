"""Names of claims about a vehicle under test: what a claim is about, then its target, then a driver model."""

POSSIBLE, SIMULATED, FAILS, SHOWN = "possible", "simulated", "fails", "shown"
"""What claims about a target are about: the beginning of their names."""
BREAKS, KEEPS = "breaks", "keeps"
"""What claims about an occurrence in a recording are about."""


def claim_name(part: str, target: str, driver: str = "") -> str:
    """Return the name of a claim about a target.

    >>> claim_name(FAILS, "scenario_4", "careful")
    'fails-scenario_4-careful'
    """
    return "-".join(filter(None, (part, target, driver)))

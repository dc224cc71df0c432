"""Shell completion of animation formats."""

from collections.abc import Mapping

from roadproof.frontends.report.animations import animations


def formats() -> Mapping[str, str]:
    """Return the formats of ``--animate``."""
    return dict.fromkeys(animations(), "")

"""What a shell completes formats of animations with."""

from collections.abc import Mapping

from roadproof.frontends.report.animations import animations


def formats() -> Mapping[str, str]:
    """The formats of ``--animate``."""
    return dict.fromkeys(animations(), "")

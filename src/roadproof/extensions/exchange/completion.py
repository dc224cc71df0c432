"""Formats for the completion of a shell."""

from collections.abc import Mapping

from roadproof.extensions.exchange.exporting import names


def formats() -> Mapping[str, str]:
    """The formats of ``roadproof export``."""
    return dict.fromkeys(names(), "")

"""Definitions with the words for requirements."""

from dataclasses import replace
from pathlib import Path

from roadproof.frontends.api.definitions import Definitions
from roadproof.library.loading import load_library
from roadproof.library.specification import read_specification

_WORDS = Path(__file__).with_name("closed_loop.spec")


def with_words(home: Definitions) -> Definitions:
    """Return definitions with the words for requirements, such as collision."""
    library, words = home.library, read_specification(_WORDS)
    if any(x.text == words.text for x in library.files):
        return home
    extended = load_library([*library.files, words])
    specification = extended.select(home.specification.set_name, home.specification.options)
    return replace(home, specification=specification)

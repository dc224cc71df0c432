"""The grammar, and a text that changes with all that a syntax tree depends on."""

import re
import sys
from functools import cache
from importlib.util import find_spec
from pathlib import Path

from roadproof.world.units import UNITS


@cache
def grammar() -> str:
    """The grammar as lark reads it."""
    text = Path(__file__).with_name("grammar.lark").read_text("utf-8")
    longest_first = sorted(UNITS, key=len, reverse=True)
    return text.replace("%UNITS%", "|".join(re.escape(x).replace("/", r"\/") for x in longest_first))


@cache
def version() -> str:
    """All that trees depend on besides the text: grammar, the source of what makes them, lark, Python."""
    here = Path(__file__).parent
    others = (here.parent / name for name in ("errors.py", "world/signals.py", "world/units.py"))
    sources = (path.read_text("utf-8") for path in sorted((*here.glob("*.py"), *others)))
    return "\0".join((grammar(), *sources, _version_of_lark(), sys.version))


def _version_of_lark() -> str:
    """The file of lark that states its version; to import it takes longer than to read a tree."""
    found = find_spec("lark")
    assert found is not None
    assert found.origin is not None
    return Path(found.origin).read_text("utf-8")

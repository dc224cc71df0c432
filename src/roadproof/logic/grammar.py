"""The grammar of specification files, and a text to key caches of syntax trees with."""

import re
import sys
from functools import cache
from importlib.util import find_spec
from pathlib import Path

from roadproof.world.units import UNITS


@cache
def grammar() -> str:
    """Return the grammar as lark reads it, with the table of units filled in."""
    text = Path(__file__).with_name("grammar.lark").read_text("utf-8")
    longest_first = sorted(UNITS, key=len, reverse=True)
    return text.replace("%UNITS%", "|".join(re.escape(x).replace("/", r"\/") for x in longest_first))


@cache
def version() -> str:
    """Return a text that changes whenever a parsed syntax tree could change.

    It joins the grammar, the source of the parser, the version of lark and that of Python.
    """
    here = Path(__file__).parent
    others = (here.parent / name for name in ("errors.py", "world/signals.py", "world/units.py"))
    sources = (path.read_text("utf-8") for path in sorted((*here.glob("*.py"), *others)))
    return "\0".join((grammar(), *sources, _version_of_lark(), sys.version))


def _version_of_lark() -> str:
    """Return the file of lark that states its version; to import lark takes longer than to read a tree."""
    spec = find_spec("lark")
    assert spec is not None
    assert spec.origin is not None
    return Path(spec.origin).read_text("utf-8")

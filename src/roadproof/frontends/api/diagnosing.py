"""What is wrong with a text, all at once, for editors and for those who write."""

from roadproof.frontends.api.definitions import Definitions, load
from roadproof.library import diagnose as texts
from roadproof.library.diagnose import Diagnostic, Proofreader

__all__ = ["Diagnostic", "Proofreader", "diagnose"]


def diagnose(text: str, using: Definitions | None = None, formula: bool = False) -> tuple[Diagnostic, ...]:
    """All that is wrong with a specification text on top of definitions, or with a ``formula`` in them.

    Each remark has line, column and end (from 1, the end not included), message, hint and severity ("error",
    or "info" where a definition replaces another). Nothing is raised for what is in the text. Whoever asks on
    each key holds a ``Proofreader(using.library)``, and asks ``read(text)``.

    >>> [(x.line, x.column, x.message) for x in diagnose("v_lon(SV) > 3", formula=True)]
    [(1, 1, 'm/s and no unit cannot be compared')]
    """
    home = using or load()
    if formula:
        return texts.diagnose_claim(text, home.specification)
    return texts.diagnose(text, home.library).diagnostics

"""Trees and formulas to text and back: what is printed must be read as what it was."""

from hypothesis import strategies as st

from fuzz.case import Disagreement
from logic import strategies
from logic.test_show import canonical
from roadproof.errors import InputError
from roadproof.library.elaborate import read_claim
from roadproof.library.loading import bundled_library
from roadproof.logic import syntax
from roadproof.logic.formula import Formula
from roadproof.logic.parse import parse_claim
from roadproof.logic.restore import as_syntax
from roadproof.logic.show import text

cases = st.one_of(strategies.expressions(), strategies.formulas())
CHUNK = 500


def check(case: syntax.Expression | Formula) -> int:
    """One text, written on one line and on several, and with the definitions written out."""
    if isinstance(case, syntax.Expression):
        for width in (None, 40):
            if parse_claim(text(case, width)).body != case:
                raise Disagreement(f"reads back differently: {text(case, width)}", case)
        return 1
    specification = bundled_library().select("ext")
    for expand in (False, True):
        shown = text(as_syntax(case, expand), 80)
        try:
            read = read_claim(specification, shown).formula
        except InputError as error:
            raise Disagreement(f"is not read back: {shown}", case) from error
        if canonical(read, not expand) != canonical(case, not expand):
            raise Disagreement(f"reads back differently: {shown}", case)
    return 1

"""What the printer says is read back by Coq as the tree that was printed (written apart in ``raw``)."""

import re

import pytest

from kernel import raw
from kernel.needs import needs_coq
from kernel.reading import answers, compared
from roadproof.errors import InputError, TextError
from roadproof.evidence.kernel.names import WORDS, comment
from roadproof.evidence.kernel.printer import CLOSE, Printer
from roadproof.library.elaborate import read_claim
from roadproof.library.loading import bundled_library
from roadproof.logic import formula as f
from roadproof.logic import terms as t
from roadproof.logic.rewrite import without_names

# Definitions that are numbers, and not true or false; claims have them written out.
NUMBERS = {
    *("front", "rear", "dRSS_lon", "dRSS_lat", "lateralDistance", "gapAhead"),
    *("brakingDistance", "frontAtLeast", "rearAtMost"),
}


def applied(specification, name, group):
    """A definition applied to names of its own, a group of vehicles as so many."""
    declared, words = [], []
    for place, x in enumerate(specification.definitions[name].parameters, 1):
        count = group if x.sort == "vehicles" else 1
        new = [f"L{place}" if x.sort == "lane" else f"x_{place}_{k}" for k in range(count)]
        words += new
        sort = "vehicle" if x.sort == "vehicles" else x.sort
        declared += [f"{word}: {sort}" for word in new if x.sort != "lane"]
    given = f"given {'; '.join(declared)}: " if declared else ""
    return read_claim(specification, f"{given}{name}({', '.join(words)})").formula


def library_formulas():
    """Every definition of a truth value, in every set in which it means something else than in another."""
    found = {}
    for set_name in ("base", "extA", "ext"):
        specification = bundled_library().select(set_name)
        for name in sorted({*specification.definitions} - NUMBERS):
            try:
                formula = applied(specification, name, 1)
            except TextError:
                formula = applied(specification, name, 2)
            found.setdefault(without_names(formula), formula)
    return list(found.values())


def formals():
    specification = bundled_library().select()
    return {
        name: tuple((x.name, str(x.sort)) for x in definition.parameters)
        for name, definition in specification.definitions.items()
    }


@needs_coq
def test_every_definition_of_the_library_is_read_back():
    found = library_formulas()
    assert len(found) >= 150
    assert answers(compared(found, formals())) == ["true"] * len(found)


@needs_coq
def test_another_formula_is_told_from_the_printed_one():
    """The comparison above can fail: a strict comparison, a bound, an order, a name."""
    base = raw.random_formula
    changed = [
        lambda text: text.replace(" < ", " <= ", 1),
        lambda text: text.replace(" and ", " or ", 1),
        lambda text: text.replace('"SV"', '"POV"', 1),
        lambda text: re.sub(r"\bl\b(?=\))", "l_2", text, count=1),
    ]
    said = [f.Compare(t.Signal("s", "SV"), "<", t.Signal("s", "POV")), f.And((base(1), base(2)))]
    said += [f.Occupies("SV", "L"), f.Truth(True)]
    original = compared(said, {})
    assert answers(original) == ["true"] * len(said)
    told = [text for change in changed if (text := change(original)) != original]
    assert len(told) >= 3
    assert all(answers(text).count("false") == 1 for text in told)


def test_a_definition_is_printed_as_a_function_once():
    query = read_claim(bundled_library().select(), "dangerArises(SV, POV)")
    printer = Printer(formals())
    assert printer.formula(query.formula).replace(CLOSE, " ") == "dangerArises SV POV"
    printed = "\n".join(printer.definitions).replace(CLOSE, " ")
    assert "Definition danger (a b : vehicle) : formula := G[0, minDanger] rssViolation a b." in printed
    assert printed.count("Definition dangerAhead ") == 1


@pytest.mark.parametrize(
    "name", ["valid", "Qed", "forall", "F", "and", "claim", "Roadproof", "eq_refl", "max"]
)
def test_a_definition_called_like_a_word_of_the_file_is_called_otherwise(name):
    assert name in WORDS
    printer = Printer()
    shown = printer.formula(f.Application(name, ("a",), f.Compare(t.Signal("s", "a"), "<", t.number(0))))
    assert shown.split(CLOSE)[0] == f"{name}_2"


def test_an_argument_is_no_word_that_the_body_says():
    """def s(danger: vehicle) would be read as another thing."""
    body = f.Compare(t.Signal("s", "rho"), "<", t.Parameter("rho"))
    printer = Printer({"near": (("rho", "vehicle"),)})
    printer.formula(
        f.And((f.Compare(t.Parameter("rho"), ">", t.number(0)), f.Application("near", ("rho",), body)))
    )
    assert printer.definitions[0].replace(CLOSE, " ").startswith("Definition near (rho_2 : vehicle)")


@pytest.mark.parametrize("name", ['a" b', "a.b", "", "x" * 300, "ä", "a\nb", "(* a"])
def test_names_of_odd_characters_are_refused(name):
    with pytest.raises(InputError):
        Printer().vehicle(name)


@pytest.mark.parametrize("said", ["*) Axiom a : False. (*", 'say "*)', "(*", "(*)", "(**)", "*" * 5, "é ✓"])
def test_words_in_comments_end_no_comment(said):
    shown = comment(said)
    assert shown.isascii()
    assert not {"(*", "*)", '"'} & {shown[i : i + n] for i in range(len(shown)) for n in (1, 2)}

"""The front door itself: its names, what it costs to open it, and what it says of itself."""

import doctest
import subprocess
import sys
from importlib import import_module
from importlib.metadata import version

import pytest

import roadproof as rp
from roadproof import _HOMES

HEAVY = (
    "z3",
    "cvc5",
    "cvxpy",
    "numpy",
    "polars",
    "matplotlib",
    "sympy",
    "lark",
    "highspy",
    "clarabel",
)


def python(*arguments: str) -> str:
    done = subprocess.run([sys.executable, *arguments], stdout=subprocess.PIPE, text=True, check=True)
    return done.stdout.strip()


def test_all_names_are_there() -> None:
    for name in rp.__all__:
        assert getattr(rp, name) is not None
    assert {*rp.__all__} <= {*dir(rp)}
    with pytest.raises(AttributeError, match="module 'roadproof' has no attribute 'prov'; there are load"):
        rp.prov  # noqa: B018


def test_all_names_have_words() -> None:
    functions = [getattr(rp, name) for name in rp.__all__ if name.islower() and callable(getattr(rp, name))]
    assert len(functions) > 15
    for function in functions:
        assert function.__doc__, function.__name__


def test_names_stay_when_modules_are_imported() -> None:
    names = (
        "prove",
        "witness",
        "compare",
        "order",
        "overlap",
        "monitor",
        "explore",
        "check",
        "simulate",
        "export",
    )
    found = {name: getattr(rp, name) for name in names}
    for module in (
        "engines.prove.prover",
        "semantics.sampled.batch",
        "analysis.order.study",
        "evidence.checking",
        "recordings.export.registry",
        "verdict",
    ):
        import_module(f"roadproof.{module}")
    for name, function in found.items():
        assert getattr(rp, name) is function
        assert callable(function)


def test_the_door_is_light() -> None:
    code = f"import sys, roadproof; print(*({{*sys.modules}} & {{*{HEAVY!r}}}))"
    assert python("-c", code) == ""
    assert python("-c", code.replace("print", "roadproof.prove; print")) != ""  # the control


def test_star_import() -> None:
    assert python("-c", "from roadproof import *; print(prove.__name__, F(SV.v_lon > 3))") == (
        "prove F v_lon(SV) > 3"
    )


def test_version() -> None:
    assert rp.__version__ == version("roadproof")
    assert python("-m", "roadproof", "--version") == f"roadproof {rp.__version__}"


@pytest.mark.parametrize("name", ["roadproof", *(f"roadproof.{x}" for x in dict.fromkeys(_HOMES.values()))])
def test_what_docstrings_show_is_so(name: str) -> None:
    assert doctest.testmod(import_module(name)).failed == 0

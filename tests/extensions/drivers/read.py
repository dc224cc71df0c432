"""Formulas of driver.spec, bound, for tests."""

from collections.abc import Mapping
from fractions import Fraction
from functools import cache
from pathlib import Path

from roadproof.extensions.drivers.manoeuvres import MANOEUVRES
from roadproof.extensions.drivers.models import unpreventable
from roadproof.library.bind import bind, values_with
from roadproof.library.elaborate import read_claim
from roadproof.library.loading import load_library
from roadproof.library.specification import Library, Specification
from roadproof.logic.formula import Formula
from roadproof.world.road import Road


@cache
def library() -> Library:
    return load_library([Path("driver")])


def specification(**options: str) -> Specification:
    return library().select("base", options)


def boundary(
    manoeuvre: str, model: str, parameters: Mapping[str, Fraction] | None = None, **options: str
) -> Formula:
    text = unpreventable(manoeuvre, model, MANOEUVRES[manoeuvre].vehicles)
    return bound(text, tuple((parameters or {}).items()), **options)


@cache
def bound(text: str, parameters: tuple[tuple[str, Fraction], ...] = (), **options: str) -> Formula:
    query = read_claim(specification(**options), text)
    return bind(query.formula, Road("none", (), frozenset()), {}, values() | dict(parameters))


def values() -> dict[str, Fraction]:
    return values_with(library(), {})

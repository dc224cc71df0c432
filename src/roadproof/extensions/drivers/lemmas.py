"""Why the formulas of ``driver.spec`` are the boundary; and which choices have no say in it.

Lemmas are claims that are proved anew wherever the boundary is told.
"""

import tomllib
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from fractions import Fraction
from functools import cache
from importlib import resources

from roadproof.extensions.drivers.manoeuvres import Manoeuvre, ManoeuvreName
from roadproof.extensions.drivers.models import Model, boundary_name
from roadproof.library.bind import default_values
from roadproof.library.elaborate import apply_definition
from roadproof.library.specification import Specification
from roadproof.logic import syntax
from roadproof.logic.formula import Formula
from roadproof.logic.parse import parse_bundled
from roadproof.logic.rewrite import parameters_of
from roadproof.runtime.records import dataclass

AT_ONCE = "0 s"
# The ramp and the full braking of each model, in the words of driver.spec; then of AEB, and of both.
_BRAKING: Mapping[str, tuple[str, str]] = {
    "careful": ("cc_ramp", "cc_braking"),
    "r157": (AT_ONCE, "r157_braking"),
    "eu1426": (AT_ONCE, "eu1426_braking"),
    "rss": (AT_ONCE, "b_min"),
}
_RAMPS: Mapping[str, tuple[str, str]] = {
    "aeb": ("cc_ramp", "aeb_braking"),
    "both": ("(cc_ramp*aeb_braking/(cc_braking + aeb_braking))", "aeb_braking"),
}
_PARAMETERS = ("aeb_braking", "cc_braking", "cc_ramp")
_RESPONSE = ("a_max", "b_min", "rho")
_EVER = ("greatest", "reached")
"""What of a ramp that begins at another speed is true of any."""


@dataclass(frozen=True)
class Lemma:
    """A claim at the values of the ``parameters``, as text and as a tree; ``title`` says what it means."""

    name: str
    title: str
    claim: str
    parameters: tuple[str, ...]
    tree: syntax.Claim


@dataclass(frozen=True)
class _Entry:
    """A lemma of ``lemmas.toml``: for whom, with {T} and {A} for the ramp and the full braking.

    ``given``: the names that it is about, as a claim declares them. ``ramp``: whether it has no part
    where the ramp is 0 s.
    """

    id: str
    title: str
    given: str
    claim: str
    manoeuvres: tuple[ManoeuvreName, ...] = ()
    readings: tuple[str, ...] = ()
    ramp: bool = False

    def at(self, prefix: str, parameters: Sequence[str] = (), ramp: str = "", full: str = "") -> "_Stated":
        """It at a ramp and a full braking; of the ``parameters`` those that it names."""
        claim = self.claim.replace("{T}", ramp).replace("{A}", full)
        named = tuple(x for x in parameters if x in claim)
        return _Stated(f"{prefix}-{self.id}", self.title, self.given, claim, named)


@dataclass(frozen=True)
class _Stated:
    """A lemma as text, of which no tree is made yet."""

    name: str
    title: str
    given: str
    claim: str
    parameters: tuple[str, ...]


@dataclass(frozen=True)
class _Entries:
    """The lemmas of ``lemmas.toml``, of any braking, of AEB and of RSS."""

    lemma: tuple[_Entry, ...]
    aeb: tuple[_Entry, ...]
    rss: tuple[_Entry, ...]


def lemmas_for(manoeuvre: ManoeuvreName, models: Sequence[Model], aeb: str = "none") -> list[Lemma]:
    """The lemmas on which the boundaries of these models rest, each model with its own braking.

    ``aeb``: what AEB does in a cut-in of the careful driver, as the option ``cc_aeb``.
    """
    stated = list(_stated(manoeuvre, models, aeb))
    trees = _trees(tuple((x.given, x.claim) for x in stated))
    return [
        Lemma(x.name, x.title, f"given {x.given}: {x.claim}", x.parameters, tree)
        for x, tree in zip(stated, trees, strict=True)
    ]


def _stated(manoeuvre: ManoeuvreName, models: Sequence[Model], aeb: str) -> Iterator[_Stated]:
    entries, names = _entries(), {x.name for x in models}
    if manoeuvre == "cut-in" and aeb != "none" and "careful" in names:
        yield from (x.at("aeb", _PARAMETERS) for x in entries.aeb if aeb in x.readings)
        for name, (ramp, full) in _RAMPS.items():
            if name == "aeb" or aeb == "add":
                titled = (replace(x, title=f"{name}: {x.title}") for x in entries.lemma if x.id in _EVER)
                yield from (x.at(name, _PARAMETERS, ramp, full) for x in titled)
    for model in (x for x in models if not x.is_stepped):
        ramp, full = _BRAKING[model.name]
        parameters = (full,) if ramp == AT_ONCE else (full, ramp)
        for x in entries.lemma:
            if manoeuvre in x.manoeuvres and not (x.ramp and ramp == AT_ONCE):
                yield replace(x.at(model.name, (), ramp, full), parameters=parameters)
    if manoeuvre == "cut-in" and "rss" in names:
        yield from (x.at("rss", _RESPONSE) for x in entries.rss)


@cache
def _entries() -> _Entries:
    content = tomllib.loads(
        resources.files("roadproof.extensions.drivers").joinpath("lemmas.toml").read_text("utf-8")
    )
    return _Entries(**{kind: tuple(_Entry(**x) for x in said) for kind, said in content.items()})


@cache
def _trees(stated: tuple[tuple[str, str], ...]) -> tuple[syntax.Claim, ...]:
    """What ``given A: B`` reads as, for each A and B: all are parsed at once, as definitions of one file."""
    lines = (f"def lemma_{k}({given.replace(';', ',')}) := {b}" for k, (given, b) in enumerate(stated))
    found = parse_bundled("\n".join(lines), "lemmas.toml")
    return tuple(syntax.Claim(x.parameters, x.body) for x in found if isinstance(x, syntax.Definition))


def chosen(specification: Specification, values: Mapping[str, Fraction]) -> dict[str, str]:
    """Options, and then parameters, that are not as declared, with their values; ``values`` in SI units."""
    library = specification.library
    declared, known = library.options, default_values(library)
    options = {x: said for x, said in specification.options.items() if said != declared[x].values[0]}
    return options | {x: str(values[x]) for x in sorted(values) if values[x] != known[x]}


def idle(
    specification: Specification,
    values: Mapping[str, Fraction],
    manoeuvre: Manoeuvre,
    models: Sequence[Model],
) -> tuple[str, ...]:
    """Those of ``chosen`` with which nothing is different, as ``cc_aeb=max``.

    A controller that is stepped depends on none of them.
    """
    names = [x.name for x in models if not x.is_stepped]

    def boundaries(home: Specification) -> list[Formula]:
        called = (boundary_name(manoeuvre.name, name) for name in names)
        return [apply_definition(home, x, manoeuvre.vehicles).formula for x in called]

    said = boundaries(specification)
    spoken = {name for formula in said for name in parameters_of(formula)}

    def has_a_say(name: str) -> bool:
        if name not in specification.options:
            return name in spoken
        declared = specification.library.options[name].values[0]
        options = {**specification.options, name: declared}
        other = specification.library.select(specification.set_name, options)
        return boundaries(other) != said

    made = chosen(specification, values)
    return tuple(f"{name}={value}" for name, value in made.items() if not has_a_say(name))

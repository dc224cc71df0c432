"""Why the formulas of ``driver.spec`` are the boundary; and which choices have no say in it.

Lemmas are claims that are proved anew wherever the boundary is told.
"""

import tomllib
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from importlib import resources

from roadproof.drivers.manoeuvres import Manoeuvre, ManoeuvreName
from roadproof.drivers.models import Model, unpreventable
from roadproof.library.bind import default_values
from roadproof.library.elaborate import read_claim
from roadproof.library.specification import Specification
from roadproof.logic.rewrite import parameters_of

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
    """A claim at the values of the ``parameters``; ``title`` says what it means."""

    name: str
    title: str
    claim: str
    parameters: tuple[str, ...]


@dataclass(frozen=True)
class _Entry:
    """A lemma of ``lemmas.toml``: for whom, and with {T} and {A} for the ramp and the full braking."""

    id: str
    title: str
    claim: str
    manoeuvres: tuple[ManoeuvreName, ...] = ()
    readings: tuple[str, ...] = ()
    ramp: bool = False

    def lemma(self, prefix: str, parameters: Sequence[str] = (), ramp: str = "", full: str = "") -> Lemma:
        """It at a ramp and a full braking; of the ``parameters`` those that it names."""
        claim = self.claim.replace("{T}", ramp).replace("{A}", full)
        return Lemma(f"{prefix}-{self.id}", self.title, claim, tuple(x for x in parameters if x in claim))


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
    content = tomllib.loads(resources.files("roadproof.drivers").joinpath("lemmas.toml").read_text("utf-8"))
    entries = _Entries(**{kind: tuple(_Entry(**x) for x in said) for kind, said in content.items()})
    names = {x.name for x in models}
    found: list[Lemma] = []
    if manoeuvre == "cut-in" and aeb != "none" and "careful" in names:
        found = [x.lemma("aeb", _PARAMETERS) for x in entries.aeb if aeb in x.readings]
        ever = [x for x in entries.lemma if x.id in _EVER]
        for name, (ramp, full) in _RAMPS.items():
            if name == "aeb" or aeb == "add":
                titled = (replace(x, title=f"{name}: {x.title}") for x in ever)
                found += [x.lemma(name, _PARAMETERS, ramp, full) for x in titled]
    for model in (x for x in models if not x.is_stepped):
        ramp, full = _BRAKING[model.name]
        gradual = ramp != AT_ONCE
        found += [
            replace(x.lemma(model.name, (), ramp, full), parameters=(full, ramp) if gradual else (full,))
            for x in entries.lemma
            if manoeuvre in x.manoeuvres and (gradual or not x.ramp)
        ]
    if manoeuvre == "cut-in" and "rss" in names:
        found += [x.lemma("rss", _RESPONSE) for x in entries.rss]
    return found


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
    claims = [unpreventable(manoeuvre.name, name, manoeuvre.vehicles) for name in names]
    said = [read_claim(specification, claim).formula for claim in claims]
    spoken = {name for formula in said for name in parameters_of(formula)}

    def has_a_say(name: str) -> bool:
        if name not in specification.options:
            return name in spoken
        declared = specification.library.options[name].values[0]
        options = {**specification.options, name: declared}
        other = specification.library.select(specification.set_name, options)
        return [read_claim(other, claim).formula for claim in claims] != said

    made = chosen(specification, values)
    return tuple(f"{name}={value}" for name, value in made.items() if not has_a_say(name))

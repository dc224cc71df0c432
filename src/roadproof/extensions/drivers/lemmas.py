"""Lemmas: why the formulas of driver models are the boundary. They are proved anew with every boundary."""

import tomllib
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from functools import cache
from importlib import resources
from typing import TypeAlias

from roadproof.extensions.drivers.manoeuvres import ManoeuvreName
from roadproof.logic import syntax
from roadproof.logic.parse import parse_bundled
from roadproof.runtime.records import dataclass

_AT_ONCE = "0 s"
# The ramp and the full braking of AEB, and of both, in the words of driver.spec.
_RAMPS: Mapping[str, tuple[str, str]] = {
    "aeb": ("cc_ramp", "aeb_braking"),
    "both": ("(cc_ramp*aeb_braking/(cc_braking + aeb_braking))", "aeb_braking"),
}
_PARAMETERS = ("aeb_braking", "cc_braking", "cc_ramp")
_RESPONSE = ("a_max", "b_min", "rho")
_EVER = ("greatest", "reached")
"""Lemmas about a ramp that hold from any speed on."""


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

    def at(self, prefix: str, parameters: Sequence[str] = (), ramp: str = "", full: str = "") -> "Stated":
        """Return the lemma with {T} and {A} filled in, and the parameters that occur in it."""
        claim = self.claim.replace("{T}", ramp).replace("{A}", full)
        named = tuple(x for x in parameters if x in claim)
        return Stated(f"{prefix}-{self.id}", self.title, self.given, claim, named)


@dataclass(frozen=True)
class Stated:
    """A lemma as text, not yet parsed; ``given``: the names that it is about, as a claim declares them."""

    name: str
    title: str
    given: str
    claim: str
    parameters: tuple[str, ...]


Lemmas: TypeAlias = Callable[[str, tuple[str, str], ManoeuvreName, str], Iterator[Stated]]
"""Yield lemmas for a name, ramp and full braking, manoeuvre, and value of the option ``cc_aeb``."""


@dataclass(frozen=True)
class _Entries:
    """The lemmas of ``lemmas.toml``, of any braking, of AEB and of RSS."""

    lemma: tuple[_Entry, ...]
    aeb: tuple[_Entry, ...]
    rss: tuple[_Entry, ...]


def lemmas_of_braking(
    name: str, braking: tuple[str, str], manoeuvre: ManoeuvreName, aeb: str
) -> Iterator[Stated]:
    """Yield the lemmas about a ramp and the full braking at its end."""
    ramp, full = braking
    parameters = (full,) if ramp == _AT_ONCE else (full, ramp)
    for x in _entries().lemma:
        if manoeuvre in x.manoeuvres and not (x.ramp and ramp == _AT_ONCE):
            yield replace(x.at(name, (), ramp, full), parameters=parameters)


def lemmas_of_aeb(manoeuvre: ManoeuvreName, aeb: str) -> Iterator[Stated]:
    """Yield the lemmas about AEB in a cut-in, by the option ``cc_aeb``."""
    if manoeuvre != "cut-in" or aeb == "none":
        return
    entries = _entries()
    yield from (x.at("aeb", _PARAMETERS) for x in entries.aeb if aeb in x.readings)
    for name, (ramp, full) in _RAMPS.items():
        if name == "aeb" or aeb == "add":
            titled = (replace(x, title=f"{name}: {x.title}") for x in entries.lemma if x.id in _EVER)
            yield from (x.at(name, _PARAMETERS, ramp, full) for x in titled)


def lemmas_of_rss(manoeuvre: ManoeuvreName) -> Iterator[Stated]:
    """Yield the lemmas about the proper response of RSS."""
    if manoeuvre == "cut-in":
        yield from (x.at("rss", _RESPONSE) for x in _entries().rss)


def parsed_lemmas(stated: Iterable[Stated]) -> list[Lemma]:
    """Return lemmas with their trees."""
    texts = list(stated)
    trees = _trees(tuple((x.given, x.claim) for x in texts))
    return [
        Lemma(x.name, x.title, f"given {x.given}: {x.claim}", x.parameters, tree)
        for x, tree in zip(texts, trees, strict=True)
    ]


@cache
def _entries() -> _Entries:
    content = tomllib.loads(
        resources.files("roadproof.extensions.drivers").joinpath("lemmas.toml").read_text("utf-8")
    )
    return _Entries(**{kind: tuple(_Entry(**x) for x in entries) for kind, entries in content.items()})


@cache
def _trees(stated: tuple[tuple[str, str], ...]) -> tuple[syntax.Claim, ...]:
    """Return ``given A: B`` as a claim for each A and B; all are parsed at once, as one file."""
    lines = (f"def lemma_{k}({given.replace(';', ',')}) := {b}" for k, (given, b) in enumerate(stated))
    read = parse_bundled("\n".join(lines), "lemmas.toml")
    return tuple(syntax.Claim(x.parameters, x.body) for x in read if isinstance(x, syntax.Definition))

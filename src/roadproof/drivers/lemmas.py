"""Why the formulas of ``driver.spec`` are the boundary: claims, proved anew wherever the boundary is told."""

import tomllib
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from importlib import resources

from roadproof.drivers.manoeuvres import ManoeuvreName
from roadproof.drivers.models import Model

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


def lemmas_for(manoeuvre: ManoeuvreName, models: Sequence[Model], aeb: str = "none") -> list[Lemma]:
    """The lemmas on which the boundaries of these models rest, each model with its own braking.

    ``aeb``: what AEB does in a cut-in of the careful driver, as the option ``cc_aeb``.
    """
    content = tomllib.loads(resources.files("roadproof.drivers").joinpath("lemmas.toml").read_text("utf-8"))
    entries = {kind: [_Entry(**x) for x in said] for kind, said in content.items()}
    names = {x.name for x in models}
    found: list[Lemma] = []
    if manoeuvre == "cut-in" and aeb != "none" and "careful" in names:
        found = [x.lemma("aeb", _PARAMETERS) for x in entries["aeb"] if aeb in x.readings]
        for name, (ramp, full) in _RAMPS.items() if aeb == "add" else [("aeb", _RAMPS["aeb"])]:
            ever = [x for x in entries["lemma"] if x.id in _EVER]
            found += [
                replace(x, title=f"{name}: {x.title}").lemma(name, _PARAMETERS, ramp, full) for x in ever
            ]
    for model in (x for x in models if not x.is_stepped):
        ramp, full = _BRAKING[model.name]
        gradual = ramp != AT_ONCE
        found += [
            replace(x.lemma(model.name, (), ramp, full), parameters=(full, ramp) if gradual else (full,))
            for x in entries["lemma"]
            if manoeuvre in x.manoeuvres and (gradual or not x.ramp)
        ]
    if manoeuvre == "cut-in" and "rss" in names:
        found += [x.lemma("rss", _RESPONSE) for x in entries["rss"]]
    return found

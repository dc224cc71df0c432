"""Why the formulas of ``driver.spec`` are the boundary: claims, proved anew wherever the boundary is told."""

import tomllib
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from importlib import resources
from typing import Any

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


def lemmas_for(manoeuvre: ManoeuvreName, models: Sequence[Model], aeb: str = "none") -> list[Lemma]:
    """The lemmas on which the boundaries of these models rest, each model with its own braking.

    ``aeb``: what AEB does in a cut-in of the careful driver, as the option ``cc_aeb``.
    """
    content = resources.files("roadproof.drivers").joinpath("lemmas.toml").read_text("utf-8")
    found: list[Lemma] = []
    if manoeuvre == "cut-in" and aeb != "none" and any(x.name == "careful" for x in models):
        found = _with_aeb(tomllib.loads(content), aeb)
    for model in (x for x in models if not x.is_stepped):
        ramp, full = _BRAKING[model.name]
        gradual = ramp != AT_ONCE
        parameters = (full, ramp) if gradual else (full,)
        for entry in tomllib.loads(content)["lemma"]:
            if manoeuvre in entry["manoeuvres"] and (gradual or not entry.get("ramp")):
                claim = _filled(entry["claim"], ramp, full)
                found.append(Lemma(f"{model.name}-{entry['id']}", entry["title"], claim, parameters))
    if manoeuvre == "cut-in" and any(x.name == "rss" for x in models):
        found += [
            Lemma(f"rss-{x['id']}", x["title"], x["claim"], _spoken(x["claim"], _RESPONSE))
            for x in tomllib.loads(content)["rss"]
        ]
    return found


def _with_aeb(content: Mapping[str, Any], aeb: str) -> list[Lemma]:
    """That AEB takes over as is said, and what is true of each ramp that it takes over with."""
    said = [(f"aeb-{x['id']}", x["title"], x["claim"]) for x in content["aeb"] if aeb in x["readings"]]
    for name, (ramp, full) in _RAMPS.items() if aeb == "add" else [("aeb", _RAMPS["aeb"])]:
        said += [
            (f"{name}-{x['id']}", f"{name}: {x['title']}", _filled(x["claim"], ramp, full))
            for x in content["lemma"]
            if x["id"] in _EVER
        ]
    return [Lemma(name, title, claim, _spoken(claim, _PARAMETERS)) for name, title, claim in said]


def _spoken(claim: str, parameters: tuple[str, ...]) -> tuple[str, ...]:
    return tuple(x for x in parameters if x in claim)


def _filled(claim: str, ramp: str, full: str) -> str:
    return claim.replace("{T}", ramp).replace("{A}", full)

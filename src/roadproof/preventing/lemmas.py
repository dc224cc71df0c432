"""Why the formulas of ``driver.spec`` are the boundary: claims, proved anew wherever the boundary is told."""

import tomllib
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from importlib import resources

from roadproof.preventing.models import Model

AT_ONCE = "0 s"
# The ramp and the full braking of each model, in the words of driver.spec.
_BRAKING: Mapping[str, tuple[str, str]] = {
    "careful": ("cc_ramp", "cc_braking"),
    "r157": (AT_ONCE, "r157_braking"),
    "eu1426": (AT_ONCE, "eu1426_braking"),
    "rss": (AT_ONCE, "b_min"),
}


@dataclass(frozen=True)
class Lemma:
    """A claim at the values of the ``parameters``; ``title`` says what it means."""

    name: str
    title: str
    claim: str
    parameters: tuple[str, ...]


def lemmas_for(manoeuvre: str, models: Sequence[Model]) -> list[Lemma]:
    """The lemmas on which the boundaries of these models rest, each model with its own braking."""
    content = resources.files("roadproof.preventing").joinpath("lemmas.toml").read_text("utf-8")
    found: list[Lemma] = []
    for model in (x for x in models if not x.is_stepped):
        ramp, full = _BRAKING[model.name]
        gradual = ramp != AT_ONCE
        parameters = (full, ramp) if gradual else (full,)
        for entry in tomllib.loads(content)["lemma"]:
            if manoeuvre in entry["manoeuvres"] and (gradual or not entry.get("ramp")):
                claim = entry["claim"].replace("{T}", ramp).replace("{A}", full)
                found.append(Lemma(f"{model.name}-{entry['id']}", entry["title"], claim, parameters))
    return found

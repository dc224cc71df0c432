"""A small folder of evidence of each kind that a command writes, made once in a run of tests."""

import shutil
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

import roadproof as rp
from cli.test_schemas import few_classes
from sharing import made_once

FORMULA = '[[test]]\nid = "T{n}"\nformula = "scenario_{n}(SV,POV,L)"\n'


def _proofs(out: Path) -> None:
    """A template property and its parts, own claims with a proof, a trace and a drive."""
    rp.prove("P2", "P4", using=rp.load("base"), out=out, jobs=1)
    rp.prove("danger(SV,POV) -> danger(POV,SV)", "G v_lon(SV) > 3 m/s -> false", out=out, jobs=1)
    rp.prove("F v_lon(SV) > 3 m/s -> v_lon(SV) > 2 m/s", drive=True, out=out, jobs=1)


def _witness(out: Path) -> None:
    """A drive of a scenario, and a proof that a formula has none."""
    rp.witness(4, out=out, jobs=1)
    rp.witness("v_lon(SV) > 3 m/s and v_lon(SV) < 2 m/s", out=out, jobs=1)


def _gaps(out: Path) -> None:
    """The gaps of a class, with drives on other roads."""
    with pytest.MonkeyPatch.context() as patch:
        few_classes(patch)
        rp.coverage(rp.load("ext"), roads=["main-2"], effort=0.2, out=out, jobs=1)


def _catalogue(out: Path) -> None:
    """What three tests with formulas imply."""
    path = out.parent / "formulas.toml"
    path.write_text("".join(FORMULA.format(n=n) for n in (1, 3, 4)), "utf-8")
    rp.catalogue(path, among="1,3,4", classes=False, drivers=[], out=out, jobs=1)


MAKE: dict[str, Callable[[Path], Any]] = {
    "proofs": _proofs,
    "witness": _witness,
    "coverage": lambda out: rp.coverage(rp.load("complete"), roads=["main-2"], effort=1, out=out, jobs=1),
    "gaps": _gaps,
    "overlap": lambda out: rp.overlap(among=[1, 3, 4], out=out, jobs=1),
    "redundancy": lambda out: rp.redundancy(among=[4], out=out, jobs=1),
    "catalogue": _catalogue,
}


def copy_of(kind: str, to: Path) -> Path:
    """A folder of that kind below ``to``, to be changed."""
    made = made_once(f"kind-{kind}", lambda home: MAKE[kind](home / kind))
    shutil.copytree(made, to, dirs_exist_ok=True)
    return to / kind

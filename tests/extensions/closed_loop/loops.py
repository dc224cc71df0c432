"""Situations and problems for tests of the closed loop."""

from fractions import Fraction
from pathlib import Path
from typing import Any

import roadproof as rp
from roadproof.extensions.closed_loop.controllers.opening import opened, source_of
from roadproof.extensions.closed_loop.data import FalsifyRequest
from roadproof.extensions.closed_loop.question import FalsifyQuestion
from roadproof.extensions.closed_loop.requirement_words import with_words
from roadproof.extensions.closed_loop.search.problem import TargetProblem
from roadproof.extensions.closed_loop.simulation import ControlLoop
from roadproof.library.scenarios import name_of
from roadproof.questions.basis import Basis

VEHICLES = Path(__file__).with_name("vehicles.py")
_PATTERNS: dict[int, Any] = {}


def question(*numbers: int, **more: Any) -> FalsifyQuestion:
    """Return a question about a controller that is never run."""
    home = with_words(rp.load())
    asked = {
        "controller": "none",
        "kind": "command",
        "sha256": "0" * 64,
        "scenarios": numbers,
        "require": ("G not collision(SV, POV)",),
        "drivers": ("careful",),
        "classes": False,
        "simulations": 100,
        "seed": 0,
        "seeds": (),
        "dt": Fraction(1, 10),
        "seconds": Fraction(10),
        "method": "cma",
        "wanted": "any",
        "patience": 20.0,
    }
    return FalsifyQuestion(Basis(home.specification), FalsifyRequest(**{**asked, **more}))


def problem(number: int, **more: Any) -> TargetProblem:
    """Return the problem of a scenario, from the drive that the core knows."""
    if number not in _PATTERNS:
        _PATTERNS[number] = rp.witness(number, objective="smooth", jobs=1).evidence[0]
    return question(number, **more).problem(name_of(number), _PATTERNS[number])


def loop_of(name: str, patience: float = 20.0) -> ControlLoop:
    """Return the loop of a controller of ``vehicles.py``."""
    with opened(source_of(f"{VEHICLES}:{name}"), 0, patience) as controller:
        return ControlLoop(controller, patience)

"""All that can be changed about a question: definitions, values, options, files; one thing at a time."""

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

from study.commands import EVERY
from study.read_files import other_files
from study.stored_question import Change

TEXTS: Mapping[str, tuple[str, str]] = {
    "leaf, which two sets share": ("v_lon(a) > 8 m/s", "v_lon(a) > 0 m/s"),
    "bar of a set": ("v_lon(a) > 5 m/s", "v_lon(a) > 6 m/s"),
    "the parent of a set": ("extends base", "extends ext"),
    "near, whose variable is called as a parameter": ("gap*5 m/s^2", "gap*6 m/s^2"),
    "paced, which an option replaces": ("v_lon(a) > 25 m/s", "v_lon(a) > 28 m/s"),
    "quick, which is not chosen": ("v_lon(a) > 29 m/s", "v_lon(a) > 20 m/s"),
    "apart, which nothing uses": ("v_lon(a) > 1 m/s", "v_lon(a) > 2 m/s"),
    "a value that is declared": ("gap = 2 s", "gap = 1 s"),
    "another value that is declared": ("low = 20 m/s", "low = 18 m/s"),
    "a bound": ("where low > 0", "where low >= 0"),
    "a spare value": ("spare = 1 s", "spare = 2 s"),
    "a disturbance": ("v_lon(SV) < 40 m/s", "v_lon(SV) < 21 m/s"),
    "a description": ('"fast"', '"very fast"'),
    "a definition of the library": (
        "param gap",
        "def fasterThan(a, b: vehicle) := v_lon(a) >= v_lon(b)\nparam gap",
    ),
    "danger": ("param gap", "def danger(a, b: vehicle) := s(a) < s(b)\nparam gap"),
}
PARAMS = {"gap": 1, "low": 18, "spare": 3, "minSafe": 1, "minDanger": 1, "rho": "0.4 s"}
OPTIONS = {"pace": "quick", "idle": "yes", "speed": "total", "rss_form": "robust"}
CHOICES: Mapping[str, Change] = {
    **{f"text: {name}": lambda x, e=edit: x.edited(*e) for name, edit in TEXTS.items()},
    **{
        f"param {name}": lambda x, n=name, v=value: replace(x, params={n: v})
        for name, value in PARAMS.items()
    },
    **{
        f"option {name}": lambda x, n=name, v=value: replace(x, options={n: v})
        for name, value in OPTIONS.items()
    },
    "set mine": lambda x: replace(x, sets=("mine",)),
}
_TRUCK = {"": "truck"}
_PLACE = {"road": "main-3", "horizon": 5, "dt": "3/10", "reach": 60, "collisions": True, "vehicles": _TRUCK}
_METHOD = {"engine": "smt", "solver": "scipy", "effort": 50}
_DRIVER = {"preventable": "careful", "unpreventable": "careful"}
MORE: Mapping[str, Mapping[str, Any]] = {
    "prove": {
        **{"effort": 50, "drive": False, "declared": True, "assume": "motion", "engine": "smt"},
        **{"vehicles": _TRUCK, "road": "main-3", "horizon": 5, "dt": "3/10", "expect": "REFUTED"},
    },
    "witness": {**_PLACE, **_METHOD, "objective": "mild", "count": 2},
    "witness_scenarios": {"horizon": 5, "objective": "any", "lanes": {"L": "main-2"}},
    "prevented": {"unpreventable": "careful", "preventable": "rss"},
    "overlap": {
        **{"horizon": 5, "effort": 50, "lanes": "any", "roles": "any", "start": "any", "vehicles": _TRUCK},
        **_DRIVER,
    },
    "explore": {
        **{**_PLACE, **_METHOD, **_DRIVER, "lanes": {"L": "main-2"}, "least": "v_lon(SV) - low"},
        **{"steps": 3, "precision": 4, "when": "v_lon(SV) < 18 m/s", "vary": {"low": (15, 26)}},
        "greatest": "v_lon(SV) - 2*low",
    },
    "preventable": {
        **{"lines": 3, "at": {"Vy": "1 m/s", "Ve0": "90 km/h"}, "along": (0, 60), "across": (0, 40)},
        **{"lemmas": True, "effort": 50},
    },
    "order": {"effort": 50, "vehicles": _TRUCK},
    "redundancy": {"effort": 2, "whole": True, "vehicles": _TRUCK},
    "classify": {"effort": 50, "vehicles": _TRUCK, "shares": True, "on": "recordings", **_DRIVER},
    "coverage": {
        **{"effort": 0.2, "needed": True, "vehicles": _TRUCK, "wider": "ext", "roads": ["main-3"]},
        **{"on": "recordings", **_DRIVER},
    },
    "catalogue": {
        **{"among": "90,91", "classes": True, "gaps": True, "explore": True, "near": 5, "effort": 50},
        **{
            "roles": "any",
            "lanes": "any",
            "start": "any",
            "drivers": ("rss",),
            "vehicles": _TRUCK,
            **_DRIVER,
        },
    },
    "evaluate": {
        **{"among": "1,90", "min_danger": (0, "0.7 s"), "classes": ("Truck",), "drivers": ("careful",)},
        **{"detectors": False, "check": True, "keep_going": True, "strict": True, "end": "clip"},
    },
    "compare": {**_PLACE, **_METHOD, "lanes": {"L": "main-2"}},
}
"""By question another value for each option."""
TOGETHER: Mapping[tuple[str, str], Mapping[str, Any]] = {
    **{("prove", x): {"engine": "smt"} for x in ("road", "horizon", "dt")},
    ("prove", "vehicles"): {"assume": "motion"},
    ("prevented", "unpreventable"): {"preventable": None},
    **{("overlap", x): {"among": "4,90"} for x in _DRIVER},
    **{("classify", x): {"among": "4,5"} for x in _DRIVER},
    **{("explore", x): {"what": "scenario_4(SV,POV,L) and v_lon(SV) < low"} for x in (*_DRIVER, "lanes")},
    ("explore", "least"): {"greatest": None},
    ("classify", "on"): {"shares": True},
    ("catalogue", "classes"): {"among": "90,91"},
    ("catalogue", "explore"): {"among": "90", "effort": 0.2},
}
"""What an option needs beside it."""
_WHOM = "whom a run tells how far it is"
UNCHANGED: Mapping[str, str] = {
    **dict.fromkeys(("progress", "say", "tell"), _WHOM),
    "timeout": "the clock ends a search; what it cuts off is in doubt, and such a doubt is not kept",
    "kernel": "a kernel is asked about the evidence that an answer has, wherever that is from",
    "explain": "it explains an answer that is there; tested in tests/extensions/encoding",
    "solution": "it is the answer; nothing is asked, and nothing goes into the cache",
    "strict": "swept where recordings are the question",
    "road": "swept with maps, in tests/extensions/traffic",
    "tests": "points on the picture of an answer, which it leaves as it is; see test_plates.py",
}
"""Options that the sweep leaves out where a question has no other value for them, with the reason."""
DRIVER = {
    "cc_braking": 4,
    "cc_delay": "0.5 s",
    "cc_wander": "0.3 m",
    "cc_evaluation": "0.5 s",
    "cc_ramp": "0.5 s",
    "cc_drift": "0.3 m",
    "r157_delay": "0.5 s",
    "a_max": 3,
}
FOLDERS = {"catalogue": "tests", "evaluate": "recordings"}
"""The folder that a question reads."""


def changes_of(name: str) -> dict[str, Change]:
    found = dict(CHOICES)
    for x, value in MORE[name].items():
        more = {x: value, **TOGETHER.get((name, x), {})}
        found[f"--{x}"] = lambda y, more=more: y.with_more(**more)
    if name in ("preventable", "prevented"):
        found |= {f"driver {x}": lambda y, x=x, v=v: replace(y, params={x: v}) for x, v in DRIVER.items()}
    if name in FOLDERS:
        for title, file, content in other_files(FOLDERS[name]):
            found[f"file {title}"] = lambda y, f=file, c=content: y.with_file(f, c)
    if name == "explore":
        del found["param low"]  # it is varied, and a value for it is refused
    return found


PAIRS = [(name, change) for name in EVERY for change in changes_of(name)]


def unchanged_options(name: str) -> set[str]:
    """The options of the settings of a question that no question with these settings changes."""
    settings = EVERY[name][1]
    swept = {x for other, (_, y) in EVERY.items() if y is settings for x in MORE[other]}
    groups = ("question", "search", "effort")
    return {x for x, o in settings.options().items() if o.keyword and o.group in groups} - swept

"""Every question whose answer can be taken from a store, or from what this process remembers."""

import functools
import gc
import os
import shutil
import tempfile
from collections.abc import Callable, Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

import roadproof as rp
from roadproof.extensions.catalogue import settings as catalogues
from roadproof.extensions.drivers import settings as drivers
from roadproof.extensions.surveys import settings as surveys
from roadproof.extensions.traffic import settings as recordings
from roadproof.frontends.api.question_answers import QuestionAnswers
from roadproof.frontends.settings import questions, relations
from roadproof.frontends.settings.option import Settings
from study.stored_question import StoredQuestion

Answers = QuestionAnswers[Any]
Ask = Callable[[StoredQuestion, bool], Any]

CLAIMS = (
    "both(SV) -> v_lon(SV) > 7 m/s",
    "near(SV) -> v_lon(SV) > 9 m/s",
    "paced(SV) -> v_lon(SV) > 27 m/s",
    "v_lon(SV) > low -> v_lon(SV) > 19 m/s",
)


def prove(asking: StoredQuestion, fresh: bool) -> Answers:
    return rp.prove(*CLAIMS, using=asking.using, jobs=1, fresh=fresh, **asking.more)


def witness(asking: StoredQuestion, fresh: bool) -> Answers:
    what = "both(SV) and near(SV) and paced(SV) and v_lon(SV) > low"
    return rp.witness(what, using=asking.using, jobs=1, fresh=fresh, **asking.more)


def witness_scenarios(asking: StoredQuestion, fresh: bool) -> Answers:
    return rp.witness(90, 91, using=asking.using, jobs=1, fresh=fresh, **asking.more)


def overlap(asking: StoredQuestion, fresh: bool) -> Answers:
    more = {"among": "90,91", **asking.more}
    return rp.overlap(more.pop("among"), asking.using, jobs=1, fresh=fresh, **more)


def order(asking: StoredQuestion, fresh: bool) -> Answers:
    return rp.order("90,91", asking.using, jobs=1, fresh=fresh, **asking.more)


def redundancy(asking: StoredQuestion, fresh: bool) -> Answers:
    more = {"effort": 1, **asking.more}
    return rp.redundancy("90,91", asking.using, jobs=1, fresh=fresh, **more)


def classify(asking: StoredQuestion, fresh: bool) -> Answers:
    more = {"among": "90,91", "shares": False, **asking.more}
    if "on" in more:
        more["on"] = asking.place(more["on"])
    return rp.classify(more.pop("among"), asking.using, jobs=1, fresh=fresh, **more)


def coverage(asking: StoredQuestion, fresh: bool) -> Answers:
    more = {"effort": 0.1, **asking.more}
    if "on" in more:
        more["on"] = asking.place(more["on"])
    return rp.coverage(asking.using, jobs=1, fresh=fresh, **more)


def explore(asking: StoredQuestion, fresh: bool) -> Answers:
    more = {
        "vary": {"low": (15, 25)},
        "steps": 2,
        "precision": 5,
        "greatest": "v_lon(SV) - low",
        **asking.more,
    }
    what = more.pop("what", "near(SV) and v_lon(SV) < low")
    return rp.explore(what, using=asking.using, jobs=1, fresh=fresh, **more)


def preventable(asking: StoredQuestion, fresh: bool) -> Answers:
    given = replace(asking, specs=("driver",))
    more = {"at": {"Vy": "1 m/s", "Ve0": "100 km/h"}, "lines": 2, "lemmas": False, **asking.more}
    return rp.preventable("cut-in", ["careful"], given.using, jobs=1, fresh=fresh, **more)


def prevented(asking: StoredQuestion, fresh: bool) -> Answers:
    given = replace(asking, specs=("driver",))
    more = {"preventable": "careful", "horizon": 3, **asking.more}
    return rp.witness(4, using=given.using, jobs=1, fresh=fresh, **more)


def catalogue(asking: StoredQuestion, fresh: bool) -> Answers:
    more = {"among": "4,90,91", "classes": False, "drivers": ("careful",), **asking.more}
    return rp.catalogue(asking.place("tests"), using=asking.using, jobs=1, fresh=fresh, **more)


def evaluate(asking: StoredQuestion, fresh: bool) -> Any:
    """With a folder of results that earlier runs have written, or with one of its own."""
    traffic, results = asking.place("recordings"), Path(os.environ["XDG_CACHE_HOME"]) / "results"
    more = {"among": "1,4,90", "pictures": False, **asking.more}
    with tempfile.TemporaryDirectory() as another:
        out = Path(another) if fresh else results
        found = rp.evaluate(traffic, out, asking.using, jobs=1, **more)
        return {"answer": found.as_data(), "findings": repr(found.findings)}


def compare(asking: StoredQuestion, fresh: bool) -> Any:
    """Nothing is kept of it; what this process and its cache remember of definitions is forgotten first."""
    more = {"effort": 20, **asking.more}
    if fresh:
        shutil.rmtree(Path(os.environ["XDG_CACHE_HOME"]) / "roadproof" / "made", ignore_errors=True)
        for remembered in gc.get_objects():
            if isinstance(remembered, functools._lru_cache_wrapper):
                remembered.cache_clear()
    one, other = "both(SV) and v_lon(SV) > low", "near(SV) and paced(SV)"
    return rp.compare(one, other, using=asking.using, jobs=1, **more).as_data()


EVERY: Mapping[str, tuple[Ask, type[Settings]]] = {
    "prove": (prove, questions.Prove),
    "witness": (witness, questions.Witness),
    "witness_scenarios": (witness_scenarios, questions.Witness),
    "prevented": (prevented, questions.Witness),
    "overlap": (overlap, relations.Overlap),
    "explore": (explore, surveys.Explore),
    "preventable": (preventable, drivers.Preventable),
    "order": (order, relations.Order),
    "redundancy": (redundancy, surveys.Redundancy),
    "classify": (classify, surveys.Classify),
    "coverage": (coverage, surveys.Coverage),
    "catalogue": (catalogue, catalogues.Catalogue),
    "evaluate": (evaluate, recordings.Evaluate),
    "compare": (compare, questions.CompareSettings),
}
"""Each question with the settings of its command."""

"""Driving scenarios, compiled to proofs, witnesses and monitors.

>>> import roadproof as rp
>>> rp.prove("danger(SV,POV) -> danger(SV,POV)", jobs=1).verdict
<Verdict.PROVED: 'PROVED'>

What is here: definitions (``load``), formulas built with operators (``SV POV L F G U some every …``),
questions (``prove witness compare overlap order redundancy coverage classify explore catalogue preventable
monitor evaluate simulate check``, and ``ask`` for studies of yours), drives that are given (``motion
drive``), ``export`` for other tools, and the errors that they raise. Each is imported when it is first used.
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from roadproof.api.asking import ask as ask
    from roadproof.api.cataloguing import catalogue as catalogue
    from roadproof.api.checking import check as check
    from roadproof.api.classifying import classify as classify
    from roadproof.api.comparing import compare as compare
    from roadproof.api.converting import convert as convert
    from roadproof.api.covering import coverage as coverage
    from roadproof.api.definitions import Definitions as Definitions
    from roadproof.api.definitions import load as load
    from roadproof.api.diagnosing import Proofreader as Proofreader
    from roadproof.api.diagnosing import diagnose as diagnose
    from roadproof.api.drives import witness as witness
    from roadproof.api.driving import drive as drive
    from roadproof.api.driving import motion as motion
    from roadproof.api.exploring import explore as explore
    from roadproof.api.exporting import export as export
    from roadproof.api.phrases import POV as POV
    from roadproof.api.phrases import POV1 as POV1
    from roadproof.api.phrases import POV2 as POV2
    from roadproof.api.phrases import SV as SV
    from roadproof.api.phrases import F as F
    from roadproof.api.phrases import G as G
    from roadproof.api.phrases import L as L
    from roadproof.api.phrases import U as U
    from roadproof.api.phrases import adjacent_lanes as adjacent_lanes
    from roadproof.api.phrases import call as call
    from roadproof.api.phrases import every as every
    from roadproof.api.phrases import lane as lane
    from roadproof.api.phrases import lanelets as lanelets
    from roadproof.api.phrases import lanes as lanes
    from roadproof.api.phrases import parameter as parameter
    from roadproof.api.phrases import some as some
    from roadproof.api.phrases import vehicle as vehicle
    from roadproof.api.phrases import zone as zone
    from roadproof.api.preventing import preventable as preventable
    from roadproof.api.proofs import prove as prove
    from roadproof.api.recordings import evaluate as evaluate
    from roadproof.api.reporting import page as page
    from roadproof.api.roads import roads as roads
    from roadproof.api.simulating import simulate as simulate
    from roadproof.api.studies import order as order
    from roadproof.api.studies import overlap as overlap
    from roadproof.api.studies import redundancy as redundancy
    from roadproof.api.traces import monitor as monitor
    from roadproof.api.traces import trace as trace
    from roadproof.errors import InputError as InputError
    from roadproof.errors import MissingSolverError as MissingSolverError
    from roadproof.errors import RoadproofError as RoadproofError
    from roadproof.errors import SharedError as SharedError
    from roadproof.errors import TextError as TextError
    from roadproof.errors import TextErrors as TextErrors
    from roadproof.errors import UsageError as UsageError
    from roadproof.hands import Cluster as Cluster
    from roadproof.hands import Hands as Hands
    from roadproof.hands import Shard as Shard
    from roadproof.stages import Cancelled as Cancelled
    from roadproof.stages import Stage as Stage
    from roadproof.verdict import Verdict as Verdict

    __version__: str

_PHRASES = (
    *("SV", "POV", "POV1", "POV2", "L", "F", "G", "U", "lanes", "lanelets", "zone", "adjacent_lanes"),
    *("some", "every", "vehicle", "lane", "parameter", "call"),
)
_ERRORS = (
    *("RoadproofError", "InputError", "UsageError", "TextError", "TextErrors", "MissingSolverError"),
    "SharedError",
)
_HOMES = {
    "load": "api.definitions",
    "Definitions": "api.definitions",
    "prove": "api.proofs",
    "witness": "api.drives",
    "motion": "api.driving",
    "drive": "api.driving",
    "diagnose": "api.diagnosing",
    "Proofreader": "api.diagnosing",
    "compare": "api.comparing",
    "overlap": "api.studies",
    "order": "api.studies",
    "redundancy": "api.studies",
    "coverage": "api.covering",
    "classify": "api.classifying",
    "catalogue": "api.cataloguing",
    "explore": "api.exploring",
    "preventable": "api.preventing",
    "ask": "api.asking",
    "monitor": "api.traces",
    "trace": "api.traces",
    "evaluate": "api.recordings",
    "roads": "api.roads",
    "convert": "api.converting",
    "simulate": "api.simulating",
    "export": "api.exporting",
    "page": "api.reporting",
    "check": "api.checking",
    "Verdict": "verdict",
    "Stage": "stages",
    "Cancelled": "stages",
    **dict.fromkeys(_PHRASES, "api.phrases"),
    **dict.fromkeys(_ERRORS, "errors"),
    **dict.fromkeys(("Hands", "Shard", "Cluster"), "hands"),
}
__all__ = [*_HOMES, "__version__"]


def __getattr__(name: str) -> Any:
    if name == "__version__":
        from importlib.metadata import version

        return version("roadproof")
    if name not in _HOMES:
        raise AttributeError(f"module 'roadproof' has no attribute '{name}'; there are {', '.join(_HOMES)}")
    return getattr(import_module(f"roadproof.{_HOMES[name]}"), name)


def __dir__() -> list[str]:
    return sorted(__all__)

"""Driving scenarios, compiled to proofs, witnesses and monitors.

>>> import roadproof as rp
>>> rp.prove("danger(SV,POV) -> danger(SV,POV)", jobs=1).verdict
<Verdict.PROVED: 'PROVED'>

What is here: definitions (``load``), formulas built with operators (``SV POV L F G U some every …``),
questions (``prove witness compare overlap order redundancy coverage classify explore catalogue preventable
monitor compile evaluate simulate check``, and ``ask`` for studies of yours), drives that are given (``motion
drive``), ``export`` for other tools, and the errors that they raise. Each is imported when it is first used.
"""

from collections.abc import Mapping
from importlib import import_module
from typing import TYPE_CHECKING, Any

from roadproof.runtime.version import VERSION

if TYPE_CHECKING:
    from roadproof.errors import InputError as InputError
    from roadproof.errors import MissingSolverError as MissingSolverError
    from roadproof.errors import RoadproofError as RoadproofError
    from roadproof.errors import SharedError as SharedError
    from roadproof.errors import TextError as TextError
    from roadproof.errors import TextErrors as TextErrors
    from roadproof.errors import UsageError as UsageError
    from roadproof.extensions.assurance.assuring import assurance as assurance
    from roadproof.extensions.assurance.bundling import bundle as bundle
    from roadproof.extensions.assurance.tracing import requirement_changes as requirement_changes
    from roadproof.extensions.assurance.tracing import requirements as requirements
    from roadproof.extensions.catalogue.cataloguing import catalogue as catalogue
    from roadproof.extensions.drivers.preventing import preventable as preventable
    from roadproof.extensions.exchange.compiling import compile as compile
    from roadproof.extensions.exchange.exporting import export as export
    from roadproof.extensions.maps.roads import road as road
    from roadproof.extensions.maps.roads import stretches as stretches
    from roadproof.extensions.pages.atlas.atlas import atlas as atlas
    from roadproof.extensions.pages.reporting import page as page
    from roadproof.extensions.surveys.classifying import classify as classify
    from roadproof.extensions.surveys.covering import coverage as coverage
    from roadproof.extensions.surveys.exploring import explore as explore
    from roadproof.extensions.surveys.redundancies import redundancy as redundancy
    from roadproof.extensions.surveys.surveying import ask as ask
    from roadproof.extensions.traffic.converting import convert as convert
    from roadproof.extensions.traffic.evaluating import evaluate as evaluate
    from roadproof.extensions.traffic.evaluating import roads as roads
    from roadproof.extensions.traffic.monitoring import monitor as monitor
    from roadproof.extensions.traffic.monitoring import trace as trace
    from roadproof.extensions.traffic.simulating import simulate as simulate
    from roadproof.frontends.api.checking import check as check
    from roadproof.frontends.api.comparing import compare as compare
    from roadproof.frontends.api.definitions import Definitions as Definitions
    from roadproof.frontends.api.definitions import diagnose as diagnose
    from roadproof.frontends.api.definitions import load as load
    from roadproof.frontends.api.drives import known_drives as known_drives
    from roadproof.frontends.api.drives import witness as witness
    from roadproof.frontends.api.driving import drive as drive
    from roadproof.frontends.api.driving import motion as motion
    from roadproof.frontends.api.phrases import POV as POV
    from roadproof.frontends.api.phrases import POV1 as POV1
    from roadproof.frontends.api.phrases import POV2 as POV2
    from roadproof.frontends.api.phrases import SV as SV
    from roadproof.frontends.api.phrases import F as F
    from roadproof.frontends.api.phrases import G as G
    from roadproof.frontends.api.phrases import L as L
    from roadproof.frontends.api.phrases import U as U
    from roadproof.frontends.api.phrases import adjacent_lanes as adjacent_lanes
    from roadproof.frontends.api.phrases import call as call
    from roadproof.frontends.api.phrases import every as every
    from roadproof.frontends.api.phrases import lane as lane
    from roadproof.frontends.api.phrases import lanelets as lanelets
    from roadproof.frontends.api.phrases import lanes as lanes
    from roadproof.frontends.api.phrases import parameter as parameter
    from roadproof.frontends.api.phrases import some as some
    from roadproof.frontends.api.phrases import vehicle as vehicle
    from roadproof.frontends.api.phrases import zone as zone
    from roadproof.frontends.api.proofs import prove as prove
    from roadproof.frontends.api.studies import order as order
    from roadproof.frontends.api.studies import overlap as overlap
    from roadproof.library.diagnose import Proofreader as Proofreader
    from roadproof.runtime.executors import Cluster as Cluster
    from roadproof.runtime.executors import Executor as Executor
    from roadproof.runtime.executors import Shard as Shard
    from roadproof.runtime.progress import Cancelled as Cancelled
    from roadproof.runtime.progress import Stage as Stage
    from roadproof.verdict import Verdict as Verdict


__version__ = VERSION
_PHRASES = (
    *("SV", "POV", "POV1", "POV2", "L", "F", "G", "U", "lanes", "lanelets", "zone", "adjacent_lanes"),
    *("some", "every", "vehicle", "lane", "parameter", "call"),
)
_ERRORS = (
    *("RoadproofError", "InputError", "UsageError", "TextError", "TextErrors", "MissingSolverError"),
    "SharedError",
)
_HOMES = {
    "load": "frontends.api.definitions",
    "Definitions": "frontends.api.definitions",
    "prove": "frontends.api.proofs",
    "witness": "frontends.api.drives",
    "known_drives": "frontends.api.drives",
    "motion": "frontends.api.driving",
    "drive": "frontends.api.driving",
    "diagnose": "frontends.api.definitions",
    "Proofreader": "library.diagnose",
    "compare": "frontends.api.comparing",
    "overlap": "frontends.api.studies",
    "order": "frontends.api.studies",
    "check": "frontends.api.checking",
    "Verdict": "verdict",
    "Stage": "runtime.progress",
    "Cancelled": "runtime.progress",
    **dict.fromkeys(_PHRASES, "frontends.api.phrases"),
    **dict.fromkeys(_ERRORS, "errors"),
    **dict.fromkeys(("Executor", "Shard", "Cluster"), "runtime.executors"),
}


def __getattr__(name: str) -> Any:
    if name == "__all__":
        return [*_names(), "__version__"]
    if name in _HOMES:
        return getattr(import_module(f"roadproof.{_HOMES[name]}"), name)
    if name.startswith("__"):
        raise AttributeError(f"module 'roadproof' has no attribute '{name}'")
    from roadproof.extension import imported

    found = _names()
    if name not in found:
        raise AttributeError(f"module 'roadproof' has no attribute '{name}'; there are {', '.join(found)}")
    return imported(found[name])


def _names() -> Mapping[str, str]:
    """The names of the core and of the extensions, each with ``module:name``."""
    from roadproof.extension import entries

    return entries("functions", {name: f"roadproof.{home}:{name}" for name, home in _HOMES.items()})


def __dir__() -> list[str]:
    return sorted((*_names(), "__version__"))

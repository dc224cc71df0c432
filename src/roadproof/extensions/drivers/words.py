"""Words for what plates and pictures of driver models show: initial values, and parts of their formulas."""

from collections.abc import Iterable, Mapping
from types import MappingProxyType

from roadproof.extensions.drivers.manoeuvres import InitialQuantity
from roadproof.extensions.drivers.models import MODELS
from roadproof.logic.formula import Application, Formula, children
from roadproof.logic.rewrite import vehicles_of

_CAREFUL, _RSS = MODELS["careful"].phrase, MODELS["rss"].phrase
_SIDE = "cannot prevent a collision with {b} from this side"
_PARTS: Mapping[str, str] = MappingProxyType(
    {
        "comesIn": "{b}, ahead of {a} and beside its way, comes into it",
        "isPast": "{a} has passed {b}",
        "meets": "{a} touches {b}, and has not passed it before",
        "touches": "{a} touches {b}",
        "hits": "{a} hits {b}, front to rear or side",
        "hasGained": "{a} has gained more than a given distance on {b} when {b} is in its way",
        "hasEverGained": "{a} has gained more than a given distance on {b}, then or before",
        "stillFaster": "{a} is still faster than {b} when {b} is in its way",
        "gains": "{a} gains more than the gap on {b}",
        "gainsByRamp": "{a} gains more than the gap on {b} while its brakes build up",
        **{f"{x.name}_in": f"{x.phrase} {_SIDE}" for x in MODELS.values() if x.law is not None},
        "careful_hits": f"{_CAREFUL} hits {{b}}",
        "careful_gated": f"{_CAREFUL} hits {{b}}, braking by time to collision",
        "careful_aided": f"{_CAREFUL} hits {{b}} in spite of AEB, or has none",
        "careful_out": f"{_CAREFUL} hits the vehicle that the cut-out reveals",
        "rss_hits": f"{_RSS} hits {{b}}",
        "rss_gains": f"{_RSS} gains more than the gap on {{b}}",
        "careful_drives": "{a} moves as the careful driver drives it while {b} cuts in",
        "seesIn": "the driver of {a} perceives {b}",
        "soon": "the driver of {a} may respond to {b} at this time to collision",
        "soonAfter": "the driver of {a} may brake at this time to collision with {b}",
        "weighs": "the driver of {a} evaluates the risk of {b}, then brakes after a delay",
        "delays": "the driver of {a} waits for the delay, then brakes",
        "goesOn": "the driver of {a} does not brake yet",
        "brakes": "the driver of {a} brakes",
        "isRelieved": "AEB alone brakes {a} from here on",
        "isFree": "{b} is not yet fully in front of {a}",
        "isWrapped": "{b} is, or was, fully in front of {a}",
        "freely": "{a} brakes as its driver does, without AEB",
        "isAided": "{a} brakes as AEB does once {b} is fully in front of it",
        "perceivedTooLate": "{a}, driven as the careful driver, hits {b}, which it perceives in this state",
        "brakesTooHard": "{a}, driven as the careful driver, hits {b}, which begins to brake in this state",
    }
)
_BEGINNINGS = {"unpreventable": "cannot prevent a collision", "follows": "moves as the model says"}


def words_of_parts(formula: Formula) -> dict[Application, str]:
    """Return a phrase with the vehicles' names for each part of a driver model in a formula.

    The arguments of many are numbers, so the vehicles are those of the nearest part around it that names two.
    """
    vehicles = {*vehicles_of(formula)}
    phrases: dict[Application, str] = {}
    seen: set[Formula] = set()
    left: list[tuple[Formula, tuple[str, ...]]] = [(formula, ())]
    while left:
        part, around = left.pop()
        if part in seen:
            continue
        seen.add(part)
        if isinstance(part, Application):
            own = tuple(x for x in part.arguments if x in vehicles)
            around = own if len(own) > 1 else around
            words = _words(part.name.partition("@")[0], around)
            phrases |= {part: words} if words else {}
        left += [(x, around) for x in children(part)]
    return phrases


def _words(name: str, vehicles: tuple[str, ...]) -> str:
    begin, _, rest = name.partition("_")
    words = _PARTS.get(name, "")
    if begin in _BEGINNINGS and (model := rest.rpartition("_")[2]) in MODELS:
        words = f"{MODELS[model].phrase} {_BEGINNINGS[begin]}"
    if not words or len(vehicles) < 2:
        return ""
    return f"{words.format(a=vehicles[0], b=vehicles[-1])} ({name})"


def legend(quantities: Iterable[InitialQuantity]) -> str:
    """Return the meaning of the symbols of initial values, with units."""
    return "; ".join(f"{x.name}: {x.doc} ({x.unit})" for x in quantities)

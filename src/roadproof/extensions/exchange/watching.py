"""Monitors that are fed one sample after the other in Python, and what they share with monitors in C."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Unpack

from roadproof.errors import UsageError
from roadproof.extensions.exchange.settings import OnlineMonitorSettings
from roadproof.extensions.exchange.streaming.online import OnlineMonitor
from roadproof.extensions.exchange.streaming.plan import plans_of
from roadproof.extensions.exchange.streaming.sample import fields_of
from roadproof.frontends.api.definitions import Definitions, What, definitions_of
from roadproof.frontends.api.settings import as_road, positive
from roadproof.frontends.settings.option import takes
from roadproof.library.bind import bind, refuse_variables
from roadproof.logic.rewrite import with_values

if TYPE_CHECKING:
    from roadproof.extensions.exchange.keywords import OnlineMonitorKeywords
    from roadproof.extensions.exchange.settings import Compile
    from roadproof.library.specification import Query
    from roadproof.logic.formula import Formula
    from roadproof.world.road import Road


@takes(OnlineMonitorSettings)
def online_monitor(
    what: What, using: Definitions | None = None, **options: Unpack[OnlineMonitorKeywords]
) -> OnlineMonitor:
    """Return a monitor of a scenario or formula that takes one sample after the other.

    ``monitor.step(sample)`` returns "true", "false" or "undecided", at the same sample as the monitor in C of
    ``compile``. ``dt``: seconds between samples (default: 1/25). ``monitor.fields`` says what a sample needs.
    Relations to lanes are flags of the sample; with ``road`` and ``lanes`` they are computed from positions
    on that road. ``strict``: no part of its map may be left out. Raises ``InputError`` for bounds that are no
    multiple of ``dt``, and for more than six operators without a bound; ``TextError``, ``UsageError``.
    """
    settings, home = OnlineMonitorSettings.of(options), definitions_of(using)
    _, query = home.numbered(what)
    formula = stream_formula(query, home, settings.lanes, road_of_samples(settings))
    dt = positive("dt", settings.dt, "s")
    plan = plans_of({query.text: formula}, dt)[query.text]
    return OnlineMonitor(query.text, plan, dt, fields_of([formula]))


def road_of_samples(settings: Compile | OnlineMonitorSettings) -> Road | None:
    """Return the road on which relations to lanes are computed. Raises ``UsageError`` for lanes of none."""
    if settings.lanes and settings.road is None:
        raise UsageError("lanes: the lanes of which road? Name it, or leave lanes to the flags of samples")
    return None if settings.road is None else as_road(settings.road, settings.strict)


def stream_formula(
    query: Query, home: Definitions, lanes: Mapping[str, str] | None, road: Road | None
) -> Formula:
    """Return a formula with values of its parameters, bound to a road if there is one."""
    if road is not None:
        return bind(query.formula, road, dict(lanes or {}), home.all_values())
    refuse_variables(query.formula)
    return with_values(query.formula, home.all_values())

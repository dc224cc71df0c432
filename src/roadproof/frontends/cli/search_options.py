"""Options of the sub-commands that search for drives, and what they mean."""

import argparse
from collections.abc import Iterator, Sequence
from fractions import Fraction
from typing import TYPE_CHECKING, TypedDict

from roadproof.frontends.cli.numbers import add_effort_options
from roadproof.frontends.cli.options import add_parameter_option, add_specification_options, read_seconds

if TYPE_CHECKING:
    from roadproof.engines.search.question import Engine


class SearchPlace(TypedDict):
    """Where, with whom and for how long is searched, as ``api.settings.setting`` takes it."""

    road: str | None
    lanes: dict[str, str]
    vehicles: dict[str, str]
    horizon: Fraction
    dt: Fraction | None
    reach: Fraction
    collisions: bool


class SearchEffort(TypedDict):
    """By whom is searched, and how much work is given."""

    engine: "Engine"
    solver: str
    effort: float
    timeout: float | None


def add_models_option(parser: argparse.ArgumentParser) -> None:
    """``--vehicle``, which ``named`` takes apart."""
    parser.add_argument(
        "--vehicle",
        dest="vehicles",
        metavar="[NAME=]MODEL",
        action="append",
        default=[],
        help="a vehicle model or a .toml file, for all vehicles or for one (default: car)",
    )


def add_search_options(parser: argparse.ArgumentParser, units: float = 60.0) -> None:
    """Where, with whom, how long and by whom is searched; see ``where_asked``, ``how_asked``."""
    add_specification_options(parser, several=True)
    add_parameter_option(parser)
    parser.add_argument(
        "--road", metavar="R", help="a reference road, or a .toml or .xodr file (default: by the formula)"
    )
    parser.add_argument(
        "--lane",
        dest="lanes",
        metavar="[L=]LANE",
        action="append",
        default=[],
        help="the lane that L stands for (default: any that works, from the right)",
    )
    add_models_option(parser)
    parser.add_argument("--horizon", metavar="S", default="6", help="seconds that are searched (default: 6)")
    parser.add_argument(
        "--dt", metavar="S", help="seconds between samples (default: the coarsest that fits, at most 3/5)"
    )
    parser.add_argument(
        "--reach", metavar="M", default="80", help="how far apart vehicles may start (default: 80)"
    )
    parser.add_argument("--allow-collisions", action="store_true", help="boxes may overlap")
    parser.add_argument("--engine", choices=("milp", "smt"), default="milp", help="default: milp")
    parser.add_argument("--solver", default="highs", help="a mixed-integer solver for milp (default: highs)")
    add_effort_options(parser, units)


def where_asked(args: argparse.Namespace) -> SearchPlace:
    """What the options say of where, with whom and for how long. Raises ``UsageError``."""
    from roadproof.library.scenarios import LANE

    return {
        "road": args.road,
        "lanes": dict(named(args.lanes, LANE)),
        "vehicles": dict(named(args.vehicles, "")),
        "horizon": read_seconds("--horizon", args.horizon),
        "dt": None if args.dt is None else read_seconds("--dt", args.dt),
        "reach": read_seconds("--reach", args.reach),
        "collisions": args.allow_collisions,
    }


def how_asked(args: argparse.Namespace) -> SearchEffort:
    """What the options say of engine, solver and work."""
    return {"engine": args.engine, "solver": args.solver, "effort": args.effort, "timeout": args.timeout}


def named(texts: Sequence[str], usual: str) -> Iterator[tuple[str, str]]:
    """``NAME=VALUE`` texts as pairs; the name is ``usual`` where none is given."""
    for text in texts:
        name, equals, value = text.rpartition("=")
        yield (name if equals else usual), value

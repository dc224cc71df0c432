"""Options of the sub-commands that search for drives, and what they mean."""

import argparse
from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING

from roadproof.cli.numbers import add_effort_options, read_effort
from roadproof.cli.options import (
    add_parameter_option,
    add_specification_options,
    parameter_values,
    read_seconds,
)

if TYPE_CHECKING:
    from roadproof.spec.library import Library
    from roadproof.witness.question import Means, Setting


def add_search_options(parser: argparse.ArgumentParser, units: float = 60.0) -> None:
    """Where, with whom, how long and by whom is searched; ``read_setting``, ``read_means``."""
    add_specification_options(parser, several=True)
    add_parameter_option(parser)
    parser.add_argument(
        "--road", metavar="R", help="a reference road or a .toml file (default: by the formula)"
    )
    parser.add_argument(
        "--lane",
        dest="lanes",
        metavar="[L=]LANE",
        action="append",
        default=[],
        help="the lane that L stands for (default: any that works, from the right)",
    )
    parser.add_argument(
        "--vehicle",
        dest="vehicles",
        metavar="[NAME=]MODEL",
        action="append",
        default=[],
        help="a vehicle model or a .toml file, for all vehicles or for one (default: car)",
    )
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


def read_setting(args: argparse.Namespace, library: "Library") -> "Setting":
    """Where, with whom and for how long is searched. Raises ``UsageError``, ``InputError``."""
    from roadproof.witness.question import Setting
    from roadproof.world.models import load_road, load_vehicle

    return Setting(
        road=None if args.road is None else load_road(args.road),
        lanes=dict(named(args.lanes, "L")),
        vehicles={name: load_vehicle(model) for name, model in named(args.vehicles, "")},
        values=parameter_values(args, library),
        horizon=read_seconds("--horizon", args.horizon),
        dt=None if args.dt is None else read_seconds("--dt", args.dt),
        reach=read_seconds("--reach", args.reach),
        collisions=args.allow_collisions,
    )


def read_means(args: argparse.Namespace) -> "Means":
    """By whom is searched, and how much work is given."""
    from roadproof.witness.question import Means

    return Means(engine=args.engine, solver=args.solver, effort=read_effort(args))


def named(texts: Sequence[str], usual: str) -> Iterator[tuple[str, str]]:
    """``NAME=VALUE`` texts as pairs; the name is ``usual`` where none is given."""
    for text in texts:
        name, equals, value = text.rpartition("=")
        yield (name if equals else usual), value

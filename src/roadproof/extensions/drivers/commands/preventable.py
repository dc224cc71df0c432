"""``roadproof preventable``: which initial values a driver prevents a collision from, exactly."""

import argparse

from roadproof.errors import UsageError
from roadproof.extensions.drivers.options import add_drivers
from roadproof.extensions.drivers.settings import Preventable, flat
from roadproof.frontends.cli.basis import deliver, read_definitions, study_keywords

SUMMARY = "map the initial values from which a driver prevents a collision"

EXAMPLES = """\
examples:
  roadproof preventable cut-in                            sheets for all models
  roadproof preventable 1 --at dy0=2.2 --at Vy=0.5        drives of the scenario: they begin safe
  roadproof preventable cut-in --model careful,r157 --at 'Ve0=60km/h' --at Vy=1 --out cut-in
  roadproof preventable deceleration --at Ve0=60km/h,130km/h --along dx0=0:120
  roadproof preventable cut-in --tests report/drivers.csv --out plates       your tests as points
  roadproof preventable deceleration --at dGdt=5    POV's braking grows by 5 m/s^3, and is not there at once
  roadproof preventable cut-out --option cc_gate=none --param cc_delay=0.5
  roadproof preventable cut-in --option cc_perception=overlap     another reading of the regulation
  roadproof preventable cut-in --model careful --option cc_aeb=max    AEB after full wrap

A plate varies two initial values and fixes the others. On each of its lines, the ends of the unpreventable
range are exact. A judged drive on each side follows the model: one ends in a collision, the other never does.
The lemmas say why the formula (--spec driver) is the boundary. The fuzzy safety model (fsm) is a controller
that looks ten times a second: its points are decided one by one, and nothing is claimed between them.
Each row of --tests has a name (column test) and initial values in SI units. It is drawn on the plate with the
nearest fixed values; a hollow point has others than its plate.
With --out: evidence, plates.csv, plates.png.
"""
OPTIONS = Preventable


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "manoeuvre", metavar="MANOEUVRE", help="cut-in, cut-out, deceleration; or a scenario: 1, 2 or 4"
    )


def run(args: argparse.Namespace) -> int:
    from roadproof.extensions.drivers.manoeuvres import MANOEUVRES
    from roadproof.extensions.drivers.models import manoeuvre_of
    from roadproof.extensions.drivers.preventing import preventable

    add_drivers(args)
    kind = MANOEUVRES[manoeuvre_of(args.manoeuvre)[0]]
    given = study_keywords(args, OPTIONS)
    given |= {"along": _range("--along", args.along, kind.line)}
    given |= {"across": _range("--across", args.across, kind.across)}
    home = read_definitions(args, OPTIONS)
    return deliver(args, preventable(args.manoeuvre, flat(args.models or ()), home, **given), args.pictures)


def _range(option: str, text: str | None, name: str) -> tuple[str, str] | None:
    """The range that a text names. Raises ``UsageError`` where it is that of something else."""
    if text is None:
        return None
    stated, equals, value = text.partition("=")
    low, colon, high = value.partition(":")
    if not equals or not colon:
        raise UsageError(f"{option} {text}: write {name}=LOW:HIGH")
    if stated.strip() != name:
        raise UsageError(f"{option} {text}: this plate varies {name}; write {name}=LOW:HIGH")
    return low.strip(), high.strip()

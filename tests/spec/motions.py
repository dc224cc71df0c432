"""Random drives on which vehicles pass each other, turn round, and leave lanes; facts that speak of them."""

from fractions import Fraction
from random import Random

from roadproof.library.assumption import Axiom
from roadproof.library.bind import bind, default_values
from roadproof.library.elaborate import read_claim
from roadproof.library.loading import bundled_library
from roadproof.logic.formula import Formula
from roadproof.semantics.exact import judge
from roadproof.world.drive import Drive, Motion, Piece
from roadproof.world.models import load_road

specification = bundled_library().select("base")
ABOUT = read_claim(
    specification, "given v: m/s: G (s(SV) <= s(POV) and v_lon(SV) <= v and atLane(SV,L) and atLane(POV,L))"
)
ROAD = load_road("main-2")
VALUES = default_values(specification.library)

TWICE = ("within-twice", "after-twice")
# Each schema with terms of every kind: places, speeds, sizes, parameters, factors.
AXIOMS = [
    *(Axiom(schema, ("s(SV)", "s(POV)")) for schema in ("at-most", "below", "meets")),
    *(Axiom(schema, ("s(POV) - length(POV)", "s(SV)")) for schema in ("at-most", "below", "meets")),
    *(Axiom(schema, ("v_lon(SV)", "v_lon(POV)")) for schema in ("at-most", "below", "meets")),
    *(Axiom(schema, ("d(SV) - width(SV)", "7/2*1 m")) for schema in ("at-most", "below", "meets")),
    *(Axiom(schema, ("2*s(SV) - s(POV) + rho*v_lon(POV)", "d(SV)")) for schema in ("at-most", "below")),
    Axiom("at-most", ("(s(SV) - s(POV))*a_max/b_min", "1 m")),
    Axiom("meets", ("max(d(SV), d(POV))", "s(POV)^2/(10 m)")),
    *(Axiom("leaves", (f"{x}atLane({v},L)",)) for v in ("SV", "POV") for x in ("",)),
    Axiom("leaves", ("every M in lanes: atLane(SV,M) or atLane(POV,L)",)),
    Axiom("leaves", ("s(SV) < s(POV) and (v_lat(SV) > 0 m/s or d(POV)*s(SV) > 2 m * v_lon(POV)*1 s)",)),
    Axiom("leaves", ("not rssViolation(SV,POV)",)),
    *(Axiom(schema, ("s(SV)", "s(POV) + 3 m", "2 m/s", "3/2*1 s")) for schema in ("within", "after")),
    *(Axiom(schema, ("v_lon(SV)", "4 m/s", "-2 m/s^2", "2 s")) for schema in ("within", "after")),
    *(Axiom(schema, ("0 m", "d(POV)", "1 m/s - a_max*rho", "minSafe")) for schema in ("within", "after")),
    *(Axiom(x, ("s(SV)", "s(POV) + 3 m", "2 m/s", "1 m/s^2", "3/2*1 s")) for x in TWICE),
    *(Axiom(x, ("s(SV)", "s(POV)", "2 m/s", "-2 m/s^2", "2 s")) for x in TWICE),
    *(Axiom(x, ("d(POV)", "d(SV) + width(SV)", "-1 m/s", "a_max", "minSafe")) for x in TWICE),
    *(Axiom(x, ("0 m", "2*s(POV) - s(SV)", "1 m/s", "0 m/s^2", "1 s")) for x in TWICE),
]


def random_drive(seed: int) -> Drive:
    """Two vehicles close to each other and to the lines of lanes."""
    pick = Random(seed)

    def part(low: int, high: int, by: int = 2) -> Fraction:
        return Fraction(pick.randint(low * by, high * by), by)

    def motion() -> Motion:
        times = [part(0, 2) + Fraction(1, 2) for _ in range(pick.randint(0, 4))]
        pieces = [
            Piece(x, *(pick.choice((Fraction(0), part(-k, k))) for k in (4, 2))) for x in [*times, None]
        ]
        start = part(-4, 4), part(1, 8), part(-5, 6), part(-2, 2)
        return Motion(Fraction(4), Fraction(2), *start, tuple(pieces))

    return Drive({name: motion() for name in ("SV", "POV")})


def holds(formula: Formula, drive: Drive) -> bool:
    """Whether a fact about SV and POV, L being the right lane, is true on a drive, judged exactly."""
    return judge(bind(formula, ROAD, {"L": "main-1"}, VALUES), drive).holds

"""A drive file as a module of Coq: the claim, the drive, and that the one is true of the other.

Trusted, but for the derivation: it says what is proved. Numbers are those of the file.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from itertools import combinations

from roadproof.errors import InputError
from roadproof.evidence.drive_file import DriveFile
from roadproof.evidence.kernel.derivation import Step, coq_derivation, rational
from roadproof.evidence.kernel.names import literal, quoted
from roadproof.evidence.kernel.printer import Formals, Printer
from roadproof.evidence.kernel.source import ClaimText, Module, claim_lines, comment_lines
from roadproof.evidence.kernel.source import claim_text as coq_claim
from roadproof.evidence.kernel.statement import bounds_of, formals_of
from roadproof.library.bind import refuse_variables, values_with
from roadproof.library.elaborate import read_claim
from roadproof.library.specification import Library
from roadproof.logic import formula as f
from roadproof.logic import terms as t
from roadproof.logic.custom_names import own_of, vehicles_with_kind
from roadproof.logic.formula import Formula, boxes_overlap
from roadproof.logic.rewrite import parameters_of
from roadproof.world.drive import Course, Motion
from roadproof.world.road import Lanelet, Road


@dataclass(frozen=True)
class Shown:
    """What a drive file shows: ``formula`` is its claim, and that boxes stay apart where it says so.

    ``values`` and ``bounds`` (name: strictly above 0) are those of the parameters that it speaks of.
    """

    file: DriveFile
    formula: Formula
    values: Mapping[str, Fraction]
    bounds: Mapping[str, bool]
    formals: Formals


def shown(file: DriveFile, library: Library) -> Shown:
    """What is to be proved of a drive file. Raises ``InputError`` where it does not fit the library."""
    specification = library.select(file.set_name, file.options)
    query = read_claim(specification, file.formula, "formula")
    refuse_variables(query.formula)
    for vehicle in query.vehicles:
        if vehicle not in file.drive.vehicles:
            raise InputError(f"the file has no vehicle {vehicle}")
    for name in query.lanes:
        if file.lanes.get(name) not in file.road.lanes:
            raise InputError(f"lane {name}={file.lanes.get(name)}: the road has {', '.join(file.road.lanes)}")
    values = values_with(library, file.values)
    spoken = parameters_of(query.formula)
    return Shown(
        file,
        f.And((f.Application("shown_of_it", (), query.formula), *_apart(file))),
        {name: values[name] for name in spoken},
        bounds_of(specification, spoken),
        formals_of(specification),
    )


def _apart(file: DriveFile) -> Iterator[Formula]:
    """Boxes do not overlap up to the horizon; touching is no overlap."""
    if file.overlaps_allowed:
        return
    seconds = (0, 1)
    interval = f.Interval(t.Number(Fraction(0), seconds), t.Number(file.horizon, seconds))
    for a, b in combinations(sorted(file.drive.vehicles), 2):
        yield f.Always(interval, f.Application("apart", (a, b), f.Not(boxes_overlap(a, b))))


def claim_text(shown: Shown) -> ClaimText:
    """Raises ``InputError`` for what is not printed."""
    drive = shown.file.drive
    for name in vehicles_with_kind(shown.formula):
        if drive.vehicles[name].kind is None:
            raise InputError(f"the file does not say of what kind {name} is")
    for signal in own_of([shown.formula]):
        if (signal.name, signal.vehicle) not in drive.own:
            raise InputError(f"the file does not say what {signal.told} is")
    return coq_claim(Printer(shown.formals), shown.formula)


def module(name: str, shown: Shown, printed: ClaimText, derivation: Step) -> Module:
    """The module that proves it. Raises ``InputError`` for what is not printed."""
    file = shown.file
    out = [f"Module {name}.", "Import Roadproof.Drive Roadproof.Shown."]
    out += comment_lines([f"A drive, set {file.set_name}:", file.formula])
    out += [*claim_lines(printed, shown.bounds), "", "Open Scope Q_scope."]
    out += ["Definition the_drive : drive :=", *drive_lines(shown), ".", ""]
    out += ["(* From here on it is proof: what is proved is said in the theorem at the end. *)"]
    theorem = len(out) + 1
    out += ["Definition reasons : derivation :=", *coq_derivation(derivation), ".", ""]
    out += [
        "Theorem proved : Roadproof.Drive.shows the_drive bounds claim.",
        "Proof.",
        "  refine (Roadproof.Shown.shown the_drive bounds claim reasons _).",
        "  vm_cast_no_check (eq_refl true).",
        "Qed.",
        f"End {name}.",
    ]
    return Module(name, "\n".join(out) + "\n", (), theorem)


def drive_lines(shown: Shown) -> Iterator[str]:
    """The drive as a term of Drive.v. Raises ``InputError`` for names that are not printed."""
    file = shown.file
    if not file.road.lanelets:
        raise InputError("a road without lanelets is not printed")
    yield "{|"
    bodies = [_body(name, motion) for name, motion in file.drive.vehicles.items()]
    yield from _field("bodies", bodies)
    first, *others = map(_rectangle, file.road.lanelets)
    yield f"  first_rectangle := {first};"
    yield from _field("other_rectangles", others)
    yield from _field("beside", [_pair(quoted(a), quoted(b)) for a, b in beside(file.road)])
    yield from _field("lanes_named", [_pair(literal(a), quoted(b)) for a, b in sorted(file.lanes.items())])
    values = [_pair(literal(name), rational(x)) for name, x in sorted(shown.values.items())]
    yield from _field("values", values)
    yield from _field("signals", [_signal(*key, x) for key, x in sorted(file.drive.own.items())], "")
    yield "|}"


def _field(name: str, items: Sequence[str], end: str = ";") -> Iterator[str]:
    if not items:
        yield f"  {name} := []{end}"
        return
    yield f"  {name} := ["
    for place, item in enumerate(items):
        yield f"    {item}{';' if place + 1 < len(items) else ''}"
    yield f"  ]{end}"


def _pair(one: str, other: str) -> str:
    return f"({one}, {other})"


def beside(road: Road) -> list[tuple[str, str]]:
    found = sorted(tuple(sorted(pair)) for pair in road.adjacent)
    return [(a, b) for a, b in found]


def _rectangle(x: Lanelet) -> str:
    low, high = ("None" if y is None else f"Some {rational(y)}" for y in x.s)
    return (
        f"{{| lane := {quoted(x.lane)}; lies_in := {x.zone}; from_s := {low}; to_s := {high}; "
        f"right_d := {rational(x.d[0])}; left_d := {rational(x.d[1])} |}}"
    )


def _signal(name: str, vehicle: str, course: Course) -> str:
    steps = "; ".join(_pair(rational(start), rational(value)) for start, value in course)
    return f"({literal(name)}, {quoted(vehicle)}, [{steps}])"


def _body(name: str, motion: Motion) -> str:
    along = _course(motion.s, motion.v_lon, [(p.duration, p.a_lon, p.j_lon) for p in motion.pieces])
    across = _course(motion.d, motion.v_lat, [(p.duration, p.a_lat, Fraction(0)) for p in motion.pieces])
    return (
        f"({literal(name)}, {{| is_a := {motion.kind or 'other'};\n"
        f"      long := {rational(motion.length)}; wide := {rational(motion.width)};\n"
        f"      long_above_0 := eq_refl; wide_above_0 := eq_refl;\n"
        f"      along := {along};\n      across := {across} |}})"
    )


def _course(
    place: Fraction, speed: Fraction, pieces: Sequence[tuple[Fraction | None, Fraction, Fraction]]
) -> str:
    """``pieces``: duration, acceleration and jerk; the last is for ever and without jerk."""
    *before, (_, last, _) = pieces
    shown = [f"({', '.join(rational(x) for x in piece if x is not None)})" for piece in before]
    return (
        f"{{| starts_at := {rational(place)}; starts_with := {rational(speed)};\n"
        f"        pieces := [{'; '.join(shown)}]; finally := {rational(last)} |}}"
    )

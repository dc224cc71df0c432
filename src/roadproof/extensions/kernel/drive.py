"""A drive file as a module of Coq: the claim, the drive, and that the one is true of the other.

Trusted, but for the derivation: it says what is proved. Numbers are those of the file.
"""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from fractions import Fraction
from itertools import combinations

from roadproof.errors import InputError
from roadproof.evidence.drive_file import DriveFile
from roadproof.extensions.kernel.derivation import Step, coq_derivation
from roadproof.extensions.kernel.printer import Formals, Printer
from roadproof.extensions.kernel.source import ClaimText, Module, claim_lines, comment_lines
from roadproof.extensions.kernel.source import claim_text as coq_claim
from roadproof.extensions.kernel.statement import bounds_of, formals_of
from roadproof.extensions.kernel.world import Steps, World, road_with_lanelets, world_lines
from roadproof.library.bind import refuse_variables, values_with
from roadproof.library.elaborate import read_claim
from roadproof.library.specification import Library
from roadproof.logic import formula as f
from roadproof.logic import terms as t
from roadproof.logic.custom_names import own_of, vehicles_with_kind
from roadproof.logic.formula import Formula, boxes_overlap
from roadproof.logic.rewrite import parameters_of


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

    @property
    def world(self) -> World:
        drive = self.file.drive
        steps: dict[t.Varying, Steps] = {
            t.Own(*key): tuple((start, value, value) for start, value in course)
            for key, course in sorted(drive.own.items())
        }
        road = road_with_lanelets(self.file.road)
        return World(drive.vehicles, road, self.file.lanes, self.values, steps)


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
    out += ["Definition the_drive : drive :=", *world_lines(shown.world), ".", ""]
    said = "Roadproof.Drive.shows the_drive bounds claim"
    return closed(name, out, said, "Roadproof.Shown.shown the_drive bounds claim", derivation)


def closed(name: str, out: list[str], said: str, by: str, derivation: Step) -> Module:
    """A module that begins with ``out`` and proves what is ``said``, ``by`` a theorem and a derivation."""
    proof = [
        "(* From here on it is proof: what is proved is said in the theorem at the end. *)",
        "Definition reasons : derivation :=",
        *coq_derivation(derivation),
        *(".", ""),
        f"Theorem proved : {said}.",
        "Proof.",
        f"  refine ({by} reasons _).",
        "  vm_cast_no_check (eq_refl true).",
        "Qed.",
        f"End {name}.",
    ]
    return Module(name, "\n".join([*out, *proof]) + "\n", (), len(out) + 2)

"""A drive file as a Coq module: the claim, the drive, and the theorem that the claim holds on the drive.

Trusted, except for the derivation, since it states the theorem. Numbers are those of the file.
"""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from fractions import Fraction
from itertools import combinations

from roadproof.errors import InputError
from roadproof.evidence.drive_file import DriveFile
from roadproof.extensions.kernel.derivation import DerivationStep, coq_derivation
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
from roadproof.logic.custom_names import custom_signals_of, vehicles_with_kind
from roadproof.logic.formula import Formula, boxes_overlap
from roadproof.logic.rewrite import parameters_of


@dataclass(frozen=True)
class DriveStatement:
    """The theorem about a drive file: ``formula`` is its claim, and that boxes stay apart if the file says
    so.

    ``values`` and ``bounds`` (name: strictly above 0) are those of the parameters in the formula.
    """

    file: DriveFile
    formula: Formula
    values: Mapping[str, Fraction]
    bounds: Mapping[str, bool]
    formals: Formals

    @property
    def world(self) -> World:
        """The drive as a world of Drive.v."""
        drive = self.file.drive
        steps: dict[t.Varying, Steps] = {
            t.CustomSignal(*key): tuple((start, value, value) for start, value in course)
            for key, course in sorted(drive.custom_signals.items())
        }
        road = road_with_lanelets(self.file.road)
        return World(drive.vehicles, road, self.file.lanes, self.values, steps)


def drive_statement(file: DriveFile, library: Library) -> DriveStatement:
    """Return the theorem about a drive file. Raises ``InputError`` if it does not fit the library."""
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
    parameters = parameters_of(query.formula)
    return DriveStatement(
        file,
        f.And((f.Application("shown_of_it", (), query.formula), *_no_overlap(file))),
        {name: values[name] for name in parameters},
        bounds_of(specification, parameters),
        formals_of(specification),
    )


def _no_overlap(file: DriveFile) -> Iterator[Formula]:
    """Yield the formulas that boxes do not overlap up to the horizon; touching is no overlap."""
    if file.overlaps_allowed:
        return
    seconds = (0, 1)
    interval = f.Interval(t.Number(Fraction(0), seconds), t.Number(file.horizon, seconds))
    for a, b in combinations(sorted(file.drive.vehicles), 2):
        yield f.Always(interval, f.Application("apart", (a, b), f.Not(boxes_overlap(a, b))))


def drive_claim_text(statement: DriveStatement) -> ClaimText:
    """Return the printed claim. Raises ``InputError`` if it cannot be printed."""
    drive = statement.file.drive
    for name in vehicles_with_kind(statement.formula):
        if drive.vehicles[name].kind is None:
            raise InputError(f"the file does not say of what kind {name} is")
    for signal in custom_signals_of([statement.formula]):
        if (signal.name, signal.vehicle) not in drive.custom_signals:
            raise InputError(f"the file does not say what {signal.text} is")
    return coq_claim(Printer(statement.formals), statement.formula)


def drive_module(
    name: str, statement: DriveStatement, printed: ClaimText, derivation: DerivationStep
) -> Module:
    """Return the module that proves the theorem. Raises ``InputError`` if it cannot be printed."""
    file = statement.file
    out = [f"Module {name}.", "Import Roadproof.Drive Roadproof.Shown."]
    out += comment_lines([f"A drive, set {file.set_name}:", file.formula])
    out += [*claim_lines(printed, statement.bounds), "", "Open Scope Q_scope."]
    out += ["Definition the_drive : drive :=", *world_lines(statement.world), ".", ""]
    theorem = "Roadproof.Drive.shows the_drive bounds claim"
    return proof_module(name, out, theorem, "Roadproof.Shown.shown the_drive bounds claim", derivation)


def proof_module(name: str, out: list[str], theorem: str, lemma: str, derivation: DerivationStep) -> Module:
    """Return a module that begins with ``out`` and proves ``theorem`` by a lemma and a derivation."""
    proof = [
        "(* From here on it is proof: what is proved is said in the theorem at the end. *)",
        "Definition reasons : derivation :=",
        *coq_derivation(derivation),
        *(".", ""),
        f"Theorem proved : {theorem}.",
        "Proof.",
        f"  refine ({lemma} reasons _).",
        "  vm_cast_no_check (eq_refl true).",
        "Qed.",
        f"End {name}.",
    ]
    return Module(name, "\n".join([*out, *proof]) + "\n", (), len(out) + 2)

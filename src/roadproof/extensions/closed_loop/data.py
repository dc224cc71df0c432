"""The question and the answer of ``roadproof falsify`` as plain data."""

from collections.abc import Mapping
from fractions import Fraction
from typing import Annotated, Final, Literal, TypeAlias

from roadproof.evidence.answers import headings, shared
from roadproof.evidence.codec import Doc, Rule
from roadproof.evidence.schema_notes import FileOrEvidence
from roadproof.extensions.drivers.verdict import DriverVerdict
from roadproof.runtime.records import dataclass

SCHEMA: Final = "roadproof/falsify/1"
Finding: TypeAlias = Literal["FAILS", "SHOWN", "NOT SHOWN", "IMPOSSIBLE", "ERROR"]
"""The findings about a target.

FAILS: a judged drive breaks a requirement. SHOWN: a judged drive shows the target, and no failure was found.
NOT SHOWN: no drive was found. IMPOSSIBLE: it is proved that there is none. ERROR: the controller failed.
"""
Kind: TypeAlias = Literal["python", "fmu", "command"]
Method: TypeAlias = Literal["cma", "random"]
Wanted: TypeAlias = Literal["any", "preventable"]
Name: TypeAlias = Annotated[str, Rule(least=1)]
Sha: TypeAlias = Annotated[str, Rule(pattern="^[0-9a-f]{64}$", called="SHA-256")]


@dataclass(frozen=True, kw_only=True)
class FalsifyRequest:
    """A controller, the targets, the requirements, and the limits of the search."""

    controller: Annotated[Name, Doc("FILE.py:NAME, FILE.fmu, or a command.")]
    kind: Kind
    sha256: Annotated[Sha, Doc("Of the files of the controller that were found.")]
    scenarios: Annotated[tuple[shared.Number, ...], Rule(least=1)]
    require: Annotated[tuple[Name, ...], Rule(least=1), Doc("Requirements, each of the form G φ.")]
    drivers: Annotated[tuple[str, ...], Doc("Driver models that are put in the place of SV.")]
    classes: Annotated[bool, Doc("Whether classes that no drive shows are aimed at, too.")]
    simulations: Annotated[int, Rule(minimum=1), Doc("At most so many simulations for each target.")]
    seed: Annotated[int, Rule(minimum=0)]
    dt: Annotated[Fraction, Doc("The step of the controller, in s.")]
    seconds: Annotated[Fraction, Doc("How long each simulation is, in s.")]
    method: Method
    wanted: Annotated[Wanted, Doc("The failures that count: any, or those that a driver model prevents.")]
    seeds: Annotated[tuple[Sha, ...], Doc("Of drives from which the searches also start.")]
    patience: Annotated[float, Doc("Seconds that the controller may take for a simulation or a reply.")]


@dataclass(frozen=True, kw_only=True)
class TargetResult:
    """The finding about a scenario or a class, with its drives."""

    name: Name
    title: str
    finding: Finding
    simulations: Annotated[int, Rule(minimum=0)]
    first_failure: Annotated[int, Rule(minimum=0), Doc("Simulations up to the first failure; 0 for none.")]
    first_preventable: Annotated[
        int, Rule(minimum=0), Doc("Simulations up to the first failure that a driver prevents; 0 for none.")
    ]
    nearest: Annotated[
        float | None,
        Doc(
            "The greatest margin of the target in a simulation, negative if it was not shown; null for none."
        ),
    ]
    shown_by: Annotated[tuple[str, ...], Doc("Names of the drives that show it.")]
    failing: Annotated[shared.DriveField, Doc("The failing drive: its file, or itself without a folder.")]
    values: Annotated[Mapping[str, float], Doc("How the failing drive begins, and what POV does (SI).")]
    driven: Annotated[
        Mapping[str, shared.DriveField],
        Doc("By driver model, its drive in the place of SV in the failing drive."),
    ]
    simulated: Annotated[
        object,
        FileOrEvidence(("simulations.json",)),
        Doc("All simulations: their file, or themselves without a folder; null where there was no search."),
    ]
    drivers: Annotated[
        tuple[DriverVerdict, ...], Doc("Driver models in the place of SV in the failing drive.")
    ]
    reason: shared.Reason


@dataclass(frozen=True, kw_only=True)
class FalsifyData(headings.AnswerHeading):
    """The answer of ``falsify``: in which scenarios a vehicle under test fails."""

    schema: Literal["roadproof/falsify/1"] = SCHEMA
    set: shared.SetName
    request: FalsifyRequest
    options: shared.Options
    parameters: shared.Parameters
    specs: shared.Specifications
    view: shared.Dense = "dense"
    seconds: shared.Seconds = 0.0
    targets: tuple[TargetResult, ...]
    classes_shown: Annotated[int, Rule(minimum=0)]
    classes_possible: Annotated[int, Rule(minimum=0), Doc("0 where classes were not asked for.")]

"""The question and the answer of ``roadproof resimulate`` as plain data."""

from collections.abc import Mapping
from fractions import Fraction
from typing import Annotated, Final, Literal, TypeAlias

from roadproof.evidence.answers import headings, shared
from roadproof.evidence.codec import Doc, Rule
from roadproof.extensions.closed_loop.data import Kind, Name, Sha
from roadproof.extensions.drivers.verdict import DriverVerdict
from roadproof.runtime.records import dataclass

SCHEMA: Final = "roadproof/resimulate/1"
OccurrenceFinding: TypeAlias = Literal["FAILS", "KEPT", "ERROR"]
"""The findings about an occurrence.

FAILS: a judged drive breaks a requirement. KEPT: a judged drive keeps all requirements. ERROR: the controller
failed, or no drive was judged.
"""


@dataclass(frozen=True, kw_only=True)
class RecordedOccurrence:
    """Scenarios that occur in a recording or a drive with one SV, from a frame on."""

    id: Annotated[str, Rule(least=1, pattern="^[A-Za-z0-9_]+$"), Doc("Its name in this answer.")]
    recording: Annotated[Name, Doc("The name of the recording, or of the file of the drive.")]
    scenarios: Annotated[tuple[shared.Number, ...], Doc("Those that occur; a drive may show none.")]
    vehicles: Annotated[Mapping[str, str], Doc("The vehicles of the recording or drive, by role.")]
    lane: Annotated[str, Doc("The lane of the match; empty where the scenarios name none.")]
    first_frame: int
    seconds: Annotated[Fraction, Doc("How long the controller drives, in s.")]
    others: Annotated[int, Rule(minimum=0), Doc("Further vehicles that the controller sees.")]
    left_out: Annotated[
        int, Rule(minimum=0), Doc("Vehicles nearby that are left out, since they come or go meanwhile.")
    ]
    deviation: Annotated[
        float, Rule(minimum=0), Doc("By how much other vehicles are off their places at most, in m.")
    ]
    gap: Annotated[
        float | None,
        Doc("The least gap of the former SV to a POV in its way, in m; null where there is none."),
    ]
    sha256: Annotated[Sha, Doc("Of the motion of all vehicles, of their limits and of the road.")]


@dataclass(frozen=True, kw_only=True)
class ResimulationRequest:
    """A controller, the occurrences, and the requirements."""

    controller: Annotated[Name, Doc("FILE.py:NAME, FILE.fmu, or a command.")]
    kind: Kind
    sha256: Annotated[Sha, Doc("Of the files of the controller that were found.")]
    recordings: Annotated[Name, Doc("The path of the recordings or drives.")]
    scenarios: Annotated[tuple[shared.Number, ...], Rule(least=1)]
    require: Annotated[tuple[Name, ...], Rule(least=1), Doc("Requirements, each of the form G φ.")]
    drivers: Annotated[tuple[str, ...], Doc("Driver models that are put in the place of SV.")]
    dt: Annotated[Fraction, Doc("The step of the controller, in s.")]
    patience: Annotated[float, Doc("Seconds that the controller may take for a simulation or a reply.")]
    occurrences: tuple[RecordedOccurrence, ...]


@dataclass(frozen=True, kw_only=True)
class OccurrenceResult:
    """The finding about an occurrence, with its drives."""

    id: Name
    finding: OccurrenceFinding
    drive: Annotated[
        shared.DriveField,
        Doc("The drive of the controller: its file, or itself without a folder; null for none."),
    ]
    shows: Annotated[tuple[shared.Number, ...], Doc("The scenarios that this drive shows.")]
    gap: Annotated[
        float | None,
        Doc("Its least gap to a POV in its way at the steps, in m; null where there is none."),
    ]
    driven: Annotated[
        Mapping[str, shared.DriveField],
        Doc("By driver model, its drive in the place of SV in the failing drive."),
    ]
    drivers: tuple[DriverVerdict, ...]
    reason: shared.Reason


@dataclass(frozen=True, kw_only=True)
class ResimulationData(headings.AnswerHeading):
    """The answer of ``resimulate``: what a controller does in place of a recorded vehicle."""

    schema: Literal["roadproof/resimulate/1"] = SCHEMA
    set: shared.SetName
    request: ResimulationRequest
    options: shared.Options
    parameters: shared.Parameters
    specs: shared.Specifications
    view: shared.Dense = "dense"
    seconds: shared.Seconds = 0.0
    occurrences: tuple[OccurrenceResult, ...]

"""Types of fields that several answers share, and how every answer begins."""

from collections.abc import Mapping
from fractions import Fraction
from typing import Annotated, Any, Literal, TypeAlias

from roadproof import reasons
from roadproof.evidence.codec import LEFT_OUT, TIMED, Doc, Rule
from roadproof.evidence.json_schema import Other, Plain, Shared
from roadproof.library.words import Words
from roadproof.runtime.records import dataclass
from roadproof.world.length_error import length_error_of
from roadproof.world.road import Road
from roadproof.world.unread import unread_of_road

Formula: TypeAlias = Annotated[
    str, Rule(least=1), Doc("A formula or a claim as text (docs/reference/language.md)."), Shared("formula")
]
Number: TypeAlias = Annotated[int, Rule(minimum=0), Doc("Number of a scenario."), Shared("number")]
Count: TypeAlias = Annotated[int, Rule(minimum=0)]
SetName: TypeAlias = Annotated[str, Rule(least=1), Doc("Name of a spec set."), Shared("set")]
KeptFile: TypeAlias = Annotated[
    object,
    Plain(str),
    Rule(least=1),
    Doc("Path of a file of evidence; in an index as it is from the index's folder."),
    Shared("file"),
]
OneScenario: TypeAlias = Annotated[
    int | None,
    Rule(minimum=0),
    Doc("Number of the scenario; null where the question is no scenario."),
    Shared("scenario"),
]
Assuming: TypeAlias = Annotated[
    tuple[Formula, ...],
    Rule(least=1),
    Doc(
        "What the claim is said under: motion, and then limits such as a_lon(SV) <= 3 m/s^2; then, or alone, "
        "values of parameters such as minDanger = 0.6 s. Evidence that assumes nothing does not have it."
    ),
    Shared("assuming"),
]
KeptWords: TypeAlias = Annotated[Words, Shared("words")]
KernelWord: TypeAlias = Annotated[
    str, Rule(pattern=r"^(accepted|refused|unknown( \(lemma [0-9]+\))?)$"), Shared("kernel_word")
]
SetNames: TypeAlias = Annotated[
    tuple[SetName, ...],
    Rule(least=1),
    Doc("Spec sets; names without @ are read in the first."),
    Shared("sets"),
]
ScenarioName: TypeAlias = Annotated[
    str,
    Rule(pattern="^[0-9]+@[A-Za-z_][A-Za-z0-9_]*$", called="scenario in a set, such as 4@base"),
    Doc("A scenario in a set, such as 4@base."),
    Shared("named_scenario"),
]
Rational: TypeAlias = Annotated[
    str,
    Rule(pattern="^-?[0-9]{1,40}(/[0-9]{1,40})?$", called="rational"),
    Doc('An exact number, such as "3/5".'),
    Shared("rational"),
]
Seconds: TypeAlias = Annotated[
    float,
    Rule(minimum=0),
    TIMED,
    Doc("How long it took, in s; differs from run to run. Files of evidence leave it out."),
    Shared("seconds"),
]


@dataclass(frozen=True, kw_only=True)
class Binding:
    """A name with what it stands for."""

    name: str
    sort: Annotated[str, Doc("vehicle, vehicles, lane, lanelet, or the unit of a number.")]


KeptBinding: TypeAlias = Annotated[Binding, Shared("binding")]


@dataclass(frozen=True, kw_only=True)
class Kernel:
    """What Coq needed, and the axioms that all that it accepted stands on; or the extracted program."""

    coqc: Annotated[str, Doc("Its version; empty with --kernel extracted.")]
    ocaml: Annotated[
        str, LEFT_OUT, Doc("With --kernel extracted, the version of the OCaml that compiled the program.")
    ] = ""
    seconds: Seconds = 0.0
    megabytes: Annotated[int, Rule(minimum=0), Doc("Of Coq; 0 with --kernel extracted.")]
    axioms: tuple[str, ...]


KeptKernel: TypeAlias = Annotated[
    Kernel,
    Doc("With --kernel: what it needed, and the axioms of Coq that all that it accepted stands on."),
    Shared("kernel"),
]
Reason: TypeAlias = Annotated[
    reasons.Reason,
    Doc("Why it is in doubt, or a note on it, in words; empty where there is nothing to say."),
    Shared("reason"),
]
KeptCertificate: TypeAlias = Annotated[
    object,
    Other(("certificate.json",)),
    Doc("A certificate: its file where evidence goes to a folder, else itself; null where there is none."),
    Shared("kept_certificate"),
]
KeptDrive: TypeAlias = Annotated[
    object,
    Other(("drive.json",)),
    Doc("A judged drive: its file where evidence goes to a folder, else itself; null where there is none."),
    Shared("kept_drive"),
]
KeptEvidence: TypeAlias = Annotated[
    object,
    Other(("certificate.json", "drive.json", "refutation.json")),
    Doc("A certificate, drive or refuting trace: its file, or itself without a folder; null where none is."),
    Shared("kept_evidence"),
]


@dataclass(frozen=True, kw_only=True)
class Limits:
    """Within what a NONE-WITHIN or PROVED-BOUNDED says that there is no drive."""

    road: Annotated[str, Doc("Name of the road.")]
    dt: Annotated[Fraction, Doc("Time between samples, in s.")]
    horizon: Annotated[Fraction, Doc("Time of the last sample, in s.")]
    read: Annotated[str, Doc("Where the formula is read, in words.")]
    accelerations: Annotated[str, Doc("How vehicles accelerate, in words.")]
    boxes: Annotated[str, Doc("Where boxes of vehicles are, in words.")]
    vehicles: Annotated[Mapping[str, str], Doc("Model by vehicle.")]
    lanes: Annotated[Mapping[str, str], Doc("Free lanes that stand for one lane only.")]
    parameters: Annotated[
        Mapping[str, Fraction], Doc("Values of parameters by name, in SI units (s, m, m/s, m/s^2).")
    ]
    reach: Annotated[Fraction, Doc("How far apart vehicles start at most, in m.")]
    starts: Annotated[
        tuple[Fraction, Fraction] | None,
        Doc("Between which places the first vehicle starts, in m; null where it makes no difference."),
    ]
    shown: Annotated[tuple[str, ...], Doc("Who says so of which part, in words.")]
    signals: Annotated[
        Mapping[str, str] | None,
        LEFT_OUT,
        Doc(
            "Between which values own signals are looked for, constant between samples; left out where "
            "there are none."
        ),
    ] = None


KeptLimits: TypeAlias = Annotated[object, Plain(Limits), Shared("limits")]
Version: TypeAlias = Annotated[
    str,
    Rule(pattern=r"^[0-9]+\.[0-9]+"),
    Doc("Version of roadproof that gave the answer."),
    Shared("version"),
]
Fingerprint: TypeAlias = Annotated[
    str,
    Doc(
        "Fingerprint of all that the specification files in use declare, those of --spec among them: two "
        "answers with one fingerprint read names alike."
    ),
    Rule(pattern="^[0-9a-f]{16}$", called="fingerprint of 16 digits from 0 to f"),
    Shared("library"),
]
Signals: TypeAlias = Annotated[
    Mapping[str, Annotated[str, Rule(least=1)]],
    Rule(least=1),
    Doc(
        "Own signals that the specification does not derive, and what an answer supposes of them; a proof "
        "holds for all such functions, a drive has one, in a recording they are read. Left out where there "
        "are none."
    ),
    Shared("signals"),
]
Options: TypeAlias = Annotated[
    Mapping[str, str], Doc("The chosen reading of each option, by name."), Shared("options")
]
Parameters: TypeAlias = Annotated[
    Mapping[str, Rational],
    Doc("Values of parameters by name, in SI units (s, m, m/s, m/s^2)."),
    Shared("parameters"),
]
Specifications: TypeAlias = Annotated[
    tuple[Annotated[str, Rule(least=1)], ...],
    Doc("Names of the users' specification files; in a folder of evidence they lie beside the index."),
    Shared("specs"),
]
Dense: TypeAlias = Annotated[
    Literal["dense"], Doc("Judged or proved in dense, unbounded time."), Shared("dense")
]


@dataclass(frozen=True, kw_only=True)
class Prevention:
    """Of a question that is asked only of what a driver model prevents, or cannot prevent."""

    side: Literal["preventable", "unpreventable"]
    driver: Annotated[Literal["careful", "r157", "eu1426", "rss"], Doc("The driver model.")]
    of: Annotated[
        Literal["scenarios", "drives"],
        Doc("What begins so: scenarios, or, for coverage, drives between two vehicles."),
    ]
    scenarios: Annotated[tuple[Number, ...], Doc("The scenarios that begin so; all others are as they are.")]
    drives_by: Annotated[
        Literal["formula", "model"],
        Doc(
            "Which drives count: by the formula of a state those that begin so; by the model those in which "
            "it, in place of SV, ends so."
        ),
    ]


KeptPrevention: TypeAlias = Annotated[
    Prevention,
    Doc(
        "Of a question that is asked only of what a driver model prevents, or cannot prevent; left out in "
        "all others."
    ),
    Shared("prevention"),
]


@dataclass(frozen=True, kw_only=True)
class LengthError:
    """How much longer or shorter lanes of a road with bends are than their s says."""

    per_cent: Annotated[float, Rule(minimum=0), Doc("At one place.")]
    metres: Annotated[float, Rule(minimum=0), Doc("On the whole way along a lane.")]


KeptLengthError: TypeAlias = Annotated[
    LengthError,
    Doc("By how much lengths in lanes differ at most from those in s; left out on straight roads."),
    Shared("length_error"),
]


LeftOutParts: TypeAlias = Annotated[
    tuple[str, ...],
    LEFT_OUT,
    Doc("Notes on vehicles and on parts of files that were left out, such as of the map of the road."),
    Shared("left_out"),
]


@dataclass(frozen=True, kw_only=True)
class OnRoad:
    """Of an answer on a road that the question may name."""

    length_error: Annotated[KeptLengthError | None, LEFT_OUT] = None
    left_out: LeftOutParts = ()

    @staticmethod
    def of_road(road: Road | None) -> dict[str, Any]:
        """The fields of an answer on a road."""
        return {"length_error": bends(road), "left_out": unread_of_road(road)}


def bends(road: Road | None) -> LengthError | None:
    """Return the error of lengths on a road; None where it is straight."""
    found = length_error_of(road)
    if found is None:
        return None
    return LengthError(per_cent=float(100 * found.share), metres=float(found.metres))


@dataclass(frozen=True, kw_only=True)
class PlainHeading:
    """How every answer begins."""

    schema: str
    roadproof: Version
    library: Fingerprint
    signals: Annotated[Signals | None, LEFT_OUT] = None


@dataclass(frozen=True, kw_only=True)
class Heading(PlainHeading):
    """How an answer begins whose question may be asked only of what a driver model prevents, or cannot."""

    prevention: Annotated[KeptPrevention | None, LEFT_OUT] = None

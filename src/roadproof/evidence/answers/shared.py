"""The types of fields that several answers share, and the heading of every answer."""

from collections.abc import Mapping
from fractions import Fraction
from typing import Annotated, Literal, TypeAlias

from roadproof import reasons
from roadproof.evidence.codec import LEFT_OUT, TIMED, Doc, Rule
from roadproof.evidence.schema_notes import DescribedBy, FileOrEvidence, SharedType
from roadproof.library.words import Words
from roadproof.runtime.records import dataclass

Formula: TypeAlias = Annotated[
    str,
    Rule(least=1),
    Doc("A formula or a claim as text (docs/reference/language.md)."),
    SharedType("formula"),
]
Number: TypeAlias = Annotated[int, Rule(minimum=0), Doc("Number of a scenario."), SharedType("number")]
Count: TypeAlias = Annotated[int, Rule(minimum=0)]
SetName: TypeAlias = Annotated[str, Rule(least=1), Doc("Name of a spec set."), SharedType("set")]
Choice: TypeAlias = Annotated[
    Literal["same", "any"], Doc("Whether both have the same, or each its own."), SharedType("choice")
]
FileField: TypeAlias = Annotated[
    object,
    DescribedBy(str),
    Rule(least=1),
    Doc("Path of a file of evidence; in an index as it is from the index's folder."),
    SharedType("file"),
]
OneScenario: TypeAlias = Annotated[
    int | None,
    Rule(minimum=0),
    Doc("Number of the scenario; null where the question is no scenario."),
    SharedType("scenario"),
]
Assuming: TypeAlias = Annotated[
    tuple[Formula, ...],
    Rule(least=1),
    Doc(
        "What the claim is said under: motion, and then limits such as a_lon(SV) <= 3 m/s^2; then, or alone, "
        "values of parameters such as minDanger = 0.6 s. Evidence that assumes nothing does not have it."
    ),
    SharedType("assuming"),
]
WordsField: TypeAlias = Annotated[Words, SharedType("words")]
KernelWord: TypeAlias = Annotated[
    str, Rule(pattern=r"^(accepted|refused|unknown( \(lemma [0-9]+\))?)$"), SharedType("kernel_word")
]
SetNames: TypeAlias = Annotated[
    tuple[SetName, ...],
    Rule(least=1),
    Doc("Spec sets; names without @ are read in the first."),
    SharedType("sets"),
]
ScenarioName: TypeAlias = Annotated[
    str,
    Rule(pattern="^[0-9]+@[A-Za-z_][A-Za-z0-9_]*$", called="scenario in a set, such as 4@base"),
    Doc("A scenario in a set, such as 4@base."),
    SharedType("named_scenario"),
]
Rational: TypeAlias = Annotated[
    str,
    Rule(pattern="^-?[0-9]{1,40}(/[0-9]{1,40})?$", called="rational"),
    Doc('An exact number, such as "3/5".'),
    SharedType("rational"),
]
Seconds: TypeAlias = Annotated[
    float,
    Rule(minimum=0),
    TIMED,
    Doc("How long it took, in s; differs from run to run. Files of evidence leave it out."),
    SharedType("seconds"),
]


@dataclass(frozen=True, kw_only=True)
class BindingData:
    """A name with the sort of thing that it denotes."""

    name: str
    sort: Annotated[str, Doc("vehicle, vehicles, lane, lanelet, or the unit of a number.")]


BindingField: TypeAlias = Annotated[BindingData, SharedType("binding")]


@dataclass(frozen=True, kw_only=True)
class Kernel:
    """The resources of Coq, and the axioms behind what it accepted; or the extracted program's version."""

    coqc: Annotated[str, Doc("Its version; empty with --kernel extracted.")]
    ocaml: Annotated[
        str, LEFT_OUT, Doc("With --kernel extracted, the version of the OCaml that compiled the program.")
    ] = ""
    seconds: Seconds = 0.0
    megabytes: Annotated[int, Rule(minimum=0), Doc("Of Coq; 0 with --kernel extracted.")]
    axioms: tuple[str, ...]


KernelField: TypeAlias = Annotated[
    Kernel,
    Doc("With --kernel: what it needed, and the axioms of Coq that all that it accepted stands on."),
    SharedType("kernel"),
]
Reason: TypeAlias = Annotated[
    reasons.Reason,
    Doc("Why it is in doubt, or a note on it, in words; empty where there is nothing to say."),
    SharedType("reason"),
]
CertificateField: TypeAlias = Annotated[
    object,
    FileOrEvidence(("certificate.json",)),
    Doc("A certificate: its file where evidence goes to a folder, else itself; null where there is none."),
    SharedType("kept_certificate"),
]
DriveField: TypeAlias = Annotated[
    object,
    FileOrEvidence(("drive.json",)),
    Doc("A judged drive: its file where evidence goes to a folder, else itself; null where there is none."),
    SharedType("kept_drive"),
]
EvidenceField: TypeAlias = Annotated[
    object,
    FileOrEvidence(("certificate.json", "drive.json", "refutation.json")),
    Doc("A certificate, drive or refuting trace: its file, or itself without a folder; null where none is."),
    SharedType("kept_evidence"),
]


@dataclass(frozen=True, kw_only=True)
class LimitsData:
    """The limits within which a NONE-WITHIN or PROVED-BOUNDED says that there is no drive."""

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
            "Between which values custom signals are looked for, constant between samples; left out where "
            "there are none."
        ),
    ] = None


LimitsField: TypeAlias = Annotated[object, DescribedBy(LimitsData), SharedType("limits")]
Version: TypeAlias = Annotated[
    str,
    Rule(pattern=r"^[0-9]+\.[0-9]+"),
    Doc("Version of roadproof that gave the answer."),
    SharedType("version"),
]
Fingerprint: TypeAlias = Annotated[
    str,
    Doc(
        "Fingerprint of all that the specification files in use declare, those of --spec among them: two "
        "answers with one fingerprint read names alike."
    ),
    Rule(pattern="^[0-9a-f]{16}$", called="fingerprint of 16 digits from 0 to f"),
    SharedType("library"),
]
Signals: TypeAlias = Annotated[
    Mapping[str, Annotated[str, Rule(least=1)]],
    Rule(least=1),
    Doc(
        "Custom signals that the specification does not derive, and what an answer supposes of them; a proof "
        "holds for all such functions, a drive has one, in a recording they are read. Left out where there "
        "are none."
    ),
    SharedType("signals"),
]
Options: TypeAlias = Annotated[
    Mapping[str, str], Doc("The chosen reading of each option, by name."), SharedType("options")
]
Parameters: TypeAlias = Annotated[
    Mapping[str, Rational],
    Doc("Values of parameters by name, in SI units (s, m, m/s, m/s^2)."),
    SharedType("parameters"),
]
Specifications: TypeAlias = Annotated[
    tuple[Annotated[str, Rule(least=1)], ...],
    Doc("Names of the users' specification files; in a folder of evidence they lie beside the index."),
    SharedType("specs"),
]
Dense: TypeAlias = Annotated[
    Literal["dense"], Doc("Judged or proved in dense, unbounded time."), SharedType("dense")
]

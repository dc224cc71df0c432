"""The record of the core: its entries in the slots that extensions fill, and the names that it reserves.

It has the schemas of files of evidence, since a start refuses an extension that adds a kind with such a name.
"""

from collections.abc import Mapping
from typing import Final

from roadproof.extension import Extension

CERTIFICATE: Final = "roadproof/certificate/2"
DRIVE: Final = "roadproof/drive/1"
JERK_DRIVE: Final = "roadproof/drive/2"
DRIVES: Final = (DRIVE, JERK_DRIVE)
NONE_WITHIN: Final = "roadproof/none-within/1"
REFUTATION: Final = "roadproof/refutation/1"
UNDECIDED: Final = "roadproof/undecided/1"
JUDGED: Final = "roadproof/judged/1"

READERS: Final[Mapping[str, str]] = {
    CERTIFICATE: "roadproof.evidence.readers.certificate:certificate_for",
    **dict.fromkeys(DRIVES, "roadproof.evidence.readers.drive:drive_for"),
    NONE_WITHIN: "roadproof.evidence.readers.none_within:none_within_for",
    REFUTATION: "roadproof.evidence.readers.refutation:refuting_trace_for",
    UNDECIDED: "roadproof.evidence.readers.plain:undecided_for",
    JUDGED: "roadproof.evidence.readers.plain:judged_trace_for",
}
"""Functions of a claim, the parsed JSON and the path that return evidence, as ``module:name``, by schema."""

_PHRASES = (
    *(
        "SV",
        "POV",
        "POV1",
        "POV2",
        "L",
        "F",
        "G",
        "U",
        "W",
        "R",
        "O",
        "H",
        "S",
        "lanes",
        "lanelets",
        "zone",
        "adjacent_lanes",
    ),
    *("some", "every", "vehicle", "lane", "parameter", "call"),
)
_ERRORS = (
    *("RoadproofError", "InputError", "UsageError", "TextError", "TextErrors", "MissingSolverError"),
    "SharedError",
)
_FUNCTIONS = {
    "load": "frontends.api.definitions",
    "Definitions": "frontends.api.definitions",
    "prove": "frontends.api.proofs",
    "witness": "frontends.api.drives",
    "known_drives": "frontends.api.drives",
    "motion": "frontends.api.driving",
    "drive": "frontends.api.driving",
    "diagnose": "frontends.api.definitions",
    "Proofreader": "library.diagnose",
    "compare": "frontends.api.comparing",
    "overlap": "frontends.api.relations",
    "order": "frontends.api.ordering",
    "check": "frontends.api.checking",
    "Verdict": "verdict",
    "Stage": "runtime.progress",
    "Cancelled": "runtime.progress",
    **dict.fromkeys(_PHRASES, "frontends.api.phrases"),
    **dict.fromkeys(_ERRORS, "errors"),
    **dict.fromkeys(("Executor", "Shard", "Cluster"), "runtime.executors"),
}
"""The module of each public function and class."""

EXTENSION = Extension(
    title="The language, its meaning, proofs, drives and their evidence",
    audience="researchers",  # nothing shows it: the core is for everybody
    functions={name: f"{module}:{name}" for name, module in _FUNCTIONS.items()},
    questions={
        "compare": "questions.compare:CompareQuestion",
        "order": "questions.order.question:OrderQuestion",
        "overlap": "questions.overlap:OverlapQuestion",
        "prove": "questions.prove:ProveQuestion",
        "witness": "questions.witness:WitnessQuestion",
    },
    answers={
        "compare": "frontends.api.comparing:ComparisonAnswer",
        "order": "frontends.api.ordering:Orders",
        "overlap": "frontends.api.relations:Overlaps",
        "prove": "frontends.api.proofs:Proofs",
        "witness": "frontends.api.drives:Witnesses",
    },
    reserved={
        "functions": (
            *("core_record", "engines", "errors", "evidence", "extension", "extensions", "frontends"),
            *("library", "logic", "questions", "reasons", "runtime", "semantics", "verdict", "world"),
        ),
        "evidence": tuple(READERS),
        "roads": (".toml",),
        "checked_files": (".json",),
        "specifications": ("entering",),
        "completions": (
            *("N|FORMULA", "FORMULA", "F1", "F2", "WHAT", "MANOEUVRE", "CLAIM", "--among", "--plant"),
            *("--set", "--plant-set", "--wider", "--option", "--param", "--vary", "--road", "--vehicle"),
            "--spec",
        ),
    },
)

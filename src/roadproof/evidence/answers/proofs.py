"""The index that ``roadproof prove`` writes: claims with their verdicts."""

from collections.abc import Iterator
from typing import Any

from roadproof.evidence.answers.entry import Entry, evidence_name, shows_of
from roadproof.evidence.answers.reader import Background, Reader
from roadproof.evidence.strict import Fields, read_assuming
from roadproof.spec.motion import is_moving

SCHEMA = "roadproof/index/1"
_ENTRY = (
    *("property", "part", "scenario", "set", "claim", "assuming", "verdict", "evidence", "counterexample"),
)
OWN = "claim"  # what a claim is called that is no template property


def read(data: Fields, background: Background) -> Iterator[Entry]:
    """The entries of an index. Raises ``InputError``."""
    for number, content in enumerate(data.items("claims"), 1):
        yield _entry(Fields(content, f"{data.where}, claim {number}", _ENTRY), background)


def _entry(line: Fields, background: Background) -> Entry:
    claim, set_name, verdict = line.text("claim"), line.text("set"), line.text("verdict")
    scenario = line.whole("scenario") if line.get("scenario") is not None else None
    told = (line.text("property"), line.text("part"), scenario)
    assuming = read_assuming(line) if "assuming" in line.content else ()
    label = None if is_moving(assuming) else background.find_label(claim, set_name)
    own = told[0] == OWN and scenario is None and (not told[1] or told[1].isdecimal())
    fault = "" if told == label or own else misnamed(line.where, told, label)
    if is_moving(assuming) and line.has("counterexample"):
        fault = f"{line.where} assumes motion, so that only a drive refutes it: a trace may jump"
    return Entry(
        background.at(set_name),
        line.where,
        (" ".join(claim.split()), set_name, assuming),
        verdict,
        shown(label, set_name),
        shows_of(verdict, line.where),
        claim,
        evidence_name(line, "evidence"),
        _trace(line),
        unchecked=unchecked_of(verdict),
        fault=fault,
        assuming=assuming,
    )


def unchecked_of(verdict: str) -> tuple[str, ...]:
    """What a verdict says beyond what its evidence shows."""
    return ("that its premise never holds",) if verdict == "VACUOUS" else ()


def shown(label: tuple[str, str, int | None] | None, set_name: str) -> str:
    """A label as text: ``P1 scenario 1 base``."""
    name, part, scenario = label or ("", "", None)
    middle = f" scenario {scenario}" if scenario is not None else ""
    return f"{name}{'-' + part if part else ''}{middle} {set_name}".strip()


def misnamed(where: str, told: tuple[str, str, int | None], label: tuple[str, str, int | None] | None) -> str:
    """Why a claim is not what it is called."""
    right = "no template property" if label is None else f"that of {shown(label, '')}"
    return f"{where} is called {shown(told, '')[:60]}, but its claim is {right}"


def _trace(line: Fields) -> Any:
    return line.content.get("counterexample")


READER = Reader(
    SCHEMA,
    ("options", "specs"),
    ("claims",),
    read,
    record=("claim", "reason", "seconds", "asked"),
    unchecked_kept=("reason", "seconds", "asked"),
    read_record=lambda record, background: [
        _entry(Fields(record.get("claim"), f"{record.where}, claim", _ENTRY), background)
    ],
)

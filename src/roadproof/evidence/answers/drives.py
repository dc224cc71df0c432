"""Kept answers of ``roadproof witness``: drives of scenarios and formulas, or proofs that there is none."""

from collections.abc import Iterator

from roadproof.evidence.answers.entry import Entry, evidence_name, shows_of
from roadproof.evidence.answers.proofs import shown
from roadproof.evidence.answers.reader import Background, Reader
from roadproof.evidence.strict import Fields, rational
from roadproof.spec.scenarios import Scenario, applied, name_of

SCHEMA = "roadproof/witness/1"
_OUTCOME = (
    *("scenario", "set", "formula", "parameters", "road", "verdict", "reason", "natural"),
    *("drives", "certificate", "core", "minimal", "seconds", "sizes"),
)


def _read(record: Fields, background: Background) -> Iterator[Entry]:
    """An entry for each drive, or one for the proof."""
    line = Fields(record.get("outcome"), f"{record.where}, outcome", _OUTCOME)
    common, claim, verdict = background.at(line.text("set")), line.text("formula"), line.text("verdict")
    scenario = line.whole("scenario") if line.has("scenario") else None
    shows = shows_of(verdict, line.where, "impossibility", "drive")
    given = line.mapping("parameters")
    values = {name: rational(x, f"{line.where}, parameters.{name}") for name, x in given.items()}
    fault = ""
    if scenario is not None:
        told = Scenario(scenario, common.set_name)
        known = name_of(scenario) in common.specification.definitions
        if not known or applied(common.specification, told).formula != common.formula(claim):
            fault = f"{line.where} is called scenario {scenario}, but its formula is another: {claim[:120]}"
    drives = [evidence_name(Fields({"drive": x}, line.where), "drive") for x in line.texts("drives")]
    files = drives if shows == "drive" else [evidence_name(line, "certificate")]
    if (shows == "drive" and line.has("certificate")) or (shows != "drive" and drives):
        fault = f"{line.where}: {verdict} has evidence of another kind"
    label = shown(None if scenario is None else ("", "", scenario), common.set_name)
    for file in files or [None]:
        key = (line.text("set"), " ".join(claim.split()), file)
        yield Entry(common, line.where, key, verdict, label, shows, claim, file, values=values, fault=fault)


READER = Reader(
    SCHEMA,
    said=("options", "specs"),
    index=(),
    read_index=lambda data, background: (),
    record=("name", "outcome", "asked"),
    read_record=_read,
    alone=True,
    unchecked_kept=(
        *(f"outcome.{x}" for x in ("reason", "road", "natural", "core", "minimal", "seconds", "sizes")),
        "asked",
    ),
    file_name=lambda record: record.text("name"),
)

"""What a page shows once and refers to: drives with their viewers, and what was found of evidence."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from roadproof.errors import RoadproofError
from roadproof.evidence.drive_file import read_drive
from roadproof.evidence.finding import Acceptance, Finding
from roadproof.evidence.strict import read_json
from roadproof.report.page.markup import Markup, tag
from roadproof.report.viewer_data import viewer_data
from roadproof.spec.library import Library

MOST_STRIPS = 14
_NAMES, _CLOCK, _ROW = 250, 420, 16  # pixels of names and of the clock, and between two strips


@dataclass
class Book:
    """``documents`` of the viewer, in the order in which drives are met; ``findings`` of evidence by file.

    ``inside``: findings on evidence inside an index, by the place that they name.
    """

    library: Library
    findings: Mapping[Path, Finding] = field(default_factory=dict)
    inside: Mapping[str, Finding] = field(default_factory=dict)
    documents: list[Mapping[str, Any]] = field(default_factory=list)

    def drive(self, file: Path | Mapping[str, Any], verdict: Mapping[str, Any] | None = None) -> Markup:
        """A drive: its strips as a picture, and the viewer once it is asked for; or why it is not shown."""
        try:
            content = read_json(file) if isinstance(file, Path) else file
            drive = read_drive(content, str(file) if isinstance(file, Path) else "the drive")
            document = viewer_data(drive, self.library, verdict=verdict)
        except (RoadproofError, OSError) as error:
            return tag("p", f"The drive cannot be shown: {error}", class_="wrong")
        self.documents.append(document)
        shown, number = document["formulas"][0], len(self.documents) - 1
        wrong = None
        if shown.get("error") or not shown.get("holds"):
            reason = shown.get("error") or "the formula is false on this drive, judged for this page"
            wrong = tag("p", reason, class_="wrong")
        begun = document["drive"]["dangers"]
        danger = f", danger from {begun[0]['begins']:.2f} s on" if begun else ""
        told = f"{document['drive']['horizon']:g} s on {document['drive']['road']['name']}{danger}"
        opening = tag("button", "Show the drive", type="button", class_="open")
        parts = [wrong, tag("p", told, " ", opening), strips(document)]
        return tag("div", *parts, class_="place", data_document=str(number))

    def finding(self, folder: Path | None, name: object) -> Finding | None:
        """What was found of a file of evidence that an answer names."""
        if folder is None or not isinstance(name, str):
            return None
        return self.findings.get((folder / name).resolve())

    def checked(self, finding: Finding | None) -> Markup:
        """Whether evidence was accepted when the page was made, in a line."""
        if finding is None:
            return tag("p", "Its evidence was not at hand and is not checked.", class_="faint")
        if finding.outcome is not Acceptance.ACCEPTED:
            return tag("p", f"{finding.outcome}: {finding.reason}", class_="wrong")
        notes = [
            *finding.checked,
            *(f"not checked: {', '.join(finding.unchecked)}",) * bool(finding.unchecked),
        ]
        return tag("p", "Accepted: ", "; ".join(notes) or "queries derived again, each answered unsat", ".")


def strips(document: Mapping[str, Any]) -> Markup:
    """When the parts of the formula that have a name are true, as a picture that prints."""
    shown = document["formulas"][0]
    horizon = document["drive"]["horizon"]
    named = [x for x in shown.get("parts", ()) if x["op"] == "name"][:MOST_STRIPS]
    if not named or not horizon:
        return Markup()
    rows = [piece for k, part in enumerate(named) for piece in _strip(part, k * _ROW, horizon)]
    width, height = _NAMES + _CLOCK, len(named) * _ROW
    told = tag("title", f"when the parts of {shown['text']} are true, from 0 to {horizon:g} s")
    return tag("svg", told, *rows, viewBox=f"0 0 {width} {height}", class_="spans", role="img")


def _strip(part: Mapping[str, Any], top: float, horizon: float) -> Sequence[Markup]:
    words = part["text"] if len(part["text"]) <= 38 else part["text"][:37] + "…"
    label = tag("text", words, x=0, y=top + 11)
    ground = tag("rect", x=_NAMES, y=top + 2, width=_CLOCK, height=_ROW - 4, class_="off")
    spans = [(begin, horizon if end is None else min(end, horizon)) for begin, end, *_ in part["true"]]
    on = [
        tag(
            "rect",
            x=round(_NAMES + _CLOCK * begin / horizon, 2),
            y=top + 2,
            width=round(max(1.0, _CLOCK * (end - begin) / horizon), 2),
            height=_ROW - 4,
            class_="on",
        )
        for begin, end in spans
        if begin <= horizon
    ]
    return [label, ground, *on]

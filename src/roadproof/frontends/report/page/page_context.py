"""What a page shows once and refers to: drives with their viewers, and what was found of evidence."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from roadproof.errors import RoadproofError
from roadproof.evidence.drive_file import DriveFile, read_drive
from roadproof.evidence.finding import Acceptance, Finding
from roadproof.evidence.strict import read_json
from roadproof.frontends.report.page.markup import Markup, tag
from roadproof.frontends.report.viewer_data import ShownFormula, viewer_data
from roadproof.library.specification import Library

MOST_STRIPS = 14
_NEARLY = 1e-6  # s: instants are told with so many digits
_NAMES, _CLOCK, _ROW = 250, 420, 16  # pixels of names and of the clock, and between two strips


@dataclass
class PageContext:
    """``documents`` of the viewer, in the order in which drives are met; ``findings`` of evidence by file.

    ``inside``: findings on evidence inside an index, by the place that they name. ``rejected``: what is wrong
    with an index itself, by its path.
    """

    library: Library
    findings: Mapping[Path, Finding] = field(default_factory=dict)
    inside: Mapping[str, Finding] = field(default_factory=dict)
    rejected: Mapping[str, Sequence[str]] = field(default_factory=dict)
    documents: list[Mapping[str, Any]] = field(default_factory=list)

    def drive(
        self,
        file: Path | Mapping[str, Any],
        asked: Sequence[ShownFormula] = (),
        since: Sequence[float] = (0.0,),
        put: Callable[[DriveFile], DriveFile] = lambda file: file,
    ) -> Markup:
        """A drive: its strips as a picture, and the viewer once it is asked for; or why it is not shown.

        ``asked``: other formulas than its own, of which the k-th has to hold at the instant (s) that is
        k-th of ``since``; ``put``: what the drive is read as.
        """
        try:
            content = read_json(file) if isinstance(file, Path) else file
            drive = read_drive(content, str(file) if isinstance(file, Path) else "the drive")
            document = viewer_data(put(drive), self.library, asked)
        except (RoadproofError, OSError) as error:
            return tag("p", f"The drive cannot be shown: {error}", class_="wrong")
        self.documents.append(document)
        number = len(self.documents) - 1
        wrong = [_wrong(x, at) for x, at in zip(document["formulas"], since, strict=False)]
        begun = document["drive"]["dangers"]
        danger = f", danger from {begun[0]['begins']:.2f} s on" if begun else ""
        told = f"{document['drive']['horizon']:g} s on {document['drive']['road']['name']}{danger}"
        opening = tag("button", "Show the drive", type="button", class_="open")
        parts = [*wrong, tag("p", told, " ", opening), strips(document)]
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


def _wrong(shown: Mapping[str, Any], at: float) -> Markup | None:
    """What is said of a formula that cannot be read, or is false at an instant; None where it is true."""
    if shown.get("error"):
        return tag("p", shown["error"], class_="wrong")
    if at == 0 and shown["holds"]:
        return None
    spans = shown["parts"][0]["true"] if at else ()
    if any(begin <= at + _NEARLY and (end is None or at <= end + _NEARLY) for begin, end, *_ in spans):
        return None
    when = f" at {at:g} s" if at else ""
    return tag("p", f"the formula is false{when} on this drive, judged for this page", class_="wrong")


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

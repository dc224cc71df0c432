"""What a page shows once and refers to: drives with their viewers, and what was found of evidence."""

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path

from roadproof.errors import RoadproofError
from roadproof.evidence.drive_file import DriveFile, read_drive
from roadproof.evidence.finding import Acceptance, Finding
from roadproof.evidence.strict import read_json
from roadproof.extensions.pages.miniature import miniature, small_scene
from roadproof.extensions.pages.viewer_data import ShownFormula, viewer_data
from roadproof.extensions.pages.viewer_document import Document, FormulaView, Span
from roadproof.library.specification import Library

MOST_STRIPS = 14
_NEARLY = 1e-6  # s: instants are told with so many digits


@dataclass(frozen=True)
class ShownDrive:
    """A drive on the page.

    ``number``: that of its ``document`` for the viewer; ``wrong``: the formulas that are not true on it;
    ``svg``: a small moving picture of it; ``fault``: why it cannot be shown.
    """

    number: int = 0
    document: Document | None = None
    wrong: Sequence[str] = ()
    svg: str = ""
    fault: str = ""

    @property
    def title(self) -> str:
        """What the viewer calls it."""
        return "" if self.document is None else self.document.title

    @property
    def scenario(self) -> int | None:
        """The scenario that its file names, if any."""
        file = None if self.document is None else self.document.file
        number = file.get("scenario") if isinstance(file, Mapping) else None
        return number if isinstance(number, int) else None

    @property
    def strips(self) -> list[tuple[str, Sequence[Span]]]:
        """When the parts of its formula that have a name are true."""
        parts = None if self.document is None else self.document.formulas[0].parts
        return [(x.text, x.true) for x in parts or () if x.op == "name"][:MOST_STRIPS]


@dataclass(frozen=True)
class DriveCard:
    """A drive in a gallery: what it shows with which verdict, and what was checked of it.

    ``place``: where it is on the page.
    """

    drive: ShownDrive
    verdict: str
    claim: str
    place: str
    notes: str = ""


@dataclass
class PageContext:
    """``documents`` of the viewer, in the order in which drives are met; ``findings`` of evidence by file.

    ``rejected``: what is wrong with a question itself, by its path.
    """

    library: Library
    findings: Mapping[Path, Finding] = field(default_factory=dict)
    rejected: Mapping[str, Sequence[str]] = field(default_factory=dict)
    documents: list[Document] = field(default_factory=list)

    def drive(
        self,
        file: Path | Mapping[str, object],
        asked: Sequence[ShownFormula] = (),
        since: Sequence[float] = (0.0,),
        put: Callable[[DriveFile], DriveFile] = lambda file: file,
    ) -> ShownDrive:
        """Put a drive on the page, or say why it is not shown.

        ``asked``: other formulas than its own, of which the k-th has to hold at the instant (s) that is
        k-th of ``since``; ``put``: what the drive is read as.
        """
        try:
            content = read_json(file) if isinstance(file, Path) else file
            drive = put(read_drive(content, str(file) if isinstance(file, Path) else "the drive"))
            document = viewer_data(drive, self.library, asked)
            svg = miniature(small_scene(drive, self.library), f"m{len(self.documents)}", document.title)
        except (RoadproofError, OSError) as error:
            return ShownDrive(fault=str(error))
        self.documents.append(document)
        wrong = [_wrong(x, at) for x, at in zip(document.formulas, since, strict=False)]
        return ShownDrive(len(self.documents) - 1, document, [x for x in wrong if x], svg)

    def is_drive(self, file: Path) -> bool:
        """Whether a file of evidence is a drive."""
        found = self.findings.get(file.resolve())
        return found is not None and found.kind == "drive"

    def rejected_in(self, folder: Path | None) -> int:
        """How much of the evidence in a folder is not accepted."""
        if folder is None:
            return 0
        here = folder.resolve()
        wrong = (path for path, x in self.findings.items() if x.outcome is not Acceptance.ACCEPTED)
        return sum(path.parent == here for path in wrong)

    def drives_of(self, folder: Path | None, claim: str) -> Iterator[Finding]:
        """What was found of the drives of a folder that are about a claim, by the names of their files."""
        here = None if folder is None else folder.resolve()
        for path, found in sorted(self.findings.items(), key=lambda x: (len(x[0].name), x[0])):
            if path.parent == here and found.claim == claim and found.kind == "drive":
                yield found

    def finding(self, folder: Path | None, name: object) -> Finding | None:
        """What was found of a file of evidence that an answer names."""
        if folder is None or not isinstance(name, str):
            return None
        return self.findings.get((folder / name).resolve())


def _wrong(shown: FormulaView, at: float) -> str:
    """Why a formula cannot be read, or that it is false at an instant; nothing where it is true."""
    if shown.error:
        return shown.error
    if at == 0 and shown.holds:
        return ""
    spans = shown.parts[0].true if at and shown.parts else ()
    if any(x.begin <= at + _NEARLY and (x.end is None or at <= x.end + _NEARLY) for x in spans):
        return ""
    when = f" at {at:g} s" if at else ""
    return f"the formula is false{when} on this drive, judged for this page"

"""The shared content of a report page: drives with their viewers, and the findings about evidence."""

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path

from roadproof.errors import RoadproofError
from roadproof.evidence.drive_file import DriveFile, drive_data, read_drive
from roadproof.evidence.finding import Acceptance, Finding
from roadproof.evidence.strict import read_json
from roadproof.extensions.pages.miniature import miniature, small_scene
from roadproof.extensions.pages.viewer_data import ShownFormula, viewer_data
from roadproof.extensions.pages.viewer_document import FormulaView, TruthSpan, ViewerDocument
from roadproof.library.specification import Library
from roadproof.questions.foreign_code import all_foreign_code
from roadproof.runtime.cache import cached
from roadproof.runtime.canonical import digest
from roadproof.runtime.package_data import program_digest

MOST_STRIPS = 14
_NEARLY = 1e-6  # s: instants are told with so many digits


@dataclass(frozen=True)
class PageDrive:
    """A drive on the page.

    ``number``: that of its ``document`` for the viewer; ``wrong``: messages about formulas that are not true
    on it; ``svg``: a small moving picture of it; ``fault``: why it cannot be shown.
    """

    number: int = 0
    document: ViewerDocument | None = None
    wrong: Sequence[str] = ()
    svg: str = ""
    fault: str = ""

    @property
    def title(self) -> str:
        """The title of the drive in the viewer."""
        return "" if self.document is None else self.document.title

    @property
    def scenario(self) -> int | None:
        """The scenario that its file names, None for none."""
        file = None if self.document is None else self.document.file
        number = file.get("scenario") if isinstance(file, Mapping) else None
        return number if isinstance(number, int) else None

    @property
    def strips(self) -> list[tuple[str, Sequence[TruthSpan]]]:
        """The named parts of its formula with the spans in which they are true."""
        parts = None if self.document is None else self.document.formulas[0].parts
        return [(x.text, x.true) for x in parts or () if x.op == "name"][:MOST_STRIPS]


@dataclass(frozen=True)
class DriveCard:
    """A drive in a gallery: the claim that it shows, the verdict, and notes on its check.

    ``place``: its id on the page. ``title``: over the picture, that of the drive where it is empty.
    """

    drive: PageDrive
    verdict: str
    claim: str
    place: str
    notes: str = ""
    title: str = ""


@dataclass
class PageContext:
    """The ``documents`` of the viewer, in order of appearance, and the ``findings`` on evidence by file.

    ``rejected``: the objections to a question itself, by its path. ``folder``: where the page will be.
    """

    library: Library
    findings: Mapping[Path, Finding] = field(default_factory=dict)
    rejected: Mapping[str, Sequence[str]] = field(default_factory=dict)
    documents: list[ViewerDocument] = field(default_factory=list)
    folder: Path = Path()

    def drive(
        self,
        file: Path | Mapping[str, object],
        formulas: Sequence[ShownFormula] = (),
        hold_at: Sequence[float | None] = (0.0,),
        adapt: Callable[[DriveFile], DriveFile] = lambda file: file,
    ) -> PageDrive:
        """Add a drive to the page, or return why it cannot be shown.

        Args:
          file: a drive file or its plain data.
          formulas: formulas to show instead of its own.
          hold_at: the instant (s) at which each formula has to hold; None where it need not.
          adapt: a function that changes the drive file before it is judged.
        """
        try:
            content = read_json(file) if isinstance(file, Path) else file
            drive = adapt(read_drive(content, str(file) if isinstance(file, Path) else "the drive"))
            document, svg = self._drawn(drive, formulas)
        except (RoadproofError, OSError) as error:
            return PageDrive(fault=str(error))
        self.documents.append(document)
        wrong = [_failure(x, at) for x, at in zip(document.formulas, hold_at, strict=False)]
        return PageDrive(len(self.documents) - 1, document, [x for x in wrong if x], svg)

    def _drawn(self, drive: DriveFile, formulas: Sequence[ShownFormula]) -> tuple[ViewerDocument, str]:
        """Return the document and the small picture of a drive, from the cache where nothing has changed."""
        name = f"m{len(self.documents)}"

        def make() -> tuple[ViewerDocument, str]:
            document = viewer_data(drive, self.library, formulas)
            return document, miniature(small_scene(drive, self.library), name, document.title)

        if any(x.specification is not None for x in formulas):
            return make()
        content = digest(drive_data(drive, {}), formulas)
        here = digest(self.library.fingerprint, self.library.titles, program_digest(), *all_foreign_code())
        return cached("viewer", f"{name} {content} {here}".encode(), make)

    def is_drive(self, file: Path) -> bool:
        """Return whether a file of evidence is a drive."""
        finding = self.findings.get(file.resolve())
        return finding is not None and finding.kind == "drive"

    def rejected_in(self, folder: Path | None) -> int:
        """Return how many pieces of evidence in a folder are not accepted."""
        if folder is None:
            return 0
        here = folder.resolve()
        wrong = (path for path, x in self.findings.items() if x.outcome is not Acceptance.ACCEPTED)
        return sum(path.parent == here for path in wrong)

    def drives_of(self, folder: Path | None, claim: str) -> Iterator[Finding]:
        """Yield the findings about drives in a folder that show a claim, sorted by file name."""
        here = None if folder is None else folder.resolve()
        for path, finding in sorted(self.findings.items(), key=lambda x: (len(x[0].name), x[0])):
            if path.parent == here and finding.claim == claim and finding.kind == "drive":
                yield finding

    def finding(self, folder: Path | None, name: object) -> Finding | None:
        """Return the finding about a file of evidence that an answer names, None where there is none."""
        if folder is None or not isinstance(name, str):
            return None
        return self.findings.get((folder / name).resolve())


def _failure(view: FormulaView, at: float | None) -> str:
    """Return why a formula cannot be read, or that it is false at an instant; empty where it is true."""
    if view.error or at is None:
        return view.error or ""
    if at == 0 and view.holds:
        return ""
    spans = view.parts[0].true if at and view.parts else ()
    if any(x.begin <= at + _NEARLY and (x.end is None or at <= x.end + _NEARLY) for x in spans):
        return ""
    when = f" at {at:g} s" if at else ""
    return f"the formula is false{when} on this drive, judged for this page"

"""Jobs that show drives, judged with the present definitions."""

from collections.abc import Iterable
from dataclasses import replace

from roadproof.evidence.drive_file import DriveFile, read_drive
from roadproof.extensions.pages.places import FormulaPlace
from roadproof.extensions.pages.studio.drafting import BEFORE, place_in
from roadproof.extensions.pages.studio.requests import Answer, StudioQuestion
from roadproof.extensions.pages.viewer_data import ShownFormula, viewer_data
from roadproof.extensions.pages.viewer_document import ViewerDocument
from roadproof.extensions.pages.viewer_page import viewer_page
from roadproof.library.specification import Library, Specification


def show(question: StudioQuestion) -> Answer:
    """Return the view of a drive with the question and the watched formulas.

    ``drive``: the plain data of a drive file; ``compare``: show the question in both sets; ``explain``: a
    part of the question by its index, and the instant at which its value is to be explained.
    """
    return {"view": view(question, read_drive(question.drive, "the drive"))}


def view(question: StudioQuestion, file: DriveFile) -> Answer:
    """Return the viewer document for a drive, with the formulas of the page, as plain data."""
    return _with_marks(_document(question, file))


def _with_marks(document: ViewerDocument) -> Answer:
    return {**document.as_json(), "marks": marks_of(document.formulas[0].said or (), "why")}


def _document(question: StudioQuestion, file: DriveFile) -> ViewerDocument:
    home = question.home
    formulas = [
        ShownFormula("question", question.formula, home.specification, home.values, question.explained)
    ]
    if question.compare:
        other = question.draft.definitions(
            BEFORE if question.draft.before is not None else question.draft.base
        )
        formulas.append(ShownFormula("before", question.formula, other.specification, home.values))
    formulas += [ShownFormula("watch", x, home.specification, home.values) for x in question.watches]
    return viewer_data(*_readable(file, home.specification), formulas)


def marks_of(places: Iterable[FormulaPlace], kind: str) -> list[Answer]:
    """Return marks for places in the user's texts; places in the library's texts are left out."""
    marks: list[Answer] = []
    for place in places:
        at = place.at
        begin = place_in(place.source, (at.line, at.column))
        end = place_in(place.source, (at.end_line, at.end_column))
        if begin is not None and end is not None:
            mark: Answer = {"where": begin[0], "from": list(begin[1]), "to": list(end[1]), "kind": kind}
            marks += [] if mark in marks else [mark]
    return marks


def _readable(file: DriveFile, home: Specification) -> tuple[DriveFile, Library]:
    """Return a drive with a library that has its set; a drive of another draft is shown with the
    present one.
    """
    library = home.library
    known = {name: x.values for name, x in library.options.items()}
    options = {k: v for k, v in file.options.items() if v in known.get(k, ())}
    values = {k: v for k, v in file.values.items() if k in library.parameters}
    if file.set_name in library.sets and file.set_name not in ("edit", "before"):
        return replace(file, options=options, values=values), library
    return replace(file, set_name=home.set_name, options=dict(home.options), values=values), library


def page(question: StudioQuestion) -> Answer:
    """Return the shown drive as an HTML page of its own."""
    document = _document(question, read_drive(question.drive, "the drive"))
    return {"page": viewer_page([_with_marks(document)], document.title)}

"""Drives on the page: judged with the definitions as they are at the moment."""

from collections.abc import Iterable
from dataclasses import replace

from roadproof.evidence.drive_file import DriveFile, read_drive
from roadproof.extensions.pages.studio.drafting import BEFORE, place_in
from roadproof.extensions.pages.studio.requests import Answer, Ask
from roadproof.extensions.pages.viewer_data import ShownFormula, viewer_data
from roadproof.extensions.pages.viewer_document import Document
from roadproof.extensions.pages.viewer_page import viewer_page
from roadproof.library.specification import Library, Specification
from roadproof.library.uses import Place


def show(ask: Ask) -> Answer:
    """A drive, and on it the question and the formulas that are watched.

    ``drive``: the plain data of a drive file; ``compare``: whether the question is shown in both sets;
    ``explain``: a part of the question by its place, and an instant, of which is to be said why.
    """
    return {"view": view(ask, read_drive(ask.drive, "the drive"))}


def view(ask: Ask, file: DriveFile) -> Answer:
    """The document of the viewer for a drive, with what the page asks of it, as plain data."""
    return _with_marks(_document(ask, file))


def _with_marks(document: Document) -> Answer:
    return {**document.as_json(), "marks": marks_of(document.formulas[0].said or (), "why")}


def _document(ask: Ask, file: DriveFile) -> Document:
    home = ask.home
    asked = [ShownFormula("question", ask.formula, home.specification, home.values, ask.explained)]
    if ask.compare:
        other = ask.draft.definitions(BEFORE if ask.draft.before is not None else ask.draft.base)
        asked.append(ShownFormula("before", ask.formula, other.specification, home.values))
    asked += [ShownFormula("watch", x, home.specification, home.values) for x in ask.watches]
    return viewer_data(*_readable(file, home.specification), asked)


def marks_of(places: Iterable[Place], kind: str) -> list[Answer]:
    """Places in texts as the editors mark them; those in the library's texts are left out."""
    found: list[Answer] = []
    for place in places:
        at = place.at
        begin = place_in(place.source, (at.line, at.column))
        end = place_in(place.source, (at.end_line, at.end_column))
        if begin is not None and end is not None:
            mark: Answer = {"where": begin[0], "from": list(begin[1]), "to": list(end[1]), "kind": kind}
            found += [] if mark in found else [mark]
    return found


def _readable(file: DriveFile, home: Specification) -> tuple[DriveFile, Library]:
    """A drive with a library that knows its set: a drive of another draft is shown with the one at hand."""
    library = home.library
    known = {name: x.values for name, x in library.options.items()}
    options = {k: v for k, v in file.options.items() if v in known.get(k, ())}
    values = {k: v for k, v in file.values.items() if k in library.parameters}
    if file.set_name in library.sets and file.set_name not in ("edit", "before"):
        return replace(file, options=options, values=values), library
    return replace(file, set_name=home.set_name, options=dict(home.options), values=values), library


def page(ask: Ask) -> Answer:
    """The drive that is shown as a page of its own."""
    document = _document(ask, read_drive(ask.drive, "the drive"))
    return {"page": viewer_page([_with_marks(document)], document.title)}

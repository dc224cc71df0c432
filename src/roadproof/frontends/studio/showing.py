"""Drives on the page: judged with the definitions as they are at the moment."""

from collections.abc import Iterable, Mapping
from dataclasses import replace
from typing import Any

from roadproof.errors import UsageError
from roadproof.evidence.drive_file import DriveFile, read_drive
from roadproof.evidence.strict import Fields
from roadproof.frontends.api.drafting import BEFORE, Draft, place_in
from roadproof.frontends.report.viewer_data import ShownFormula, viewer_data
from roadproof.frontends.report.viewer_page import viewer_page
from roadproof.frontends.studio.requests import draft_of, explain_of, set_of, text_of
from roadproof.library.specification import Library, Specification

MOST_WATCHES = 12


def show(ask: Mapping[str, Any], say: object) -> dict[str, Any]:
    """A drive, and on it the question and the formulas that are watched.

    ``drive``: the plain data of a drive file; ``compare``: whether the question is shown in both sets;
    ``explain``: a part of the question by its place, and an instant, of which is to be said why.
    """
    draft = draft_of(ask)
    return {"view": view(draft, read_drive(ask.get("drive"), "the drive"), ask)}


def view(draft: Draft, file: DriveFile, ask: Mapping[str, Any]) -> dict[str, Any]:
    """The document of the viewer for a drive, with what the page asks of it."""
    home = draft.definitions(set_of(ask))
    explain = explain_of(ask)
    asked = [ShownFormula("question", text_of(ask, "formula"), home.specification, home.values, explain)]
    if ask.get("compare") is True:
        other = draft.definitions(BEFORE if draft.before is not None else draft.base)
        asked.append(ShownFormula("before", text_of(ask, "formula"), other.specification, home.values))
    watches = Fields(ask, "question").texts("watches") if "watches" in ask else ()
    if len(watches) > MOST_WATCHES:
        raise UsageError(f"watches={len(watches)}: at most {MOST_WATCHES} formulas are watched")
    asked += [ShownFormula("watch", x, home.specification, home.values) for x in watches]
    document = viewer_data(*_readable(file, home.specification), asked)
    document["marks"] = marks_of(document["formulas"][0].get("said", []), "why")
    return document


def marks_of(places: Iterable[Mapping[str, Any]], kind: str) -> list[dict[str, Any]]:
    """Places in texts as the editors mark them; those in the library's texts are left out."""
    found: list[dict[str, Any]] = []
    for place in places:
        begin, end = (place_in(place["source"], tuple(place[x])) for x in ("from", "to"))
        if begin is not None and end is not None:
            mark = {"where": begin[0], "from": list(begin[1]), "to": list(end[1]), "kind": kind}
            found += [] if mark in found else [mark]
    return found


def _readable(file: DriveFile, home: Specification) -> tuple[DriveFile, Library]:
    """A drive with a library that knows its set: a drive of another draft is shown with the one at hand."""
    library = home.library
    options = {k: v for k, v in file.options.items() if v in _values(library, k)}
    values = {k: v for k, v in file.values.items() if k in library.parameters}
    if file.set_name in library.sets and file.set_name not in ("edit", "before"):
        return replace(file, options=options, values=values), library
    return replace(file, set_name=home.set_name, options=dict(home.options), values=values), library


def _values(library: Library, option: str) -> tuple[str, ...]:
    declared = library.options.get(option)
    return () if declared is None else declared.values


def page(ask: Mapping[str, Any], say: object) -> dict[str, Any]:
    """The drive that is shown as a page of its own."""
    document = show(ask, say)["view"]
    return {"page": viewer_page([document], document["title"])}

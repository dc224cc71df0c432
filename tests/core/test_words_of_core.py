"""Answers in the core have no field of an extension: the record of the extension adds it."""

import subprocess
import sys
from pathlib import Path

from roadproof.evidence.answers import headings, shared
from roadproof.evidence.codec import fields_of
from roadproof.extension import entries, import_entry

SOURCE = "".join(Path(x.__file__).read_text("utf-8") for x in (headings, shared))


def test_the_heading_of_answers_names_no_driver() -> None:
    assert not [x for x in ("prevent", "driver", "catalogue") if x in SOURCE.lower()]


def test_records_add_the_fields_of_the_heading() -> None:
    core = [x.name for x in fields_of(headings.BaseHeading)]
    added = [x.name for x in fields_of(headings.AnswerHeading) if x.name not in core]
    assert added == [*entries("headings")] == ["prevention"]
    for name, entry in entries("headings").items():
        assert [x.name for x in fields_of(import_entry(entry))] == [name]


def test_the_module_of_headings_can_be_imported_first() -> None:
    code = "import roadproof.evidence.answers.headings as x; print(x.AnswerHeading.__mro__[1].__name__)"
    told = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True)
    assert told.stdout == "PreventionHeading\n", told.stderr

"""Drives that complete a catalogue, written as tests into a folder: copies for other tools, and entries."""

import json
from collections.abc import Iterable, Iterator, Mapping, Sequence
from pathlib import Path

from roadproof.errors import InputError
from roadproof.evidence.certificate_file import to_json
from roadproof.extensions.catalogue.catalogue_file import FILE_NAME
from roadproof.extensions.catalogue.completing import Completion
from roadproof.extensions.catalogue.entries import ConcreteTest, Freedom
from roadproof.extensions.catalogue.judge_test import judge_test
from roadproof.extensions.catalogue.target_formulas import TargetFormulas
from roadproof.extensions.exchange.exporting import ExportedDrive, can_export, export
from roadproof.extensions.exchange.exporting import names as format_names
from roadproof.frontends.settings.readers import formats_in
from roadproof.runtime.files import json_bytes, lock_folder, write_atomic
from roadproof.runtime.records import dataclass
from roadproof.world.models import read_toml

PROOFS = "proofs"
_TESTS = {"openscenario": ".xosc", "commonroad": ".xml", "csv": ".csv", "highd": "_tracks.csv"}
"""The ending of the file that is a test, by format; a road alone is none."""


@dataclass(frozen=True)
class CompletionAnswer:
    """The drives that were written into ``folder``, and the targets that are empty or have no drive.

    ``copies``: the entries of drives in formats of other tools; ``notes``: remarks on them.
    """

    folder: Path
    completions: tuple[Completion, ...]
    copies: tuple[ConcreteTest, ...] = ()
    notes: tuple[str, ...] = ()

    def __str__(self) -> str:
        made = [x for x in self.completions if x.drive is not None]
        lines = []
        if made:
            lines.append(
                f"{len(made)} drive{'s' * (len(made) != 1)} for what was not tested in {self.folder}"
            )
        if self.copies:
            lines.append(f"{len(self.copies)} copies of them for other tools, with entries")
        lines += [
            f"{x.name}: begins {x.apart:.2g} from the nearest test of {x.target}, "
            "where 1 is 15 m along, 2.5 m across or 4 m/s"
            for x in made
            if x.apart is not None
        ]
        lines += [f"{x.target}: nothing shows it: that is proved" for x in self.completions if x.empty]
        lines += [f"{x.name}: {x.reason}" for x in self.completions if not (x.drive or x.empty)]
        return "\n".join([*lines, *self.notes]) or "nothing was missing"


def write_completions(
    folder: Path,
    completions: Sequence[Completion],
    titles: Mapping[str, str],
    formulas: TargetFormulas,
    formats: Iterable[str] = (),
    specs: Iterable[str | Path] = (),
) -> CompletionAnswer:
    """Write drives and proofs, copies in ``formats``, and a ``catalogue.toml``, whose entries stay.

    ``titles``: the title of each drive by its name. Raises ``InputError``, ``UsageError``.
    """
    names = formats_in(formats, format_names()) if formats else []
    made = {x.name: x for x in completions if x.drive is not None}
    with lock_folder(folder):
        files = {name: _write(folder, name, x) for name, x in made.items()}
        for x in completions:
            if x.empty is not None:
                write_atomic(folder / PROOFS / f"{x.name}.json", to_json(x.empty).encode())
        entries = [
            ConcreteTest(path.stem, path.name, titles[name], (made[name].target,))
            for name, path in files.items()
        ]
        copies, notes = list[ConcreteTest](), list[str]()
        for name in names:
            for copy in _export(folder, name, list(files.values()), specs, notes):
                copies += _entries_of_copy(folder, copy, entries, formulas, notes)
        if entries:
            content = _with_earlier(folder / FILE_NAME, [*entries, *copies])
            write_atomic(folder / FILE_NAME, content.encode())
    return CompletionAnswer(folder, tuple(completions), tuple(copies), tuple(notes))


def _write(folder: Path, name: str, made: Completion) -> Path:
    """Write a drive, under another name where a file of that name has other content, and return its path."""
    assert made.drive is not None
    content, count, path = json_bytes(made.drive.as_data()), 1, folder / f"{name}.json"
    while path.exists() and path.read_bytes() != content:
        count += 1
        path = folder / f"{name}-{count}.json"
    write_atomic(path, content)
    return path


def _export(
    folder: Path, name: str, files: Sequence[Path], specs: Iterable[str | Path], notes: list[str]
) -> Iterator[ExportedDrive]:
    """Yield the drives in one format; add a note on each that it cannot represent."""
    fit = []
    for path in files:
        try:
            can_export(path, name, specs)
        except InputError as error:
            notes.append(f"{path.stem} is not written as {name}: {error}")
        else:
            fit.append(path)
    if fit:
        yield from export(fit, name, _free(folder, name), specs=specs).drives


def _free(folder: Path, name: str) -> Path:
    """Return a folder for copies in a format. Recordings are numbered in each run, so they need a new one."""
    place, count = folder / name, 1
    while name == "highd" and place.exists():
        count += 1
        place = folder / f"{name}-{count}"
    return place


def _entries_of_copy(
    folder: Path,
    copy: ExportedDrive,
    entries: Sequence[ConcreteTest],
    formulas: TargetFormulas,
    notes: list[str],
) -> Iterator[ConcreteTest]:
    """Yield the entry of a copy that is a test, with those claims of its original that the file shows.

    Adds a note where it shows none of them.
    """
    original = next(x for x in entries if x.id == copy.name)
    path = next((x for x in copy.files if x.name.endswith(_TESTS.get(copy.format, "\0"))), None)
    if path is None:
        return
    place = str(path.relative_to(folder))
    if copy.format == "highd":
        place += ":" + ",".join(map(str, copy.ids.values()))
    shown = judge_test(ConcreteTest(original.id, str(folder / place)), formulas, Freedom())
    claims = tuple(x for x in original.claims if x in shown.names)
    if not claims:
        what = shown.fault or f"it shows {', '.join(sorted(shown.names)) or 'no scenario'}"
        notes.append(f"{original.id} as {copy.format} is no test of {original.claims[0]}: {what}")
    yield ConcreteTest(f"{original.id} as {copy.format}", place, original.title, claims, original.id)


def _with_earlier(path: Path, entries: Sequence[ConcreteTest]) -> str:
    """Return the text of a ``catalogue.toml`` with its present text first."""
    if not path.exists():
        return catalogue_text(entries)
    tests = read_toml(path).get("test")
    known = {x.get("id") for x in tests if isinstance(x, Mapping)} if isinstance(tests, list) else set()
    new = [x for x in entries if x.id not in known]
    return "\n".join([path.read_text("utf-8").rstrip("\n") + "\n", *([catalogue_text(new)] if new else [])])


def catalogue_text(tests: Iterable[ConcreteTest]) -> str:
    """Return tests as TOML; basic strings and arrays of strings are written as in JSON."""
    return "\n".join(
        "[[test]]\n"
        + "".join(f"{x} = {json.dumps(y, ensure_ascii=False)}\n" for x, y in _fields(test).items())
        for test in tests
    )


def _fields(test: ConcreteTest) -> dict[str, object]:
    fields: dict[str, object] = {
        "id": test.id,
        "title": test.title,
        "file": test.place,
        "claims": test.claims,
    }
    return fields | ({"copy_of": test.copy_of} if test.copy_of else {})

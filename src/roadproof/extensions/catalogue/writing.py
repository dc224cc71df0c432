"""Drives that complete a catalogue, written as tests into a folder: copies for other tools, and entries."""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from pathlib import Path

from roadproof.errors import InputError
from roadproof.evidence.certificate import to_json
from roadproof.extensions.catalogue.asked import Questions
from roadproof.extensions.catalogue.completing import Completion, catalogue_text
from roadproof.extensions.catalogue.entries import Concrete, Freedom
from roadproof.extensions.catalogue.listing import FILE_NAME
from roadproof.extensions.catalogue.showing import show
from roadproof.extensions.exchange.exporting import ExportedDrive, can_export, export
from roadproof.extensions.exchange.exporting import names as format_names
from roadproof.frontends.settings.readers import formats_in
from roadproof.runtime.files import hold_folder, json_bytes, write_whole
from roadproof.runtime.records import dataclass
from roadproof.world.models import read_toml

PROOFS = "proofs"
_TESTS = {"openscenario": ".xosc", "commonroad": ".xml", "csv": ".csv", "highd": "_tracks.csv"}
"""The file of a format that is a test by itself, by its ending; a road alone is none."""


@dataclass(frozen=True)
class CompletionAnswer:
    """The drives that were written into ``folder``, and what was proved empty or not found.

    ``copies``: of drives in formats of other tools, each an entry of the catalogue; ``told``: what is to be
    said of them.
    """

    folder: Path
    completions: tuple[Completion, ...]
    copies: tuple[Concrete, ...] = ()
    told: tuple[str, ...] = ()

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
        return "\n".join([*lines, *self.told]) or "nothing was missing"


def write_completions(
    folder: Path,
    completions: Sequence[Completion],
    titles: Mapping[str, str],
    asked: Questions,
    formats: Iterable[str] = (),
    specs: Iterable[str | Path] = (),
) -> CompletionAnswer:
    """Write drives and proofs, copies in ``formats``, and a ``catalogue.toml``; entries that it has are kept.

    ``titles``: what each drive is, by its name. Raises ``InputError``, ``UsageError``.
    """
    names = formats_in(formats, format_names()) if formats else []
    made = {x.name: x for x in completions if x.drive is not None}
    with hold_folder(folder):
        files = {name: _write(folder, name, x) for name, x in made.items()}
        for x in completions:
            if x.empty is not None:
                write_whole(folder / PROOFS / f"{x.name}.json", to_json(x.empty).encode())
        entries = [
            Concrete(path.stem, path.name, titles[name], (made[name].target,)) for name, path in files.items()
        ]
        copies, told = list[Concrete](), list[str]()
        for name in names:
            for copy in _exported(folder, name, list(files.values()), specs, told):
                copies += _listed(folder, copy, entries, asked, told)
        if entries:
            write_whole(folder / FILE_NAME, _with_known(folder / FILE_NAME, [*entries, *copies]).encode())
    return CompletionAnswer(folder, tuple(completions), tuple(copies), tuple(told))


def _write(folder: Path, name: str, made: Completion) -> Path:
    """Write a drive, under another name where there is a file of that name that says otherwise."""
    assert made.drive is not None
    content, count, path = json_bytes(made.drive.as_data()), 1, folder / f"{name}.json"
    while path.exists() and path.read_bytes() != content:
        count += 1
        path = folder / f"{name}-{count}.json"
    write_whole(path, content)
    return path


def _exported(
    folder: Path, name: str, files: Sequence[Path], specs: Iterable[str | Path], told: list[str]
) -> Iterator[ExportedDrive]:
    """The drives in one format; what it cannot say is told."""
    fit = []
    for path in files:
        try:
            can_export(path, name, specs)
        except InputError as error:
            told.append(f"{path.stem} is not written as {name}: {error}")
        else:
            fit.append(path)
    if fit:
        yield from export(fit, name, _free(folder, name), specs=specs).drives


def _free(folder: Path, name: str) -> Path:
    """A folder for copies in a format. Recordings are numbered in each run, so they need a new one."""
    place, count = folder / name, 1
    while name == "highd" and place.exists():
        count += 1
        place = folder / f"{name}-{count}"
    return place


def _listed(
    folder: Path, copy: ExportedDrive, entries: Sequence[Concrete], asked: Questions, told: list[str]
) -> Iterator[Concrete]:
    """The entry of a copy, which claims what its original does; it is looked at again as it was written."""
    original = next(x for x in entries if x.id == copy.name)
    path = next((x for x in copy.files if x.name.endswith(_TESTS.get(copy.format, "\0"))), None)
    if path is None:
        return
    place = str(path.relative_to(folder))
    if copy.format == "highd":
        place += ":" + ",".join(map(str, copy.ids.values()))
    shown = show(Concrete(original.id, str(folder / place)), asked, Freedom())
    claims = tuple(x for x in original.claims if x in shown.names)
    if not claims:
        what = shown.fault or f"it shows {', '.join(sorted(shown.names)) or 'no scenario'}"
        told.append(f"{original.id} as {copy.format} is no test of {original.claims[0]}: {what}")
    yield Concrete(f"{original.id} as {copy.format}", place, original.title, claims, original.id)


def _with_known(path: Path, entries: Sequence[Concrete]) -> str:
    """The text of a ``catalogue.toml``, with what it says already."""
    if not path.exists():
        return catalogue_text(entries)
    tests = read_toml(path).get("test")
    known = {x.get("id") for x in tests if isinstance(x, Mapping)} if isinstance(tests, list) else set()
    new = [x for x in entries if x.id not in known]
    return "\n".join([path.read_text("utf-8").rstrip("\n") + "\n", *([catalogue_text(new)] if new else [])])

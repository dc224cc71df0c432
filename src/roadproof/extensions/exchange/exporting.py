"""Drives for other people's tools."""

from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path
from typing import TypeAlias, Unpack

from roadproof.core_record import DRIVES
from roadproof.errors import InputError, UsageError
from roadproof.evidence.drive_file import DriveFile, load_drive
from roadproof.evidence.judged import JudgedDrive, RejectedError
from roadproof.evidence.strict import read_json
from roadproof.extensions.exchange.export.registry import FORMATS, vehicle_ids_in
from roadproof.extensions.exchange.export.subject import ExportSubject, subject_of
from roadproof.extensions.exchange.keywords import ExportKeywords
from roadproof.extensions.exchange.settings import Export
from roadproof.frontends.api.table import Row, Table
from roadproof.frontends.report.animations import animations
from roadproof.frontends.settings.option import takes
from roadproof.frontends.settings.readers import formats_in
from roadproof.library.loading import load_library
from roadproof.library.specification import Library
from roadproof.runtime.files import lock_folder, write_atomic
from roadproof.runtime.records import dataclass

ANIMATIONS = {"animation": "svg", "gif": "gif", "mp4": "mp4"}
"""Animations by the name that ``export`` has for them."""
"""Animations, which show RSS distances of the library too, and so are made here."""
# A drive, a drive file, or the path of one or of a folder of them.
DriveLike: TypeAlias = JudgedDrive | DriveFile | str | Path


def names() -> tuple[str, ...]:
    """The formats by name; animations where an extension draws them."""
    return (*FORMATS, *(name for name, x in ANIMATIONS.items() if x in animations()))


@dataclass(frozen=True)
class ExportedDrive:
    """The ``files`` of one drive in one format; ``ids``: its vehicles where they have numbers for names."""

    name: str
    format: str
    files: tuple[Path, ...]
    ids: Mapping[str, int]


@dataclass(frozen=True)
class Exports(Table):
    """Drives that were written into ``folder``."""

    folder: Path
    drives: tuple[ExportedDrive, ...]

    @property
    def files(self) -> tuple[Path, ...]:
        """All files, each once: drives on one map share it."""
        return tuple(dict.fromkeys(path for drive in self.drives for path in drive.files))

    def rows(self) -> list[Row]:
        """A row for each drive and format."""
        return [
            {
                "drive": x.name,
                "format": x.format,
                "files": " ".join(str(path.relative_to(self.folder)) for path in x.files),
                "vehicles": " ".join(f"{name}={number}" for name, number in x.ids.items()),
            }
            for x in self.drives
        ]

    def __str__(self) -> str:
        formats = list(dict.fromkeys(x.format for x in self.drives))
        count = len(self.drives) // len(formats)
        number = f"{count} drive{'s' if count > 1 else ''}"
        files = f"{len(self.files)} file{'s' if len(self.files) > 1 else ''}"
        return f"{number} as {', '.join(formats)}: {files} in {self.folder}"


@takes(Export)
def export(
    drives: DriveLike | Iterable[DriveLike],
    to: str | Iterable[str],
    out: str | Path,
    **options: Unpack[ExportKeywords],
) -> Exports:
    """Write drives for other tools (openscenario, opendrive, commonroad, highd, csv), or as animations.

    Every drive is judged first. ``to``: a format or several, which go into folders of their own then;
    ``rate``: samples a second where a format has samples; ``specs``: specification files that the drives were
    made with. In highD's format the drives are the recordings 01, 02 and so on. Raises ``InputError`` for
    drives that do not stand and roads that a format cannot say, ``UsageError``.
    """
    settings, formats = Export.of(options), formats_in(to, names())
    library = load_library(Path(x) for x in settings.specs)
    sources = [drives] if isinstance(drives, str | Path | JudgedDrive | DriveFile) else drives
    files = _by_unique_name(_judge_all(sources, library))
    subjects = [subject_of(name, k, file, settings.rate) for k, (name, file) in enumerate(files.items(), 1)]
    if not subjects:
        raise UsageError("no drive to export: name drive files, such as those of roadproof witness")
    folder = Path(out)
    contents = {(x.name, name): _files(x, name, library) for x in subjects for name in formats}
    _refuse_clash(contents)
    with lock_folder(folder):
        written = tuple(
            _write(folder / name if len(formats) > 1 else folder, subject, name, contents[subject.name, name])
            for subject in subjects
            for name in formats
        )
    return Exports(folder, written)


def _refuse_clash(contents: Mapping[tuple[str, str], Mapping[str, bytes]]) -> None:
    """Raises ``InputError`` where two drives have maps of one name that differ."""
    known = dict[tuple[str, str], bytes]()
    for (drive, form), files in contents.items():
        for name, content in files.items():
            if known.setdefault((form, name), content) != content:
                raise InputError(f"{drive}: another drive has another {name}; export to two folders")


def _files(subject: ExportSubject, name: str, library: Library) -> dict[str, bytes]:
    """The files of a drive in a format: their contents by name."""
    if name in ANIMATIONS:
        animation = animations()[ANIMATIONS[name]]
        return {f"{subject.name}{animation.ending}": animation.draw(subject.file, library)}
    return FORMATS[name](subject)


def _write(folder: Path, subject: ExportSubject, name: str, files: Mapping[str, bytes]) -> ExportedDrive:
    for file, content in files.items():
        write_atomic(folder / file, content)
    return ExportedDrive(subject.name, name, tuple(folder / x for x in files), vehicle_ids_in(name, subject))


def can_export(drive: str | Path, to: str, specs: Iterable[str | Path] = ()) -> None:
    """Nothing; raises ``InputError`` where a format cannot say a drive."""
    library = load_library(Path(x) for x in specs)
    [(name, file, _)] = _judge_all([drive], library)
    _files(subject_of(name, 1, file, 25), to, library)


def _judge_all(drives: Iterable[DriveLike], library: Library) -> Iterator[tuple[str, DriveFile, Path | None]]:
    """Yield each judged drive, with a name and the path that it was read from. Raises ``InputError``."""
    for drive in drives:
        if isinstance(drive, str | Path):
            for path in _paths(Path(drive)):
                yield path.stem, _judge_file(load_drive(path), str(path), library), path
        elif isinstance(drive, JudgedDrive):
            yield _usual_name(drive.file), drive.file, None
        else:
            yield _usual_name(drive), _judge_file(drive, "drive", library), None


def _judge_file(file: DriveFile, where: str, library: Library) -> DriveFile:
    try:
        return JudgedDrive(file, library).file
    except RejectedError as error:
        raise InputError(f"{where}: the drive fails its check and is not exported: {error}") from None


def _paths(path: Path) -> list[Path]:
    """The drive files of a folder, among other evidence; a file as it is."""
    if not path.is_dir():
        return [path]
    paths = [x for x in sorted(path.glob("*.json")) if _schema(x) in DRIVES]
    if not paths:
        known = " or ".join(DRIVES)
        raise InputError(f"{path}: the folder holds no drive files (*.json of schema {known})")
    return paths


def _schema(path: Path) -> object:
    content = read_json(path)
    return content.get("schema") if isinstance(content, dict) else None


def _usual_name(file: DriveFile) -> str:
    return "drive" if file.scenario is None else f"scenario-{file.scenario:02d}-{file.set_name}"


def _by_unique_name(drives: Iterable[tuple[str, DriveFile, Path | None]]) -> dict[str, DriveFile]:
    """The drives by name; values whose names are the same are counted. Raises ``UsageError`` for files."""
    exports: dict[str, DriveFile] = {}
    for name, file, path in drives:
        if name in exports and path is not None:
            raise UsageError(
                f"{path}: another drive has the name {name}; export one of them to another folder"
            )
        count = 1
        while (unique_name := name if count == 1 else f"{name}-{count}") in exports:
            count += 1
        exports[unique_name] = file
    return exports

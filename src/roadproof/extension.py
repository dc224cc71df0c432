"""The record by which an extension adds itself.

An extension is a package with an ``EXTENSION``: a folder of ``roadproof.extensions``, or a package of others
that an entry point of the group ``roadproof.extensions`` names. Its commands are the files of its folder
``commands``. All else is named in the record as ``module:name``, from the package on, and imported when it is
needed, so that a start reads nothing but records.
"""

from __future__ import annotations

import os
import sys
from collections.abc import Iterator, Mapping
from importlib import import_module
from typing import Any, Final, Literal, TypeAlias

GROUP: Final = "roadproof.extensions"
"""The folder of the extensions that come with roadproof, and the group of entry points of others."""
Label: TypeAlias = Literal["stable", "incubating"]
Audience: TypeAlias = Literal["testers", "safety cases", "researchers"]
Entries: TypeAlias = Mapping[str, str]
"""Names, each with ``module:name`` of what it stands for."""
LABELS: Final[tuple[Label, ...]] = ("stable", "incubating")
AUDIENCES: Final[tuple[Audience, ...]] = ("testers", "safety cases", "researchers")
_NONE: Entries = {}
_known: list[dict[str, Installed]] = []


class Extension:
    """What an extension adds. What is incubating may be removed.

    ``needs``: the extensions that it imports; ``incubating``: parts of a stable one that may be removed. All
    else are slots, each described where it is set.
    """

    def __init__(
        self,
        *,
        title: str,
        audience: Audience,
        label: Label = "stable",
        needs: tuple[str, ...] = (),
        incubating: tuple[str, ...] = (),
        functions: Entries = _NONE,
        questions: Entries = _NONE,
        answers: Entries = _NONE,
        evidence: Entries = _NONE,
        build_results: Entries = _NONE,
        kernels: tuple[str, ...] = (),
        modifiers: Entries = _NONE,
        roads: Entries = _NONE,
        frames: tuple[str, ...] = (),
        words: tuple[str, ...] = (),
        checked_files: Entries = _NONE,
        animations: Entries = _NONE,
        completions: Entries = _NONE,
        options: Entries = _NONE,
        sections: Entries = _NONE,
        formats: tuple[str, ...] = (),
        traces: Entries = _NONE,
        drives: Entries = _NONE,
        schemas: tuple[str, ...] = (),
    ) -> None:
        # Assigned by hand: a start, which reads all records, imports no dataclasses.
        self.title = title
        self.audience = audience
        self.label = label
        self.needs = needs
        self.incubating = incubating
        self.functions = functions
        """Functions and classes of ``import roadproof``."""
        self.questions = questions
        """Classes of questions, by their kind."""
        self.answers = answers
        """Classes of the answers to questions in Python, by the kind of the question."""
        self.evidence = evidence
        """Classes of evidence (``evidence.answer_files.OwnEvidence``), by the schema of their files."""
        self.build_results = build_results
        """Writers of files for build servers (``frontends.api.build_result.Writer``), by their format."""
        self.kernels = kernels
        """Those who check evidence again (``evidence.kernels.Kernels``)."""
        self.modifiers = modifiers
        """Functions that find the modifier of a question (``engines.modifier``), by the option for it."""
        self.roads = roads
        """Functions that read a road from a text that names it, by the ending of the file in it."""
        self.frames = frames
        """A function that makes a data frame of rows."""
        self.words = words
        """Functions that say what parts of a formula mean that scenarios have no words for."""
        self.checked_files = checked_files
        """Functions that check a file for ``roadproof check``, by its ending; they return the exit code."""
        self.animations = animations
        """Animations of drives (``frontends.report.witness.Animation``), by the name of their format."""
        self.completions = completions
        """Functions that give words with descriptions, with which a shell completes a value, by flag."""
        self.options = options
        """Classes of further options (``frontends.settings.option.Settings``), by their command."""
        self.sections = sections
        """Sections of pages (``extensions.pages.page.section_kind``), by the kind of the result."""
        self.formats = formats
        """Formats of recordings (``extensions.traffic.formats.source.Format``)."""
        self.traces = traces
        """Readers of a file of one trace (``extensions.traffic.formats.source.ReadTrace``), by its ending."""
        self.drives = drives
        """Readers of a file of one drive (``extensions.traffic.formats.source.ReadDrive``), by its ending."""
        self.schemas = schemas
        """Mappings of definitions of JSON files to their titles."""

    def own_names(self) -> Iterator[tuple[str, str]]:
        """Each slot and name that no other extension may have; several may add options to one command."""
        for slot, value in vars(self).items():
            if isinstance(value, dict) and slot != "options":
                yield from ((slot, name) for name in value)


class Installed:
    """An extension that is there: its name, its package and its record."""

    def __init__(self, name: str, package: str, record: Extension) -> None:
        self.name, self.package, self.record = name, package, record

    @property
    def folder(self) -> str:
        """The folder of its package."""
        return os.path.dirname(str(sys.modules[self.package].__file__))

    def whole(self, entry: str) -> str:
        """Return an entry of the record with the whole name of its module; those of roadproof have it."""
        return entry if entry.startswith("roadproof.") else f"{self.package}.{entry}"


def installed() -> Mapping[str, Installed]:
    """The extensions that are there, by name.

    Raises ``InputError`` for a package that cannot be imported or has no record, for a record that needs what
    is not there, and where two extensions have one name, or one in a slot.
    """
    if _known:
        return _known[0]
    folder = os.path.join(os.path.dirname(__file__), "extensions")
    own = sorted(os.listdir(folder)) if os.path.isdir(folder) else []
    own = [x for x in own if os.path.exists(os.path.join(folder, x, "__init__.py"))]
    found: dict[str, Installed] = {}
    for name, package in (*((x, f"{GROUP}.{x}") for x in own), *_of_others()):
        if name in found:
            raise refused(name, f"{found[name].package} and {package} both have this name; uninstall one")
        found[name] = _read(name, package)
    for x in found.values():
        if missing := [name for name in x.record.needs if name not in found]:
            raise refused(x.name, f"it needs {', '.join(missing)}; install it, or uninstall {x.package}")
    taken: dict[tuple[str, str], str] = {}
    for x in found.values():
        for key in x.record.own_names():
            if key in taken:
                raise refused(x.name, f"{key[0]}={key[1]!r} is in '{taken[key]}' already; uninstall one")
            taken[key] = x.name
    _known.append(found)
    return found


def entries(slot: str, core: Entries = _NONE) -> Mapping[str, str]:
    """Return the entries of a slot of the core and of all extensions, each as ``module:name``.

    Raises ``InputError`` where an extension has a name that the core has.
    """
    found = dict(core)
    for x in installed().values():
        for name, entry in getattr(x.record, slot).items():
            if name in core:
                raise refused(x.name, f"{slot}={name!r} is {found[name]} already; uninstall {x.package}")
            found[name] = x.whole(entry)
    return found


def added(slot: str, name: str) -> list[str]:
    """Return the entries that extensions have for one name in a slot, each as ``module:name``."""
    found = ((x, getattr(x.record, slot)) for x in installed().values())
    return [x.whole(named[name]) for x, named in found if name in named]


def listed(slot: str) -> list[str]:
    """Return what all extensions list in a slot, each as ``module:name``."""
    return [x.whole(entry) for x in installed().values() for entry in getattr(x.record, slot)]


def imported(entry: str) -> Any:
    """Return what ``module:name`` stands for. Raises ``InputError`` where a package of others lacks it."""
    module, _, name = entry.partition(":")
    try:
        return getattr(import_module(module), name)
    except (ImportError, AttributeError) as error:
        if entry.startswith("roadproof."):
            raise
        raise refused(module.partition(".")[0], f"{entry} is named, but not there: {error}") from error


def _read(name: str, package: str) -> Installed:
    try:
        record = getattr(import_module(package), "EXTENSION", None)
    except Exception as error:  # whatever a package of others does
        reason = f"{type(error).__name__}: {error}"
        raise refused(name, f"{package} cannot be imported: {reason}; mend or uninstall it") from error
    if not isinstance(record, Extension):
        raise refused(name, f"{package} has no EXTENSION of the class Extension; mend or uninstall it")
    for field, known in (("audience", AUDIENCES), ("label", LABELS)):
        if (value := getattr(record, field)) not in known:
            raise refused(name, f"{field}={value!r} of {package} is none of {', '.join(known)}")
    return Installed(name, package, record)


def refused(name: str, reason: str) -> Exception:
    """Return the error that says what is wrong with an extension, and what to do."""
    from roadproof.errors import InputError  # a start needs none

    return InputError(f"extension '{name}': {reason}")


def _of_others() -> list[tuple[str, str]]:
    """The names and packages of the extensions of others.

    ``importlib.metadata`` is slow to import, so it is asked only where a file mentions the group.
    """
    if not any(map(_mentions, _entry_point_files())):
        return []
    from importlib.metadata import entry_points

    return sorted({(x.name, x.value) for x in entry_points(group=GROUP)})


def _entry_point_files() -> Iterator[str]:
    for place in sys.path:
        try:
            found = os.listdir(place or ".")
        except OSError:
            continue
        yield from (
            os.path.join(place, x, "entry_points.txt")
            for x in found
            if x.endswith((".dist-info", ".egg-info"))
        )


def _mentions(file: str) -> bool:
    try:
        with open(file, "rb") as content:
            return f"[{GROUP}]".encode() in content.read()
    except OSError:
        return False

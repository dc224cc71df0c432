"""The record by which an extension adds itself.

An extension is a package with an ``EXTENSION``: a folder of ``roadproof.extensions``, or a package of others
that an entry point of the group ``roadproof.extensions`` names. Its commands are the files of its folder
``commands``. All else is named in the record as ``module:name``, from the package on, and imported when it is
needed, so that a start reads nothing but records.
"""

from __future__ import annotations

import os
import sys
from collections.abc import Iterable, Iterator, Mapping
from importlib import import_module
from typing import Any, Final, Literal, NamedTuple, TypeAlias

GROUP: Final = "roadproof.extensions"
"""The folder of the extensions that come with roadproof, and the group of entry points of others."""
Label: TypeAlias = Literal["stable", "incubating"]
Audience: TypeAlias = Literal["testers", "safety cases", "researchers"]
Entries: TypeAlias = Mapping[str, str]
"""Names, each with ``module:name`` of what it stands for."""
LABELS: Final[tuple[Label, ...]] = ("stable", "incubating")
AUDIENCES: Final[tuple[Audience, ...]] = ("testers", "safety cases", "researchers")
PLAIN: Final = ("title", "audience", "label", "page", "needs", "incubating", "reserved")
"""What a record has beside slots."""
CORE: Final = "core"
Key: TypeAlias = Literal["name", "slot", "none"]
KEYS: Final[Mapping[str, Key]] = {
    "functions": "name",
    "questions": "name",
    "answers": "name",
    "evidence": "name",
    "build_results": "name",
    "kernels": "slot",
    "modifiers": "name",
    "headings": "name",
    "roads": "name",
    "frames": "slot",
    "words": "none",
    "checked_files": "name",
    "animations": "name",
    "pictures": "name",
    "pages": "name",
    "completions": "name",
    "options": "none",
    "sections": "name",
    "formats": "name",
    "traces": "name",
    "drives": "name",
    "drivers": "name",
    "specifications": "name",
    "schemas": "none",
}
"""The key of an entry by its slot. No two extensions, nor one and the core, have the same key in a slot.

``name``: the name of the entry. ``slot``: the slot itself, so that one extension fills it. ``none``: several
extensions may have the same entry (``SHARED``).
"""
SHARED: Final[Mapping[str, str]] = {
    "words": "all functions are called, and the first phrase for a part of a formula is used",
    "options": "several extensions extend a command; option.extensible refuses a flag that it has",
    "schemas": "several extensions list definitions; make generated refuses a file that is described",
}
"""Why entries of a slot have no key."""
LISTS: Final = ("kernels", "frames", "words", "schemas")
"""The slots whose entries have no names."""
OWN_NAMES: Final[Mapping[str, str]] = {"drivers": "name", "formats": "name", "questions": "kind"}
"""The attribute of an imported entry that repeats its name in the record, by slot."""
_NONE: Entries = {}
_NO_NAMES: Mapping[str, tuple[str, ...]] = {}
_known: list[dict[str, InstalledExtension]] = []


class Extension(NamedTuple):
    """The record of an extension: all that it adds, each slot by its keyword."""

    title: str
    """A title for lists of extensions."""
    audience: Audience
    """The readers whom it is for."""
    label: Label = "stable"
    """An incubating extension may be removed."""
    page: str = ""
    """The path or address of its documentation."""
    needs: tuple[str, ...] = ()
    """The extensions that it imports."""
    incubating: tuple[str, ...] = ()
    """Parts of a stable extension that may be removed."""
    reserved: Mapping[str, tuple[str, ...]] = _NO_NAMES
    """Names in slots that its own code handles, which no other extension may have."""
    functions: Entries = _NONE
    """Functions and classes of ``import roadproof``."""
    questions: Entries = _NONE
    """Classes of questions, by their kind."""
    answers: Entries = _NONE
    """Classes of the answers to questions in Python, by the kind of the question."""
    evidence: Entries = _NONE
    """Classes of evidence (``evidence.answer_files.OwnEvidence``), by the schema of their files."""
    build_results: Entries = _NONE
    """Writers of files for build servers (``frontends.api.build_result.Writer``), by their format."""
    kernels: tuple[str, ...] = ()
    """Those who check evidence again (``evidence.kernels.Kernels``)."""
    modifiers: Entries = _NONE
    """Functions that find the modifier of a question (``engines.modifier``), by the option for it."""
    headings: Entries = _NONE
    """Dataclasses with fields that modifiers add to the heading of answers, by the name of the field."""
    roads: Entries = _NONE
    """Functions that read a road from a text that names it, by the ending of the file in it."""
    frames: tuple[str, ...] = ()
    """A function that makes a data frame of rows."""
    words: tuple[str, ...] = ()
    """Functions that say what parts of a formula mean that scenarios have no words for."""
    checked_files: Entries = _NONE
    """Functions that check a file for ``roadproof check``, by its ending; they return the exit code."""
    animations: Entries = _NONE
    """Animations of drives (``frontends.report.witness.Animation``), by the name of their format."""
    pictures: Entries = _NONE
    """Functions that draw an answer of the core, by the kind of its question; ``drive`` draws a drive file,
    by a library, under a title. Each returns a ``frontends.report.picture.Picture``.
    """
    pages: Entries = _NONE
    """Functions that write a page about a folder of answers into it, by the kind of its question."""
    completions: Entries = _NONE
    """Functions that give words with descriptions, with which a shell completes a value, by flag."""
    options: Entries = _NONE
    """Classes of further options (``frontends.settings.option.Settings``), by their command."""
    sections: Entries = _NONE
    """Sections of pages (``extensions.pages.page.section_kind``), by the kind of the result."""
    formats: Entries = _NONE
    """Formats of recordings (``extensions.traffic.formats.source.Format``), by their name."""
    traces: Entries = _NONE
    """Readers of a file of one trace (``extensions.traffic.formats.source.ReadTrace``), by its ending."""
    drives: Entries = _NONE
    """Readers of a file of one drive (``extensions.traffic.formats.source.ReadDrive``), by its ending."""
    drivers: Entries = _NONE
    """Driver models (``extensions.drivers.driver_model.DriverModel``), by their name."""
    specifications: Entries = _NONE
    """Files of definitions in its folder that are read where they are named, by their name."""
    schemas: tuple[str, ...] = ()
    """Mappings of definitions of JSON files to their titles."""

    def own_keys(self) -> Iterator[tuple[str, str]]:
        """Yield each slot with the keys that no other extension may have in it."""
        for slot, key in KEYS.items():
            names = (*getattr(self, slot), *self.reserved.get(slot, ()))
            if key == "name":
                yield from ((slot, name) for name in names)
            elif key == "slot" and names:
                yield slot, ""

    def fault(self) -> str:
        """Return the first value that is not of the kind that its slot takes, or ""."""
        for field, known in (("audience", AUDIENCES), ("label", LABELS)):
            if (value := getattr(self, field)) not in known:
                return f"{field}={value!r} is none of {', '.join(known)}"
        for slot in KEYS:
            kind, noun = (tuple, "tuple") if slot in LISTS else (Mapping, "mapping")
            if not isinstance(value := getattr(self, slot), kind):
                return f"{slot}={value!r} is no {noun}"
        return ""


class InstalledExtension:
    """An extension that is there: its name, package and record, and the distribution that others install.

    ``distribution`` is a name with a version, empty for the extensions of roadproof.
    """

    def __init__(self, name: str, package: str, record: Extension, distribution: str = "") -> None:
        self.name, self.package, self.record, self.distribution = name, package, record, distribution

    @property
    def is_foreign(self) -> bool:
        """Return whether it is a package of others."""
        return self.package.partition(".")[0] != "roadproof"

    @property
    def folder(self) -> str:
        """The folder of its package."""
        return os.path.dirname(str(sys.modules[self.package].__file__))

    def whole(self, entry: str) -> str:
        """Return an entry of the record with the whole name of its module; those of roadproof have it."""
        return entry if entry.startswith("roadproof.") else f"{self.package}.{entry}"


def installed_extensions() -> Mapping[str, InstalledExtension]:
    """The extensions that are there, by name, without the core.

    Raises ``InputError`` for a package that cannot be imported or has no record, for a record that needs what
    is not there, and where two extensions have one name, or an extension has a key in a slot (``KEYS``) that
    another one or the core has.
    """
    return {name: x for name, x in _filled().items() if name != CORE}


def _filled() -> Mapping[str, InstalledExtension]:
    """The core and the extensions that are there, by name."""
    if _known:
        return _known[0]
    folder = os.path.join(os.path.dirname(__file__), "extensions")
    own = sorted(os.listdir(folder)) if os.path.isdir(folder) else []
    own = [x for x in own if os.path.exists(os.path.join(folder, x, "__init__.py"))]
    known = {CORE: core()}
    for name, package, *distribution in (*((x, f"{GROUP}.{x}") for x in own), *_of_others()):
        if name in known:
            raise extension_error(
                name, f"{known[name].package} and {package} both have this name; uninstall one"
            )
        known[name] = _read(name, package, *distribution)
    for x in known.values():
        if missing := [name for name in x.record.needs if name not in known]:
            raise extension_error(
                x.name, f"it needs {', '.join(missing)}; install it, or uninstall {x.package}"
            )
    _check_keys(known.values())
    _known.append(known)
    return known


def core() -> InstalledExtension:
    """Return the core as an extension: what it has in the slots, and the names that it handles itself."""
    return InstalledExtension(CORE, "roadproof", import_module("roadproof.core_record").EXTENSION)


def _check_keys(extensions: Iterable[InstalledExtension]) -> None:
    """Raises ``InputError`` where two of them have the same key in a slot."""
    taken: dict[tuple[str, str], InstalledExtension] = {}
    for x in extensions:
        for slot, key in x.record.own_keys():
            if (former := taken.setdefault((slot, key), x)) is not x:
                entry = f"{slot}={key!r}" if key else slot
                where = "the core" if former.name == CORE else f"'{former.name}'"
                one = "one" if former.is_foreign else x.package
                raise extension_error(x.name, f"{entry} is in {where} already; uninstall {one}")


def entries(slot: str) -> Mapping[str, str]:
    """Return the entries of a slot of the core and of all extensions, each as ``module:name``."""
    known = _filled().values()
    return {name: x.whole(entry) for x in known for name, entry in getattr(x.record, slot).items()}


def imported(slot: str, name: str) -> Any:
    """Return what an entry of a slot stands for.

    Raises ``InputError`` where a package of others lacks it, or gives it another name than its record does.
    """
    value = import_entry(entries(slot)[name])
    own = getattr(value, OWN_NAMES[slot], name) if slot in OWN_NAMES else name
    if own != name:
        x = next(x for x in _filled().values() if name in getattr(x.record, slot))
        raise extension_error(x.name, f"{slot}={name!r} calls itself {own!r}; give it one name")
    return value


def named_entries(slot: str, name: str) -> list[str]:
    """Return the entries that extensions have for one name in a slot, each as ``module:name``."""
    records = ((x, getattr(x.record, slot)) for x in installed_extensions().values())
    return [x.whole(named[name]) for x, named in records if name in named]


def list_entries(slot: str) -> list[str]:
    """Return what all extensions list in a slot, each as ``module:name``."""
    return [x.whole(entry) for x in installed_extensions().values() for entry in getattr(x.record, slot)]


def extension_of(module: str) -> InstalledExtension | None:
    """Return the extension whose package has a module; None for other modules."""
    known = installed_extensions().values()
    return next((x for x in known if f"{module}.".startswith(f"{x.package}.")), None)


def owner_of(entry: str) -> str:
    """Return the name of the extension to which ``module:name`` belongs, or else of its package."""
    module = entry.partition(":")[0]
    owner = extension_of(module)
    return module.partition(".")[0] if owner is None else owner.name


def import_entry(entry: str) -> Any:
    """Return what ``module:name`` stands for. Raises ``InputError`` where a package of others lacks it."""
    module, _, name = entry.partition(":")
    try:
        return getattr(import_module(module), name)
    except (ImportError, AttributeError) as error:
        if entry.startswith("roadproof."):
            raise
        raise extension_error(owner_of(entry), f"{entry} is named, but not there: {error}") from error


def _read(name: str, package: str, distribution: str = "") -> InstalledExtension:
    try:
        record = getattr(import_module(package), "EXTENSION", None)
    except Exception as error:  # whatever a package of others does
        reason = f"{type(error).__name__}: {error}"
        raise extension_error(
            name, f"{package} cannot be imported: {reason}; mend or uninstall it"
        ) from error
    if not isinstance(record, Extension):
        raise extension_error(
            name, f"{package} has no EXTENSION of the class Extension; mend or uninstall it"
        )
    if fault := record.fault():
        raise extension_error(name, f"{package}: {fault}; mend or uninstall it")
    return InstalledExtension(name, package, record, distribution)


def extension_error(name: str, reason: str) -> Exception:
    """Return the error that says what is wrong with an extension, and what to do."""
    from roadproof.errors import InputError  # a start needs none

    return InputError(f"extension '{name}': {reason}")


def _of_others() -> list[tuple[str, str, str]]:
    """The names, packages and distributions of the extensions of others.

    ``importlib.metadata`` is slow to import, so it is asked only where a file mentions the group.
    """
    if not any(map(_mentions, _entry_point_files())):
        return []
    from importlib.metadata import entry_points

    points = entry_points(group=GROUP)
    return sorted({(x.name, x.value, f"{x.dist.name} {x.dist.version}" if x.dist else "") for x in points})


def _entry_point_files() -> Iterator[str]:
    for place in sys.path:
        try:
            names = os.listdir(place or ".")
        except OSError:
            continue
        yield from (
            os.path.join(place, x, "entry_points.txt")
            for x in names
            if x.endswith((".dist-info", ".egg-info"))
        )


def _mentions(file: str) -> bool:
    try:
        with open(file, "rb") as content:
            return f"[{GROUP}]".encode() in content.read()
    except OSError:
        return False

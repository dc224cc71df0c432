"""Specification files that lie beside evidence, because the claims were made with them.

Evidence must not redefine what it is about: such a file may add definitions, sets and options to the library,
but change nothing that is there. One that does change something has to be named by whoever checks.
"""

from collections.abc import Mapping, Sequence
from pathlib import Path

from roadproof.errors import InputError, UsageError
from roadproof.evidence.strict import Fields
from roadproof.library.loading import load_library
from roadproof.library.specification import Library, on_request, read_specification
from roadproof.runtime.files import write_whole


def read_beside(data: Fields | None, folder: Path, given: Sequence[Path]) -> tuple[Library, tuple[Path, ...]]:
    """The library with the files ``given``, and on top those that ``data`` names in its ``specs``.

    Raises ``InputError`` where one is not in ``folder``, or changes what is below it.
    """
    below = load_library(given)
    names = data.texts("specs") if data is not None and data.has("specs") else ()
    for name in names:
        if "/" in name or "\\" in name or name in ("", ".", ".."):
            raise InputError(f"specs: '{name[:80]}' is no file in the folder of the index")
        if (folder / name).is_symlink() or not (folder / name).is_file():
            raise InputError(f"specs: there is no file {folder / name}")
    paths = tuple(folder / name for name in names)
    if not paths:
        return below, ()
    shipped = {file.name: file for file in on_request().values()}
    asked = [path for path in paths if path.name in shipped]
    for path in asked:
        if read_specification(path).text != read_specification(shipped[path.name]).text:
            raise InputError(
                f"{path}: it is not the file of that name that comes with roadproof, so what the evidence "
                "says is not what it seems; name the file with --spec if that is meant"
            )
    above = load_library((*given, *paths))
    _check_adds_only(load_library((*given, *asked)), above, paths)
    return above, paths


def specification_names(library: Library) -> list[str]:
    """Return the names of the users' specification files, as ``check`` looks for them beside the evidence.

    Raises ``UsageError`` where two files have the same name.
    """
    names = [Path(source.name).name for source in library.files]
    if len(set(names)) < len(names):
        paths = ", ".join(source.name for source in library.files)
        raise UsageError(f"two files of --spec have the same name: {paths}")
    return names


def keep_specifications(folder: Path, library: Library) -> None:
    """Write copies of the users' specification files into a folder of evidence: ``check`` reads them there.

    Raises ``UsageError`` where two files have the same name.
    """
    for name, source in zip(specification_names(library), library.files, strict=True):
        write_whole(folder / name, source.text.encode("utf-8"))


def _check_adds_only(below: Library, above: Library, paths: Sequence[Path]) -> None:
    changed: list[str] = []
    for kind in ("parameters", "options", "definitions", "sets", "lanes", "titles", "signals"):
        after: Mapping[object, object] = getattr(above, kind)
        changed += [str(name) for name, meaning in getattr(below, kind).items() if after.get(name) != meaning]
    # One more variant replaces definitions under a value that may be the default one.
    for choice, definitions in above.variants.items():
        if definitions != below.variants.get(choice):
            changed += [
                x.name for x in definitions if choice[0] in below.options or x.name in below.definitions
            ]
    if changed:
        raise InputError(
            f"{', '.join(map(str, paths))}: changes '{changed[0]}' of the library, so what the evidence says "
            "is not what it seems; name the file with --spec if that is meant"
        )

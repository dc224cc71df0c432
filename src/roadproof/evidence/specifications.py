"""The specification files that lie beside evidence, because the claims were made with them.

Evidence must not redefine its own subject. Such a file may add definitions, sets and options to the library,
but change nothing in it. A file with changes must be named by the person who checks.
"""

from collections.abc import Mapping, Sequence
from pathlib import Path

from roadproof.errors import InputError, UsageError
from roadproof.evidence.strict import Fields
from roadproof.library.loading import load_library
from roadproof.library.specification import Library, on_request, read_specification
from roadproof.runtime.files import write_atomic


def load_specs_beside(
    data: Fields | None, folder: Path, spec_files: Sequence[Path]
) -> tuple[Library, tuple[Path, ...]]:
    """Return the library with ``spec_files``, and on top the files that ``data`` names in its ``specs``.

    Raises ``InputError`` if one of them is not in ``folder``, or changes an existing definition.
    """
    base = load_library(spec_files)
    names = data.texts("specs") if data is not None and data.has("specs") else ()
    for name in names:
        if "/" in name or "\\" in name or name in ("", ".", ".."):
            raise InputError(f"specs: '{name[:80]}' is no file in the folder of the index")
        if (folder / name).is_symlink() or not (folder / name).is_file():
            raise InputError(f"specs: there is no file {folder / name}")
    paths = tuple(folder / name for name in names)
    if not paths:
        return base, ()
    shipped = {file.name: file for file in on_request().values()}
    bundled = [path for path in paths if path.name in shipped]
    for path in bundled:
        if read_specification(path).text != read_specification(shipped[path.name]).text:
            raise InputError(
                f"{path}: it is not the file of that name that comes with roadproof, so what the evidence "
                "says is not what it seems; name the file with --spec if that is meant"
            )
    extended = load_library((*spec_files, *paths))
    _check_adds_only(load_library((*spec_files, *bundled)), extended, paths)
    return extended, paths


def specification_names(library: Library) -> list[str]:
    """Return the names of the users' specification files, by which ``check`` finds them beside the evidence.

    Raises ``UsageError`` if two files have the same name.
    """
    names = [Path(source.name).name for source in library.files]
    if len(set(names)) < len(names):
        paths = ", ".join(source.name for source in library.files)
        raise UsageError(f"two files of --spec have the same name: {paths}")
    return names


def write_specifications(folder: Path, library: Library) -> None:
    """Write copies of the users' specification files into a folder of evidence, for ``check``.

    Raises ``UsageError`` if two files have the same name.
    """
    for name, source in zip(specification_names(library), library.files, strict=True):
        write_atomic(folder / name, source.text.encode("utf-8"))


def _check_adds_only(base: Library, extended: Library, paths: Sequence[Path]) -> None:
    changed: list[str] = []
    for kind in ("parameters", "options", "definitions", "sets", "lanes", "titles", "signals"):
        after: Mapping[object, object] = getattr(extended, kind)
        changed += [str(name) for name, meaning in getattr(base, kind).items() if after.get(name) != meaning]
    # One more variant replaces definitions under a value that may be the default one.
    for choice, definitions in extended.variants.items():
        if definitions != base.variants.get(choice):
            changed += [
                x.name for x in definitions if choice[0] in base.options or x.name in base.definitions
            ]
    if changed:
        raise InputError(
            f"{', '.join(map(str, paths))}: changes '{changed[0]}' of the library, so what the evidence says "
            "is not what it seems; name the file with --spec if that is meant"
        )

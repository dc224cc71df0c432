"""Reads requirements in any format, chosen by file suffix."""

from collections.abc import Callable, Mapping
from pathlib import Path

from roadproof.errors import InputError
from roadproof.extensions.assurance.requirements.doorstop import read_doorstop
from roadproof.extensions.assurance.requirements.reqif_file import read_reqif
from roadproof.extensions.assurance.requirements.requirement import RequirementSet, check_requirements
from roadproof.extensions.assurance.requirements.strictdoc import read_strictdoc
from roadproof.extensions.assurance.requirements.toml_file import read_toml_requirements

_FORMATS = "requirements.toml, .reqif, .sdoc (StrictDoc) or a folder of Doorstop"


def read_requirements(path: Path) -> RequirementSet:
    """Return the requirements of a file or a folder. Raises ``InputError``."""
    requirements = _read(path)
    check_requirements(requirements.requirements)
    if not requirements.requirements:
        raise InputError(f"{path}: there is no requirement in it")
    return requirements


def _read(path: Path) -> RequirementSet:
    if path.suffix == ".toml" and path.exists():
        return read_toml_requirements(path, _read_source)
    return _read_source(path).without_strange_parents()


def _read_source(path: Path) -> RequirementSet:
    """Return the requirements of a file that is not TOML. Raises ``InputError``."""
    if not path.exists():
        raise InputError(f"{path} does not exist: name {_FORMATS}")
    if path.is_dir():
        return read_doorstop(path)
    if path.suffix in _READERS:
        return _READERS[path.suffix](path)
    raise InputError(f"{path}: this is no file of requirements: name {_FORMATS}")


_READERS: Mapping[str, Callable[[Path], RequirementSet]] = {
    ".reqif": read_reqif,
    ".xml": read_reqif,
    ".sdoc": read_strictdoc,
}

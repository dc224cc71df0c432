"""The JSON document ``manifest.json`` of an auditor's bundle: its content, and what the check
script expects.
"""

from collections.abc import Mapping
from typing import Annotated, Final, Literal

from roadproof.evidence.answers import shared
from roadproof.evidence.codec import Doc
from roadproof.runtime.records import dataclass

SCHEMA: Final = "roadproof/bundle/1"


@dataclass(frozen=True, kw_only=True)
class Package:
    """A Python package that the check script installs."""

    name: str
    version: str
    sha256: Annotated[str, Doc("Of the file that is installed.")]


@dataclass(frozen=True, kw_only=True)
class Argument:
    """An assurance case or a file of requirements, which the check script checks against the evidence of the
    bundle.
    """

    command: Literal["assurance", "trace"]
    file: Annotated[str, Doc("The case or the requirements.")]
    exit_code: Annotated[int, Doc("Exit code of the command when the bundle was made; the check demands 0.")]


@dataclass(frozen=True, kw_only=True)
class Manifest:
    """The content of a bundle."""

    schema: Literal["roadproof/bundle/1"] = SCHEMA
    roadproof: shared.Version
    library: shared.Fingerprint
    python: Annotated[str, Doc("Version of Python that the packages are for, such as 3.12.")]
    platform: Annotated[str, Doc("Platform that the packages are for, such as linux-x86_64.")]
    evidence: Annotated[tuple[str, ...], Doc("Folders and files that are checked again, as they were named.")]
    specs: Annotated[tuple[str, ...], Doc("Specification files that they are read with.")]
    accepted: Annotated[int, Doc("Claims that were accepted when the bundle was made.")]
    claims: Annotated[int, Doc("Claims that were checked then.")]
    exit_code: Annotated[int, Doc("Exit code of roadproof check then.")]
    arguments: tuple[Argument, ...]
    packages: tuple[Package, ...]
    files: Annotated[Mapping[str, str], Doc("SHA-256 of every other file but SHA256SUMS, by path.")]

"""The answer of ``roadproof extensions``: the installed extensions."""

from typing import Annotated, Final, Literal

from roadproof.evidence.codec import Doc
from roadproof.runtime.records import dataclass

SCHEMA: Final = "roadproof/extensions/1"


@dataclass(frozen=True, kw_only=True)
class ExtensionData:
    """An extension: its additions, and its audience."""

    name: str
    package: str
    title: str
    audience: Literal["testers", "safety cases", "researchers"]
    label: Annotated[Literal["stable", "incubating"], Doc("What is incubating may be removed.")]
    incubating: Annotated[tuple[str, ...], Doc("Parts that may be removed.")]
    page: Annotated[str, Doc("The path or address of its documentation, or empty.")]
    needs: Annotated[tuple[str, ...], Doc("The extensions that it imports.")]
    commands: tuple[str, ...]
    functions: Annotated[tuple[str, ...], Doc("What it adds to import roadproof.")]
    questions: Annotated[tuple[str, ...], Doc("The kinds of questions that it adds.")]


@dataclass(frozen=True, kw_only=True)
class ExtensionsData:
    """The extensions that are installed."""

    schema: Literal["roadproof/extensions/1"] = SCHEMA
    roadproof: Annotated[str, Doc("The version of roadproof.")]
    extensions: tuple[ExtensionData, ...]

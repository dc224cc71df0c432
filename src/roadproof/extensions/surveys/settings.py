"""The options of surveys."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path
from typing import TYPE_CHECKING

from roadproof.frontends.settings import groups
from roadproof.frontends.settings.option import extensible, option, search
from roadproof.frontends.settings.readers import whole
from roadproof.runtime.records import dataclass

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

    from roadproof.frontends.api.definitions import What
    from roadproof.frontends.api.phrases import Term
    from roadproof.frontends.settings.value_types import RoadLike
    from roadproof.library.bind import Number


def text_or_none(text: str) -> str | None:
    """The text, or None where it is empty."""
    return text or None


@dataclass(frozen=True, kw_only=True)
class Ask(groups.Survey):
    """Options of ``ask``."""

    among: str | None = groups.scenarios_such_as()


@extensible("redundancy")
@dataclass(frozen=True, kw_only=True)
class Redundancy(groups.Survey):
    """Options of ``redundancy``."""

    among: str | None = groups.scenarios_such_as()
    whole: bool = option(False, "--whole", "include the parts of simple predicates")
    effort: float = groups.effort_for("a drive", 20.0)


@extensible("coverage")
@dataclass(frozen=True, kw_only=True)
class Coverage(groups.Survey):
    """Options of ``coverage``."""

    wider: str | None = option(
        None, "--wider S", "set that misses nothing (default: complete, if it extends the set)"
    )
    roads: Iterable[RoadLike] | None = search(
        None, "--road R", "road to search; may be repeated (default: main-2, then main-3)", gather=list
    )
    needed: bool = option(
        False, "--needed", "if the set has no gap: find a drive for each definition that it needs"
    )
    on: str | Path | None = option(
        None, "--on DIR", "count the classes of gaps in these recordings", read=Path
    )
    strict: bool = groups.strict_reading()
    effort: float = groups.effort_for("a search", 10.0)
    out: str | Path | None = groups.folder_for("certificates, drives and pictures")
    pictures: bool = groups.pictures_of(command_line_only=True)


@extensible("classify")
@dataclass(frozen=True, kw_only=True)
class Classify(groups.Survey):
    """Options of ``classify``."""

    among: str | None = groups.scenarios_such_as("1-8")
    on: str | Path | None = option(
        None, "--on DIR", "recordings for the shares (default: simulated traffic)", read=Path
    )
    strict: bool = groups.strict_reading()
    shares: bool = option(True, "--no-shares", "compute no shares")
    effort: float = groups.effort_for("a drive or a proof", 60.0)
    out: str | Path | None = groups.folder_for("classes.spec, claims, evidence, picture")
    pictures: bool = groups.pictures_of("picture", command_line_only=True)


@extensible("explore")
@dataclass(frozen=True, kw_only=True)
class Explore(groups.DriveSearch):
    """Options of ``explore``."""

    vary: Mapping[str, tuple[Number, Number]] | None = option(
        None,
        "--vary NAME=LOW:HIGH",
        "vary a parameter, or a limit such as POV.a_lon.min; may be given twice",
        gather=list,
    )
    steps: int | None = option(
        None, "--steps K", "number of values (default: 11; 6 for each of two)", read=whole(2), rare=True
    )
    least: Term | None = option(None, "--least TERM", "find the least value of a term", read=text_or_none)
    greatest: Term | None = option(
        None, "--greatest TERM", "find the greatest value of a term", read=text_or_none
    )
    when: What | None = option(
        None, "--when FORMULA", "measure the term when FORMULA holds, not at time 0", rare=True
    )
    precision: Number | None = option(
        None, "--precision P", "width of a bracket in SI units (default: range/60; 0.1 for a term)", rare=True
    )
    effort: float = groups.effort_for("a question", 6.0)
    out: str | Path | None = groups.folder_for("drives, certificates, JSON, pictures")
    pictures: bool = groups.pictures_of(command_line_only=True)

"""Options that several questions share, in groups which they inherit."""

from __future__ import annotations

from fractions import Fraction
from pathlib import Path
from typing import TYPE_CHECKING, Any

from roadproof.frontends.settings.option import Settings, definition, option, output, search, work
from roadproof.frontends.settings.readers import (
    assignment,
    decimal,
    file_name,
    folder,
    named,
    seconds,
    set_names,
    whole,
)
from roadproof.runtime.records import dataclass

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

    from roadproof.evidence.claim import Engine
    from roadproof.frontends.settings.value_types import RoadLike, Vehicles
    from roadproof.library.bind import Number
    from roadproof.runtime.executors import Jobs
    from roadproof.runtime.pool import Progress, Say
    from roadproof.semantics.sampled.answers import Convention


OBJECTIVES = ("any", "smooth", "margin", "mild", "severe", "short", "typical")
"""What a drive can be like (``engines.search.question.Objective``)."""


def effort_for(what: str, units: float) -> Any:
    """``effort`` of a question that gives so many units of work to each ``what``."""
    text = f"about N solver seconds for {what} (default: {units:g}); counted, so the answer is the same on "
    text += "every machine"
    return option(units, "--effort N", text, group="effort", read=decimal)


def folder_for(what: str, command_line_only: bool = False, required: bool = False) -> Any:
    """``out`` of a question that writes ``what``."""
    keyword = not command_line_only
    return output(None, "--out DIR", f"write {what}", read=folder, keyword=keyword, required=required)


def specifications_of(what: str) -> Any:
    """``specs``, the specification files that ``what`` were made with."""
    text = f"specification file of {what}; may be repeated"
    return option((), "--spec FILE", text, group="definitions", read=Path, gather=tuple)


def pictures_of(what: str = "pictures", command_line_only: bool = False) -> Any:
    """``pictures`` of a question that draws ``what``."""
    keyword = not command_line_only
    return output(True, "--no-pictures", f"draw no {what}", keyword=keyword, rare=True)


def strict_reading(rare: bool = False) -> Any:
    """``strict``: files are read as a whole or not at all."""
    return option(False, "--strict", "reject a file of which vehicles or parts would be left out", rare=rare)


def map_road() -> Any:
    """``road``: the road of recordings that name no lanes."""
    return option(None, "--road MAP#ROAD", "road of a map, for recordings without lanes (such as inD, OSI)")


def checker_of(what: str) -> Any:
    """``solver``, which checks evidence; ``what`` is its help."""
    return option("z3", "--solver", f"{what} (default: z3)", choices=("z3", "cvc5"))


def scenarios_such_as(example: str = "1,3-8", keyword: bool = False) -> Any:
    """``--among``, which is the first argument in Python where it is no ``keyword``."""
    return option(None, "--among N-M", f"only these scenarios, such as {example}", keyword=keyword)


def same_or_any(flag: str, what: str) -> Any:
    """A choice between the same for both scenarios, and any."""
    return option("same", flag, f"{what} (default: same)", choices=("same", "any"))


def one_set(*default: str) -> Any:
    """``--set`` of a question about one spec set."""
    default_text = f" (default: {default[0]})" if default else ""
    return definition(default, "--set S", f"spec set{default_text}", read=lambda text: (text,))


def several_sets(*default: str) -> Any:
    """``--set`` of a question about several spec sets."""
    text = f"spec set (default: {','.join(default)}); may be repeated"
    return definition(default, "--set S", text, gather=set_names)


@dataclass(frozen=True, kw_only=True)
class Answered(Settings):
    """An answer that may be wanted as JSON."""

    json: str | None = output(
        None,
        "--json FILE",
        "write JSON to FILE, or to stdout if FILE is -",
        read=file_name,
        keyword=False,
        last=True,
    )


@dataclass(frozen=True, kw_only=True)
class Readings(Settings):
    """A spec set, files on top of the library, and readings."""

    sets: tuple[str, ...] = one_set("base")
    specs: Iterable[str | Path] = definition(
        (), "--spec FILE", "specification file to add; may be repeated", read=Path, gather=list
    )
    readings: Mapping[str, str] | None = definition(
        None,
        "--option NAME=VALUE",
        "choose a reading, such as lateral_sign=literal; may be repeated",
        read=assignment("--option"),
        gather=dict,
        rare=True,
    )


@dataclass(frozen=True, kw_only=True)
class Values(Readings):
    """Definitions, with values of parameters."""

    params: Mapping[str, Number] | None = definition(
        None,
        "--param NAME=VALUE",
        "set a parameter, such as rho=3/5; may be repeated",
        read=assignment("--param"),
        gather=dict,
    )


@dataclass(frozen=True, kw_only=True)
class DefinitionsSettings(Values, Answered):
    """The definitions that a question is asked in."""


@dataclass(frozen=True, kw_only=True)
class SeveralSets(DefinitionsSettings):
    """Definitions in several spec sets."""

    sets: tuple[str, ...] = several_sets("base")


@dataclass(frozen=True, kw_only=True)
class Models(Settings):
    """Vehicle models."""

    vehicles: Vehicles = search(
        None,
        "--vehicle [NAME=]MODEL",
        "vehicle model, or .toml file (default: car)",
        read=named(""),
        gather=dict,
        rare=True,
    )


@dataclass(frozen=True, kw_only=True)
class SearchPlace(Models):
    """The road, the vehicles and the horizon of a search for drives."""

    road: RoadLike | None = search(None, "--road R", "road, .toml file or map (default: by formula)")
    lanes: Mapping[str, str] | None = search(
        None,
        "--lane [L=]LANE",
        "lane that L means (default: any, from the right)",
        read=named("L"),
        gather=dict,
        rare=True,
    )
    horizon: Number = search(Fraction(6), "--horizon S", "seconds to search (default: 6)", read=seconds)
    dt: Number | None = search(
        None,
        "--dt S",
        "seconds between samples (default: the coarsest that fits, at most 3/5)",
        read=seconds,
        rare=True,
    )
    reach: Number = search(
        Fraction(80),
        "--reach M",
        "largest distance of vehicles at the start in metres (default: 80)",
        read=seconds,
        rare=True,
    )
    collisions: bool = search(False, "--allow-collisions", "allow vehicles to overlap", rare=True)
    strict: bool = strict_reading(rare=True)


@dataclass(frozen=True, kw_only=True)
class Traces(Settings):
    """The meaning of recorded traces."""

    end: Convention = option(
        "truncated",
        "--end KIND",
        "end of a trace: truncated (default) asks for every continuation, clip cuts windows there",
        choices=("truncated", "clip"),
    )


@dataclass(frozen=True, kw_only=True)
class Method(Settings):
    """The engine and the solver of a search for drives."""

    engine: Engine = search(
        "milp", "--engine", "method of the search (default: milp)", choices=("milp", "smt"), rare=True
    )
    solver: str = search(
        "highs", "--solver NAME", "mixed-integer solver of --engine milp (default: highs)", rare=True
    )


@dataclass(frozen=True, kw_only=True)
class BudgetSettings(Settings):
    """The work that a claim may take, and the clock that ends it."""

    effort: float = effort_for("a question", 60.0)
    timeout: float | None = option(
        None,
        "--timeout S",
        "seconds after which the clock ends a search, whatever work is left; the answer then says so "
        "(default: 60 for each unit of --effort, at least 600)",
        group="effort",
        read=decimal,
        rare=True,
    )


@dataclass(frozen=True, kw_only=True)
class Workers(Settings):
    """The number of processes, and whether they report progress."""

    jobs: Jobs = option(
        None,
        "--jobs N",
        "number of processes (default: one per core)",
        group="work",
        read=whole(1),
        rare=True,
    )
    quiet: bool = output(False, "--quiet", "suppress progress output", keyword=False, rare=True)


@dataclass(frozen=True, kw_only=True)
class Listeners(Settings):
    """Listeners for progress, and for stored answers that do not count."""

    progress: Progress | None = option(None)
    say: Say | None = option(None)


@dataclass(frozen=True, kw_only=True)
class Run(Workers, Listeners):
    """The processes of a long question, and the folder of its evidence."""

    out: str | Path | None = folder_for("certificates and drives")
    fresh: bool = option(
        False,
        "--fresh",
        help="compute known answers again: those of roadproof itself and of the cache, not those in --out",
        group="work",
        rare=True,
    )


@dataclass(frozen=True, kw_only=True)
class Sharing(Workers):
    """The share of one of several runs, or a cluster; from Python ``jobs`` says this."""

    shard: str | None = work(
        None,
        "--shard K/N",
        "process shard K of N: start N runs with the same --out, then run once without --shard to merge",
    )
    cluster: str | None = work(
        None,
        "--cluster SCHEDULER|local:N",
        "work on a Dask cluster, such as tcp://host:8786, or on a local one of N processes",
    )
    tls_ca: str | None = work(
        None,
        "--tls-ca FILE",
        "certificate of the authority (CA) that signed the certificate of the scheduler",
    )
    tls_cert: str | None = work(
        None, "--tls-cert FILE", "certificate of this client, if the scheduler asks for one"
    )
    tls_key: str | None = work(None, "--tls-key FILE", "private key of --tls-cert")


@dataclass(frozen=True, kw_only=True)
class Survey(DefinitionsSettings, Models, BudgetSettings, Sharing, Run):
    """Options of every question about several scenarios."""


@dataclass(frozen=True, kw_only=True)
class DriveSearch(SeveralSets, SearchPlace, Method, BudgetSettings, Sharing, Run):
    """Options of every question about drives of some scenarios or formulas."""

"""Formulas for other programs: monitors in C99, and problems of searches for other solvers."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping
from fractions import Fraction
from pathlib import Path
from typing import Literal, TypeAlias, Unpack

from roadproof.errors import UsageError
from roadproof.extensions.encoding import kinds
from roadproof.extensions.encoding.files import CompiledProblems, compile_problems, write_problems
from roadproof.extensions.exchange.keywords import CompileKeywords
from roadproof.extensions.exchange.settings import Compile
from roadproof.extensions.exchange.streaming.c_files import FLAGS, CSource, compile_c
from roadproof.extensions.exchange.streaming.functions import StreamMonitor
from roadproof.extensions.exchange.watching import road_of_samples, stream_formula
from roadproof.frontends.api.definitions import Definitions, What, definitions_of
from roadproof.frontends.api.settings import positive
from roadproof.frontends.api.table import Row, Table
from roadproof.frontends.report.sheet import aligned
from roadproof.frontends.settings.option import takes
from roadproof.library.scenarios import name_of
from roadproof.library.specification import Query, unknown_name
from roadproof.logic.formula import Application
from roadproof.runtime.files import lock_folder, write_atomic
from roadproof.runtime.records import dataclass
from roadproof.world.road import Road

Target: TypeAlias = Literal["c"] | kinds.Target


TARGETS: tuple[Target, ...] = ("c", *kinds.TARGETS)
OF_MONITORS = ("memory", "name")
OF_PROBLEMS = ("vehicles", "horizon", "reach", "collisions", "drives")
"""Options that only some targets have."""
STEP = Fraction(1, 25)  # s, of the samples of monitors


@dataclass(frozen=True, repr=False)
class CompiledMonitors(Table):
    """Monitors in C, a function for each formula; ``folder``: where the files are, None where in none.

    ``road``: that on which relations to lanes are computed, if any.
    """

    source: CSource
    folder: Path | None = None
    road: Road | None = None

    @property
    def files(self) -> Mapping[str, str]:
        """The texts of the header and of the source file, by name."""
        return self.source.files

    def rows(self) -> list[Row]:
        """A row for each formula: the step function, what verdicts are about, delay (s), memory (bytes)."""
        return [
            {
                "function": f"{x.identifier}_step",
                "formula": x.told,
                "about": _verdict_subject(x),
                "delay": float(x.plan.delay * self.source.dt),
                "memory": x.memory,
            }
            for x in self.source.monitors
        ]

    def __str__(self) -> str:
        head = ("function", "verdicts about", "delay", "memory")
        body = [
            (
                f"{x.identifier}_step",
                _verdict_subject(x),
                f"{float(x.plan.delay * self.source.dt):g} s",
                f"{x.memory} bytes",
            )
            for x in self.source.monitors
        ]
        lines = aligned([head, *body], [False, False, False, False])
        if self.folder is not None:
            lines += [f"written to {self.folder}: {', '.join(self.files)}"]
            lines += [f"compile: cc {FLAGS} -c {self.folder / f'{self.source.name}.c'}"]
        return "\n".join(line.rstrip() for line in lines)

    def __repr__(self) -> str:
        return f"<Monitors in C: {', '.join(x.identifier for x in self.source.monitors)}>"


def _verdict_subject(monitor: StreamMonitor) -> str:
    """Return the subject of a monitor's verdicts, in words."""
    return "the first sample" if monitor.plan.at_start else "each sample"


@takes(Compile)
def compile(
    what: What | Iterable[What],
    to: Target = "c",
    out: str | Path | None = None,
    using: Definitions | None = None,
    **options: Unpack[CompileKeywords],
) -> CompiledMonitors | CompiledProblems:
    """Scenarios or formulas for other programs, in the folder ``out``.

    ``to`` c: monitors in C99, functions that take one sample and return a verdict. ``dt``: seconds between
    samples. Relations to lanes are flags of the sample; with ``road`` and ``lanes`` they are computed from
    positions on that road. ``name``: of the two files. ``memory``: how many bytes the state of a monitor may
    take. ``to`` mps, lp, smt2: the problem that a search for drives solves, a file for each assignment of
    lanes, with a table of its rows; see ``encode``. Raises ``InputError`` for formulas that need more memory,
    ``TextError``, ``UsageError``.
    """
    settings, home = Compile.of(options), definitions_of(using)
    if to not in TARGETS:
        raise UsageError(unknown_name("target", to, TARGETS))
    _refuse_options(settings, OF_PROBLEMS if to == "c" else OF_MONITORS, to)
    if not re.fullmatch(r"[A-Za-z][A-Za-z0-9_]{0,40}", settings.name):
        raise UsageError(f"name={settings.name}: write letters, digits and _, and a letter first")
    queries = [what] if isinstance(what, int | str) or not isinstance(what, Iterable) else what
    named = _named(home, queries)
    if to == "c":
        return _compile_monitors(home, named, settings, None if out is None else Path(out))
    problems = compile_problems(home, named, to, settings, settings.drives)
    return problems if out is None else write_problems(problems, Path(out))


def _refuse_options(settings: Compile, names: Iterable[str], to: Target) -> None:
    """Raises ``UsageError`` for an option that another target has, and that this one would ignore."""
    for name in names:
        value = getattr(settings, name)
        if value != getattr(Compile, name):
            others = "mps, lp or smt2" if to == "c" else "c"
            raise UsageError(f"{name}={value}: to={to} has no such option; it is one of to={others}")


def _named(home: Definitions, queries: Iterable[What]) -> dict[str, What]:
    """Return formulas by the beginning of their names."""
    named: dict[str, What] = {}
    for k, x in enumerate(home.each(queries), 1):
        number, query = home.numbered(x)
        named[_unused_identifier(_identifier(number, query, k), named)] = x
    return named


def _compile_monitors(
    home: Definitions, named: Mapping[str, What], settings: Compile, out: Path | None
) -> CompiledMonitors:
    road = road_of_samples(settings)
    read = {name: home.numbered(x)[1] for name, x in named.items()}
    formulas = {name: (x.text, stream_formula(x, home, settings.lanes, road)) for name, x in read.items()}
    dt = positive("dt", STEP if settings.dt is None else settings.dt, "s")
    source = compile_c(formulas, dt, settings.name, settings.memory)
    if out is None:
        return CompiledMonitors(source, road=road)
    with lock_folder(out):
        for name, text in source.files.items():
            write_atomic(out / name, text.encode())
    return CompiledMonitors(source, out, road)


def _identifier(number: int | None, query: Query, place: int) -> str:
    """The beginning of the names of functions: scenario_4, danger_SV_POV, or formula_1."""
    if number is not None:
        return name_of(number)
    if isinstance(query.formula, Application):
        return re.sub(r"\W+", "_", "_".join((query.formula.name, *query.formula.arguments)))
    return f"formula_{place}"


def _unused_identifier(identifier: str, taken: Mapping[str, object]) -> str:
    """An identifier that no other has, in whatever letters."""
    identifiers, number, candidate = {x.lower() for x in taken}, 1, identifier
    while candidate.lower() in identifiers:
        number += 1
        candidate = f"{identifier}_{number}"
    return candidate

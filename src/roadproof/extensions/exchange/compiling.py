"""Formulas as monitors that run elsewhere: C99 that takes one sample at a time."""

import re
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Literal, TypeAlias, Unpack

from roadproof.errors import UsageError
from roadproof.extensions.exchange.keywords import CompileKeywords
from roadproof.extensions.exchange.settings import Compile
from roadproof.extensions.exchange.streaming.c_files import FLAGS, CSource, compile_c
from roadproof.extensions.exchange.streaming.functions import StreamMonitor
from roadproof.frontends.api.definitions import Definitions, What, definitions_of
from roadproof.frontends.api.settings import as_road, positive
from roadproof.frontends.api.table import Row, Table
from roadproof.frontends.report.sheet import aligned
from roadproof.frontends.settings.option import takes
from roadproof.library.bind import bind, refuse_variables
from roadproof.library.scenarios import name_of
from roadproof.library.specification import Query, unknown
from roadproof.logic.formula import Application, Formula
from roadproof.logic.rewrite import with_values
from roadproof.runtime.files import hold_folder, write_whole
from roadproof.runtime.records import dataclass
from roadproof.world.road import Road

Target: TypeAlias = Literal["c"]


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
                "function": f"{x.label}_step",
                "formula": x.told,
                "about": _about(x),
                "delay": float(x.plan.delay * self.source.dt),
                "memory": x.memory,
            }
            for x in self.source.monitors
        ]

    def __str__(self) -> str:
        head = ("function", "verdicts about", "delay", "memory")
        body = [
            (f"{x.label}_step", _about(x), f"{float(x.plan.delay * self.source.dt):g} s", f"{x.memory} bytes")
            for x in self.source.monitors
        ]
        lines = aligned([head, *body], [False, False, False, False])
        if self.folder is not None:
            lines += [f"written to {self.folder}: {', '.join(self.files)}"]
            lines += [f"compile: cc {FLAGS} -c {self.folder / f'{self.source.name}.c'}"]
        return "\n".join(line.rstrip() for line in lines)

    def __repr__(self) -> str:
        return f"<Monitors in C: {', '.join(x.label for x in self.source.monitors)}>"


def _about(monitor: StreamMonitor) -> str:
    """What the verdicts of a monitor are about."""
    return "the first sample" if monitor.plan.at_start else "each sample"


@takes(Compile)
def compile(
    what: What | Iterable[What],
    to: Target = "c",
    out: str | Path | None = None,
    using: Definitions | None = None,
    **options: Unpack[CompileKeywords],
) -> CompiledMonitors:
    """Monitors in C99 for scenarios or formulas: functions that take one sample and return a verdict.

    ``dt``: seconds between samples. Relations to lanes are flags of the sample; with ``road`` and ``lanes``
    they are computed from positions on that road. ``name``: of the two files, which go to the folder
    ``out``. ``memory``: how many bytes the state of a monitor may take. Raises ``InputError`` for formulas
    that need more, ``TextError``, ``UsageError``.
    """
    given, home = Compile.of(options), definitions_of(using)
    if to != "c":
        raise UsageError(unknown("target", to, ("c",)))
    if not re.fullmatch(r"[A-Za-z][A-Za-z0-9_]{0,40}", given.name):
        raise UsageError(f"name={given.name}: write letters, digits and _, and a letter first")
    if given.lanes and given.road is None:
        raise UsageError("lanes: the lanes of which road? Name it, or leave lanes to the flags of samples")
    road = None if given.road is None else as_road(given.road, given.strict)
    each = [what] if isinstance(what, int | str) or not isinstance(what, Iterable) else what
    formulas: dict[str, tuple[str, Formula]] = {}
    for k, x in enumerate(home.each(each), 1):
        number, query = home.numbered(x)
        label = _free(_label(number, query, k), formulas)
        formulas[label] = query.text, _with_values(query, home, given, road)
    source = compile_c(formulas, positive("dt", given.dt, "s"), given.name, given.memory)
    if out is None:
        return CompiledMonitors(source, road=road)
    with hold_folder(Path(out)):
        for name, text in source.files.items():
            write_whole(Path(out) / name, text.encode())
    return CompiledMonitors(source, Path(out), road)


def _with_values(query: Query, home: Definitions, given: Compile, road: Road | None) -> Formula:
    if road is not None:
        return bind(query.formula, road, dict(given.lanes or {}), home.all_values())
    refuse_variables(query.formula)
    return with_values(query.formula, home.all_values())


def _label(number: int | None, query: Query, place: int) -> str:
    """The beginning of the names of functions: scenario_4, danger_SV_POV, or formula_1."""
    if number is not None:
        return name_of(number)
    if isinstance(query.formula, Application):
        return re.sub(r"\W+", "_", "_".join((query.formula.name, *query.formula.arguments)))
    return f"formula_{place}"


def _free(label: str, taken: Mapping[str, object]) -> str:
    """A label that no other has, in whatever letters."""
    known, number, made = {x.lower() for x in taken}, 1, label
    while made.lower() in known:
        number += 1
        made = f"{label}_{number}"
    return made

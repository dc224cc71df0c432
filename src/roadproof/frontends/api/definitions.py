"""The definitions, readings and parameter values that questions are about."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Mapping, Sequence
from dataclasses import field
from fractions import Fraction
from numbers import Integral
from pathlib import Path
from typing import TYPE_CHECKING, TypeAlias

from roadproof.errors import InputError, TextError, UsageError
from roadproof.library.bind import Number, exact, values_with
from roadproof.library.elaborate import read_claim
from roadproof.library.loading import bundled_library
from roadproof.library.roles import with_vehicles
from roadproof.library.scenario_references import read_numbers, read_query
from roadproof.library.scenarios import are_numbers
from roadproof.library.specification import Library, Query, Source, Specification, unknown_name
from roadproof.library.words import Words, words_of
from roadproof.runtime.records import dataclass

if TYPE_CHECKING:
    from roadproof.frontends.api.phrases import Phrase, Term
    from roadproof.library.diagnose import Diagnostic

# A scenario by number, a formula as text or built with operators, or one that was read before.
What: TypeAlias = "int | str | Phrase | Query"
Among: TypeAlias = int | str | Iterable[int] | None


@dataclass(frozen=True, repr=False)
class Definitions:
    """Spec sets under one choice of readings, and values of parameters; made by ``load``.

    ``specification`` is that of the first of ``sets``, in which names without @ are read; ``values`` has
    the parameters that were given another value than the declared one (SI units). A definition is an
    attribute: ``rp.load().danger(SV, POV)`` is a formula.
    """

    specification: Specification
    sets: tuple[str, ...]
    values: Mapping[str, Fraction] = field(default_factory=dict)

    @property
    def library(self) -> Library:
        return self.specification.library

    def __getattr__(self, name: str) -> Callable[..., Phrase]:
        if name.startswith("_") or name in Definitions.__dataclass_fields__:
            raise AttributeError(name)
        definitions, signals = self.specification.definitions, self.library.signals
        if name not in definitions and name not in signals:
            raise AttributeError(unknown_name("definition", name, (*definitions, *signals)))

        from roadproof.frontends.api.phrases import call

        def apply(*arguments: Term) -> Phrase:
            return call(name, *arguments)

        apply.__name__ = name
        known = definitions.get(name)
        apply.__doc__ = signals[name].doc if known is None else self.specification.describe(known)
        return apply

    def __repr__(self) -> str:
        declared = self.library.options
        readings = {k: v for k, v in self.specification.options.items() if v != declared[k].values[0]}
        chosen = [f"{name}={value}" for name, value in {**readings, **self.values}.items()]
        return f"<definitions {' '.join([', '.join(self.sets), *chosen])}>"

    def __dir__(self) -> list[str]:
        return [*super().__dir__(), *self.specification.definitions, *self.library.signals]

    @property
    def alone(self) -> Specification:
        """The one set that is named. Raises ``UsageError`` where there are several."""
        if len(self.sets) > 1:
            raise UsageError(f"{', '.join(self.sets)}: this question takes one spec set; name one")
        return self.specification

    def words(self, number: int) -> Words:
        """A scenario in words. Raises ``InputError`` where there is none of that number."""
        [known] = read_numbers(self.specification, str(number))
        return words_of(self.specification, known)

    def all_values(self) -> dict[str, Fraction]:
        """The value of every parameter, in SI units."""
        return values_with(self.library, self.values)

    def read(self, what: What) -> Query:
        """A formula as a value that can be asked about. Raises ``TextError`` with line, column and caret."""
        return self.numbered(what)[1]

    def numbered(self, what: What, vehicles: Collection[str] = ()) -> tuple[int | None, Query]:
        """Read a formula; return it with the scenario's number where it is given by number.

        ``vehicles`` need not be declared.
        """
        try:
            return self._numbered(what)
        except TextError:
            declared = with_vehicles(str(what), vehicles)
            if declared == str(what):
                raise
            return self._numbered(declared)

    def _numbered(self, what: What) -> tuple[int | None, Query]:
        match what:
            case Query():
                return None, what
            case _ if isinstance(what, Integral | str) and not isinstance(what, bool):  # open: a user's value
                return read_query(self.specification, str(what))
            case _:  # open: a user's value
                from roadproof.frontends.api.phrases import Phrase  # here: most are numbers and texts

                if isinstance(what, Phrase):
                    return None, read_claim(self.specification, str(what))
                raise UsageError(
                    f"{what!r} is not a formula: give a number, a text, or a formula built with operators"
                )

    def each(self, what: Iterable[What]) -> list[What]:
        """Scenarios and formulas one by one, where a text may be a list of numbers such as ``"1,3-8"``."""
        items: list[What] = []
        for x in what:
            is_list = isinstance(x, str) and are_numbers(x) and bool({",", "-"} & {*x})
            items += read_numbers(self.specification, str(x)) if is_list else [x]
        return items

    def among(self, numbers: Among) -> tuple[int, ...] | None:
        """Scenarios by number: ``"1-8,12"``, 4, or a sequence; None for all. Raises ``InputError``."""
        if numbers is None:
            return None
        if isinstance(numbers, str | int | Integral):
            return read_numbers(self.specification, str(numbers))
        return read_numbers(self.specification, ",".join(map(str, numbers)))


def definitions_of(using: Definitions | None) -> Definitions:
    """Return the definitions of a question, base for None. Raises ``UsageError`` for anything else."""
    if using is None:
        return load()
    if not isinstance(using, Definitions):
        raise UsageError(f"using={using!r}: write what rp.load returns, such as using=rp.load('ext')")
    return using


def load(
    *sets: str,
    options: Mapping[str, str] | None = None,
    params: Mapping[str, Number] | None = None,
    specs: Iterable[str | Path] = (),
) -> Definitions:
    """The definitions of spec sets (base where none is named), as ``--set``, ``--option``, ``--param``,
    ``--spec`` choose them.

    ``params``: numbers in the unit of the declaration, or texts with a unit such as ``"600 ms"``.
    ``specs``: specifications of yours on top of the library, each a path or, where it has several lines
    or a ``:=``, the text itself. Raises ``InputError``, ``UsageError``.

    >>> load("ext", params={"rho": 0.3}).values["rho"]
    Fraction(3, 10)
    """
    chosen = sets or ("base",)
    if isinstance(specs, str):
        raise UsageError(f"specs={specs!r}: write a list, such as specs=[{specs!r}]")
    if len(set(chosen)) < len(chosen):
        raise UsageError(f"load({', '.join(map(repr, chosen))}): name different spec sets")
    library = library_with([_source(k, spec) for k, spec in enumerate(specs, 1)])
    return chosen_in(library, chosen, options, params)


def library_with(files: Sequence[Path | Source]) -> Library:
    """Return the bundled library with the texts of a user on top, after a check of all their definitions.

    Raises ``TextError``, ``TextErrors`` for several mistakes, ``InputError``.
    """
    if not files:
        return bundled_library()
    from roadproof.library.diagnose import checked_library  # here: most questions need no text of a user

    return checked_library(files)


def chosen_in(
    library: Library,
    sets: tuple[str, ...],
    readings: Mapping[str, str] | None,
    params: Mapping[str, Number] | None,
    before: str = "",
) -> Definitions:
    """Spec sets of a library. ``before`` as for ``values_of``. Raises ``InputError``."""
    first, *_ = (library.select(name, readings) for name in sets)
    return Definitions(first, sets, values_of(library, params or {}, before))


def _source(number: int, spec: str | Path) -> Path | Source:
    if isinstance(spec, str) and ("\n" in spec or ":=" in spec):
        return Source(f"mine-{number}.spec", spec)
    return Path(spec)


def values_of(library: Library, params: Mapping[str, Number], before: str = "") -> dict[str, Fraction]:
    """Values of parameters in SI units; one without unit is in the unit of the declaration.

    ``before`` stands before the name in a complaint. Raises ``InputError`` for unknown names, values that are
    no rational, units of another dimension, and values out of the declared bound.
    """
    values: dict[str, Fraction] = {}
    for name, value in params.items():
        if name not in library.parameters:
            raise InputError(f"{before}{name}={value}: {unknown_name('parameter', name, library.parameters)}")
        values[name] = exact(f"{before}{name}", value, library.parameters[name].unit)
    try:
        values_with(library, values)
    except InputError as error:
        raise InputError(f"{before}{error}") from None
    return values


def diagnose(text: str, using: Definitions | None = None, formula: bool = False) -> tuple[Diagnostic, ...]:
    """All that is wrong with a specification text on top of definitions, or with a ``formula`` in them.

    Each remark has line, column and end (from 1, the end not included), message, hint and severity ("error",
    or "info" where a definition replaces another). Nothing is raised for what is in the text. Whoever asks on
    each key holds a ``Proofreader(using.library)``, and asks ``read(text)``.

    >>> [(x.line, x.column, x.message) for x in diagnose("v_lon(SV) > 3", formula=True)]
    [(1, 1, 'm/s and no unit cannot be compared')]
    """
    from roadproof.library import diagnose as texts

    home = definitions_of(using)
    if formula:
        return texts.diagnose_claim(text, home.specification)
    return texts.diagnose(text, home.library).diagnostics

"""Questions about what begins with a manoeuvre whose collision a driver prevents, or cannot prevent.

What that is, ``prevention.spec`` says. Which driver, which side and what begins so are its options, and
options are told with every answer: so evidence is about the question that was asked, and ``check`` reads it.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Literal, TypeAlias, get_args

from roadproof.errors import InputError, UsageError
from roadproof.extensions.drivers import models
from roadproof.extensions.drivers.restriction_file import check_restriction_file
from roadproof.library.elaborate import elaborate
from roadproof.library.loading import bundled_library
from roadproof.library.scenarios import initial_condition_name
from roadproof.library.specification import (
    Library,
    Query,
    Source,
    Specification,
    on_request,
    read_specification,
)
from roadproof.logic import formula as f
from roadproof.logic.formula import Formula, subformulas
from roadproof.logic.parse import parse_library
from roadproof.logic.restore import as_syntax
from roadproof.logic.rewrite import without_names
from roadproof.logic.syntax import Claim, Definition
from roadproof.runtime.records import dataclass

if TYPE_CHECKING:
    from roadproof.engines.search.question import FoundDrive, SearchProblem
    from roadproof.engines.setting import Search

Side: TypeAlias = Literal["preventable", "unpreventable"]
About: TypeAlias = Literal["scenarios", "drives"]


@dataclass(frozen=True)
class Restriction:
    """``side`` of the driver ``model``; ``about``: what begins so, scenarios of a course or every drive."""

    side: Side
    model: str
    about: About = "scenarios"

    @property
    def options(self) -> dict[str, str]:
        """The values of the options of ``prevention.spec``."""
        return {models.PREVENTION: self.side, models.DRIVEN_BY: self.model, models.BEGINS: self.about}

    @property
    def scenarios(self) -> tuple[int, ...]:
        """The scenarios that begin so; all others are as they are."""
        return models.courses_of(self.model) if self.about == "scenarios" else ()

    @property
    def word(self) -> str:
        """The name of the driver model."""
        return self.model

    @property
    def relies_on(self) -> tuple[str, ...]:
        """The entry of the driver model."""
        return (models.entry_of(self.model),)

    def with_opaque_driver(self, home: Specification) -> Specification:
        """Return the same definitions, but what a driver prevents is left open.

        What is proved of the scenarios alone is proved of these, too, and what is not is quickly refuted,
        where the formulas of a driver, cubic in the state, would keep a prover busy to no end.
        """
        opaque = {x.name: x for x in parse_library(_OPEN, models.PREVENTION) if isinstance(x, Definition)}
        return Specification(home.library, home.set_name, home.options, {**home.definitions, **opaque})

    def check_drives(self) -> None:
        """Raises ``UsageError`` where scenarios begin so: most drives are in none of them."""
        if self.about == "scenarios":
            raise UsageError(
                f"{models.BEGINS}=scenarios: drives that do not begin so would all be gaps; ask with "
                f"{models.BEGINS}=drives"
            )

    def objector(self, search: "Search", problem: "SearchProblem") -> "Callable[[FoundDrive], str] | None":
        """Return who puts the model into drives of scenarios that begin so, if any do."""
        if not self.scenarios:
            return None
        from roadproof.extensions.drivers.objection import Driven  # loads what drives are replayed with

        return Driven(search, problem, self).objection

    def as_data(self, schema: str) -> dict[str, object]:
        """Return what an answer of this schema says of it, as plain data."""
        by = "formula" if self.about == "drives" or schema in _BY_FORMULA else "model"
        fields = {"side": self.side, "driver": self.model, "of": self.about}
        return {"prevention": {**fields, "scenarios": list(self.scenarios), "drives_by": by}}

    def __str__(self) -> str:
        title = models.MODELS[self.model].title
        if self.about == "scenarios":
            numbers = ", ".join(map(str, self.scenarios))
            return f"{self.side} ({title}): scenarios {numbers} begin so, others are as they are"
        kinds = " or ".join(x for x in models.MODELS[self.model].manoeuvres if x != "cut-out")
        drives = f"drives between two vehicles begin so, with a {kinds}"
        return f"{self.side} ({title}; by the formula of a state): {drives}"


EVERY = tuple(
    Restriction(side, model.name, about)
    for side in get_args(Side)
    for model in models.MODELS.values()
    for about in get_args(About)
)


def restriction_of(options: Mapping[str, str]) -> Restriction | None:
    """The restriction that options say; None where ``prevention.spec`` is not read."""
    return next((x for x in EVERY if x.options.items() <= options.items()), None)


_BY_FORMULA = ("roadproof/explore/2", "roadproof/coverage/2")
"""Answers whose drives are restricted by the formula of a state alone."""


# Of signals that no scenario speaks of: any drive may begin so, or not.
_OPEN = """
def begins_cutIn(a, b: vehicle) "left open" := a_lat(a) > a_lat(b)
def begins_cutOut(a, b, c: vehicle) "left open" := a_lat(a) > a_lat(b)
def begins_deceleration(a, b: vehicle) "left open" := j_lon(a) > j_lon(b)
def begins_between(a, b: vehicle) "left open" := a_lat(a) > a_lat(b)
"""


def unrestricted(specification: Specification) -> Specification:
    """Return the definitions with scenarios that begin as the library says."""
    options = specification.options
    if restriction_of(options) is None:
        return specification
    return specification.library.select(specification.set_name, {**options, models.BEGINS: "drives"})


def restated_in(query: Query, home: Specification, there: Specification) -> Query:
    """``query``, read in ``home``, so that its text says the same in ``there``.

    Definitions that say something else there are written out. Raises ``InputError`` where that cannot be.
    """
    mine, others = home.definitions, there.definitions
    changed = {name for name in mine if others.get(name) != mine[name]}
    called = {
        (x.name, x.arguments)
        for x in subformulas(query.formula)
        if isinstance(x, f.Application)
        and any(isinstance(y, f.Application) and y.name.partition("@")[0] in changed for y in subformulas(x))
    }
    if not called:
        return query

    def written_out(part: Formula) -> Formula:
        return (
            part.body if isinstance(part, f.Application) and (part.name, part.arguments) in called else part
        )

    formula = f.transform(query.formula, written_out)
    again = elaborate(there, Claim(query.claim.given, as_syntax(formula)))
    if _bare(again.formula) != _bare(query.formula):
        raise InputError(
            f"{query.text[:60]}: a driver model changes what its names mean, and it cannot be written out "
            "without them; write the formula without names of scenarios"
        )
    return replace(again, vehicles=query.vehicles, lanes=query.lanes)


def _bare(formula: Formula) -> Formula:
    """Return a formula without names and without parts that are always true, as a parsed text has none."""

    def change(part: Formula) -> Formula:
        match part:
            case f.And(parts):
                return f.conjunction(*parts)
            case f.Or(parts):
                return f.disjunction(*parts)
            case f.Truth() | f.Compare() | f.Occupies() | f.Some() | f.Every() | f.Not() | f.Application():
                return part
            case f.Until() | f.Since() | f.Eventually() | f.Always():
                return part

    return f.transform(without_names(formula), change)


def files_for(given: Sequence[Source], model: str) -> list[Path | Source]:
    """The specification files that a restriction by a model needs, with those that are given on top.

    Raises ``InputError`` where the file of a package is not the one that ``restriction_file`` writes.
    """
    names = models.restriction_specifications(model)
    needed = [read_specification(on_request()[name]) for name in names]
    check_restriction_file(models.MODELS[model], needed[-1])
    texts = {x.text for x in needed}
    return [*needed, *(x for x in given if x.text not in texts)]


def names_for(given: Sequence[Path], model: str) -> list[Path]:
    """Return the names of these files, as ``--spec`` takes them."""
    needed = [*map(Path, models.restriction_specifications(model))]
    return [*needed, *(x for x in given if x not in needed)]


def check_library(library: Library) -> None:
    """Raises ``InputError`` where a user's file says how a scenario begins, which would be lost."""
    for number in models.SCENARIOS.values():
        name = initial_condition_name(number)
        blocks = [block.definitions for block in library.sets.values()]
        blocks += [x for (option, _), x in library.variants.items() if option != models.BEGINS]
        changed = library.definitions[name] != bundled_library().definitions[name]
        if changed or any(name == x.name for block in blocks for x in block):
            raise InputError(
                f"{name}: your specification file and {models.PREVENTION}.spec both define it; "
                "rename your definition, or use a formula with the conditions of driver.spec"
            )

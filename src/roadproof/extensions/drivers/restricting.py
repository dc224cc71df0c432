"""Questions about scenarios, asked only of what a driver prevents, or cannot prevent."""

from collections.abc import Iterator, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, get_args

from roadproof.errors import UsageError
from roadproof.extensions.drivers.models import check_courses, check_restricts
from roadproof.extensions.drivers.restriction import About, Restriction, Side, check_library, files_for
from roadproof.frontends.api.definitions import Among, Definitions, What
from roadproof.library.diagnose import checked_library
from roadproof.library.scenarios import number_in, numbers_of
from roadproof.library.specification import Query
from roadproof.logic import formula as f
from roadproof.logic.formula import subformulas

if TYPE_CHECKING:
    from roadproof.extensions.drivers.options import Prevention


def restricted(
    home: Definitions,
    given: "Prevention",
    among: Among = None,
    what: Sequence[What] | None = None,
    about: About = "scenarios",
) -> Definitions:
    """Return the definitions under ``prevention.spec``, unchanged where no driver model is named.

    ``among`` or ``what``: what is asked for, among which there has to be a scenario of which the model says
    something; nothing of that where it is ``about`` drives. Raises ``InputError``, ``UsageError``.
    """
    models = {side: getattr(given, side) for side in get_args(Side)}
    named = [Restriction(side, model, about) for side, model in models.items() if model is not None]
    if not named:
        return home
    if len(named) > 1:
        named_sides = ", ".join(f"{side}={model}" for side, model in models.items())
        raise UsageError(f"{named_sides}: no drive satisfies both; omit one")
    [restriction] = named
    requested = f"{restriction.side}={restriction.model}"
    check_restricts(restriction.model, requested)
    files = files_for(home.library.files, restriction.model)
    library = home.library if len(files) == len(home.library.files) else checked_library(files)
    check_library(library)
    options = {**home.specification.options, **restriction.options}
    result = replace(home, specification=library.select(home.sets[0], options))
    if about == "scenarios":
        check_courses(restriction.model, [*dict.fromkeys(_requested(result, among, what))], requested)
    return result


def _requested(home: Definitions, among: Among, what: Sequence[What] | None) -> Iterator[int]:
    """Yield the numbers of the requested scenarios, with those that occur in formulas."""
    if not what:
        yield from home.among(among) or numbers_of(home.specification)
    for one in what or ():
        if isinstance(one, Query):
            raise UsageError(
                f"{one.text[:60]}: it was read without a driver model; give the formula as text, or read it "
                "from definitions that have one"
            )
        for part in subformulas(home.read(one).formula):
            number = number_in(part.name.partition("@")[0]) if isinstance(part, f.Application) else None
            if number is not None:
                yield number

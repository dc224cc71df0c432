"""Options and parameters of driver models that differ from the declared ones, and those without effect."""

from collections.abc import Mapping, Sequence
from fractions import Fraction

from roadproof.extensions.drivers.driver_model import DriverModel
from roadproof.extensions.drivers.manoeuvres import Manoeuvre
from roadproof.extensions.drivers.models import boundary_name
from roadproof.library.bind import default_values
from roadproof.library.elaborate import apply_definition
from roadproof.library.specification import Specification
from roadproof.logic.formula import Formula
from roadproof.logic.rewrite import parameters_of


def chosen(specification: Specification, values: Mapping[str, Fraction]) -> dict[str, str]:
    """Return options, then parameters (SI), whose values are not the declared ones."""
    library = specification.library
    declared, known = library.options, default_values(library)
    options = {x: value for x, value in specification.options.items() if value != declared[x].values[0]}
    return options | {x: str(values[x]) for x in sorted(values) if values[x] != known[x]}


def idle(
    specification: Specification,
    values: Mapping[str, Fraction],
    manoeuvre: Manoeuvre,
    models: Sequence[DriverModel],
) -> tuple[str, ...]:
    """Return the entries of ``chosen`` without effect, written as ``cc_aeb=max``.

    A controller that is stepped depends on none of them.
    """
    names = [x.name for x in models if not x.is_stepped]

    def boundaries(home: Specification) -> list[Formula]:
        called = (boundary_name(manoeuvre.name, name) for name in names)
        return [apply_definition(home, x, manoeuvre.vehicles).formula for x in called]

    declared_boundaries = boundaries(specification)
    spoken = {name for formula in declared_boundaries for name in parameters_of(formula)}

    def has_a_say(name: str) -> bool:
        if name not in specification.options:
            return name in spoken
        declared = specification.library.options[name].values[0]
        options = {**specification.options, name: declared}
        other = specification.library.select(specification.set_name, options)
        return boundaries(other) != declared_boundaries

    made = chosen(specification, values)
    return tuple(f"{name}={value}" for name, value in made.items() if not has_a_say(name))

"""What was chosen, and what of that has no say: no boundary of a manoeuvre depends on it."""

from collections.abc import Mapping, Sequence
from fractions import Fraction

from roadproof.drivers.manoeuvres import Manoeuvre
from roadproof.drivers.models import Model, unpreventable
from roadproof.library.bind import default_values
from roadproof.library.elaborate import read_claim
from roadproof.library.specification import Specification
from roadproof.logic.rewrite import parameters_of


def chosen(specification: Specification, values: Mapping[str, Fraction]) -> dict[str, str]:
    """Options, and then parameters, that are not as declared, with their values; ``values`` in SI units."""
    library = specification.library
    declared, known = library.options, default_values(library)
    options = {x: said for x, said in specification.options.items() if said != declared[x].values[0]}
    return options | {x: str(values[x]) for x in sorted(values) if values[x] != known[x]}


def idle(
    specification: Specification,
    values: Mapping[str, Fraction],
    manoeuvre: Manoeuvre,
    models: Sequence[Model],
) -> tuple[str, ...]:
    """Those of ``chosen`` with which nothing is different, as ``cc_aeb=max``.

    A controller that is stepped depends on none of them.
    """
    names = [x.name for x in models if not x.is_stepped]
    claims = [unpreventable(manoeuvre.name, name, manoeuvre.vehicles) for name in names]
    said = [read_claim(specification, claim).formula for claim in claims]
    spoken = {name for formula in said for name in parameters_of(formula)}

    def has_a_say(name: str) -> bool:
        if name not in specification.options:
            return name in spoken
        declared = specification.library.options[name].values[0]
        options = {**specification.options, name: declared}
        other = specification.library.select(specification.set_name, options)
        return [read_claim(other, claim).formula for claim in claims] != said

    made = chosen(specification, values)
    return tuple(f"{name}={value}" for name, value in made.items() if not has_a_say(name))

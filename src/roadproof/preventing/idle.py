"""What was chosen and has no say: options and parameters on which no boundary of a manoeuvre depends."""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from fractions import Fraction

from roadproof.logic import terms as t
from roadproof.logic.formula import Formula
from roadproof.logic.rewrite import terms_of
from roadproof.preventing.manoeuvres import Manoeuvre
from roadproof.preventing.models import Model, unpreventable
from roadproof.spec.bind import default_values
from roadproof.spec.elaborate import read_claim
from roadproof.spec.library import Specification


def idle(
    specification: Specification,
    values: Mapping[str, Fraction],
    manoeuvre: Manoeuvre,
    models: Sequence[Model],
) -> tuple[str, ...]:
    """Those that are not as declared, as ``cc_aeb=max``, though with the declared value nothing is different.

    ``values``: of parameters (SI). A controller that is stepped depends on none of them.
    """
    library = specification.library
    names = [x.name for x in models if not x.is_stepped]
    claims = [unpreventable(manoeuvre.name, name, manoeuvre.vehicles) for name in names]
    said = [read_claim(specification, claim).formula for claim in claims]
    found: list[str] = []
    for option, chosen in specification.options.items():
        declared = library.options[option].values[0]
        if chosen != declared:
            other = library.select(specification.set_name, {**specification.options, option: declared})
            if [read_claim(other, claim).formula for claim in claims] == said:
                found.append(f"{option}={chosen}")
    spoken = set(_parameters(said))
    known = default_values(library)
    others = (name for name in sorted(values) if values[name] != known[name] and name not in spoken)
    return (*found, *(f"{name}={values[name]}" for name in others))


def _parameters(formulas: Iterable[Formula]) -> Iterator[str]:
    for formula in formulas:
        for term in terms_of(formula):
            yield from (x.name for x in t.leaves(term) if isinstance(x, t.Parameter))

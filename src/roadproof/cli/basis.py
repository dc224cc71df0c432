"""What analyses rest on, from the options that they share."""

import argparse
from collections.abc import Sequence
from typing import TYPE_CHECKING

from roadproof.cli.numbers import read_effort
from roadproof.cli.options import chosen_options, load_library_of, parameter_values

if TYPE_CHECKING:
    from roadproof.analysis.basis import Basis
    from roadproof.spec.library import Specification


def read_basis(args: argparse.Namespace, sets: Sequence[str]) -> "Basis":
    """The definitions of ``sets``, values and work. Raises ``InputError``, ``UsageError``."""
    from roadproof.analysis.basis import Basis

    library, options = load_library_of(args), chosen_options(args)
    for name in sets:
        library.select(name, options)
    specification = library.select(sets[0], options)
    values = parameter_values(args, library)
    return Basis(specification, tuple(sets), values, effort=read_effort(args))


def among(args: argparse.Namespace, specification: "Specification") -> tuple[int, ...] | None:
    """The scenarios of ``--among``, None where all are meant. Raises ``UsageError``, ``InputError``."""
    from roadproof.spec.scenarios import read_numbers

    return read_numbers(specification, args.among) if args.among else None

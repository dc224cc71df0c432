"""What is asked of a catalogue: which tests, and what of them is looked at."""

import shlex
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction

from roadproof.analysis.catalogue.showing import Freedom
from roadproof.drivers.models import MODELS
from roadproof.drivers.restriction import restriction_of
from roadproof.errors import InputError, UsageError
from roadproof.evidence.answers.catalogue_index import KeptRequest, Look
from roadproof.evidence.codec import read
from roadproof.library.bind import values_with
from roadproof.library.scenarios import numbers_of
from roadproof.library.specification import Specification, on_request, unknown
from roadproof.world.units import UNITS

NEAR = 0.5
_CHOICES = ("roles", "lanes", "start")


@dataclass(frozen=True)
class Request:
    """``paths``: folders of tests, and tests. ``sets``: spec sets, of which the first is asked about.

    ``classes``, ``gaps``, ``explore``: whether classes of scenarios, classes of gaps and ranges are asked
    about too. ``roles``, ``lanes``, ``start``: whether those are looked at that a test fixes, or "any".
    ``near``: how far apart tests that say the same may begin, in m and m/s. ``drivers``: the models that are
    asked what becomes of tests. Raises ``UsageError``.
    """

    paths: tuple[str, ...]
    sets: tuple[str, ...] = ("base",)
    classes: bool = True
    gaps: bool = False
    explore: bool = False
    roles: Look = "fixed"
    lanes: Look = "fixed"
    start: Look = "fixed"
    near: float = NEAR
    drivers: tuple[str, ...] = tuple(MODELS)

    def __post_init__(self) -> None:
        for name in _CHOICES:
            if getattr(self, name) not in ("fixed", "any"):
                raise UsageError(f"{name}={getattr(self, name)!r}: write 'fixed' or 'any'")
        for name in self.drivers:
            if name not in MODELS:
                raise UsageError(f"drivers={','.join(self.drivers)}: {unknown('driver model', name, MODELS)}")
        if not self.near >= 0:
            raise UsageError(f"near={self.near}: write a number, 0 or more")

    @property
    def freedom(self) -> Freedom:
        """What is looked at beside what a test fixes."""
        return Freedom(self.roles == "any", self.lanes == "any", self.start == "any")

    @property
    def kept(self) -> KeptRequest:
        """As an index has it."""
        return KeptRequest(**vars(self))

    def command(self, more: tuple[str, ...] = ()) -> str:
        """The command that asks the same; ``more``: further options of it."""
        said = [*self.paths]
        said += ["--set", ",".join(self.sets)] if self.sets != ("base",) else []
        said += ["--no-classes"] * (not self.classes)
        said += ["--gaps"] * self.gaps + ["--explore"] * self.explore
        for name in _CHOICES:
            said += [f"--{name}", "any"] if getattr(self, name) == "any" else []
        said += ["--near", f"{self.near:g}"] if self.near != NEAR else []
        said += [] if self.drivers == (*MODELS,) else ["--drivers", ",".join(self.drivers) or "none"]
        return shlex.join(["roadproof", "catalogue", *said, *more])


def further_options(
    specification: Specification, values: Mapping[str, Fraction], numbers: Sequence[int]
) -> tuple[str, ...]:
    """The options of the command that say what was asked otherwise than by default.

    ``values``: parameters (SI); ``numbers``: the scenarios that were asked about.
    """
    library, restriction = specification.library, restriction_of(specification.options)
    said: list[str] = []
    if tuple(numbers) != numbers_of(specification):
        said += ["--among", ",".join(map(str, numbers))]
    known = {} if restriction is None else restriction.options
    if restriction is not None:
        said += [f"--{restriction.side}", restriction.model]
    shipped = [*map(str, on_request().values())] if restriction is not None else []
    for source in library.files:
        said += ["--spec", source.name] if source.name not in shipped else []
    for name, value in specification.options.items():
        if name not in known and value != library.options[name].values[0]:
            said += ["--option", f"{name}={value}"]
    declared = values_with(library, {})
    for name, number in values.items():
        if number != declared[name]:
            said += ["--param", f"{name}={number / UNITS[library.parameters[name].unit][0]}"]
    return tuple(said)


def read_request(content: object, where: str) -> Request:
    """A request as an index has it. Raises ``InputError``."""
    try:
        return Request(**vars(read(KeptRequest, content, where)))
    except UsageError as error:
        raise InputError(f"{where}: {error}") from None

"""The tests of a catalogue, concrete and abstract ones, and what is asked of them."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import TypeAlias

from roadproof.errors import InputError, UsageError
from roadproof.evidence.codec import read
from roadproof.extensions.catalogue.kept import KeptRequest, Look
from roadproof.extensions.drivers.models import MODELS
from roadproof.library.specification import Query, unknown
from roadproof.world.road import Road
from roadproof.world.vehicle import Vehicle


@dataclass(frozen=True)
class Concrete:
    """A test whose vehicles move as it says.

    ``place``: a drive file, samples, a scenario of CommonRoad, or vehicles of a recording such as
    ``01_tracks.csv:12,15``. ``claims``: the scenarios and classes that it is meant to show, by definition.
    ``copy_of``: the id of the test of which it is the same in another format, if any. ``roles``: the name of
    the vehicle of each role that it names. ``fault``: why the test cannot be read, concrete or not; its place
    is then the file that names it where no other is known. ``strict``: nothing of its files may be left out.
    """

    id: str
    place: str
    title: str = ""
    claims: tuple[str, ...] = ()
    copy_of: str = ""
    roles: Mapping[str, str] = field(default_factory=dict)
    fault: str = ""
    strict: bool = False


@dataclass(frozen=True)
class Abstract:
    """A test that is a formula, ranges of values included, on a road; every drive of it is one way to run it.

    ``road`` None is the usual road of what is looked for; ``vehicles``: models by name.
    """

    id: str
    query: Query
    title: str = ""
    claims: tuple[str, ...] = ()
    road: Road | None = None
    vehicles: Mapping[str, Vehicle] = field(default_factory=dict)


Entry: TypeAlias = Concrete | Abstract


@dataclass(frozen=True)
class Catalogue:
    """The tests, in order, and ``notes`` on files that are none; ``sources``: the file that names each."""

    entries: tuple[Entry, ...]
    notes: tuple[str, ...] = ()
    sources: Mapping[str, str] = field(default_factory=dict)


# --- what is asked of them ------------------------------------------------------------------------


@dataclass(frozen=True)
class Freedom:
    """What is looked at beside what a test fixes: all roles, all lanes, all instants."""

    roles: bool = False
    lanes: bool = False
    start: bool = False


_CHOICES = ("roles", "lanes", "start")


@dataclass(frozen=True)
class Request:
    """``paths``: folders of tests, and tests. ``sets``: spec sets, of which the first is asked about.

    ``classes``, ``gaps``, ``explore``: whether classes of scenarios, classes of gaps and ranges are asked
    about too. ``roles``, ``lanes``, ``start``: whether those are looked at that a test fixes, or "any".
    ``near``: how far apart tests that say the same may begin, in m and m/s. ``drivers``: the models that are
    asked what becomes of tests. ``strict``: a test of whose files vehicles or parts would be left out has a
    fault. Raises ``UsageError``.
    """

    paths: tuple[str, ...]
    sets: tuple[str, ...] = ("base",)
    classes: bool = True
    gaps: bool = False
    explore: bool = False
    roles: Look = "fixed"
    lanes: Look = "fixed"
    start: Look = "fixed"
    near: float = 0.5
    drivers: tuple[str, ...] = tuple(MODELS)
    strict: bool = False

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


def read_request(content: object, where: str) -> Request:
    """A request as an index has it. Raises ``InputError``."""
    try:
        return Request(**vars(read(KeptRequest, content, where)))
    except UsageError as error:
        raise InputError(f"{where}: {error}") from None

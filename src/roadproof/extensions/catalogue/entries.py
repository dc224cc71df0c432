"""The tests of a catalogue, concrete and abstract ones, and the request about them."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import TypeAlias

from roadproof.errors import InputError, UsageError
from roadproof.evidence.codec import read
from roadproof.extensions.catalogue.catalogue_data import FixedOrAny, RequestData
from roadproof.extensions.drivers.models import MODELS
from roadproof.library.specification import Query, unknown_name
from roadproof.world.road import Road
from roadproof.world.vehicle import Vehicle


@dataclass(frozen=True)
class ConcreteTest:
    """A test with a motion of all vehicles: a drive or samples.

    ``place``: a drive file, samples, a scenario of CommonRoad, or vehicles of a recording such as
    ``01_tracks.csv:12,15``. ``claims``: the scenarios and classes that it is meant to show, by definition.
    ``copy_of``: the id of the test of which it is a copy in another format. ``roles``: the vehicle of each
    role that it names. ``fault``: why the test cannot be read, concrete or not; ``place`` is then the file
    that names the test, unless a file of its own is known. ``strict``: nothing of its files may be left out.
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
class AbstractTest:
    """A test that is a formula with its ranges of values; every drive of it is one way to run it.

    ``road`` None is the usual road of the claim; ``vehicles``: models by name.
    """

    id: str
    query: Query
    title: str = ""
    claims: tuple[str, ...] = ()
    road: Road | None = None
    vehicles: Mapping[str, Vehicle] = field(default_factory=dict)


Entry: TypeAlias = ConcreteTest | AbstractTest


@dataclass(frozen=True)
class CatalogueTests:
    """The tests in order, and ``notes`` on files that are no tests; ``sources``: the file that names each."""

    entries: tuple[Entry, ...]
    notes: tuple[str, ...] = ()
    sources: Mapping[str, str] = field(default_factory=dict)


# --- the request ----------------------------------------------------------------------------------


@dataclass(frozen=True)
class Freedom:
    """The choices that are free: all roles, all lanes, all instants, or those that a test fixes."""

    roles: bool = False
    lanes: bool = False
    start: bool = False


_CHOICES = ("roles", "lanes", "start")


@dataclass(frozen=True)
class Request:
    """A request about tests. Raises ``UsageError``.

    ``paths``: folders of tests, and tests. ``sets``: spec sets; figures alone for those after the first.
    ``classes``, ``gaps``, ``explore``: whether classes of scenarios, classes of gaps and ranges are targets
    too. ``roles``, ``lanes``, ``start``: "fixed" for those of the test, or "any". ``near``: the largest
    difference of the initial values of duplicates (m, m/s). ``drivers``: the driver models that are put into
    tests. ``strict``: a test has a fault where vehicles or parts of its files would be left out.
    """

    paths: tuple[str, ...]
    sets: tuple[str, ...] = ("base",)
    classes: bool = True
    gaps: bool = False
    explore: bool = False
    roles: FixedOrAny = "fixed"
    lanes: FixedOrAny = "fixed"
    start: FixedOrAny = "fixed"
    near: float = 0.5
    drivers: tuple[str, ...] = tuple(MODELS)
    strict: bool = False

    def __post_init__(self) -> None:
        for name in _CHOICES:
            if getattr(self, name) not in ("fixed", "any"):
                raise UsageError(f"{name}={getattr(self, name)!r}: write 'fixed' or 'any'")
        for name in self.drivers:
            if name not in MODELS:
                raise UsageError(
                    f"drivers={','.join(self.drivers)}: {unknown_name('driver model', name, MODELS)}"
                )
        if not self.near >= 0:
            raise UsageError(f"near={self.near}: write a number, 0 or more")

    @property
    def freedom(self) -> Freedom:
        """The free choices."""
        return Freedom(self.roles == "any", self.lanes == "any", self.start == "any")

    @property
    def data(self) -> RequestData:
        """The request as plain data."""
        return RequestData(**vars(self))


def read_request(content: object, where: str) -> Request:
    """Return the request of plain data. Raises ``InputError``."""
    try:
        return Request(**vars(read(RequestData, content, where)))
    except UsageError as error:
        raise InputError(f"{where}: {error}") from None

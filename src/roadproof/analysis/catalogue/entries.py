"""What the tests of a catalogue are: concrete ones, whose vehicles move as they say, and abstract ones."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import TypeAlias

from roadproof.library.specification import Query
from roadproof.world.road import Road
from roadproof.world.vehicle import Vehicle


@dataclass(frozen=True)
class Concrete:
    """A test whose vehicles move as it says.

    ``place``: a drive file, samples, a scenario of CommonRoad, or vehicles of a recording such as
    ``01_tracks.csv:12,15``. ``claims``: the scenarios and classes that it is meant to show, by definition.
    ``copy_of``: the id of the test of which it is the same in another format, if any. ``roles``: the name of
    the vehicle of each role that it names. ``fault``: why the test cannot be read, concrete or not; its place
    is then the file that names it where no other is known.
    """

    id: str
    place: str
    title: str = ""
    claims: tuple[str, ...] = ()
    copy_of: str = ""
    roles: Mapping[str, str] = field(default_factory=dict)
    fault: str = ""


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
    """The tests, in order, and ``notes`` on files that are none."""

    entries: tuple[Entry, ...]
    notes: tuple[str, ...] = ()

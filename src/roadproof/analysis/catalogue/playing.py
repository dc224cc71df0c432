"""Which vehicle of a test plays which role of scenarios, where vehicles have names of their own."""

from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from itertools import count, permutations, product

from roadproof.analysis.catalogue.entries import Concrete
from roadproof.errors import InputError
from roadproof.evidence.drive_file import DriveFile
from roadproof.library.scenarios import PAIR, SUBJECT
from roadproof.library.specification import unknown
from roadproof.recordings.evaluate.one_trace import OneTrace

UNDER_TEST = frozenset(
    {
        *("ego", "egovehicle", "egocar", "hero", "herovehicle", "host", "hostvehicle", "sv", "sut", "vut"),
        *("subject", "subjectvehicle", "subjectcar", "vehicleundertest", "systemundertest"),
    }
)
"""What other tools call the vehicle under test, in small letters, without signs between words."""
Choice = tuple[tuple[str, ...], tuple[str, ...]]
"""Roles of scenarios, and a vehicle for each."""


@dataclass(frozen=True)
class Roles:
    """The role of each vehicle that plays one, by the vehicle's name; ``taken``: those that no one named.

    All other vehicles keep their names, unless these are roles that others play.
    """

    by_name: Mapping[str, str] = field(default_factory=dict)
    taken: tuple[str, ...] = ()

    @property
    def note(self) -> str:
        """Which names were taken as which roles; empty where the test names them, or none was."""
        told = [f"{name} is taken as {self.by_name[name]}" for name in self.taken]
        return ", ".join(told)

    @property
    def own_names(self) -> dict[str, str]:
        """What the test calls each vehicle, by what it is called here."""
        return {role: name for name, role in self.by_name.items()}

    def played(self, known: Collection[str]) -> dict[str, str]:
        """What the test calls the vehicle of each of the roles ``known``, where that is not the role."""
        return {role: name for role, name in sorted(self.own_names.items()) if role in known}

    def own(self, vehicles: Iterable[str]) -> tuple[str, ...]:
        """Vehicles as the test calls them."""
        names = self.own_names
        return tuple(names.get(x, x) for x in vehicles)


def roles_of(entry: Concrete, vehicles: Sequence[str], known: Collection[str]) -> Roles:
    """The roles of the vehicles of a test: as it says, or by their names.

    A vehicle plays the role that it is called as, in any letters, and the only one with a usual name of the
    vehicle under test is SV; of two vehicles the other one is then POV. ``known``: the roles of scenarios.
    Raises ``InputError`` for unknown names and roles.
    """
    by_role = dict(checked(entry, vehicles, known))
    taken = []
    for role, name in _usual(vehicles, by_role, known):
        by_role[role] = name
        taken += [name] if name != role else []
    by_name = {name: role for role, name in by_role.items() if name != role}
    for name in vehicles:
        if name not in by_role.values() and name in by_role:
            by_name[name] = next(x for k in count(1) if (x := f"{name}_{k}") not in {*vehicles, *known})
    return Roles(by_name, tuple(taken))


def checked(entry: Concrete, vehicles: Sequence[str], known: Collection[str]) -> Iterator[tuple[str, str]]:
    """The roles that a test names, with their vehicles. Raises ``InputError`` for unknown ones."""
    for role, name in entry.roles.items():
        where = f"{entry.place}: roles = {{ {role} = '{name}' }}"
        if role not in known:
            raise InputError(f"{where}: {unknown('role', role, known)}")
        if name not in vehicles:
            raise InputError(f"{where}: {unknown('vehicle', name, vehicles)}")
        yield role, name


def _usual(
    vehicles: Sequence[str], given: Mapping[str, str], known: Collection[str]
) -> Iterator[tuple[str, str]]:
    """Further roles, with the vehicles that play them by their names, or as the other one of two."""
    left = [x for x in vehicles if x not in given.values()]
    found: dict[str, str] = dict(given)
    for role in (x for x in sorted(known) if x not in given):
        named = [x for x in left if x == role] or [x for x in left if x.casefold() == role.casefold()]
        if len(named) == 1:
            found[role] = named[0]
            yield role, named[0]
    left = [x for x in left if x not in found.values()]
    under_test = [x for x in left if _plain(x) in UNDER_TEST]
    if SUBJECT not in found and len(under_test) == 1:
        found[SUBJECT] = under_test[0]
        yield SUBJECT, under_test[0]
    others = [x for x in vehicles if x not in found.values()]
    missing = [x for x in PAIR if x not in found]
    if len(vehicles) == len(PAIR) and len(others) == len(missing) == 1:
        yield missing[0], others[0]


def _plain(name: str) -> str:
    return "".join(x for x in name.casefold() if x.isalnum())


def choices(
    roles: Sequence[tuple[str, ...]],
    all_roles: Sequence[tuple[str, ...]],
    names: Sequence[str],
    free: bool,
    any_way: bool = False,
) -> Iterator[Choice]:
    """Choices of ``roles`` with vehicles for them: those of the same names, or any where it is ``free``.

    ``all_roles``: those of scenarios that are not asked about too. Where no choice of them has a vehicle for
    each role, those that are called as a role play it alone, and the others may play any other; ``any_way``:
    also where no vehicle is called as a role.
    """
    known = {role for x in all_roles for role in x} & {*names}
    complete = any({*x} <= known for x in all_roles)
    for x in roles:
        if not free and complete:
            yield from [(x, x)] if {*x} <= known else []
        elif free or known or any_way:
            for chosen in permutations(names, len(x)):
                if free or all(a == b for a, b in zip(x, chosen, strict=True) if {a, b} & known):
                    yield x, chosen


def no_role(vehicles: Iterable[str]) -> str:
    """A note on a drive none of whose vehicles plays a role."""
    return (
        f"no vehicle is called as a role of a scenario (vehicles: {', '.join(vehicles)}); name them in a "
        'catalogue.toml, as roles = { SV = "…", POV = "…" }'
    )


def chosen_vehicles(
    ids: Sequence[str], given: Mapping[str, str], names: Sequence[str]
) -> Iterator[tuple[int, ...]]:
    """Places in ``ids`` for the roles ``names``, all different: those that are ``given``, or any others."""
    taken = {*given.values()}
    free = [k for k, name in enumerate(ids) if name not in taken]
    places = ([ids.index(given[role])] if role in given else free for role in names)
    return (chosen for chosen in product(*places) if len({*chosen}) == len(chosen))


def play_drive(file: DriveFile, roles: Roles) -> DriveFile:
    """The drive of a file with its vehicles called as their roles."""
    new = roles.by_name
    return replace(file, drive=file.drive.cast({new.get(name, name): name for name in file.drive.vehicles}))


def play_samples(trace: OneTrace, roles: Roles) -> OneTrace:
    """Samples with their vehicles called as their roles; nothing but signals is given of them."""
    new, batch = roles.by_name, trace.batch
    if not new:
        return trace
    signals = {(signal, new.get(name, name)): x for (signal, name), x in batch.signals.items()}
    sizes = {(size, new.get(name, name)): x for (size, name), x in batch.sizes.items()}
    lanes = {new.get(name, name): lane for name, lane in trace.lanes.items()}
    return replace(trace, batch=replace(batch, signals=signals, sizes=sizes, given={}), lanes=lanes)


def cast_samples(
    trace: OneTrace, roles: tuple[str, ...], vehicles: tuple[str, ...]
) -> tuple[OneTrace, tuple[str, ...]]:
    """Samples of ``vehicles`` alone, called as the ``roles`` that they play, and what they are called now.

    Samples of which lane predicates are given stay as they are, since these are said of names.
    """
    if trace.batch.given:
        return trace, vehicles
    alone = dict(zip(vehicles, roles, strict=True))
    batch = trace.batch
    signals = {
        (signal, alone.get(name, name)): x
        for (signal, name), x in batch.signals.items()
        if not name or name in alone
    }
    sizes = {(size, alone[name]): x for (size, name), x in batch.sizes.items() if name in alone}
    lanes = {role: trace.lanes[name] for name, role in alone.items()}
    return replace(trace, batch=replace(batch, signals=signals, sizes=sizes), lanes=lanes), roles

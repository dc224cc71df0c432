"""Which vehicle plays which role of scenarios, where vehicles have names of their own."""

import re
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import field, replace
from itertools import count

from roadproof.errors import InputError, TextError
from roadproof.library.scenarios import PAIR, SUBJECT, TRIPLE
from roadproof.library.specification import unknown
from roadproof.logic.parse import parse_claim
from roadproof.logic.show import text as printed
from roadproof.logic.syntax import Binding
from roadproof.runtime.records import dataclass

UNDER_TEST = frozenset(
    {
        *("ego", "egovehicle", "egocar", "hero", "herovehicle", "host", "hostvehicle", "sv", "sut", "vut"),
        *("subject", "subjectvehicle", "subjectcar", "vehicleundertest", "systemundertest"),
    }
)
"""What other tools call the vehicle under test, in small letters, without signs between words."""
_WORD, _ROLE = re.compile(r"[A-Za-z_]\w*"), re.compile(r"SV|POV[0-9]?|L[0-9]?")
"""Names in claims, and those that nothing declares."""


@dataclass(frozen=True)
class Roles:
    """The role of each vehicle that plays one, by the vehicle's name; ``taken``: those that no one named.

    All other vehicles keep their names, unless these are roles that others play.
    """

    by_name: Mapping[str, str] = field(default_factory=dict)
    taken: tuple[str, ...] = ()

    @property
    def note(self) -> str:
        """Which names were taken as which roles; empty where a user names them, or none was."""
        told = [f"{name} is taken as {self.by_name[name]}" for name in self.taken]
        return ", ".join(told)

    @property
    def own_names(self) -> dict[str, str]:
        """The name in the file of each vehicle, by what it is called here."""
        return {role: name for name, role in self.by_name.items()}

    def played(self, known: Collection[str]) -> dict[str, str]:
        """The name in the file of the vehicle of each of the roles ``known``, where that is not the role."""
        return {role: name for role, name in sorted(self.own_names.items()) if role in known}

    def own(self, vehicles: Iterable[str]) -> tuple[str, ...]:
        """Vehicles as the file calls them."""
        names = self.own_names
        return tuple(names.get(x, x) for x in vehicles)

    def called(self, vehicle: str) -> str:
        """What the vehicle of this name in the file is called here."""
        return self.by_name.get(vehicle, vehicle)


def roles_of(
    vehicles: Sequence[str], known: Collection[str], given: Mapping[str, str], where: str = "roles"
) -> Roles:
    """The roles of ``vehicles``: as ``given`` (a vehicle by role), or by their names.

    A vehicle plays the role that it is called as, in any letters, and the only one with a usual name of the
    vehicle under test is SV; of two vehicles the other one is then POV. ``known``: the roles of scenarios.
    Raises ``InputError``, which begins with ``where``, for unknown names and roles.
    """
    check_roles(vehicles, known, given, where)
    by_role = dict(given)
    taken = []
    for role, name in _usual(vehicles, by_role, known):
        by_role[role] = name
        taken += [name] if name != role else []
    return _named(vehicles, known, by_role, taken)


def cast_of(vehicles: Sequence[str], wanted: Sequence[str], given: Mapping[str, str], where: str) -> Roles:
    """The roles of ``vehicles`` in one formula that speaks of ``wanted``, as ``roles_of``.

    Where as many others as roles are left, they play these in the order of the file. Of fewer vehicles than
    roles some roles stay open. Raises ``InputError`` where it is not clear who plays a role.
    """
    if not given and {*wanted} <= {*vehicles}:
        return Roles()
    found = roles_of(vehicles, wanted, given, where)
    by_role = {found.called(name): name for name in vehicles}
    missing = [role for role in wanted if role not in by_role]
    others = [name for name in vehicles if found.called(name) not in wanted]
    if not missing or len(vehicles) < len(wanted):
        return found
    if len(missing) == len(wanted) or len(others) != len(missing):
        pairs = zip(vehicle_order(wanted), (*vehicle_order(vehicles), *"?" * len(wanted)), strict=False)
        told = ",".join(f"{role}={name}" for role, name in pairs)
        raise InputError(
            f"{where}: no vehicle is called as {', '.join(missing)}; vehicles are {', '.join(vehicles[:12])}"
            f"{', …' if len(vehicles) > 12 else ''}; assign the roles, such as {told}"
        )
    complete = {role: name for role, name in by_role.items() if role in wanted}
    complete |= dict(zip(missing, others, strict=True))
    return _named(vehicles, wanted, complete, [*found.taken, *others])


def _goes_with(role: str, known: Collection[str]) -> bool:
    """Return whether a role that a question lacks is of the same cast: SV and POV, or SV, POV1 and POV2."""
    return any({role, *known} <= {*cast} for cast in (PAIR, TRIPLE) if not {*cast} <= {*known})


def check_roles(
    vehicles: Collection[str], known: Collection[str], given: Mapping[str, str], where: str
) -> None:
    """Raise ``InputError``, which begins with ``where``, for roles and vehicles that there are not."""
    for role, name in given.items():
        told = f"{where} = {{ {role} = '{name}' }}"
        if role not in known and not _goes_with(role, known):
            raise InputError(f"{told}: {unknown('role', role, known)}")
        if name not in vehicles:
            raise InputError(f"{told}: {unknown('vehicle', name, vehicles)}")
        those = [x for x, other in given.items() if other == name]
        if len(those) > 1:
            raise InputError(f"{where}: {name} is {' and '.join(those)}; it can play one role")


def with_vehicles(text: str, vehicles: Collection[str]) -> str:
    """The text of a claim, which then declares those of ``vehicles`` that it names and does not declare.

    A text that is no claim stays as it is.

    >>> with_vehicles("danger(Ego, POV)", ["Ego", "POV", "bus"])
    'given Ego: vehicle: danger(Ego, POV)'
    """
    words = dict.fromkeys(_WORD.findall(text))
    named = [x for x in words if x in vehicles and not _ROLE.fullmatch(x)]
    try:
        claim = parse_claim(text) if named else None
    except TextError:
        return text
    known = set() if claim is None else {x.name for x in claim.given}
    new = [x for x in named if x not in known]
    if claim is None or not new:
        return text
    if not known:
        return f"given {', '.join(new)}: vehicle: {text.strip()}"
    return printed(replace(claim, given=(*(Binding(x, "vehicle") for x in new), *claim.given)))


def vehicle_order(names: Iterable[str]) -> list[str]:
    """Names of vehicles in the order in which every format numbers them: SV first, the others by name.

    Where none is SV, the only one with a usual name of the vehicle under test comes first.

    >>> vehicle_order(["POV", "SV"]), vehicle_order(["car", "Ego", "bus"])
    (['SV', 'POV'], ['Ego', 'bus', 'car'])
    """
    known = [*names]
    first = subject_in(known)
    return sorted(known, key=lambda name: (name != first, name))


def subject_in(names: Collection[str]) -> str:
    """SV, or else the only one of ``names`` that is usual for the vehicle under test; "" for none."""
    return SUBJECT if SUBJECT in names else _under_test(names)


def _named(
    vehicles: Sequence[str], known: Collection[str], by_role: Mapping[str, str], taken: Sequence[str]
) -> Roles:
    by_name = {name: role for role, name in by_role.items() if name != role}
    for name in vehicles:
        if name not in by_role.values() and name in by_role:
            by_name[name] = next(x for k in count(1) if (x := f"{name}_{k}") not in {*vehicles, *known})
    return Roles(by_name, tuple(taken))


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
    under_test = _under_test([x for x in left if x not in found.values()])
    if SUBJECT not in found and under_test:
        found[SUBJECT] = under_test
        yield SUBJECT, under_test
    others = [x for x in vehicles if x not in found.values()]
    missing = [x for x in PAIR if x not in found]
    if len(vehicles) == len(PAIR) and len(others) == len(missing) == 1:
        yield missing[0], others[0]


def _under_test(names: Iterable[str]) -> str:
    """The only one of some names that is usual for the vehicle under test; empty where there is no such."""
    found = [x for x in names if "".join(y for y in x.casefold() if y.isalnum()) in UNDER_TEST]
    return found[0] if len(found) == 1 else ""

"""Assignment of scenario roles (SV, POV) to vehicles that have names of their own."""

import re
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import field, replace
from itertools import count

from roadproof.errors import InputError, TextError
from roadproof.library.scenarios import PAIR, SUBJECT, TRIPLE
from roadproof.library.specification import unknown_name
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
"""Names of the vehicle under test in other tools, in lower case without separators."""
_WORD, _ROLE = re.compile(r"[A-Za-z_]\w*"), re.compile(r"SV|POV[0-9]?|L[0-9]?")
"""Names in claims, and those that nothing declares."""


@dataclass(frozen=True)
class Roles:
    """The role of each vehicle that has one, by vehicle; ``matched_by_name``: those found by their name.

    All other vehicles keep their names, unless these are roles of other vehicles.
    """

    by_name: Mapping[str, str] = field(default_factory=dict)
    matched_by_name: tuple[str, ...] = ()

    @property
    def note(self) -> str:
        """A note on the roles that were found by name; empty if there are none."""
        notes = [f"{name} is taken as {self.by_name[name]}" for name in self.matched_by_name]
        return ", ".join(notes)

    @property
    def name_by_role(self) -> dict[str, str]:
        """The name in the file of each vehicle, by its role."""
        return {role: name for name, role in self.by_name.items()}

    def played(self, known: Collection[str]) -> dict[str, str]:
        """Return the name in the file for each of the roles ``known``, if it differs from the role."""
        return {role: name for role, name in sorted(self.name_by_role.items()) if role in known}

    def names_in_file(self, vehicles: Iterable[str]) -> tuple[str, ...]:
        """Return the names of vehicles in the file."""
        names = self.name_by_role
        return tuple(names.get(x, x) for x in vehicles)

    def role_of(self, vehicle: str) -> str:
        """Return the role of a vehicle in the file, else its name."""
        return self.by_name.get(vehicle, vehicle)


def roles_of(
    vehicles: Sequence[str], known: Collection[str], assignment: Mapping[str, str], where: str = "roles"
) -> Roles:
    """Assign roles to ``vehicles``: as ``assignment`` (a vehicle by role), else by their names.

    A vehicle whose name is a role, in any case, gets that role. The only one with a usual name of the vehicle
    under test becomes SV; of two vehicles the other one is then POV. ``known``: the roles of scenarios.
    Raises ``InputError``, which begins with ``where``, for unknown names and roles.
    """
    check_roles(vehicles, known, assignment, where)
    by_role = dict(assignment)
    matched_by_name = []
    for role, name in _usual(vehicles, by_role, known):
        by_role[role] = name
        matched_by_name += [name] if name != role else []
    return _named(vehicles, known, by_role, matched_by_name)


def assign_roles(
    vehicles: Sequence[str], required: Sequence[str], assignment: Mapping[str, str], where: str
) -> Roles:
    """Assign the roles ``required`` by one formula to ``vehicles``, as ``roles_of`` does.

    If as many vehicles as roles are left, they get these in the order of the file. With fewer vehicles than
    roles, some roles stay open. Raises ``InputError`` if the assignment is not clear.
    """
    if not assignment and {*required} <= {*vehicles}:
        return Roles()
    assigned = roles_of(vehicles, required, assignment, where)
    by_role = {assigned.role_of(name): name for name in vehicles}
    missing = [role for role in required if role not in by_role]
    others = [name for name in vehicles if assigned.role_of(name) not in required]
    if not missing or len(vehicles) < len(required):
        return assigned
    if len(missing) == len(required) or len(others) != len(missing):
        pairs = zip(vehicle_order(required), (*vehicle_order(vehicles), *"?" * len(required)), strict=False)
        example = ",".join(f"{role}={name}" for role, name in pairs)
        raise InputError(
            f"{where}: no vehicle is called as {', '.join(missing)}; vehicles are {', '.join(vehicles[:12])}"
            f"{', …' if len(vehicles) > 12 else ''}; assign the roles, such as {example}"
        )
    complete = {role: name for role, name in by_role.items() if role in required}
    complete |= dict(zip(missing, others, strict=True))
    return _named(vehicles, required, complete, [*assigned.matched_by_name, *others])


def _goes_with(role: str, known: Collection[str]) -> bool:
    """Return whether a role that a question lacks is of the same cast: SV and POV, or SV, POV1 and POV2."""
    return any({role, *known} <= {*cast} for cast in (PAIR, TRIPLE) if not {*cast} <= {*known})


def check_roles(
    vehicles: Collection[str], known: Collection[str], assignment: Mapping[str, str], where: str
) -> None:
    """Raise ``InputError``, which begins with ``where``, for roles and vehicles that do not exist."""
    for role, name in assignment.items():
        prefix = f"{where} = {{ {role} = '{name}' }}"
        if role not in known and not _goes_with(role, known):
            raise InputError(f"{prefix}: {unknown_name('role', role, known)}")
        if name not in vehicles:
            raise InputError(f"{prefix}: {unknown_name('vehicle', name, vehicles)}")
        roles = [x for x, other in assignment.items() if other == name]
        if len(roles) > 1:
            raise InputError(f"{where}: {name} is {' and '.join(roles)}; it can play one role")


def with_vehicles(text: str, vehicles: Collection[str]) -> str:
    """Return the text of a claim, with a declaration of those of ``vehicles`` that it uses undeclared.

    A text that does not parse is returned unchanged.

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
    """Return names of vehicles in the order in which every format numbers them: SV first, the others by name.

    Without SV, the only one with a usual name of the vehicle under test comes first.

    >>> vehicle_order(["POV", "SV"]), vehicle_order(["car", "Ego", "bus"])
    (['SV', 'POV'], ['Ego', 'bus', 'car'])
    """
    known = [*names]
    first = subject_in(known)
    return sorted(known, key=lambda name: (name != first, name))


def subject_in(names: Collection[str]) -> str:
    """Return SV, else the only one of ``names`` that is usual for the vehicle under test, else ""."""
    return SUBJECT if SUBJECT in names else _under_test(names)


def _named(
    vehicles: Sequence[str], known: Collection[str], by_role: Mapping[str, str], matched: Sequence[str]
) -> Roles:
    by_name = {name: role for role, name in by_role.items() if name != role}
    for name in vehicles:
        if name not in by_role.values() and name in by_role:
            by_name[name] = next(x for k in count(1) if (x := f"{name}_{k}") not in {*vehicles, *known})
    return Roles(by_name, tuple(matched))


def _usual(
    vehicles: Sequence[str], assignment: Mapping[str, str], known: Collection[str]
) -> Iterator[tuple[str, str]]:
    """Yield further roles with their vehicles, found by names, or as the other one of two."""
    unassigned = [x for x in vehicles if x not in assignment.values()]
    assigned: dict[str, str] = dict(assignment)
    for role in (x for x in sorted(known) if x not in assignment):
        named = [x for x in unassigned if x == role] or [
            x for x in unassigned if x.casefold() == role.casefold()
        ]
        if len(named) == 1:
            assigned[role] = named[0]
            yield role, named[0]
    under_test = _under_test([x for x in unassigned if x not in assigned.values()])
    if SUBJECT not in assigned and under_test:
        assigned[SUBJECT] = under_test
        yield SUBJECT, under_test
    others = [x for x in vehicles if x not in assigned.values()]
    missing = [x for x in PAIR if x not in assigned]
    if len(vehicles) == len(PAIR) and len(others) == len(missing) == 1:
        yield missing[0], others[0]


def _under_test(names: Iterable[str]) -> str:
    """Return the only name that is usual for the vehicle under test; empty if there is not exactly one."""
    matches = [x for x in names if "".join(y for y in x.casefold() if y.isalnum()) in UNDER_TEST]
    return matches[0] if len(matches) == 1 else ""

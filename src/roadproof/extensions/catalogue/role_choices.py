"""The choices of a vehicle of a test for each role of a scenario, where vehicles have names of their own."""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from itertools import permutations, product

from roadproof.evidence.drive_file import DriveFile
from roadproof.extensions.traffic.evaluate.one_trace import OneTrace
from roadproof.library.roles import Roles

Choice = tuple[tuple[str, ...], tuple[str, ...]]
"""Roles of scenarios, and a vehicle for each."""


def role_choices(
    roles: Sequence[tuple[str, ...]],
    all_roles: Sequence[tuple[str, ...]],
    names: Sequence[str],
    free: bool,
    any_way: bool = False,
) -> Iterator[Choice]:
    """Yield choices of ``roles`` with vehicles for them: those of the same names, or any if ``free``.

    ``all_roles``: also those of scenarios outside the question. If vehicles have the names of all roles of
    one of these, only vehicles with such names play. Otherwise a vehicle with the name of a role plays that
    role alone, and others may play any other role. ``any_way``: also where no vehicle has the name of a role.
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


def no_role_note(vehicles: Iterable[str]) -> str:
    """Return a note on a drive none of whose vehicles plays a role."""
    return (
        f"no vehicle is called as a role of a scenario (vehicles: {', '.join(vehicles)}); name them in a "
        'catalogue.toml, as roles = { SV = "…", POV = "…" }'
    )


def vehicle_choices(
    ids: Sequence[str], named: Mapping[str, str], roles: Sequence[str]
) -> Iterator[tuple[int, ...]]:
    """Yield places in ``ids`` for the ``roles``, all different; ``named``: the vehicle of some roles."""
    taken = {*named.values()}
    free = [k for k, name in enumerate(ids) if name not in taken]
    places = ([ids.index(named[role])] if role in named else free for role in roles)
    return (chosen for chosen in product(*places) if len({*chosen}) == len(chosen))


def drive_in_roles(file: DriveFile, roles: Roles) -> DriveFile:
    """Return the drive of a file with its vehicles named by their roles."""
    return replace(file, drive=file.drive.cast({roles.role_of(name): name for name in file.drive.vehicles}))


def samples_in_roles(
    trace: OneTrace, roles: tuple[str, ...], vehicles: tuple[str, ...]
) -> tuple[OneTrace, tuple[str, ...]]:
    """Return the samples of ``vehicles`` alone, named by their ``roles``, and these names.

    Samples with given lane predicates stay as they are, since the predicates speak of names.
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

"""Which vehicle of a test plays which role of scenarios, where vehicles have names of their own."""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from itertools import permutations, product

from roadproof.evidence.drive_file import DriveFile
from roadproof.extensions.traffic.evaluate.one_trace import OneTrace
from roadproof.library.roles import Roles

Choice = tuple[tuple[str, ...], tuple[str, ...]]
"""Roles of scenarios, and a vehicle for each."""


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
    return replace(file, drive=file.drive.cast({roles.called(name): name for name in file.drive.vehicles}))


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

"""The code of other packages on which an answer depends, as a part of its key in the store.

Claims are closed, but a package may add code that decides them: a question, a mode, a modifier or a driver
model. Another version of it may answer otherwise.
"""

from collections.abc import Iterator
from functools import cache
from pathlib import Path
from typing import TypeAlias

from roadproof.engines.modifier import find_modifier
from roadproof.evidence.claim import Claim, On, OwnMode
from roadproof.extension import entries, extension_of, installed_extensions
from roadproof.runtime.package_data import folder_digest

PackageVersion: TypeAlias = tuple[str, str, str]
"""A package of others: its name, its distribution with its version, and a digest of its files."""


def foreign_code(kind: str, claim: Claim) -> tuple[PackageVersion, ...]:
    """Return the packages of others on which the answer to a claim of a kind of question depends."""
    owners = (extension_of(entry.partition(":")[0]) for entry in _code_of(kind, claim))
    return tuple(sorted({_version(x.package) for x in owners if x is not None and x.is_foreign}))


def all_foreign_code() -> tuple[PackageVersion, ...]:
    """Return all packages of others, for results that may depend on any of them."""
    return tuple(_version(x.package) for x in installed_extensions().values() if x.is_foreign)


def _code_of(kind: str, claim: Claim) -> Iterator[str]:
    """Yield the modules and entries that decide a claim."""
    if kind in (questions := entries("questions")):
        yield questions[kind]
    modifier = find_modifier(claim.home.options)
    if modifier is not None:
        yield type(modifier).__module__
        yield from modifier.relies_on
    match claim.mode:
        case OwnMode() as mode:
            yield type(mode).__module__
            yield from mode.relies_on
        case On(judge=judge):
            yield type(judge).__module__
            yield from judge.relies_on
        case _:  # open: engines of the core decide all other modes
            return


@cache
def _version(package: str) -> PackageVersion:
    x = next(x for x in installed_extensions().values() if x.package == package)
    return x.package, x.distribution, folder_digest(Path(x.folder))

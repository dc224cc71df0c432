"""The shares of classes in a simulated recording, stored under a digest of everything that they depend on.

No verdict rests on them.
"""

import json
from collections import Counter
from typing import Annotated, Final, TypeAlias

from roadproof.errors import InputError
from roadproof.evidence.codec import Doc, read, write
from roadproof.extensions.surveys.classify.classes import Classes
from roadproof.extensions.surveys.classify.traffic_shares import Shares, count_shares
from roadproof.extensions.traffic.simulate.simulate import simulate
from roadproof.extensions.traffic.simulate.traffic import TrafficSettings
from roadproof.questions.basis import Basis
from roadproof.runtime.archives import is_off, recall, remember
from roadproof.runtime.canonical import digest
from roadproof.runtime.records import dataclass
from roadproof.runtime.version import ANSWERS

KIND: Final = "shares"
SECONDS, SEED = 600.0, 1
SOURCE: Final = f"a simulated recording of {SECONDS:g} s, seed {SEED}"
Count: TypeAlias = tuple[str, int]


@dataclass(frozen=True)
class SharesRecord:
    """The JSON of ``Shares``, with counts in the order in which classes occurred."""

    recordings: Annotated[tuple[str, ...], Doc("What was counted in.")]
    traces: Annotated[int, Doc("Traces in which danger arises.")]
    covered: Annotated[int, Doc("Those with a class.")]
    repeated: Annotated[int, Doc("Traces that were left out, as another recording shows them.")]
    situations: Annotated[tuple[Count, ...], Doc("Situations by class.")]
    in_traces: Annotated[tuple[Count, ...], Doc("Traces by class.")]
    classified: Annotated[tuple[tuple[int, int], ...], Doc("Situations by number of vehicles.")]


def simulated_shares(basis: Basis, classes: Classes, fresh: bool = False) -> Shares:
    """Return the shares of ``classes`` in a simulated recording; ``basis`` reads their set.

    ``fresh``: count again even if the shares are known. Shares that contradict a proof are not stored.
    """
    reads_known = not fresh and not is_off()
    key = shares_key(basis, classes)
    known = recall(KIND, key) if reads_known else None
    if known is not None:
        try:
            return shares_of(known.text)
        except InputError:  # they are counted again
            pass
    home, values = basis.specification, basis.all_values()
    recording = simulate(TrafficSettings(seconds=SECONDS), SEED)
    shares = count_shares(classes, home, values, [recording], source=SOURCE)
    if reads_known and not shares.broken:
        remember(key, shares_text(shares))
    return shares


def shares_key(basis: Basis, classes: Classes) -> str:
    """Return a digest of all that shares depend on: every definition, readings, values, and the classes."""
    home, plan = basis.specification, classes.plan
    named = [(x.name, x.vehicles, x.scenarios) for x in classes.all()]
    groups = [(x.vehicles, x.rows) for x in plan.groups]
    divided = plan.set_name, groups, plan.sectors, plan.places, plan.happenings
    read_with = home.library.fingerprint, home.set_name, home.options, basis.all_values()
    return digest(SOURCE, read_with, divided, named, ANSWERS)


def shares_text(shares: Shares) -> str:
    """Return shares as JSON."""
    record = SharesRecord(
        tuple(shares.recordings),
        shares.all_traces,
        shares.covered,
        shares.repeated,
        tuple(shares.situations.items()),
        tuple(shares.traces.items()),
        tuple(shares.classified.items()),
    )
    return json.dumps(write(record))


def shares_of(text: str) -> Shares:
    """Return the shares of a JSON text. Raises ``InputError``."""
    record = read(SharesRecord, json.loads(text), "known shares")
    return Shares(
        [*record.recordings],
        record.traces,
        record.covered,
        Counter(dict(record.situations)),
        Counter(dict(record.in_traces)),
        Counter(dict(record.classified)),
        repeated=record.repeated,
        source=SOURCE,
    )

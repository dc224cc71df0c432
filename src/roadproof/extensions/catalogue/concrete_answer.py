"""The answer about a concrete test: the targets that it shows, with notes and decisions of driver models."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from functools import cached_property

from roadproof.extensions.catalogue.catalogue_data import NearestScenario, ShownTarget
from roadproof.extensions.catalogue.entries import ConcreteTest
from roadproof.extensions.traffic.evaluate.decisions import Decision
from roadproof.library.scenarios import number_in
from roadproof.verdict import Verdict


@dataclass(frozen=True)
class ConcreteAnswer:
    """The answer about a test.

    ``claims``: the claims of the catalogue, else that of the file. ``begins``: initial values by name (m,
    m/s). ``dense``: whether it was judged in dense time. ``others``: parameters with other values in its file
    than in the question. ``notes``: contradictions in its samples and the like. ``made_with``: parameters,
    readings and spec set of its file that differ from the question. ``rejected``: why the judge rejects its
    file, with the file's own values. ``fault``: why it cannot be read. ``why``: why it shows no scenario.
    ``sha256``: the digest of its files at the judgement (``digest_of``). ``decisions``: those of driver
    models on its scenarios. ``roles``: the vehicle of each role that has another name.
    """

    entry: ConcreteTest
    claims: tuple[str, ...]
    shown: tuple[ShownTarget, ...] = ()
    begins: Mapping[str, float] = field(default_factory=dict)
    dense: bool = False
    others: tuple[str, ...] = ()
    notes: tuple[str, ...] = ()
    made_with: tuple[str, ...] = ()
    rejected: str = ""
    fault: str = ""
    why: NearestScenario | None = None
    sha256: str = ""
    decisions: tuple[Decision, ...] = ()
    roles: Mapping[str, str] = field(default_factory=dict)

    @cached_property
    def names(self) -> frozenset[str]:
        """The names of all targets that it shows."""
        return frozenset(x.what for x in self.shown)

    @property
    def verdict(self) -> Verdict:
        """COVERED where it shows a target, else GAPS."""
        return Verdict.COVERED if self.shown else Verdict.GAPS


def has_scenario(shown: Iterable[ShownTarget]) -> bool:
    """Return whether a scenario is among the targets."""
    return any(number_in(x.what) is not None for x in shown)


def in_order(shown: Iterable[ShownTarget]) -> tuple[ShownTarget, ...]:
    """Return targets in the order of their instants, then by name, vehicles and lane."""
    return tuple(sorted(shown, key=lambda x: (x.at, x.what, x.vehicles, x.lane)))

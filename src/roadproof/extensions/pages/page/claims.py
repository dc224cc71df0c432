"""The template values of claims: template properties, a matrix of scenarios and properties, and
each claim.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

from roadproof.engines.prove.properties import OWN, find_task
from roadproof.evidence.codec import read
from roadproof.evidence.finding import Acceptance, Finding
from roadproof.evidence.strict import Fields
from roadproof.extensions.pages.page.matrix import Heading, Linked, Matrix
from roadproof.extensions.pages.page.page_context import PageContext
from roadproof.extensions.pages.page.results import PageResult, Words
from roadproof.library.assumption import claim_statement
from roadproof.library.words import spans
from roadproof.questions.prove_data import ClaimData, ClaimsData
from roadproof.verdict import Verdict

LEAST_SCENARIOS = 3
"""The smallest number of scenarios for which the matrix shows a property."""


@dataclass(frozen=True)
class ShownClaim:
    """A claim with the finding about its evidence, and the drive that refutes it.

    ``id``: its listed property, empty for a claim of the user; ``title``: its statement in words; ``place``:
    its id on the page.
    """

    verdict: Verdict
    expected: Verdict | None
    id: str
    part: str
    title: str
    scenario: int | None
    set: str
    claim: str
    finding: Finding | None
    drive: Mapping[str, object] | None
    place: str

    @property
    def label(self) -> str:
        """The property, part and scenario, such as ``P1 4``."""
        return " ".join(filter(None, (self.name, "" if self.scenario is None else str(self.scenario))))

    @property
    def name(self) -> str:
        """The property and part, such as ``P8-rear``."""
        return "-".join(filter(None, (self.id, self.part)))

    @property
    def outcome(self) -> str:
        """The outcome of checking its evidence, empty without evidence."""
        return "" if self.finding is None else str(self.finding.outcome)


def claims(result: PageResult, context: PageContext, words: Words) -> dict[str, object]:
    """Return the values for an answer of ``prove``."""
    shown = [*shown_claims(result, context)]
    listed = [x for x in shown if x.id]
    return {
        "claims": shown,
        "accepted": sum(x.outcome == Acceptance.ACCEPTED for x in shown),
        "properties": _properties(listed),
        "matrix": _matrix(listed, words),
    }


def shown_claims(result: PageResult, context: PageContext) -> Iterator[ShownClaim]:
    """Yield the claims of a result, in order. Raises ``InputError``."""
    for k, x in enumerate(read(ClaimsData, result.data, result.name).verdicts):
        finding = context.finding(result.folder, x.evidence)
        task = find_task(x.claim, x.set)
        yield ShownClaim(
            verdict=x.verdict,
            expected=x.expected,
            id="" if x.property == OWN else x.property,
            part="" if x.property == OWN else x.part,
            title="" if task is None else task.title,
            scenario=x.scenario,
            set=x.set,
            claim=claim_statement(x.assuming, x.claim),
            finding=finding,
            drive=_drive_against(x),
            place=f"claim-{result.id}-{k}",
        )


def _drive_against(claim: ClaimData) -> Mapping[str, object] | None:
    if claim.refuted_by != "drive":
        return None
    return Fields(claim.counterexample, "its counterexample").mapping("drive")


@dataclass(frozen=True)
class ListedProperty:
    """A property in words, with its claims in all sets."""

    name: str
    title: str
    claims: Sequence[ShownClaim]

    @property
    def sets(self) -> str:
        """The sets in which it was asked."""
        return ", ".join(dict.fromkeys(x.set for x in self.claims))

    @property
    def scenarios(self) -> str:
        """The scenarios for which it was asked, such as ``1-3, 7``."""
        return spans({x.scenario for x in self.claims if x.scenario is not None})


def _properties(listed: Sequence[ShownClaim]) -> list[ListedProperty]:
    """Return a row for each property, in the order of the result."""
    groups: dict[tuple[str, str], list[ShownClaim]] = {}
    for x in listed:
        groups.setdefault((x.name, x.title), []).append(x)
    return [ListedProperty(name, title, claims) for (name, title), claims in groups.items()]


def _matrix(listed: Sequence[ShownClaim], words: Words) -> Matrix | None:
    """Return the matrix with a row for each scenario and a column for each property and set.

    None where no property has enough scenarios.
    """
    about: dict[str, set[int]] = {}
    for x in listed:
        if x.scenario is not None:
            about.setdefault(x.name, set()).add(x.scenario)
    wide = [x for x in listed if x.scenario is not None and len(about[x.name]) >= LEAST_SCENARIOS]
    if not wide:
        return None
    columns = dict.fromkeys((x.name, x.set) for x in wide)
    sets = {name: [of for one, of in columns if one == name] for name, _ in columns}
    cells: dict[tuple[object, object], Linked] = {
        (x.scenario, (x.name, x.set)): Linked(x.verdict, f"{x.label} in {x.set}: {x.verdict}", x.place)
        for x in wide
    }
    return Matrix(
        [Heading(n, n, words.get(n)) for n in sorted({x.scenario for x in wide if x.scenario is not None})],
        [Heading((name, of), of) for name, set_names in sets.items() for of in set_names],
        cells,
        [(name, len(set_names)) for name, set_names in sets.items()],
    )

"""The template properties P1 to P9, and claims from users' files."""

import hashlib
import re
from collections.abc import Iterator, Sequence
from functools import cache
from itertools import groupby
from pathlib import Path

from roadproof.errors import Position, UsageError
from roadproof.library.assumption import claim_statement
from roadproof.library.specification import read_specification, unknown_name
from roadproof.runtime.records import dataclass
from roadproof.verdict import ClaimVerdict, Verdict, claim_verdict

ROAD_SECTORS_APART = 8  # scenarios 9 to 24 are 1 to 8 on other road sectors
OWN = "claim"  # the id of claims that users bring
_RANGE = re.compile(r"\s*(\d+)\s*(?:\.\.\s*(\d+)\s*)?")
_INDEX = re.compile(r"\{i(?:\+(\d+))?\}")


@dataclass(frozen=True)
class Task:
    """A claim in a spec set with its expected verdict; ``scenario`` None: about no single scenario.

    ``assuming``: assumptions in words. ``of_all_values``: the verdict is expected for all values of
    parameters together, and may differ at some.
    """

    id: str
    part: str
    title: str
    scenario: int | None
    set_name: str
    claim: str
    expected: ClaimVerdict
    assuming: tuple[str, ...] = ()
    of_all_values: bool = False

    @property
    def name(self) -> str:
        """A name that no other claim has, fit for a file: ``P1-scenario-04-base``, ``claim-3f0a9c71``."""
        if self.id == OWN:
            return name_of_claim(self.claim, self.set_name, self.assuming)
        middle = f"-scenario-{self.scenario:02}" if self.scenario is not None else ""
        under = f"-at-{digest(claim_statement(self.assuming, ''))}" if self.assuming else ""
        return f"{self.id}{'-' + self.part if self.part else ''}{middle}-{self.set_name}{under}"

    @property
    def affinity(self) -> tuple[str, int | str]:
        """The key of claims whose proofs share steps: set, and scenario up to its road sector."""
        if self.scenario is None:
            return self.set_name, self.claim
        return self.set_name, self.scenario % ROAD_SECTORS_APART


def name_of_claim(claim: str, set_name: str, assuming: Sequence[str] = ()) -> str:
    """A name for a claim in a set, under what is assumed, fit for a file: ``claim-3f0a9c71-base``."""
    return f"{OWN}-{digest(claim_statement(assuming, ' '.join(claim.split())))}-{set_name}"


def digest(text: str) -> str:
    """Return eight hexadecimal digits of the SHA-256 of a text."""
    return hashlib.sha256(text.encode()).hexdigest()[:8]


def template_properties() -> list[Task]:
    """Return P1 to P9 and the negative controls, in order."""
    import tomllib

    text = Path(__file__).with_name("properties.toml").read_text("utf-8")
    entries = (
        _Property(**entry) for entries_of_one in tomllib.loads(text).values() for entry in entries_of_one
    )
    tasks = [task for entry in entries for task in entry.tasks]
    headings = list(dict.fromkeys((task.id, task.title, task.set_name) for task in tasks))
    return sorted(tasks, key=lambda x: (headings.index((x.id, x.title, x.set_name)), x.scenario or 0))


def find_label(claim: str, set_name: str) -> tuple[str, str, int | None] | None:
    """Return property, part and scenario of a claim in a set; None if it is no template property."""
    task = find_task(claim, set_name)
    return None if task is None else (task.id, task.part, task.scenario)


def find_task(claim: str, set_name: str) -> Task | None:
    """Return the template property that states a claim in a set, or None."""
    return _tasks_by_claim().get((" ".join(claim.split()), set_name))


@cache
def _tasks_by_claim() -> dict[tuple[str, str], Task]:
    return {(" ".join(x.claim.split()), x.set_name): x for x in template_properties()}


@dataclass(frozen=True)
class _Property:
    """An entry of ``properties.toml``: a claim in some sets, for each of its ``scenarios``, if any."""

    id: str
    title: str
    claim: str
    sets: tuple[str, ...]
    part: str = ""
    scenarios: str = ""
    expected: str = Verdict.PROVED
    values: str = ""

    @property
    def tasks(self) -> Iterator[Task]:
        """The claims of this entry, one for each set and scenario."""
        for set_name in self.sets:
            for number in _numbers(self.scenarios) if self.scenarios else [None]:
                claim, expected = _at(self.claim, number), claim_verdict(self.expected)
                of_all = self.values == "all"
                yield Task(
                    self.id, self.part, self.title, number, set_name, claim, expected, of_all_values=of_all
                )


def _numbers(text: str) -> list[int | None]:
    numbers: list[int | None] = []
    for piece in text.split(","):
        match = _RANGE.fullmatch(piece)
        assert match is not None, f"bad range {piece!r} in properties.toml"
        numbers += range(int(match[1]), int(match[2] or match[1]) + 1)
    return numbers


def _at(claim: str, scenario: int | None) -> str:
    return _INDEX.sub(lambda match: str((scenario or 0) + int(match[1] or 0)), claim)


def choose(
    tasks: Sequence[Task], names: Sequence[str], set_name: str | None, numbers: Sequence[int] = ()
) -> list[Task]:
    """Select the tasks of the named properties (all if none is named) in a set (all if None).

    ``numbers``: only those about these scenarios. Raises ``UsageError`` for an unknown property.
    """
    known = {task.id for task in tasks}
    for name in names:
        if name not in known:
            raise UsageError(unknown_name("property", name, known))
    return [
        task
        for task in tasks
        if (not names or task.id in names)
        and set_name in (None, task.set_name)
        and (not numbers or task.scenario in numbers)
    ]


@dataclass(frozen=True)
class WrittenClaim:
    """A claim of a file, with the place where it begins; line and column count from 1."""

    text: str
    at: Position


def read_claims(path: Path) -> list[WrittenClaim]:
    """Return the claims of a file: paragraphs, without ``#`` comments. Raises ``InputError``."""
    text = read_specification(path).text.replace("\r\n", "\n")
    numbered = [(k, line) for k, line in enumerate(text.split("\n"), 1) if not line.lstrip().startswith("#")]
    lines = [(k, line.partition("#")[0].rstrip()) for k, line in numbered]
    paragraphs = (list(group) for filled, group in groupby(lines, lambda x: bool(x[1])) if filled)
    return [
        WrittenClaim(
            "\n".join(line for _, line in those).strip(),
            Position(those[0][0], len(those[0][1]) - len(those[0][1].lstrip()) + 1),
        )
        for those in paragraphs
    ]

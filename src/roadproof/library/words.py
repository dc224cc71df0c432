"""Scenarios in words: a title, the road sector, what SV and POV do, and a sentence.

All words come from the specification: from ``title of`` the number, and from descriptions of definitions. A
scenario without title is named by its description.
"""

from collections.abc import Iterable, Iterator, Mapping
from itertools import groupby

from roadproof.library import scenarios
from roadproof.library.specification import Specification
from roadproof.runtime.records import dataclass


@dataclass(frozen=True)
class Words:
    """A scenario in words; each field is empty if the specification has no text for it.

    ``title``: what happens, without the road ``sector``. ``sv`` and ``pov``: what they do. ``sentence``: the
    whole scenario as a driver would describe it.
    """

    number: int
    title: str = ""
    sector: str = ""
    sv: str = ""
    pov: str = ""
    sentence: str = ""

    @property
    def name(self) -> str:
        """Title and road sector."""
        return ", ".join(filter(None, (self.title, self.sector)))

    def __str__(self) -> str:
        """Return ``scenario 4: …``, or the number alone if there are no words.

        >>> str(Words(4, "deceleration ahead, lane keep", "main road")), str(Words(40))
        ('scenario 4: deceleration ahead, lane keep, main road', 'scenario 40')
        """
        return f"scenario {self.number}" + (f": {self.name}" if self.name else "")


ScenarioWords = Mapping[int, Words]
"""Scenarios in words, by number."""


def words_of(specification: Specification, number: int) -> Words:
    """Return a scenario in words; all are empty for a number that the specification does not have."""
    sector = scenarios.sector_words(specification, number)
    sv, pov = scenarios.behaviour_words(specification, number)
    declared = scenarios.declared_title(specification, number)
    if declared is not None:
        title, sentence = declared.title, declared.sentence or declared.title
    else:
        title = scenarios.description_of(specification, number) or ", ".join(filter(None, (sv, pov)))
        sentence = title
    text = ": ".join(filter(None, (sector, sentence)))
    return Words(number, title, sector, sv, pov, text and f"{text[0].upper()}{text[1:].rstrip('.')}.")


def words_by_number(specification: Specification, numbers: Iterable[int] | None = None) -> ScenarioWords:
    """Return scenarios in words, in order; without ``numbers``, all scenarios of the specification."""
    chosen = scenarios.numbers_of(specification) if numbers is None else numbers
    return {number: words_of(specification, number) for number in sorted(chosen)}


def words_named_in(specification: Specification, texts: Iterable[str]) -> ScenarioWords:
    """Return the scenarios that some texts name, in words."""
    numbers = {number for text in texts for number in scenarios.numbers_named(text)}
    return words_by_number(specification, numbers)


def words_in_sets(specification: Specification, sets: Iterable[str], numbers: Iterable[int]) -> ScenarioWords:
    """Return scenarios in the words that all of some spec sets share; without words where the sets differ."""
    chosen = sorted(numbers)
    first, *others = (words_by_number(specification.in_set(name), chosen) for name in sets)
    agreeing = (n for n in chosen if all(words[n] == first[n] for words in others))
    return {**{n: Words(n) for n in chosen}, **{n: first[n] for n in agreeing}}


def legend(words: ScenarioWords) -> Iterator[str]:
    """Yield lines that explain numbers in a table: one for each title, one for all road sectors."""
    if len(words) == 1:
        yield from (f"{number}: {x.name}" for number, x in words.items() if x.name)
        return
    titles = _numbers_by((x.number, x.title) for x in words.values())
    width = max(map(len, titles.values()), default=0) + 1
    for title, numbers in titles.items():
        yield f"{f'{numbers}:':<{width}} {title}"
    sectors = _numbers_by((x.number, x.sector) for x in words.values())
    if sectors:
        yield "; ".join(f"{numbers}: {sector}" for sector, numbers in sectors.items())


def _numbers_by(named: Iterable[tuple[int, str]]) -> dict[str, str]:
    """Return the numbers with each name, as text, without those that have no name."""
    by_name: dict[str, list[int]] = {}
    for number, name in named:
        if name:
            by_name.setdefault(name, []).append(number)
    return {name: spans(numbers) for name, numbers in by_name.items()}


def spans(numbers: Iterable[int], least: int = 3) -> str:
    """Return numbers as text, with ``least`` or more consecutive ones as a span.

    >>> spans([1, 2, 3, 9, 17, 18])
    '1-3, 9, 17, 18'
    """
    shown: list[str] = []
    for _, group in groupby(enumerate(sorted(numbers)), key=lambda x: x[1] - x[0]):
        run = [number for _, number in group]
        shown += [f"{run[0]}-{run[-1]}"] if len(run) >= least else map(str, run)
    return ", ".join(shown)

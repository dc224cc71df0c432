"""What a scenario is called, for people: a title, its road sector, what SV and POV do, and a sentence.

All words are the specification's: the ``title of`` its number, and the descriptions of its definitions. A
scenario that has no title is called by its description.
"""

from collections.abc import Iterable, Iterator, Mapping
from itertools import groupby

from roadproof.library import scenarios as s
from roadproof.library.specification import Specification
from roadproof.runtime.records import dataclass


@dataclass(frozen=True)
class Words:
    """A scenario in words, each empty where the specification says nothing.

    ``title``: what happens, without the road ``sector``. ``sv`` and ``pov``: what they do. ``sentence``: the
    whole as a driver would tell it.
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
        """``scenario 4: …``, the number alone where there are no words.

        >>> str(Words(4, "deceleration ahead, lane keep", "main road")), str(Words(40))
        ('scenario 4: deceleration ahead, lane keep, main road', 'scenario 40')
        """
        return f"scenario {self.number}" + (f": {self.name}" if self.name else "")


Called = Mapping[int, Words]
"""Scenarios in words, by number."""


def words_of(specification: Specification, number: int) -> Words:
    """A scenario in words; one that the specification does not have has none."""
    where = s.sector_words(specification, number)
    sv, pov = s.behaviour_words(specification, number)
    declared = s.declared_title(specification, number)
    if declared is not None:
        title, sentence = declared.title, declared.sentence or declared.title
    else:
        title = s.own_words(specification, number) or ", ".join(filter(None, (sv, pov)))
        sentence = title
    told = ": ".join(filter(None, (where, sentence)))
    return Words(number, title, where, sv, pov, told and f"{told[0].upper()}{told[1:].rstrip('.')}.")


def called(specification: Specification, numbers: Iterable[int] | None = None) -> Called:
    """Scenarios in words, in order; all of a specification where no ``numbers`` are given."""
    chosen = s.numbers_of(specification) if numbers is None else numbers
    return {number: words_of(specification, number) for number in sorted(chosen)}


def called_by(specification: Specification, texts: Iterable[str]) -> Called:
    """The scenarios that some texts name, in words."""
    return called(specification, {number for text in texts for number in s.numbers_named(text)})


def called_in(specification: Specification, sets: Iterable[str], numbers: Iterable[int]) -> Called:
    """Scenarios as all of some spec sets call them; one that they do not call alike has no words."""
    chosen = sorted(numbers)
    first, *others = (called(specification.in_set(name), chosen) for name in sets)
    alike = (n for n in chosen if all(words[n] == first[n] for words in others))
    return {**{n: Words(n) for n in chosen}, **{n: first[n] for n in alike}}


def legend(words: Called) -> Iterator[str]:
    """What numbers in a table mean: a line for each title and one for the roads; one line for one number."""
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
    """The numbers with each name, as text; those without a name are left out."""
    found: dict[str, list[int]] = {}
    for number, name in named:
        if name:
            found.setdefault(name, []).append(number)
    return {name: spans(numbers) for name, numbers in found.items()}


def spans(numbers: Iterable[int], least: int = 3) -> str:
    """Numbers as text, ``least`` or more that follow each other as a span.

    >>> spans([1, 2, 3, 9, 17, 18])
    '1-3, 9, 17, 18'
    """
    shown: list[str] = []
    for _, group in groupby(enumerate(sorted(numbers)), key=lambda x: x[1] - x[0]):
        run = [number for _, number in group]
        shown += [f"{run[0]}-{run[-1]}"] if len(run) >= least else map(str, run)
    return ", ".join(shown)

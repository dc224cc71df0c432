"""Concrete tests that earlier runs have judged: taken over where test, question and program are the same."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

from roadproof.analysis.catalogue.asked import Questions
from roadproof.analysis.catalogue.decisions import Drivers, content_of
from roadproof.analysis.catalogue.entries import Concrete, Freedom
from roadproof.analysis.catalogue.showing import ConcreteAnswer
from roadproof.analysis.catalogue.traces import digest_of
from roadproof.analysis.study.known import KnownAnswer, KnownAnswers
from roadproof.errors import InputError
from roadproof.evidence.codec import read, write
from roadproof.runtime.canonical import digest

SCHEMA = "roadproof/shown/1"


@dataclass(frozen=True)
class EarlierAnswers:
    """The answers of earlier runs to ``asked``, with this freedom and these driver models."""

    asked: Questions
    freedom: Freedom
    drivers: Drivers | None

    def of(self, entries: Sequence[Concrete]) -> dict[str, ConcreteAnswer]:
        """The answers that are known, by the ids of the tests."""
        found = ((x.id, self._find(x)) for x in entries)
        return {name: answer for name, answer in found if answer is not None}

    def keep(self, answers: Sequence[ConcreteAnswer]) -> None:
        """Keep answers for later runs."""
        for answer in answers:
            key = self._key(answer.entry, answer.sha256)
            if key:
                self._known.remember(_name(answer.entry), key, KnownAnswer(write(answer), {}))
        if answers:
            self._known.make_room()

    def _find(self, entry: Concrete) -> ConcreteAnswer | None:
        key = self._key(entry, digest_of(entry.place))
        found = self._known.find(_name(entry), key) if key else None
        if found is None:
            return None
        try:
            return read(ConcreteAnswer, found.record, "a known answer")
        except InputError:  # the program has changed since, which versions do not tell
            return None

    def _key(self, entry: Concrete, sha256: str) -> str:
        """What the answer depends on besides the question; empty where no digest says that."""
        return digest(sha256, entry) if sha256 else ""

    @cached_property
    def _known(self) -> KnownAnswers:
        """A test may use any definition, and is told of all spec sets: so all of them count."""
        home = self.asked.specification
        read = home.set_name, home.options, self.asked.values, home.library.fingerprint, home.library.titles
        drivers = None if self.drivers is None else content_of(self.drivers)
        asked = self.asked.numbers, self.asked.named, self.freedom, bool(home.library.files)
        return KnownAnswers.to(SCHEMA, {"asked": digest(read, asked, drivers)}, {})


def _name(entry: Concrete) -> str:
    return f"shown {entry.id}"

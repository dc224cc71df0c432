"""Which scenarios can hold together: for every pair a drive, a proof that there is none, or a doubt.

Pairs that differ only in their road sectors (eq. disturbFormat: rows 9 to 24 repeat rows 1 to 8) form a
group. One pair is solved for each group; its drive is put on roads of the other sectors and judged
there, and its core is looked up in the others, each of which gets a certificate of its own.
"""

import time
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from fractions import Fraction
from itertools import combinations
from pathlib import Path
from typing import Any

from roadproof.analysis.meeting import Meeting, Node, conjunctions, scenario_numbers
from roadproof.analysis.placing import Shown, show_elsewhere
from roadproof.effort import Effort, Late
from roadproof.evidence.certificate import to_json
from roadproof.logic import formula as f
from roadproof.logic.formula import Formula, transform
from roadproof.logic.rewrite import without_names
from roadproof.prove.prover import Result, prove
from roadproof.spec.bind import default_values
from roadproof.spec.elaborate import apply_definition, read_claim
from roadproof.spec.library import Library, Specification, load_library
from roadproof.verdict import Verdict
from roadproof.witness.ask import Request, ask
from roadproof.witness.impossible import parts, show_impossible
from roadproof.witness.question import Means


@dataclass(frozen=True)
class Asked:
    """What is asked of every pair, and within which limits; ``horizon`` in s.

    ``effort`` is for one drive; ``proof``: units of work for a proof before a drive is looked for.
    """

    sets: tuple[str, ...] = ("base",)
    meeting: Meeting = field(default_factory=Meeting)
    options: Mapping[str, str] = field(default_factory=dict)
    specs: tuple[Path, ...] = ()
    values: Mapping[str, Fraction] = field(default_factory=dict)
    horizon: Fraction = Fraction(6)
    effort: Effort = field(default_factory=Effort)
    proof: float = 3.0

    def load(self) -> tuple[Library, Specification]:
        """The library, and the definitions of the first set."""
        library = load_library(self.specs)
        return library, library.select(self.sets[0], self.options)

    def question(self) -> dict[str, str]:
        """What is asked as texts, without the limits of the search."""
        values = " ".join(f"{name}={value}" for name, value in sorted(self.values.items()))
        return {
            "sets": ",".join(self.sets),
            "meeting": repr(self.meeting),
            "options": repr(sorted(self.options.items())),
            "values": values,
        }


@dataclass(frozen=True)
class Core:
    """Parts of a conjunction that already clash."""

    formula: str
    parts: tuple[str, ...]


@dataclass(frozen=True)
class Entry:
    """The answer for one pair: WITNESSED with a drive, IMPOSSIBLE with certificate and cores, or a reason.

    ``formula`` is what the drive satisfies, or the claim that was proved; ``certificate`` a file's text.
    """

    a: Node
    b: Node
    verdict: Verdict
    formula: str
    reason: str = ""
    cores: tuple[Core, ...] = ()
    certificate: str | None = None
    drive: Mapping[str, Any] | None = None
    seconds: float = 0.0


Pair = tuple[Node, Node]


def pairs_of(asked: Asked, numbers: Sequence[int] | None = None) -> list[Pair]:
    """The pairs of different scenarios of one set, or all pairs across two; ``numbers``: only these."""
    library, _ = asked.load()
    nodes = [
        [
            Node(number, name)
            for number in scenario_numbers(library.select(name, asked.options))
            if numbers is None or number in numbers
        ]
        for name in asked.sets
    ]
    if len(nodes) == 1:
        return list(combinations(nodes[0], 2))
    return [(a, b) for a in nodes[0] for b in nodes[1]]


def groups_of(asked: Asked, pairs: Sequence[Pair]) -> list[tuple[Pair, list[Pair]]]:
    """The pairs in groups that differ in road sectors only; with each group the pair to be solved for it.

    That is the pair of the first scenarios that are the same but for their sectors. Within a pair of
    one set the order may be turned around, which a conjunction does not mind.
    """
    _, specification = asked.load()
    likes = {name: likes_of(specification.in_set(name)) for name in asked.sets}
    groups: dict[Pair, list[Pair]] = {}
    for a, b in pairs:
        first, second = likes[a.set_name][a.number], likes[b.set_name][b.number]
        turned = a.set_name == b.set_name and second < first
        seed = (Node(first, a.set_name), Node(second, b.set_name))
        groups.setdefault(seed[::-1] if turned else seed, []).append((b, a) if turned else (a, b))
    return list(groups.items())


def likes_of(specification: Specification) -> dict[int, int]:
    """For every scenario the first one that differs from it in the road sector only."""
    first: dict[Formula, int] = {}
    likes: dict[int, int] = {}
    for number in scenario_numbers(specification):
        query = apply_definition(specification, f"scenario_{number}")
        likes[number] = first.setdefault(without_sectors(query.formula), number)
    return likes


def without_sectors(formula: Formula) -> Formula:
    """``formula`` without names, and with every application of a ``roadSector_…`` replaced by true."""

    def change(part: Formula) -> Formula:
        if not isinstance(part, f.Named):
            return part
        return f.TRUE if part.name.startswith("roadSector_") else part.body

    return transform(formula, change)


def decide_group(asked: Asked, seed: Pair, pairs: Sequence[Pair]) -> list[Entry]:
    """The answers for a group: the seed is solved, and the others are answered with its help."""
    library, specification = asked.load()
    deciding = _Deciding(asked, library, specification)
    begun = time.monotonic()
    first = deciding.answer(seed)
    entries: list[Entry] = []
    for pair in pairs:
        entry = first if pair == seed else deciding.answer(pair, seed, first)
        a, b = sorted(pair, key=lambda node: (asked.sets.index(node.set_name), node.number))
        entries.append(replace(entry, a=a, b=b, seconds=time.monotonic() - begun))
        begun = time.monotonic()
    return entries


@dataclass(frozen=True)
class _Deciding:
    asked: Asked
    library: Library
    specification: Specification

    def texts(self, pair: Pair) -> tuple[str, ...]:
        return conjunctions(self.specification, *pair, self.asked.meeting)

    def answer(self, pair: Pair, seed: Pair | None = None, first: Entry | None = None) -> Entry:
        """The answer for a pair, with the help of that for its group's seed; a doubt where it is late."""
        try:
            followed = None if seed is None or first is None else self.follow(pair, seed, first)
            return followed or self.decide(pair)
        except Late as late:
            return _doubt(pair, self.texts(pair), str(late))

    def decide(self, pair: Pair) -> Entry:
        """Proofs first, which are quick where they exist; then drives for what is left."""
        texts = self.texts(pair)
        left = [x for x in texts if not _proved(self._prove(f"not ({x})"))]
        if not left:
            cores = tuple(self._core(x) for x in texts)
            return self._impossible(pair, texts, cores) or _doubt(pair, texts, "a proof was lost")
        for formula in left:
            outcome = ask(self._request(formula, explain=False))
            if outcome.drives:
                return Entry(*pair, Verdict.WITNESSED, formula, drive=outcome.drives[0])
        return self._explain(pair, texts, left)

    def follow(self, pair: Pair, seed: Pair, first: Entry) -> Entry | None:
        """An answer with the help of that for the seed of the group, or None."""
        texts = self.texts(pair)
        if first.verdict is Verdict.IMPOSSIBLE:
            cores = [self._core_like(x, core) for x, core in zip(texts, first.cores, strict=True)]
            return self._impossible(pair, texts, tuple(cores))
        if first.drive is None:
            return None
        chosen = texts[self.texts(seed).index(first.formula)]
        shown = show_elsewhere(Shown(first.formula, dict(first.drive)), chosen, self.library)
        return None if shown is None else Entry(*pair, Verdict.WITNESSED, chosen, drive=shown.data)

    def _impossible(self, pair: Pair, texts: Sequence[str], cores: tuple[Core, ...]) -> Entry | None:
        claim = " and ".join(f"not ({x})" for x in texts)
        label = f"overlap-{pair[0]}-{pair[1]}"
        result = prove(self.specification, claim, self._longer(), label)
        if not _proved(result) or result.certificate is None:
            return None
        return Entry(*pair, Verdict.IMPOSSIBLE, claim, "", cores, to_json(result.certificate))

    def _explain(self, pair: Pair, texts: Sequence[str], left: Sequence[str]) -> Entry:
        """No drive was found: say within which limits there is none, or prove it after all."""
        verdicts: list[Verdict] = []
        reasons: list[str] = []
        for formula in left:
            outcome = ask(self._request(formula, explain=True))
            if outcome.drives:
                return Entry(*pair, Verdict.WITNESSED, formula, drive=outcome.drives[0])
            verdicts.append(outcome.verdict)
            reasons.append(outcome.told(("--horizon",)) or f"proved impossible: {formula}")
        if all(verdict is Verdict.IMPOSSIBLE for verdict in verdicts):
            entry = self._impossible(pair, texts, tuple(self._core(x) for x in texts))
            if entry is not None:
                return entry
        sure = all(verdict in (Verdict.IMPOSSIBLE, Verdict.NONE_WITHIN) for verdict in verdicts)
        verdict = Verdict.NONE_WITHIN if sure else Verdict.UNKNOWN
        return Entry(*pair, verdict, " or ".join(f"({x})" for x in left), "; ".join(dict.fromkeys(reasons)))

    def _prove(self, claim: str) -> Result:
        return prove(self.specification, claim, self.asked.effort.of(self.asked.proof))

    def _longer(self) -> Effort:
        """For proofs that are known to be there."""
        return self.asked.effort.of(10 * self.asked.proof)

    def _core(self, formula: str) -> Core:
        shown = show_impossible(self.specification, formula, self._longer())
        return Core(formula, shown.core if shown is not None else (formula,))

    def _core_like(self, formula: str, core: Core) -> Core:
        """``core`` for ``formula``, where all its parts are parts of that too; its own core otherwise."""
        wanted = {without_names(self._read(part)) for part in core.parts}
        mine = {without_names(part) for part in parts(self._read(formula))}
        return Core(formula, core.parts) if wanted <= mine else self._core(formula)

    def _read(self, formula: str) -> Formula:
        return read_claim(self.specification, formula).formula

    def _request(self, formula: str, explain: bool) -> Request:
        return Request(
            formula,
            self.asked.sets[0],
            self.asked.options,
            self.asked.specs,
            {**default_values(self.library), **self.asked.values},
            horizon=self.asked.horizon,
            means=Means("smooth", effort=self.asked.effort, explain=explain),
        )


def _proved(result: Result) -> bool:
    return result.verdict in (Verdict.PROVED, Verdict.VACUOUS)


def _doubt(pair: Pair, texts: Sequence[str], reason: str) -> Entry:
    return Entry(*pair, Verdict.UNKNOWN, " or ".join(f"({x})" for x in texts), reason)

"""The index and the journal of ``roadproof order``: which scenarios imply which."""

import re
from collections.abc import Collection, Iterator, Mapping, Sequence
from math import perm

from roadproof.errors import InputError
from roadproof.evidence.answers.entry import Common, Entry, evidence_name
from roadproof.evidence.strict import Fields, text
from roadproof.logic.rewrite import without_names
from roadproof.spec.scenarios import Scenario, applied, vehicles_of

SCHEMA = "roadproof/order/1"
SAID = ("sets", "options", "parameters", "specs")
FIELDS = ("schema", *SAID, "view", "kinds", "proved", "edges", "missing", "drives", "doubts", "seconds")
_APPLIED = re.compile(r"\s*scenario_([0-9]{1,6})(?:@(\w+))?\(\s*([\w\s,]*?)\s*\)\s*", re.ASCII)
_NODE = re.compile(r"([0-9]{1,6})@(\w+)", re.ASCII)


def read(head: Fields, common: Common, proved: Sequence[object], drives: Sequence[object]) -> Iterator[Entry]:
    """The entries of an index or of a line of a journal. Raises ``InputError``."""
    for number, content in enumerate(proved, 1):
        line = Fields(
            content, f"{common.where}, implication {number}", ("from", "to", "claim", "certificate")
        )
        yield _implication(line, common)
    for number, content in enumerate(drives, 1):
        line = Fields(content, f"{common.where}, drive {number}", ("number", "holds", "fails", "drive"))
        yield _refutation(line, common)


def _implication(line: Fields, common: Common) -> Entry:
    above, below, claim = line.text("from"), line.text("to"), line.text("claim")
    one, _, other = claim.partition("->")
    told = _reading(one, common), _reading(other, common)
    right = told[0] is not None and told[1] is not None and (told[0][0], told[1][0]) == (above, below)
    if not right or not _fit(told[0][1] if told[0] else (), told[1][1] if told[1] else ()):
        fault = f"{line.where} says {above} -> {below}, but its claim is not that: {claim[:120]}"
    else:
        fault = ""
    return Entry(
        common,
        line.where,
        ("implication", above, below),
        "PROVED",
        f"{above} -> {below}",
        "proof",
        claim,
        evidence_name(line, "certificate"),
        fault=fault,
    )


def _refutation(line: Fields, common: Common) -> Entry:
    holds, fails = line.text("holds"), line.texts("fails")
    return Entry(
        common,
        line.where,
        ("drive", line.content.get("drive")),
        "WITNESSED",
        f"{holds} without {', '.join(fails)}",
        "drive",
        None,
        evidence_name(line, "drive"),
        fault_of=lambda formula: _misread(formula, holds, fails, common),
    )


def _misread(formula: str, holds: str, fails: Sequence[str], common: Common) -> str:
    """Why a drive's formula is not that one scenario holds and the others do not; or nothing."""
    readings = readings_of(formula, common)
    told = [] if readings is None else [node for _, (node, _) in readings]
    if readings is None or readings[0][0][0] != holds or sorted(set(told)) != sorted(set(fails)):
        return f"it says that {holds} holds without {', '.join(fails)}, but its drive: {formula[:120]}"
    return ""


Reading = tuple[str, tuple[str, ...]]


def readings_of(formula: str, common: Common) -> list[tuple[Reading, Reading]] | None:
    """``A and not B and not C`` as the pairs A, B and A, C; None where it is no such formula."""
    first, *others = formula.split(" and ")
    above = _reading(first, common)
    found: list[tuple[Reading, Reading]] = []
    for other in others:
        below = _reading(other.strip().removeprefix("not "), common)
        if above is None or below is None or not other.strip().startswith("not "):
            return None
        if not _fit(above[1], below[1]):
            return None
        found.append((above, below))
    return found or None


def _reading(written: str, common: Common) -> Reading | None:
    """A scenario applied to names, as its node and the names."""
    read = _APPLIED.fullmatch(written)
    if read is None:
        return None
    return f"{int(read[1])}@{read[2] or common.set_name}", tuple(re.split(r"\s*,\s*", read[3]))


def _fit(above: tuple[str, ...], below: tuple[str, ...]) -> bool:
    """Whether two scenarios are about one L and the same SV, and the fewer POVs are among the others."""
    if len(above) == len(below):
        return above == below and above[0] == "SV" and above[-1] == "L"
    fewer, more = sorted((above, below), key=len)
    ends = (fewer[0], fewer[-1]) == (more[0], more[-1]) == ("SV", "L")
    return ends and set(fewer) <= set(more) and len(set(fewer)) == len(fewer)


def faults(data: Fields, common: Common, formulas: Mapping[str, str]) -> Iterator[str]:
    """What a whole index says that its entries do not show; ``formulas`` are those of accepted drives."""
    proved = {(x.text("from"), x.text("to")) for x in _lines(data, "proved")}
    for edge in data.items("edges"):
        if edge not in data.items("proved"):
            yield f"an edge is not among what is proved: {str(edge)[:120]}"
    refuted: dict[tuple[str, str], set[tuple[Reading, Reading]]] = {}
    numbers: dict[tuple[str, str], set[int]] = {}
    for drive in _lines(data, "drives"):
        for above, below in readings_of(formulas.get(drive.text("drive"), ""), common) or ():
            refuted.setdefault((above[0], below[0]), set()).add((above, below))
            numbers.setdefault((above[0], below[0]), set()).add(drive.whole("number"))
    for line in _lines(data, "missing"):
        pair = (line.text("from"), line.text("to"))
        if len(refuted.get(pair, ())) < _count_readings(common, *pair):
            yield f"that {pair[0]} does not imply {pair[1]} is not shown by its drives"
        elif set(line.items("drives")) != numbers[pair]:
            yield f"the drives against {pair[0]} -> {pair[1]} are not those that it names"
    kinds = [_names(kind, data.where) for kind in data.items("kinds")]
    for kind in kinds:
        meanings = {without_names(applied(common.specification, _node(name)).formula) for name in kind}
        if len(meanings) != 1:
            yield f"{', '.join(kind)} are not one formula"
    told = {(x.text("from"), x.text("to")) for field in ("missing", "doubts") for x in _lines(data, field)}
    yield from _unanswered([kind[0] for kind in kinds if kind], proved, told)


def _lines(data: Fields, field: str) -> list[Fields]:
    return [Fields(content, f"{data.where}, {field}") for content in data.items(field)]


def _names(content: object, where: str) -> list[str]:
    if not isinstance(content, list):
        raise InputError(f"{where}, kinds: {str(content)[:60]!r} is no list")
    return [text(name, f"{where}, kinds") for name in content]


def _unanswered(
    names: Sequence[str], proved: Collection[tuple[str, str]], told: Collection[tuple[str, str]]
) -> Iterator[str]:
    """Pairs of which nothing is said: neither implied, nor missing, nor in doubt."""
    for above in names:
        reached, waiting = {above}, [above]
        while waiting:
            current = waiting.pop()
            new = {b for a, b in proved if a == current} - reached
            reached |= new
            waiting += new
        for below in names:
            if below not in reached and (above, below) not in told:
                yield f"nothing is said of {above} -> {below}"


def _count_readings(common: Common, above: str, below: str) -> int:
    """How many ways there are to read an implication between scenarios of different numbers of vehicles."""
    sizes = sorted(len(vehicles_of(common.specification, _node(name))) for name in (above, below))
    return 1 if sizes[0] == sizes[1] else perm(sizes[1] - 1, sizes[0] - 1)


def _node(name: str) -> Scenario:
    read = _NODE.fullmatch(name)
    if read is None:
        raise InputError(f"'{name[:40]}' is no scenario: write 4@base")
    return Scenario(int(read[1]), read[2])

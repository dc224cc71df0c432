"""The index and the journal of ``roadproof order``: which scenarios imply which."""

import re
from collections.abc import Collection, Iterator, Mapping, Sequence
from math import perm

from roadproof.errors import InputError, TextError
from roadproof.evidence.answers.entry import Common, Entry, evidence_name
from roadproof.evidence.answers.reader import Background, Reader
from roadproof.evidence.strict import Fields, text
from roadproof.logic import syntax
from roadproof.logic.parse import parse_claim
from roadproof.logic.rewrite import without_names
from roadproof.spec.scenarios import (
    LANE,
    SUBJECT,
    Application,
    Scenario,
    application_in,
    applied,
    vehicles_of,
)

SCHEMA = "roadproof/order/1"
_NODE = re.compile(r"([0-9]{1,6})@(\w+)", re.ASCII)


def read(data: Fields, background: Background) -> Iterator[Entry]:
    """The entries of an index or of a kept answer. Raises ``InputError``."""
    common = background.home
    for number, content in enumerate(data.items("proved"), 1):
        line = Fields(
            content, f"{common.where}, implication {number}", ("from", "to", "claim", "certificate")
        )
        yield _implication(line, common)
    for number, content in enumerate(data.items("drives"), 1):
        line = Fields(content, f"{common.where}, drive {number}", ("number", "holds", "fails", "drive"))
        yield _refutation(line, common)
    for number, content in enumerate(data.items("doubts"), 1):
        Fields(content, f"{common.where}, doubt {number}", ("from", "to", "reason"))


def _implication(line: Fields, common: Common) -> Entry:
    above, below, claim = line.text("from"), line.text("to"), line.text("claim")
    fault = ""
    if [(str(a.scenario), str(b.scenario)) for a, b in _implied(claim, common)] != [(above, below)]:
        fault = f"{line.where} says {above} -> {below}, but its claim is not that: {claim[:120]}"
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
    told = {str(below.scenario) for _, below in readings}
    if not readings or str(readings[0][0].scenario) != holds or told != set(fails):
        return f"it says that {holds} holds without {', '.join(fails)}, but its drive: {formula[:120]}"
    return ""


Reading = tuple[Application, Application]


def _implied(claim: str, common: Common) -> list[Reading]:
    """``A -> B`` as the pair A, B; nothing where it is no such claim."""
    match _body(claim):
        case syntax.Binary("->", above, below):
            return _fitting([(above, below)], common)
        case _:
            return []


def readings_of(formula: str, common: Common) -> list[Reading]:
    """``A and not B and not C`` as the pairs A, B and A, C; nothing where it is no such formula."""
    match _body(formula):
        case syntax.Chain("and", (above, *others)):
            below = [x.body for x in others if isinstance(x, syntax.Prefix) and x.op == "not"]
            return _fitting([(above, x) for x in below], common) if len(below) == len(others) else []
        case _:
            return []


def _body(written: str) -> syntax.Expression | None:
    """What a text says, None where it is no formula or declares names of its own."""
    try:
        claim = parse_claim(written)
    except TextError:
        return None
    return None if claim.given else claim.body


def _fitting(pairs: Sequence[tuple[syntax.Expression, syntax.Expression]], common: Common) -> list[Reading]:
    """Pairs of scenarios that speak of the same vehicles; nothing where one pair is no such."""
    found: list[Reading] = []
    for above, below in pairs:
        one, other = (application_in(common.specification, said) for said in (above, below))
        if one is None or other is None or not _fit(one.arguments, other.arguments):
            return []
        found.append((one, other))
    return found


def _fit(above: tuple[str, ...], below: tuple[str, ...]) -> bool:
    """Whether two scenarios are about one L and the same SV, and the fewer POVs are among the others."""
    fewer, more = sorted((above, below), key=len)
    if len(fewer) == len(more) and fewer != more:
        return False
    ends = (fewer[:1], fewer[-1:]) == (more[:1], more[-1:]) == ((SUBJECT,), (LANE,))
    return ends and set(fewer) <= set(more) and len(set(fewer)) == len(fewer)


def faults(data: Fields, background: Background, formulas: Mapping[str, str]) -> Iterator[str]:
    """What a whole index says that its entries do not show; ``formulas`` are those of accepted drives."""
    common = background.home
    proved = {(x.text("from"), x.text("to")) for x in _lines(data, "proved")}
    for edge in data.items("edges"):
        if edge not in data.items("proved"):
            yield f"an edge is not among what is proved: {str(edge)[:120]}"
    drawn = {(x.text("from"), x.text("to")) for x in _lines(data, "edges")}
    for one, other in sorted(proved):
        if other not in _reached(one, drawn):
            yield f"{one} -> {other} is proved, but does not follow from the edges"
    refuted: dict[tuple[str, str], set[Reading]] = {}
    numbers: dict[tuple[str, str], set[int]] = {}
    for drive in _lines(data, "drives"):
        for above, below in readings_of(formulas.get(drive.text("drive"), ""), common):
            shown = str(above.scenario), str(below.scenario)
            refuted.setdefault(shown, set()).add((above, below))
            numbers.setdefault(shown, set()).add(drive.whole("number"))
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
    asked = {_node(name).set_name for kind in kinds for name in kind}
    if asked != {*data.texts("sets")}:
        yield f"its sets are not those of its scenarios: {', '.join(sorted(asked))}"
    told = {(x.text("from"), x.text("to")) for field in ("missing", "doubts") for x in _lines(data, field)}
    known = {name for kind in kinds for name in kind}
    spoken = {name for names in (proved | told) for name in names}
    spoken |= {name for x in _lines(data, "drives") for name in (x.text("holds"), *x.texts("fails"))}
    if spoken - known:
        yield f"it says something of {', '.join(sorted(spoken - known))}, but no kind has it"
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
        reached = _reached(above, proved)
        for below in names:
            if below not in reached and (above, below) not in told:
                yield f"nothing is said of {above} -> {below}"


def _reached(above: str, steps: Collection[tuple[str, str]]) -> set[str]:
    """What follows from ``above`` by steps, itself included."""
    reached, waiting = {above}, [above]
    while waiting:
        current = waiting.pop()
        new = {b for a, b in steps if a == current} - reached
        reached |= new
        waiting += new
    return reached


def _count_readings(common: Common, above: str, below: str) -> int:
    """How many ways there are to read an implication between scenarios of different numbers of vehicles."""
    sizes = sorted(len(vehicles_of(common.specification, _node(name))) for name in (above, below))
    return 1 if sizes[0] == sizes[1] else perm(sizes[1] - 1, sizes[0] - 1)


def _node(name: str) -> Scenario:
    read = _NODE.fullmatch(name)
    if read is None:
        raise InputError(f"'{name[:40]}' is no scenario: write 4@base")
    return Scenario(int(read[1]), read[2])


READER = Reader(
    SCHEMA,
    ("sets", "options", "parameters", "specs"),
    ("view", "kinds", "proved", "edges", "missing", "drives", "doubts", "seconds"),
    read,
    ("family", "proved", "drives", "doubts"),
    read,
    faults,
    unchecked=("seconds", "doubts[].reason"),
    unchecked_kept=("doubts", "said.sets"),
    file_name=lambda record: record.text("family"),
)

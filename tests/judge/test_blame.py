"""Why a formula is true or false: what is named is enough, whatever all else were."""

from fractions import Fraction
from pathlib import Path

import pytest

from roadproof.errors import UsageError
from roadproof.evidence.drive_file import DriveFile, load_drive
from roadproof.library.bind import bind, values_with
from roadproof.library.elaborate import read_claim
from roadproof.library.loading import bundled_library
from roadproof.logic import formula as f
from roadproof.logic.formula import Formula, subformulas
from roadproof.semantics.exact.blame import Blame, blame
from roadproof.semantics.exact.exact import Judgement, judge, seconds
from roadproof.semantics.exact.truth import (
    NEVER,
    TruthSet,
    always,
    complement,
    eventually,
    intersection,
    union,
    until,
)

EXAMPLES = Path(__file__).parents[2] / "examples"
DRIVES = (
    "traffic/drives/scenario-01-base.json",
    "traffic/drives/scenario-04-base.json",
    "catalogue/tests/drives/both-change-fast.json",
)
HOME = bundled_library().select()
MOMENTS = (Fraction(0), Fraction(3, 2), Fraction(14, 5))


def judged(file: DriveFile, text: str) -> Judgement:
    formula = read_claim(HOME, text).formula
    lanes = {"L": file.lanes["L"]}
    return judge(bind(formula, file.road, lanes, values_with(HOME.library, {})), file.drive)


def possible(judgement: Judgement, known: Blame, formula: Formula) -> tuple[TruthSet, TruthSet]:
    """When a formula must, and when it may be true, where comparisons are known only at some instants."""
    match formula:
        case f.Truth():
            return judgement.truth(formula), judgement.truth(formula)
        case f.Compare():
            truth, at = judgement.truth(formula), known.get(formula, NEVER)
            return intersection([truth, at]), union([truth, complement(at)])
        case f.Not(body):
            least, most = possible(judgement, known, body)
            return complement(most), complement(least)
        case f.Application(_, _, body):
            return possible(judgement, known, body)
        case f.And(parts) | f.Or(parts):
            join = intersection if isinstance(formula, f.And) else union
            every = [possible(judgement, known, part) for part in parts]
            return join([x for x, _ in every]), join([x for _, x in every])
        case f.Eventually(interval, body) | f.Always(interval, body):
            reach = eventually if isinstance(formula, f.Eventually) else always
            least, most = possible(judgement, known, body)
            return reach(*seconds(interval), least), reach(*seconds(interval), most)
        case f.Until(left, interval, right):
            first, then = possible(judgement, known, left), possible(judgement, known, right)
            return (
                until(first[0], *seconds(interval), then[0]),
                until(first[1], *seconds(interval), then[1]),
            )
    raise AssertionError(formula)


@pytest.mark.parametrize("drive", DRIVES)
@pytest.mark.parametrize(
    "text",
    [
        *(f"scenario_{n}(SV,POV,L)" for n in (1, 3, 4, 6, 7)),
        "(v_lon(SV) > 27 m/s or not danger(SV,POV)) U[1 s, 3 s] (danger(SV,POV) and F[0, 1 s] atLane(POV,L))",
        "G (F[1 s, 2 s] rssViolation(SV,POV) or G[0, 1 s] not (aheadOf(SV,POV) U danger(SV,POV)))",
    ],
)
def test_what_is_named_is_enough(drive: str, text: str) -> None:
    judgement = judged(load_drive(EXAMPLES / drive), text)
    asked = 0
    for part in list(subformulas(judgement.formula))[:24]:
        for at in MOMENTS:
            found = blame(judgement, part, at)
            known = {x: instants for x, instants in found.items() if isinstance(x, f.Compare)}
            least, most = possible(judgement, known, part)
            assert least.at(at) if judgement.truth(part).at(at) else not most.at(at), (part, at)
            asked += 1
    assert asked >= 24


def test_one_reason_is_enough_for_one_instant() -> None:
    """Of two parts that are false the first is named, and of a window its first false stretch."""
    judgement = judged(load_drive(EXAMPLES / DRIVES[1]), "s(SV) < 0 m and v_lon(SV) < 0 m/s")
    assert isinstance(judgement.formula, f.And)
    first, second = judgement.formula.parts
    fast = judged(load_drive(EXAMPLES / DRIVES[1]), "F[0, 2 s] not s(SV) < 0 m")
    assert set(blame(judgement)) in ({judgement.formula, first}, {judgement.formula, second})
    [instants] = [str(x) for part, x in blame(fast).items() if isinstance(part, f.Compare)]
    assert instants.startswith(("[0", "(0"))


def test_only_judged_parts_are_explained() -> None:
    judgement = judged(load_drive(EXAMPLES / DRIVES[1]), "danger(SV,POV)")
    with pytest.raises(UsageError, match="no judged part"):
        blame(judgement, f.TRUE)

"""A drive that is tried for another claim has that claim's values of parameters, which its file may lack."""

import random
from dataclasses import replace
from fractions import Fraction

import pytest

import roadproof as rp
from roadproof.engines.search.batches import Engines
from roadproof.engines.search.known_drive import KnownDrive
from roadproof.evidence.answer import ClaimAnswer
from roadproof.evidence.claim import Claim, Exists, claim_of
from roadproof.evidence.judged import JudgedDrive
from roadproof.library.elaborate import read_claim
from roadproof.runtime.budget import Effort, Work
from roadproof.verdict import Verdict

HOME = rp.load(specs=["param gap = 2 s where gap > 0\n"]).specification
BEHIND = "v_lon(SV) = 15 m/s and s(SV) + 40 m = s(POV)"


def claim(text: str, gap: Fraction | None = None) -> Claim:
    values = {} if gap is None else {"gap": gap}
    return claim_of(HOME, read_claim(HOME, text), Exists(horizon=Fraction(2)), values)


@pytest.fixture(scope="module")
def drive() -> JudgedDrive:
    answer, _ = Engines(Work(Effort(20.0))).answer_claim(claim(BEHIND))
    assert answer.drive is not None
    assert "gap" not in answer.drive.file.values
    return answer.drive


@pytest.mark.parametrize(
    "work", [Work(Effort(20.0)), Work(Effort(20.0), moves=False)], ids=["moves", "stays"]
)
@pytest.mark.parametrize("seed", range(12))
def test_each_way_to_try_a_known_drive_reads_the_values_of_the_claim(
    seed: int, work: Work, drive: JudgedDrive
) -> None:
    chance = random.Random(seed)
    gap, factor = Fraction(chance.randint(1, 60), 10), chance.choice([5, 10, 15])
    text = chance.choice(
        [f"v_lon(SV) > gap*{factor} m/s^2", f"s(POV) - s(SV) > gap*{factor} m/s and v_lon(SV) > 0 m/s"]
    )
    asked = claim(f"({BEHIND}) and {text}", gap)
    engines = Engines(work)
    engines.offer(drive)
    answer, _ = engines.answer_claim(asked)
    holds = gap * factor < (15 if text.startswith("v_lon") else 40)
    assert (answer.verdict is Verdict.WITNESSED) == holds
    if answer.drive is not None:
        assert answer.drive.file.values["gap"] == gap
    known = KnownDrive(drive)
    for shown in (known.here(asked), known.elsewhere(asked.query, asked), known.recast(asked, False)):
        assert (shown is not None) == holds
        assert shown is None or shown.file.values["gap"] == gap


def test_no_answer_is_made_of_a_drive_with_other_values(drive: JudgedDrive) -> None:
    asked = claim(f"({BEHIND}) and v_lon(SV) > gap*5 m/s^2", Fraction(1))
    shown = KnownDrive(drive).here(asked)
    assert shown is not None
    assert ClaimAnswer(asked, shown).verdict is Verdict.WITNESSED
    with pytest.raises(ValueError, match="it has gap=1, and not 2"):
        ClaimAnswer(claim(f"({BEHIND}) and v_lon(SV) > gap*5 m/s^2"), shown)
    everywhere = replace(asked, mode=replace(asked.mode, horizon=Fraction(3)))
    assert everywhere.values == {"gap": 1}

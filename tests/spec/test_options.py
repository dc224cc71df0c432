"""Definitions under their options, judged at one instant."""

from fractions import Fraction as F

import pytest

from roadproof.library.bind import default_values
from roadproof.library.elaborate import read_claim
from roadproof.library.loading import bundled_library
from roadproof.logic.rewrite import with_values
from roadproof.semantics.exact import judge
from roadproof.world.drive import Drive, Motion, Piece

LIBRARY = bundled_library()


def going(v_lon: int, v_lat: int) -> Motion:
    return Motion(F(9, 2), F(9, 5), F(0), F(3), F(v_lon), F(v_lat), (Piece(None, F(0), F(0)),))


@pytest.mark.parametrize(
    ("sv", "pov", "along", "total"),
    [
        ((30, 0), (29, 8), False, True),  # 900 and 905
        ((30, 0), (29, -8), False, True),
        ((30, 0), (29, 7), False, False),  # 900 and 890
        ((29, 8), (30, 0), True, False),
        ((30, 4), (30, -4), False, False),
        ((20, 0), (30, 0), True, True),
    ],
)
def test_faster_along_the_road_or_in_all(
    sv: tuple[int, int], pov: tuple[int, int], along: bool, total: bool
) -> None:
    drive = Drive({"SV": going(*sv), "POV": going(*pov)})
    for options, expected in (({}, along), ({"speed": "total"}, total)):
        formula = read_claim(LIBRARY.select("base", options), "fasterThan(SV, POV)").formula
        assert judge(with_values(formula, default_values(LIBRARY)), drive).holds == expected

"""A countermodel is judged from its numbers and its road alone."""

from dataclasses import replace
from fractions import Fraction

import pytest

from roadproof.errors import InputError
from roadproof.evidence.answers.trace import MOST_INSTANTS
from roadproof.evidence.refutation import Countermodel, Instant, fault_of, read_trace, trace_data
from roadproof.library.elaborate import read_claim
from roadproof.library.loading import bundled_library
from roadproof.world.road import Lanelet, Road, pairs

SPECIFICATION = bundled_library().select("base")
CLAIM = read_claim(SPECIFICATION, "given v: m/s: atLane(SV,L) -> F[0,minSafe] v_lon(SV) > v").formula


def number(text: str | int) -> Fraction:
    return Fraction(text)


def lanelet(name: str, lane: str, low: int, high: int, right: int) -> Lanelet:
    s, d = (number(low), number(high)), (number(right), number(right + 3))
    return Lanelet(name, lane, "main", "main", s, d)


ROAD = Road("r", (lanelet("a", "L", 0, 50, 0), lanelet("b", "K", 0, 50, 3)), pairs([("L", "K")]))
STATE = {name: number(x) for name, x in {"s(SV)": 9, "d(SV)": 2, "v_lon(SV)": 5, "v": 5}.items()}
STATE |= {"length(SV)": number(4), "width(SV)": number(2)}
FASTER = STATE | {"v_lon(SV)": number(6)}
FOUND = Countermodel(
    (Instant(number(0), STATE, {}), Instant(number(1), FASTER, {})),
    {"minSafe": number("3/5")},
    "before",
    ROAD,
)


def fault(found: Countermodel) -> str | None:
    return fault_of(found, CLAIM, SPECIFICATION.library.bounds)


def with_road(*lanelets: Lanelet, beside: tuple[tuple[str, str], ...] = ()) -> Countermodel:
    return replace(FOUND, road=Road("r", lanelets, pairs(beside)))


def with_first(**values: int) -> Countermodel:
    changed = STATE | {f"{name}(SV)" if name != "v" else name: number(x) for name, x in values.items()}
    return replace(FOUND, instants=(Instant(number(0), changed, {}), *FOUND.instants[1:]))


def test_a_countermodel():
    assert fault(FOUND) is None


@pytest.mark.parametrize(
    ("changed", "said"),
    [
        (replace(FOUND, parameters={"minSafe": number(-1)}), "declared minSafe >= 0"),
        (replace(FOUND, parameters={"minSafe": number(1)}), "true on it"),
        (replace(FOUND, parameters={}), "still holds a parameter"),
        (replace(FOUND, held="after"), "true on it"),
        (replace(FOUND, instants=FOUND.instants[1:]), "ascend from 0"),
        (replace(FOUND, instants=FOUND.instants[::-1]), "ascend from 0"),
        (replace(FOUND, instants=()), "ascend from 0"),
        (with_first(length=5), "length, width or kind changes"),
        (replace(with_first(width=0), instants=with_first(width=0).instants[:1]), "not greater than 0"),
        (with_first(d=9), "true on it"),
        (with_first(v=4), "true on it"),
        (replace(FOUND, road=None), "L"),
        (with_road(lanelet("a", "K", 0, 50, 0)), "L"),
        (with_road(lanelet("a", "L", 0, 50, 0), lanelet("a", "K", 0, 50, 9)), "given twice"),
        (with_road(lanelet("a", "L", 0, 50, 0), lanelet("b", "L", 60, 90, 0)), "does not begin where"),
        (with_road(*ROAD.lanelets), "share a boundary"),
        (with_road(lanelet("a", "L", 0, 50, 0), lanelet("b", "K", 0, 50, 9), beside=(("L", "K"),)), "share"),
    ],
)
def test_what_is_none(changed, said):
    assert said in str(fault(changed))


@pytest.mark.parametrize("road", [ROAD, None])
def test_a_trace_goes_through_plain_data(road):
    plain = trace_data(replace(FOUND, road=road))
    assert read_trace(plain, "here") == replace(FOUND, road=road)
    assert (plain["road"] is None) == (road is None)


def test_a_trace_of_too_many_instants_is_refused():
    plain = trace_data(FOUND)
    with pytest.raises(InputError, match=f"more than {MOST_INSTANTS} instants"):
        read_trace({**plain, "instants": plain["instants"][:1] * (MOST_INSTANTS + 1)}, "here")


def test_a_drive_is_no_trace():
    with pytest.raises(InputError, match="a drive is a file beside the index"):
        read_trace({"kind": "drive"}, "here")

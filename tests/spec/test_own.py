"""Own signals and kinds of vehicles in the language: what is read, what is refused, what is printed."""

import pytest

from roadproof.errors import TextError
from roadproof.library.compose import with_vehicles
from roadproof.library.elaborate import read_claim
from roadproof.library.loading import bundled_library, load_library
from roadproof.library.specification import Source
from roadproof.library.uses import definitions_used
from roadproof.logic.custom_names import told_freedom
from roadproof.logic.rewrite import vehicles_of, without_names
from roadproof.logic.show import as_syntax, text
from roadproof.world.signals import KINDS

OWN = """
signal jerk(a: vehicle): m/s^3 in [-10, 10 m/s^3] "how fast its acceleration changes"
signal red: bool "the light is red"
signal gap(a: vehicle): m in [0, inf]
signal speed(a: vehicle): km/h in [0, 36]
signal braking: bool derived by red
signal ahead(a: vehicle): m derived by s(a) + gap(a)
"""


def home(more: str = ""):
    return load_library([Source("own.spec", OWN + more)]).select()


@pytest.mark.parametrize(
    ("claim", "expanded"),
    [
        ("red and jerk(SV) > 2 m/s^3", "red and jerk(SV) > 2 m/s^3"),
        ("F braking", "F red"),
        ("ahead(SV) < s(POV)", "s(SV) + gap(SV) < s(POV)"),
        ("not red", "not red"),
        ("kind(SV) = truck", "kind(SV) = truck"),
        ("not kind(SV) = car", "not kind(SV) = car"),
        ("bus = kind(SV)", "kind(SV) = bus"),
        ("kind(SV) != motorcycle", "kind(SV) != motorcycle"),
        ("given truck: vehicle: kind(truck) = truck", "kind(truck) = truck"),
    ],
)
def test_what_is_written_is_printed(claim: str, expanded: str) -> None:
    assert text(as_syntax(read_claim(home(), claim).formula, expand=True)) == expanded


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("op", ["=", "!=", ">=", "<"])
def test_all_that_compares_kinds_reads_back(kind: str, op: str) -> None:
    if kind == KINDS[0] and op in (">=", "<"):
        return  # nothing comes before the first
    made = read_claim(home(), f"kind(SV) {op} {kind}").formula
    for part in (made, *getattr(made, "parts", ())):
        assert read_claim(home(), text(as_syntax(part))).formula == part


def test_bounds_are_in_si_and_said() -> None:
    formula = read_claim(home(), "speed(SV) > 1 m/s and jerk(SV) > 0 and red and gap(SV) < 1 m").formula
    assert told_freedom(formula) == (
        "gap is any function of time within [0, inf] m",
        "jerk is any function of time within [-10, 10] m/s^3",
        "red is unconstrained: any function of time",
        "speed is any function of time within [0, 10] m/s",
    )
    assert told_freedom(read_claim(home("signal x: bool derived by true"), "x").formula) == ()


def test_roles_are_exchanged_in_own_signals_and_never_in_kinds() -> None:
    query = read_claim(home(), "given truck: vehicle: jerk(truck) > 1 m/s^3 and red and kind(truck) = truck")
    renamed = with_vehicles(query, {"truck": "POV"})
    assert vehicles_of(renamed.formula) == ("POV",)
    assert without_names(read_claim(home(), renamed.text).formula) == renamed.formula


def test_a_derived_signal_is_shown_with_what_it_is_derived_by() -> None:
    query = read_claim(home(), "F braking and ahead(SV) > 0")
    assert [x.name for x in definitions_used(home(), query.claim.body)] == ["braking", "ahead"]


def test_the_fingerprint_changes_with_signals_only() -> None:
    plain = bundled_library().fingerprint
    assert load_library([Source("x", "")]).fingerprint == plain
    assert len({plain, home().library.fingerprint, home("signal y: m").library.fingerprint}) == 3


@pytest.mark.parametrize(
    ("claim", "column", "told"),
    [
        ("jerk > 2", 1, "'jerk' needs its arguments"),
        ("red(SV)", 1, "'red' takes 0 arguments but got 1"),
        ("jerk(SV, POV) > 0", 1, "'jerk' takes 1 argument but got 2"),
        ("red > 0", 1, "a number is expected here, but this is a formula"),
        ("jerk(SV) > 2", 1, "write it with m/s^3"),
        ("jek(SV) > 0", 1, "did you mean 'jerk'?"),
        ("F[0, speed(SV)] red", 6, "an interval bound is a time"),
        ("given red: vehicle: v_lon(red) > 0", 7, "'red' is a signal of the specification"),
        ("some red in lanes: atLane(SV, red)", 1, "'red' is a signal of the specification"),
        ("kind(SV)", 1, "a kind is no number"),
        ("kind(SV) + 1 > 2", 1, "a kind is no number"),
        ("kind(SV) = lorry", 12, "Kinds are car, truck, bus, motorcycle, other"),
        ("kind(SV) > truck", 1, "kinds are compared with = and != only"),
        ("kind(SV, POV) = car", 1, "'kind' takes 1 argument"),
    ],
)
def test_mistakes_in_claims(claim: str, column: int, told: str) -> None:
    with pytest.raises(TextError) as raised:
        read_claim(home(), claim)
    assert told in str(raised.value)
    assert f"line 1, column {column}:" in str(raised.value)


@pytest.mark.parametrize(
    ("declared", "told"),
    [
        ("signal s(a: vehicle): m", "'s' is built in"),
        ("signal kind(a: vehicle): m", "'kind' is built in"),
        ("def kind(a: vehicle) := true", "'kind' is built in"),
        ("signal POV1: m", "'POV1' means something else"),
        ("signal time: s", "'time' means something else"),
        ("signal x(a: lane): m", "is of one vehicle or of none"),
        ("signal x: lane", "'lane' is no unit of a signal"),
        ("signal x: bool in [0, 1]", "is true or false"),
        ("signal x: m in [0, 1] derived by 1 m", "so its bounds follow"),
        ("signal x: m in [2, 2]", "low=2 is not below high=2"),
        ("signal x: m in [inf, 2]", "the wrong way round"),
        ("signal x: m in [0 s, 2]", "is in m, but its bound is in s"),
        ("signal danger: bool", "'danger' is a definition already"),
        ("signal rho: s", "'rho' is a parameter already"),
        ("param gap = 1 m", "'gap' is a signal already"),
        ("def gap(a: vehicle) := true", "'gap' is a signal"),
        ("signal x: m signal x: m", "signal 'x' is given twice"),
        ("signal x: m derived by 3 s", "is declared in m, but derived in s"),
        ("signal x: bool derived by 3 s", "is declared bool, but derived by a number"),
        ("signal x: m derived by x", "'x' is defined by itself"),
    ],
)
def test_mistakes_in_declarations(declared: str, told: str) -> None:
    with pytest.raises(TextError) as raised:
        read_claim(home(declared), "x = 1 m" if "x:" in declared else "red")
    assert told in str(raised.value)

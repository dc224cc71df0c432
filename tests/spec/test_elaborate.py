"""Names, sorts, arities, units and cycles."""

from typing import Any

import pytest

import roadproof as rp
from roadproof.errors import TextError
from roadproof.frontends.cli.main import main
from roadproof.library.diagnose import Proofreader, diagnose, diagnose_claim
from roadproof.library.elaborate import apply_definition, read_claim, signature
from roadproof.library.elaboration import Elaborator
from roadproof.library.loading import build_library, bundled_library, load_library
from roadproof.library.quantity import LARGEST_FORMULA, MOST_READ, Sizes, unit_name
from roadproof.library.specification import Query, Source, Specification
from roadproof.logic import formula as f
from roadproof.logic import terms as t
from roadproof.logic.formula import FOREVER, Formula
from roadproof.logic.parse import parse_library
from roadproof.logic.recover import parse_pieces
from roadproof.runtime.package_data import shipped_folder
from tables import read_table

BASE = bundled_library().select()
SECONDS = (0, 1)
SPEED = t.Signal("v_lon", "SV")
FAST = f.Compare(SPEED, ">", t.number(3, (1, -1)))


def read(text: str, more: str = "") -> Query:
    return read_claim(with_definitions(more) if more else BASE, text)


def with_definitions(text: str) -> Specification:
    return build_library([Source("mine.spec", text)], bundled_library()).select()


def formula(text: str, more: str = "") -> Formula:
    return read(text, more).formula


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("v_lon(SV) > 3 m/s", FAST),
        ("v_lon(SV) > 10.8 km/h", FAST),
        ("not not v_lon(SV) > 3 m/s", FAST),
        ("true and v_lon(SV) > 3 m/s", FAST),
        ("false or v_lon(SV) > 3 m/s", FAST),
        ("false -> v_lon(SV) > 3 m/s", f.TRUE),
        ("v_lon(SV) > 3 m/s -> false", f.Not(FAST)),
        ("F v_lon(SV) > 3 m/s", f.Eventually(FOREVER, FAST)),
        (
            "v_lon(SV) = 3 m/s",
            f.And((f.Compare(SPEED, "<=", FAST.right), f.Compare(SPEED, ">=", FAST.right))),
        ),
        (
            "v_lon(SV) != 3 m/s",
            f.Or((f.Compare(SPEED, "<", FAST.right), f.Compare(SPEED, ">", FAST.right))),
        ),
        (
            "G[500 ms, 1] v_lon(SV) > 3 m/s",
            f.Always(f.Interval(t.Number(t.Fraction(1, 2), SECONDS), t.number(1, SECONDS)), FAST),
        ),
        (
            "some l in lanelets(L): occ(SV, l)",
            f.Some("l", f.Domain("lanelets", "L"), f.Occupies("SV", "l")),
        ),
        ("every x in {SV}: v_lon(x) > 3 m/s", FAST),
        (
            "abs(v_lon(SV)) > 3 m/s",
            f.Compare(t.Maximum((SPEED, t.negate(SPEED))), ">", FAST.right),
        ),
    ],
)
def test_formulas(text: str, expected: Formula) -> None:
    assert formula(text) == expected


def test_calls_are_named_and_substituted() -> None:
    made = formula("near(POV, SV)", "def near(a, b: vehicle) := s(a) <= s(b)")
    body = f.Compare(t.Signal("s", "POV"), "<=", t.Signal("s", "SV"))
    assert made == f.Application("near", ("POV", "SV"), body)


def test_functions_of_numbers_are_put_in_place() -> None:
    made = formula("v_lon(SV) > twice(1.5 m/s)", "def twice(v: m/s) := v + v")
    half = t.Number(t.Fraction(3, 2), (1, -1))
    assert made == f.Compare(SPEED, ">", t.Sum((half, half)))


def test_quantified_vehicles() -> None:
    made = formula("(some x in {SV, POV}: v_lon(x) > 3 m/s)")
    other = f.Compare(t.Signal("v_lon", "POV"), ">", FAST.right)
    assert made == f.Or((FAST, other))


def test_groups_take_what_other_arguments_leave() -> None:
    text = "def all(a: vehicle, others: vehicles, L: lane) := every x in others: aheadOf(a, x)"
    made = formula("all(SV, POV1, POV2, L)", text)
    assert isinstance(made, f.Application)
    assert isinstance(made.body, f.And)
    assert [part.arguments for part in made.body.parts if isinstance(part, f.Application)] == [
        ("SV", "POV1"),
        ("SV", "POV2"),
    ]


def test_bound_variables_never_capture_arguments() -> None:
    made = read("given M: lane: inAdjLanes(SV, POV, M)").formula
    assert isinstance(made, f.Application)
    assert isinstance(made.body, f.And)
    inner = made.body.parts[1]
    assert isinstance(inner, f.Some)
    assert inner.domain == f.Domain("adjacent", "M")
    assert inner.variable != "M"
    assert isinstance(inner.body, f.Application)
    assert inner.body.arguments == ("POV", inner.variable)


def test_free_names_are_reported() -> None:
    query = read("given A: vehicle; K: lane: laneKeep(A, K) and aheadOf(A, POV3) and laneKeep(SV, L2)")
    assert set(query.vehicles) == {"A", "POV3", "SV"}
    assert set(query.lanes) == {"K", "L2"}
    assert query.text.startswith("given A")


def test_given_numbers_are_variables() -> None:
    made = formula("given v: m/s: v_lon(SV) > v")
    assert made == f.Compare(SPEED, ">", t.Variable("v", (1, -1)))


def test_definitions_of_other_sets() -> None:
    ours, theirs = formula("accel(POV, SV, L)"), formula("accel@ext(POV, SV, L)")
    assert isinstance(theirs, f.Application)
    assert theirs.name == "accel@ext"
    assert theirs.body != ours
    ext = bundled_library().select("ext")
    assert read_claim(ext, "accel(POV, SV, L)").formula.body == theirs.body  # type: ignore[union-attr]
    # What does not differ between the sets keeps its plain name, so that it stays one atom.
    assert formula("danger@ext(SV, POV)") == formula("danger(SV, POV)")
    assert formula("danger@base(SV, POV)") == formula("danger(SV, POV)")


@pytest.mark.parametrize(
    ("text", "column", "message"),
    read_table(__file__, "mistakes"),
)
def test_mistakes(text: str, column: int, message: str) -> None:
    with pytest.raises(TextError, match=message.replace("(", r"\(").replace(")", r"\)")) as raised:
        read(text)
    assert raised.value.position is not None
    assert raised.value.position.column == column


@pytest.mark.parametrize(
    ("text", "cycle"),
    [
        ("def p(a: vehicle) := F p(a)", "p -> p"),
        ("def p(a: vehicle) := q(a) def q(a: vehicle) := not p(a)", "p -> q -> p"),
    ],
)
def test_cycles(text: str, cycle: str) -> None:
    with pytest.raises(TextError, match=f"is defined by itself: {cycle}"):
        formula("p(SV)", text)


def test_long_chains_are_refused_before_the_stack_ends() -> None:
    chain = "def p_0(a: vehicle) := true each i in 1..900 { def p_{i}(a: vehicle) := p_{i-1}(a) }"
    assert formula("p_50(SV)", chain)
    with pytest.raises(TextError, match="nested deeper than 100"):
        formula("p_900(SV)", chain)


def test_a_chain_is_refused_whatever_was_read_before() -> None:
    chain = "def p_0(a: vehicle) := true each i in 1..120 { def p_{i}(a: vehicle) := p_{i-1}(a) }"
    home = with_definitions(chain)
    for number in (40, 80, 95):
        read_claim(home, f"p_{number}(SV)")
    for text in ("p_110(SV)", "not not not not not not p_95(SV)"):
        with pytest.raises(TextError, match="nested deeper than 100"):
            read_claim(home, text)
    assert read_claim(home, "p_95(SV) and p_40(POV)").vehicles == ("POV", "SV")


DOUBLING = (
    "def p_0(a: vehicle) := v_lon(a) > 0 each i in 1..60 "
    "{ def p_{i}(a: vehicle) := p_{i-1}(a) and F p_{i-1}(a) }"
)
DOUBLED_TERMS = (
    "def q_0(a: vehicle) := s(a) each i in 1..60 { def q_{i}(a: vehicle) := q_{i-1}(a) + q_{i-1}(a) }"
)


def test_a_definition_is_elaborated_once(monkeypatch: pytest.MonkeyPatch) -> None:
    """Doubling at every level would take 2^14 steps."""
    read: list[object] = []
    whole = Elaborator._expression

    def count(self: Elaborator, expression: Any, scope: Any) -> Any:
        read.append(expression)
        return whole(self, expression, scope)

    monkeypatch.setattr(Elaborator, "_expression", count)
    assert formula("p_14(SV)", DOUBLING)
    assert len(read) < 100


@pytest.mark.parametrize(
    ("claim", "more"),
    [
        ("p_22(SV)", DOUBLING),
        ("p_39(SV)", DOUBLING),
        ("q_22(SV) > 0", DOUBLED_TERMS),
        ("q_39(SV) > 0", DOUBLED_TERMS),
        ("s(SV) > (((((((2^8)^8)^8)^8)^8)^8)^8)", ""),
        ("F[0, ((((((((2 s)^8)^8)^8)^8)^8)^8)^8)] true", ""),
    ],
)
def test_what_is_too_large_when_it_is_written_out_is_refused(claim: str, more: str) -> None:
    with pytest.raises(TextError, match=f"more than {LARGEST_FORMULA} parts once its definitions"):
        formula(claim, more)


def test_quantifiers_inside_each_other_are_refused_before_they_are_written_out() -> None:
    many = "".join(f"every v{k} in {{SV, POV}}: " for k in range(40))
    with pytest.raises(TextError, match=f"more than {MOST_READ} expressions"):
        formula(f"{many} v_lon(SV) > 0")


def test_a_power_counts_as_the_product_that_it_is() -> None:
    term = t.Power(t.Sum((t.Signal("s", "SV"), t.Signal("s", "POV"))), 4)
    assert Sizes().size(term) == 1 + 4 * 3


def test_names_inside_definitions_must_be_their_own() -> None:
    with pytest.raises(TextError, match="there is no vehicle 'SV'"):
        formula("p(POV)", "def p(a: vehicle) := v_lon(SV) > 0")


@pytest.mark.parametrize(
    ("name", "expected"),
    [
        ("scenario_1", ("SV", "POV", "L")),
        ("scenario_2", ("SV", "POV1", "POV2", "L")),
        ("scenario_18", ("SV", "POV1", "POV2", "L")),
        ("mainRoad", ("a",)),
        ("sameLane_3", ("a", "b", "c", "L")),
        ("dRSS_lon", ("v_r", "v_f")),
    ],
)
def test_signatures(name: str, expected: tuple[str, ...]) -> None:
    assert signature(BASE, name) == expected


def test_definitions_are_applied_to_names() -> None:
    swapped = apply_definition(BASE, "scenario_4", ("POV", "SV", "L"))
    assert swapped.formula == formula("scenario_4(POV, SV, L)")
    with pytest.raises(TextError, match="there is no definition 'scenario_25'"):
        apply_definition(BASE, "scenario_25")


def test_units() -> None:
    assert [unit_name(d) for d in [(1, -2), (0, 1), (0, 0), None, (2, -2)]] == [
        "m/s^2",
        "s",
        "no unit",
        "no unit",
        "m^2*s^-2",
    ]


# --- All mistakes of a text at once: each told once, at its place, and nothing that follows from another

LIBRARY = bundled_library()
MANY = """\
param foo = 3 s
def one(SV: vehicle) := (v_lon(SV) > 3 m/s  # not closed
def two(SV: vehicle) := v_lon(SV) > 3 m and v_lon(SV) > foo
def three(SV: vehicle) := dangr(SV, SV) and one(SV) and danger(SV) or s(ego) < 3 m and two(SV)
def d(SV: vehicle, L: lan) := true
def four(SV: vehicle) := G[2 s, 1 s] true and G[1 s, nofoo] true and five(SV)
def five(SV: vehicle) := five(SV)
def six(x: vehicle, M: lan) := true
set edit extends base "x" {
  def danger(SV, POV: vehicle) := G[0, 1 s] rssViolation(SV) and three(SV)
  def nosuch(SV: vehicle) := true
  def initSafe(SV, POV: vehicle) := G[0, 1 s rssViolation(SV, POV)
}
set edit2 extends bas { def danger(SV, POV: vehicle) := true }
each i in 1..3 {
  def x_{i}(SV: vehicle) := y_{i}(SV) and d(SV, L)
}
param neg = -1 s where neg > 0
def group(SV: vehicle, POV: vehicles) := every x in POV: danger(SV, x) and one(x) and G[0, neg] true
def one(SV: vehicle) := true
set last extends base {
  def danger(SV, POV: vehicle) := rssViolation(SV, POV) and nosuch(SV)
"""
WRONG = read_table(__file__, "wrong")


def said(diagnostics) -> list[tuple[int, int, str]]:
    return [(x.line, x.column, x.message) for x in diagnostics if x.severity == "error"]


def matches(found, wanted):
    return [x[:2] for x in found] == [x[:2] for x in wanted] and all(
        message.startswith(start) for (_, _, message), (_, _, start) in zip(found, wanted, strict=True)
    )


def test_each_mistake_is_told_once_in_order():
    found = said(diagnose(MANY, LIBRARY).diagnostics)
    assert matches(found, WRONG), found


def test_the_exception_carries_all_and_the_command_line_prints_them(tmp_path, capsys):
    file = tmp_path / "many.spec"
    file.write_text(MANY, "utf-8")
    for ask in (lambda: rp.load(specs=[file]), lambda: rp.load(specs=[MANY])):
        with pytest.raises(rp.TextErrors) as caught:
            ask()
        places = [(x.position.line, x.position.column, x.message) for x in caught.value.errors]
        assert matches(places, WRONG)
    assert main(["show", "4", "--spec", str(file)]) == 3
    printed = capsys.readouterr().err
    told = [line.partition(": ")[0] for line in printed.splitlines() if "many.spec, line" in line]
    assert len(told) == len(WRONG)
    assert printed.count("^\n") == len(WRONG)
    assert printed.startswith(
        f"roadproof: {file}, line 2, column 43: the statement ends too early\n  def one"
    )


def test_all_mistakes_of_a_formula():
    text = "dangr(SV,POV) and danger(SV) -> v_lon(SV) > 3 and (some M in lane: G[0, 1 m] true)"
    found = [(1, 1), (1, 19), (1, 33), (1, 51), (1, 70)]
    errors = diagnose_claim(text, LIBRARY.select())
    assert [(x.line, x.column) for x in errors][:3] == found[:3]
    assert (errors[0].end_line, errors[0].end_column) == (1, 14)
    with pytest.raises(rp.TextErrors) as caught:
        rp.prove(text)
    assert len(caught.value.errors) == len(errors)
    with pytest.raises(rp.TextError) as one:
        rp.prove("dangr(SV,POV)")
    assert not isinstance(one.value, rp.TextErrors)


def test_the_library_has_no_mistake_and_reads_alike_in_pieces():
    folder = shipped_folder("models").parent / "src/roadproof/library/sets"
    files = sorted(folder.glob("*.spec"))
    assert files
    for file in files:
        text = file.read_text("utf-8")
        pieces = parse_pieces(text, file.name)
        assert (pieces.statements, pieces.errors) == (parse_library(text, file.name), ())
        errors = [x for x in diagnose(text, load_library(), file.name).diagnostics if x.severity == "error"]
        assert errors == []


@pytest.mark.parametrize(
    "text",
    [
        "",
        "# nothing",
        "}",
        "{",
        "def",
        "def a",
        'param p = 1 s "x\ndef b(SV: vehicle) := true',
        "set a extends base {\nset b extends base {\n}\n}",
        "each i in 1..2 {\ndef a_{i}(SV: vehicle) := b_{j}(SV)\n}",
        "each i in 5..2 {\ndef a_{i}(SV: vehicle) := true\n}",
        "when nosuch = rss {\ndef danger(SV, POV: vehicle) := true\n}",
        "\ufeffdef a(SV: vehicle) := true",
        "def a(SV: vehicle) := " + "(" * 500,
        "def a(SV, POV: vehicle) := " + "not " * 300 + "danger(SV, POV)",
        'title of 4 "x"\nlane of POV for 4',
        "def f(u: m/s) := u\ndef g(SV: vehicle) := f(v_lon(SV)) > 3 s",
        "def f(u, v: m/s) := u / (v - u)\ndef g(x: vehicle, u: s) := G[0, u] f(2 m/s, 3 m/s) < 0",
    ],
)
def test_whatever_is_typed_is_answered(text):
    """Each has an error exactly where loading it fails."""
    found = [x for x in diagnose(text, LIBRARY).diagnostics if x.severity == "error"]
    lines = text.split("\n")
    assert all(1 <= x.line <= len(lines) and (x.line, x.column) < (x.end_line, x.end_column) for x in found)
    try:
        rp.load(specs=[text + "\n"])
        failed = False
    except rp.InputError:
        failed = True
    assert failed == bool(found)


def test_a_proofreader_says_the_same_after_each_change():
    """Every prefix of a text, as it is typed, against a reader that remembers nothing."""
    text = MANY[:420] + MANY[MANY.index("each i") :]
    reader = Proofreader(LIBRARY)
    for end in range(0, len(text), 23):
        now = reader.read(text[:end])
        fresh = Proofreader(LIBRARY).read(text[:end])
        assert now.diagnostics == fresh.diagnostics
    replaced = "def danger(SV, POV: vehicle) := rssViolation(SV, POV)\ndef mine(SV, POV: vehicle) := {}"
    for body in ("danger(SV, POV)", "danger(SV)", "initSafe(SV, POV, L)", "scenario_4(SV, POV)"):
        now = reader.read(replaced.format(body))
        assert now.diagnostics == Proofreader(LIBRARY).read(replaced.format(body)).diagnostics
        assert [x.severity for x in now.diagnostics] == ["info", *["error"] * (body != "danger(SV, POV)")]

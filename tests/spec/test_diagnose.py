"""All mistakes of a text at once: each told once, at its place, and nothing that follows from another."""

import pytest

import roadproof as rp
from roadproof.frontends.cli.main import main
from roadproof.library.diagnose import Proofreader, diagnose, diagnose_claim
from roadproof.library.loading import bundled_library, load_library
from roadproof.logic.parse import parse_library
from roadproof.logic.recover import parse_pieces
from roadproof.runtime.package_data import shipped

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
WRONG = [
    (2, 43, "the statement ends too early"),
    (3, 25, "m/s and m cannot be compared"),
    (3, 45, "m/s and s cannot be compared"),
    (4, 27, "there is no definition 'dangr'; did you mean 'danger'?"),
    (4, 57, "'danger' takes 2 arguments but got 1"),
    (4, 73, "there is no vehicle 'ego'; there are SV"),
    (5, 5, "'d' is built in and cannot be defined"),
    (6, 27, "the interval is empty: low=2 is above high=1"),
    (6, 54, "there is no parameter or definition 'nofoo'; did you mean 'foo'?"),
    (7, 26, "'five' is defined by itself: five -> five"),
    (8, 21, "there is no sort or unit 'lan'; did you mean 'lane'?"),
    (10, 45, "'rssViolation' takes 2 arguments but got 1"),
    (11, 7, "an override needs something to replace: there is no definition 'nosuch'"),
    (12, 46, "'rssViolation' cannot stand here"),
    (14, 1, "there is no spec set 'bas'; did you mean 'base'?"),
    (16, 29, "there is no definition 'y_1'; did you mean 'x_1'?"),
    (18, 1, "neg=-1 s: it is declared with neg > 0"),
    (22, 71, "'set last extends base {' is not closed"),
]


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
    folder = shipped("models").parent / "src/roadproof/library/sets"
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

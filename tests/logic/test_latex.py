"""LaTeX that reads like the paper's."""

import pytest

from planting import plant
from roadproof.evidence.answers.tree import claim_node
from roadproof.evidence.codec import write
from roadproof.library.loading import bundled_library
from roadproof.logic import latex as latex_module
from roadproof.logic.latex import align, latex, symbol
from roadproof.logic.parse import parse_claim

U = r"\mathbin{\mathcal{U}}"
DEFINITIONS = bundled_library().select("ext").definitions


@pytest.mark.parametrize(
    ("name", "shown"),
    [
        ("SV", r"\mathit{SV}"),
        ("POV1", r"\mathit{POV}_{1}"),
        ("L", "L"),
        ("rho", r"\rho"),
        ("v_r", "v_{r}"),
        ("a_max", r"a_{\mathrm{max}}"),
        ("b_min_lat", r"b_{\mathrm{min}}^{\mathit{lat}}"),
        ("minDanger", r"\mathit{minDanger}"),
        ("scenario_12", r"\mathit{scenario}_{12}"),
        ("accel@ext", r"\mathit{accel}^{\mathit{ext}}"),
    ],
)
def test_symbols(name: str, shown: str) -> None:
    assert symbol(name) == shown


@pytest.mark.parametrize(
    ("name", "shown"),
    [
        (
            "danger",
            r"\mathit{danger}(a,b) \;:=\; \mathcal{G}_{[0,\mathit{minDanger}]} \mathit{rssViolation}(a,b)",
        ),
        (
            "cutIn",
            r"\mathit{cutIn}(\mathit{POV},\mathit{SV},L) \;:=\;"
            r" \neg \mathit{sameLane}(\mathit{POV},\mathit{SV},L) \wedge"
            r" \mathcal{F} \left(\mathit{danger}(\mathit{SV},\mathit{POV}) \wedge"
            r" \mathcal{F}_{[0,\mathit{minDanger}]} \mathit{sameLane}(\mathit{SV},\mathit{POV},L)\right)",
        ),
        (
            "dRSS_lon",
            r"\mathit{dRSS}_{\mathit{lon}}(v_{r},v_{f}) \;:=\;"
            r" \max\left(0,v_{r} \rho + \frac{a_{\mathrm{max}} \rho^{2}}{2}"
            r" + \frac{\left(v_{r} + a_{\mathrm{max}} \rho\right)^{2}}{2 b_{\mathrm{min}}} -"
            r" \frac{v_{f}^{2}}{2 b_{\mathrm{max}}}\right)",
        ),
        ("fasterThan", r"\mathit{fasterThan}(a,b) \;:=\; v_{\mathit{lon},a} < v_{\mathit{lon},b}"),
        ("atLane", r"\mathit{atLane}(a,L) \;:=\; \bigvee_{l\in L} \mathit{occ}(a,l)"),
        (
            "onMainRoad",
            r"\mathit{onMainRoad}(a) \;:=\; \bigvee_{\mathit{zone}(l)=\mathit{main}} \mathit{occ}(a,l)",
        ),
        ("mainRoad", r"\mathit{mainRoad}(a) \;:=\; \bigwedge_{x\in a} \mathit{onMainRoad}(x)"),
        (
            "behaviourSV_4",
            r"\mathit{behaviourSV}_{4}(\mathit{SV},\mathit{POV},L) \;:=\; \mathit{laneKeep}(\mathit{SV},L)"
            r" \mathbin{\mathcal{U}} \mathit{danger}(\mathit{SV},\mathit{POV})",
        ),
    ],
)
def test_definitions_read_like_the_paper(name: str, shown: str) -> None:
    assert latex(DEFINITIONS[name]) == shown


@pytest.mark.parametrize(
    ("text", "shown"),
    [
        ("true -> false", r"\top \Rightarrow \bot"),
        ("(a or b) and not (c and d)", r"\left(a \vee b\right) \wedge \neg \left(c \wedge d\right)"),
        ("a U[1 s, inf] b", r"a \mathbin{\mathcal{U}_{[1\,\mathrm{s},\infty]}} b"),
        (
            "some M in adjacentLanes(L): a and b",
            r"\bigvee_{M\in\mathit{adjLanes}(L)} \left(a \wedge b\right)",
        ),
        ("every x in {SV, POV2}: a", r"\bigwedge_{x\in\{\mathit{SV},\mathit{POV}_{2}\}} a"),
        ("(a / b)^2 >= 2 * 3", r"\left(\frac{a}{b}\right)^{2} \ge 2 \cdot 3"),
        ("F (a U b)", rf"\mathcal{{F}} \left(a {U} b\right)"),
        ("G[0, 1 s] (a U b)", rf"\mathcal{{G}}_{{[0,1\,\mathrm{{s}}]}} \left(a {U} b\right)"),
        ("not (a U b)", rf"\neg \left(a {U} b\right)"),
        ("F a U b", rf"\mathcal{{F}} a {U} b"),
        ("(a U b) U c", rf"\left(a {U} b\right) {U} c"),
        ("a U (b and c)", rf"a {U} \left(b \wedge c\right)"),
        ("(a and b) U c", rf"\left(a \wedge b\right) {U} c"),
        ("F (a -> b)", r"\mathcal{F} \left(a \Rightarrow b\right)"),
        ("F (a < b)", r"\mathcal{F} a < b"),
        ("every x in {SV}: (a U b)", rf"\bigwedge_{{x\in\{{\mathit{{SV}}\}}}} \left(a {U} b\right)"),
        ("a * (b + c) != a / (b + c)", r"a \left(b + c\right) \neq \frac{a}{b + c}"),
        ("inverse(a - b) <= abs(c)", r"\frac{1}{a - b} \le \left|c\right|"),
        ("a < 25 km/h", r"a < 25\,\mathrm{km}/\mathrm{h}"),
    ],
)
def test_formulas(text: str, shown: str) -> None:
    assert latex(parse_claim(text)) == shown


PARENTHESES = [
    (r"{_bounds(bounds)} {_show(right, UNARY)}", r"{_bounds(bounds)} {_show(right, UNTIL)}"),
    (r"\neg {_show(body, UNARY)}", r"\neg {_show(body, UNTIL)}"),
    ("{_show(left, UNARY)} {until}", "{_show(left, UNTIL)} {until}"),
    ("{_show(right, UNTIL)}", "{_show(right, AND)}"),
    (
        "{_range(symbol(variable), domain)}}} {_show(body, UNARY)}",
        "{_range(symbol(variable), domain)}}} {_show(body, OR)}",
    ),
]


@pytest.mark.parametrize(("right", "wrong"), PARENTHESES)
def test_parentheses_that_are_lost_are_noticed(
    right: str, wrong: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    texts = ["F (a U b)", "not (a U b)", "(a U b) U c", "a U (b and c)", "every x in {SV}: (a U b)"]
    shown = [latex(parse_claim(text)) for text in texts]
    plant(monkeypatch, latex_module, "_operator", right, wrong)
    assert [latex(parse_claim(text)) for text in texts] != shown


def test_align_puts_definitions_below_each_other() -> None:
    shown = align([DEFINITIONS["front"], DEFINITIONS["accelerates"]])
    assert shown.splitlines() == [
        r"\begin{align*}",
        r"\mathit{front}(a) &\;:=\; s_{a} \\",
        r"\mathit{accelerates}(a) &\;:=\; a_{\mathit{lon},a} > 0",
        r"\end{align*}",
    ]


def test_braces_balance_in_every_definition() -> None:
    for definition in DEFINITIONS.values():
        shown = latex(definition).replace(r"\{", "").replace(r"\}", "")
        assert shown.count("{") == shown.count("}")
        assert shown.count(r"\left(") == shown.count(r"\right)")


def test_tree_is_plain_data() -> None:
    claim = parse_claim("given v: m/s: some x in {SV}: G[0, 0.5 s] (not p(x) U v > 1 m/s)")
    assert write(claim_node(claim)) == {
        "node": "claim",
        "given": [{"name": "v", "sort": "m/s"}],
        "body": {
            "node": "some",
            "variable": "x",
            "domain": {"node": "group", "members": ["SV"]},
            "body": {
                "node": "G",
                "low": {"node": "number", "value": "0", "unit": ""},
                "high": {"node": "number", "value": "1/2", "unit": "s"},
                "body": {
                    "node": "U",
                    "low": {"node": "number", "value": "0", "unit": ""},
                    "high": None,
                    "left": {"node": "not", "body": {"node": "call", "name": "p", "arguments": [
                        {"node": "name", "name": "x"}
                    ]}},
                    "right": {
                        "node": ">",
                        "left": {"node": "name", "name": "v"},
                        "right": {"node": "number", "value": "1", "unit": "m/s"},
                    },
                },
            },
        },
    }  # fmt: skip

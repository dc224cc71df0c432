"""The extracted program: whether it is what Coq extracts, and what it reads, accepts and refuses."""

import random
from collections import Counter
from dataclasses import replace
from fractions import Fraction
from functools import cache
from pathlib import Path

import pytest

import roadproof as rp
from cli.test_schemas import validator
from extensions.kernel import raw
from extensions.kernel.drives import ROAD
from extensions.kernel.extract import extracted
from extensions.kernel.needs import needs_coq, needs_ocaml
from extensions.kernel.reader_faults import FAULTS
from extensions.kernel.test_accept import ODD, ONE, PROOFS
from extensions.kernel.test_drives import DRIVES, changed, derivation_of, with_one_missing
from extensions.kernel.test_refused import CHANGES, EACH, FALSE, donors, exchange, on_roads
from extensions.kernel.test_theories import library_formulas
from roadproof.evidence.certificate_file import read_certificate
from roadproof.evidence.finding import Acceptance
from roadproof.evidence.judged import judge_file
from roadproof.extensions.kernel import coq, ocaml
from roadproof.extensions.kernel import extracted as extracted_text
from roadproof.extensions.kernel.accept import CoqModule, prepare
from roadproof.extensions.kernel.constructors import Writer
from roadproof.extensions.kernel.drive import drive_claim_text, drive_statement
from roadproof.extensions.kernel.extracted import drive, judge, proof
from roadproof.extensions.kernel.source import Module
from roadproof.extensions.kernel.statement import state
from roadproof.frontends.api.checking import check
from roadproof.frontends.cli.main import main
from roadproof.library.bind import bind
from roadproof.library.loading import bundled_library
from roadproof.logic.rewrite import without_names
from roadproof.semantics.exact import judge as judge_drive

SOURCES = PROOFS / "kernel" / "ocaml"
READER = (SOURCES / "reader.ml").read_text("ascii")
ECHO = Path(__file__).with_name("echo.ml")


@needs_coq
def test_the_shipped_checker_is_what_coq_extracts():
    assert extracted() == (SOURCES / "checker.ml").read_bytes(), "run: make generated"


# --- what is accepted ------------------------------------------------------------------------------


@needs_ocaml
def test_every_shipped_proof_and_drive_is_accepted():
    checked = check(PROOFS, kernel="extracted", jobs=1)
    said = Counter(x.kernel for x in checked.findings if x.kind in ("certificate", "drive"))
    assert said == {"accepted": 161}
    assert not [*validator("check.json").iter_errors(checked.as_data())]
    assert "accepted by the extracted program and the exact judge" in str(checked)


@needs_ocaml
def test_drives_of_all_eight_scenarios_are_accepted():
    checked = check(*DRIVES, kernel="extracted", jobs=1)
    assert [(x.outcome, x.kernel) for x in checked.findings] == [(Acceptance.ACCEPTED, "accepted")] * 8


@needs_ocaml
def test_claims_that_quantify_over_lanes_are_accepted(tmp_path):
    """Whose proof speaks of any lane, since every road has one; or of an atom inside a quantifier."""
    claims = (
        "some M in lanes: atLane(SV,M) -> some N in lanes: atLane(SV,N)",
        "some M in lanes: atLane(SV,M) -> every N in lanes: atLane(SV,N)",
        "(every M in lanes: atLane(SV,M)) -> (some N in lanes: atLane(SV,N))",
        "(some M in lanes: v_lon(SV) > 3 m/s) -> some N in lanes: v_lon(SV) > 2 m/s",
        "(F some M in lanes: G v_lon(SV) > 3 m/s) -> F v_lon(SV) > 2 m/s",
    )
    rp.prove(*claims, jobs=1, out=tmp_path)
    checked = check(tmp_path, kernel="extracted", jobs=1)
    assert [(x.outcome, x.kernel) for x in checked.findings] == [(Acceptance.ACCEPTED, "accepted")] * 5


ANY_OTHER = '(proof b "" [] [] (Truth true) [] [] [] (CloseTruth 0))'


@needs_ocaml
def test_odd_names_and_premises_of_motion(tmp_path):
    """Names that are words of the text, claims that would end a string, and what is said of premises."""
    spec = tmp_path / "odd.spec"
    spec.write_text(ODD, "utf-8")
    claims = [
        f'proved(SV,POV,L) -> F[0, 0 s] valid(SV, POV) # ") {ANY_OTHER} "',
        "G[0, Axiom] Qed(SV) -> G[0, Axiom] F bounds(SV)",
    ]
    found = rp.prove(*claims, using=rp.load(specs=[spec]), kernel="extracted", drive=False, jobs=1)
    assert [str(x) for x in found.kernel.rulings.values()] == ["accepted", "accepted"]
    claim = "G v_lon(SV) <= v_lon(POV) and s(SV) < s(POV) -> G s(SV) < s(POV)"
    moving = rp.prove(claim, assume="motion", kernel="extracted", jobs=1)
    assert not [*validator("verdicts.json").iter_errors(moving.as_data())]
    assert moving.as_data()["verdicts"][0]["kernel"] == {"says": "accepted", "reason": "", "premises": 0}
    assert moving.as_data()["kernel"]["ocaml"]


def test_without_ocaml_it_is_said_before_any_work(monkeypatch, tmp_path, capsys):
    monkeypatch.setenv("PATH", str(tmp_path))
    assert main(["check", str(ONE), "--kernel", "extracted", "--jobs", "1"]) == 4
    assert "apt-get install -y ocaml" in capsys.readouterr().err


# --- what is refused -------------------------------------------------------------------------------


def verdicts(modules):
    """The words of the program on modules, in their order, and nothing of others."""
    with ocaml.ready() as program:
        rulings = judge(program, {x.name: CoqModule(x) for x in modules}).rulings
    assert set(rulings) == {x.name for x in modules}
    return [str(rulings[x.name]) for x in modules]


@needs_ocaml
def test_no_tableau_of_another_claim_proves_a_false_one():
    modules, truths = [], []
    for certificate, tableau in (*donors().values(), exchange()):
        for claim in (certificate.claim, *FALSE):
            other = state(replace(certificate, claim=claim), bundled_library())
            modules.append(proof(f"n{len(modules)}", other, tableau))
            truths.append("accepted" if claim == certificate.claim else "refused")
    assert truths.count("refused") >= 110
    assert verdicts(modules) == truths


@needs_ocaml
def test_changed_tableaux_are_refused_kind_by_kind():
    tried = Counter()
    for name, (certificate, tableau) in {**donors(), "on roads": on_roads()}.items():
        r = random.Random(name)
        found = [(k, change(tableau, r)) for k, change in CHANGES.items() for _ in range(EACH)]
        others = [(kind, new) for kind, new in found if new not in (None, tableau)]
        statement = state(certificate, bundled_library())
        modules = [proof(f"n{k}", statement, x) for k, (_, x) in enumerate([("", tableau), *others])]
        assert verdicts(modules) == ["accepted", *["refused"] * len(others)]
        tried.update(kind for kind, _ in others)
    assert min(tried.values()) >= EACH
    assert tried.total() >= 300


@needs_ocaml
def test_a_fact_that_its_reason_does_not_show_is_named():
    certificate = read_certificate(PROOFS / "P7-left-base.json")
    made = prepare("one", certificate, bundled_library(), proof).module
    assert verdicts([made]) == ["accepted"]
    assert made.text.count("(Reads 0 ") >= 1
    other = replace(made, text=made.text.replace("(Reads 0 ", "(Reads 1 ", 1))
    assert verdicts([other]) == ["unknown (lemma 1)"]
    certificate = read_certificate(PROOFS / "P3-scenario-03-extA.json")
    (lemma,) = certificate.lemmas
    false = replace(lemma, literals=tuple((name, not positive) for name, positive in lemma.literals))
    made = prepare("one", replace(certificate, lemmas=(false,)), bundled_library(), proof).module
    assert verdicts([made]) == ["unknown (lemma 1)"]


@needs_ocaml
def test_only_the_very_guarantee_is_known_by_name(monkeypatch):
    """With weaker bounds or another comparison or number it is another fact. No reason is searched for it."""
    monkeypatch.setattr(extracted_text, "find_instant_proof", lambda *_: None)
    text = prepare("n0", read_certificate(PROOFS / "P9-base.json"), bundled_library(), proof).module.text
    others = [("above_0", "at_least_0"), ('"gap")) GT', '"gap")) GE'), ("(q 2 1)", "(q 1 1)")]
    texts = [text, *(text.replace(a, b).replace("n0", f"n{k}") for k, (a, b) in enumerate(others, 1))]
    assert all(old in text for old, _ in others)
    modules = [Module(f"n{k}", x, (), 0) for k, x in enumerate(texts)]
    assert verdicts(modules) == ["accepted", *["unknown (lemma 1)"] * 3]


@needs_ocaml
def test_changed_drives_and_derivations_are_refused():
    what, derivation = derivation_of(DRIVES[0])
    bound = bind(what.formula, what.file.road, what.file.lanes, what.values)
    text = drive_claim_text(what)
    others = [x for x in changed(what.file.drive) if not judge_drive(bound, x).holds]
    modules = [drive("n0", what, text, derivation)]
    for x in others:
        made = replace(what, file=replace(what.file, drive=x))
        modules.append(drive(f"n{len(modules)}", made, text, derivation))
    for step in with_one_missing(derivation):
        modules.append(drive(f"n{len(modules)}", what, text, step))
    library = bundled_library()
    for claim in ("not scenario_4(SV, POV, L)", "G scenario_4(SV, POV, L)", "scenario_3(SV, POV, L)"):
        other = replace(what.file, formula=claim)
        if not judge_file(other, library).accepted:
            modules.append(drive(f"n{len(modules)}", drive_statement(other, library), text, derivation))
    assert len(modules) >= 100
    assert verdicts(modules) == ["accepted", *["refused"] * (len(modules) - 1)]


def rulings_of(script, folder, *texts):
    """The words on modules n0, n1 and so on with these texts, by a program that is a script."""
    path = folder / "kernel"
    path.write_text(f"#!/bin/sh\n{script}\n", "ascii")
    path.chmod(0o700)
    prepared = {f"n{k}": CoqModule(Module(f"n{k}", text, (), 0)) for k, text in enumerate(texts)}
    return [str(x) for x in judge(ocaml.ExtractedProgram(path, "4.13.1"), prepared).rulings.values()]


@pytest.mark.parametrize(
    "script",
    [
        "echo n0 accepted; exit 1",
        "echo n0 accepted; kill -9 $$",
        "echo n1 accepted",
        "echo n0 refused; echo n0 accepted",
        "echo n0 accepted; echo n1 accepted",
        "echo n0 accepted anyway",
        "echo n0 Accepted",
        "true",
    ],
)
def test_a_program_that_fails_or_answers_otherwise_accepts_nothing(script, tmp_path):
    assert rulings_of(script, tmp_path, "") == ["unknown"]


def test_one_on_which_the_program_fails_does_not_take_others_with_it(tmp_path):
    script = 'asked=$(cat); case "$asked" in *bad*) exit 2;; *) echo "$asked accepted";; esac'
    assert rulings_of(script, tmp_path, "n0", "bad", "n2") == ["accepted", "unknown", "accepted"]


STILL = "(0 0 [] 0) (0 0 [] 0)"
RECTANGLE = '"l" main None None 0 1'
UNREAD = [
    '(proof a "" [] [] (Truth yes) [] [] [] (CloseTruth 0))',
    '(proof a "" [] [] (Or (Truth true)) [] [] [] (CloseTruth 0))',
    '(proof a "" [] [] "p" [] [] [] (CloseTruth 0))',
    '(proof a "" [] ["p" (Truth true); "p" (Truth false)] "p" [] [] [] (CloseTruth 0))',
    '(proof a "" [] [] (Truth true) [] [] [] (CloseTruth -1))',
    '(proof a "" [] [] (Truth true) [] [] [] (CloseTruth 0x0))',
    '(proof a "" [] [] (Truth true) [] [] [] (CloseTruth 0) (CloseTruth 0))',
    '(proof a "" [] [] (Compare (Fin (Num 1)) EQ (Fin (Num 1))) [] [] [] (CloseTruth 0))',
    '(proof a "" [] [] (Compare (Fin (Num (q 1 0))) LE (Fin (Num 1))) [] [] [] (CloseTruth 0))',
    '(proof a "" [] [] (Compare (Fin (Num (q 1 -2))) LE (Fin (Num 1))) [] [] [] (CloseTruth 0))',
    f'(drive a "" [] [] (Truth true) (["A" car 0 1 {STILL}] [{RECTANGLE}] [] [] [] [] None) Plain)',
    f'(drive a "" [] [] (Truth true) (["A" car 1 1 {STILL}] [] [] [] [] [] None) Plain)',
    "(else a)",
]
BROKEN = ["(proof a", "(proof a))", '(proof a "', "(proof a [1; 2)", "proof", "()"]


@needs_ocaml
def test_what_is_no_form_is_not_read():
    with ocaml.ready() as program:
        said = [program.run(text) for text in UNREAD]
        broken = [program.run(text) for text in BROKEN]
    assert [x.output[:9] for x in said] == ["a unread:"] * len(UNREAD)
    assert [(x.code, x.output) for x in broken] == [(2, "")] * len(BROKEN)


# --- what is read ----------------------------------------------------------------------------------
# Written by constructors.py, read by reader.ml and printed by echo.ml, a formula is what raw.py says of it.


def written(formula):
    writer = Writer()
    claim = writer.formula(formula)
    return f"(formula [{'; '.join(writer.definitions)}] {claim})"


def compiler():
    """That to bytecode, which takes a third of the time."""
    return str(Path(ocaml.find_ocamlopt()[0]).with_name("ocamlc"))


@pytest.fixture(scope="module")
def compiled(tmp_path_factory):
    """A folder with the compiled checker, and echo.ml."""
    folder = tmp_path_factory.mktemp("echo")
    for source in (SOURCES / "checker.ml", ECHO):
        (folder / source.name).write_bytes(source.read_bytes())
    assert coq.run_program([compiler(), "-w", "-a", "-c", "checker.ml"], folder).code == 0
    return folder


def echoed(folder, texts, reader):
    """What a reader of that text has read; each of ``texts`` is a form."""
    (folder / "reader.ml").write_text(reader, "ascii")
    sources = ["checker.cmo", "reader.ml", "echo.ml"]
    ran = coq.run_program([compiler(), "-w", "-a", "-o", "echo", *sources], folder)
    assert (ran.code, ran.errors) == (0, "")
    asked = " ".join(" ".join(texts).split()) + "\n"
    return coq.run_program([str(folder / "echo")], folder, asked.encode("ascii")).output.splitlines()


def exact(value):
    return f"(Qmake ({value.numerator}) {value.denominator})"


def listed(items):
    return f"[{'; '.join(items)}]"


def course(place, speed, motion, rate, jerk):
    rates = [(p.duration, getattr(p, rate), jerk(p)) for p in motion.pieces]
    pieces = listed(f"({exact(d)} {exact(a)} {exact(j)})" for d, a, j in rates[:-1])
    return f"({exact(place)} {exact(speed)} {pieces} {exact(rates[-1][1])})"


def expected_drive(what):
    """The drive of a file, field by field, written apart from extracted.py."""
    text, file = raw.text, what.file
    bodies = [
        f"({text(name)} {x.kind or 'other'} {exact(x.length)} {exact(x.width)} "
        f"{course(x.s, x.v_lon, x, 'a_lon', lambda p: p.j_lon)} "
        f"{course(x.d, x.v_lat, x, 'a_lat', lambda _: Fraction(0))})"
        for name, x in file.drive.vehicles.items()
    ]
    ends = lambda x: " ".join("None" if y is None else exact(y) for y in x)  # noqa: E731
    rectangles = [
        f"({text(x.lane)} {x.zone} {ends(x.s)} {exact(x.d[0])} {exact(x.d[1])})" for x in file.road.lanelets
    ]
    beside = sorted(tuple(sorted(x)) for x in file.road.adjacent)
    pairs = [f"({text(a)} {text(b)})" for a, b in beside]
    lanes = [f"({text(a)} {text(b)})" for a, b in sorted(file.lanes.items())]
    values = [f"({text(a)} {exact(b)})" for a, b in sorted(what.values.items())]
    own = [
        f"((Own {text(n)}) {text(a)} {listed(f'({exact(at)} {exact(x)} {exact(x)})' for at, x in steps)})"
        for (n, a), steps in sorted(file.drive.custom_signals.items())
    ]
    return f"({' '.join(map(listed, (bodies, rectangles, pairs, lanes, values, own, [])))} None)"


BOUNDS = '(bounds [at_least_0 "a"; above_0 "b"; own_at_least "n" "a" (q 1 2); own_at_most "n" "" (3 # 4)])'
BOUNDS_READ = (
    '[(at_least_0 "a"%string); (above_0 "b"%string); (own_at_least "n"%string "a"%string (Qmake (1) 2)); '
    '(own_at_most "n"%string ""%string (Qmake (3) 4))]'
)
TRACE = (
    '(drive ([] ["x" main None None 0 1; "y" main None None 1 2] [] [] [] '
    '[Speed_lon "A" [0 1 2; (1 # 2) 3 4]; Place_lat "B" []] ["v" 5] (1 2)))'
)
TRACE_READ = (
    '([] [("x"%string main None None (Qmake (0) 1) (Qmake (1) 1)); '
    '("y"%string main None None (Qmake (1) 1) (Qmake (2) 1))] [] [] [] [(Speed_lon "A"%string '
    "[((Qmake (0) 1) (Qmake (1) 1) (Qmake (2) 1)); ((Qmake (1) 2) (Qmake (3) 1) (Qmake (4) 1))]); "
    '(Place_lat "B"%string [])] [("v"%string (Qmake (5) 1))] ((Qmake (1) 1) (Qmake (2) 1)))'
)

PROGRAM = (
    "(program 2 [a_column 1 -4 6; a_column 2 (-1) 0] [a_product 3 1 2] [a_row 1 [a_term 3 -1; a_term 1 5] 7] "
    "[a_row 2 [] -8] [a_leaf 1 true [a_term 1 9] 10; a_leaf 2 false [] 0; a_conjunction 3 [1; 2]; "
    "a_disjunction 4 [3; 1]] 4)"
)
PROGRAM_READ = (
    "(2 [(1 -4 6); (2 -1 0)] [(3 1 2)] [(1 [(3 -1); (1 5)] 7)] [(2 [] -8)] "
    "[(1 above [(1 9)] 10); (2 at_least [] 0); (3 all [1; 2]); (4 one [3; 1])] 4)"
)


def varied(drive):
    """The drive with jerk, kinds of vehicles and signals."""
    vehicles = {
        name: replace(
            x,
            kind=kind,
            pieces=(*(replace(p, j_lon=p.a_lon + Fraction(1, 7)) for p in x.pieces[:-1]), x.pieces[-1]),
        )
        for (name, x), kind in zip(drive.vehicles.items(), ("truck", "bus"), strict=False)
    }
    steps = ((Fraction(0), Fraction(-1, 3)), (Fraction(5, 2), Fraction(4)))
    return replace(drive, vehicles=vehicles, custom_signals={("red", ""): steps, ("blink", "SV"): steps[:1]})


@cache
def questions():
    """Forms for echo.ml with what it has to answer."""
    formulas = [*library_formulas(), *map(raw.random_formula, range(150))]
    asked = [(written(x), raw.formula(without_names(x))) for x in formulas]
    asked += [(BOUNDS, BOUNDS_READ), (TRACE, TRACE_READ), (PROGRAM, PROGRAM_READ)]
    for path in DRIVES:
        what, derivation = derivation_of(path)
        if path == DRIVES[0]:  # with ends of rectangles, jerk, kinds and signals
            what = replace(what, file=replace(what.file, road=ROAD, drive=varied(what.file.drive)))
        lines = drive("n", what, drive_claim_text(what), derivation).text.splitlines()
        first = next(k for k, line in enumerate(lines) if line.startswith(" (["))
        asked.append((f"(drive {' '.join(lines[first : first + 8])})", expected_drive(what)))
    return asked


@needs_ocaml
def test_formulas_and_drives_are_read_as_they_are_meant(compiled):
    asked = questions()
    said = echoed(compiled, [text for text, _ in asked], READER)
    assert len(said) == len(asked) >= 300
    assert said == [answer for _, answer in asked]


@needs_ocaml
@pytest.mark.parametrize(("right", "wrong"), FAULTS)
def test_a_reader_with_a_fault_reads_another_claim(right, wrong, compiled):
    assert READER.count(right) == 1
    asked = questions()
    said = echoed(compiled, [text for text, _ in asked], READER.replace(right, wrong))
    assert len(said) == len(asked)
    assert said != [answer for _, answer in asked]


@needs_ocaml
def test_a_claim_without_a_proof_leaves_nothing_to_ask():
    found = rp.prove("v_lon(SV) > 3 m/s", kernel="extracted", jobs=1)
    assert found.kernel is not None
    assert str(found.kernel).endswith(": nothing asked")
    proved = rp.prove("v_lon(SV) > 3 m/s -> v_lon(SV) > 2 m/s", kernel="extracted", jobs=1)
    assert str(proved.kernel).endswith(" s of processor time")

"""Drives put to Coq: accepted where the formula is true of them, and refused where it is not."""

import json
import re
from dataclasses import dataclass, field, replace
from fractions import Fraction
from itertools import permutations, product
from pathlib import Path

import pytest

from examples import some
from extensions.kernel import raw
from extensions.kernel.drives import agrees_with_the_judge, cases
from extensions.kernel.needs import needs_coq
from roadproof.evidence.drive_file import load_drive
from roadproof.evidence.finding import Acceptance
from roadproof.evidence.judged import judge_file
from roadproof.evidence.kernels import KernelRuling, KernelVerdict
from roadproof.extensions.kernel.accept import AXIOMS, CoqModule, axioms_of, split_evenly
from roadproof.extensions.kernel.accept import file as theory_file
from roadproof.extensions.kernel.accept import judge as accept_judge
from roadproof.extensions.kernel.coq import CoqRun, ready
from roadproof.extensions.kernel.derivation import DerivationStep, coq_derivation
from roadproof.extensions.kernel.derivations.derive import derive
from roadproof.extensions.kernel.derivations.prepare import prepare
from roadproof.extensions.kernel.drive import drive_claim_text, drive_module, drive_statement
from roadproof.extensions.kernel.source import Module, file
from roadproof.extensions.kernel.world import world_lines
from roadproof.frontends.api.checking import check
from roadproof.library.bind import bind
from roadproof.library.loading import bundled_library
from roadproof.logic.rewrite import without_names
from roadproof.reasons import ReasonKind
from roadproof.semantics.exact import judge
from roadproof.semantics.exact.algebraic import Root
from roadproof.world.drive import Drive

HOME = Path(__file__).parents[3]
DRIVES = sorted((HOME / "tests/extensions/traffic/planted").glob("scenario-*.json"))
ONE = HOME / "examples/traffic/drives/scenario-04-base.json"
THEOREM = re.compile(r"Theorem proved .*?Qed\.\n", re.DOTALL)


def size(step: DerivationStep) -> int:
    """How many rules a derivation has."""
    return 1 + sum(map(size, step.children))


def derivation_of(path):
    what = drive_statement(load_drive(path), bundled_library())
    return what, derive(what.formula, what.file.drive, what.file.road, what.file.lanes, what.values)


def refused(name, what, derivation, asked):
    """A module that says of each of ``asked``, (drive, claim, reasons) as text, that it is not accepted."""
    made = drive_module(name, what, drive_claim_text(what), derivation)
    said = [
        f"Example refused_{k} : Roadproof.Shown.accepts {drive} bounds {claim} {reasons} = false.\n"
        "Proof. vm_compute. reflexivity. Qed.\n"
        for k, (drive, claim, reasons) in enumerate(asked)
    ]
    return replace(made, text=THEOREM.sub("".join(said), made.text))


def accepted_whole(modules):
    with ready() as coq:
        ran = coq.run(file(modules))
    assert (ran.code, ran.errors) == (0, "")


@needs_coq
def test_drives_of_all_eight_scenarios_are_accepted():
    checked = check(*DRIVES, kernel="coq", jobs=1)
    assert len(DRIVES) == 8
    assert [(x.outcome, x.kernel) for x in checked.findings] == [(Acceptance.ACCEPTED, "accepted")] * 8


def test_what_is_printed_says_claim_drive_and_theorem():
    text = prepare("one", load_drive(ONE), bundled_library()).module.text
    said, _, proof = text.partition("(* From here on it is proof")
    assert "Definition claim : formula := shown_of_it and (G[0, 6] apart POV SV)." in said
    assert "Definition shown_of_it : formula := scenario_4 SV POV L." in said
    assert 'lanes_named := [\n    ("L", "main-1")\n  ];' in said
    for motion in load_drive(ONE).drive.vehicles.values():
        numbers = [motion.s, motion.v_lat, *(x for p in motion.pieces for x in (p.a_lon, p.a_lat) if x)]
        for number in numbers:
            shown_as = f"{number.numerator} # {number.denominator}" if number.denominator > 1 else str(number)
            assert shown_as in said
    assert "Theorem proved : Roadproof.Drive.shows the_drive bounds claim." in proof


@needs_coq
def test_what_the_judge_says_of_random_formulas_and_drives_coq_accepts():
    """Comparisons of any degree up to two, inverses, lanes, and all operators of time inside each other."""
    given = cases(some(60))
    agrees_with_the_judge(given, len(given) - 2)


def changed(drive):
    """The drive with one number changed, in many ways."""
    for name, motion in drive.vehicles.items():
        others = [
            replace(motion, **{x: getattr(motion, x) + by}) for x in ("s", "d", "v_lon") for by in (-9, 9)
        ]
        for place, piece in enumerate(motion.pieces[:4]):
            for a_lon in (piece.a_lon - 3, piece.a_lon + 3):
                pieces = (*motion.pieces[:place], replace(piece, a_lon=a_lon), *motion.pieces[place + 1 :])
                others.append(replace(motion, pieces=pieces))
        for other in others:
            yield Drive({**drive.vehicles, name: other})


@needs_coq
def test_a_changed_drive_on_which_the_formula_fails_is_refused():
    """With the derivation of the drive as it was."""
    modules, count = [], 0
    for path in DRIVES[:2]:
        what, derivation = derivation_of(path)
        bound = bind(what.formula, what.file.road, what.file.lanes, what.values)
        others = [x for x in changed(what.file.drive) if not judge(bound, x).holds]
        false = [replace(what, file=replace(what.file, drive=x)) for x in others]
        asked = [(" ".join(["(", *world_lines(x.world), ")"]), "claim", "reasons") for x in false]
        modules.append(refused(f"m{len(modules)}", what, derivation, asked))
        count += len(asked)
    assert count >= 20
    accepted_whole(modules)


@needs_coq
def test_another_formula_with_the_derivation_of_this_is_refused():
    library = bundled_library()
    what, derivation = derivation_of(ONE)
    claims = ["not scenario_4(SV, POV, L)", "G scenario_4(SV, POV, L)", "G not danger(SV, POV)"]
    claims += [f"scenario_{number}(SV, POV, L)" for number in (1, 3, 5, 6, 7)]
    asked = []
    for claim in claims:
        other = replace(what.file, formula=claim)
        assert not judge_file(other, library).accepted
        asked.append(
            ("the_drive", raw.formula(without_names(drive_statement(other, library).formula)), "reasons")
        )
    accepted_whole([refused("m", what, derivation, asked)])


def with_one_missing(step):
    """The derivation with each of its steps in turn put as plain."""
    if step.rule != "Plain":
        yield DerivationStep("Plain")
    for place, child in enumerate(step.children):
        for other in with_one_missing(child):
            children = (*step.children[:place], other, *step.children[place + 1 :])
            yield replace(step, children=children)


@needs_coq
def test_a_derivation_with_a_step_missing_is_refused():
    what, derivation = derivation_of(ONE)
    others = list(with_one_missing(derivation))
    assert len(others) >= size(derivation) - 5
    asked = [("the_drive", "claim", "\n".join(coq_derivation(x))) for x in others]
    accepted_whole([refused("m", what, derivation, asked)])


@needs_coq
def test_a_change_at_an_irrational_instant():
    """s(A) > 0 from the square root of 2 on: one of two holds always, and they change there."""
    motion = replace(load_drive(ONE).drive.vehicles["SV"], s=Fraction(-1), v_lon=Fraction(0))
    last = replace(motion.pieces[-1], duration=None, a_lon=Fraction(1))
    file_ = replace(
        load_drive(ONE),
        scenario=None,
        drive=Drive({"SV": replace(motion, pieces=(last,))}),
        formula="G (s(SV) > 0 m or s(SV) <= 0 m) and F (s(SV) >= 0 m) and not F[0, 1 s] s(SV) > 0 m",
    )
    what = drive_statement(file_, bundled_library())
    derivation = derive(what.formula, file_.drive, file_.road, file_.lanes, what.values)
    assert "Case" in str(derivation)
    ruling = judge_file(file_, bundled_library())
    assert any(
        isinstance(cut.point, Root) for truth in ruling.judgement.truths.values() for cut in truth.cuts
    )
    accepted_whole([drive_module("m", what, drive_claim_text(what), derivation)])


@needs_coq
def test_operators_of_time_that_change_at_one_irrational_instant_are_unknown(tmp_path):
    """Neither accepted nor rejected: the exact judge accepts it, Coq is told nothing."""
    data = json.loads(ONE.read_text("utf-8"))
    data["scenario"] = None
    data["vehicles"] = {"SV": data["vehicles"]["SV"]}
    data["vehicles"]["SV"] |= {
        "s": "-1",
        "v_lon": "0",
        "pieces": [{"duration": None, "a_lon": "1", "a_lat": "0"}],
    }
    data["formula"] = "G[0 s, 1 s] ((G[0 s, 1 s] s(SV) < 0 m) or (F[0 s, 1 s] s(SV) >= 0 m))"
    data["verdict"] = {}
    path = tmp_path / "touching.json"
    path.write_text(json.dumps(data), "utf-8")
    assert check(path).accepted
    (finding,) = check(path, kernel="coq").findings
    assert (finding.outcome, finding.kernel) == (Acceptance.UNDECIDED, str(KernelVerdict.UNKNOWN))
    assert "no derivation was found: what holds changes exactly at an irrational" in finding.reason


# --- What Coq says of several certificates at once: good, bad and silent ones, known and other axioms
# Coq is played by a program that reads the file that is put to it, so the tests need none.

KNOWN = "ClassicalDedekindReals.sig_forall_dec"
OTHER = "Coq.Logic.any"


def certificate(name: str, what: str) -> CoqModule:
    """A module of six lines, whose theorem is on the fifth; ``what`` Coq finds in it."""
    text = f"Module {name}.\n(* {what} *)\nlemma\nlemma\nTheorem proved.\nEnd {name}.\n"
    return CoqModule(Module(name, text, theorem=5, lemmas=(3, 4)))


@dataclass
class Player:
    """Plays coqc: stops at the first module that is not good, and prints what all others stand on.

    "bad" has a tableau that is refused, "slow" an error elsewhere, "silent" ends it without a place; "other"
    is good and stands on an axiom that is not known, "mute" on nothing that is said.
    """

    files: list[list[str]] = field(default_factory=list)

    def run(self, text: str) -> CoqRun:
        names = re.findall(r"^Module (\w+)\.\n\(\* (\w+) \*\)", text, re.MULTILINE)
        self.files.append([name for name, _ in names])
        said = [what for _, what in names]
        for name, what in names:
            line = text[: text.index(f"Module {name}.")].count("\n") + 5
            place = f'File "./evidence.v", line {line}, characters 0-1:\n'
            if what == "bad":
                return ran(1, "", f'{place}Error: Unable to unify "true = true" with x')
            if what == "slow":
                return ran(1, "", f"{place}Error: no")
            if what == "silent":
                return ran(1, "", "killed")
        if "mute" in said:
            return ran(0, "", "")
        axioms = [KNOWN, *([OTHER] if "other" in said else [])]
        return ran(0, "Axioms:\n" + "".join(f"{x} : forall x\n  , x\n" for x in axioms), "")


def ran(code: int, said: str, complained: str) -> CoqRun:
    return CoqRun(code=code, output=said, errors=complained, seconds=1.0, megabytes=2.0)


def rulings(*kinds: str) -> dict[str, KernelRuling]:
    made = {f"c{k}": certificate(f"c{k}", kind) for k, kind in enumerate(kinds)}
    return accept_judge(Player(), made).rulings  # type: ignore[arg-type]


WORDS = {
    "good": KernelVerdict.ACCEPTED,
    "bad": KernelVerdict.REFUSED,
    "slow": KernelVerdict.UNKNOWN,
    "silent": KernelVerdict.UNKNOWN,
}


@pytest.mark.parametrize("count", [1, 2, 3, 4])
def test_each_has_its_own_word_in_every_mixture(count: int) -> None:
    for mixed in product(WORDS, repeat=count):
        found = rulings(*mixed)
        assert [found[f"c{k}"].verdict for k in range(count)] == [WORDS[kind] for kind in mixed], mixed


def test_a_reason_is_that_of_its_own_certificate() -> None:
    for mixed in permutations(["good", "bad", "slow", "silent", "good"]):
        found = rulings(*mixed)
        reasons = {kind: found[f"c{k}"].reason for k, kind in enumerate(mixed)}
        assert reasons["good"] == ""
        assert reasons["bad"] == "the proved checker does not accept it"
        assert reasons["slow"].startswith("coqc says: Error: no")
        assert reasons["silent"] == "coqc ended without an answer: killed"


@pytest.mark.parametrize(
    ("axioms", "word"),
    [
        ((KNOWN,), KernelVerdict.ACCEPTED),
        ((), KernelVerdict.ACCEPTED),
        (tuple(sorted(AXIOMS)), KernelVerdict.ACCEPTED),
        ((OTHER,), KernelVerdict.REFUSED),
        ((KNOWN, OTHER), KernelVerdict.REFUSED),
        ((OTHER, KNOWN), KernelVerdict.REFUSED),
        ((*sorted(AXIOMS), OTHER), KernelVerdict.REFUSED),
        ((f"{KNOWN}_2",), KernelVerdict.REFUSED),
        (("sig_forall_dec",), KernelVerdict.REFUSED),
    ],
)
def test_one_other_axiom_among_known_ones_refuses_all_of_the_file(
    axioms: tuple[str, ...], word: KernelVerdict
) -> None:
    listed = "Axioms:\n" + "".join(f"{x} :\n  forall P : Prop, P\n" for x in axioms)
    said = listed if axioms else "Closed under the global context\n"

    class Says:
        def run(self, text: str) -> CoqRun:
            return ran(0, said, "")

    made = {name: certificate(name, "good") for name in ("a", "b")}
    found = accept_judge(Says(), made).rulings  # type: ignore[arg-type]
    assert {x.verdict for x in found.values()} == {word}
    for ruling in found.values():
        told = OTHER in axioms and OTHER in ruling.reason and KNOWN not in ruling.reason.split(", ")
        assert told or OTHER not in axioms
        assert ruling.axioms == (axioms if word is KernelVerdict.ACCEPTED else ())


@pytest.mark.parametrize(
    ("said", "axioms"),
    [
        ("Closed under the global context\n", ()),
        (f"Axioms:\n{KNOWN} : x\n", (KNOWN,)),
        (f"Axioms:\n{KNOWN}\n  : x\n{OTHER} : y\n", (KNOWN, OTHER)),
        ("", None),
        ("Axioms", None),
        (f"Warning: x\nAxioms:\n{KNOWN} : x\n", None),
        ("Closed under the global context\nAxioms:\nx : y\n", None),
    ],
)
def test_axioms_are_read_where_coq_lists_them_alone(said: str, axioms: tuple[str, ...] | None) -> None:
    assert axioms_of(said) == axioms


@pytest.mark.parametrize("count", [1, 2, 3, 7, 9])
def test_batches_have_each_certificate_once(count: int) -> None:
    made = {f"c{k}": certificate(f"c{k}", "good") for k in range(7)}
    parts = [*split_evenly(made, count)]
    assert sorted(name for part in parts for name in part) == sorted(made)
    assert all(part for part in parts)
    assert max(map(len, parts)) - min(map(len, parts)) <= 1


def test_what_was_not_prepared_keeps_its_refusal() -> None:
    refusal = KernelRuling(KernelVerdict.REFUSED, ReasonKind.NOT_PUT(""))
    made = {"a": CoqModule(None, 0, refusal), "b": certificate("b", "good"), "c": certificate("c", "bad")}
    player = Player()
    found = accept_judge(player, made).rulings  # type: ignore[arg-type]
    assert [found[x].verdict for x in "abc"] == [
        KernelVerdict.REFUSED,
        KernelVerdict.ACCEPTED,
        KernelVerdict.REFUSED,
    ]
    assert found["a"] is refusal
    assert all("a" not in names for names in player.files)


def test_the_head_of_a_file_has_no_module() -> None:
    assert "Module c" not in theory_file([])

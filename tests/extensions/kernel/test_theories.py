"""The theories: without warnings, without gaps, and on the axioms of Coq's real numbers alone."""

import json
import re
from dataclasses import replace
from pathlib import Path

import pytest

from extensions.exchange.exporting.shipped_drives import shipped_drives
from extensions.kernel import raw
from extensions.kernel.needs import needs_coq
from extensions.kernel.reading import SOURCES, answers, compared, monitor_theory
from roadproof.errors import InputError, RoadproofError, TextError
from roadproof.evidence.kernels import KernelRuling, KernelVerdict
from roadproof.extensions.kernel import coq as coq_module
from roadproof.extensions.kernel.accept import AXIOMS, CoqModule, axioms_of
from roadproof.extensions.kernel.coq import THEORIES, ready
from roadproof.extensions.kernel.derivations import prepare as module
from roadproof.extensions.kernel.derivations.parts import NoDerivationError
from roadproof.extensions.kernel.derivations.prepare import prepare
from roadproof.extensions.kernel.names import WORDS, comment
from roadproof.extensions.kernel.printer import FIXED_SPACE, Printer
from roadproof.extensions.kernel.source import HEAD
from roadproof.library.elaborate import read_claim
from roadproof.library.loading import bundled_library
from roadproof.logic import formula as f
from roadproof.logic import terms as t
from roadproof.logic.rewrite import without_names
from roadproof.reasons import ReasonKind
from roadproof.runtime.cache import private_folder

UNUSED = ("Sane", "Steps", "Recorded", "Monitor", "Extract")
"""Theories that no printed claim needs."""
TRUSTED = ("Meaning", "Text", "Drive", "Motion", "Recorded", "Extract", "Prescribed", "Programs")
GAPS = re.compile(
    r"\b(Admitted|admit|give_up|Axioms?|Parameters?|Conjectures?|Unset Guard|bypass_check|type_in_type)\b"
)


@pytest.mark.parametrize("name", [*THEORIES, *UNUSED])
def test_each_file_says_what_it_is_for_and_whether_it_is_trusted(name):
    text = (SOURCES / f"{name}.v").read_text("ascii")
    opening = text[: text.index("*)")]
    assert text.startswith("(* ")
    assert ("NOT TRUSTED" in opening) == (name not in TRUSTED)
    assert "TRUSTED" in opening
    code = re.sub(r"\(\*.*?\*\)", "", text, flags=re.DOTALL)
    assert not GAPS.search(code)
    assert all(len(line) <= 140 for line in text.splitlines())


def test_no_other_theory_is_there():
    assert {x.stem for x in SOURCES.glob("*.v")} == {*THEORIES, *UNUSED}


@needs_coq
def test_theories_compile_without_a_warning():
    """Those that claims need, as they were compiled for the cache, and the unused ones."""
    with ready() as coq:
        others = [coq.run((SOURCES / f"{name}.v").read_text("ascii")) for name in ("Sane", "Steps")]
        others.append(coq.run(monitor_theory()))
        complaints = json.loads((coq.theories / coq_module.WARNINGS).read_text("ascii"))
    assert [(ran.code, ran.errors) for ran in others] == [(0, "")] * 3
    assert complaints == dict.fromkeys(THEORIES, "")


@needs_coq
def test_compiled_theories_are_kept(tmp_path, monkeypatch):
    """Two of them, in a new cache. What is changed there counts no more."""
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    monkeypatch.setattr(coq_module, "THEORIES", ("Meaning", "Text"))
    said = []
    run = coq_module.run_program
    monkeypatch.setattr(coq_module, "run_program", lambda *args: said.append(run(*args)) or said[-1])
    with ready() as coq:
        assert len(said) == 3  # the version, and the theories
    assert [ran.errors for ran in said] == [""] * 3
    with ready() as again:
        assert again.theories == coq.theories
    assert len(said) == 4
    assert coq_module._is_sound(coq.theories)
    (coq.theories / "Below").mkdir()
    for name in ("Other.vo", "Text.vio", "Below/Text.vo"):
        (coq.theories / name).write_bytes(b"one more, which Coq would load")
        assert not coq_module._is_sound(coq.theories)
        (coq.theories / name).unlink()
        assert coq_module._is_sound(coq.theories)
    (coq.theories / "Text.vo").write_bytes(b"forged")
    assert not coq_module._is_sound(coq.theories)
    coq.theories.chmod(0o777)
    assert not coq_module._is_sound(coq.theories)
    (tmp_path / "roadproof" / "coq").chmod(0o777)
    assert private_folder("coq") is None


@needs_coq
def test_theorems_stand_on_known_axioms_alone():
    theorems = ["accepted", "envelopes", "motions", "settled", "answer_right", "minus_as_written"]
    theorems += [
        "accepted_at",
        "no_solution",
        "shown",
        "not_always",
        "drives_keep_apart",
        "motions_across",
        "drives_keep_apart_across",
        *("holds_of_motions", "holds_by_induction", "drives_move", "refuted"),
    ]
    theorems += ["unaided_boundary", "cut_out_boundary", "says_right", "following_boundary"]
    theorems += ["r157_boundary", "eu1426_boundary", "Known.known", "Moves.refuted", "Shown.refuted"]
    theorems += ["rss_boundary", "rss_following_boundary", "aeb_boundary"]
    with ready() as coq:
        whole = (
            "Definition whole := (" + ", ".join(f"@{x}" for x in theorems) + ").\nPrint Assumptions whole."
        )
        steps = (SOURCES / "Steps.v").read_text("ascii")
        ran = coq.run(f"{steps}\nFrom Roadproof Require Import {' '.join(THEORIES)}.\n{whole}")
    found = axioms_of(ran.output)
    assert ran.code == 0
    assert found is not None
    assert set(found) <= AXIOMS


@needs_coq
def test_a_theorem_that_is_admitted_is_told():
    """The reading of axioms can find one."""
    with ready() as coq:
        ran = coq.run("Lemma gap : 1 = 2. Admitted. Print Assumptions gap.")
    found = axioms_of(ran.output)
    assert found is not None
    assert set(found) - AXIOMS == {"gap"}


# --- What the printer says is read back by Coq as the tree that was printed (written apart in ``raw``)

# Definitions that are numbers, and not true or false; claims have them written out.
NUMBERS = {
    *("front", "rear", "dRSS_lon", "dRSS_lat", "lateralDistance", "gapAhead"),
    *("brakingDistance", "frontAtLeast", "rearAtMost"),
}


def applied(specification, name, group):
    """A definition applied to names of its own, a group of vehicles as so many."""
    declared, words = [], []
    for place, x in enumerate(specification.definitions[name].parameters, 1):
        count = group if x.sort == "vehicles" else 1
        new = [f"L{place}" if x.sort == "lane" else f"x_{place}_{k}" for k in range(count)]
        words += new
        sort = "vehicle" if x.sort == "vehicles" else x.sort
        declared += [f"{word}: {sort}" for word in new if x.sort != "lane"]
    given = f"given {'; '.join(declared)}: " if declared else ""
    return read_claim(specification, f"{given}{name}({', '.join(words)})").formula


def library_formulas():
    """Every definition of a truth value, in every set in which it means something else than in another."""
    found = {}
    for set_name in ("base", "extA", "ext"):
        specification = bundled_library().select(set_name)
        for name in sorted({*specification.definitions} - NUMBERS):
            try:
                formula = applied(specification, name, 1)
            except TextError:
                formula = applied(specification, name, 2)
            found.setdefault(without_names(formula), formula)
    return list(found.values())


def formals():
    specification = bundled_library().select()
    return {
        name: tuple((x.name, str(x.sort)) for x in definition.parameters)
        for name, definition in specification.definitions.items()
    }


@needs_coq
def test_every_definition_of_the_library_is_read_back():
    found = library_formulas()
    assert len(found) >= 150
    assert answers(compared(found, formals())) == ["true"] * len(found)


@needs_coq
def test_another_formula_is_told_from_the_printed_one():
    """The comparison above can fail: a strict comparison, a bound, an order, a name."""
    base = raw.random_formula
    changed = [
        lambda text: text.replace(" < ", " <= ", 1),
        lambda text: text.replace(" and ", " or ", 1),
        lambda text: text.replace('"SV"', '"POV"', 1),
        lambda text: re.sub(r"\bl\b(?=\))", "l_2", text, count=1),
    ]
    said = [f.Compare(t.Signal("s", "SV"), "<", t.Signal("s", "POV")), f.And((base(1), base(2)))]
    said += [f.Occupies("SV", "L"), f.Truth(True)]
    original = compared(said, {})
    told = [text for change in changed if (text := change(original)) != original]
    assert len(told) >= 3
    inside = [x.removeprefix(HEAD) for x in (original, *told)]
    found = answers(HEAD + "".join(f"Module c{k}.\n{x}End c{k}.\n" for k, x in enumerate(inside)))
    first, *others = (found[i : i + len(said)] for i in range(0, len(found), len(said)))
    assert first == ["true"] * len(said)
    assert [x.count("false") for x in others] == [1] * len(told)


def test_a_definition_is_printed_as_a_function_once():
    query = read_claim(bundled_library().select(), "dangerArises(SV, POV)")
    printer = Printer(formals())
    assert printer.formula(query.formula).replace(FIXED_SPACE, " ") == "dangerArises SV POV"
    printed = "\n".join(printer.definitions).replace(FIXED_SPACE, " ")
    assert "Definition danger (a b : vehicle) : formula := G[0, minDanger] rssViolation a b." in printed
    assert printed.count("Definition dangerAhead ") == 1


@pytest.mark.parametrize(
    "name", ["valid", "Qed", "forall", "F", "and", "claim", "Roadproof", "eq_refl", "max"]
)
def test_a_definition_called_like_a_word_of_the_file_is_called_otherwise(name):
    assert name in WORDS
    printer = Printer()
    shown = printer.formula(f.Application(name, ("a",), f.Compare(t.Signal("s", "a"), "<", t.number(0))))
    assert shown.split(FIXED_SPACE)[0] == f"{name}_2"


def test_an_argument_is_no_word_that_the_body_says():
    """def s(danger: vehicle) would be read as another thing."""
    body = f.Compare(t.Signal("s", "rho"), "<", t.Parameter("rho"))
    printer = Printer({"near": (("rho", "vehicle"),)})
    printer.formula(
        f.And((f.Compare(t.Parameter("rho"), ">", t.number(0)), f.Application("near", ("rho",), body)))
    )
    assert printer.definitions[0].replace(FIXED_SPACE, " ").startswith("Definition near (rho_2 : vehicle)")


@pytest.mark.parametrize("name", ['a" b', "a.b", "", "x" * 300, "ä", "a\nb", "(* a"])
def test_names_of_odd_characters_are_refused(name):
    with pytest.raises(InputError):
        Printer().vehicle(name)


@pytest.mark.parametrize("said", ["*) Axiom a : False. (*", 'say "*)', "(*", "(*)", "(**)", "*" * 5, "é ✓"])
def test_words_in_comments_end_no_comment(said):
    shown = comment(said)
    assert shown.isascii()
    assert not {"(*", "*)", '"'} & {shown[i : i + n] for i in range(len(shown)) for n in (1, 2)}


# --- Drive files put to Coq: what is refused, and what is only unknown ------------------------------

FILE = shipped_drives()["scenario-04-base"]


def test_a_drive_with_a_derivation_is_a_module_without_premises() -> None:
    made = prepare("one", FILE, bundled_library())
    assert made.module is not None
    assert (made.module.name, made.limits, made.refusal) == ("one", 0, None)


def test_a_formula_that_cannot_be_read_is_refused() -> None:
    made = prepare("one", replace(FILE, formula="nobody_knows(SV)"), bundled_library())
    assert (made.module, made.limits) == (None, 0)
    assert made.refusal is not None
    assert made.refusal.verdict is KernelVerdict.REFUSED
    assert made.refusal.reason.startswith("it cannot be put to the kernel: ")


@pytest.mark.parametrize(
    ("error", "reason"),
    [
        (NoDerivationError(ReasonKind.TOO_NEAR()), "no derivation was found: two instants are too near"),
        (InputError("too long"), "it is not printed for the kernel: too long"),
    ],
)
def test_a_drive_without_a_derivation_is_unknown(
    error: RoadproofError, reason: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    def fail(*_: object) -> None:
        raise error

    monkeypatch.setattr(module, "derive", fail)
    assert prepare("one", FILE, bundled_library()) == CoqModule(
        None, refusal=KernelRuling(KernelVerdict.UNKNOWN, ReasonKind.TOLD(reason))
    )


# --- docs/explanation/trust.md

HOME = Path(__file__).parents[3]


def test_the_command_of_coqchk_reaches_all_theories_of_printed_claims():
    page = (HOME / "docs" / "explanation" / "trust.md").read_text("utf-8")
    command = re.search(r"`coqchk ([^`]+)`", page)
    assert command is not None
    reached, waiting = set(), re.findall(r"Roadproof\.(\w+)", command[1])
    while waiting:
        name = waiting.pop()
        if name not in reached:
            reached.add(name)
            text = (SOURCES / f"{name}.v").read_text("ascii")
            for said in re.findall(r"^From Roadproof Require (?:Import )?([^.]+)\.$", text, re.MULTILINE):
                waiting += said.split()
    assert reached == set(THEORIES)

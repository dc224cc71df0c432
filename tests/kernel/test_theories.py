"""The theories: without warnings, without gaps, and on the axioms of Coq's real numbers alone."""

import re
from pathlib import Path

import pytest

from kernel.needs import needs_coq
from roadproof.evidence.kernel import coq as coq_module
from roadproof.evidence.kernel.accept import AXIOMS, axioms_of
from roadproof.evidence.kernel.coq import THEORIES, ready
from roadproof.runtime.cache import private_folder

SOURCES = Path(__file__).parents[2] / "proofs" / "kernel"
GAPS = re.compile(
    r"\b(Admitted|admit|give_up|Axioms?|Parameters?|Conjectures?|Unset Guard|bypass_check|type_in_type)\b"
)


@pytest.mark.parametrize("name", [*THEORIES, "Sane", "Steps"])
def test_each_file_says_what_it_is_for_and_whether_it_is_trusted(name):
    text = (SOURCES / f"{name}.v").read_text("ascii")
    opening = text[: text.index("*)")]
    assert text.startswith("(* ")
    assert ("NOT TRUSTED" in opening) == (name not in ("Meaning", "Text", "Drive"))
    assert "TRUSTED" in opening
    code = re.sub(r"\(\*.*?\*\)", "", text, flags=re.DOTALL)
    assert not GAPS.search(code)
    assert all(len(line) <= 140 for line in text.splitlines())


def test_no_other_theory_is_there():
    assert {x.stem for x in SOURCES.glob("*.v")} == {*THEORIES, "Sane", "Steps"}


@needs_coq
def test_theories_compile_without_a_warning_and_are_kept(tmp_path, monkeypatch):
    """Into a new cache; Sane and Steps too, which nothing needs. What is changed there counts no more."""
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    said = []
    run = coq_module._run
    monkeypatch.setattr(coq_module, "_run", lambda *args: said.append(run(*args)) or said[-1])
    with ready() as coq:
        others = [coq.run((SOURCES / f"{name}.v").read_text("ascii")) for name in ("Sane", "Steps")]
    assert len(said) == len(THEORIES) + 3  # the version, and the two others
    assert [ran.code for ran in others] == [0, 0]
    assert [ran.complained for ran in said] == [""] * len(said)
    with ready() as again:
        assert again.theories == coq.theories
    assert len(said) == len(THEORIES) + 4
    assert coq_module._is_sound(coq.theories)
    for change in (
        lambda: (coq.theories / "Other.vo").write_bytes(b"one more"),
        lambda: (coq.theories / "Text.vo").write_bytes(b"forged"),
    ):
        change()
        assert not coq_module._is_sound(coq.theories)
        (coq.theories / "Other.vo").unlink(missing_ok=True)
    coq.theories.chmod(0o777)
    assert not coq_module._is_sound(coq.theories)
    (tmp_path / "roadproof" / "coq").chmod(0o777)
    assert private_folder("coq") is None


@needs_coq
def test_theorems_stand_on_known_axioms_alone():
    theorems = ["accepted", "envelopes", "motions", "settled", "answer_right", "minus_as_written"]
    theorems += ["shown", "not_always", "drives_keep_apart", "motions_across", "drives_keep_apart_across"]
    with ready() as coq:
        whole = (
            "Definition whole := (" + ", ".join(f"@{x}" for x in theorems) + ").\nPrint Assumptions whole."
        )
        steps = (SOURCES / "Steps.v").read_text("ascii")
        ran = coq.run(f"{steps}\nFrom Roadproof Require Import {' '.join(THEORIES)}.\n{whole}")
    found = axioms_of(ran.said)
    assert ran.code == 0
    assert found is not None
    assert set(found) <= AXIOMS


@needs_coq
def test_a_theorem_that_is_admitted_is_told():
    """The reading of axioms can find one."""
    with ready() as coq:
        ran = coq.run("Lemma gap : 1 = 2. Admitted. Print Assumptions gap.")
    found = axioms_of(ran.said)
    assert found is not None
    assert set(found) - AXIOMS == {"gap"}

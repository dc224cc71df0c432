"""What Coq says of several certificates at once: good, bad and silent ones, known and other axioms.

Coq is played by a program that reads the file that is put to it, so the tests need none.
"""

import re
from dataclasses import dataclass, field
from itertools import permutations, product

import pytest

from roadproof.evidence.kernel.accept import (
    AXIOMS,
    CoqModule,
    Ruling,
    Word,
    axioms_of,
    batches,
    file,
    judge,
)
from roadproof.evidence.kernel.coq import CoqRun
from roadproof.evidence.kernel.source import Module

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
    return CoqRun(code=code, said=said, complained=complained, seconds=1.0, megabytes=2.0)


def rulings(*kinds: str) -> dict[str, Ruling]:
    made = {f"c{k}": certificate(f"c{k}", kind) for k, kind in enumerate(kinds)}
    return judge(Player(), made).rulings  # type: ignore[arg-type]


WORDS = {"good": Word.ACCEPTED, "bad": Word.REFUSED, "slow": Word.UNKNOWN, "silent": Word.UNKNOWN}


@pytest.mark.parametrize("count", [1, 2, 3, 4])
def test_each_has_its_own_word_in_every_mixture(count: int) -> None:
    for mixed in product(WORDS, repeat=count):
        found = rulings(*mixed)
        assert [found[f"c{k}"].word for k in range(count)] == [WORDS[kind] for kind in mixed], mixed


def test_a_reason_is_that_of_its_own_certificate() -> None:
    for mixed in permutations(["good", "bad", "slow", "silent", "good"]):
        found = rulings(*mixed)
        reasons = {kind: found[f"c{k}"].reason for k, kind in enumerate(mixed)}
        assert reasons["good"] == ""
        assert "does not accept its tableau" in reasons["bad"]
        assert reasons["slow"].startswith("coqc says: Error: no")
        assert reasons["silent"] == "coqc ended without an answer: killed"


@pytest.mark.parametrize(
    ("axioms", "word"),
    [
        ((KNOWN,), Word.ACCEPTED),
        ((), Word.ACCEPTED),
        (tuple(sorted(AXIOMS)), Word.ACCEPTED),
        ((OTHER,), Word.REFUSED),
        ((KNOWN, OTHER), Word.REFUSED),
        ((OTHER, KNOWN), Word.REFUSED),
        ((*sorted(AXIOMS), OTHER), Word.REFUSED),
        ((f"{KNOWN}_2",), Word.REFUSED),
        (("sig_forall_dec",), Word.REFUSED),
    ],
)
def test_one_other_axiom_among_known_ones_refuses_all_of_the_file(
    axioms: tuple[str, ...], word: Word
) -> None:
    listed = "Axioms:\n" + "".join(f"{x} :\n  forall P : Prop, P\n" for x in axioms)
    said = listed if axioms else "Closed under the global context\n"

    class Says:
        def run(self, text: str) -> CoqRun:
            return ran(0, said, "")

    made = {name: certificate(name, "good") for name in ("a", "b")}
    found = judge(Says(), made).rulings  # type: ignore[arg-type]
    assert {x.word for x in found.values()} == {word}
    for ruling in found.values():
        told = OTHER in axioms and OTHER in ruling.reason and KNOWN not in ruling.reason.split(", ")
        assert told or OTHER not in axioms
        assert ruling.axioms == (axioms if word is Word.ACCEPTED else ())


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
    parts = [*batches(made, count)]
    assert sorted(name for part in parts for name in part) == sorted(made)
    assert all(part for part in parts)
    assert max(map(len, parts)) - min(map(len, parts)) <= 1


def test_what_was_not_prepared_keeps_its_refusal() -> None:
    refusal = Ruling(Word.REFUSED, "it cannot be put to Coq")
    made = {"a": CoqModule(None, 0, refusal), "b": certificate("b", "good"), "c": certificate("c", "bad")}
    player = Player()
    found = judge(player, made).rulings  # type: ignore[arg-type]
    assert [found[x].word for x in "abc"] == [Word.REFUSED, Word.ACCEPTED, Word.REFUSED]
    assert found["a"] is refusal
    assert all("a" not in names for names in player.files)


def test_the_head_of_a_file_has_no_module() -> None:
    assert "Module c" not in file([])

"""Drive files put to Coq: what is refused, and what is only unknown."""

from dataclasses import replace

import pytest

from exporting.kept import kept
from roadproof.errors import InputError, RoadproofError
from roadproof.evidence.derivations import prepare as module
from roadproof.evidence.derivations.parts import NoDerivationError
from roadproof.evidence.derivations.prepare import prepare
from roadproof.evidence.kernel.accept import NO_PREMISES, CoqModule, Ruling, Word
from roadproof.library.loading import bundled_library

FILE = kept()["scenario-04-base"]


def test_a_drive_with_a_derivation_is_a_module_without_premises() -> None:
    made = prepare("one", FILE, bundled_library())
    assert made.module is not None
    assert (made.module.name, made.premises, made.refusal) == ("one", NO_PREMISES, None)


def test_a_formula_that_cannot_be_read_is_refused() -> None:
    made = prepare("one", replace(FILE, formula="nobody_knows(SV)"), bundled_library())
    assert (made.module, made.premises) == (None, NO_PREMISES)
    assert made.refusal is not None
    assert made.refusal.word is Word.REFUSED
    assert made.refusal.reason.startswith("it cannot be put to Coq: ")


@pytest.mark.parametrize(
    ("error", "reason"),
    [
        (NoDerivationError("too hard"), "no derivation was found: too hard"),
        (InputError("too long"), "it is not printed for Coq: too long"),
    ],
)
def test_a_drive_without_a_derivation_is_unknown(
    error: RoadproofError, reason: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    def fail(*_: object) -> None:
        raise error

    monkeypatch.setattr(module, "derive", fail)
    assert prepare("one", FILE, bundled_library()) == CoqModule(None, refusal=Ruling(Word.UNKNOWN, reason))

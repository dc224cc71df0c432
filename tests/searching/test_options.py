"""No way of asking drops the options that definitions are read under."""

import pytest

import roadproof as rp
from roadproof.verdict import Verdict

# Under the option's first value the claim holds on every drive, under the other one a drive refutes it.
DECIDED = "fasterThan(SV,POV) -> v_lon(POV) > v_lon(SV)"


@pytest.mark.parametrize("engine", ["dense", "milp", "smt"])
def test_an_option_that_decides_a_claim_decides_it_for_every_engine(engine):
    asked = {"engine": engine, "horizon": 1.2, "jobs": 1}
    assert rp.prove(DECIDED, using=rp.load(), **asked).verdict is Verdict.PROVED
    refuted = rp.prove(DECIDED, using=rp.load(options={"speed": "total"}), **asked)
    assert refuted.verdict is Verdict.REFUTED
    assert refuted.answers[0].drive.file.options["speed"] == "total"


@pytest.mark.parametrize("engine", ["dense", "milp", "smt"])
def test_each_option_is_named_by_the_drive_that_refutes_under_it(engine):
    home = rp.load()
    for name, option in home.specification.library.options.items():
        for value in option.values:
            chosen = rp.load(options={name: value})
            found = rp.prove("not (v_lon(SV) > 20 m/s)", using=chosen, engine=engine, horizon=1.2, jobs=1)
            assert found.answers[0].drive.file.options[name] == value

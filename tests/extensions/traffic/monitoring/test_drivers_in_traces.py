"""What ``monitor`` says of driver models: the model that is put into the trace decides, not a formula."""

from pathlib import Path

import pytest

import roadproof as rp
from roadproof.errors import UsageError
from roadproof.evidence.codec import read
from roadproof.extensions.traffic.answers.monitor import MonitorData
from roadproof.frontends.cli.main import main

DRIVE = Path(__file__).parents[4] / "examples" / "catalogue" / "tests" / "drives" / "cut-in.json"


def test_models_that_are_named_drive_the_trace() -> None:
    found = rp.monitor(1, DRIVE, drivers=("careful", "fsm"))
    [test] = rp.catalogue(DRIVE, among="1", classes=False, drivers=("careful", "fsm"), jobs=1).concrete
    assert [(x.driver, x.side, x.gap) for x in found.decisions] == [
        (x.driver, x.side, x.gap) for x in test.decisions
    ]
    assert "careful, scenario_1: preventable (11.75 m left)" in str(found)
    kept = read(MonitorData, found.as_data(), "the answer")
    assert [(x.driver, x.side) for x in kept.drivers] == [(x.driver, x.side) for x in found.decisions]


def test_a_formula_of_a_boundary_names_its_model() -> None:
    """In samples, too; its verdict is that of the formula, and beside it stands that of the trace."""
    home = rp.load(specs=["driver"])
    for view in ("dense", "recorded"):
        found = rp.monitor("unpreventable_cutIn_careful(SV,POV)", DRIVE, home, view=view)
        assert [(x.driver, x.scenario) for x in found.decisions] == [("careful", "scenario_1")]
    assert not rp.monitor("scenario_1(SV,POV,L)", DRIVE, home).decisions


@pytest.mark.parametrize(
    ("what", "model", "said"),
    [
        (1, "carful", "did you mean 'careful'"),
        (3, "careful", "careful does not apply to the selected scenarios (3)"),
        ("G v_lon(SV) > 0 m/s", "careful", "(none)"),
    ],
)
def test_models_that_say_nothing_are_refused(what: int | str, model: str, said: str) -> None:
    with pytest.raises(UsageError) as refused:
        rp.monitor(what, DRIVE, drivers=(model,))
    assert said in str(refused.value)


def test_the_command_takes_parameters_of_drivers(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["monitor", "1", str(DRIVE), "--drivers", "careful", "--param", "cc_wander=0.1 m"]) == 0
    assert "careful, scenario_1: preventable (12.16" in capsys.readouterr().out

"""Models of vehicles in long questions: who drives, and that another model is another question."""

from pathlib import Path

import pytest

import roadproof as rp
from roadproof.analysis.basis import Basis
from roadproof.errors import UsageError
from roadproof.evidence.drive_file import load_drive
from roadproof.frontends.api.settings import basis_of
from roadproof.frontends.cli.main import main
from roadproof.frontends.settings.groups import Budget
from roadproof.library.loading import bundled_library
from roadproof.library.scenarios import Scenario, applied
from roadproof.world.models import load_vehicle


def test_models_go_to_the_vehicles_that_a_formula_has() -> None:
    truck, home = load_vehicle("truck"), bundled_library().select()
    basis = Basis(home, vehicles={"POV": truck, "": load_vehicle("bus")})
    assert set(basis.search(applied(home, Scenario(4, "base"))).setting.vehicles) == {"POV", ""}
    assert set(basis.search(applied(home, Scenario(2, "base"))).setting.vehicles) == {""}
    assert basis.models != Basis(home, vehicles={"SV": truck}).models
    assert Basis(home).models == {}


def test_roles_that_no_scenario_has_are_refused(capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(UsageError, match="vehicle XV: scenarios mention POV, POV1, POV2, SV"):
        basis_of(rp.load(), Budget(), {"XV": "truck"})
    for command in ("overlap", "order", "redundancy", "coverage", "classify"):
        assert main([command, "--vehicle", "XV=truck"]) == 2
        assert "vehicle XV" in capsys.readouterr().err


def test_a_truck_in_a_role(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    asked = ("overlap", "--among", "4,8", "--jobs", "1", "--no-pictures", "--out", str(tmp_path))
    assert main([*asked, "--vehicle", "POV=truck"]) == 0
    [path] = tmp_path.glob("drive-*.json")
    found = rp.check(path)
    assert found.accepted
    sizes = {name: (x.length, x.width) for name, x in load_drive(path).drive.vehicles.items()}
    truck, car = load_vehicle("truck"), load_vehicle("car")
    assert sizes == {"SV": (car.length, car.width), "POV": (truck.length, truck.width)}
    assert main([*asked]) == 2
    assert "holds the answers to another question" in capsys.readouterr().err

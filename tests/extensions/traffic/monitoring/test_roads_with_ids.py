"""A road that is named, with and without ids of vehicles, in every format of tests."""

from pathlib import Path

import pytest

import roadproof as rp
from roadproof.errors import RoadproofError
from roadproof.extensions.traffic.formats.table import polars_module

DRIVE = Path(__file__).parents[4] / "examples" / "traffic" / "drives" / "scenario-01-base.json"
ENDINGS = (".csv", ".parquet", ".xosc", ".xml")


@pytest.fixture(scope="module")
def files(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Path]:
    """The drive by ending, where tables have no road beside them."""
    folder = tmp_path_factory.mktemp("files")
    rp.export([DRIVE], ["openscenario", "commonroad", "csv"], folder)
    found = {x: next(folder.rglob(f"*{x}")) for x in (".csv", ".xosc", ".xml")}
    next(folder.rglob("*_road.toml")).unlink()
    found[".parquet"] = found[".csv"].with_suffix(".parquet")
    pl = polars_module()
    pl.read_csv(found[".csv"], schema_overrides={"time": pl.Float64}).write_parquet(found[".parquet"])
    return found


@pytest.mark.parametrize("ending", ENDINGS)
@pytest.mark.parametrize("road", [None, "main-2", "main-3", "nowhere", "a.xodr"])
def test_a_road_is_used_or_the_message_fits(files: dict[str, Path], ending: str, road: str | None) -> None:
    place = f"{files[ending]}:1,2"
    own_road = ending in (".xosc", ".xml")
    if road in (None, "main-2", "main-3") and not (own_road and road):
        found = rp.monitor(1, place, road=road)
        assert found.verdict == "true"
        assert found.place.roles == {"SV": "1", "POV": "2"}
        assert rp.catalogue(place, classes=False, drivers=()).as_data()["targets"][0]["tested"]  # type: ignore[index,call-overload]
        return
    with pytest.raises(RoadproofError) as error:
        rp.monitor(1, place, road=road)
    told = str(error.value)
    assert "road.toml is missing" not in told
    if own_road:
        assert "has the road of its recording; omit it" in told
    else:
        assert "there is no road 'nowhere'" in told or "a.xodr" in told


@pytest.mark.parametrize("ending", [".csv", ".parquet"])
@pytest.mark.parametrize("road", [None, "main-3"])
def test_ids_change_no_verdict(files: dict[str, Path], ending: str, road: str | None) -> None:
    alone, named = (rp.monitor(1, f"{files[ending]}{ids}", road=road) for ids in ("", ":1,2"))
    assert alone.verdict == named.verdict
    assert alone.place.lanes == named.place.lanes


def test_recordings_of_samples_are_evaluated_on_a_road_that_is_named(
    files: dict[str, Path], tmp_path: Path
) -> None:
    found = rp.evaluate(files[".csv"], tmp_path / "out", road="main-2")
    assert found.totals.vehicles == 2


def test_a_road_beside_a_table_counts_with_ids(files: dict[str, Path], tmp_path: Path) -> None:
    path = tmp_path / "a.csv"
    path.write_text(files[".csv"].read_text("utf-8"), "utf-8")
    model = Path(__file__).parents[4] / "models" / "roads" / "main-3.toml"
    (tmp_path / "a_road.toml").write_text(model.read_text("utf-8"), "utf-8")
    road = rp.monitor(1, f"{path}:1,2").road
    assert road is not None
    assert len(road.lanes) == 3

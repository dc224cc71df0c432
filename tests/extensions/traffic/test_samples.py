"""CSV and Parquet recordings: by hand, against highD, on roads with zones, and damaged."""

from collections.abc import Callable
from dataclasses import replace
from fractions import Fraction
from pathlib import Path
from random import Random

import numpy as np
import polars as pl
import pytest

import roadproof as rp
from extensions.traffic.drives import cut_in
from extensions.traffic.sampled import TWO, csv_of, lower_road, toml_of, write_samples
from roadproof.errors import InputError
from roadproof.extensions.traffic.evaluate.evaluate import Findings, evaluate_recording
from roadproof.extensions.traffic.evaluate.one_trace import read_pair, read_samples
from roadproof.extensions.traffic.evaluate.questions import compile_questions, default_settings
from roadproof.extensions.traffic.formats.converted import same_recording
from roadproof.extensions.traffic.formats.highd import read_highd
from roadproof.extensions.traffic.formats.recording import Recording, keep_vehicles, kind_called, own_numbers
from roadproof.extensions.traffic.formats.samples import HEADER, clock_of, read_columns, read_recording
from roadproof.extensions.traffic.formats.sources import find_source, find_sources
from roadproof.extensions.traffic.formats.straight import of_road, place
from roadproof.extensions.traffic.formats.write_highd import write_highd
from roadproof.extensions.traffic.simulate.planting import PlantingPlace, plant
from roadproof.extensions.traffic.simulate.simulate import simulate
from roadproof.extensions.traffic.simulate.traffic import TrafficSettings
from roadproof.library.bind import occupies
from roadproof.logic.rewrite import with_values
from roadproof.semantics.sampled.batch import Batch
from roadproof.semantics.sampled.compiled import compile
from roadproof.world.models import load_road
from roadproof.world.road import Lanelet, Road
from roadproof.world.signals import KINDS
from tables import read_table

MERGE = toml_of(load_road("merge"))


def table(*rows: str) -> str:
    return "\n".join((",".join(HEADER), *rows)) + "\n"


def test_by_hand(tmp_path: Path) -> None:
    r = read_recording(write_samples(tmp_path, "a", table(*TWO), MERGE))
    assert (r.name, r.rate, r.notes) == ("a", 10, ())
    assert [x.name for x in r.lanes] == ["main-1", "main-2", "merge-1"]
    assert r.beside == {frozenset(("main-1", "main-2")), frozenset(("main-1", "merge-1"))}
    assert r.vehicle_id.tolist() == [1, 2]
    assert (r.start.tolist(), r.first_frame.tolist()) == ([0, 3, 5], [0, 1])
    assert (r.length.tolist(), r.kind.tolist()) == ([4.5, 5.0], ["Car", "Car"])
    assert r.s.tolist() == [20, 22, 24, 62, 65]
    assert r.occupancy.tolist() == [2, 2, 2, 1, 1]
    assert r.lane.tolist() == [1, 1, 1, 0, 0]
    assert r.zones.tolist() == [2] * 5  # from -100 m to 300 m all is merge zone


def test_zones_at_their_ends(tmp_path: Path) -> None:
    """The merge zone ends at 300 m: the box that reaches across it is in both, one that touches in one."""
    rows = [f"{k / 10},7,{s},{d},30,0,0,0,4,2" for k, (s, d) in enumerate(((300, 2), (303, 2), (304, 2)))]
    r = read_recording(write_samples(tmp_path, "a", table(*rows), MERGE))
    assert r.zones.tolist() == [2, 3, 1]
    assert r.lane.tolist() == [0, 0, 0]
    assert [[x.id for x, held in zip(r.lanelets, row, strict=True) if held] for row in r.inside] == [
        ["m1b"],
        ["m1b", "m1c"],
        ["m1c"],
    ]


@pytest.mark.parametrize("name", ["merge", "depart", "weave"])
def test_places_are_those_of_the_formulas(name: str) -> None:
    """occ(a, l) as the monitor computes it from s, d and sizes, on boxes that touch and that do not."""
    road = load_road(name)
    random = np.random.default_rng(3)
    count = 3000
    s = np.round(random.uniform(-420, 420, count) * 2) / 2
    d = np.round(random.uniform(-4, 9, count) * 2) / 2
    length, width = random.choice([4.0, 4.5, 8.5], count), random.choice([1.5, 2.0], count)
    known = of_road(road, 1, Path("x"))
    placed = place(known, np.ones(count, np.int64), s, d, length, width)
    batch = Batch(
        Fraction(1, 10),
        np.ones(count, np.int64),
        {("s", "SV"): s[None], ("d", "SV"): d[None]},
        {("length", "SV"): length, ("width", "SV"): width},
    )
    asked = {x.id: with_values(occupies("SV", x), {}) for x in known.lanelets}
    answers = compile(asked).evaluate(batch).answers
    for j, lanelet in enumerate(known.lanelets):
        assert np.array_equal(answers[lanelet.id].true, placed.inside[:, j])
        assert placed.inside[:, j].any()
    for k, lane in enumerate(known.lanes):
        mine = [j for j, x in enumerate(known.lanelets) if x.lane == lane.name]
        assert np.array_equal((placed.occupancy >> k) & 1 == 1, placed.inside[:, mine].any(axis=1))


@pytest.fixture(scope="module")
def traffic() -> Recording:
    """With a planted cut-in on the lower lanes."""
    recording = simulate(TrafficSettings(seconds=30, lane_width=3.5), seed=4)
    right = min(lane.d[0] for lane in recording.lanes if lane.direction == 2 and lane.d)
    return plant(recording, cut_in(), PlantingPlace(2, 20, 6, 10.0, right))[0]


def found(recording: Recording) -> Findings:
    return evaluate_recording(recording, compile_questions(default_settings(), recording.rate))


def test_csv_parquet_and_highd_tell_the_same(traffic: Recording, tmp_path: Path) -> None:
    """The lower lanes of simulated traffic: matches, traces and detections are those of the highD files."""
    write_highd(traffic, tmp_path / "highd")
    read = read_highd(tmp_path / "highd", "01")
    lower = keep_vehicles(read, read.direction == 2)
    expected = found(lower)
    assert {m.scenario for m in expected.matches} >= {1}
    path = write_samples(tmp_path / "csv", "x", csv_of(lower), toml_of(lower_road(read)))
    columns = read_columns(path).columns
    (tmp_path / "parquet").mkdir()
    pl.DataFrame(dict(columns)).with_columns(pl.col("vehicle").cast(pl.Int32)).write_parquet(
        tmp_path / "parquet" / "x.parquet"
    )
    (tmp_path / "parquet" / "x_road.toml").write_bytes(path.with_name("x_road.toml").read_bytes())
    shift = int(lower.first_frame.min())
    for folder, name in ((tmp_path / "csv", "CSV"), (tmp_path / "parquet", "Parquet")):
        source = find_source(folder)
        assert source.format.name == name
        assert [x.name for x in source.files] == ["x_road.toml", f"x.{name.lower()}"]
        told = found(source.read())
        assert [
            replace(m, start_frame=m.start_frame + shift, end_frame=m.end_frame + shift) for m in told.matches
        ] == list(expected.matches)
        assert len(told.traces) == len(expected.traces)
        assert told.detections == expected.detections


def test_a_road_beside_highd(traffic: Recording, tmp_path: Path) -> None:
    """A road that says what the markings say changes nothing; one with a merge zone gives its zones."""
    write_highd(traffic, tmp_path)
    plain = read_highd(tmp_path, "01")
    road = lower_road(plain)
    (tmp_path / "01_road.toml").write_text(toml_of(road))
    with_road = read_highd(tmp_path, "01")
    assert with_road.notes == ()
    assert found(with_road) == found(plain)
    assert find_source(tmp_path).files[0].name == "01_road.toml"
    half = Fraction(200)
    cut = [
        replace(x, id=f"{x.id}{side}", zone=zone, s=s)
        for x in road.lanelets
        for side, zone, s in (("a", "main", (None, half)), ("b", "merge", (half, None)))
    ]
    (tmp_path / "01_road.toml").write_text(toml_of(Road("x", tuple(cut), road.adjacent)))
    r = read_highd(tmp_path, "01")
    down = r.direction[r.row_vehicle] == 2
    assert np.array_equal(r.occupancy, plain.occupancy[:])
    rear = r.s - r.length[r.row_vehicle]
    on = down & (r.occupancy != 0)
    assert np.array_equal((r.zones & 2 != 0)[on], (r.s > 200)[on])
    assert np.array_equal((r.zones & 1 != 0)[on], (rear < 200)[on])
    assert (r.zones[~down & (r.occupancy != 0)] == 1).all()


def test_direction_1_of_highd(traffic: Recording, tmp_path: Path) -> None:
    write_highd(traffic, tmp_path)
    plain = read_highd(tmp_path, "01")
    lanelets = [
        Lanelet(
            f"up{x.name}",
            f"up{x.name}",
            "depart",
            "main",
            (None, None),
            (Fraction(str(x.d[0])), Fraction(str(x.d[1]))),
        )
        for x in plain.lanes
        if x.direction == 1 and x.d
    ]
    (tmp_path / "01_road.toml").write_text(toml_of(Road("up", tuple(lanelets), frozenset()), "direction = 1"))
    r = read_highd(tmp_path, "01")
    up = r.direction[r.row_vehicle] == 1
    assert (r.zones[up & (r.occupancy != 0)] == 4).all()
    assert [x.name for x in r.lanes if x.direction == 2] == [x.name for x in plain.lanes if x.direction == 2]
    (tmp_path / "01_road.toml").write_text(toml_of(Road("up", tuple(lanelets), frozenset()), "direction = 3"))
    with pytest.raises(InputError, match=r"01_road.toml: direction=3, but it must be 2 or 1"):
        read_highd(tmp_path, "01")


def test_a_pair_of_a_csv_recording(tmp_path: Path) -> None:
    path = write_samples(tmp_path, "a", table(*TWO), MERGE)
    trace = read_pair(f"{path}:1,2")
    assert (trace.lanes, trace.first, trace.batch.samples) == (
        {"SV": "main-2", "POV": "main-1"},
        "frame 1",
        2,
    )
    assert [x.zone for x in trace.road.lanelets] == ["main", "merge", "main"] * 2 + ["merge"]
    with pytest.raises(InputError, match="has no vehicle 3"):
        read_pair(f"{path}:1,3")
    with pytest.raises(InputError, match="they share the frames 1 to 2"):
        read_pair(f"{path}:1,2", (0, 2))


def test_names_are_numbered_and_time_may_begin_anywhere(tmp_path: Path) -> None:
    rows = [
        f"{round(7.3 + k / 30, 3)},{who},{s + k},{d},30,0,0,0,4,2,{kind}"
        for who, s, d, kind in (("POV", 50, 2, "Truck"), ("SV", 0, 5, "Car"))
        for k in range(4)
    ]
    text = table(*rows).replace("width\n", "width,kind\n")
    r = read_recording(write_samples(tmp_path, "a", text, MERGE))
    assert (r.rate, r.kind.tolist()) == (30, ["Car", "Truck"])
    assert r.notes[:2] == ("vehicles are numbered: SV is 1, POV is 2", "frame 0 is time 7.3 s")


def cell(row: int, column: str, value: str) -> Callable[[list[list[str]]], None]:
    def apply(rows: list[list[str]]) -> None:
        rows[row - 1][rows[0].index(column)] = value

    return apply


def drop(row: int) -> Callable[[list[list[str]]], None]:
    return lambda rows: rows.pop(row - 1) and None


DAMAGE: dict[str, tuple[Callable[[list[list[str]]], object], str]] = {
    **{name: (cell(*place), said) for name, *place, said in read_table(__file__, "damaged_cells")},
    "a gap": (drop(3), r"a.csv, row 3, column time=0.2: .*without gaps"),
    "off the road": (
        lambda rows: [cell(k, "d", "50")(rows) for k in (5, 6)],
        r"a.csv, row 5, column vehicle=2: on no lanelet of the road at any time",
    ),
    "a missing cell": (lambda rows: rows[2].pop(), r"a.csv, row 3: the row has 9 fields, the format 10"),
    "a missing column": (
        lambda rows: [row.pop(3) for row in rows],
        r"a.csv, row 1: missing columns d; the format has time,",
    ),
    "one sample each": (
        lambda rows: [rows.pop(k) for k in (5, 3, 2)],
        r"a.csv: no vehicle has two samples",
    ),
}


def test_rows_out_of_order_and_rows_twice_are_read(tmp_path: Path) -> None:
    rows = table(*TWO).splitlines(keepends=True)
    whole = read_recording(write_samples(tmp_path, "whole", "".join(rows), MERGE))
    rows[1], rows[2] = rows[2], rows[1]
    turned = read_recording(
        write_samples(tmp_path, "a", "".join([*rows, rows[3]]).replace(",", " , "), MERGE)
    )
    assert (turned.s == whole.s).all()
    assert (turned.d == whole.d).all()
    assert turned.notes[0] == "a.csv: rows were not in order of time; they were sorted"
    assert turned.notes[1] == "a.csv: 1 rows that repeat another row were left out"


@pytest.mark.parametrize("name", DAMAGE)
def test_damage_is_named(name: str, tmp_path: Path) -> None:
    rows = [row.split(",") for row in table(*TWO).splitlines()]
    damage, said = DAMAGE[name]
    damage(rows)
    path = write_samples(tmp_path, "a", "".join(",".join(row) + "\n" for row in rows), MERGE)
    with pytest.raises(InputError, match=said):
        read_recording(path)


ROADS = {
    "no road": ("", "a.csv: a_road.toml is missing beside it"),
    "no TOML": ("[[lanelet", "a_road.toml is no TOML"),
    "no lanelet": ('name = "x"', r"a_road.toml: a road needs at least one \[\[lanelet\]\]"),
    "a direction": ("direction = 2\n" + MERGE, "a_road.toml: 'direction' is unknown"),
    "unknown zone": (
        MERGE.replace('zone = "merge"', 'zone = "ramp"', 1),
        "lanelet 2: zone='ramp', but it must be",
    ),
    "a gap in a lane": (
        MERGE.replace('"-100"]', '"-90"]', 1),
        "lanelet 'm1b' does not begin where 'm1a' ends",
    ),
}


@pytest.mark.parametrize("name", ROADS)
def test_roads_that_are_wrong(name: str, tmp_path: Path) -> None:
    road, said = ROADS[name]
    path = write_samples(tmp_path, "a", table(*TWO), road)
    if not road:
        path.with_name("a_road.toml").unlink()
    with pytest.raises(InputError, match=said):
        read_recording(path)


def test_parquet_that_is_wrong(tmp_path: Path) -> None:
    csv = write_samples(tmp_path, "a", table(*TWO), MERGE)
    right = pl.read_csv(csv)
    path = tmp_path / "a.parquet"
    for frame, said in (
        (right.drop("d"), "a.parquet: missing columns d"),
        (right.with_columns(pl.lit(1).alias("an x")), "a.parquet: unknown columns an x"),
        (right.clear(), "a.parquet: the file has no rows"),
        (right.with_columns(s=pl.lit(None, pl.Float64)), "row 2, column s=null: a finite number"),
        (right.with_columns(s=pl.lit(float("nan"))), "row 2, column s=nan: a finite number"),
        (right.with_columns(s=pl.lit("x")), "column s: String is no type for it; a finite number"),
        (right.with_columns(vehicle=pl.lit("")), "row 2, column vehicle='': the cell must not be empty"),
    ):
        frame.write_parquet(path)
        with pytest.raises(InputError, match=said):
            read_recording(path)
    right.write_parquet(path)
    assert read_recording(path).vehicles == 2
    content = path.read_bytes()
    for damaged in (
        content[:100],
        b"PAR1",
        content[:4] + b"\xff" * 50 + content[54:],
        content.replace(b"v_lon", b"v_\xff\xffn"),
    ):
        path.write_bytes(damaged)
        with pytest.raises(InputError, match=r"a\.parquet"):
            read_recording(path)


def test_one_format_a_folder(tmp_path: Path) -> None:
    write_samples(tmp_path, "a", table(*TWO), MERGE)
    write_samples(tmp_path, "b", table(*TWO), MERGE)
    (tmp_path / "other.csv").write_text("a,b\n1,2\n")
    assert [x.name for x in find_sources(tmp_path)] == ["a", "b"]
    assert [x.name for x in find_sources(tmp_path / "b.csv")] == ["b"]
    with pytest.raises(InputError, match=r"2 recordings; name the file of one, such as a\.csv, b\.csv"):
        find_source(tmp_path)
    with pytest.raises(InputError, match="row 1: missing columns"):
        find_source(tmp_path / "other.csv").read()
    (tmp_path / "x.parquet").write_bytes(b"")
    with pytest.raises(InputError, match="CSV and Parquet files in one folder"):
        find_sources(tmp_path)


# --- Custom signals and kinds in CSV, Parquet and frames: what is read, and what is refused ------------

SPEC = """
signal red: bool
signal jerk(a: vehicle): m/s^3 in [-10, 10]
signal swift(a: vehicle): bool derived by jerk(a) > 2 m/s^3
"""
HOME = rp.load(specs=[SPEC])
BOX = {"d": 3.0, "v_lon": 20.0, "v_lat": 0.0, "a_lon": 0.0, "a_lat": 0.0, "length": 4.5, "width": 1.8}
ROAD = """
[[lanelet]]
id = "a"
lane = "a"
zone = "main"
attribute = "main"
s = [-inf, inf]
d = [0, 4]
"""


def own_table(**more: object) -> pl.DataFrame:
    """Two vehicles for a second, red from 0.4 s on, jerk 3 at 0.6 s; POV is a truck."""
    rows = [
        {"time": k / 10, "vehicle": name, "s": place + 2 * k, **BOX, "kind": kind}
        | {"red": k >= 4, "jerk": 3.0 if k == 6 else float(k % 3)}
        for k in range(11)
        for name, place, kind in (("SV", 0.0, "Car"), ("POV", 30.0, "Truck"))
    ]
    return pl.DataFrame(rows).with_columns(**more)


def written(folder: Path, frame: pl.DataFrame, ending: str) -> Path:
    path = folder / f"a.{ending}"
    frame.write_csv(path) if ending == "csv" else frame.write_parquet(path)
    path.with_name("a_road.toml").write_text(ROAD)
    return path


@pytest.mark.parametrize("source", ["csv", "parquet", "frame"])
@pytest.mark.parametrize(
    ("formula", "verdict"),
    [
        ("F[0, 1] (red and swift(SV))", "true"),
        ("F[0, 0.3] red", "false"),
        ("G[0, 1] jerk(POV) <= 2 m/s^3", "false"),
        ("kind(POV) = truck and kind(SV) = car", "true"),
        ("kind(SV) = kind(POV)", "false"),
    ],
)
def test_columns_are_read(tmp_path: Path, source: str, formula: str, verdict: str) -> None:
    on = own_table() if source == "frame" else written(tmp_path, own_table(), source)
    assert rp.monitor(formula, on, HOME).verdict == verdict


@pytest.mark.parametrize(
    "red", [[k >= 4 for k in range(11)], ["TRUE", "False"] * 5 + ["1"], [0, 1] * 5 + [0]]
)
def test_truth_is_written_as_words_or_as_0_and_1(tmp_path: Path, red: list[object]) -> None:
    told = pl.Series("red", [x for x in red for _ in (0, 1)], strict=False)
    path = written(tmp_path, own_table(red=told), "csv")
    measured = read_samples(path).batch.signals["red", ""][:, 0]
    assert measured.tolist() == [float(str(x).lower() in ("true", "1")) for x in red]


MISSING = pl.when(pl.col("time") > 0.75).then(None).otherwise(pl.col("jerk"))


@pytest.mark.parametrize("ending", ["csv", "parquet"])
@pytest.mark.parametrize(
    ("more", "formula", "told"),
    [
        ({"jerk": MISSING}, "F[0, 1] swift(SV)", "a.{}: jerk(SV) in trace 0 at sample 8 is missing"),
        ({"jerk": pl.lit("x")}, "swift(SV)", "at sample 0 is missing, or no finite number"),
        ({"jerk": pl.col("jerk") * 5}, "swift(SV)", "jerk(SV)=15 in trace 0 at sample 6: signal jerk"),
        ({"red": pl.lit(2)}, "red", "red=2 in trace 0 at sample 0: it is declared bool"),
        ({"red": pl.col("vehicle") == "SV"}, "red", "a.{}: column red is not the same for all vehicles"),
        ({"red": pl.col("jerk")}, "F[0,1] red", "declared bool"),
    ],
)
def test_wrong_values_are_refused_by_name(
    tmp_path: Path, ending: str, more: dict[str, pl.Expr], formula: str, told: str
) -> None:
    path = written(tmp_path, own_table(**more), ending)
    with pytest.raises(InputError) as raised:
        rp.monitor(formula, path, HOME)
    assert told.format(ending) in str(raised.value)
    assert rp.monitor("G[0, 1] v_lon(SV) > 0", path, HOME).verdict == "true"  # what nobody asks for is free


def test_a_missing_column_names_the_signal_the_file_and_what_there_is(tmp_path: Path) -> None:
    path = written(tmp_path, own_table().drop("jerk"), "csv")
    with pytest.raises(InputError) as raised:
        rp.monitor("swift(SV)", path, HOME)
    for part in (str(path), "no column jerk", "signal jerk", "of custom signals there are red"):
        assert part in str(raised.value)


def test_a_recording_has_own_signals_by_sample_and_kinds_by_vehicle(tmp_path: Path) -> None:
    recording = read_recording(written(tmp_path, own_table(), "csv"))
    assert recording.custom_signals["red"].tolist() == [float(k >= 4) for k in range(11)] * 2
    assert [KINDS[code - 1] for code in recording.kind_code] == ["car", "truck"]
    kept = keep_vehicles(recording, recording.kind == "Car")
    assert isinstance(kept, Recording)
    assert kept.custom_signals["red"].tolist() == recording.custom_signals["red"].tolist()[:11]
    assert (
        rp.monitor("kind(SV) = truck and F[0, 1] swift(SV)", f"{tmp_path}/a.csv:2,1", HOME).verdict == "true"
    )


def test_evaluate_reads_own_signals_and_refuses_recordings_without(tmp_path: Path) -> None:
    spec = "signal red: bool def rssViolation(a, b: vehicle) := red"
    home = rp.load(specs=[spec])
    data = tmp_path / "data"
    data.mkdir()
    written(data, own_table().drop("kind"), "csv")
    assert rp.evaluate(data, tmp_path / "out", home, pictures=False).exit_code == 0
    written(data, own_table().drop("kind", "red"), "csv")
    with pytest.raises(InputError, match=r"a\.csv: recording a: there is no column red"):
        rp.evaluate(data, tmp_path / "other", home)


def test_what_files_call_kinds() -> None:
    told = {
        "Car": "car",
        "taxi": "car",
        "Truck": "truck",
        "bus": "bus",
        "Motorbike": "motorcycle",
        "van": "other",
    }
    assert {name: kind_called(name) for name in told} == told
    assert [str(x) for x in own_numbers(["", None, "nan", True, "FALSE", "1e3"])] == [
        *("nan", "nan", "nan", "1.0", "0.0", "1000.0")
    ]


# --- CSV files with quoted cells or other line ends say the same as those without -------------------


def quoted(content: bytes) -> bytes:
    lines = content.decode().splitlines()
    return "".join(",".join(f'"{cell}"' for cell in line.split(",")) + "\n" for line in lines).encode()


def quoted_names(content: bytes) -> bytes:
    """Some rows only, as where texts alone are quoted."""
    header, _, rest = content.decode().partition("\n")
    lines = [line.split(",") for line in rest.splitlines()]
    return f"{header}\n".encode() + "".join(f'"{a}",{",".join(b)}\n' for a, *b in lines).encode()


CUSTOMS = {
    "CR": lambda x: x.replace(b"\n", b"\r"),
    "CRLF": lambda x: x.replace(b"\n", b"\r\n"),
    "quoted": quoted,
    "quoted, CR": lambda x: quoted(x).replace(b"\n", b"\r"),
    "quoted, CRLF": lambda x: quoted(x).replace(b"\n", b"\r\n"),
    "some quoted": quoted_names,
    "mark of UTF-8": lambda x: b"\xef\xbb\xbf" + quoted(x),
    "mark of UTF-8, CRLF": lambda x: b"\xef\xbb\xbf" + x.replace(b"\n", b"\r\n"),
}


@pytest.mark.parametrize("custom", CUSTOMS)
def test_samples_say_the_same(custom: str, tmp_path: Path) -> None:
    path = written(tmp_path, own_table(), "csv")
    before = find_source(path.parent).read()
    path.write_bytes(CUSTOMS[custom](path.read_bytes()))
    assert same_recording(find_source(path.parent).read(), before)


@pytest.fixture(scope="module")
def made(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return rp.simulate(tmp_path_factory.mktemp("made"), seconds=20, seed=2, jobs=1).folder


@pytest.mark.parametrize("custom", CUSTOMS)
def test_highd_files_say_the_same(custom: str, made: Path, tmp_path: Path) -> None:
    for path in made.iterdir():
        (tmp_path / path.name).write_bytes(CUSTOMS[custom](path.read_bytes()))
    assert same_recording(read_highd(tmp_path, "01"), read_highd(made, "01"))


@pytest.mark.parametrize("cell", ['"a,b"', '"a""b"', '"a', '"a"b'])
def test_other_quotes_are_refused_by_row(cell: str, tmp_path: Path) -> None:
    path = written(tmp_path, own_table(), "csv")
    lines = path.read_text().splitlines()
    first, _, rest = lines[3].split(",", 2)
    lines[3] = f"{first},{cell},{rest}"
    path.write_text("\n".join(lines) + "\n")
    with pytest.raises(InputError, match=r"row 4: a (comma or a quote within|quote does not end)"):
        find_source(path.parent).read()


def test_a_quoted_file_that_was_cut_off_is_refused(tmp_path: Path) -> None:
    path = written(tmp_path, own_table(), "csv")
    path.write_bytes(quoted(path.read_bytes())[:-1])
    with pytest.raises(InputError, match="the file was cut off"):
        find_source(path.parent).read()


@pytest.mark.parametrize("seed", range(60))
def test_the_most_frequent_step_is_that_of_the_clock(seed: int) -> None:
    """One mistyped time of a vehicle does not change the clock, whatever was typed; rounding evens out."""
    dice = Random(seed)
    rate = dice.choice([3, 10, 25, 30])
    times = [[round(k / rate, 4) for k in range(dice.randrange(8, 40))] for _ in range(12)]
    place = dice.randrange(1, len(times[0]) - 1)
    before, after = times[0][place - 1], times[0][place + 1]
    times[0][place] = round(before + (after - before) * dice.uniform(0.02, 0.98), 4)
    steps, counts = np.unique(np.concatenate([np.diff(x) for x in times]), return_counts=True)
    steps, counts = steps[steps > 0], counts[steps > 0]
    every = np.unique(np.concatenate(times))
    assert clock_of(Path("a.csv"), every, steps, counts).rate == rate

"""A bad vehicle costs that vehicle: it is left out and named, the others are as in a file without it."""

import json
import re
from collections.abc import Callable
from dataclasses import replace
from itertools import pairwise
from pathlib import Path
from random import Random

import numpy as np
import pytest

import roadproof as rp
from extensions.traffic.make_recording import Track, cruise, make_recording
from extensions.traffic.planar_exid import write_exid
from extensions.traffic.tiny_commonroad import Car, document, lanelet
from roadproof.errors import InputError
from roadproof.extensions.surveys import settings
from roadproof.extensions.surveys.classify.cells import whole_cell
from roadproof.extensions.surveys.classify.classes import Classes, plan_of, what_axis
from roadproof.extensions.surveys.classify.text import with_classes, write_classes
from roadproof.extensions.surveys.classify.traffic_shares import count_shares
from roadproof.extensions.surveys.coverage.traffic import count_in_traffic, recordings_in
from roadproof.extensions.traffic.evaluate.one_trace import read_pair
from roadproof.extensions.traffic.formats.off_line import follows_line, leave_out_strays
from roadproof.extensions.traffic.formats.recording import Recording
from roadproof.extensions.traffic.formats.sources import find_source
from roadproof.extensions.traffic.formats.write_highd import write_highd
from roadproof.frontends.cli.main import main
from roadproof.library.loading import bundled_library
from roadproof.questions.basis import Basis
from roadproof.verdict import ExitCode
from roadproof.world.models import load_road

STEPS = 41


def car(number: int, begin: float, speed: float = 20.0, told: float = 1.0, pull: float = 0.0) -> Car:
    """A car in the right lane with constant acceleration ``pull``; it says ``told`` times its speed."""
    times = [k / 10 for k in range(STEPS)]
    centres = tuple((begin + speed * t + pull * t * t / 2, 1.75) for t in times)
    motion = tuple((told * (speed + pull * t), pull) for t in times)
    return Car(number, 0, centres, motion=motion)


GOOD = tuple(car(k, 10.0 * k, speed=3.0) for k in range(1, 6))


def written(folder: Path, text: str, name: str = "a") -> Path:
    folder.mkdir(exist_ok=True)
    (folder / f"{name}.xml").write_text(text, "utf-8")
    return folder / f"{name}.xml"


def both(path: Path) -> tuple[Recording, str]:
    """The recording as it is read by default, and why it is rejected as a whole."""
    with pytest.raises(InputError) as error:
        find_source(path, strict=True).read()
    return find_source(path).read(), str(error.value)


def note_in(recording: Recording, begin: str) -> str:
    [note] = [x for x in recording.notes if x.startswith(begin)]
    return note


def of_one(text: str, number: int, change: Callable[[str], str]) -> str:
    """A file with the obstacle of this id changed."""
    found = re.search(rf'<dynamicObstacle id="{number}">.*?</dynamicObstacle>', text, re.DOTALL)
    assert found is not None
    return text.replace(found[0], change(found[0]))


# --- vehicles that contradict themselves -----------------------------------------------------------


def test_the_others_are_as_without_it(tmp_path: Path) -> None:
    good = find_source(written(tmp_path, document(GOOD))).read()
    bad = car(9, 5.0, speed=20.0, told=2.0)
    read, why = both(written(tmp_path / "b", document((*GOOD, bad)), "a"))
    assert "dynamicObstacle 9, time step" in why
    assert "velocities along the road and positions contradict each other, by a factor of 2" in why
    rule = "velocities along the road and positions contradict each other"
    assert note_in(read, "left out") == f"left out 1 of 6 vehicles (9): {rule}"
    assert read.vehicle_id.tolist() == good.vehicle_id.tolist()
    for name in ("s", "d", "v_lon", "a_lon", "occupancy", "inside", "start", "lane"):
        assert np.array_equal(getattr(read, name), getattr(good, name)), name


def test_nothing_is_left_out_of_what_stands(tmp_path: Path) -> None:
    path = written(tmp_path, document(GOOD))
    default, strict = find_source(path).read(), find_source(path, strict=True).read()
    assert default.notes == strict.notes
    assert default.vehicles == 5


def test_too_many_cost_the_recording(tmp_path: Path) -> None:
    """Half of the vehicles may be bad, and no more."""
    bad = tuple(car(10 + k, 5.0 + k, speed=3.0, told=2.0) for k in range(6))
    assert find_source(written(tmp_path, document((*GOOD, *bad[:5])))).read().vehicles == 5
    with pytest.raises(
        InputError, match=r"by a factor of 2.*; 6 of 11 vehicles would be left out, more than"
    ):
        find_source(written(tmp_path, document((*GOOD, *bad)))).read()


def test_a_vehicle_that_is_suddenly_elsewhere_is_left_out(tmp_path: Path) -> None:
    """One step of 120 m is enough, though it is one of forty."""
    jumping = car(9, 5.0, speed=3.0)
    far = tuple((s + (120.0 if k > 20 else 0.0), d) for k, (s, d) in enumerate(jumping.centres))
    read, why = both(written(tmp_path, document((*GOOD, replace(jumping, centres=far)))))
    assert "does not move by more than 100 m from one frame to the next" in why
    assert read.vehicle_id.tolist() == [1, 2, 3, 4, 5]


def test_accelerations_come_from_velocities(tmp_path: Path) -> None:
    """Places confirm the velocities, so that these say what accelerations are that a file has as zero."""
    braking = tuple(car(k, 10.0 * k, speed=12.0, pull=-2.0) for k in range(1, 4))
    silent = tuple(replace(x, motion=tuple((v, 0.0) for v, _ in x.motion or ())) for x in braking)
    read, why = both(written(tmp_path, document(silent)))
    assert "accelerations along the road and velocities contradict each other" in why
    assert read.vehicles == 3
    assert np.allclose(read.a_lon, -2.0)
    assert "those of all 3 vehicles were computed from the velocities" in note_in(
        read, "accelerations along the road contradict"
    )


@pytest.mark.parametrize("factor", [-1.0, 3.6])
def test_a_factor_of_most_accelerations_holds_for_all(factor: float, tmp_path: Path) -> None:
    """Vehicles that hardly accelerate do not show that signs or units are wrong, but theirs are as wrong."""
    pulls = (-2.0, -1.5, -2.0, 0.3, 0.3, 0.2)
    right = tuple(car(k, 5.0 * k, speed=9.0, pull=x) for k, x in enumerate(pulls, 1))
    wrong = tuple(replace(x, motion=tuple((v, a * factor) for v, a in x.motion or ())) for x in right)
    good, (read, why) = (
        find_source(written(tmp_path / "good", document(right))).read(),
        both(written(tmp_path / "wrong", document(wrong))),
    )
    assert "contradict each other, by a factor of" in why
    assert np.allclose(read.a_lon, good.a_lon, rtol=0.03)
    assert f"those of all 6 vehicles were divided by {factor:g}" in note_in(
        read, "accelerations along the road contradict"
    )


@pytest.mark.parametrize("seed", range(25))
def test_a_factor_of_a_whole_recording_is_undone_for_every_vehicle(seed: int, tmp_path: Path) -> None:
    """Four to eight vehicles show it, and up to three hardly accelerate; turned signs, km/h, and g."""
    dice = Random(seed)
    factor = dice.choice((-1.0, 3.6, 9.81, -3.6))
    shown = [dice.choice((-1, -1, 1)) * dice.uniform(1.2, 2.0) for _ in range(dice.randrange(4, 9))]
    pulls = [*shown, *(dice.uniform(-0.1, 0.1) for _ in range(dice.randrange(4)))]
    dice.shuffle(pulls)
    right = tuple(car(k, 9.0 * k, speed=12.0, pull=x) for k, x in enumerate(pulls, 1))
    wrong = tuple(replace(x, motion=tuple((v, a * factor) for v, a in x.motion or ())) for x in right)
    read = find_source(written(tmp_path, document(wrong))).read()
    assert read.vehicle_id.tolist() == [x.id for x in right]
    assert np.allclose(read.a_lon[read.start[:-1] + 20], pulls, atol=0.1), (factor, pulls)


def test_a_factor_of_a_few_accelerations_does_not(tmp_path: Path) -> None:
    """Three turned vehicles of nine are computed from their velocities; the others are as they were."""
    pulls = [-2.0, -1.8, -1.6, -2.0, -1.9, -1.7, -1.5, 1.5, 1.2]
    cars = [car(k, 5.0 * k, speed=9.0, pull=x) for k, x in enumerate(pulls, 1)]
    turned = [replace(x, motion=tuple((v, -a) for v, a in x.motion or ())) for x in cars[:3]]
    read, _ = both(written(tmp_path, document((*turned, *cars[3:]))))
    assert np.allclose(read.a_lon[read.start[:-1] + 20], pulls)
    assert "of 3 of 9 vehicles (1, 2, 3) contradict their velocities" in note_in(read, "accelerations along")


def test_velocities_across_come_from_places_where_boxes_are_turned(tmp_path: Path) -> None:
    """A map's grid turns orientations by two degrees: speeds agree with places, their direction does not."""
    turned = tuple(replace(car(k, 10.0 * k), drift=float(np.radians(2.0))) for k in range(1, 9))
    read, why = both(written(tmp_path, document(turned)))
    assert "velocities across the road and positions contradict each other" in why
    assert read.vehicles == 8
    assert np.allclose(read.v_lat, 0.0, atol=1e-6)
    assert np.allclose(read.a_lat, 0.0, atol=1e-5)
    assert "of 8 of 8 vehicles (1, 2, 3, 4, 5, 6, 7, 8) contradict their places" in note_in(
        read, "velocities across"
    )


def test_velocities_across_of_a_table_are_not_computed(tmp_path: Path) -> None:
    """There a sign that is turned is a mistake of columns, and either of the two may be wrong."""
    rows = [
        f"{k / 10},{n},{20 * n + 2 * k},{2 + k / 25},20,-0.4,0,0,4,1.8"
        for n in range(1, 9)
        for k in range(41)
    ]
    path = tmp_path / "a.csv"
    lane = 'id = "a"\nlane = "a"\nzone = "main"\nattribute = "main"\ns = [-inf, inf]\nd = [0, 4]\n'
    path.with_name("a_road.toml").write_text(f"[[lanelet]]\n{lane}")
    path.write_text("\n".join(["time,vehicle,s,d,v_lon,v_lat,a_lon,a_lat,length,width", *rows, ""]))
    with pytest.raises(InputError, match="by a factor of -1: the sign is turned"):
        find_source(path).read()


def test_the_line_is_at_fault_where_the_plane_agrees(tmp_path: Path) -> None:
    """A vehicle that drives across the road is left out, and the note says that its data agree."""
    across = tuple((60.0, 1.75 + 5.0 * k / 10) for k in range(STEPS))
    turned = replace(car(9, 0.0), centres=across, motion=((5.0, 0.0),) * STEPS, drift=np.pi / 2 + 0.6)
    read = find_source(written(tmp_path, document((*GOOD, turned)))).read()
    assert read.vehicle_id.tolist() == [1, 2, 3, 4, 5]
    assert "left out, 1 (9) move in the plane as their velocities say" in note_in(read, "of the vehicles")
    reason = "left out 1 of 6 vehicles (9): the reference line of the road does not follow their way"
    assert reason in read.notes
    with pytest.raises(InputError, match=r"does not follow the way of 1 of 6 vehicles \(9\)"):
        find_source(written(tmp_path, document((*GOOD, turned))), strict=True).read()
    alone = written(tmp_path, document((GOOD[0], turned, replace(turned, id=10))), "b")
    with pytest.raises(InputError, match="line of the road does not follow the way of 2 of 3 vehicles"):
        find_source(alone).read()
    told = replace(turned, motion=((9.0, 0.0),) * STEPS)
    read = find_source(written(tmp_path, document((*GOOD, told)))).read()
    assert read.vehicle_id.tolist() == [1, 2, 3, 4, 5]
    assert not any(x.startswith("of the vehicles") for x in read.notes)


@pytest.mark.parametrize("seed", range(20))
def test_a_vehicle_is_bounded_by_the_mean_error_of_its_steps(tmp_path: Path, seed: int) -> None:
    """Steps that are too long do not make up for steps that are too short; noise of places is no error."""
    random = np.random.default_rng(seed)
    read = find_source(written(tmp_path, document(GOOD))).read()
    counts = np.diff(read.start)
    centre = np.stack((read.s, read.d), axis=1) + random.uniform(-1e3, 1e3, 2)
    off = random.choice((0.0, 0.02, 0.045, 0.055, 0.3, 2.2), read.vehicles)
    turns = random.integers(2, size=read.vehicles)
    s = []
    for share, back, (begin, end) in zip(off, turns, pairwise(read.start.tolist()), strict=True):
        steps = np.diff(read.s[begin:end])
        sign = np.where(np.arange(len(steps)) < len(steps) / 2, 1.0, -1.0 if back else 1.0)
        s.append(read.s[begin] + np.append(0.0, np.cumsum(steps * (1 + share * sign))))
    stretched = replace(read, s=np.concatenate(s))
    assert len(stretched.s) == counts.sum()
    fits = follows_line(centre, stretched)
    assert fits.tolist() == (off <= 0.05).tolist()
    strays = read.vehicle_id[~fits].tolist()
    if fits.all():
        assert leave_out_strays(stretched, fits, strict=True) is stretched
    else:
        named = re.escape(f"{len(strays)} of {read.vehicles} vehicles ({', '.join(map(str, strays))})")
        with pytest.raises(InputError, match=named):
            leave_out_strays(stretched, fits, strict=True)
    if len(strays) > read.vehicles / 2:
        with pytest.raises(InputError, match="the reference line of the road does not follow the way of"):
            leave_out_strays(stretched, fits, strict=False)
    else:
        part = leave_out_strays(stretched, fits, strict=False)
        assert part.vehicle_id.tolist() == read.vehicle_id[fits].tolist()


# --- what files do not have -------------------------------------------------------------------------


def without(tag: str, first_only: bool = False) -> Callable[[str], str]:
    return lambda text: re.sub(rf"<{tag}><exact>[^<]*</exact></{tag}>", "", text, count=int(first_only))


@pytest.mark.parametrize("first_only", [True, False])
@pytest.mark.parametrize("tag", ["orientation", "velocity", "acceleration"])
def test_the_motion_says_what_states_lack(tag: str, first_only: bool, tmp_path: Path) -> None:
    cars = (*GOOD, car(7, 70.0, speed=10.0, pull=1.0))
    full = find_source(written(tmp_path, document(cars))).read()
    read, why = both(written(tmp_path, of_one(document(cars), 7, without(tag, first_only))))
    assert f"{tag} in a state of dynamicObstacle 7 is None; a finite number is needed" in why
    assert f"{tag} of 1 of 6 vehicles (7)" in "\n".join(read.notes)
    for name, within in (("s", 1e-6), ("v_lon", 0.06), ("v_lat", 1e-6), ("a_lon", 1.01)):
        assert np.allclose(getattr(read, name), getattr(full, name), atol=within), name
    inner = slice(int(read.start[-2]) + 2, -2)
    assert np.allclose(read.a_lon[inner], full.a_lon[inner])


def test_an_interval_stands_for_its_middle(tmp_path: Path) -> None:
    def interval(text: str) -> str:
        return text.replace(
            "<velocity><exact>3.0</exact></velocity>",
            "<velocity><intervalStart>2.5</intervalStart><intervalEnd>3.5</intervalEnd></velocity>",
            1,
        )

    full = find_source(written(tmp_path, document(GOOD))).read()
    read, why = both(written(tmp_path, of_one(document(GOOD), 2, interval)))
    assert "velocity in a state of dynamicObstacle 2 is None" in why
    assert "the middle of an interval is velocity of 1 of 5 vehicles (2)" in read.notes
    assert np.array_equal(read.v_lon, full.v_lon)


def test_unsigned_speeds_backwards(tmp_path: Path) -> None:
    """Strict reading takes such a vehicle for one that drives on: it contradicts its places."""
    back = replace(car(9, 60.0, speed=-6.0), motion=((6.0, 0.0),) * STEPS)
    read, why = both(written(tmp_path, document((*GOOD, back))))
    assert "by a factor of -1" in why
    assert read.vehicles == 6
    assert np.allclose(read.v_lon[read.start[-2] :], -6.0)
    assert "an unsigned velocity, of 1 of 6 vehicles (9)" in note_in(read, "the motion is backwards")


def test_a_first_state_that_is_said_twice(tmp_path: Path) -> None:
    def twice(text: str) -> str:
        first = text[text.index("<initialState>") : text.index("</initialState>")].partition(">")[2]
        return text.replace("<trajectory>", f"<trajectory><state>{first}</state>")

    read, why = both(written(tmp_path, of_one(document(GOOD), 2, twice)))
    assert "dynamicObstacle 2: time step 0 is followed by 0" in why
    assert np.array_equal(read.s, find_source(written(tmp_path, document(GOOD))).read().s)


def test_an_obstacle_that_cannot_be_read(tmp_path: Path) -> None:
    text = of_one(document(GOOD), 2, lambda x: x.replace("<time><exact>7</exact>", "<time><exact>99</exact>"))
    read, why = both(written(tmp_path, text))
    assert read.vehicle_id.tolist() == [1, 3, 4, 5]
    told = "dynamicObstacle 2: time step 6 is followed by 99; the steps of a trajectory have no gaps"
    assert told in why
    assert note_in(read, "left out") == f"left out 1 of 5 vehicles (2): {told}"
    every = document(GOOD).replace("<time><exact>7</exact>", "<time><exact>99</exact>")
    with pytest.raises(InputError, match=r"time step 6 is followed by 99.*; 5 obstacles have such faults"):
        find_source(written(tmp_path, every)).read()


# --- what is no traffic -----------------------------------------------------------------------------


def test_people_and_parked_vehicles_are_left_out(tmp_path: Path) -> None:
    text = document(GOOD)
    for number, kind in ((1, "pedestrian"), (2, "bicycle"), (4, "bicycle"), (5, "parkedVehicle")):
        text = of_one(text, number, lambda x, kind=kind: x.replace("<type>car<", f"<type>{kind}<"))  # type: ignore[misc]
    read = find_source(written(tmp_path, text)).read()
    assert read.vehicle_id.tolist() == [3]
    assert "left out 1 of 5 vehicles (1): they are pedestrians" in read.notes
    assert "left out 2 of 5 vehicles (2, 4): they are cyclists" in read.notes
    assert "left out 1 of 5 vehicles (5): they are parked vehicles" in read.notes
    assert find_source(tmp_path / "a.xml", strict=True).read().vehicles == 5


def test_vehicles_off_the_road(tmp_path: Path) -> None:
    """They are left out, also where they are so few that strict reading only notes them."""
    off = tuple(
        replace(car(k, 5.0), centres=tuple((5.0 + 2.0 * n, 10.0 * k) for n in range(STEPS))) for k in (8, 9)
    )
    read, why = both(written(tmp_path, document((*GOOD, *off))))
    assert "dynamicObstacle 8: on no lanelet at any time, like 2 obstacles" in why
    assert note_in(read, "left out") == "left out 2 of 7 vehicles (8, 9): on no lane at any time"
    many = tuple(car(10 + k, 10.0 * k, speed=3.0) for k in range(1, 10))
    path = written(tmp_path, document((*many, off[0])))
    assert find_source(path, strict=True).read().vehicles == 10
    assert find_source(path).read().vehicles == 9


def test_any_number_of_lanes(tmp_path: Path) -> None:
    """Of more lanes than a mask has bits those remain that a vehicle is ever in, with the same places."""
    more = "".join(lanelet(str(100 + k), 100 + 4 * k, 103 + 4 * k, (0, 80), "highway", "") for k in range(70))
    text = document(GOOD).replace("<dynamicObstacle", f"{more}<dynamicObstacle", 1)
    read, why = both(written(tmp_path, text))
    assert "73 lanes; at most 32 are supported, cut out a part" in why
    few = find_source(written(tmp_path / "few", document(GOOD))).read()
    assert note_in(read, "left out") == "left out 72 of 73 lanes: no vehicle is ever in them"
    assert [x.name for x in read.lanes] == ["1"]
    assert np.array_equal(read.inside[:, :2], few.inside[:, :2])
    assert np.array_equal(read.zones, few.zones)
    assert rp.roads(tmp_path / "a.xml")[0].vehicles == 5


# --- samples ----------------------------------------------------------------------------------------


def samples(folder: Path, rows: dict[str, list[tuple[float, float]]]) -> Path:
    """A CSV file with the (s, v_lon) of each vehicle, ten times a second, on a lane from 0 to 3.5."""
    lines = ["time,vehicle,s,d,v_lon,v_lat,a_lon,a_lat,length,width"]
    for name, course in rows.items():
        lines += [f"{k / 10:g},{name},{s:g},2.6,{v:g},0,0,0,4.5,1.8" for k, (s, v) in enumerate(course)]
    (folder / "a.csv").write_text("\n".join(lines) + "\n", "utf-8")
    bound = "s = [-inf, inf]\nd = [0, 3.5]\n"
    road = f'[[lanelet]]\nid = "r"\nlane = "slow"\nzone = "main"\nattribute = "main"\n{bound}'
    (folder / "a_road.toml").write_text(road, "utf-8")
    return folder / "a.csv"


def course(begin: float, speed: float, told: float = 1.0) -> list[tuple[float, float]]:
    return [(begin + speed * k / 10, told * speed) for k in range(STEPS)]


def test_samples_without_bad_vehicles(tmp_path: Path) -> None:
    rows = {str(k): course(30.0 * k, 20.0) for k in range(1, 6)}
    good = find_source(samples(tmp_path, rows)).read()
    wild = [(s, 300.0 if k == 3 else v) for k, (s, v) in enumerate(course(300.0, 20.0))]
    read, why = both(samples(tmp_path, {"8": wild, **rows, "9": course(500.0, 20.0, 3.6)}))
    assert "row 5, column v_lon=300.0: must lie between -250 and 250" in why
    told = "left out 1 of 7 vehicles (8): row 5, column v_lon=300.0: must lie between -250 and 250"
    assert told in read.notes
    [told] = (x for x in read.notes if x.startswith("left out 1 of 6 vehicles (9)"))
    assert "velocities along the road and positions contradict each other" in told
    assert read.vehicle_id.tolist() == good.vehicle_id.tolist()
    assert np.array_equal(read.s, good.s)
    with pytest.raises(InputError, match="column v_lon=300"):
        find_source(samples(tmp_path, {"8": wild, "1": rows["1"], "7": wild, "6": wild})).read()


# --- tracks in several files ------------------------------------------------------------------------


def cell(path: Path, row: int, column: str, value: str) -> None:
    """Another value in a cell; data rows count from 1."""
    lines = path.read_text("utf-8").splitlines()
    place = lines[0].split(",").index(column)
    lines[row] = ",".join(value if k == place else x for k, x in enumerate(lines[row].split(",")))
    path.write_text("\n".join(lines) + "\n", "utf-8")


@pytest.mark.parametrize(
    ("file", "column", "value", "told"),
    [
        ("tracks", "xVelocity", "-999", "must lie between -250 and 250"),
        ("tracks", "xAcceleration", "500", "must lie between -100 and 100"),
        ("tracksMeta", "width", "0", "the size of a vehicle is greater than zero; people have none"),
        ("tracksMeta", "length", "90", "no vehicle is larger than 50 m"),
        ("tracks", "heading", "nan", "column heading=nan: a number must be finite"),
    ],
)
def test_exid_without_bad_vehicles(file: str, column: str, value: str, told: str, tmp_path: Path) -> None:
    tracks = [Track(2, 0, cruise(30.0 * k, 20, 20, 2.7)) for k in range(3)]
    path = write_exid(make_recording(tracks), load_road("main-2"), tmp_path)
    good = find_source(path).read()
    cell(tmp_path / f"07_{file}.csv", 25 if file == "tracks" else 2, column, value)
    read, why = both(path)
    assert told in why
    assert read.vehicle_id.tolist() == [0, 2]
    assert note_in(read, "left out").startswith("left out 1 of 3 vehicles (1): row ")
    assert note_in(read, "left out").endswith(told)
    for k, v in ((0, 0), (1, 2)):
        ours, theirs = (x.s[x.start[n] : x.start[n + 1]] for x, n in ((read, k), (good, v)))
        assert np.array_equal(ours, theirs)


def test_highd_without_bad_vehicles(tmp_path: Path) -> None:
    tracks = [Track(2, 0, cruise(30.0 * k, 20, 20)) for k in range(3)]
    write_highd(make_recording(tracks), tmp_path)
    path = tmp_path / "01_tracks.csv"
    good = find_source(path).read()
    cell(path, 25, "xVelocity", "999")
    read, why = both(path)
    assert "row 26, column xVelocity=999.0: must lie between -250 and 250" in why
    assert read.vehicle_id.tolist() == [1, 3]
    assert note_in(read, "left out").startswith(
        "left out 1 of 3 vehicles (2): row 26, column xVelocity=999.0"
    )
    assert np.array_equal(read.s, np.concatenate((good.s[:20], good.s[40:])))


@pytest.mark.parametrize(
    ("column", "value", "told"),
    [
        ("x", "?", "row 26, column x=nan: a number must be finite"),
        ("yVelocity", "", "row 26, column yVelocity=nan: a number must be finite"),
        ("xAcceleration", "inf", "row 26, column xAcceleration=inf: a number must be finite"),
        (
            "frame",
            "?",
            "vehicle id=2, frame=5: the frame before it is 3; the frames of a vehicle have no gaps",
        ),
        ("laneId", "?", ""),
        (
            "frame",
            "77",
            "vehicle id=2, frame=5: the frame before it is 3; the frames of a vehicle have no gaps",
        ),
    ],
)
def test_gaps_and_unreadable_cells_of_highd(column: str, value: str, told: str, tmp_path: Path) -> None:
    """They cost their vehicle; the number of a lane, which the markings say too, costs nothing."""
    tracks = [Track(2, 0, cruise(30.0 * k, 20, 20)) for k in range(3)]
    write_highd(make_recording(tracks), tmp_path)
    path = tmp_path / "01_tracks.csv"
    good = find_source(path).read()
    cell(path, 25, column, value)
    read, why = both(path)
    if not told:
        assert "column laneId='?': a whole number is needed" in why
        assert read.vehicles == 3
        return
    assert note_in(read, "left out") == f"left out 1 of 3 vehicles (2): {told}"
    assert np.array_equal(read.s, np.concatenate((good.s[:20], good.s[40:])))


def test_an_unreadable_id_costs_the_recording(tmp_path: Path) -> None:
    write_highd(make_recording([Track(2, 0, cruise(30.0 * k, 20, 20)) for k in range(3)]), tmp_path)
    cell(tmp_path / "01_tracks.csv", 25, "id", "?")
    with pytest.raises(InputError, match=r"row 26, column id='\?': a whole number is needed"):
        find_source(tmp_path / "01_tracks.csv").read()


# --- answers say what was left out ------------------------------------------------------------------


def test_evaluations_say_it(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """On the screen and in JSON; strict runs reject the recording, and do not take what others found."""
    path, out = written(tmp_path, document((*GOOD, car(9, 5.0, told=2.0)))), tmp_path / "out"
    asked = ["evaluate", str(path), "--out", str(out), "--no-pictures"]
    assert main(asked) == ExitCode.AS_EXPECTED
    assert "note: recording a: left out 1 of 6 vehicles (9): velocities along" in capsys.readouterr().err
    notes = json.loads((out / "results.json").read_text("utf-8"))["notes"]["a"]
    assert any(x.startswith("left out 1 of 6 vehicles (9)") for x in notes)
    assert main([*asked, "--strict"]) == ExitCode.BAD_INPUT
    assert "by a factor of 2" in capsys.readouterr().err


def test_classes_and_gaps_say_it(tmp_path: Path) -> None:
    path = written(tmp_path, document((*GOOD, car(9, 5.0, told=2.0))))
    told = "recording a: left out 1 of 6 vehicles (9): velocities along the road"
    basis = Basis(bundled_library().select())
    [note] = count_in_traffic(basis, recordings_in(path), print).left_out
    assert note.startswith(told)
    assert settings.Coverage().strict is settings.Classify().strict is False
    with pytest.raises(InputError, match="by a factor of 2"):
        count_in_traffic(basis, recordings_in(path, strict=True), print)
    home = basis.specification
    (group,) = (plan := plan_of(home, (12,))).groups
    classes = Classes(plan, ((whole_cell(what_axis(plan, group, home), (12,), ()),),), ())
    library = with_classes(write_classes(classes, home), home)
    shares = count_shares(classes, library, basis.all_values(), [find_source(path).read()])
    assert shares.left_out == [note]


def test_monitors_say_it(tmp_path: Path) -> None:
    path = written(tmp_path, document((*GOOD, car(9, 5.0, told=2.0))))
    found = rp.monitor("F danger(SV, POV)", f"{path}:1,2")
    assert any(x.startswith("left out 1 of 6 vehicles (9)") for x in found.as_data()["notes"])
    with pytest.raises(InputError, match=r"no vehicle 9; ids are 1 to 5\nleft out 1 of 6 vehicles \(9\):"):
        rp.monitor("F danger(SV, POV)", f"{path}:1,9")
    with pytest.raises(InputError, match="by a factor of 2"):
        rp.monitor("F danger(SV, POV)", f"{path}:1,2", strict=True)
    assert read_pair(f"{path}:1,2").batch.lengths[0] == STEPS


def test_conversion_keeps_it(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path, out = written(tmp_path, document((*GOOD, car(9, 5.0, told=2.0)))), tmp_path / "out"
    assert main(["convert", str(path), "--out", str(out), "--strict"]) == ExitCode.BAD_INPUT
    assert main(["convert", str(path), "--out", str(out)]) == ExitCode.AS_EXPECTED
    read = find_source(out).read()
    assert read.vehicles == 5
    assert note_in(read, "left out").startswith("left out 1 of 6 vehicles (9)")

"""Traces of OSI on roads of maps: planted drives, fields by hand, who is left out, and damage."""

import math
import struct
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from extensions.traffic.planar_exid import osm_of
from extensions.traffic.test_exid import CASES, planted
from extensions.traffic.test_ind import around, bend_of
from extensions.traffic.test_ngsim import matches, on_road
from extensions.traffic.test_topology import with_ramps
from extensions.traffic.tiny_osi import Seen, moments_of, part, write_osi
from roadproof.errors import InputError
from roadproof.extensions.exchange.protobuf import WireError, doubles_in, fields_of, integer_in, message_in
from roadproof.extensions.traffic.formats.sources import find_source
from roadproof.reasons import ReasonKind

RATE = 25


def chart(folder: Path, name: str = "merge", case: str = "merge") -> str:
    folder.mkdir(parents=True, exist_ok=True)
    path = folder / "map.osm"
    path.write_text(osm_of(with_ramps(name), CASES[case][3]))
    return f"{path}#road=1"


def going(number: int, x: float, y: float, heading: float, v: float, count: int = 60) -> list[Seen]:
    """At constant speed; ``heading`` in degrees."""
    turn = math.radians(heading)
    cos, sin = math.cos(turn), math.sin(turn)
    places = [(x + v * cos * k / RATE, y + v * sin * k / RATE) for k in range(count)]
    return [Seen(number, (4.4, 1.8), place, turn, (v * cos, v * sin), (0.0, 0.0)) for place in places]


def at_once(*tracks: list[Seen]) -> list[list[Seen]]:
    return [[x[k] for x in tracks if k < len(x)] for k in range(max(map(len, tracks)))]


def two_cars() -> list[list[Seen]]:
    return at_once(going(7, -150, 1.75, 0, 30), going(3, -60, 5.25, 0, 30))


def test_fields_by_hand(tmp_path: Path) -> None:
    """The front is half a length ahead of the position, which is the middle of the box."""
    said = chart(tmp_path)
    path = write_osi(tmp_path, two_cars(), RATE, zero=10**18 + 5)
    source = find_source(path, road=said)
    r = source.read()
    assert (source.format.name, r.name, r.rate) == ("OSI", "trace", 25)
    assert [x.name for x in source.files] == ["map.osm", "trace.osi"]
    assert (r.vehicle_id.tolist(), r.kind.tolist()) == ([3, 7], ["Car", "Car"])
    assert (r.length.tolist(), r.width.tolist(), r.first_frame.tolist()) == ([4.4, 4.4], [1.8, 1.8], [0, 0])
    begin = r.start[1]
    assert r.s[begin] == pytest.approx(600 - 150 + 2.2, abs=1e-3)  # the map begins at -600 m
    assert r.d[0] - r.d[begin] == pytest.approx(3.5, abs=1e-3)
    assert r.v_lon == pytest.approx(np.full(120, 30.0), abs=1e-6)
    assert "host_vehicle_id is 0" in r.notes
    assert [x.name for x in r.lanes] == ["main-1", "main-2", "merge-1"]


def test_the_sensor_view_has_its_ground_truth(tmp_path: Path) -> None:
    said = chart(tmp_path)
    plain = find_source(write_osi(tmp_path / "a", two_cars(), RATE), road=said).read()

    def wrap(message: bytes) -> bytes:
        return part(3, b"\x08\x01") + part(7, message) + part(1000, b"")

    path = write_osi(tmp_path / "b", two_cars(), RATE, "2026_sv_380_600_60_x", wrap=wrap)
    assert find_source(path, road=said).read().s.tolist() == plain.s.tolist()
    other = write_osi(tmp_path / "c", two_cars(), RATE, "view", wrap=wrap)
    with pytest.raises(InputError, match=r"traces of SensorView have _sv_ in their names"):
        find_source(other, road=said).read()


def test_who_is_not_in_traffic_is_left_out_and_counted(tmp_path: Path) -> None:
    walker = [replace(x, type=3, kind=None) for x in going(20, 0, -5, 90, 1.5)]
    rider = [replace(x, kind=11, size=(1.8, 0.6)) for x in going(21, 0, -6, 90, 4)]
    box = [replace(x, type=1, kind=None) for x in going(22, 10, -6, 90, 0)]
    parked, elsewhere = going(23, 40, 1.75, 0, 0), going(24, 40, 80, 0, 12)
    cars = [going(7, -150, 1.75, 0, 30), going(3, -60, 5.25, 0, 30)]
    path = write_osi(tmp_path, at_once(*cars, walker, rider, box, parked, elsewhere), RATE)
    r = find_source(path, road=chart(tmp_path)).read()
    assert r.vehicle_id.tolist() == [3, 7]
    for told in (
        "left out 1 of 7 vehicles (20): they are pedestrians",
        "left out 1 of 7 vehicles (21): they are cyclists",
        "left out 1 of 7 vehicles (22): they are other objects",
        "left out 1 of 4 vehicles (23): they are parked, or stand all the time",
        "left out 1 of 4 vehicles (24): they are not on the road along it for a second",
    ):
        assert told in r.notes


def test_missing_accelerations_follow_from_velocities(tmp_path: Path) -> None:
    speeds = [20 + 1.5 * k / RATE for k in range(50)]
    places = np.cumsum([0, *(x / RATE for x in speeds[:-1])]).tolist()
    track = [Seen(1, (4.4, 1.8), (x, 1.75), 0.0, (v, 0.0), None) for x, v in zip(places, speeds, strict=True)]
    path = write_osi(tmp_path, at_once(track), RATE)
    r = find_source(path, road=chart(tmp_path)).read()
    assert r.a_lon == pytest.approx(np.full(50, 1.5), abs=1e-6)
    assert "velocities imply acceleration of 1 vehicles (1)" in r.notes
    assert not any("contradict" in x for x in r.notes)


def changed(moment: int, number: int, **values: object) -> Callable[[list[list[Seen]]], list[list[Seen]]]:
    """One object of a moment, or of all moments (-1), with other values."""

    def damage(moments: list[list[Seen]]) -> list[list[Seen]]:
        return [
            [
                replace(x, **values) if x.id == number and moment in (-1, k) else x  # type: ignore[arg-type]
                for x in there
            ]
            for k, there in enumerate(moments)
        ]

    return damage


DAMAGE: dict[str, tuple[Callable[[list[list[Seen]]], list[list[Seen]]], str]] = {
    "NaN": (
        changed(4, 7, place=(math.nan, 1.75)),
        "message 5, moving_object 7, position.x=nan: a finite number",
    ),
    "no velocity": (
        changed(4, 7, velocity=None),
        "message 5, moving_object 7, velocity.x=nan: a finite number",
    ),
    "too fast": (changed(4, 7, velocity=(900.0, 0.0)), "velocity.x=900.0: must lie between -250 and 250"),
    "too far": (changed(4, 7, place=(1e8, 0.0)), "position.x=100000000.0: must lie between"),
    "no size": (
        changed(-1, 7, size=(0.0, 1.8)),
        "message 1, moving_object 7, length=0.0: the size of a vehicle is",
    ),
    "another size": (
        changed(4, 7, size=(4.5, 1.8)),
        "message 5, moving_object 7, length=4.5: the size .* same",
    ),
    "degrees": (changed(-1, 7, yaw=200.0), "yaw=200.0: must lie between -100 and 100"),
    "km/h": (changed(-1, 7, velocity=(108.0, 0.0)), "velocities along the road and positions contradict"),
    "a gap": (
        lambda moments: [[x for x in there if x.id != 7 or k != 9] for k, there in enumerate(moments)],
        "message 11, moving_object 7, message=11: a vehicle is once in each message",
    ),
    "twice": (
        changed(-1, 3, id=7),
        "message 1, moving_object 7, message=1: a vehicle is once in each message",
    ),
    "off the road": (
        lambda moments: [[replace(x, place=(x.place[0], 90.0)) for x in there] for there in moments],
        "no vehicle is on road .*map.osm#road=1 for a second; do map and positions fit",
    ),
    "no vehicle": (lambda moments: [[] for _ in moments], "no moving_object is a vehicle in traffic"),
    "a large id": (changed(-1, 7, id=2**40), "ids of moving objects must lie between 0 and 999999999"),
}


@pytest.mark.parametrize("name", DAMAGE)
def test_damage_is_named(name: str, tmp_path: Path) -> None:
    damage, said = DAMAGE[name]
    path = write_osi(tmp_path, damage(two_cars()), RATE)
    with pytest.raises(InputError, match=said):
        find_source(path, strict=True, road=chart(tmp_path)).read()


def test_a_bad_vehicle_is_left_out(tmp_path: Path) -> None:
    moments = changed(4, 7, velocity=(900.0, 0.0))(two_cars())
    r = find_source(write_osi(tmp_path, moments, RATE), road=chart(tmp_path)).read()
    assert r.vehicle_id.tolist() == [3]
    assert any(x.startswith("left out 1 of 2 vehicles (7): message 5, moving_object 7") for x in r.notes)


@pytest.mark.parametrize("far", range(4))
def test_who_drives_far_beside_the_line_of_a_bend_is_left_out(far: int, tmp_path: Path) -> None:
    """As in inD: 5.25 m beside a line with a radius of 60 m ways are 8.8 % longer."""
    cars = [(-5.25 if k == far else -1.75, 10.0 + 8 * k) for k in range(4)]
    tracks = [
        [
            Seen(number, (4.4, 1.8), (x, y), math.radians(way), (vx, vy), None)
            for x, y, way, vx, vy in around(60.0, d, begin)
        ]
        for number, (d, begin) in enumerate(cars, start=20)
    ]
    path, chart = write_osi(tmp_path, at_once(*tracks), RATE), bend_of(tmp_path, 60.0)
    read = find_source(path, road=chart).read()
    assert read.vehicle_id.tolist() == [k for k in range(20, 24) if k != 20 + far]
    told = f"left out 1 of 4 vehicles ({20 + far}): {ReasonKind.OFF_LINE()}"
    assert told in read.notes
    with pytest.raises(InputError, match=rf"way of 1 of 4 vehicles \({20 + far}\)"):
        find_source(path, strict=True, road=chart).read()


def test_messages_are_equally_far_apart(tmp_path: Path) -> None:
    said = chart(tmp_path)
    content = write_osi(tmp_path, two_cars(), RATE).read_bytes()
    messages, place = list[bytes](), 0
    while place < len(content):
        size = struct.unpack_from("<I", content, place)[0]
        messages.append(content[place : place + 4 + size])
        place += 4 + size
    path = tmp_path / "hurt.osi"
    for kept, told in (
        ([*messages[:20], *messages[21:]], r"message 21, timestamp=0.84 s: messages are 1/25 s apart"),
        (
            [*messages[:20], messages[19], *messages[20:]],
            r"message 21, timestamp=0.76 s: messages are 1/25 s",
        ),
        (messages[::-1], "at least two messages are needed, each later"),
        (messages[:1], "at least two messages are needed"),
    ):
        path.write_bytes(b"".join(kept))
        with pytest.raises(InputError, match=told):
            find_source(path, road=said).read()
    for cut, told in (
        (-3, "message 60: the file was cut off"),
        (-len(messages[-1]) + 2, "message 60: the file was"),
    ):
        path.write_bytes(content[:cut])
        with pytest.raises(InputError, match=told):
            find_source(path, road=said).read()
    path.write_bytes(struct.pack("<I", 3) + b"\x0f\x01\x02")
    with pytest.raises(InputError, match=r"message 1: no message of OSI .a field has the unknown wire"):
        find_source(path, road=said).read()


def test_a_road_is_needed(tmp_path: Path) -> None:
    path = write_osi(tmp_path, two_cars(), RATE)
    with pytest.raises(InputError, match=r"trace.osi: the files name no lanes: give a road of a map"):
        find_source(path).read()


def test_wire_format() -> None:
    """The examples of the encoding guide: 150 is 96 01, and the text testing in field 2."""
    assert list(fields_of(b"\x08\x96\x01")) == [(1, 150)]
    assert list(fields_of(b"\x12\x07testing")) == [(2, b"testing")]
    assert list(fields_of(b"\x0d\x01\x00\x00\x00")) == [(1, b"\x01\x00\x00\x00")]
    assert message_in(b"\x12\x07testing\x12\x01x", 2) == b"x"
    assert integer_in(b"\x08" + b"\xff" * 9 + b"\x01", 1) == -1
    assert doubles_in(b"\x11" + struct.pack("<d", 2.5), 3) == (0.0, 2.5, 0.0)
    for broken in (b"\x08", b"\x12\x07test", b"\x08" + b"\xff" * 11, b"\x0b", b"\x09\x00"):
        with pytest.raises(WireError):
            list(fields_of(broken))
    for wrong in (
        lambda: integer_in(b"\x12\x01x", 2),
        lambda: message_in(b"\x08\x01", 1),
        lambda: doubles_in(b"\x08\x01", 1),
    ):
        with pytest.raises(WireError):
            wrong()


@pytest.mark.parametrize("case", ["merge, turned", "exit, bent"])
def test_planted_drives_have_the_verdicts_of_their_samples(case: str, tmp_path: Path) -> None:
    name, shift, begin, bend = CASES[case]
    recording, who = planted(begin)
    path = write_osi(tmp_path, moments_of(recording, bend), RATE)
    found = matches(find_source(path, road=chart(tmp_path, name, case)).read())
    assert found == matches(on_road(recording, with_ramps(name), RATE))
    shown = {(sv, pov, scenario) for sv, pov, _, scenario, *_ in found}
    assert {
        (sv + 1, pov + 1, number + shift) for number, (sv, *_, pov) in who.items() if number != 2
    } <= shown

"""Animations of drives as GIF and MP4 files: their frames, their lengths, and what they show when."""

import os
import shutil
from dataclasses import replace
from fractions import Fraction as F
from functools import cache
from io import BytesIO
from pathlib import Path

import pytest
from PIL import Image

import roadproof as rp
from extensions.pages.report.test_drive import CROSSING, THREE, driving, file_of
from roadproof.errors import MissingSolverError
from roadproof.evidence.drive_file import DriveFile, load_drive
from roadproof.extensions.pages.animation import draw_animation
from roadproof.extensions.pages.frames import MOST_FRAMES, draw_film
from roadproof.extensions.pages.scene import AnimationScene
from roadproof.frontends.cli.main import main
from roadproof.frontends.report.colours import COLOURS, DANGER, SHADES
from roadproof.library.loading import bundled_library
from roadproof.world.motion import state_at

LIBRARY = bundled_library()
DRIVES = Path(__file__).parents[4] / "examples" / "traffic" / "drives"
FILE = load_drive(DRIVES / "scenario-01-base.json")
Pixels = list[tuple[int, int]]


@cache
def example() -> bytes:
    """The GIF file of ``FILE``."""
    return draw_animation(FILE, LIBRARY, "gif")


def frames_of(file: DriveFile) -> list[tuple[F, Image.Image]]:
    """The frames of a GIF file, each with the time at which it appears, in seconds."""
    film = Image.open(BytesIO(example() if file is FILE else draw_animation(file, LIBRARY, "gif")))
    frames, since = [], F(0)
    for k in range(film.n_frames):
        film.seek(k)
        frames.append((since, film.convert("RGB")))
        since += F(film.info["duration"], 1000)
    return [*frames, (since, frames[-1][1])]


def box_of(frame: Image.Image, colour: str, scene: AnimationScene) -> tuple[float, float]:
    """Left edge and middle of the height of a colour on the road, in m from SV's front and across."""
    rgb = tuple(bytes.fromhex(colour[1:]))
    left, top, width, height = scene.pixels((*scene.window, *scene.across))
    places: Pixels = [
        (x, y)
        for x in range(int(left), int(left + width))
        for y in range(int(top), int(top + height))
        if frame.getpixel((x, y)) == rgb
    ]
    x, rows = min(x for x, _ in places), sorted({y for _, y in places})
    along, across = scene.scale
    return (x - left) / along + scene.window[0], scene.across[1] - (
        (rows[0] + rows[-1] + 1) / 2 - top
    ) / across


def test_a_gif_file_has_twelve_frames_a_second_and_rests_at_the_end() -> None:
    frames = frames_of(FILE)
    assert len(frames) - 1 == 6 * 12 + 1
    assert frames[-1][0] == FILE.horizon + 1
    assert [since for since, _ in frames[:-1]] == [F(round(100 * F(k, 12)), 100) for k in range(73)]
    assert frames[0][1].tobytes() != frames[-1][1].tobytes()


@pytest.mark.parametrize("file", [FILE, file_of(2, "scenario_2(SV, POV1, POV2, L)", **THREE)])
def test_a_gif_file_of_six_seconds_is_small(file: DriveFile) -> None:
    assert len(draw_animation(file, LIBRARY, "gif")) < 300_000


@pytest.mark.parametrize("k", [0, 25, 50, 72])
def test_frames_show_vehicles_where_the_drive_has_them(k: int) -> None:
    scene = AnimationScene(FILE, LIBRARY)
    time = F(k, 12)
    frame = frames_of(FILE)[k][1]
    sv, pov = (FILE.drive.vehicles[name] for name in ("SV", "POV"))
    at_sv, at_pov = state_at(sv, time), state_at(pov, time)
    pixel = 1.5 / scene.scale[0]
    for colour, motion, state in zip(COLOURS, (sv, pov), (at_sv, at_pov), strict=False):
        rear, middle = box_of(frame, colour, scene)
        assert rear == pytest.approx(float(state.s - motion.length - at_sv.s), abs=pixel)
        assert middle == pytest.approx(float(state.d - motion.width / 2), abs=pixel)


def test_the_area_of_a_frame_is_red_while_the_vehicle_is_in_it() -> None:
    file = file_of(None, "F danger(SV, POV)", **CROSSING)
    [area] = AnimationScene(file, LIBRARY, grain=F(1, 12)).areas()
    seen = set()
    for (_, frame), (left, top, *_), red in zip(frames_of(file), area.boxes, area.red, strict=False):
        shown = frame.getpixel((int(left + 3), int(top + 3)))
        found = [fill for fill in (DANGER, area.fill) if max(apart(shown, fill)) < 4]
        if found:
            assert found == [DANGER if red else area.fill]
        seen |= {*found}
    assert seen == {DANGER, area.fill}


def apart(shown: tuple[int, ...], fill: str) -> list[float]:
    """How much a colour differs from that of an area on the road."""
    road, over = (bytes.fromhex(x[1:]) for x in (SHADES["main"], fill))
    return [abs(a - 0.8 * b - 0.2 * c) for a, b, c in zip(shown, road, over, strict=True)]


def test_a_long_drive_has_fewer_frames_a_second() -> None:
    film = draw_film(replace(file_of(), horizon=F(400)), LIBRARY)
    assert film.count == MOST_FRAMES + 1
    assert film.grain * MOST_FRAMES == 400


def test_a_drive_of_one_vehicle_has_frames() -> None:
    frames = frames_of(file_of(None, "v_lon(SV) > 0 m/s", SV=driving(0, 30)))
    assert frames[0][1].tobytes() != frames[5][1].tobytes()


def test_the_same_drive_gives_the_same_gif_file() -> None:
    assert draw_animation(FILE, LIBRARY, "gif") == example()


# --- The command line and Python


def test_witness_writes_animations_beside_the_drive(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    asked = ["witness", "1", "--no-pictures", "--jobs", "1", "--out", str(tmp_path)]
    assert main([*asked, "--animate", "svg,gif"]) == 0
    names = [f"scenario-01-base{x}" for x in (".json", ".csv", "-moving.svg", ".gif")]
    assert f"written to {tmp_path}: {', '.join(names)}" in capsys.readouterr().out
    assert all((tmp_path / name).stat().st_size for name in names)
    gif = (tmp_path / names[-1]).read_bytes()
    exported = rp.export(tmp_path / names[0], "gif", tmp_path / "again")
    assert [x.name for x in exported.files] == ["scenario-01-base.gif"]
    assert exported.files[0].read_bytes() == gif
    (tmp_path / names[-2]).unlink()
    assert main([*asked, "--animate", "svg"]) == 0
    assert all((tmp_path / name).exists() for name in names)  # also the one that was not asked for again


def test_another_drive_takes_the_animation_of_a_former_one_away(tmp_path: Path) -> None:
    rp.witness(1, out=tmp_path, pictures=False, animate="gif", jobs=1)
    assert (tmp_path / "scenario-01-base.gif").exists()
    rp.witness(1, objective="any", out=tmp_path, pictures=False, jobs=1)
    assert not (tmp_path / "scenario-01-base.gif").exists()


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ({"animate": "webm", "out": "x"}, "there is no format 'webm'; there are gif, mp4, svg"),
        ({"animate": ["gif", "gfi"], "out": "x"}, "did you mean 'gif'"),
        ({"animate": "gif"}, "animate=gif: name a folder for the animations with --out DIR"),
    ],
)
def test_animations_that_cannot_be_asked_for(options: dict[str, object], words: str) -> None:
    with pytest.raises(rp.UsageError) as error:
        rp.witness(1, **options)
    assert words in str(error.value)


def test_mp4_without_ffmpeg_is_refused_before_the_search(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setenv("PATH", str(tmp_path))
    assert main(["witness", "1", "--animate", "mp4", "--out", str(tmp_path / "out")]) == 4
    assert "mp4 needs the program ffmpeg: install it" in capsys.readouterr().err
    assert not (tmp_path / "out").exists()


def pretend(folder: Path, script: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """A program named ffmpeg that does what the script says."""
    program = folder / "ffmpeg"
    program.write_text(f"#!/bin/sh\n{script}\n", "utf-8")
    program.chmod(0o755)
    monkeypatch.setenv("PATH", f"{folder}{os.pathsep}{os.environ['PATH']}")


def test_ffmpeg_is_given_each_frame(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    pretend(tmp_path, 'for last; do :; done; echo "$@" > "$last"; wc -c >> "$last"', monkeypatch)
    told, size = draw_animation(FILE, LIBRARY, "mp4").decode().splitlines()
    film = draw_film(FILE, LIBRARY)
    assert f"-s {film.size[0]}x{film.size[1]} -r 12 -i -" in told
    assert int(size) == 4 * film.size[0] * film.size[1] * 12 * 7


def test_what_ffmpeg_complains_of_is_told(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    pretend(tmp_path, "echo 'Unknown encoder' >&2; exit 1", monkeypatch)
    with pytest.raises(MissingSolverError, match="ffmpeg cannot write mp4: Unknown encoder; install"):
        draw_animation(FILE, LIBRARY, "mp4")


@pytest.mark.skipif(shutil.which("ffmpeg") is None, reason="ffmpeg is not installed")
def test_ffmpeg_writes_an_mp4_file() -> None:
    assert draw_animation(FILE, LIBRARY, "mp4")[4:8] == b"ftyp"

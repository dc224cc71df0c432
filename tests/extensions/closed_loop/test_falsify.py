"""``falsify``: failures are judged drives, the same seed gives the same bytes, and nothing is lost."""

import json
import os
import signal
import subprocess
import sys
import time
from fractions import Fraction
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import roadproof as rp
from extensions.closed_loop.loops import VEHICLES, loop_of, problem, question
from roadproof.errors import InputError, UsageError
from roadproof.evidence.drive_file import load_drive
from roadproof.evidence.judged import judge_file
from roadproof.extensions.closed_loop.controllers.opening import source_of
from roadproof.extensions.closed_loop.falsifying import Falsification
from roadproof.extensions.closed_loop.requirement_words import with_words
from roadproof.extensions.closed_loop.search.boundary import boundary_line, is_prevented
from roadproof.extensions.closed_loop.search.margins import Ruler
from roadproof.extensions.closed_loop.search.searching import Searching
from roadproof.extensions.closed_loop.simulation import exact_drive
from roadproof.frontends.cli.main import main
from roadproof.verdict import ExitCode
from roadproof.world.drive import Drive
from roadproof.world.motion import states_at

EXAMPLES = Path(__file__).parents[3] / "examples" / "closed-loop"


def falsify(name: str, **more: Any) -> Falsification:
    known = {
        "among": 4,
        "classes": False,
        "drivers": ["careful"],
        "simulations": 150,
        "jobs": 1,
        "fresh": True,
    }
    return rp.falsify(f"{VEHICLES}:{name}", **{**known, **more})


@pytest.fixture(scope="module")
def late(tmp_path_factory: pytest.TempPathFactory) -> Falsification:
    folder = tmp_path_factory.mktemp("late")
    return falsify("LateBrake", among="1,4", out=folder)


def test_a_failure_is_a_judged_drive_that_a_driver_prevents(late: Falsification) -> None:
    assert late.findings == {"scenario_1": "FAILS", "scenario_4": "FAILS"}
    assert late.exit_code is ExitCode.UNEXPECTED
    for x in late.targets:
        assert x.preventable_by == ("careful",)
        assert x.drive is not None
        assert judge_file(x.drive.file, late.library).accepted
        driven = x.driven["careful"].drive
        assert driven is not None
        pov = x.drive.file.drive.vehicles["POV"]
        assert driven.file.drive.vehicles["POV"] == pov  # the same course
        assert driven.file.drive.vehicles["SV"] != x.drive.file.drive.vehicles["SV"]


def test_the_failure_is_what_the_controller_does_in_that_situation(late: Falsification) -> None:
    """An independent replay: boxes of ``world.motion`` at fine instants touch, and SV moves as demanded."""
    for x in late.targets:
        assert x.drive is not None and x.simulations is not None  # noqa: PT018
        number = int(x.name.partition("_")[2])
        asked = problem(number)
        again = exact_drive(loop_of("LateBrake"), asked.shape.situation([*x.simulations.values.values()]))
        assert again == x.drive.file.drive
        times = [Fraction(k, 100) for k in range(1001)]
        sv, pov = (states_at(again.vehicles[name], times) for name in ("SV", "POV"))
        assert any(
            a.s >= b.s - Fraction(9, 2) and b.s >= a.s - Fraction(9, 2) and abs(a.d - b.d) <= Fraction(9, 5)
            for a, b in zip(sv, pov, strict=True)
        )


def test_check_judges_all_drives_again(late: Falsification, capsys: pytest.CaptureFixture[str]) -> None:
    assert late.folder is not None
    assert main(["check", str(late.folder)]) == 0
    assert "9 of 9 accepted" in capsys.readouterr().out or late.check().accepted


@pytest.mark.parametrize("damage", ["drive", "counts", "driver"])
def test_check_rejects_planted_mistakes(
    late: Falsification, damage: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    folder = tmp_path / "copy"
    late.save(folder, pictures=False)
    name = {
        "drive": "fails-scenario_4",
        "counts": "simulated-scenario_4",
        "driver": "fails-scenario_4-careful",
    }[damage]
    path = folder / f"{name}.json"
    content = json.loads(path.read_text())
    if damage == "counts":
        content["count"] += 1
    else:  # SV begins far behind, and never meets POV; or far ahead
        content["vehicles"]["SV"]["s"] = "-900" if damage == "drive" else "0"
    path.write_text(json.dumps(content))
    assert main(["check", str(folder)]) != 0
    assert "rejected" in capsys.readouterr().out


def test_two_classes_in_a_file_are_two_controllers() -> None:
    one, other = (source_of(f"{VEHICLES}:{name}") for name in ("Coasting", "LateBrake"))
    assert one.sha256 != other.sha256


def command(name: str, *more: str, among: str = "1,4") -> list[str]:
    """Return the command line of ``falsify`` in a process of its own, which starts workers."""
    asked = [sys.executable, "-m", "roadproof", "falsify", f"{VEHICLES}:{name}", "--among", among]
    words = "--no-classes --drivers careful --simulations 150 --fresh --quiet --no-pictures"
    return [*asked, *words.split(), *more]


def test_the_same_bytes_with_one_and_two_processes(late: Falsification, tmp_path: Path) -> None:
    assert late.folder is not None
    for jobs in "12":
        subprocess.run([*command("LateBrake"), "--jobs", jobs, "--out", str(tmp_path / jobs)], timeout=300)
        for path in sorted(late.folder.glob("*.json")):
            assert (tmp_path / jobs / path.name).read_bytes() == path.read_bytes(), path.name


def test_another_seed_gives_another_search() -> None:
    outcomes = [Searching(problem(4), 64, seed, "random").run(loop_of("Coasting")) for seed in (0, 0, 1)]
    assert outcomes[0].points == outcomes[1].points != outcomes[2].points


def test_a_collision_after_the_controller_has_driven_is_no_failure() -> None:
    """SV keeps its speed after the last step, and then meets POV: that is not what the controller did."""
    asked = problem(4, seconds=Fraction(1))
    assert asked.fails is not None
    whole = problem(4)
    found = Searching(whole, 100, 0).run(loop_of("Coasting"))
    assert found.failing is not None
    situation = asked.shape.situation(whole.shape.seed)
    drive = exact_drive(loop_of("Coasting"), situation)
    sv, pov = (states_at(drive.vehicles[name], [Fraction(1), Fraction(200)]) for name in ("SV", "POV"))
    assert sv[0].s < pov[0].s - 4.5
    assert sv[1].s > pov[1].s
    assert asked.judged(situation, loop_of("Coasting"), asked.fails, may_overlap=True) is None


def test_failures_that_no_driver_prevents_do_not_count_where_only_preventable_ones_do() -> None:
    any_one = falsify("Coasting", among=3, simulations=64)
    assert (any_one.findings, any_one.exit_code) == ({"scenario_3": "FAILS"}, ExitCode.UNEXPECTED)
    preventable = falsify("Coasting", among=3, simulations=64, failures="preventable")
    assert preventable.findings == {"scenario_3": "SHOWN"}
    assert preventable.exit_code is ExitCode.AS_EXPECTED


def test_no_word_claims_safety(late: Falsification) -> None:
    calm = falsify("Standing", among=2, simulations=40)
    for text in (str(calm), str(late)):
        assert "simulations show failures; that none was found shows nothing about other drives" in text
        assert not {"safe", "passed", "proved", "verified"} & {*text.lower().split()}


def test_a_controller_that_ends_its_process_ends_no_other(tmp_path: Path) -> None:
    for among in ("4", "1,4"):
        folder = tmp_path / among
        ended = subprocess.run(
            [*command("Dying", among=among), "--out", str(folder)],
            capture_output=True,
            text=True,
            timeout=300,
        )
        assert ended.returncode == ExitCode.UNKNOWN, ended.stderr
        assert ended.stdout.count("ERROR") == len(among.split(","))
        assert "exited with 9" in ended.stdout
        assert (folder / "possible-scenario_4.json").exists()


def test_a_controller_that_never_fails_has_to_be_deterministic(tmp_path: Path) -> None:
    """Drives are asked for twice, also where no failure is judged."""
    found = falsify("Fickle", drivers=[], simulations=30, out=tmp_path / "out")
    assert found.findings == {"scenario_4": "ERROR"}
    assert "it is not deterministic" in found.targets[0].reason


@pytest.mark.parametrize("jobs", [1, 2])
def test_the_answer_is_not_mixed_with_what_a_controller_prints(jobs: int) -> None:
    asked = [
        sys.executable,
        "-m",
        "roadproof",
        "falsify",
        f"{VEHICLES}:Talking",
        "--among",
        "4",
        "--json",
        "-",
    ]
    asked += ["--no-classes", "--drivers", "none", "--simulations", "10", "--fresh", "--jobs", str(jobs)]
    done = subprocess.run(asked, capture_output=True, text=True, check=False)
    assert json.loads(done.stdout)["targets"][0]["finding"] in ("FAILS", "SHOWN", "NOT SHOWN")
    assert "step" in done.stderr


@pytest.mark.parametrize("name", ["NotANumber", "Raising", "Moody"])
def test_a_controller_that_fails_to_answer_is_an_error_of_its_own(name: str, tmp_path: Path) -> None:
    answer = falsify(name, out=tmp_path)
    assert answer.exit_code in (ExitCode.UNKNOWN, ExitCode.UNEXPECTED)
    [target] = answer.targets
    assert target.finding == "ERROR"
    assert target.reason
    assert (tmp_path / "possible-scenario_4.json").exists()  # what was answered before stays


def test_a_killed_worker_is_replaced(tmp_path: Path) -> None:
    """kill -9 of a process of the pool: its job runs again, and the answer is the same."""
    ends = []
    for kills in (False, True):
        folder = tmp_path / str(kills)
        asked = [*command("LateBrake"), "--jobs", "2", "--out", str(folder)]
        process = subprocess.Popen(asked, stdout=subprocess.PIPE, text=True)
        if kills:
            _kill_a_worker(process.pid)
        text, _ = process.communicate(timeout=300)
        ends.append((process.returncode, text, (folder / "fails-scenario_4.json").read_bytes()))
    assert ends[0] == ends[1]


def _kill_a_worker(root: int) -> None:
    """Kill the first process two levels below the command: the command watches one that has workers."""
    latest = time.monotonic() + 60
    while time.monotonic() < latest:
        for child in _children(root):
            if workers := _children(child):
                os.kill(workers[-1], signal.SIGKILL)
                return
        time.sleep(0.02)


def _children(pid: int) -> list[int]:
    try:
        return [int(x) for x in Path(f"/proc/{pid}/task/{pid}/children").read_text().split()]
    except OSError:
        return []


@pytest.mark.parametrize(
    ("require", "told"),
    [
        ("not collision(SV, POV)", "write one G (...) for each --require"),
        ("G[0, 3 s] not collision(SV, POV)", "write one G (...) for each --require"),
        ("G F not collision(SV, POV)", "give F, G and U in it an end"),
    ],
)
def test_a_requirement_that_no_drive_decides_is_refused(require: str, told: str) -> None:
    with pytest.raises(UsageError) as error:
        _ = question(4, require=(require,)).requirements
    assert told in str(error.value)


def test_other_requirements_are_searched_for() -> None:
    soft = falsify("LateBrake", require=["G a_lon(SV) >= -5 m/s^2"])
    assert soft.findings == {"scenario_4": "FAILS"}
    [x] = soft.targets
    assert x.drive is not None
    assert "F[0 s, 10 s] not (a_lon(SV) >= -5 m/s^2)" in x.drive.file.formula
    assert "preventable" not in {d.side for d in x.decisions}  # the careful driver brakes harder, too


def test_a_driver_prevents_a_failure_only_if_its_own_drive_keeps_the_requirement() -> None:
    """In scenario 2 the model looks at POV2; a collision with POV1 is one, too."""
    asked = problem(2)
    assert asked.breach is not None
    assert "collision(SV, POV1)" in asked.breach.text
    assert "collision(SV, POV2)" in asked.breach.text


def test_wrong_controllers_are_refused_by_name(tmp_path: Path) -> None:
    empty = tmp_path / "broken.py"
    empty.write_text("def step(:\n")
    cases: dict[str, type[Exception]] = {
        str(VEHICLES): UsageError,
        f"{VEHICLES}:Nobody": InputError,
        f"{VEHICLES}:NOT_CALLABLE": InputError,
        f"{empty}:step": InputError,
        f"{tmp_path}/none.py:step": InputError,
        "no-such-program --fast": InputError,
        "": UsageError,
    }
    for controller, kind in cases.items():
        with pytest.raises(kind):
            rp.falsify(controller, among=4, classes=False, simulations=1)


def test_words_for_requirements_are_added_once() -> None:
    once = with_words(rp.load())
    assert with_words(once) is once


def test_failing_drives_become_tests_of_a_catalogue(late: Falsification, tmp_path: Path) -> None:
    written = late.write_tests(tmp_path, "openscenario,commonroad")
    assert (len(written.tests), written.copies) == (2, 4)
    assert load_drive(tmp_path / "failure-scenario_4.json").scenario == 4
    report = rp.catalogue(tmp_path, among="1,4", classes=False, drivers=["careful"])
    assert report.missing == ()


@pytest.mark.parametrize(("name", "failing"), [("Aeb", set[int]()), ("LateAeb", {1, 2, 4, 9, 17})])
def test_drivers_prevent_failures_of_the_late_example_only(name: str, failing: set[int]) -> None:
    """Of 5,000 simulations in each of 1 to 9 and 17, none of the good one's was preventable."""
    answer = rp.falsify(
        f"{EXAMPLES / 'aeb.py'}:{name}",
        among=[1, 2, 4, 9, 17],
        classes=False,
        failures="preventable",
        simulations=500,
        jobs=1,
    )
    assert {x.name for x in answer.view.failures} == {f"scenario_{n}" for n in failing}
    assert all(x.preventable_by for x in answer.view.failures)


def test_a_search_also_starts_from_drives(late: Falsification, tmp_path: Path) -> None:
    """The first generation has the values of the failing drive; without it, it has not."""
    late.write_tests(tmp_path / "tests")
    plain = falsify("HardBrake", simulations=60, seed=5)
    seeded = falsify("HardBrake", simulations=60, seed=5, seeds=tmp_path / "tests")
    [y] = seeded.targets
    x = next(z for z in late.targets if z.name == y.name)
    assert x.simulations is not None
    assert y.simulations is not None
    known = x.simulations.values
    places = {(p.gap, p.faster) for p in y.simulations.points}
    place = known["POV.gap"], -known["POV.faster"]
    assert place in places
    [z] = plain.targets
    assert z.simulations is not None
    assert place not in {(p.gap, p.faster) for p in z.simulations.points}
    assert z.simulations.key != y.simulations.key
    fails = falsify("LateBrake", simulations=60, seed=5, seeds=tmp_path / "tests")
    assert fails.findings == {"scenario_4": "FAILS"}
    assert plain.question.settings.seeds == ()
    assert len(seeded.question.settings.seeds) == 2
    assert x.simulations.key != y.simulations.key
    with pytest.raises(InputError, match="there is no drive file"):
        falsify("LateBrake", seeds=tmp_path)


def test_knobs_are_fitted_to_other_drives(late: Falsification) -> None:
    """The values of a situation come back from its drive, but for instants."""
    one = problem(4)
    x = next(z for z in late.targets if z.name == one.name)
    assert x.drive is not None
    assert x.simulations is not None
    drive = x.drive.file.drive
    assert one.shape.fits(drive)
    values = dict(zip((k.name for k in one.shape.knobs), one.shape.fitted(drive), strict=True))
    for name in ("SV.speed", "POV.gap", "POV.faster"):
        assert values[name] == x.simulations.values[name]
    turned = Drive({"SV": drive.vehicles["POV"], "POV": drive.vehicles["SV"]})
    assert not one.shape.fits(turned)
    assert not one.shape.fits(Drive({"SV": drive.vehicles["SV"]}))


def test_the_boundary_of_a_driver_model_parts_gaps() -> None:
    """Just below the boundary the model collides, just above it does not; lines are those of the file."""
    one = problem(4)
    line = boundary_line(one, one.shape.seed)
    assert len(line) > 4
    names = [k.name for k in one.shape.knobs]
    for gap, faster in line:
        sides = []
        for change in (-0.8, 0.8):
            values = list(one.shape.seed)
            values[names.index("POV.gap")], values[names.index("POV.faster")] = gap + change, -faster
            sides += is_prevented(one, [tuple(values)])
        assert sides == [False, True]


def test_a_failure_is_made_simple(late: Falsification) -> None:
    for x in late.targets:
        assert x.simulations is not None
        known = x.simulations.values
        assert any(value % 5 == 0 for name, value in known.items() if name.endswith((".gap", ".speed")))


def test_a_page_plays_the_failing_drive_beside_those_of_the_driver_models(
    late: Falsification, tmp_path: Path
) -> None:
    assert late.folder is not None
    rp.page(late.folder, out=tmp_path / "page.html")
    text = (tmp_path / "page.html").read_text("utf-8")
    summary = text.partition('id="result-0"')[0]
    failing = [x.name for x in late.view.failures]
    assert failing
    assert f"{len(failing)} FAILS" in summary
    assert all(f"{name}, " in summary for name in failing)
    assert "your vehicle fails" in text
    assert "gap at the start (m)" in text
    for x in ("scenario_1", "scenario_4"):
        assert f'id="fails-0-{x}"' in text
        assert f'id="fails-0-{x}-careful"' in text
    assert "The drive cannot be shown" not in text
    assert text.count("<circle") >= sum(x.simulations.count for x in late.targets if x.simulations)


def test_build_servers_read_each_scenario(late: Falsification) -> None:
    assert late.to_junit().count("<failure") == 2
    assert "preventable by careful" in late.to_sarif()


def test_classes_that_no_drive_shows_are_aimed_at(tmp_path: Path) -> None:
    answer = falsify("Coasting", among="4,8", classes=True, simulations=64, out=tmp_path, drivers=[])
    classes = {x.name: x for x in answer.targets if not x.is_scenario}
    assert {*classes} == {"class_4", "class_8", "class_4_8"}
    assert answer.view.classes_shown == sum(bool(x.shown_by) for x in classes.values()) >= 2
    aimed_at = {name for name, x in classes.items() if x.simulations is not None}
    by_others = {name for name, x in classes.items() if {*x.shown_by} - {f"shown-{name}"}}
    assert aimed_at == {*classes} - by_others
    assert main(["check", str(tmp_path)]) == 0


def test_classes_are_left_out_where_rows_of_the_table_are_not_whole() -> None:
    answer = falsify("Coasting", among="1,2,9", classes=True, simulations=1, drivers=[])
    assert not answer.view.classes_asked
    assert "note: classes are left out" in str(answer)


def test_what_no_drive_can_show_is_proved_impossible(tmp_path: Path) -> None:
    spec = tmp_path / "never.spec"
    spec.write_text(
        'def scenario_30(SV, POV: vehicle, L: lane) "safe and too near at once"\n'
        "  := atLane(SV, L) and initSafe(SV, POV) and rssViolation(SV, POV)\n"
    )
    answer = falsify("Coasting", among=30, using=rp.load(specs=[spec]))
    assert answer.findings == {"scenario_30": "IMPOSSIBLE"}
    assert answer.exit_code is ExitCode.AS_EXPECTED
    [target] = answer.targets
    assert target.simulations is None


def test_samples_that_lie_make_no_failure(monkeypatch: pytest.MonkeyPatch) -> None:
    """A planted mistake: each simulation is measured as a failure. The judge alone decides."""
    asked = problem(4)
    true = Searching(asked, 32, 5).run(loop_of("Standing"))

    def lie(self: Ruler, tracks: Any, courses: Any) -> dict[str, Any]:
        count = next(iter(tracks.values())).s.shape[1]
        return {"shows": np.ones(count), "breaks": np.ones(count)}

    monkeypatch.setattr(Ruler, "measure", lie)
    false = Searching(problem(4), 32, 5).run(loop_of("Standing"))
    assert {kind for _, _, kind in false.points} <= {"fails", "preventable"}
    assert true.failing is None
    assert false.failing is None

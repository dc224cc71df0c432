"""The front door itself: its names, what it costs to open it, and what it says of itself."""

import doctest
import json
import multiprocessing
import os
import subprocess
import sys
from importlib import import_module
from importlib.metadata import version
from pathlib import Path

import pytest

import roadproof as rp
from roadproof.core_record import EXTENSION
from roadproof.engines.search.batches import Engines
from roadproof.errors import MissingSolverError, UsageError
from roadproof.evidence.drive_file import load_drive
from roadproof.extensions.catalogue.writing import _free
from roadproof.extensions.kernel import coq
from roadproof.extensions.kernel.asking import KernelQuestion, write
from roadproof.extensions.traffic.evaluate.on_trace import driver_models_of
from roadproof.frontends.cli.main import main
from roadproof.questions import decide
from tables import read_table

HEAVY = tuple(read_table(__file__, "heavy"))


def python(*arguments: str) -> str:
    done = subprocess.run([sys.executable, *arguments], stdout=subprocess.PIPE, text=True, check=True)
    return done.stdout.strip()


def test_all_names_are_there() -> None:
    for name in rp.__all__:
        assert getattr(rp, name) is not None
    assert {*rp.__all__} <= {*dir(rp)}
    with pytest.raises(AttributeError, match="module 'roadproof' has no attribute 'prov'; there are load"):
        rp.prov  # noqa: B018


def test_all_names_have_words() -> None:
    functions = [getattr(rp, name) for name in rp.__all__ if name.islower() and callable(getattr(rp, name))]
    assert len(functions) > 15
    for function in functions:
        assert function.__doc__, function.__name__


def test_names_stay_when_modules_are_imported() -> None:
    names = (
        "prove",
        "witness",
        "compare",
        "order",
        "overlap",
        "monitor",
        "explore",
        "check",
        "simulate",
        "export",
    )
    found = {name: getattr(rp, name) for name in names}
    for module in (
        "engines.prove.prover",
        "semantics.sampled.batch",
        "questions.order.question",
        "evidence.checking",
        "extensions.exchange.export.registry",
        "verdict",
    ):
        import_module(f"roadproof.{module}")
    for name, function in found.items():
        assert getattr(rp, name) is function
        assert callable(function)


def test_the_door_is_light() -> None:
    code = f"import sys, roadproof; print(*({{*sys.modules}} & {{*{HEAVY!r}}}))"
    assert python("-c", code) == ""
    assert python("-c", code.replace("print", "roadproof.monitor; print")) != ""  # the control


def test_star_import() -> None:
    assert python("-c", "from roadproof import *; print(prove.__name__, F(SV.v_lon > 3))") == (
        "prove F v_lon(SV) > 3"
    )


def test_version() -> None:
    assert rp.__version__ == version("roadproof")
    assert python("-m", "roadproof", "--version") == f"roadproof {rp.__version__}"


@pytest.mark.parametrize(
    "name", ["roadproof", *sorted({f"roadproof.{x.partition(':')[0]}" for x in EXTENSION.functions.values()})]
)
def test_what_docstrings_show_is_so(name: str) -> None:
    assert doctest.testmod(import_module(name)).failed == 0


# --- Ends of calls that other tests pass by: names of folders, lanes of samples, wrong parameters of drivers

EXAMPLE = Path(__file__).parents[2] / "examples" / "catalogue" / "tests"


def test_each_run_of_recordings_has_a_folder_of_its_own(tmp_path: Path) -> None:
    names = []
    for _ in range(3):
        place = _free(tmp_path, "highd")
        place.mkdir()
        names.append(place.name)
    assert names == ["highd", "highd-2", "highd-3"]
    assert _free(tmp_path, "csv") == _free(tmp_path, "csv") == tmp_path / "csv"


def test_lanes_of_samples_are_those_that_are_asked_for() -> None:
    samples = EXAMPLE / "samples" / "braking.csv"
    for lane, holds in ((1, True), (2, False)):
        found = rp.monitor("scenario_4(SV,POV,L)", samples, lanes={"L": f"main-{lane}"})
        assert found.verdict == str(holds).lower()


def test_lanes_of_a_drive_are_those_that_are_asked_for() -> None:
    """As a path, and as a drive that was read."""
    path = EXAMPLE / "drives" / "braking.json"
    for on in (path, load_drive(path)):
        for lane, holds in (("main-1", True), ("main-2", False)):
            found = rp.monitor("scenario_4(SV,POV,L)", on, lanes={"L": lane})
            assert found.verdict == str(holds).lower()


def test_drivers_are_refused_where_aeb_brakes_less_than_the_driver() -> None:
    names = ("careful",)
    for braking, refused in (("9 m/s^2", False), ("1 m/s^2", True)):
        home = rp.load(specs=["driver"], options={"cc_aeb": "max"}, params={"aeb_braking": braking})
        if refused:
            with pytest.raises(UsageError, match="AEB brakes at least as hard as the driver"):
                driver_models_of(home, names)
        else:
            assert driver_models_of(home, names) is not None


def test_what_cannot_be_put_to_coq_has_a_reason_and_no_file(tmp_path: Path) -> None:
    drive = EXAMPLE / "drives" / "braking.json"
    wrong = json.loads(drive.read_text("utf-8")) | {"formula": "nothing(SV)", "scenario": None}
    (tmp_path / "wrong.json").write_text(json.dumps(wrong), "utf-8")
    asked = [KernelQuestion("wrong", tmp_path / "wrong.json", ()), KernelQuestion("fine", drive, ())]
    reasons = write(asked, tmp_path / "out", 1)
    assert [*reasons] == ["wrong"]
    assert "nothing" in reasons["wrong"]
    assert sorted(x.name for x in (tmp_path / "out").glob("*.v")) == ["fine.v"]


@pytest.mark.parametrize(
    ("said", "code", "told"),
    [
        ("8.18.0", 0, ""),
        ("8.18.0", 1, "does not say its version"),
        ("what?", 0, "does not say its version"),
        ("8.4.6", 0, "8.16 or later is needed"),
    ],
)
def test_the_version_of_coq(
    said: str, code: int, told: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A version counts only where the program also ends well."""
    program = tmp_path / "coqc"
    program.write_text(f"#!/bin/sh\necho '{said}'\nexit {code}\n", "utf-8")
    program.chmod(0o755)
    monkeypatch.setenv("PATH", f"{tmp_path}:/usr/bin:/bin")
    if not told:
        assert coq.find_coqc() == (str(program), said)
    else:
        with pytest.raises(MissingSolverError, match=told):
            coq.find_coqc()


def test_rows_of_an_extreme_number_its_values_from_one() -> None:
    found = rp.explore("v_lon(SV) >= 30 m/s", greatest="v_lon(SV)", jobs=1)
    assert [(x["kind"], x["at 1"], x["verdict"]) for x in found.rows()] == [
        ("greatest v_lon(SV), best", 40.0, "WITNESSED"),
        ("greatest v_lon(SV), missed", 40.1, "NONE-WITHIN"),
    ]
    assert all("at 2" not in x for x in found.rows())


@pytest.mark.parametrize(("chosen", "told"), [("base", ()), ("ext", ("set ext",))])
def test_a_catalogue_names_another_set(chosen: str, told: tuple[str, ...]) -> None:
    drive = EXAMPLE / "drives" / "braking.json"
    using = rp.load(chosen)
    found = rp.catalogue(drive, among="4", using=using, classes=False, drivers=(), jobs=1)
    assert found.view.in_force == told


# --- What a question is at, told while it is asked; how whoever listens ends it; compare with both at once

BEFORE, AFTER = "F[0, 1.2 s] danger(SV,POV)", "F[0, 0.6 s] danger(SV,POV)"


def test_a_search_tells_its_stages_in_order():
    told: list[rp.Stage] = []
    assert rp.witness(AFTER, jobs=1, stage=told.append).verdict is rp.Verdict.WITNESSED
    assert [x.name for x in told][:2] == ["encode", "solve"]
    assert {"shape", "judge"} <= {x.name for x in told}
    assert {x.of for x in told} == {f"{AFTER} base"}
    assert told[0].told.startswith("dt=3/5 s up to 6 s, natural drives")
    assert [x.seconds for x in told] == sorted(x.seconds for x in told)
    told.clear()
    rp.prove("danger(SV,POV) -> danger(POV,SV)", jobs=1, stage=told.append)
    assert {x.name for x in told} == {"prove"}


@pytest.mark.parametrize("name", ["encode", "solve", "judge"])
def test_whoever_listens_ends_a_search_between_two_stages(name):
    def end(stage: rp.Stage) -> None:
        heard.append(stage.name)
        if stage.name == name:
            raise rp.Cancelled("enough")

    heard: list[str] = []
    with pytest.raises(rp.Cancelled, match="enough"):
        rp.witness(AFTER, jobs=1, stage=end)
    assert heard[-1] == name
    assert rp.witness(AFTER, jobs=1).verdict is rp.Verdict.WITNESSED


def test_workers_are_heard_and_ended(tmp_path):
    """Two questions in two processes: what they are at is told here, and ending it leaves none behind."""
    told: list[rp.Stage] = []
    rp.witness(BEFORE, AFTER, jobs=2, stage=told.append, pictures=False)
    assert {x.of for x in told} == {f"{BEFORE} base", f"{AFTER} base"}

    def end(stage: rp.Stage) -> None:
        raise rp.Cancelled(stage.name)

    before = multiprocessing.active_children()
    with pytest.raises(rp.Cancelled):
        rp.witness(BEFORE, AFTER, jobs=2, stage=end)
    assert multiprocessing.active_children() == before


@pytest.mark.parametrize("jobs", [1, 2])
def test_both_directions_are_answered_alike_however_they_are_asked(jobs):
    came: dict[str, str] = {}
    told: list[rp.Stage] = []
    answer = rp.compare(
        BEFORE,
        AFTER,
        jobs=jobs,
        fresh=True,
        each=lambda name, x: came.update({name: str(x.verdict)}),
        stage=told.append,
    )
    assert answer.relation == "weaker"
    assert came == {"first implies second": "REFUTED", "second implies first": "PROVED"}
    one, other = (f"F[0, {x}] danger(SV, POV)" for x in ("1.2 s", "0.6 s"))
    assert {x.of for x in told} == {f"{one} and not {other} base", f"{other} and not {one} base"}
    assert answer.check().accepted


def is_forward(claim):
    """Whether a claim is that a drive has the first formula, and not the second."""
    return claim.query.text.startswith("F[0, 1.2 s]")


def test_the_first_answer_is_told_while_the_other_is_still_looked_for(monkeypatch):
    plain, told = Engines.answer_claim, multiprocessing.get_context("fork").Event()

    def wait(engines, claim, *more):
        if is_forward(claim):
            assert told.wait(300)
        return plain(engines, claim, *more)

    monkeypatch.setattr(Engines, "answer_claim", wait)
    monkeypatch.setattr(decide, "is_fork_unsafe", lambda: False)
    came: list[str] = []
    rp.compare(BEFORE, AFTER, jobs=2, fresh=True, each=lambda name, _: (came.append(name), told.set()))
    assert came == ["second implies first", "first implies second"]


def test_a_direction_that_is_lost_or_late_leaves_the_other(monkeypatch):
    plain = Engines.answer_claim

    def die(engines, claim, *more):
        if is_forward(claim):
            os._exit(7)
        return plain(engines, claim, *more)

    monkeypatch.setattr(Engines, "answer_claim", die)
    monkeypatch.setattr(decide, "is_fork_unsafe", lambda: False)
    answer = rp.compare(BEFORE, AFTER, jobs=2, fresh=True)
    forward, backward = answer.view.directions.values()
    assert (str(forward.verdict), str(backward.verdict)) == ("UNKNOWN", "PROVED")
    assert "its process ended each time" in forward.reason
    monkeypatch.setattr(Engines, "answer_claim", plain)
    late = rp.compare(BEFORE, AFTER, jobs=1, timeout=1e-6, fresh=True)
    assert {x.verdict for x in late.view.directions.values()} == {rp.Verdict.UNKNOWN}
    assert all("cut off by the clock" in x.reason for x in late.view.directions.values())


def test_the_command_line_tells_each_answer_when_it_is_there(capsys):
    assert main(["compare", BEFORE, AFTER, "--jobs", "2"]) == 0
    found = capsys.readouterr()
    assert "second implies first: PROVED (after" in found.err
    assert "first implies second: REFUTED (after" in found.err
    assert "the first is weaker" in found.out
    assert main(["compare", BEFORE, AFTER, "--quiet", "--jobs", "1"]) == 0
    assert capsys.readouterr().err == ""

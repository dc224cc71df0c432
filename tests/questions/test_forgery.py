"""Folders of answers with one thing changed: ``check`` shows the same of them, or they are rejected."""

import json
import random
import shutil
from collections.abc import Callable, Iterator
from itertools import combinations
from pathlib import Path
from typing import Any

import pytest

import roadproof as rp
from api.both_interfaces import IMPOSSIBLE, MINE, SLOW
from examples import EVERY_CHANGE
from roadproof.extensions.surveys.coverage.classes import GapClasses, GapGroup
from roadproof.extensions.surveys.coverage.gap_drives import GapDrive, SimpleDrives
from roadproof.frontends.api.checking import check
from roadproof.library.elaborate import read_claim
from roadproof.questions.checking import read_folder
from roadproof.questions.question import QUESTION
from roadproof.verdict import ExitCode
from sharing import made_once


def prove(out: Path) -> None:
    """A property of the list; own claims with a proof, a trace, a drive, an empty premise; one on drives."""
    rp.prove("P2", using=rp.load("base"), out=out, jobs=1)
    rp.prove("danger(SV,POV) -> danger(POV,SV)", "G v_lon(SV) > 3 m/s -> false", out=out, jobs=1)
    rp.prove(f"{IMPOSSIBLE} -> danger(SV,POV)", "v_lon(SV) < 99 m/s", assume="motion", out=out, jobs=1)
    rp.prove(SLOW, engine="milp", horizon=3, dt="3/5", out=out, jobs=1)


def witness(out: Path) -> None:
    """A drive of a scenario, two drives of a formula, a proof that there is none, and trees."""
    rp.witness(4, IMPOSSIBLE, out=out, pictures=False, jobs=1)
    rp.witness("G[0, 3] a_lon(SV) > 1 m/s^2", count=2, out=out, pictures=False, jobs=1)


def trees(out: Path) -> None:
    rp.witness("v_lon(SV) = 60 m/s and v_lon(POV) < 20 m/s", "v_lon(SV) > 70 m/s", out=out, jobs=1)


DRIVE = Path(__file__).parents[2] / "examples" / "catalogue" / "tests" / "drives" / "cut-in.json"
TESTS = """\
[[test]]
id = "AHEAD"
formula = "scenario_4(SV,POV,L)"
claims = [4]
"""


def catalogue(out: Path) -> None:
    """A drive and a formula, asked about the classes of scenarios 4 and 3, and about gaps of these."""
    tests = out.parent / "tests"
    tests.mkdir()
    shutil.copy(DRIVE, tests)
    (tests / "catalogue.toml").write_text(TESTS, "utf-8")
    rp.catalogue(tests, among="3,4", gaps=True, drivers=["careful"], effort=0.2, out=out, jobs=1)


FAST = "v_lon(SV) = 30 m/s and v_lon(SV)^3 > rho*rho*rho*(50 m/s^2)*(50 m/s^2)*(50 m/s^2)"
"""For rho below 0.6 s; elsewhere it is proved for each value."""
FOLDERS: dict[str, Callable[[Path], object]] = {
    "catalogue": catalogue,
    "classify": lambda out: rp.classify("4,8", shares=False, out=out, jobs=1),
    "coverage": lambda out: rp.coverage(rp.load("ext"), roads=["main-2"], out=out, jobs=1, effort=0.2),
    "order": lambda out: rp.order("4", rp.load("base", "extA"), out=out, jobs=1),
    "explore": lambda out: rp.explore(FAST, vary={"rho": (0, 1)}, steps=2, precision=1, out=out, jobs=1),
    "overlap": lambda out: rp.overlap("4,5,8", out=out, jobs=1),
    "preventable": lambda out: rp.preventable(
        "deceleration", ["careful"], at={"Ve0": "60 km/h", "dGdt": 5}, lines=2, out=out, jobs=1
    ),
    "prove": prove,
    "redundancy": lambda out: rp.redundancy(90, rp.load(specs=[MINE]), effort=1, out=out, jobs=1),
    "trees": trees,
    "witness": witness,
}
MOST, SLOW_ONES = (160, 60) if EVERY_CHANGE else (48, 24)
"""Fields of a folder that are changed, as many of each file; of more there is a sample."""
SWAPS = 500 if EVERY_CHANGE else 12
"""Pairs of files that are swapped."""
SLOW_FOLDERS = ("forged-catalogue", "forged-coverage")


@pytest.fixture(scope="module")
def few_gaps() -> Iterator[None]:
    """One class of gaps, one claim that there is none, two roads: the rest takes minutes."""
    with pytest.MonkeyPatch.context() as patch:
        groups, best = GapClasses.groups, SimpleDrives.best

        def few(classes: GapClasses) -> list[GapGroup]:
            return [GapGroup(x.component) for x in groups(classes) if x.title == "behaviourPOV_4"]

        def some(drives: SimpleDrives, start: int, step: int) -> dict[int, GapDrive]:
            return best(drives, 0, 98 * step)

        patch.setattr(GapClasses, "groups", few)
        patch.setattr(SimpleDrives, "best", some)
        patch.setattr("roadproof.extensions.surveys.coverage.question.CHUNKS", 1)
        patch.setattr("roadproof.extensions.surveys.covering.ELSEWHERE", ("merge",))
        patch.setattr("roadproof.extensions.catalogue.gaps.ROADS", ("main-2",))
        patch.setattr(
            "roadproof.extensions.surveys.coverage.claims.claims_of",
            lambda home: (read_claim(home, "danger(SV,POV) -> v_lon(SV) > 0 m/s"),),
        )
        yield


@pytest.fixture(scope="module", params=FOLDERS)
def folder(request: pytest.FixtureRequest, few_gaps: None) -> Path:
    def make(home: Path) -> None:
        FOLDERS[request.param](home / "answers")
        for path in (home / "answers").iterdir():
            if path.suffix not in (".json", ".spec"):
                path.unlink()

    place = made_once(f"forged-{request.param}", make) / "answers"
    assert check(place, jobs=1).exit_code is ExitCode.AS_EXPECTED
    return place


def answers_in(folder: Path) -> list[Path]:
    return sorted(x for x in folder.glob("*.json") if x.name != QUESTION)


def shown(folder: Path) -> tuple[object, ...]:
    """What is said of each claim: its label, its words and the verdict."""
    return tuple((x.label, x.claim, x.verdict) for x in check(folder, jobs=1).findings)


def leaves(content: Any, path: tuple[Any, ...] = ()) -> Iterator[tuple[Any, ...]]:
    match content:
        case dict():
            for key, value in content.items():
                yield from leaves(value, (*path, key))
        case list():
            for place, value in enumerate(content):
                yield from leaves(value, (*path, place))
        case _:
            yield path


def changed(value: Any) -> Any:
    match value:
        case bool():
            return not value
        case int() | float():
            return value + 1
        case str():
            return f"{value}1" if value[-1:].isdigit() else f"{value} x"
        case _:
            return 1


def test_a_changed_field_is_rejected_or_has_no_effect(folder: Path, tmp_path: Path) -> None:
    before = shown(folder)
    sample = random.Random(0)
    counts = {"rejected": 0, "without effect": 0}
    files = [folder / QUESTION, *answers_in(folder)]
    most = SLOW_ONES if folder.parents[1].name in SLOW_FOLDERS else MOST
    for path in sample.sample(files, min(most, len(files))):
        content = json.loads(path.read_text())
        every = [*leaves(content)]
        for field in sample.sample(every, min(max(most // len(files), 1), len(every))):
            copy = tmp_path / "copy"
            shutil.rmtree(copy, ignore_errors=True)
            shutil.copytree(folder, copy)
            forged = json.loads(path.read_text())
            inner = forged
            for key in field[:-1]:
                inner = inner[key]
            inner[field[-1]] = changed(inner[field[-1]])
            (copy / path.name).write_text(json.dumps(forged))
            try:
                found = check(copy, jobs=1)
            except rp.InputError:
                counts["rejected"] += 1
                continue
            if found.exit_code is ExitCode.AS_EXPECTED:
                assert shown(copy) == before, (path.name, field)
                counts["without effect"] += 1
            else:
                counts["rejected"] += 1
    assert counts["rejected"] > 10


def test_two_files_that_are_swapped_are_rejected_or_answer_each_others_claims(
    folder: Path, tmp_path: Path
) -> None:
    """A drive that refutes one claim may have what another asks for."""
    before, rejected = shown(folder), 0
    pairs = [*combinations(answers_in(folder), 2)]
    for one, other in random.Random(0).sample(pairs, min(SWAPS, len(pairs))):
        copy = tmp_path / f"{one.stem}-{other.stem}"
        shutil.copytree(folder, copy)
        (copy / one.name).write_bytes(other.read_bytes())
        (copy / other.name).write_bytes(one.read_bytes())
        if check(copy, jobs=1).exit_code is ExitCode.UNEXPECTED:
            rejected += 1
        else:
            assert shown(copy) == before, (one.name, other.name)
    assert rejected


def test_a_file_that_is_removed_leaves_a_claim_in_doubt(folder: Path, tmp_path: Path) -> None:
    files = answers_in(folder)
    for path in random.Random(0).sample(files, min(MOST, len(files))):
        copy = tmp_path / path.stem
        shutil.copytree(folder, copy)
        (copy / path.name).unlink()
        found = check(copy, jobs=1, strict=True)
        # What was asked after it is asked no more, where claims depend on answers.
        assert found.exit_code in (ExitCode.UNKNOWN, ExitCode.UNEXPECTED)
        assert read_folder(copy).answers[path.stem].reason


def test_a_file_that_no_claim_asks_for_is_rejected(folder: Path, tmp_path: Path) -> None:
    first = answers_in(folder)[0]
    for name in ("other.json", "answers/other.json", f"{first.stem}-1.json"):
        copy = tmp_path / name.replace("/", "-")
        shutil.copytree(folder, copy)
        (copy / name).parent.mkdir(exist_ok=True)
        (copy / name).write_bytes(first.read_bytes())
        assert check(copy, jobs=1).exit_code is ExitCode.UNEXPECTED
    copy = tmp_path / "link"
    shutil.copytree(folder, copy)
    (copy / first.name).unlink()
    (copy / first.name).symlink_to(first)
    assert check(copy, jobs=1).exit_code is ExitCode.UNEXPECTED


def test_no_other_question_has_these_answers(folder: Path, tmp_path: Path) -> None:
    copy = tmp_path / "copy"
    shutil.copytree(folder, copy)
    data = json.loads((copy / QUESTION).read_text())
    data["question"] = "nothing"
    (copy / QUESTION).write_text(json.dumps(data))
    found = check(copy, jobs=1)
    assert found.exit_code in (ExitCode.BAD_INPUT, ExitCode.UNEXPECTED)
    assert "question='nothing' is none of" in str(found)

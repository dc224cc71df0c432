"""Options that one way of asking might ignore: each changes what is asked, of every command that has it."""

import shlex
from fractions import Fraction
from itertools import combinations
from pathlib import Path
from typing import Any

import pytest

import roadproof as rp
from roadproof.errors import UsageError
from roadproof.frontends.api.question_answers import QuestionAnswers
from roadproof.frontends.cli.main import main
from roadproof.questions.data import question_data
from roadproof.runtime.canonical import digest

CLAIM = "'fasterThan(SV,POV) -> F danger(SV,POV)'"
COMMON = ("--option lateral_rss=signed", "--option speed=total", "--param rho=1/3", "--spec mine.spec")
SEARCH = ("--effort 7", "--timeout 700")
MODEL = ("--vehicle truck", "--vehicle POV=truck", "--vehicle SV=truck")
PLACE = ("--road main-3", "--horizon 5", "--dt 1/5")
DRIVERS = ("--preventable careful", "--unpreventable careful", "--unpreventable r157")
COMMANDS: dict[str, tuple[str, ...]] = {
    f"prove {CLAIM}": (
        *(*COMMON, *SEARCH, "--set ext", "--declared", "--expect REFUTED", "--assume motion", "--no-drive"),
    ),
    f"prove {CLAIM} --assume motion": (*COMMON, *MODEL, *SEARCH),
    f"prove {CLAIM} --engine milp": (
        *(*COMMON, *MODEL, *PLACE, *SEARCH, "--set ext", "--engine smt", "--expect REFUTED"),
    ),
    f"prove {CLAIM} --engine smt": (*COMMON, *MODEL, *PLACE, *SEARCH, "--set ext"),
    "prove P1": ("--set ext", "--param rho=1/3", "--declared", "--option speed=total", "--no-drive", *SEARCH),
    f"witness {CLAIM} --lane L=main-1": (
        *(*COMMON, *MODEL, *PLACE, *SEARCH, "--set ext", "--objective severe", "--count 2", "--engine smt"),
        *("--reach 90", "--allow-collisions", "--lane L=main-2"),
    ),
    "witness 1": DRIVERS,
    "overlap --among 1,3": (
        *(*COMMON, *MODEL, *SEARCH, *DRIVERS, "--set ext", "--among 1,4", "--lanes any", "--roles any"),
        *("--start any", "--horizon 5", "--start any --horizon 6"),
    ),
    "order --among 3,4 --set base": (*COMMON, *MODEL, *SEARCH, "--set ext", "--among 3,5"),
    "redundancy --among 3": (*COMMON, *MODEL, *SEARCH, "--set ext", "--among 4", "--whole"),
    "coverage": (
        *(*COMMON, *MODEL, *SEARCH, *DRIVERS, "--set ext", "--wider extA", "--road main-3", "--needed"),
    ),
    "explore 4 --vary minSafe=0:6": (
        *(*COMMON, *MODEL, *PLACE, *SEARCH, "--set ext", "--vary rho=0:1", "--steps 5", "--precision 0.2"),
        *("--least 'v_lon(SV)'", "--greatest 'v_lon(SV)'", "--engine smt"),
        *("--greatest 'v_lon(SV)' --when 'danger(SV,POV)'", "--reach 90", "--allow-collisions"),
    ),
    "preventable cut-in --model careful --lines 3": (
        *("--option cc_gate=before_delay", "--param cc_delay=0.5", "--model r157", "--at Vy=1"),
        *("--along dx0=0:60", "--across dV0=0:9", "--lines 4", "--no-lemmas"),
    ),
    f"compare {CLAIM} 'danger(SV,POV)'": (*COMMON, *MODEL, *PLACE, *SEARCH, "--set ext", "--engine smt"),
}  # fmt: skip


SAME_ANSWERS = ("--timeout 700", "--needed")
"""What the clock cuts off is never kept; and more answers beside the others change none of them."""


class Asked(list[Any]):
    """What was asked, and no answer."""

    def note(self, *what: Any) -> Any:
        self.append(what)
        raise UsageError("it was asked")


@pytest.fixture
def asked(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Asked:
    (tmp_path / "mine.spec").write_text("param rho = 2 s where rho > 0\n")
    monkeypatch.chdir(tmp_path)
    found = Asked()
    monkeypatch.setattr(QuestionAnswers, "decide", classmethod(lambda _, x, *more, **__: found.note(x)))
    return found


def question(words: str, asked: Asked) -> Any:
    asked.clear()
    code = main(shlex.split(words))
    assert (code, len(asked)) == (2, 1), words
    return asked[0]


@pytest.mark.parametrize("command", COMMANDS)
def test_each_option_is_another_question(
    command: str, asked: Asked, capsys: pytest.CaptureFixture[str]
) -> None:
    usual = question(command, asked)
    assert question(command, asked) == usual
    made = {option: question(f"{command} {option}", asked) for option in COMMANDS[command]}
    for option, other in made.items():
        assert other != usual, option
    for (one, first), (two, second) in combinations(made.items(), 2):
        assert first != second, f"{one} is {two}"
    assert "it was asked" in capsys.readouterr().err


KEPT = [x for x in COMMANDS if not x.startswith(("prove", "compare"))]
"""Of claims other tests say when a kept answer counts; ``compare`` keeps none."""


def digests(study: Any) -> tuple[Any, ...]:
    """What tells a kept or known answer from those to another question."""
    return (digest(question_data(study), study.work),)


@pytest.mark.parametrize("command", KEPT)
def test_no_answer_is_kept_for_two_questions(command: str, asked: Asked) -> None:
    usual = digests(*question(command, asked))
    assert digests(*question(command, asked)) == usual
    made = {
        x: digests(*question(f"{command} {x}", asked)) for x in COMMANDS[command] if x not in SAME_ANSWERS
    }
    for option, other in made.items():
        assert other != usual, option
    for (one, first), (two, second) in combinations(made.items(), 2):
        assert first != second, f"{one} is {two}"


def test_ranges_and_lanes_of_an_exploration_are_told_apart(asked: Asked) -> None:
    lines = [f"explore 4 --vary minSafe={x}" for x in ("0:6", "0:5", "1:6")]
    lines += [f"explore 4 --vary minSafe=0:6 --road main-2 --lane L=main-{k}" for k in (1, 2)]
    assert len({digests(*question(x, asked)) for x in lines}) == len(lines)


@pytest.mark.parametrize("line", ["--greatest 'v_lon(SV)' --when 'fast(SV)'", "--least 'far(SV)'"])
def test_a_definition_of_a_measure_alone_is_a_part_of_its_claims(
    line: str, asked: Asked, tmp_path: Path
) -> None:
    keys = set()
    for number in (20, 21):
        fast = f"def fast(a: vehicle) := v_lon(a) > {number} m/s"
        far = f"def far(a: vehicle) := s(a) + {number} m"
        (tmp_path / "mine.spec").write_text(f"{fast}\n{far}\n")
        [explored] = question(f"explore 4 {line} --spec mine.spec", asked)
        [measure] = explored.explorables[0].measures
        keys.add(digest(measure.bound(Fraction(1))[0].formula))
    assert len(keys) == 2


def test_claims_of_a_file_are_asked_beside_those_of_the_line(
    asked: Asked, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "mine.txt").write_text("true\n\nnot false\n")
    for words, claims in (
        (CLAIM, 1),
        ("--claims mine.txt", 2),
        (f"{CLAIM} --claims mine.txt", 3),
    ):
        [study] = question(f"prove {words}", asked)
        assert len(study.tasks) == claims
    (tmp_path / "empty.txt").write_text("# nothing\n")
    assert main(["prove", "--claims", "empty.txt"]) == 2
    assert "empty.txt contains no claim" in capsys.readouterr().err


def test_properties_of_all_values_are_not_asked_at_one(asked: Asked) -> None:
    [every] = question("prove", asked)
    [at_one] = question("prove --param rho=1/2", asked)
    assert any(x.task.of_all_values for x in every.tasks)
    assert at_one.tasks
    assert not any(x.task.of_all_values for x in at_one.tasks)


@pytest.mark.parametrize("text", ["dx0=5", "dx0", "5:6", "dV0=5:6", "dx0=6:5"])
def test_a_range_has_a_name_and_two_ends(text: str, asked: Asked, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["preventable", "cut-in", "--along", text]) == 2
    told = capsys.readouterr().err
    assert "write dx0=LOW:HIGH" in told or (text == "dx0=6:5" and "the range is empty" in told)
    assert not asked


def test_who_does_the_work_is_as_the_options_say() -> None:
    from argparse import Namespace

    from roadproof.frontends.cli.options import read_executor
    from roadproof.runtime.executors import Shard

    def hands(**more: Any) -> Any:
        return read_executor(Namespace(**{"jobs": None, "json": None, **more}))

    assert hands(jobs=3).processes == 3
    assert hands(shard="2/3").shard == Shard(2, 3)
    files = {"tls_ca": "ca.pem", "tls_cert": "cert.pem", "tls_key": "key.pem"}
    cluster = hands(cluster="tls://host:1", **files).cluster
    assert (cluster.address, cluster.authority, cluster.certificate, cluster.key) == (
        "tls://host:1",
        *files.values(),
    )
    for wrong in ({"tls_key": "key.pem"}, {"cluster": "local:2", "jobs": 2}, {"shard": "1/2", "json": "-"}):
        with pytest.raises(UsageError):
            hands(**wrong)


@pytest.mark.parametrize("value", ["1/3", "0.1", "7/3", "0.001", "2/7"])
def test_a_claim_is_proved_at_any_value_and_checked(value: str, tmp_path: Path) -> None:
    """Thirds are no decimals: they are written as a product, and are read again."""
    home = rp.load(params={"rho": value})
    found = rp.prove("a_max > 0 m/s^2 -> rho > 0 s", using=home, jobs=1, out=tmp_path)
    assert (found.verdict, found.exit_code) == ("PROVED", 0)
    assert rp.check(tmp_path).accepted

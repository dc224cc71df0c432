"""The recipes of CONTRIBUTING.md (signal, operator, option, survey) are carried out on a copy of the code."""

import csv
import json
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
TEXT = (ROOT / "CONTRIBUTING.md").read_text()
CHANGES = re.findall(r"```diff\n(.*?)```", TEXT, re.DOTALL)
OPTION = re.findall(r"```diff option\n(.*?)```", TEXT, re.DOTALL)
SURVEY = dict(re.findall(r"`(src/roadproof/\S+\.py)`[^\n]*\n\n```python\n(.*?)```", TEXT, re.DOTALL))
OPERATOR = re.findall(r"```diff operator\n(.*?)```", TEXT, re.DOTALL)
READERS = re.findall(
    r"^\| `.*", TEXT.partition("## A new temporal operator")[2].partition("\n## ")[0], re.MULTILINE
)
READERS_OF_OPERATORS = set(re.findall(r"`(\S+\.py)`", "\n".join(READERS)))
"""The files in the table of the recipe for a temporal operator."""


@pytest.fixture
def copy(tmp_path):
    shutil.copytree(ROOT / "src", tmp_path / "src", ignore=shutil.ignore_patterns("__pycache__"))
    for name in ("models", "proofs"):
        (tmp_path / name).symlink_to(ROOT / name)
    shutil.copy(ROOT / "pyproject.toml", tmp_path)
    return tmp_path


def apply(copy, changes):
    for change in changes:
        subprocess.run(["git", "apply", "--unidiff-zero"], input=change, text=True, cwd=copy, check=True)


def add_survey(copy):
    for name, text in SURVEY.items():
        assert not (copy / name).exists()
        (copy / name).parent.mkdir(parents=True, exist_ok=True)
        (copy / name).write_text(text)


def begin(copy, *words):
    paths = os.pathsep.join([str(copy / "src"), str(ROOT / "tests")])
    environment = {**os.environ, "PYTHONPATH": paths}
    return subprocess.run([sys.executable, *words], env=environment, cwd=copy, capture_output=True, text=True)


def run(copy, text):
    done = begin(copy, "-c", text)
    assert done.returncode == 0, done.stderr[-2000:]
    return done.stdout.splitlines()


def roadproof(copy, code, line):
    """What a command line prints, whose exit code is ``code``."""
    done = begin(copy, "-m", "roadproof", *line.split())
    assert done.returncode == code, done.stdout + done.stderr[-2000:]
    return done.stdout


def files_in(changes):
    return set(re.findall(r"^\+\+\+ b/src/roadproof/(\S+)", "\n".join(changes), re.MULTILINE))


def test_an_option_touches_two_files(copy):
    assert len(files_in(OPTION)) == 2
    before = roadproof(copy, 0, "witness 4").splitlines()
    apply(copy, OPTION)
    after = roadproof(copy, 0, "witness 4 --brief").splitlines()
    assert len(before) == 3
    assert len(after) == 1
    assert after[0].split()[:4] == before[0].split()[:4] == ["scenario", "4", "base", "WITNESSED"]
    assert re.search(
        r"^output:\n(?:  .*\n)*  --brief  +one line for each answer$",
        roadproof(copy, 0, "witness --help"),
        re.M,
    )
    remade = run(copy, "from documents import keywords_file as k; print(k.text(k.CORE), end='')")
    assert "\n".join(remade) + "\n" == (copy / "src/roadproof/frontends/settings/keywords.py").read_text()


NOTE = (
    '    note: str = option("", "--note TEXT", help="print TEXT first", group="output", keyword=False)\n\n\n'
)
IN_OTHERS = {
    "compare": (
        *("frontends/settings/questions.py", "frontends/cli/compare.py"),
        *('folder_for("certificates and drive files")\n', "4 4"),
    ),
    "redundancy": (
        *("extensions/surveys/settings.py", "extensions/surveys/commands/redundancy.py"),
        *('effort: float = groups.effort_for("a drive", 20.0)\n', "--among 4 --effort 1"),
    ),
}
"""By question: where its options and its command are, how its last option ends, and what is asked."""


@pytest.mark.parametrize("command", IN_OTHERS)
def test_an_option_of_other_questions_touches_two_files_too(copy, command):
    options, file, last, asked = IN_OTHERS[command]
    home, before = copy / "src/roadproof", "def run(args: argparse.Namespace) -> int:\n"
    forge(home / options, (last, last + NOTE))
    forge(home / file, (before, before + "    print(args.note, flush=True)\n"))
    told = roadproof(copy, 0, f"{command} {asked} --note between").splitlines()
    assert told[0] == "between"
    assert len(told) > 1
    assert "--note TEXT" in roadproof(copy, 0, f"{command} --help")


FIELD = {
    "questions/overlap_data.py": (
        (
            "    reason: shared.Reason = NO_REASON\n",
            '    one_set: Annotated[bool, Doc("Whether both are of one spec set.")]\n',
        ),
        (
            "        reason=pair.reason,\n",
            "        one_set=pair.a.set_name == pair.b.set_name,\n",
        ),
    ),
    "frontends/report/overlap.py": (
        (
            '            Column("reason", lambda x: x.reason),\n',
            '            Column("one_set", lambda x: x.a.set_name == x.b.set_name, "csv"),\n',
        ),
        (
            '    lines += [f"  {line}" for line in legend(words)]\n',
            '    lines.append(f"of one set: {sum(x.a.set_name == x.b.set_name for x in verdicts)}")\n',
        ),
    ),
    "extensions/pages/page/templates/overlap.html": (
        ("{{ p.reason(x.reason) }}\n", "<p>of one set: {{ x.one_set }}</p>\n"),
    ),
}
"""A field of the answer of overlap, by file: the lines before which it is put in."""


def test_a_field_of_an_answer_touches_three_files(copy):
    """It is in the terminal, in JSON and its schema, in CSV and on the page."""
    assert len(FIELD) == 3
    for name, edits in FIELD.items():
        forge(copy / "src/roadproof" / name, *((old, new + old) for old, new in edits))
    told = roadproof(copy, 0, "overlap --among 1,4 --out X --json answer.json --no-pictures --jobs 1")
    assert "\nof one set: 1\n" in told
    assert [x["one_set"] for x in json.loads((copy / "answer.json").read_text())["verdicts"]] == [True]
    [row] = csv.DictReader((copy / "X/overlap.csv").read_text().splitlines())
    assert row["one_set"] == "True"
    [schema] = run(copy, "from documents.schemas import schemas; print(dict(schemas())['overlap.json'])")
    assert "Whether both are of one spec set." in schema
    assert "1 of 1 accepted" in roadproof(copy, 0, "check X --jobs 1")
    roadproof(copy, 0, "report X -o page.html")
    assert "<p>of one set: True</p>" in (copy / "page.html").read_text()


def errors_of_mypy(copy):
    """What mypy says of our own modules alone."""
    options = ["--strict", "src", "--no-site-packages", "--cache-dir", os.devnull]
    return begin(copy, "-m", "mypy", *options).stdout


def files_with(errors, pattern):
    return set(re.findall(rf"^src/roadproof/(\S+?):\d+: error:.*{pattern}", errors, re.MULTILINE))


def test_mypy_names_every_reader_that_forgets_a_signal(copy):
    apply(copy, CHANGES[:1])
    add_survey(copy)
    errors = errors_of_mypy(copy)
    assert not re.findall(r"^src/roadproof/\S+/alone.py.*", errors, re.MULTILINE)
    assert files_with(errors, "soon") == files_in(CHANGES[1:]) - {"world/motion.py"}


def test_mypy_names_every_reader_that_the_recipe_for_a_temporal_operator_lists(copy):
    apply(copy, OPERATOR)
    forgetful = files_with(errors_of_mypy(copy), '(?:"Never"|Missing return statement)')
    assert forgetful == READERS_OF_OPERATORS


def test_an_operator_that_only_the_parser_knows_is_never_taken_for_another(copy):
    """A reader once took every operator that it did not know for G, which gave a false PROVED."""
    apply(copy, OPERATOR)
    parse = "from roadproof.logic.parse import parse_claim; print(parse_claim({!r}).body.op)"
    assert run(copy, parse.format("N[1 s, 2 s] v_lon(SV) > 1 m/s")) == ["N"]
    for claim in ("N true", "G true -> N true", "N[1 s, 2 s] v_lon(SV) > 1 m/s"):
        for command in ("prove", "witness"):
            done = begin(copy, "-m", "roadproof", command, claim)
            assert done.returncode not in (0, 10), done.stdout
            assert "PROVED" not in done.stdout + done.stderr


REFUSALS = """
from fractions import Fraction as F
import numpy as np
from roadproof.engines.encode.shift_invariance import depends_on_place
from roadproof.engines.encode.motion import ColumnLayout
from roadproof.engines.encode.unroll import Grid
from roadproof.semantics.exact import judge
from roadproof.logic.latex import latex
from roadproof.engines.prove.prover import prove
from roadproof.library.elaborate import read_claim
from roadproof.library.loading import bundled_library
from roadproof.extensions.traffic.evaluate.one_trace import sample_drive
from roadproof.extensions.traffic.evaluate.traces import gather
from roadproof.semantics.sampled import Batch, compile
from roadproof.world.drive import Drive, Motion, Piece
from roadproof.world.models import load_road, load_vehicle

query = read_claim(bundled_library().select(), "soon(SV) > 30 m")
print(latex(query.claim))
drive = Drive({"SV": Motion(F(4), F(2), F(0), F(3), F(20), F(0), (Piece(None, F(0), F(0)),))})
cars = {"SV": load_vehicle("car")}
readers = {
    "judge": lambda: judge(query.formula, drive),
    "columns": lambda: ColumnLayout(("SV",), Grid(F(1), 1)).state("SV", "soon", 0),
    "places": lambda: depends_on_place(query.formula, cars),
    "prover": lambda: prove(bundled_library().select(), query),
    "samples": lambda: sample_drive(drive, load_road("main-2"), F(1), F(1), "drive"),
    "monitor": lambda: compile({"it": query.formula}).evaluate(Batch(F(1), np.array([1]))),
    "recordings": lambda: gather(None, {}, *np.zeros((2, 1), int), compile({"it": query.formula}).signals),
}
for name, ask in readers.items():
    try:
        ask()
    except Exception as error:
        print(name, "refuses" if "soon" in str(error) else f"says {error}")
    else:
        print(name, "passes it over")
"""


def test_a_reader_that_does_not_know_a_signal_refuses_it_by_name(copy):
    apply(copy, CHANGES[:1])
    shown, *told = run(copy, REFUSALS)
    assert "soon" in shown
    assert told == [
        f"{name} refuses"
        for name in ("judge", "columns", "places", "prover", "samples", "monitor", "recordings")
    ]


AGREEMENT = """
from fractions import Fraction as F
import random
from roadproof.engines.encode.shift_invariance import depends_on_place
from roadproof.engines.encode.build import NO_MARGIN, ground_atoms
from roadproof.engines.encode.problem import evaluate
from roadproof.engines.encode.motion import ColumnLayout
from roadproof.engines.encode.unroll import Grid, unroll
from roadproof.semantics.exact import judge
from roadproof.semantics.sampled import compile
from roadproof.world.signals import STARTING
from roadproof.library.elaborate import read_claim
from roadproof.library.loading import bundled_library
from roadproof.extensions.traffic.evaluate.one_trace import sample_drive
from roadproof.world.drive import Drive, Motion, Piece
from roadproof.world.models import load_road, load_vehicle
from roadproof.world.motion import state_at

STEPS = 4
base, road, car = bundled_library().select(), load_road("main-2"), load_vehicle("car")
layout = ColumnLayout(("POV", "SV"), Grid(F(1), STEPS))
cars = dict.fromkeys(layout.vehicles, car)
held = {name: set() for name in ("judge", "monitor", "grid", "meant")}
dice = random.Random(7)


def drive():
    pieces = [*(Piece(F(1), F(dice.randint(-3, 3)), F(0)) for _ in range(STEPS)), Piece(None, F(0), F(0))]
    place, speed = F(dice.randint(0, 30)), F(dice.randint(9, 30))
    return Motion(car.length, car.width, place, F(3), speed, F(0), tuple(pieces))


def answers(formula, motions):
    yield "judge", judge(formula, motions).holds
    trace = sample_drive(motions, road, F(STEPS), F(1), "drive")
    yield "monitor", bool(compile({"it": formula}).evaluate(trace.batch, "clip").answers["it"].true[0])
    circuit = ground_atoms(unroll(formula, layout.grid), cars, layout, NO_MARGIN)
    values = {
        layout.column(name, signal, k): getattr(state_at(motion, F(k)), signal)
        for name, motion in motions.vehicles.items() for signal in STARTING for k in range(STEPS + 1)
    }

    def holds(fact):
        value = fact.polynomial.value(values.__getitem__)
        return value > 0 or (value == 0 and not fact.strict)

    yield "grid", evaluate(circuit, holds)


for case in range(60):
    motions = Drive({"POV": drive(), "SV": drive()})
    far, when = dice.randint(20, 150), dice.randint(0, STEPS - 1)
    other = dice.choice(["soon(POV)", "s(POV)", f"{far} m"])
    text = f"F[{when} s, {when} s] SIGNAL >= {other}"
    formula = read_claim(base, text.replace("SIGNAL", "soon(SV)")).formula
    meant = read_claim(base, text.replace("SIGNAL", "s(SV) + v_lon(SV) * 1 s").replace(
        "soon(POV)", "s(POV) + v_lon(POV) * 1 s")).formula
    expected = judge(meant, motions).holds
    for reader, answer in answers(formula, motions):
        assert answer == expected, (reader, text, answer)
        held[reader].add(answer)
assert all(held[reader] == {True, False} for reader in ("judge", "monitor", "grid")), held
assert depends_on_place(read_claim(base, "soon(SV) > 9 m").formula, cars)
assert not depends_on_place(read_claim(base, "soon(SV) > s(POV)").formula, cars)
"""
ASKED = ("F soon(SV) > s(POV) + 40 m", "soon(SV) > 60 m and s(SV) < 41 m")
WITNESS = "from roadproof.frontends.cli.main import main\nraise SystemExit(main(['witness', {!r}]))"


def test_when_all_is_done_the_readers_agree(copy):
    apply(copy, CHANGES)
    run(copy, AGREEMENT)
    for text in ASKED:
        assert "WITNESSED" in run(copy, WITNESS.format(text))[0]


def test_the_example_is_the_list_its_physics_and_its_readers():
    assert files_in(CHANGES[:1]) == {"world/signals.py"}
    assert len(files_in(CHANGES)) == 7


# --- a new survey ------------------------------------------------------------------------------------

SLOW = """set mine extends base "scenario 4 is 6 for the slow" {
  def scenario_4(SV, POV: vehicle, L: lane) "slow" := scenario_6(SV, POV, L) and v_lon(SV) < 5 m/s
}
"""
ASK = "alone --among 4,6 --set mine --spec mine.spec --effort 3 --jobs 1 --out X"
FROM_PYTHON = """
import roadproof as rp
from roadproof.extensions.alone.question import Alone
found = rp.ask(Alone, "4,6", rp.load("mine", specs=["mine.spec"]), out="X", jobs=1, say=print)
print({name: str(x) for name, x in found.verdicts.items()}, len(found.evidence), int(found.exit_code))
"""


def forge(path, *changes):
    """Change the text of a file, and say what it was."""
    text = path.read_text()
    for old, new in changes:
        assert old in text
        path.write_text(path.read_text().replace(old, new, 1))
    return text


def test_a_survey_is_an_extension_that_needs_no_line_elsewhere(copy):
    files = ("__init__.py", "question.py", "commands/alone.py")
    assert list(SURVEY) == [f"src/roadproof/extensions/alone/{file}" for file in files]
    add_survey(copy)
    for words in (["check"], ["format", "--check"]):
        done = begin(copy, "-m", "ruff", *words, *SURVEY)
        assert done.returncode == 0, done.stdout
    help_of_all = roadproof(copy, 0, "--help")
    assert re.search("alone +Scenarios that hold while no other one does", help_of_all)
    assert "roadproof alone --among 1,3-8" in roadproof(copy, 0, "alone --help")


def test_a_survey_is_asked_kept_taken_up_again_and_checked(copy):
    add_survey(copy)
    (copy / "mine.spec").write_text(SLOW)
    told = json.loads(roadproof(copy, 0, f"{ASK} --json -"))
    assert told["schema"] == "roadproof/survey/1"
    assert told["survey"] == "alone"
    assert [(x["name"], x["verdict"]) for x in told["verdicts"]] == [
        ("scenario_4", "IMPOSSIBLE"),
        ("scenario_6", "WITNESSED"),
    ]
    assert "2 of 2 accepted" in roadproof(copy, 0, "check X --jobs 1")
    times = {x: x.stat().st_mtime_ns for x in (copy / "X").glob("scenario_*.json")}
    assert len(times) == 2
    assert run(copy, FROM_PYTHON) == ["{'scenario_4': 'IMPOSSIBLE', 'scenario_6': 'WITNESSED'} 2 0"]
    assert {x: x.stat().st_mtime_ns for x in times} == times

    whole = forge(
        copy / "X/scenario_6.json", ("scenario_6(SV, POV, L) and not", "scenario_6(SV, POV, L) or not")
    )
    assert "is no answer to its claim" in roadproof(copy, 10, "check X --jobs 1")
    (copy / "X/scenario_6.json").write_text(whole)
    question = forge(copy / "X/question.json", ('"asked"', '"more": 1, "asked"'))
    assert "unknown field 'more'" in roadproof(copy, 10, "check X --jobs 1")
    (copy / "X/question.json").write_text(question.replace('"alone"', '"unheard_of"'))
    assert "is none of" in roadproof(copy, 10, "check X --jobs 1")
    (copy / "X/question.json").write_text(question)
    (copy / "X/scenario_6.json").write_text(whole[:60])
    assert roadproof(copy, 0, ASK).startswith("IMPOSSIBLE  scenario_4\nWITNESSED   scenario_6\n2 answers")
    assert "2 of 2 accepted" in roadproof(copy, 0, "check X --jobs 1")

"""Answers that are known where one thing is another than when they were computed; all else is the same."""

import itertools
import lzma
import os
from collections.abc import Iterator
from fractions import Fraction
from pathlib import Path
from typing import Any

import pytest

from roadproof.extensions.surveys.redundancy import RedundancyQuestion
from roadproof.frontends.api.definitions import load
from roadproof.frontends.api.proofs import claims_question
from roadproof.library.elaborate import read_claim
from roadproof.library.loading import build_library, bundled_library
from roadproof.library.specification import Source
from roadproof.questions.basis import Basis
from roadproof.questions.decide import decide_claims, look_up, shard_filter
from roadproof.questions.overlap import Meeting, OverlapQuestion
from roadproof.questions.question import walk_batch
from roadproof.questions.store import Store
from roadproof.runtime import archives, package_data
from roadproof.runtime.archives import SWITCH
from roadproof.runtime.budget import Effort
from roadproof.runtime.executors import Shard
from roadproof.world.models import load_road, load_vehicle
from shipping.archive import ship

KEY = "5eed"


@pytest.fixture(autouse=True)
def home(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Path]:
    monkeypatch.setenv(SWITCH, "on")
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    (tmp_path / "models").mkdir()
    (tmp_path / "models/car.toml").write_text("one")
    for module in (archives, package_data):
        monkeypatch.setattr(module, "shipped_folder", lambda folder: tmp_path / folder)
    package_data.program_digest.cache_clear()
    archives.shipped_answers.cache_clear()
    yield tmp_path
    archives.shipped_answers.cache_clear()
    package_data.program_digest.cache_clear()


def found(kind: str = "overlap", key: str = KEY) -> archives.KnownText | None:
    return archives.recall(kind, key)


def put(where: str, home: Path) -> None:
    if where == "cache":
        archives.remember(KEY, "{}")
    else:
        ship(home / "proofs/known", "overlap", {KEY: "{}"})


@pytest.mark.parametrize("where", ["cache", "shipped"])
def test_another_key_is_another_answer(where: str, home: Path) -> None:
    put(where, home)
    same = found()
    assert same is not None
    assert (same.text, same.origin) == ("{}", where)
    assert found(key="other") is None
    assert (found("witness") is None) == (where == "shipped"), "each kind of question has its archive"


@pytest.mark.parametrize("change", ["another size", "other bytes", "one more", "one less"])
def test_a_changed_model_or_program_has_no_answers(change: str, home: Path) -> None:
    model = home / "models/car.toml"
    before = model.stat()
    put("cache", home)
    assert found() is not None
    match change:
        case "another size":
            model.write_text("other")
        case "other bytes":
            model.write_text("two")
        case "one more":
            (home / "models/truck.toml").write_text("two")
        case _:
            model.unlink()
    if model.exists():
        os.utime(model, ns=(before.st_atime_ns, before.st_mtime_ns))  # times do not count
    package_data.program_digest.cache_clear()
    assert found() is None


def test_a_changed_source_has_no_answers(home: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    source = home / "roadproof/runtime/package_data.py"
    source.parent.mkdir(parents=True)
    source.write_text("one")
    monkeypatch.setattr(package_data, "__file__", str(source))
    package_data.program_digest.cache_clear()
    put("cache", home)
    assert found() is not None
    (source.parents[1] / "more.py").write_text("another module")
    package_data.program_digest.cache_clear()
    assert found() is None


def test_what_is_switched_off_is_neither_taken_nor_kept(home: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    asked = claims_question(load(), ["v_lon(SV) > 2 m/s -> v_lon(SV) > 1 m/s"], None)
    monkeypatch.setenv(SWITCH, "off")
    decide_claims(asked, executor=1)
    assert not [*(home / "cache/roadproof/answers").glob("*")]
    monkeypatch.setenv(SWITCH, "on")
    decide_claims(asked, executor=1)
    monkeypatch.setenv(SWITCH, "off")
    assert not decide_claims(asked, executor=1).origins


@pytest.mark.parametrize("change", ["an answer", "the seal", "half of it", "no archive", "no text"])
def test_a_shipped_archive_that_was_changed_is_none(change: str, home: Path) -> None:
    path = ship(home / "proofs/known", "overlap", {KEY: '{"verdict": "PROVED"}', "other": "{}"})
    assert found() is not None
    seal, lines = lzma.decompress(path.read_bytes()).split(b"\n", 1)
    content = {
        "an answer": seal + b"\n" + lines.replace(b"PROVED", b"REFUTED"),
        "the seal": b"0" * 64 + b"\n" + lines,
        "no text": b"\xff" + lines,
    }.get(change, seal + b"\n" + lines)
    data = lzma.compress(content)
    path.write_bytes({"half of it": data[: len(data) // 2], "no archive": b"x"}.get(change, data))
    archives.shipped_answers.cache_clear()
    assert found() is None


@pytest.mark.parametrize(("shipped", "cached"), list(itertools.product(range(3), repeat=2)))
def test_known_answers_are_counted_by_where_they_are_from(shipped: int, cached: int) -> None:
    line = archives.origins_in_words([*["shipped"] * shipped, *["cache"] * cached], 9)
    assert bool(line) == bool(shipped + cached)
    if line:
        assert line.startswith(f"{shipped + cached} of 9 answers were known: ")
        assert (f"{shipped} shipped with" in line) == bool(shipped)
        assert (f"{cached} of earlier runs" in line) == bool(cached)


# --- the digest of what an analysis rests on ---------------------------------------------------------

LIBRARY = bundled_library()
HERE = Basis(LIBRARY.select())
CAR = load_vehicle("car")


def changed_library() -> Basis:
    return Basis(build_library([Source("m", "param rho = 2 s where rho > 0")], LIBRARY).select())


@pytest.mark.parametrize(
    "other",
    [
        lambda: Basis(LIBRARY.select("base", {"lateral_rss": "signed"})),
        lambda: Basis(LIBRARY.select(), values={"rho": Fraction(1, 3)}),
        lambda: Basis(LIBRARY.select(), horizon=Fraction(7)),
        lambda: Basis(LIBRARY.select(), effort=Effort(61.0)),
        lambda: Basis(LIBRARY.select(), effort=Effort(60.0, 5.0)),
        lambda: Basis(LIBRARY.select(), proof=4.0),
        lambda: Basis(LIBRARY.select(), objective="severe"),
        lambda: Basis(LIBRARY.select(), vehicles={"POV": CAR}),
        changed_library,
    ],
    ids=["options", "values", "horizon", "effort", "timeout", "proof", "objective", "models", "definitions"],
)
def test_a_digest_changes_with_all_that_an_answer_depends_on(other: Any) -> None:
    def key(basis: Basis, text: str = "scenario_4(SV,POV,L)") -> str:
        return Store(None, "overlap", basis.work).key(basis.claim(read_claim(basis.specification, text)))

    assert key(HERE) == key(Basis(LIBRARY.select()))
    assert key(other()) != key(HERE)
    assert key(HERE) != key(HERE, "scenario_3(SV,POV,L)")


def test_a_claim_for_one_model_is_none_for_another() -> None:
    truck = Basis(LIBRARY.select(), vehicles={"POV": load_vehicle("truck")})
    car = Basis(LIBRARY.select(), vehicles={"POV": CAR})
    for question in (lambda x: OverlapQuestion(x, Meeting(among=(3, 4))), RedundancyQuestion):
        claims = [_first_claim(question(x)) for x in (HERE, truck, car)]
        assert len({x.digest() for x in claims}) == 3


def _first_claim(question: Any) -> Any:
    [(_, claim), *_] = [x for batch in question.batches({}) for x in walk_batch(batch, lambda *_: None)]
    return claim


def test_what_is_known_of_a_formula_is_known_in_each_set_that_has_it() -> None:
    text = "v_lon(SV) > 2 m/s -> v_lon(SV) > 1 m/s"
    decide_claims(claims_question(load("base"), [text], None), executor=1)
    for home in (load("extA"), load("base", options={"lateral_sign": "literal"})):
        found = decide_claims(claims_question(home, [text], None), executor=1)
        assert [*found.origins.values()] == ["cache"]
        [certificate] = [x.certificate for x in found.answers.values()]
        assert certificate is not None
        said = home.specification
        assert (certificate.set_name, certificate.options) == (said.set_name, said.options)


def test_known_answers_are_looked_up_by_the_claim() -> None:
    one, other = (
        claims_question(load(), [f"v_lon(SV) > {k} m/s -> v_lon(SV) > 1 m/s"], None) for k in (2, 3)
    )
    first = decide_claims(one, executor=1)
    assert not first.origins
    assert [*decide_claims(one, executor=1).origins.values()] == ["cache"]
    assert not decide_claims(one, executor=1, fresh=True).origins
    assert look_up(one) == first.answers
    assert look_up(other) == {}


@pytest.mark.parametrize("of", [2, 3])
def test_a_later_batch_is_in_exactly_one_share(of: int) -> None:
    first = ["a", "b", "c"]
    shares = [shard_filter(Shard(k, of), first) for k in range(1, of + 1)]
    for name in (*first, *(f"later-{k}" for k in range(20))):
        assert sum(is_ours(name) for is_ours in shares) == 1, name


def test_an_index_says_the_values_of_all_parameters() -> None:
    said = Basis(LIBRARY.select(), values={"rho": Fraction(1, 3)}).common_data()
    assert {*said["parameters"]} == {*LIBRARY.parameters}
    assert said["parameters"]["rho"] == "1/3"


def test_a_search_of_an_analysis_is_asked_as_the_question_is() -> None:
    truck = load_vehicle("truck")
    home = LIBRARY.select()
    models = {"": truck, "POV": CAR, "POV9": CAR}
    given = Basis(home, (), {"rho": Fraction(1, 3)}, Fraction(7), Effort(5.0, 9.0), 2.0, "severe", models)
    road = load_road("main-3")
    search = given.search(query(home), road)
    setting = search.setting
    assert (setting.values, setting.horizon, setting.road) == (given.values, given.horizon, road)
    assert dict(setting.vehicles) == {"": truck, "POV": CAR}
    options = search.search_options
    assert (options.objective, options.effort, options.explain) == ("severe", given.effort, False)
    assert given.search(query(home), effort=Effort(1.0), explain=True).search_options.effort == Effort(1.0)


def query(home: Any) -> Any:
    from roadproof.library.elaborate import read_claim

    return read_claim(home, "danger(SV,POV)")

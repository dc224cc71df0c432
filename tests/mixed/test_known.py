"""Answers that are known where one thing is another than when they were computed; all else is the same."""

import itertools
import json
import os
from collections.abc import Iterator
from fractions import Fraction
from pathlib import Path
from typing import Any

import pytest
from roadproof.analysis.study import known
from roadproof.analysis.study.known import KnownAnswer, KnownAnswers, told

from roadproof.analysis.basis import Basis
from roadproof.frontends.api.definitions import load
from roadproof.frontends.api.proofs import claims_of
from roadproof.library.elaborate import read_claim
from roadproof.library.loading import build_library, bundled_library
from roadproof.library.specification import Source
from roadproof.questions.overlap import Meeting, OverlapQuestion
from roadproof.questions.question import walk
from roadproof.questions.redundancy import RedundancyQuestion
from roadproof.questions.settle import look_up, settle
from roadproof.runtime import package_data
from roadproof.runtime.archives import SWITCH
from roadproof.runtime.budget import Effort
from roadproof.world.models import load_road, load_vehicle

SCHEMA = "roadproof/overlap/1"
SAID = {
    "set": "base",
    "lanes": "same",
    "roles": "same",
    "start": "same",
    "options": {"speed": "longitudinal"},
    "parameters": {"rho": "1"},
    "specs": [],
}
MORE = {"vehicles": "car"}
ANSWER = KnownAnswer({"verdict": "PROVED"}, {"a.json": "{}"})


@pytest.fixture(autouse=True)
def home(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Path]:
    monkeypatch.setenv(SWITCH, "on")
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    (tmp_path / "models").mkdir()
    (tmp_path / "models/car.toml").write_text("one")
    for module in (known, package_data):
        monkeypatch.setattr(module, "shipped", lambda folder: tmp_path / folder)
    package_data.program.cache_clear()
    yield tmp_path
    known._read.cache_clear()
    package_data.program.cache_clear()


def found(name: str = "pair", key: str = "key", *question: Any) -> KnownAnswer | None:
    return KnownAnswers.to(*(question or (SCHEMA, SAID, MORE))).find(name, key)


def remember(folder: Path | None = None) -> None:
    store = KnownAnswers.to(SCHEMA, SAID, MORE)
    store.remember("pair", "key", ANSWER)
    if folder is not None:
        store.ship(folder, {store.entry("pair", "key"): ANSWER.content})


@pytest.mark.parametrize("where", ["cache", "shipped"])
def test_any_other_part_of_the_question_is_another_question(where: str, home: Path) -> None:
    if where == "cache":
        remember()
    else:
        store = KnownAnswers.to(SCHEMA, SAID, MORE)
        store.ship(home / "proofs/known", {store.entry("pair", "key"): ANSWER.content})
    same = found()
    assert same is not None
    assert (same.record, same.origin) == (ANSWER.record, where)
    assert found("other") is None
    assert found("pair", "other") is None
    for part, other in (
        *((name, "any") for name in ("set", "lanes", "roles", "start")),
        ("options", {"speed": "total"}),
        ("more", 1),
    ):
        assert found("pair", "key", SCHEMA, {**SAID, part: other}, MORE) is None, part
    assert found("pair", "key", SCHEMA, SAID, {"vehicles": "truck"}) is None
    assert found("pair", "key", SCHEMA, SAID, {}) is None
    assert found("pair", "key", "roadproof/overlap/2", SAID, MORE) is None
    for used_where_named in ("parameters", "specs"):
        assert found("pair", "key", SCHEMA, {**SAID, used_where_named: []}, MORE) is not None


def test_another_version_has_no_answers(monkeypatch: pytest.MonkeyPatch) -> None:
    remember()
    monkeypatch.setattr(known, "ANSWERS", "9.9.9")
    assert found() is None


@pytest.mark.parametrize("change", ["another size", "other bytes", "one more", "one less"])
def test_a_changed_model_or_program_has_no_answers(change: str, home: Path) -> None:
    model = home / "models/car.toml"
    before = model.stat()
    remember()
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
    package_data.program.cache_clear()
    assert found() is None


def test_a_changed_source_has_no_answers(home: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    source = home / "roadproof/runtime/package_data.py"
    source.parent.mkdir(parents=True)
    source.write_text("one")
    monkeypatch.setattr(package_data, "__file__", str(source))
    package_data.program.cache_clear()
    remember()
    assert found() is not None
    (source.parents[1] / "more.py").write_text("another module")
    package_data.program.cache_clear()
    assert found() is None


def test_what_is_switched_off_is_neither_taken_nor_kept(home: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv(SWITCH, "off")
    remember()
    assert not (home / "cache/roadproof/answers").exists()
    monkeypatch.setenv(SWITCH, "on")
    remember()
    monkeypatch.setenv(SWITCH, "off")
    assert found() is None


@pytest.mark.parametrize("change", ["an answer", "the seal", "the schema", "half of it", "no archive"])
def test_a_shipped_archive_that_was_changed_is_none(change: str, home: Path) -> None:
    import lzma

    store = KnownAnswers.to(SCHEMA, SAID, MORE)
    path = store.ship(home / "proofs/known", {store.entry("pair", "key"): ANSWER.content})
    assert found() is not None
    content = json.loads(lzma.decompress(path.read_bytes()))
    match change:
        case "an answer":
            content["answers"][store.entry("pair", "key")]["record"]["verdict"] = "REFUTED"
        case "the seal":
            content["seal"] = "0" * 24
        case "the schema":
            content["schema"] = "roadproof/known/0"
        case _:
            pass
    data = lzma.compress(json.dumps(content).encode())
    path.write_bytes({"half of it": data[: len(data) // 2], "no archive": b"x"}.get(change, data))
    known._read.cache_clear()
    assert found() is None


@pytest.mark.parametrize(("shipped", "cached"), list(itertools.product(range(3), repeat=2)))
def test_known_answers_are_counted_by_where_they_are_from(shipped: int, cached: int) -> None:
    lines = [*told([*["shipped"] * shipped, *["cache"] * cached], 9)]
    assert len(lines) == bool(shipped + cached)
    for line in lines:
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
        return basis.key([read_claim(basis.specification, text)])

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
    [(_, claim), *_] = [x for batch in question.batches({}) for x in walk(batch, lambda *_: None)]
    return claim


def test_known_answers_are_looked_up_by_the_claim() -> None:
    one, other = (claims_of(load(), [f"v_lon(SV) > {k} m/s -> v_lon(SV) > 1 m/s"], None) for k in (2, 3))
    first = settle(one, hands=1)
    assert not first.origins
    assert [*settle(one, hands=1).origins.values()] == ["cache"]
    assert not settle(one, hands=1, fresh=True).origins
    assert look_up(one) == first.answers
    assert look_up(other) == {}


@pytest.mark.parametrize("of", [2, 3])
def test_a_later_piece_is_in_exactly_one_share(of: int) -> None:
    from types import SimpleNamespace

    from roadproof.analysis.study.frame import _share

    from roadproof.runtime.executors import Shard

    study: Any = SimpleNamespace(pieces=lambda known: ["a", "b", "c"], doubt=lambda x, reason: {x: None})
    shares = [_share(study, Shard(k, of)) for k in range(1, of + 1)]
    for piece in ["a", "b", "c", *(f"later-{k}" for k in range(20))]:
        assert sum(is_ours(piece) for is_ours in shares) == 1, piece


def test_an_index_says_the_values_of_all_parameters() -> None:
    said = Basis(LIBRARY.select(), values={"rho": Fraction(1, 3)}).said()
    assert {*said["parameters"]} == {*LIBRARY.parameters}  # type: ignore[misc]
    assert said["parameters"]["rho"] == "1/3"  # type: ignore[index,call-overload]


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


def test_a_proof_of_an_analysis_costs_what_is_said(monkeypatch: pytest.MonkeyPatch) -> None:
    from roadproof.analysis import basis
    from roadproof.engines.prove.prover import Result
    from roadproof.runtime.budget import BudgetExceeded
    from roadproof.verdict import Verdict

    asked: list[Effort] = []

    def prove(home: Any, claim: Any, effort: Effort, shared: Any) -> Result:
        asked.append(effort)
        if effort.units == 9.0:
            raise BudgetExceeded(3.0)
        return Result(verdict=Verdict.PROVED)

    monkeypatch.setattr(basis, "prove_of_scenarios", prove)
    given = Basis(LIBRARY.select(), effort=Effort(60.0, 8.0), proof=2.0)
    given.proof_of(query(given.specification))
    given.proof_of(query(given.specification), 5.0)
    late = given.settle("claim", query(given.specification), 9.0, "label")
    assert asked == [Effort(2.0, 8.0), Effort(5.0, 8.0), Effort(9.0, 8.0)]
    assert (late.verdict, late.certificate) == (Verdict.UNKNOWN, None)
    assert "--timeout" in late.reason
    assert given.settle("claim", query(given.specification), 1.0, "label").verdict is Verdict.PROVED


def test_the_set_of_an_analysis_is_the_one_that_is_named() -> None:
    assert HERE.set_names == ("base",)
    assert Basis(LIBRARY.select(), ("base", "ext")).set_names == ("base", "ext")

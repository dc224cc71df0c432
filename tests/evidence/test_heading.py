"""How answers begin: the version, and a fingerprint of the library, in indices too, where it is checked."""

import json
from pathlib import Path
from typing import Any

import pytest

import roadproof as rp
from evidence.folders import check, code, read, some_proofs, write
from roadproof.evidence.finding import NO_EVIDENCE
from roadproof.evidence.folder import OTHER_LIBRARY
from roadproof.evidence.heading import heading
from roadproof.library.loading import build_library, bundled_library
from roadproof.library.specification import Library, Source


def with_text(text: str) -> Library:
    return build_library([Source("mine.spec", text)], bundled_library())


def test_the_heading_names_version_and_library() -> None:
    told = heading("roadproof/any/1", bundled_library())
    assert [*told] == ["schema", "roadproof", "library"]
    assert told == {
        "schema": "roadproof/any/1",
        "roadproof": rp.__version__,
        "library": bundled_library().fingerprint,
    }


@pytest.mark.parametrize(
    ("text", "same"),
    [
        ("# a remark\n", True),
        ("def mine(a: vehicle) := true", False),
        ("param rho = 1 s where rho >= 0", False),
        ("option lateral_sign = literal | rss", False),
        ("set mine extends base { def danger(a, b: vehicle) := true }", False),
    ],
)
def test_the_fingerprint_is_that_of_what_is_declared(text: str, same: bool) -> None:
    assert (with_text(text).fingerprint == bundled_library().fingerprint) == same


def test_the_fingerprint_is_not_that_of_places() -> None:
    text = "def mine(a: vehicle) := v_lon(a) > 0 m/s"
    moved = f"\n# a remark\n\n  {text}\n"
    assert with_text(text).fingerprint == with_text(moved).fingerprint


def heads() -> dict[str, Any]:
    return {"roadproof": rp.__version__, "library": bundled_library().fingerprint}


def test_indices_with_and_without_a_heading_are_accepted(tmp_path: Path) -> None:
    folder = some_proofs(tmp_path / "proofs")
    index = {k: v for k, v in read(folder / "index.json").items() if k in ("schema", "claims")}
    write(folder / "index.json", index)  # as earlier versions wrote it
    plain = check(folder)
    write(folder / "index.json", {**index, **heads()})
    assert check(folder) == plain
    assert code(folder) == 0


def test_another_library_is_told_and_no_reason_to_reject(tmp_path: Path) -> None:
    folder = some_proofs(tmp_path / "proofs")
    index = read(folder / "index.json")
    write(folder / "index.json", {**index, **heads(), "library": "0" * 16})
    assert code(folder) == 0
    found = check(folder)
    assert all(OTHER_LIBRARY in x.unchecked for x in found if x.kind != NO_EVIDENCE)
    assert "not checked" in str(found[0])


@pytest.mark.parametrize(
    "library", [None, 7, True, [], {}, "", "0" * 15, "0" * 17, "G" * 16, "0" * 15 + "\n"]
)
def test_a_fingerprint_of_another_kind_is_refused(library: object, tmp_path: Path) -> None:
    folder = some_proofs(tmp_path / "proofs")
    write(folder / "index.json", {**read(folder / "index.json"), "library": library})
    assert code(folder) == 3
    assert any("library" in x.reason for x in check(folder))


@pytest.mark.parametrize("version", [None, 7, [], {}])
def test_a_version_of_another_kind_is_refused(version: object, tmp_path: Path) -> None:
    folder = some_proofs(tmp_path / "proofs")
    write(folder / "index.json", {**read(folder / "index.json"), "roadproof": version})
    assert code(folder) == 3


def test_planted_fingerprints_that_are_not_compared_are_noticed(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("roadproof.evidence.folder.library_of", lambda data: None)
    with pytest.raises(AssertionError):
        test_another_library_is_told_and_no_reason_to_reject(tmp_path)


def test_the_folder_of_prove_says_both(tmp_path: Path) -> None:
    rp.prove("danger(SV,POV) -> danger(SV,POV)", jobs=1).save(tmp_path / "out")
    index = json.loads((tmp_path / "out" / "index.json").read_text("utf-8"))
    assert {name: index[name] for name in heads()} == heads()

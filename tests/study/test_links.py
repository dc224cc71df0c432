"""Requirements, cases and bundles take over what was checked before: only what has not changed since.

A folder has definitions, evidence, requirements with a lock file, and a case. All is checked and bundled; one
thing is changed; all is done again, with what is remembered of former checks and without it: both are equal.
"""

import hashlib
import json
import shutil
from collections.abc import Callable, Iterator, Mapping
from contextlib import chdir
from pathlib import Path
from typing import Any

import pytest

import roadproof as rp
from api.both_interfaces import without_seconds
from roadproof.errors import RoadproofError
from roadproof.extensions.assurance import pins
from roadproof.extensions.assurance.pins import Pin
from roadproof.extensions.assurance.settings import BundleSettings
from roadproof.runtime.archives import SWITCH
from study.changes import TEXTS
from study.stored_question import SPEC

CLAIMS = ("both(SV) -> v_lon(SV) > 7 m/s", "paced(SV) -> v_lon(SV) > 24 m/s")
DRIVE = "foo(SV) and v_lon(SV) > low"
DANGER = "danger(SV,POV)"
PARAMETERS = ("rho", "a_max", "b_min", "b_max", "a_max_lat", "b_min_lat", "minDanger")
OPTIONS = {"lateral_sign": "literal", "lateral_rss": "signed", "speed": "total", "rss_form": "robust"}
"""The parameters and options of the library that ``DANGER`` depends on; another choice for each option."""
REQUIREMENTS = f"""\
[trace]
evidence = ["proofs", "drives"]
specs = ["mine.spec"]
parameters = {{ gap = "2 s" }}
vehicles = {{ SV = "car" }}

[[requirement]]
id = "BOTH"
text = "Both readings are fast."
claims = ["{CLAIMS[0]}"]

[[requirement]]
id = "PACED"
text = "What is paced is fast."
claims = ["{CLAIMS[1]}"]

[[requirement]]
id = "FAST"
text = "A vehicle is fast."
scenarios = ["{DRIVE}"]
"""
CASE = """\
[G1]
goal = "The claims hold"
supported-by = ["Sn1"]

[Sn1]
solution = "Proofs"
evidence = "proofs"
expect = "PROVED"
entries = 2
"""


def set_up(folder: Path) -> None:
    """Write definitions, evidence, requirements and a case, and accept what each link rests on."""
    folder.mkdir()
    (folder / "mine.spec").write_text(SPEC)
    using = rp.load(specs=[folder / "mine.spec"])
    rp.prove(*CLAIMS, using=using, jobs=1, out=folder / "proofs")
    rp.witness(DRIVE, using=using, jobs=1, out=folder / "drives")
    rp.witness(DANGER, using=using, jobs=1, out=folder / "dangers")
    drive = json.loads(first_evidence(folder, "dangers").read_text("utf-8"))
    assert {*drive["parameters"]} == {*PARAMETERS, *OPTIONS, "pace", "idle"}
    (folder / "roadproof-1.0-py3-none-any.whl").write_bytes(b"a wheel")
    (folder / "requirements.toml").write_text(REQUIREMENTS)
    (folder / "case.toml").write_text(CASE)
    found = rp.requirements(folder / "requirements.toml", jobs=1, accept=True)
    assert {*map(str, found.states.values())} == {"proved", "witnessed"}


@pytest.fixture(scope="module", autouse=True)
def home(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Path]:
    """A cache of our own, beside the folder that all changes begin from."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv(SWITCH, "on")
        home = tmp_path_factory.mktemp("links")
        patch.setattr(pins, "pins_of", lambda _: [Pin("numpy", "2.4.0", "1" * 64)])
        patch.setattr(pins, "own_wheel", lambda _: home / "first" / "roadproof-1.0-py3-none-any.whl")
        patch.setattr(pins, "download", lambda _, place: (place / "numpy.whl").write_bytes(b"numpy"))
        patch.setenv("XDG_CACHE_HOME", str(home / "cache"))
        set_up(home / "first")
        yield home


def trace(folder: Path) -> Any:
    return rp.requirements(folder / "requirements.toml", jobs=1).as_data()


def case(folder: Path) -> Any:
    return rp.assurance(folder / "case.toml", jobs=1, specs=[folder / "mine.spec"]).as_data()


RESULTS = ("proofs", "drives", "dangers", "requirements.toml", "case.toml")


def bundle(folder: Path, *results: str, **options: Any) -> Any:
    """A bundle as data, with a digest of the archive and of its signature."""
    with chdir(folder):
        more = {"specs": ["mine.spec"], **options}
        made = rp.bundle(*(results or RESULTS), out="safety.tar.gz", jobs=1, **more)
        written = [made.path, *([made.signature] if made.signature else [])]
        digests = [hashlib.sha256(x.read_bytes()).hexdigest() for x in written]
    (folder / "safety.tar.gz").unlink()
    return {"manifest": made.as_data(), "exit code": int(made.exit_code), "digests": digests}


def answer(ask: Callable[[Path], Any], folder: Path) -> Any:
    """An answer as data, or why there is none."""
    try:
        return without_seconds(ask(folder))
    except RoadproofError as error:
        return {"error": str(error)}


def edit(name: str, before: str, after: str) -> Callable[[Path], None]:
    def change(folder: Path) -> None:
        text = (folder / name).read_text("utf-8")
        assert before in text, name
        (folder / name).write_text(text.replace(before, after), "utf-8")

    return change


def first_evidence(folder: Path, within: str) -> Path:
    return next(x for x in sorted((folder / within).glob("*.json")) if x.name != "question.json")


def remove_evidence(within: str) -> Callable[[Path], None]:
    return lambda folder: first_evidence(folder, within).unlink()


def edit_evidence(within: str, change: Callable[[dict[str, Any]], None]) -> Callable[[Path], None]:
    def edit_file(folder: Path) -> None:
        path = first_evidence(folder, within)
        content = json.loads(path.read_text("utf-8"))
        change(content)
        path.write_text(json.dumps(content), "utf-8")

    return edit_file


def swap_evidence(folder: Path) -> None:
    one, other = (x for x in sorted((folder / "proofs").glob("*.json")) if x.name != "question.json")
    first = one.read_bytes()
    one.write_bytes(other.read_bytes())
    other.write_bytes(first)


def add_file(name: str, text: str) -> Callable[[Path], None]:
    return lambda folder: (folder / name).write_text(text, "utf-8") and None


CHANGES: Mapping[str, Callable[[Path], None]] = {
    **{f"text: {name}": edit("mine.spec", *texts) for name, texts in TEXTS.items()},
    **{f"text beside the proofs: {name}": edit("proofs/mine.spec", *texts) for name, texts in TEXTS.items()},
    "a parameter": edit("requirements.toml", "2 s", "1 s"),
    "the spec set": edit("requirements.toml", "[trace]", '[trace]\nset = "mine"'),
    "an option": edit("requirements.toml", "[trace]", '[trace]\noptions = { pace = "quick" }'),
    "the vehicle": edit("requirements.toml", '"car"', '"truck"'),
    "the specifications": edit("requirements.toml", 'specs = ["mine.spec"]\n', ""),
    "the evidence": edit("requirements.toml", '["proofs", "drives"]', '["drives"]'),
    "a claim": edit("requirements.toml", "> 7 m/s", "> 6 m/s"),
    "the text of a requirement": edit("requirements.toml", "Both readings", "All readings"),
    "the expected verdict": edit("case.toml", '"PROVED"', '"REFUTED"'),
    "the number of entries": edit("case.toml", "entries = 2", "entries = 1"),
    "no proof": remove_evidence("proofs"),
    "no drive": remove_evidence("drives"),
    "proofs that are exchanged": swap_evidence,
    "a proof of another claim": edit_evidence("proofs", lambda x: x.update(claim="v_lon(SV) > 1 m/s")),
    "a proof that assumes more": edit_evidence("proofs", lambda x: x.update(assuming=["motion"])),
    "a slower drive": edit_evidence("drives", lambda x: x["vehicles"]["SV"].update(v_lon="1")),
    "a file beside the proofs": add_file("proofs/other.json", "{}"),
    "other lanes in a road beside the drive": add_file("drives/road.toml", "[[lanelet]]\nid = 1\n"),
    "no lock file": lambda folder: next(folder.glob("*lock*")).unlink(),
    **{
        f"the {x} of a drive": edit_evidence(
            "dangers", lambda drive, x=x: drive["parameters"].update({x: "4"})
        )
        for x in PARAMETERS
    },
    **{
        f"the {x} of a drive": edit_evidence(
            "dangers", lambda drive, x=x, y=y: drive["parameters"].update({x: y})
        )
        for x, y in OPTIONS.items()
    },
}
SEEN: Mapping[str, tuple[str, ...]] = {
    "trace": (
        *("text: leaf, which two sets share", "text: bar of a set", "the specifications", "a claim"),
        *("no proof", "no drive", "proofs that are exchanged", "a proof of another claim", "no lock file"),
        *("a slower drive", "the spec set", "a proof that assumes more"),
    ),
    "bundle": tuple(CHANGES),
    "case": (
        *("the expected verdict", "the number of entries", "no proof", "proofs that are exchanged"),
        *("a proof of another claim", "a file beside the proofs", "a proof that assumes more"),
    ),
}
"""The changes that must change the answer, by command."""
ASK: Mapping[str, Callable[[Path], Any]] = {"trace": trace, "case": case, "bundle": bundle}


@pytest.mark.parametrize("change", CHANGES)
def test_what_was_checked_before_is_taken_over_only_where_it_is_the_same(
    change: str, home: Path, tmp_path: Path
) -> None:
    folder = home / "now"  # one place, so that no path is another
    shutil.rmtree(folder, ignore_errors=True)
    shutil.copytree(home / "first", folder)
    first = {name: answer(ask, folder) for name, ask in ASK.items()}
    CHANGES[change](folder)
    known = {name: answer(ask, folder) for name, ask in ASK.items()}
    shutil.rmtree(home / "cache/roadproof/checked")
    fresh = {name: answer(ask, folder) for name, ask in ASK.items()}
    assert known == fresh
    for name, changes in SEEN.items():
        assert change not in changes or known[name] != first[name], f"{name} does not see it"


BUNDLES: Mapping[str, tuple[tuple[str, ...], Mapping[str, Any]]] = {
    "specs": (RESULTS, {"specs": []}),
    "wheel": (RESULTS, {"wheel": "roadproof-1.1-py3-none-any.whl"}),
    "wheels": (RESULTS, {"wheels": True}),
    "sign": (RESULTS, {"sign": "key.pem"}),
    "results": (("proofs", "requirements.toml", "drives"), {}),
}
"""Other results and options of a bundle, one at a time."""


def test_every_option_of_a_bundle_is_changed() -> None:
    options = BundleSettings.options().items()
    own = {x for x, option in options if option.keyword and option.group in ("definitions", "question")}
    assert own == {*BUNDLES} - {"results"} | {"progress"}


def write_key(path: Path) -> None:
    """Write an Ed25519 key; skip the test where cryptography is not installed."""
    ed25519 = pytest.importorskip("cryptography.hazmat.primitives.asymmetric.ed25519")
    kinds = pytest.importorskip("cryptography.hazmat.primitives.serialization")
    key = ed25519.Ed25519PrivateKey.from_private_bytes(bytes(32))
    form = kinds.Encoding.PEM, kinds.PrivateFormat.PKCS8, kinds.NoEncryption()
    path.write_bytes(key.private_bytes(*form))


@pytest.mark.parametrize("change", BUNDLES)
def test_a_bundle_with_another_option_is_that_of_a_fresh_check(change: str, home: Path) -> None:
    folder = home / "now"
    shutil.rmtree(folder, ignore_errors=True)
    shutil.copytree(home / "first", folder)
    (folder / "roadproof-1.1-py3-none-any.whl").write_bytes(b"another wheel")
    if change == "sign":
        write_key(folder / "key.pem")
    results, options = BUNDLES[change]
    first = answer(bundle, folder)
    assert "error" not in first
    known = answer(lambda x: bundle(x, *results, **options), folder)
    shutil.rmtree(home / "cache/roadproof/checked")
    fresh = answer(lambda x: bundle(x, *results, **options), folder)
    assert known == fresh
    assert known != first

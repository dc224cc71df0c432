"""Bundles for auditors: what is in them, that they are deterministic, and that they check themselves."""

import hashlib
import io
import json
import os
import shutil
import subprocess
import sys
import tarfile
from pathlib import Path

import pytest

import roadproof as rp
from cli.test_schemas import accept
from roadproof.errors import InputError, MissingSolverError, UsageError
from roadproof.extensions.assurance import pins
from roadproof.extensions.assurance.pins import Pin
from roadproof.frontends.cli.main import main
from roadproof.verdict import ExitCode

ROOT = Path(__file__).parents[4]
SPEC = "def slow(a: vehicle) := v_lon(a) < 3 m/s\n"
PINS = [Pin("cvc5", "1.3.0", "0" * 64), Pin("numpy", "2.4.0", "1" * 64)]


@pytest.fixture(scope="module")
def made(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with evidence: proofs with definitions of the user, and a catalogue with its tests."""
    home = tmp_path_factory.mktemp("made")
    (home / "own.spec").write_text(SPEC, "utf-8")
    (home / "tests").mkdir()
    shutil.copy(ROOT / "examples/catalogue/tests/drives/braking.json", home / "tests")
    with pytest.MonkeyPatch.context() as patch:
        patch.chdir(home)
        rp.prove("slow(SV) -> v_lon(SV) < 4 m/s", using=rp.load(specs=["own.spec"]), out="proofs", jobs=1)
        rp.catalogue("tests", among="4", classes=False, drivers=(), out="report", jobs=1)
    return home


@pytest.fixture
def home(made: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A copy of it as the working directory; pip is not asked."""
    shutil.copytree(made, tmp_path / "home")
    monkeypatch.chdir(tmp_path / "home")
    monkeypatch.setattr(pins, "pins_of", lambda more: PINS)
    wheel = tmp_path / "roadproof-1.0-py3-none-any.whl"
    wheel.write_bytes(b"a wheel")
    monkeypatch.setattr(pins, "own_wheel", lambda folder: wheel)
    return tmp_path / "home"


def contents(path: Path) -> dict[str, bytes]:
    found = {}
    with tarfile.open(path) as archive:
        for entry in archive:
            file = archive.extractfile(entry)
            assert file is not None
            found[entry.name.partition("/")[2]] = file.read()
    return found


def test_it_has_evidence_definitions_packages_page_and_script(home: Path) -> None:
    found = rp.bundle("proofs", "report", specs=["own.spec"], out="safety.tar.gz")
    inside = contents(home / "safety.tar.gz")
    assert {"proofs/question.json", "report/question.json", "own.spec", "tests/braking.json"} <= {*inside}
    assert inside["requirements.txt"].decode().splitlines() == [
        f"roadproof==1.0 --hash=sha256:{hashlib.sha256(b'a wheel').hexdigest()}",
        f"cvc5==1.3.0 --hash=sha256:{'0' * 64}",
        f"numpy==2.4.0 --hash=sha256:{'1' * 64}",
    ]
    assert inside["index.html"].startswith(b"<!doctype html>")
    sums = dict(reversed(line.split("  ")) for line in inside["SHA256SUMS"].decode().splitlines())
    assert sums == {name: hashlib.sha256(x).hexdigest() for name, x in inside.items() if name != "SHA256SUMS"}
    manifest = json.loads(inside["manifest.json"])
    accept("bundle.json", manifest)
    assert manifest == found.as_data()
    assert manifest["evidence"] == ["proofs", "report"]
    assert manifest["claims"] == manifest["accepted"] == len(found.checked.findings) > 1
    script = inside["check.sh"].decode()
    assert "@" not in script.replace('"$@"', "")
    assert "--spec own.spec" in script


def test_the_same_content_is_the_same_bundle(
    home: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    rp.bundle("proofs", specs=["own.spec"], out="safety.tar.gz")
    shutil.copytree(home / "proofs", tmp_path / "other" / "proofs", copy_function=shutil.copyfile)
    shutil.copyfile(home / "own.spec", tmp_path / "other" / "own.spec")
    monkeypatch.chdir(tmp_path / "other")
    rp.bundle("proofs", specs=["own.spec"], out="safety.tar.gz")
    assert (home / "safety.tar.gz").read_bytes() == (tmp_path / "other" / "safety.tar.gz").read_bytes()


def test_evidence_that_is_rejected_is_told(home: Path) -> None:
    [proof] = (home / "proofs").glob("claim-*.json")
    proof.write_text(proof.read_text("utf-8").replace("< 4 m/s", "< 2 m/s"), "utf-8")
    assert main(["bundle", "proofs", "--spec", "own.spec", "-o", "x.tar.gz"]) == ExitCode.UNEXPECTED
    assert b"-eq 10 ]" in contents(home / "x.tar.gz")["check.sh"]


@pytest.mark.parametrize(
    ("results", "options", "told"),
    [
        (["proofs"], {"out": "x.zip"}, "ends with .tar.gz"),
        ([], {"out": "x.tar.gz"}, "at least one folder"),
        (["nowhere"], {"out": "x.tar.gz"}, "nowhere does not exist"),
        (["/etc/hostname"], {"out": "x.tar.gz"}, "is outside of"),
        (["proofs"], {"out": "x.tar.gz", "sign": "own.spec"}, "openssl genpkey"),
        (["proofs"], {"out": "x.tar.gz", "wheel": "own.spec"}, "is no wheel of roadproof"),
        (["proofs"], {"out": "x.tar.gz", "wheel": "numpy-2-py3-none-any.whl"}, "is no wheel of roadproof"),
    ],
)
def test_mistakes(home: Path, results: list[str], options: dict[str, str], told: str) -> None:
    (home / "numpy-2-py3-none-any.whl").write_bytes(b"another package")
    with pytest.raises((InputError, UsageError, MissingSolverError), match=told):
        rp.bundle(*results, **options)
    assert not list(home.glob("x.*"))


def test_a_signature_is_verified_by_another_program(home: Path) -> None:
    pytest.importorskip("cryptography")
    if shutil.which("openssl") is None:
        pytest.skip("there is no openssl to verify signatures")
    make = (
        "openssl genpkey -algorithm ed25519 -out key.pem && openssl pkey -in key.pem -pubout -out public.pem"
    )
    subprocess.run(make, shell=True, check=True)
    found = rp.bundle("proofs", specs=["own.spec"], out="safety.tar.gz", sign="key.pem")
    assert found.signature == Path("safety.tar.gz.sig")
    verify = (
        "openssl pkeyutl -verify -pubin -inkey public.pem -rawin -sigfile safety.tar.gz.sig -in safety.tar.gz"
    )
    assert subprocess.run(verify, shell=True, check=False, capture_output=True).returncode == 0
    with (home / "safety.tar.gz").open("ab") as file:
        file.write(b"\0")
    assert subprocess.run(verify, shell=True, check=False, capture_output=True).returncode != 0


def unpacked(archive: Path, folder: Path) -> Path:
    with tarfile.open(fileobj=io.BytesIO(archive.read_bytes())) as opened:
        opened.extractall(folder, filter="data")
    return folder / "safety"


def ask(folder: Path) -> subprocess.CompletedProcess[str]:
    """Run the script of a bundle without this environment, but for compiled theories of Coq."""
    kept = os.environ.get("XDG_CACHE_HOME") or str(Path.home() / ".cache")
    empty = {"PATH": "/usr/bin:/bin", "HOME": str(folder), "XDG_CACHE_HOME": kept}
    command = ["sh", "check.sh", sys.executable]
    return subprocess.run(command, cwd=folder, env=empty, capture_output=True, text=True, check=False)


def test_a_changed_file_is_found_before_anything_is_installed(home: Path, tmp_path: Path) -> None:
    rp.bundle("proofs", specs=["own.spec"], out="safety.tar.gz")
    folder = unpacked(home / "safety.tar.gz", tmp_path)
    with (folder / "own.spec").open("a") as file:
        file.write("\n")
    done = ask(folder)
    assert done.returncode == 10
    assert "FAILED: files are not those of the bundle" in done.stdout


CHECKED = ("proofs", "case.toml", "asked.toml")
AFTER = "# Check an assurance case or requirements: ``argue COMMAND FILE``."
CASE = """
[G1]
goal = "Claims hold"
supported-by = "Sn1"
[Sn1]
solution = "Proofs"
evidence = "proofs"
expect = "EXPECTED"
"""
TRACED = """
[trace]
evidence = ["proofs"]
specs = ["own.spec"]
[[requirement]]
id = "R1"
text = "Slow means slow"
claims = ["slow(SV) -> v_lon(SV) < LIMIT m/s"]
"""


@pytest.mark.parametrize(
    ("expected", "limit", "codes"), [("PROVED", 4, (0, 0)), ("REFUTED", 4, (10, 0)), ("PROVED", 1, (0, 10))]
)
def test_the_script_checks_cases_and_requirements(
    home: Path, tmp_path: Path, expected: str, limit: int, codes: tuple[int, int]
) -> None:
    """The script runs the commands of this environment, without its lines about packages and evidence."""
    (home / "case.toml").write_text(CASE.replace("EXPECTED", expected), "utf-8")
    (home / "asked.toml").write_text(TRACED.replace("LIMIT", str(limit)), "utf-8")
    found = rp.bundle(*CHECKED, specs=["own.spec"], out="safety.tar.gz", jobs=1)
    assert (found.exit_code == 0) is (codes == (0, 0))
    told = [(x.command, x.file, x.exit_code) for x in found.manifest.arguments]
    assert told == [("trace", "asked.toml", codes[1]), ("assurance", "case.toml", codes[0])]
    assert json.loads(contents(home / "safety.tar.gz")["manifest.json"])["arguments"] == [
        {"command": command, "file": file, "exit_code": code} for command, file, code in told
    ]
    assert f"trace asked.toml: exit code {codes[1]}" in str(found)
    folder = unpacked(home / "safety.tar.gz", tmp_path)
    lines = (folder / "check.sh").read_text("utf-8").splitlines()
    for path, command in (("asked.toml", "trace"), ("case.toml", "assurance")):
        assert f"argue {command} {path}" in lines
    rest = [x for x in lines if "-m pip" not in x and "-m venv" not in x]
    before, after = rest.index("for solver in z3 cvc5; do"), rest.index(AFTER)
    script = "\n".join([*rest[:before], *rest[after:]])
    script = script.replace("$place/environment/bin", str(Path(sys.executable).parent))
    done = subprocess.run(["sh", "-c", script], cwd=folder, capture_output=True, text=True, check=False)
    assert (done.returncode == 0) is (codes == (0, 0)), done.stdout + done.stderr
    for command, code in zip(("assurance case.toml", "trace asked.toml"), codes, strict=True):
        assert (f"FAILED: the exit code of {command} is" in done.stdout) is (code != 0), done.stdout


def test_cases_and_requirements_are_checked_with_the_files_of_the_bundle_alone(
    home: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    """A file that is beside them, and not in the bundle, shows nothing."""
    (home / "case.toml").write_text(CASE.replace("EXPECTED", "PROVED"), "utf-8")
    (home / "asked.toml").write_text(TRACED.replace("LIMIT", "4"), "utf-8")
    assert main(["trace", "asked.toml", "--accept"]) == 0
    held = rp.bundle(*CHECKED, specs=["own.spec"], out="safety.tar.gz", jobs=1)
    assert held.exit_code == 0
    assert "asked.lock.json" in held.manifest.files
    (home / "asked.lock.json").unlink()
    shutil.copytree(home / "proofs", home / "other")
    for command, name in (("assurance", "case.toml"), ("trace", "asked.toml")):
        path = home / name
        path.write_text(path.read_text("utf-8").replace('"proofs"', '"other"'), "utf-8")
        assert main([command, name, "--spec", "own.spec"]) == 0
        code = main(["bundle", "proofs", name, "--spec", "own.spec", "-o", "x.tar.gz", "--jobs", "1"])
        told = capfd.readouterr()
        assert code != 0
        assert (
            f"name all files on which {name} rests" in told.err or f"{command} {name}: exit code" in told.out
        )
        assert "/tmp" not in told.err + told.out


def test_it_checks_itself_in_an_empty_environment(
    made: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """With the packages that pip finds; the catalogue is judged again from its tests."""
    shutil.copytree(made, tmp_path / "home")
    monkeypatch.chdir(tmp_path / "home")
    try:
        rp.bundle("proofs", "report", specs=["own.spec"], out="safety.tar.gz")
    except MissingSolverError as error:
        pytest.skip(f"pip finds no packages here: {error}")
    done = ask(unpacked(tmp_path / "home" / "safety.tar.gz", tmp_path))
    assert done.returncode == 0, done.stdout + done.stderr
    with_coq = shutil.which("coqc") is not None
    assert done.stdout.count("accepted by") == 2 + with_coq, done.stdout
    assert ("accepted by coq" in done.stdout) is with_coq
    assert "OK: everything comes out as when the bundle was made" in done.stdout

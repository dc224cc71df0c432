"""A bundle for auditors: evidence with definitions, pinned packages, a page, and a script that checks it."""

import gzip
import hashlib
import io
import json
import shlex
import sys
import sysconfig
import tarfile
import tempfile
from collections.abc import Iterable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Literal, TypeAlias, Unpack

from roadproof.errors import InputError, MissingSolverError, UsageError
from roadproof.evidence.codec import write
from roadproof.evidence.strict import JsonObject
from roadproof.extensions.assurance import pins as packages
from roadproof.extensions.assurance.answers.bundle import Argument, Manifest, Package
from roadproof.extensions.assurance.assuring import assurance
from roadproof.extensions.assurance.case.case import Kind
from roadproof.extensions.assurance.keywords import BundleKeywords
from roadproof.extensions.assurance.requirements.fingerprints import lock_path
from roadproof.extensions.assurance.settings import Bundle as Options
from roadproof.extensions.assurance.tracing import requirements
from roadproof.extensions.catalogue.kept import SCHEMA as CATALOGUE
from roadproof.extensions.pages.page.results import read_results
from roadproof.extensions.pages.reporting import page
from roadproof.frontends.api.checking import CheckReport
from roadproof.frontends.settings.option import takes
from roadproof.runtime.files import refuse_name, utf8, whole_file
from roadproof.runtime.pool import Progress
from roadproof.runtime.records import dataclass
from roadproof.runtime.version import VERSION
from roadproof.verdict import ExitCode
from roadproof.world.models import read_toml

if TYPE_CHECKING:
    from cryptography.hazmat.primitives.asymmetric.ed25519 import Ed25519PrivateKey

SCRIPT = Path(__file__).parent / "bundle_files" / "check.sh"
PAGE, SUMS, MANIFEST, REQUIREMENTS = "index.html", "SHA256SUMS", "manifest.json", "requirements.txt"
_Command: TypeAlias = Literal["assurance", "trace"]
_TIME = 0  # when every file in a bundle was changed, so that the same content is the same bundle


@dataclass(frozen=True)
class Bundle:
    """A bundle that was written to ``path``; ``checked``: what was found of its evidence.

    ``exit_code``: the gravest of ``roadproof check`` and of the cases and requirements inside.
    """

    path: Path
    manifest: Manifest
    checked: CheckReport
    signature: Path | None
    exit_code: ExitCode

    def as_data(self) -> JsonObject:
        """The manifest as plain data."""
        return write(self.manifest)

    def __str__(self) -> str:
        said = self.manifest
        size = f"{self.path.stat().st_size / 1e6:.1f} MB"
        lines = [f"{self.path}: {len(said.files)} files, {size}, {said.accepted} of {said.claims} accepted"]
        lines += [f"{x.command} {x.file}: exit code {x.exit_code}" for x in said.arguments]
        lines += [] if self.signature is None else [f"signature: {self.signature}"]
        return "\n".join([*lines, f"tar xzf {self.path.name}; sh {_stem(self.path)}/check.sh"])


@takes(Options)
def bundle(*results: str | Path, out: str | Path, **options: Unpack[BundleKeywords]) -> Bundle:
    """Write evidence with all that its check needs into one archive, which is the same for the same content.

    ``results``: folders of evidence, and other files such as requirements, all below the working directory,
    whose paths are kept; the tests of a catalogue come with its answer. ``out``: NAME.tar.gz.
    ``specs``: specification files.
    ``wheel``: the wheel of this version, where pip cannot make it; ``wheels``: whether the files of all
    packages are inside, so that the check needs no network. ``sign``: an Ed25519 key in PEM, by which
    NAME.tar.gz.sig is made. Raises ``InputError``, ``UsageError``, ``MissingSolverError``.
    """
    asked = Options.of(options)
    target = Path(out)
    if not target.name.endswith(".tar.gz"):
        raise UsageError(f"out={target}: name a file that ends with .tar.gz")
    key = None if asked.sign is None else _signing_key(Path(asked.sign))
    named, specs = [_inside(Path(x)) for x in results], [_inside(Path(x)) for x in asked.specs]
    evidence = [x for x in named if x.is_dir() or x.suffix == ".json"]
    everything = dict.fromkeys([*named, *_tests_of(evidence), *_locks_of(named), *specs])
    files = {path.as_posix(): path.read_bytes() for path in _files(everything)}
    content, checked = _page(evidence, specs, asked.progress)
    files[PAGE] = content
    pinned = _packages(files, asked.wheel, asked.wheels)
    files[REQUIREMENTS] = "".join(f"{x.line}\n" for x in pinned).encode()
    checkable = [x.as_posix() for x in read_results(evidence).checkable]
    arguments = _arguments(files, specs, asked)
    script = _script(checkable, [x.as_posix() for x in specs], checked.exit_code, asked.wheels, arguments)
    files |= {"check.sh": script}
    manifest = _manifest(checkable, specs, checked, arguments, pinned, files)
    files[MANIFEST] = (json.dumps(write(manifest), indent=1) + "\n").encode()
    files[SUMS] = "".join(f"{_digest(x)}  {name}\n" for name, x in sorted(files.items())).encode()
    packed = _packed(_stem(target), files)
    with whole_file(target) as file:
        file.write(packed)
    signature = None if key is None else _sign(key, target, packed)
    codes = [checked.exit_code, *(ExitCode(x.exit_code) for x in arguments)]
    return Bundle(target, manifest, checked, signature, max(codes))


def _inside(path: Path) -> Path:
    """A path relative to the working directory. Raises ``InputError`` where it is elsewhere, or nowhere."""
    if not path.exists():
        raise InputError(f"{path} does not exist")
    absolute = path.resolve()
    if not absolute.is_relative_to(Path.cwd().resolve()):
        raise InputError(f"{path} is outside of {Path.cwd()}: make the bundle in a folder above all evidence")
    return absolute.relative_to(Path.cwd().resolve())


def _tests_of(evidence: Sequence[Path]) -> Iterator[Path]:
    """The tests of catalogues, whose answers are judged again from them. Raises ``InputError``."""
    for result in read_results(evidence).results:
        request = result.data.get("request") if result.schema == CATALOGUE else None
        paths = request.get("paths") if isinstance(request, Mapping) else None
        yield from (_inside(Path(str(x))) for x in (paths if isinstance(paths, list) else ()))


def _locks_of(named: Sequence[Path]) -> Iterator[Path]:
    """The lock files beside requirements, without which no link of them is stale."""
    yield from (lock for x in named if _command_of(x) == "trace" and (lock := lock_path(x)).is_file())


def _files(paths: Iterable[Path]) -> Iterator[Path]:
    """All files of folders and files, once; hidden ones are left out. Raises ``InputError``."""
    found = (y for x in paths for y in (sorted(x.rglob("*")) if x.is_dir() else [x]))
    for file in dict.fromkeys(x for x in found if x.is_file() and not x.name.startswith(".")):
        refuse_name(file)
        yield file


def _page(
    named: Sequence[Path], specs: Sequence[Path], progress: Progress | None
) -> tuple[bytes, CheckReport]:
    """The page about the evidence, and what was found of it. Raises ``UsageError`` where there is none."""
    with tempfile.TemporaryDirectory() as folder:
        if not named:
            raise UsageError("name at least one folder of evidence")
        made = page(*named, out=Path(folder) / PAGE, specs=specs, progress=progress, title="Bundle")
        if made.checked is None:
            raise UsageError(f"{', '.join(map(str, named))}: no evidence to check; name folders of --out")
        return utf8(made.text), made.checked


def _packages(files: dict[str, bytes], wheel: str | Path | None, with_wheels: bool) -> list[packages.Pin]:
    """The pins of all packages; adds the wheel of roadproof to ``files``, and those of all where wanted."""
    with tempfile.TemporaryDirectory() as place:
        folder = Path(place)
        own = packages.own_wheel(folder) if wheel is None else Path(wheel)
        files[f"wheels/{own.name}"] = own.read_bytes()
        pinned = packages.pins_of(["cvc5"])
        if with_wheels:
            packages.download(pinned, folder)
            files |= {f"wheels/{x.name}": x.read_bytes() for x in folder.glob("*.whl")}
        return [packages.pin_of_wheel(own), *pinned]


def _command_of(path: Path) -> _Command | None:
    """The command that checks a file: an assurance case has a table of an element, requirements a [trace]."""
    if path.suffix != ".toml":
        return None
    try:
        content = read_toml(path)
    except InputError:
        return None  # such as a file for another program
    if "trace" in content:
        return "trace"
    tables = [x for x in content.values() if isinstance(x, dict)]
    return "assurance" if any(str(Kind.GOAL) in x or str(Kind.SOLUTION) in x for x in tables) else None


def _arguments(files: Mapping[str, bytes], specs: Sequence[Path], asked: Options) -> tuple[Argument, ...]:
    """Check cases and requirements where only the files of the bundle are. Raises ``InputError``."""
    commands = {name: found for name in sorted(files) if (found := _command_of(Path(name))) is not None}
    if not commands:
        return ()
    with tempfile.TemporaryDirectory() as place:
        folder = Path(place).resolve()
        for name, content in files.items():
            (folder / name).parent.mkdir(parents=True, exist_ok=True)
            (folder / name).write_bytes(content)
        inside = [folder / x for x in specs]
        return tuple(
            Argument(
                command=command, file=name, exit_code=int(_exit_code(command, folder, name, inside, asked))
            )
            for name, command in commands.items()
        )


def _exit_code(command: _Command, folder: Path, name: str, specs: Sequence[Path], asked: Options) -> ExitCode:
    """The exit code of the command that checks a case or requirements. Raises ``InputError``."""
    run = assurance if command == "assurance" else requirements
    try:
        return run(folder / name, specs=specs, jobs=asked.jobs).exit_code
    except InputError as error:
        told = str(error).replace(f"{folder}/", "")
        raise InputError(f"in the bundle {told}: name all files on which {name} rests") from None


def _script(
    evidence: Sequence[str],
    specs: Sequence[str],
    code: ExitCode,
    with_wheels: bool,
    arguments: Sequence[Argument],
) -> bytes:
    index = "--no-index " if with_wheels else ""
    values = {
        "python": _python(),
        "platform": sysconfig.get_platform(),
        "wheels": f"{index}--find-links wheels",
        "evidence": shlex.join(evidence),
        "specs": shlex.join(word for x in specs for word in ("--spec", x)),
        "code": str(int(code)),
        "arguments": "\n".join(shlex.join(["argue", x.command, x.file]) for x in arguments),
    }
    text = SCRIPT.read_text("utf-8")
    for name, value in values.items():
        text = text.replace(f"@{name}@", value)
    return text.encode()


def _manifest(
    evidence: Sequence[str],
    specs: Sequence[Path],
    checked: CheckReport,
    arguments: tuple[Argument, ...],
    pinned: Sequence[packages.Pin],
    files: Mapping[str, bytes],
) -> Manifest:
    return Manifest(
        roadproof=VERSION,
        library=checked.library.fingerprint,
        python=_python(),
        platform=sysconfig.get_platform(),
        evidence=tuple(evidence),
        specs=tuple(x.as_posix() for x in specs),
        accepted=sum(x.outcome.exit_code is ExitCode.AS_EXPECTED for x in checked.findings),
        claims=len(checked.findings),
        exit_code=int(checked.exit_code),
        arguments=arguments,
        packages=tuple(Package(**vars(x)) for x in pinned),
        files={name: _digest(x) for name, x in sorted(files.items())},
    )


def _python() -> str:
    return "{}.{}".format(*sys.version_info)


def _stem(path: Path) -> str:
    return path.name.removesuffix(".tar.gz")


def _digest(content: bytes) -> str:
    return hashlib.sha256(content).hexdigest()


def _packed(name: str, files: Mapping[str, bytes]) -> bytes:
    """An archive of files in a folder, the same for the same files."""
    packed = io.BytesIO()
    with (
        gzip.GzipFile(fileobj=packed, mode="wb", mtime=_TIME, filename="") as zipped,
        tarfile.open(fileobj=zipped, mode="w", format=tarfile.PAX_FORMAT) as archive,
    ):
        for path, content in sorted(files.items()):
            entry = tarfile.TarInfo(f"{name}/{path}")
            entry.size, entry.mtime = len(content), _TIME
            entry.mode = 0o755 if path == "check.sh" else 0o644
            archive.addfile(entry, io.BytesIO(content))
    return packed.getvalue()


def _signing_key(path: Path) -> "Ed25519PrivateKey":
    """An Ed25519 key of a PEM file without a password. Raises ``InputError``, ``MissingSolverError``."""
    try:
        from cryptography.hazmat.primitives.asymmetric.ed25519 import Ed25519PrivateKey
        from cryptography.hazmat.primitives.serialization import load_pem_private_key
    except ImportError:
        raise MissingSolverError("--sign needs cryptography: pip install cryptography") from None
    try:
        key = load_pem_private_key(path.read_bytes(), None)
    except (ValueError, TypeError) as error:
        raise InputError(f"{path}: {error}; make a key by openssl genpkey -algorithm ed25519") from None
    if not isinstance(key, Ed25519PrivateKey):
        raise InputError(f"{path} is no Ed25519 key; make one by openssl genpkey -algorithm ed25519")
    return key


def _sign(key: "Ed25519PrivateKey", target: Path, content: bytes) -> Path:
    signature = target.with_name(f"{target.name}.sig")
    with whole_file(signature) as file:
        file.write(key.sign(content))
    return signature

"""Packs bundles for auditors: evidence, definitions, pinned packages, an HTML page, and a script that checks
all of it.
"""

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
from roadproof.extensions.assurance.case.case import ElementKind
from roadproof.extensions.assurance.keywords import BundleKeywords
from roadproof.extensions.assurance.requirements.fingerprints import lock_path
from roadproof.extensions.assurance.settings import BundleSettings as Options
from roadproof.extensions.assurance.tracing import requirements
from roadproof.extensions.catalogue.catalogue_data import SCHEMA as CATALOGUE
from roadproof.extensions.pages.page.results import PageResult, PageSources
from roadproof.extensions.pages.reporting import page
from roadproof.frontends.api.checking import CheckReport
from roadproof.frontends.settings.option import takes
from roadproof.runtime.files import atomic_file, refuse_name, utf8
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
    """A bundle that was written to ``path``; ``checked``: the report on its evidence.

    ``exit_code``: the highest of ``roadproof check`` and of the cases and requirements inside.
    """

    path: Path
    manifest: Manifest
    checked: CheckReport
    signature: Path | None
    exit_code: ExitCode

    def as_data(self) -> JsonObject:
        """Return the manifest as plain data."""
        return write(self.manifest)

    def __str__(self) -> str:
        manifest = self.manifest
        size = f"{self.path.stat().st_size / 1e6:.1f} MB"
        counts = f"{len(manifest.files)} files, {size}, {manifest.accepted} of {manifest.claims} accepted"
        lines = [f"{self.path}: {counts}"]
        lines += [f"{x.command} {x.file}: exit code {x.exit_code}" for x in manifest.arguments]
        lines += [] if self.signature is None else [f"signature: {self.signature}"]
        return "\n".join([*lines, f"tar xzf {self.path.name}; sh {_stem(self.path)}/check.sh"])


@takes(Options)
def bundle(*results: str | Path, out: str | Path, **options: Unpack[BundleKeywords]) -> Bundle:
    """Write evidence and everything that its check needs into one archive; equal content gives equal bytes.

    ``results``: folders of evidence and other files such as requirements, all below the working directory;
    the archive keeps their paths. The tests of a catalogue are added with its answer. ``out``: NAME.tar.gz.
    ``specs``: specification files. ``wheel``: the wheel of this version, where pip cannot build it;
    ``wheels``: include the files of all packages, so the check needs no network. ``sign``: an Ed25519 key in
    PEM, which signs the archive into NAME.tar.gz.sig. Raises ``InputError``, ``UsageError``,
    ``MissingSolverError``.
    """
    settings = Options.of(options)
    target = Path(out)
    if not target.name.endswith(".tar.gz"):
        raise UsageError(f"out={target}: name a file that ends with .tar.gz")
    key = None if settings.sign is None else _signing_key(Path(settings.sign))
    named, specs = [_inside(Path(x)) for x in results], [_inside(Path(x)) for x in settings.specs]
    evidence = [x for x in named if x.is_dir() or x.suffix == ".json"]
    content, checked, sources = _evidence_page(evidence, specs, settings.progress)
    everything = dict.fromkeys([*named, *_tests_of(sources.results), *_locks_of(named), *specs])
    files = {path.as_posix(): path.read_bytes() for path in _files_below(everything)}
    files[PAGE] = content
    pinned = _pin_packages(files, settings.wheel, settings.wheels)
    files[REQUIREMENTS] = "".join(f"{x.line}\n" for x in pinned).encode()
    checkable = [x.as_posix() for x in sources.checkable]
    arguments = _arguments(files, specs, settings)
    script = _script(checkable, [x.as_posix() for x in specs], checked.exit_code, settings.wheels, arguments)
    files |= {"check.sh": script}
    manifest = _manifest(checkable, specs, checked, arguments, pinned, files)
    files[MANIFEST] = (json.dumps(write(manifest), indent=1) + "\n").encode()
    files[SUMS] = "".join(f"{_digest(x)}  {name}\n" for name, x in sorted(files.items())).encode()
    archive = _archive_of(_stem(target), files)
    with atomic_file(target) as file:
        file.write(archive)
    signature = None if key is None else _sign(key, target, archive)
    codes = [checked.exit_code, *(ExitCode(x.exit_code) for x in arguments)]
    return Bundle(target, manifest, checked, signature, max(codes))


def _inside(path: Path) -> Path:
    """Return a path relative to the working directory. Raises ``InputError`` for a missing path or one
    outside of it.
    """
    if not path.exists():
        raise InputError(f"{path} does not exist")
    absolute = path.resolve()
    if not absolute.is_relative_to(Path.cwd().resolve()):
        raise InputError(f"{path} is outside of {Path.cwd()}: make the bundle in a folder above all evidence")
    return absolute.relative_to(Path.cwd().resolve())


def _tests_of(results: Sequence[PageResult]) -> Iterator[Path]:
    """Yield the test files of catalogues, which the check judges again. Raises ``InputError``."""
    for result in results:
        request = result.data.get("request") if result.schema == CATALOGUE else None
        paths = request.get("paths") if isinstance(request, Mapping) else None
        yield from (_inside(Path(str(x))) for x in (paths if isinstance(paths, list) else ()))


def _locks_of(named: Sequence[Path]) -> Iterator[Path]:
    """Yield the lock files beside requirements; without them no link would be stale."""
    yield from (lock for x in named if _command_of(x) == "trace" and (lock := lock_path(x)).is_file())


def _files_below(paths: Iterable[Path]) -> Iterator[Path]:
    """Yield all files of folders and files, each once, without hidden ones. Raises ``InputError``."""
    every_file = (y for x in paths for y in (sorted(x.rglob("*")) if x.is_dir() else [x]))
    for file in dict.fromkeys(x for x in every_file if x.is_file() and not x.name.startswith(".")):
        refuse_name(file)
        yield file


def _evidence_page(
    named: Sequence[Path], specs: Sequence[Path], progress: Progress | None
) -> tuple[bytes, CheckReport, PageSources]:
    """Return the HTML page about the evidence, the report on it, and what it was made of.

    Raises ``UsageError`` for no evidence.
    """
    with tempfile.TemporaryDirectory() as folder:
        if not named:
            raise UsageError("name at least one folder of evidence")
        made = page(*named, out=Path(folder) / PAGE, specs=specs, progress=progress, title="Bundle")
        if made.checked is None:
            raise UsageError(f"{', '.join(map(str, named))}: no evidence to check; name folders of --out")
        return utf8(made.text), made.checked, made.sources


def _pin_packages(files: dict[str, bytes], wheel: str | Path | None, with_wheels: bool) -> list[packages.Pin]:
    """Return the pins of all packages; add the wheel of roadproof to ``files``, or all wheels if
    ``with_wheels``.
    """
    with tempfile.TemporaryDirectory() as place:
        folder = Path(place)
        own_wheel = packages.own_wheel(folder) if wheel is None else Path(wheel)
        files[f"wheels/{own_wheel.name}"] = own_wheel.read_bytes()
        pinned = packages.pins_of(["cvc5"])
        if with_wheels:
            packages.download(pinned, folder)
            files |= {f"wheels/{x.name}": x.read_bytes() for x in folder.glob("*.whl")}
        return [packages.pin_of_wheel(own_wheel), *pinned]


def _command_of(path: Path) -> _Command | None:
    """Return the command that checks a file, None for other files.

    A file with a table [trace] has requirements; one with a table of a goal or solution is an assurance case.
    """
    if path.suffix != ".toml":
        return None
    try:
        content = read_toml(path)
    except InputError:
        return None  # such as a file for another program
    if "trace" in content:
        return "trace"
    tables = [x for x in content.values() if isinstance(x, dict)]
    return (
        "assurance"
        if any(str(ElementKind.GOAL) in x or str(ElementKind.SOLUTION) in x for x in tables)
        else None
    )


def _arguments(files: Mapping[str, bytes], specs: Sequence[Path], settings: Options) -> tuple[Argument, ...]:
    """Check cases and requirements in a folder that has only the files of the bundle. Raises
    ``InputError``.
    """
    commands = {name: kind for name in sorted(files) if (kind := _command_of(Path(name))) is not None}
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
                command=command, file=name, exit_code=int(_exit_code(command, folder, name, inside, settings))
            )
            for name, command in commands.items()
        )


def _exit_code(
    command: _Command, folder: Path, name: str, specs: Sequence[Path], settings: Options
) -> ExitCode:
    """Return the exit code of the command that checks a case or requirements. Raises ``InputError``."""
    run = assurance if command == "assurance" else requirements
    try:
        return run(folder / name, specs=specs, jobs=settings.jobs).exit_code
    except InputError as error:
        message = str(error).replace(f"{folder}/", "")
        raise InputError(f"in the bundle {message}: name all files on which {name} rests") from None


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


def _archive_of(name: str, files: Mapping[str, bytes]) -> bytes:
    """Return a tar.gz archive of files in a folder ``name``; equal files give equal bytes."""
    buffer = io.BytesIO()
    with (
        gzip.GzipFile(fileobj=buffer, mode="wb", mtime=_TIME, filename="") as zipped,
        tarfile.open(fileobj=zipped, mode="w", format=tarfile.PAX_FORMAT) as archive,
    ):
        for path, content in sorted(files.items()):
            entry = tarfile.TarInfo(f"{name}/{path}")
            entry.size, entry.mtime = len(content), _TIME
            entry.mode = 0o755 if path == "check.sh" else 0o644
            archive.addfile(entry, io.BytesIO(content))
    return buffer.getvalue()


def _signing_key(path: Path) -> "Ed25519PrivateKey":
    """Return the Ed25519 key of a PEM file without a password. Raises ``InputError``,
    ``MissingSolverError``.
    """
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
    with atomic_file(signature) as file:
        file.write(key.sign(content))
    return signature

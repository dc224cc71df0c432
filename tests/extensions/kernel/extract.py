"""The checkers as Coq extracts them; ``make generated`` writes them into proofs/kernel/ocaml."""

import tempfile
from pathlib import Path

from roadproof.extensions.kernel import coq
from roadproof.runtime.package_data import shipped_folder

KERNEL = shipped_folder("proofs") / "kernel"
CHECKER = KERNEL / "ocaml" / "checker.ml"


def extracted() -> bytes:
    """Return the file that Coq writes for Extract.v."""
    with coq.ready() as found, tempfile.TemporaryDirectory(prefix="roadproof-extract-") as folder:
        source = Path(folder) / "Extract.v"
        source.write_bytes((KERNEL / source.name).read_bytes())
        ran = found.in_folder(source.name, source.parent)
        assert (ran.code, ran.errors) == (0, "")
        return (source.parent / "checker.ml").read_bytes()

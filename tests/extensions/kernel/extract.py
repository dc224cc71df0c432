"""The checkers as Coq extracts them.

``python -m extensions.kernel.extract`` writes proofs/kernel/ocaml/checker.ml.
"""

import tempfile
from pathlib import Path

from roadproof.extensions.kernel import coq
from roadproof.runtime.package_data import shipped

KERNEL = shipped("proofs") / "kernel"


def extracted() -> bytes:
    """What Coq writes for Extract.v."""
    with coq.ready() as found, tempfile.TemporaryDirectory(prefix="roadproof-extract-") as folder:
        source = Path(folder) / "Extract.v"
        source.write_bytes((KERNEL / source.name).read_bytes())
        ran = found.in_folder(source.name, source.parent)
        assert (ran.code, ran.complained) == (0, "")
        return (source.parent / "checker.ml").read_bytes()


if __name__ == "__main__":
    (KERNEL / "ocaml" / "checker.ml").write_bytes(extracted())

"""What these tests need that may not be installed."""

import shutil

import pytest

needs_coq = pytest.mark.skipif(
    shutil.which("coqc") is None, reason="coqc is not installed: apt-get install -y coq"
)
needs_ocaml = pytest.mark.skipif(
    shutil.which("ocamlopt") is None, reason="ocamlopt is not installed: apt-get install -y ocaml-nox"
)

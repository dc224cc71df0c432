"""Editors and mypy see the public functions of the core and of the extensions that come with it."""

import ast
import subprocess
import sys
from pathlib import Path

import roadproof as rp
from documents import stub
from roadproof.extension import installed_extensions

USER = """\
import roadproof as rp

reveal_type(rp.prove("true").verdict)
reveal_type(rp.coverage().verdict)
reveal_type(rp.VERDICT)
rp.prove("true", jbos=1)
"""


def test_the_stub_has_all_public_names() -> None:
    tree = ast.parse(stub.text())
    imported = {x.asname for node in tree.body if isinstance(node, ast.ImportFrom) for x in node.names}
    foreign = {y for x in installed_extensions().values() if x.is_foreign for y in x.record.functions}
    assert imported == {*rp.__all__} - {"__version__"} - foreign


def test_the_package_says_that_it_is_typed() -> None:
    package = Path(rp.__file__).parent
    assert (package / "py.typed").is_file()
    assert (package / "__init__.pyi").is_file()


def test_mypy_sees_functions_of_the_core_and_of_extensions(tmp_path: Path) -> None:
    user = tmp_path / "user.py"
    user.write_text(USER)
    command = [sys.executable, "-m", "mypy", "--strict", "--follow-imports", "silent", str(user)]
    told = subprocess.run(command, cwd=stub.FILE.parents[2], text=True, capture_output=True).stdout
    errors = [x.partition("user.py:")[2] for x in told.splitlines()]
    assert errors[0] == '3: note: Revealed type is "roadproof.verdict.Verdict"', told
    assert errors[1] == '4: note: Revealed type is "roadproof.verdict.Verdict"', told
    assert errors[2] == '5: error: Module has no attribute "VERDICT"  [attr-defined]', told
    assert any(x.startswith('6: error: Unexpected keyword argument "jbos" for "prove"') for x in errors), told

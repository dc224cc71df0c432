"""docs/explanation/trust.md: the code to trust is counted with all that it imports."""

import re
import subprocess
import sys
from pathlib import Path

from documents.trusted import ANSWER, PAGE, SOURCE, closure, counted, lines, modules, parts


def test_the_page_counts_the_code_to_trust_with_all_that_it_imports() -> None:
    page = PAGE.read_text("utf-8")
    assert [*parts(page)] == list("12345678")
    assert len(ANSWER.findall(page)) == 5
    assert counted(page) == page, "run: make generated"
    for number, files in parts(page).items():
        assert lines(closure(files)) > lines(files) or number == "4"
    named_only = re.sub(r"\| ([\d,]+) \| [\d,]+ \|$", r"| \1 | \1 |", page, flags=re.MULTILINE)
    assert named_only != page
    assert counted(named_only) != named_only


def test_python_imports_nothing_of_roadproof_that_is_not_counted() -> None:
    names = {path: name for name, path in modules().items()}
    for number, files in parts(PAGE.read_text("utf-8")).items():
        python = [names[x] for x in files if x.suffix == ".py"]
        loading = "".join(f"import {x}\n" for x in python)
        show = "import sys\nfor x in [*sys.modules]:\n    print(getattr(sys.modules[x], '__file__', None))\n"
        printed = subprocess.run(
            [sys.executable, "-c", loading + show], capture_output=True, text=True, check=True
        ).stdout
        loaded = {Path(x) for x in printed.splitlines() if x.startswith(f"{SOURCE}/")}
        assert len(loaded) >= len(python)
        assert loaded <= closure(files), number


def test_imports_in_functions_count_and_those_of_types_do_not(tmp_path: Path) -> None:
    late = tmp_path / "late.py"
    late.write_text("def f():\n    from roadproof.world import units\n", "utf-8")
    typed = tmp_path / "typed.py"
    typed.write_text("if TYPE_CHECKING:\n    from roadproof.world import units\n", "utf-8")
    assert SOURCE / "world" / "units.py" in closure([late])
    assert SOURCE / "world" / "__init__.py" in closure([late])
    assert closure([typed]) == {typed}

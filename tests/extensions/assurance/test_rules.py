"""Cases that are not well-formed are refused with the line and the rule; well-formed ones are read."""

from pathlib import Path

import pytest

from extensions.assurance.cases import GOOD
from roadproof.errors import InputError
from roadproof.extensions.assurance.case.case import ElementKind
from roadproof.extensions.assurance.case.reading import read_case
from tables import read_table

FAULTS = read_table(__file__, "faults")


def write(tmp_path: Path, text: str) -> Path:
    path = tmp_path / "case.toml"
    path.write_text(text, "utf-8")
    return path


def test_a_case_is_read(tmp_path: Path) -> None:
    case = read_case(write(tmp_path, GOOD))
    assert (case.title, case.top) == ("Trial", "G1")
    assert [x.kind for x in case.elements.values()] == [
        *(
            ElementKind.GOAL,
            ElementKind.CONTEXT,
            ElementKind.STRATEGY,
            ElementKind.GOAL,
            ElementKind.SOLUTION,
            ElementKind.GOAL,
        )
    ]
    assert case.elements["Sn1"].line == 18
    assert case.supported["G2"] == ("S1",)


@pytest.mark.parametrize("fault", FAULTS, ids=lambda x: x["name"])
def test_a_fault_is_refused_with_its_line(fault: dict[str, str], tmp_path: Path) -> None:
    """The change of the good case, the number of the line and the rule stand in the table."""
    assert GOOD.count(fault["old"]) == 1
    path = write(tmp_path, GOOD.replace(fault["old"], fault["new"]))
    with pytest.raises(InputError) as error:
        read_case(path)
    assert str(error.value).startswith(f"{path}, line {fault['line']}: ")
    assert fault["told"] in str(error.value)


def test_texts_over_several_lines_hide_no_fields(tmp_path: Path) -> None:
    text = GOOD.replace('"Is developed later"', '"""Is\n[G9]\ngoal = 7\nlater"""') + "colour = 1\n"
    with pytest.raises(InputError, match=r"line 29: there is no field 'colour'"):
        read_case(write(tmp_path, text))


@pytest.mark.parametrize(
    ("count", "deep", "told"), [(1001, False, "1001 elements"), (61, True, "more than 60")]
)
def test_cases_that_no_sheet_holds_are_refused(count: int, deep: bool, told: str, tmp_path: Path) -> None:
    goals = [f"[G{k}]\ngoal = 'x'\n" for k in range(count)]
    below = [[k + 1] if deep else [*range(1, count)] * (k == 0) for k in range(count)]
    below[-1] = []
    lists = [", ".join(f"'G{x}'" for x in some) for some in below]
    support = [f"supported-by = [{x}]\n" if x else "undeveloped = true\n" for x in lists]
    with pytest.raises(InputError, match=told):
        read_case(write(tmp_path, "".join(map("".join, zip(goals, support, strict=True)))))

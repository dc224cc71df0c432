"""docs/explanation/trust.md: the files that it names are there, and as long as it says, within a tenth."""

import re
from pathlib import Path

HOME = Path(__file__).parents[2]
ROW = re.compile(r"^\| \((\d)\) \| [^|]+ \| ([^|]+) \| (\d+) \|$", re.MULTILINE)


def test_what_has_to_be_believed_is_as_long_as_the_page_says():
    rows = ROW.findall((HOME / "docs" / "explanation" / "trust.md").read_text("utf-8"))
    assert [number for number, _, _ in rows] == list("1234567")
    for number, files, said in rows:
        lines = 0
        for name in re.findall(r"`([^`]+)`", files):
            found = list((HOME if name.startswith("proofs") else HOME / "src" / "roadproof").glob(name))
            assert found, name
            lines += sum(len(x.read_text("utf-8").splitlines()) for x in found)
        assert abs(lines - int(said)) <= int(said) / 10, (number, lines, said)

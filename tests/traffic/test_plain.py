"""CSV files with quoted cells or other line ends say the same as those without."""

from pathlib import Path

import pytest

import roadproof as rp
from roadproof.errors import InputError
from roadproof.recordings.formats.converted import same_recording
from roadproof.recordings.formats.highd import read_highd
from roadproof.recordings.formats.sources import find_source
from traffic.test_own_columns import table, written


def quoted(content: bytes) -> bytes:
    lines = content.decode().splitlines()
    return "".join(",".join(f'"{cell}"' for cell in line.split(",")) + "\n" for line in lines).encode()


def quoted_names(content: bytes) -> bytes:
    """Some rows only, as where texts alone are quoted."""
    header, _, rest = content.decode().partition("\n")
    lines = [line.split(",") for line in rest.splitlines()]
    return f"{header}\n".encode() + "".join(f'"{a}",{",".join(b)}\n' for a, *b in lines).encode()


CUSTOMS = {
    "CR": lambda x: x.replace(b"\n", b"\r"),
    "CRLF": lambda x: x.replace(b"\n", b"\r\n"),
    "quoted": quoted,
    "quoted, CR": lambda x: quoted(x).replace(b"\n", b"\r"),
    "quoted, CRLF": lambda x: quoted(x).replace(b"\n", b"\r\n"),
    "some quoted": quoted_names,
    "mark of UTF-8": lambda x: b"\xef\xbb\xbf" + quoted(x),
}


@pytest.mark.parametrize("custom", CUSTOMS)
def test_samples_say_the_same(custom: str, tmp_path: Path) -> None:
    path = written(tmp_path, table(), "csv")
    before = find_source(path.parent).read()
    path.write_bytes(CUSTOMS[custom](path.read_bytes()))
    assert same_recording(find_source(path.parent).read(), before)


@pytest.fixture(scope="module")
def made(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return rp.simulate(tmp_path_factory.mktemp("made"), seconds=20, seed=2, jobs=1).folder


@pytest.mark.parametrize("custom", CUSTOMS)
def test_highd_files_say_the_same(custom: str, made: Path, tmp_path: Path) -> None:
    for path in made.iterdir():
        (tmp_path / path.name).write_bytes(CUSTOMS[custom](path.read_bytes()))
    assert same_recording(read_highd(tmp_path, "01"), read_highd(made, "01"))


@pytest.mark.parametrize("cell", ['"a,b"', '"a""b"', '"a', '"a"b'])
def test_other_quotes_are_refused_by_row(cell: str, tmp_path: Path) -> None:
    path = written(tmp_path, table(), "csv")
    lines = path.read_text().splitlines()
    first, _, rest = lines[3].split(",", 2)
    lines[3] = f"{first},{cell},{rest}"
    path.write_text("\n".join(lines) + "\n")
    with pytest.raises(InputError, match=r"row 4: a (comma or a quote within|quote does not end)"):
        find_source(path.parent).read()


def test_a_quoted_file_that_was_cut_off_is_refused(tmp_path: Path) -> None:
    path = written(tmp_path, table(), "csv")
    path.write_bytes(quoted(path.read_bytes())[:-1])
    with pytest.raises(InputError, match="the file was cut off"):
        find_source(path.parent).read()

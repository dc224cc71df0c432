"""Requirements in ReqIF, StrictDoc and Doorstop: each is read, and what cannot be read is refused."""

import json
import os
import random
import re
import shutil
import subprocess
import sys
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import pytest

import roadproof as rp
from roadproof.errors import InputError
from roadproof.extensions.assurance.answers.trace import RequirementPlace
from roadproof.extensions.assurance.requirements.requirement import Link, Requirement
from roadproof.extensions.assurance.requirements.sources import read_requirements

ROOT = Path(__file__).parents[4]
NOWHERE = RequirementPlace(file="")
TOML = """\
[trace]
evidence = ["brake.json"]

[[requirement]]
id = "ALL"
title = "A < B & \\"C\\""
text = "All of it."
edition = "ISO 34502:2022"
clause = "B.2 & C"

[[requirement]]
id = "BRAKE/1 ä"
parent = "ALL"
text = \"\"\"
A vehicle ahead brakes:
if a < b & c > d,

so be it.\"\"\"
scenarios = [4, "F danger(SV,POV) and v_lon(SV) < 30 m/s"]
claims = ["P4 scenario 3 base"]
tests = ["T; 1"]
"""
SDOC = """\
[DOCUMENT]
TITLE: Highway
UID: DOC

[GRAMMAR]
ELEMENTS:
- TAG: REQUIREMENT
  FIELDS:
  - TITLE: UID
    TYPE: String
    REQUIRED: True

[[SECTION]]
TITLE: Distance

[TEXT]
STATEMENT: >>>
[REQUIREMENT]
this is prose
<<<

[FREETEXT]
[REQUIREMENT]
UID: >>>
[/FREETEXT]

[REQUIREMENT]
UID: LEAD-1
TITLE: Distance
STATEMENT: >>>
The vehicle keeps its distance:

UID: no field
<<<
CLAIMS: >>>
P4 scenario 3 base
danger(SV,POV) -> danger(SV,POV)
<<<
SCENARIOS: 4; 5
RELATIONS:
- TYPE: Parent
  VALUE: TOP-1
- TYPE: File
  VALUE: src/a.c

[[/SECTION]]

[SYSTEM_NEED]
UID: TOP-1
STATEMENT: It is safe.
RELATIONS:
- TYPE: Parent
  VALUE: ELSEWHERE-1
  ROLE: Refines

[REQUIREMENT]
STATEMENT: Nobody can name me.
"""
ITEM = """\
active: true
derived: false
header: |
  Distance
level: 1.10
links:
- TOP001: avwblqPimDJ2OgTrRCXxRPN8FQhUBWqPIXm7kSR95C4=
normative: true
ref: ''
references:
- path: a/b.c
  type: file
reviewed: null
claims:
- P4 scenario 3 base
- 'at minDanger = 0.6 s: danger(SV,POV) -> danger(SV,POV)'
scenarios: 4
tests: []
text: |
  The vehicle keeps its distance:

    whatever comes.  # no comment
"""


def bare(found: Sequence[Requirement]) -> list[Requirement]:
    """Requirements without their places, and without identifiers of ReqIF."""
    return [replace(x, place=NOWHERE, identifier="") for x in found]


def test_strictdoc(tmp_path: Path) -> None:
    path = tmp_path / "highway.sdoc"
    path.write_text(SDOC, "utf-8")
    found = read_requirements(path)
    assert bare(found.requirements) == [
        Requirement(
            "LEAD-1",
            "The vehicle keeps its distance:\n\nUID: no field",
            NOWHERE,
            "Distance",
            ("TOP-1",),
            (
                Link("claim", "P4 scenario 3 base"),
                Link("claim", "danger(SV,POV) -> danger(SV,POV)"),
                Link("scenario", "4"),
                Link("scenario", "5"),
            ),
        ),
        Requirement("TOP-1", "It is safe.", NOWHERE),
    ]
    assert [x.place.line for x in found.requirements] == [27, 48]
    assert [x.rpartition(": ")[2] for x in found.notes] == [
        "the requirement has no UID and is left out",
        "TOP-1 is derived from ELSEWHERE-1, which is not here",
    ]


@pytest.mark.parametrize(
    ("old", "new", "told"),
    [
        ("STATEMENT: It is safe.", "STATEMENT: >>>\nIt is safe.", "the field STATEMENT has no end"),
        ("STATEMENT: It is safe.", "STATEMENT: It is\nsafe.", "line 51: 'safe.' is no field of a node"),
        ("UID: TOP-1", "UID: LEAD-1", "two requirements are called 'LEAD-1'"),
    ],
)
def test_strictdoc_that_is_not_understood_is_refused(tmp_path: Path, old: str, new: str, told: str) -> None:
    assert old in SDOC
    (tmp_path / "bad.sdoc").write_text(SDOC.replace(old, new), "utf-8")
    with pytest.raises(InputError, match=told):
        read_requirements(tmp_path / "bad.sdoc")


@pytest.fixture
def doorstop(tmp_path: Path) -> Path:
    home = tmp_path / "reqs"
    (home / "low").mkdir(parents=True)
    (home / ".doorstop.yml").write_text("settings:\n  digits: 3\n  prefix: TOP\n  sep: ''\n", "utf-8")
    (home / "low" / ".doorstop.yml").write_text("settings:\n  parent: TOP\n  prefix: LOW\n", "utf-8")
    (home / "TOP001.yml").write_text("active: true\ntext: >\n  It is\n  safe.\n\n  Always.\n", "utf-8")
    (home / "TOP002.yml").write_text("active: false\ntext: gone\n", "utf-8")
    (home / "TOP003.yml").write_text("active: true\nnormative: false\ntext: A heading\n", "utf-8")
    (home / "low" / "LOW001.yml").write_text(ITEM, "utf-8")
    return home


def test_doorstop(doorstop: Path) -> None:
    found = read_requirements(doorstop)
    assert bare(found.requirements) == [
        Requirement("TOP001", "It is safe.\nAlways.", NOWHERE),
        Requirement(
            "LOW001",
            "The vehicle keeps its distance:\n\n  whatever comes.  # no comment",
            NOWHERE,
            "Distance",
            ("TOP001",),
            (
                Link("claim", "P4 scenario 3 base"),
                Link("claim", "at minDanger = 0.6 s: danger(SV,POV) -> danger(SV,POV)"),
                Link("scenario", "4"),
            ),
        ),
    ]
    assert len(found.notes) == 2


@pytest.mark.parametrize(
    ("line", "told"),
    [
        ("claims: *a", "line 1: it is no YAML: a repeated part (*name) and a tag (!name) are not read"),
        ("claims: !!python/object:os.system x", "a tag (!name) are not read"),
        ("claims: 'open", "found unexpected end of stream"),
        ('claims: "open', "found unexpected end of stream"),
        ("- a", "line 1: write keys with texts"),
        ("a: b\na: c", "line 2: it is no YAML: the key 'a' is given twice"),
        ("a: " + "[" * 20_000, "its parts lie too deep in each other"),
        ("a: \x07", "it is no YAML: unacceptable character #x0007: special characters are not allowed in"),
    ],
)
def test_yaml_that_doorstop_does_not_write_is_refused(doorstop: Path, line: str, told: str) -> None:
    (doorstop / "TOP001.yml").write_text(f"{line}\n", "utf-8")
    with pytest.raises(InputError, match=re.escape(told)):
        read_requirements(doorstop)


@pytest.mark.parametrize("word", ["false", "False", "FALSE", "no", "No", "NO", "off", "Off", "OFF"])
def test_an_item_is_off_with_every_word_of_yaml_for_it(doorstop: Path, word: str) -> None:
    (doorstop / "TOP001.yml").write_text(f"active: {word}\ntext: gone\n", "utf-8")
    assert "TOP001" not in [x.id for x in read_requirements(doorstop).requirements]


def test_every_key_of_an_object_in_a_list_is_a_link(doorstop: Path) -> None:
    (doorstop / "TOP001.yml").write_text("text: safe\nlinks:\n- A: x\n  B: y\n- {C: z, D: z}\n- E\n", "utf-8")
    told = "\n".join(read_requirements(doorstop).notes)
    assert all(f"TOP001 is derived from {name}, which is not here" in told for name in "ABCDE")


def test_a_file_of_many_keys_is_read(doorstop: Path) -> None:
    (doorstop / "TOP001.yml").write_text(
        "text: safe\n" + "".join(f"k{i}: x\n" for i in range(60_000)), "utf-8"
    )
    assert "TOP001" in [x.id for x in read_requirements(doorstop).requirements]


def test_a_folder_that_is_none_of_doorstop_is_refused(tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"there is no \.doorstop\.yml"):
        read_requirements(tmp_path)


@pytest.mark.parametrize(
    ("name", "content"),
    [
        ("R-1.yml", "text: Yes.\nedition: '2nd'\nclause: 4.3\nother: 1\n"),
        ("top.sdoc", "[REQUIREMENT]\nUID: R-1\nSTATEMENT: Yes.\nEDITION: 2nd\nCLAUSE: 4.3\n"),
        ("r.toml", '[[requirement]]\nid = "R-1"\ntext = "Yes."\nedition = "2nd"\nclause = "4.3"\n'),
    ],
)
def test_edition_and_clause_are_read_and_empty_where_unknown(tmp_path: Path, name: str, content: str) -> None:
    home = tmp_path / "reqs"
    home.mkdir()
    (home / ".doorstop.yml").write_text("settings:\n  digits: 3\n  prefix: R\n  sep: '-'\n", "utf-8")
    path = home if name.endswith(".yml") else home / name
    (home / name).write_text(content, "utf-8")
    [found] = read_requirements(path).requirements
    assert (found.id, found.edition, found.clause) == ("R-1", "2nd", "4.3")
    kept = [x for x in content.splitlines() if not x.lower().startswith(("edition", "clause"))]
    (home / name).write_text("\n".join(kept) + "\n", "utf-8")
    [found] = read_requirements(path).requirements
    assert (found.edition, found.clause) == ("", "")


def test_links_are_added_to_requirements_of_other_files(doorstop: Path) -> None:
    (doorstop.parent / "top.sdoc").write_text("[REQUIREMENT]\nUID: S-1\nSTATEMENT: Yes.\n", "utf-8")
    path = doorstop.parent / "links.toml"
    path.write_text(
        '[trace]\nsource = ["reqs", "top.sdoc"]\n[[requirement]]\nid = "S-1"\nscenarios = [4]\n', "utf-8"
    )
    found = read_requirements(path)
    assert [x.id for x in found.requirements] == ["TOP001", "LOW001", "S-1"]
    assert found.requirements[2].links == (Link("scenario", "4"),)
    source = '[trace]\nsource = "top.sdoc"\n[[requirement]]\nid = "S-1"\nclause = '
    path.write_text(source + '"4.3"\n', "utf-8")
    assert read_requirements(path).requirements[0].clause == "4.3"
    (doorstop.parent / "top.sdoc").write_text(
        "[REQUIREMENT]\nUID: S-1\nSTATEMENT: Yes.\nCLAUSE: 5\n", "utf-8"
    )
    with pytest.raises(InputError, match=r"clause='4\.3', but the source of S-1 says '5'"):
        read_requirements(path)
    path.write_text('[trace]\nsource = "reqs"\n[[requirement]]\nid = "S-2"\nscenarios = [4]\n', "utf-8")
    with pytest.raises(InputError, match="there is no requirement 'S-2'"):
        read_requirements(path)
    path.write_text('[trace]\nsource = "reqs"\n[[requirement]]\nid = "TOP001"\ntext = "x"\n', "utf-8")
    with pytest.raises(InputError, match="the text of TOP001 is in its source"):
        read_requirements(path)


# --- ReqIF ---------------------------------------------------------------------------------------


@pytest.fixture
def exported(tmp_path: Path) -> Path:
    """The requirements of TOML as ReqIF."""
    shutil.copy(ROOT / "examples" / "traffic" / "drives" / "scenario-04-base.json", tmp_path / "brake.json")
    (tmp_path / "requirements.toml").write_text(TOML, "utf-8")
    found = rp.requirements(tmp_path / "requirements.toml", jobs=1)
    return found.save_reqif(tmp_path / "out.reqif")


def test_reqif_comes_back_as_it_was(exported: Path) -> None:
    was = read_requirements(exported.parent / "requirements.toml")
    found = read_requirements(exported)
    expected = [replace(x, links=tuple(y for z in x.links for y in parts(z))) for x in bare(was.requirements)]
    assert bare(found.requirements) == expected
    lines = exported.read_text("utf-8").splitlines()
    assert all("<SPEC-OBJECT " in lines[x.place.line - 1] for x in found.requirements)
    assert 'THE-VALUE="witnessed"' not in "\n".join(lines)  # one of its links is missing
    assert 'THE-VALUE="missing"' in "\n".join(lines)


def parts(link: Link) -> list[Link]:
    """A semicolon divides links in other formats."""
    return [Link(link.kind, x.strip()) for x in link.target.split(";")]


def test_reqif_is_the_same_each_time(exported: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("SOURCE_DATE_EPOCH", "1700000000")
    found = rp.requirements(exported.parent / "requirements.toml", jobs=1)
    first = found.save_reqif(exported.parent / "a.reqif").read_bytes()
    os.utime(exported.parent / "requirements.toml", (1, 1))
    assert found.save_reqif(exported.parent / "b.reqif").read_bytes() == first
    assert b"2023-11-14T22:13:20+00:00" in first


FOREIGN = """\
<?xml version="1.0" encoding="UTF-8"?>
<REQ-IF xmlns="http://www.omg.org/spec/ReqIF/20110401/reqif.xsd" xmlns:h="http://www.w3.org/1999/xhtml">
<CORE-CONTENT><REQ-IF-CONTENT>
<DATATYPES><DATATYPE-DEFINITION-ENUMERATION IDENTIFIER="e"><SPECIFIED-VALUES>
<ENUM-VALUE IDENTIFIER="e1" LONG-NAME="CUT-1"/><ENUM-VALUE IDENTIFIER="e2" LONG-NAME="CUT-2"/>
</SPECIFIED-VALUES></DATATYPE-DEFINITION-ENUMERATION></DATATYPES>
<SPEC-TYPES><SPEC-OBJECT-TYPE IDENTIFIER="t"><SPEC-ATTRIBUTES>
<ATTRIBUTE-DEFINITION-XHTML IDENTIFIER="a-text" LONG-NAME="ReqIF.Text"/>
<ATTRIBUTE-DEFINITION-INTEGER IDENTIFIER="a-id" LONG-NAME="ReqIF.ForeignID"/>
<ATTRIBUTE-DEFINITION-STRING IDENTIFIER="a-scenarios" LONG-NAME="Scenarios"/>
<ATTRIBUTE-DEFINITION-ENUMERATION IDENTIFIER="a-tests" LONG-NAME="Tests"/>
</SPEC-ATTRIBUTES></SPEC-OBJECT-TYPE>
<SPEC-RELATION-TYPE IDENTIFIER="r" LONG-NAME="Satisfies"/><SPEC-RELATION-TYPE IDENTIFIER="s" LONG-NAME="See"/>
</SPEC-TYPES>
<SPEC-OBJECTS>
<SPEC-OBJECT IDENTIFIER="h" LONG-NAME="A chapter"><VALUES/></SPEC-OBJECT>
<SPEC-OBJECT IDENTIFIER="o1" LONG-NAME="One"><VALUES>
<ATTRIBUTE-VALUE-INTEGER THE-VALUE="17"><DEFINITION><ATTRIBUTE-DEFINITION-INTEGER-REF>a-id
</ATTRIBUTE-DEFINITION-INTEGER-REF></DEFINITION></ATTRIBUTE-VALUE-INTEGER>
<ATTRIBUTE-VALUE-XHTML><DEFINITION><ATTRIBUTE-DEFINITION-XHTML-REF>a-text</ATTRIBUTE-DEFINITION-XHTML-REF>
</DEFINITION><THE-VALUE><h:div><h:p>The <h:b>vehicle</h:b>
brakes.</h:p><h:ul><h:li>At once.</h:li></h:ul></h:div></THE-VALUE></ATTRIBUTE-VALUE-XHTML>
</VALUES></SPEC-OBJECT>
<SPEC-OBJECT IDENTIFIER="o2" DESC="Two things."><VALUES>
<ATTRIBUTE-VALUE-STRING THE-VALUE="4;5"><DEFINITION>
<ATTRIBUTE-DEFINITION-STRING-REF>a-scenarios</ATTRIBUTE-DEFINITION-STRING-REF></DEFINITION>
</ATTRIBUTE-VALUE-STRING>
<ATTRIBUTE-VALUE-ENUMERATION><DEFINITION>
<ATTRIBUTE-DEFINITION-ENUMERATION-REF>a-tests</ATTRIBUTE-DEFINITION-ENUMERATION-REF></DEFINITION>
<VALUES><ENUM-VALUE-REF>e1</ENUM-VALUE-REF><ENUM-VALUE-REF>e2</ENUM-VALUE-REF></VALUES>
</ATTRIBUTE-VALUE-ENUMERATION>
</VALUES></SPEC-OBJECT>
<SPEC-OBJECT IDENTIFIER="o3" DESC="Three."><VALUES/></SPEC-OBJECT>
</SPEC-OBJECTS>
<SPEC-RELATIONS>
<SPEC-RELATION IDENTIFIER="r1"><TYPE><SPEC-RELATION-TYPE-REF>r</SPEC-RELATION-TYPE-REF></TYPE>
<SOURCE><SPEC-OBJECT-REF>o3</SPEC-OBJECT-REF></SOURCE><TARGET><SPEC-OBJECT-REF>o1</SPEC-OBJECT-REF></TARGET>
</SPEC-RELATION>
<SPEC-RELATION IDENTIFIER="r2"><TYPE><SPEC-RELATION-TYPE-REF>s</SPEC-RELATION-TYPE-REF></TYPE>
<SOURCE><SPEC-OBJECT-REF>o1</SPEC-OBJECT-REF></SOURCE><TARGET><SPEC-OBJECT-REF>o3</SPEC-OBJECT-REF></TARGET>
</SPEC-RELATION>
</SPEC-RELATIONS>
<SPECIFICATIONS><SPECIFICATION IDENTIFIER="d"><CHILDREN>
<SPEC-HIERARCHY IDENTIFIER="p1"><OBJECT><SPEC-OBJECT-REF>o1</SPEC-OBJECT-REF></OBJECT><CHILDREN>
<SPEC-HIERARCHY IDENTIFIER="p2"><OBJECT><SPEC-OBJECT-REF>o2</SPEC-OBJECT-REF></OBJECT></SPEC-HIERARCHY>
</CHILDREN></SPEC-HIERARCHY>
</CHILDREN></SPECIFICATION></SPECIFICATIONS>
</REQ-IF-CONTENT></CORE-CONTENT></REQ-IF>
"""


def test_reqif_of_other_tools(tmp_path: Path) -> None:
    path = tmp_path / "other.reqif"
    path.write_text(FOREIGN, "utf-8")
    found = read_requirements(path)
    links = (Link("scenario", "4"), Link("scenario", "5"), Link("test", "CUT-1"), Link("test", "CUT-2"))
    assert bare(found.requirements) == [
        Requirement("17", "The vehicle brakes.\nAt once.", NOWHERE, "One"),
        Requirement("o2", "Two things.", NOWHERE, parents=("17",), links=links),
        Requirement("o3", "Three.", NOWHERE, parents=("17",)),
    ]
    assert [x.identifier for x in found.requirements] == ["o1", "o2", "o3"]
    again = read_requirements(rp.requirements(path, jobs=1).save_reqif(tmp_path / "again.reqif"))
    assert [replace(x, place=NOWHERE) for x in again.requirements] == [
        replace(x, place=NOWHERE) for x in found.requirements
    ]
    assert found.notes == (f"{path}: 1 objects have no text, such as headings, and are left out",)


@pytest.mark.parametrize(
    ("content", "told"),
    [
        ('<!DOCTYPE REQ-IF [<!ENTITY a "aaaa">]><REQ-IF>&a;</REQ-IF>', "document type"),
        ('<!DOCTYPE REQ-IF SYSTEM "http://localhost/x.dtd"><REQ-IF/>', "document type"),
        ("<REQ-IF>&a;</REQ-IF>", "no well-formed XML"),
        ("<REQ-IF/>", "there is no CORE-CONTENT/REQ-IF-CONTENT"),
        ("<REQ-IF><CORE-CONTENT><REQ-IF-CONTENT/></CORE-CONTENT></REQ-IF>", "there is no requirement"),
        ("<a>" * 200 + "</a>" * 200, "inside 100 others"),
        ("<other/>", "the root is other"),
        ("PK\x03\x04", "ZIP|no well-formed XML|archive"),
    ],
)
def test_hostile_and_foreign_xml_is_refused(tmp_path: Path, content: str, told: str) -> None:
    (tmp_path / "bad.reqif").write_text(content, "utf-8")
    with pytest.raises(InputError, match=told):
        read_requirements(tmp_path / "bad.reqif")


READER = """
import json, sys
from reqif.parser import ReqIFParser
bundle = ReqIFParser.parse(sys.argv[1])
assert not bundle.exceptions, bundle.exceptions
content = bundle.core_content.req_if_content
kinds = [getattr(x, "attribute_definitions", None) or () for x in content.spec_types]
names = {x.identifier: x.long_name for kind in kinds for x in kind}
objects = [{names[a.definition_ref]: a.value for a in x.attributes} for x in content.spec_objects]
print(json.dumps({"objects": objects, "relations": [[x.source, x.target] for x in content.spec_relations],
    "ids": [x.identifier for x in content.spec_objects],
    "order": [x.spec_object for x in content.specifications[0].children]}))
"""


def test_another_library_reads_the_reqif(exported: Path) -> None:
    """``ROADPROOF_REQIF_PYTHON``: an interpreter that has the package reqif."""
    python = os.environ.get("ROADPROOF_REQIF_PYTHON", sys.executable)
    there = subprocess.run([python, "-c", "import reqif"], capture_output=True, check=False)
    if there.returncode:
        pytest.skip("the package reqif is not installed: name an interpreter in ROADPROOF_REQIF_PYTHON")
    done = subprocess.run([python, "-c", READER, str(exported)], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    found = json.loads(done.stdout)
    first, second = found["objects"]
    assert first["ReqIF.Name"] == 'A < B & "C"'
    assert second["ReqIF.ForeignID"] == "BRAKE/1 ä"
    assert "if a &lt; b &amp; c &gt; d," in second["ReqIF.Text"]
    assert found["relations"] == [[found["ids"][1], found["ids"][0]]]
    assert found["order"] == found["ids"]
    command = [python, "-m", "reqif.cli.main", "validate", "--use-reqif-schema", str(exported)]
    checked = subprocess.run(command, capture_output=True, text=True, check=False)
    assert "0 errors, 0 schema issues found, 0 semantic issues" in checked.stdout, checked.stdout


@pytest.mark.parametrize("name", ["a.sdoc", "a.reqif", "TOP001.yml", "a.toml"])
def test_damaged_files_are_read_or_refused(doorstop: Path, name: str) -> None:
    """A file with a piece cut out, doubled or replaced never ends in another error than ``InputError``."""
    text = {"a.sdoc": SDOC, "a.reqif": FOREIGN, "TOP001.yml": ITEM, "a.toml": TOML}[name]
    path, dice, refused = doorstop / name, random.Random(7), 0
    for _ in range(200):
        begin = dice.randrange(len(text))
        end = min(len(text), begin + dice.randrange(1, 40))
        piece = dice.choice(
            ["", text[begin:end] * 2, "\x00", ">>>", "<<<", "'", "- ", "[", "]]", "ä\n", "&a;"]
        )
        path.write_text(text[:begin] + piece + text[end:], "utf-8")
        try:
            read_requirements(doorstop if name.endswith(".yml") else path)
        except InputError:
            refused += 1
    assert refused

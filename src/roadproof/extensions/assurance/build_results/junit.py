"""Writes test cases as JUnit XML, valid by the schema of Jenkins' xUnit plugin (junit-10.xsd)."""

from collections.abc import Iterable, Sequence
from itertools import groupby
from xml.etree import ElementTree as xml

from roadproof.frontends.report.cases import Case, State
from roadproof.verdict import ExitCode

_ELEMENTS: dict[State, str] = {"failed": "failure", "undecided": "error", "skipped": "skipped"}
_FORBIDDEN = {code: "\N{REPLACEMENT CHARACTER}" for code in range(32) if chr(code) not in "\t\n\r"}
"""Control characters that XML cannot hold, with their replacement."""


def as_junit(title: str, cases: Sequence[Case], in_force: Sequence[str] = ()) -> str:
    """Return JUnit XML with one suite for each kind of case.

    A case that did not pass is a failure, an undecided one an error; one that the user lets roadproof skip is
    ``skipped``. ``in_force``: the settings that differ from their defaults, each a property of every suite.
    """
    suites = xml.Element("testsuites", {"name": title} | _counts(cases))
    order = list(dict.fromkeys(x.suite for x in cases))
    for name, suite_cases in groupby(sorted(cases, key=lambda x: order.index(x.suite)), lambda x: x.suite):
        _add_suite(suites, name, list(suite_cases), in_force)
    return as_text(suites)


def junit(command: str, cases: Sequence[Case], code: ExitCode, in_force: Sequence[str]) -> str:
    """Return the cases of a command as JUnit XML."""
    return as_junit(f"roadproof {command}", cases, in_force)


def as_text(suites: xml.Element) -> str:
    """Return the document as text with its XML declaration."""
    xml.indent(suites)
    return '<?xml version="1.0" encoding="UTF-8"?>\n' + xml.tostring(suites, "unicode") + "\n"


def _counts(cases: Iterable[Case]) -> dict[str, str]:
    states = [x.state for x in cases]
    return {
        "tests": str(len(states)),
        "failures": str(states.count("failed")),
        "errors": str(states.count("undecided")),
    }


def _add_suite(suites: xml.Element, name: str, cases: Sequence[Case], in_force: Sequence[str]) -> None:
    suite = xml.SubElement(suites, "testsuite", {"name": name} | _counts(cases))
    if in_force:
        properties = xml.SubElement(suite, "properties")
        for setting in in_force:
            xml.SubElement(properties, "property", name="asked with", value=setting)
    for case in cases:
        _add_case(suite, case)


def _add_case(suite: xml.Element, case: Case) -> None:
    element = xml.SubElement(suite, "testcase", classname=_plain(case.suite), name=_plain(case.name))
    if case.seconds is not None:
        element.set("time", f"{case.seconds:.3f}")
    lines = [] if case.place is None else [str(case.place)]
    lines += [] if case.evidence is None else [f"[[ATTACHMENT|{case.evidence.as_posix()}]]"]
    if case.state != "passed":
        attributes = {"message": _plain(case.message)} | ({"type": str(case.rule)} if case.rule else {})
        xml.SubElement(element, _ELEMENTS[case.state], attributes).text = _plain("\n".join(lines)) or None
    elif lines:
        xml.SubElement(element, "system-out").text = _plain("\n".join(lines))


def _plain(text: str) -> str:
    return text.translate(_FORBIDDEN)

"""Reports of ASAM's quality checkers (.xqar): their exit code is 0 whatever they find."""

import xml.etree.ElementTree as ElementTree
from pathlib import Path

LATER = "is not valid according to definition setting"
"""Told of rules of a later version of the format, which are skipped."""


def issues_in(path: Path) -> list[str]:
    """Every issue, and every checker that was not completed for another reason than its version."""
    found = []
    checkers = list(ElementTree.parse(path).getroot().iter("Checker"))
    if len(checkers) < 10:
        found.append(f"only {len(checkers)} checkers are in the report")
    for checker in checkers:
        name, status = checker.get("checkerId"), checker.get("status")
        found += [f"{name}: {issue.get('description')}" for issue in checker.iter("Issue")]
        if status != "completed" and LATER not in (checker.get("summary") or ""):
            found.append(f"{name}: {status}")
    return found

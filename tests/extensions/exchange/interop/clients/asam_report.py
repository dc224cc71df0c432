"""Reports of ASAM's quality checkers (.xqar): their exit code is 0 whatever they find."""

import json
import logging
import sys
import xml.etree.ElementTree as ElementTree
from pathlib import Path
from typing import Any

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


def answer(constants: Any, run_checks: Any) -> None:
    """The issues of each file of a JSON list, by name, as JSON; both files are named on the command line.

    A checker's own report is written as its command line writes it, and read again.
    """
    from qc_baselib import Configuration, Result

    logging.disable(logging.INFO)
    asked, told = map(Path, sys.argv[1:])
    issues = {}
    for path in json.loads(asked.read_text("utf-8")):
        config, result = Configuration(), Result()
        config.set_config_param("InputFile", path)
        result.register_checker_bundle(name=constants.BUNDLE_NAME, description="", version="", summary="")
        result.set_result_version(version=constants.BUNDLE_VERSION)
        run_checks(config, result)
        result.copy_param_from_config(config)
        report = told.with_suffix(".xqar")
        result.write_to_file(str(report), generate_summary=True)
        issues[path] = issues_in(report)
    told.write_text(json.dumps(issues), "utf-8")

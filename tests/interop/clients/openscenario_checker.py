"""asam-qc-openscenarioxml on files: the issues in its reports. Run in its own environment."""

import json
import logging
import sys
from pathlib import Path

from qc_baselib import Configuration, Result
from qc_openscenario import constants
from qc_openscenario.main import run_checks

sys.path.append(str(Path(__file__).parent))
from asam_report import issues_in

logging.disable(logging.INFO)


def check(path: str, report: Path) -> list[str]:
    """Its own report is written as its command line writes it, and read again."""
    config, result = Configuration(), Result()
    config.set_config_param("InputFile", path)
    result.register_checker_bundle(name=constants.BUNDLE_NAME, description="", version="", summary="")
    result.set_result_version(version=constants.BUNDLE_VERSION)
    run_checks(config, result)
    result.copy_param_from_config(config)
    result.write_to_file(str(report), generate_summary=True)
    return issues_in(report)


if __name__ == "__main__":
    asked, answer = map(Path, sys.argv[1:])
    files = json.loads(asked.read_text("utf-8"))
    answer.write_text(json.dumps({x: check(x, answer.with_suffix(".xqar")) for x in files}), "utf-8")

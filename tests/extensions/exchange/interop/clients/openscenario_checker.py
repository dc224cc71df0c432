"""asam-qc-openscenarioxml on files: the issues in its reports. Run in its own environment."""

import sys
from pathlib import Path

from qc_openscenario import constants
from qc_openscenario.main import run_checks

sys.path.append(str(Path(__file__).parent))
from asam_report import answer

if __name__ == "__main__":
    answer(constants, run_checks)

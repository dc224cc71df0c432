"""Formulas on drives with accelerations: the judge against a reading in floats, and against the monitor.

The monitor is asked about comparisons at samples of the drive, where it has to say what the judge says.
"""

from collections import Counter
from fractions import Fraction

import numpy as np
from hypothesis import strategies as st

from fuzz.case import Disagreement
from judge.cases import comparisons, drives, formulas
from judge.pinning import disagreement_on_drive
from roadproof.logic import formula as f
from roadproof.logic.formula import Formula
from roadproof.semantics.exact import judge
from roadproof.semantics.sampled import Batch, compile
from roadproof.world.drive import Drive
from roadproof.world.motion import state_at

DT, SAMPLES = Fraction(1, 4), 13
NEAR = 1e-9  # margins below it are not told apart by floats
SIGNALS = ("s", "d", "v_lon", "v_lat", "a_lon", "a_lat")

cases = st.tuples(formulas(comparisons, leaves=5, past=False), drives)
notes: Counter[str] = Counter()


def check(case: tuple[Formula, Drive]) -> int:
    """1, or 0 where floats cannot tell."""
    formula, drive = case
    found = disagreement_on_drive(formula, drive)
    if found == "doubtful":
        notes["left out: too near for floats"] += 1
        return 0
    if found is not None:
        raise Disagreement(f"the judge differs from the definition at {found[1]}", case)
    atoms = {x for x in f.subformulas(formula) if isinstance(x, f.Compare)}
    measured = compile({str(i): atom for i, atom in enumerate(atoms)}).measure(sampled(drive), at="all")
    for i, atom in enumerate(atoms):
        truth = judge(atom, drive).truth(atom)
        for k in range(SAMPLES):
            margin = measured.margins[str(i)].low[k, 0]
            if abs(margin) > NEAR and (margin > 0) != truth.at(k * DT):
                raise Disagreement(f"margin {margin} at {k * DT} s, where the judge says otherwise", case)
    return 1


def sampled(drive: Drive) -> Batch:
    states = {x: [state_at(motion, k * DT) for k in range(SAMPLES)] for x, motion in drive.vehicles.items()}
    signals = {
        (name, x): np.array([[float(getattr(state, name))] for state in course])
        for x, course in states.items()
        for name in SIGNALS
    }
    sizes = {
        (name, x): np.array([float(getattr(motion, name))])
        for x, motion in drive.vehicles.items()
        for name in ("length", "width")
    }
    return Batch(DT, np.array([SAMPLES]), signals, sizes)

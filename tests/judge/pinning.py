"""Does the judge agree with the second reading? The checks that mutants are held against."""

from fractions import Fraction

from judge.reference import FloatDrive, Reference, critical_times, distinct
from roadproof.logic import formula as f
from roadproof.semantics.exact import judging
from roadproof.semantics.exact.algebraic import bounds


def disagreement_on_sets(formula, given):
    """A sub-formula and instant on which the judge is not what the definition says, or None. Exact."""
    critical = sorted(critical_times(formula, lambda atom: [c.point for c in given[atom].cuts]))
    reference = Reference(lambda atom, time: given[atom].at(time), critical)
    judgement = judging.judge(formula, None, given)
    for part in f.subformulas(formula):
        truth = judgement.truth(part)
        for region in reference.regions:
            time = reference.sample(region)
            if truth.at(time) != reference.holds(part, region):
                return part, time
        if not {c.point for c in truth.cuts} <= set(critical):
            return part, truth
    return None


def disagreement_on_drive(formula, drive, epsilon=1e-6):
    """As above on a drive, in floats; ``"doubtful"`` where floats cannot tell.

    Times within ``epsilon`` seconds are one to the reference.
    """
    floats = FloatDrive(drive, epsilon)
    critical, doubtful = distinct(map(float, critical_times(formula, floats.switches)), epsilon)
    reference = Reference(floats.truth, critical, epsilon)
    expected = {p: [reference.holds(p, r) for r in reference.regions] for p in f.subformulas(formula)}
    if doubtful or floats.doubtful:
        return "doubtful"
    judgement = judging.judge(formula, drive)
    points = {cut.point for truth in judgement.truths.values() for cut in truth.cuts}
    for part, truths in expected.items():
        truth = judgement.truth(part)
        for region in reference.regions[1::2]:
            if truth.at(Fraction(reference.sample(region))) != truths[region]:
                return part, reference.sample(region)
        for point in points:
            region = reference.locate(float(bounds(point, Fraction(1, 10**12))[0]))
            if region % 2 == 1 or truth.at(point) != truths[region]:
                return part, point
    return None

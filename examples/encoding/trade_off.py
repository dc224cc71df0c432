"""A trade-off that no option asks for: from how far must POV brake how hard, so that danger arises?

Scenario 4 is encoded once, with SV at a steady 25 m/s behind a POV at 24 m/s. For each gap at the start,
cvxpy finds the drive with the gentlest braking of POV; the judge confirms each. The curve is drawn as SVG.
"""

import sys
from pathlib import Path

import cvxpy as cp

import roadproof as rp

SPEED = 25  # m/s
GAPS = (60, 63, 66, 69, 72, 75)  # m


def trade_off(gaps: tuple[int, ...]) -> list[tuple[int, float]]:
    """Return the gentlest hardest braking of POV (m/s^2) for each gap at the start (m), in scenario 4."""
    encoding = rp.encode(4, lanes={"L": "main-1"})
    gap = encoding.variable("POV", "s") - encoding.variable("SV", "s") - 4.5  # length of POV
    start, braking = cp.Parameter(), cp.Variable(nonneg=True)
    rules = [
        *encoding.problem().constraints,
        gap[0] == start,
        encoding.variable("SV", "v_lon") == SPEED,
        encoding.variable("POV", "v_lon")[0] == SPEED - 1,
        encoding.variable("POV", "a_lon") >= -braking,
    ]
    problem = cp.Problem(cp.Minimize(braking), rules)
    curve = []
    for start.value in gaps:
        problem.solve(solver="HIGHS", mip_rel_gap=0.01, time_limit=60)
        if problem.status != cp.OPTIMAL:
            break
        encoding.drive()  # judged; raises where it is no drive of scenario 4
        curve.append((int(start.value), float(braking.value)))
    return curve


def draw(curve: list[tuple[int, float]], path: Path) -> None:
    """Draw the curve as SVG."""
    import matplotlib

    matplotlib.use("svg")
    from matplotlib import pyplot

    figure, axes = pyplot.subplots(figsize=(5.5, 3.4), layout="constrained")
    axes.plot(*zip(*curve, strict=True), marker="o", color="#3f51b5")
    axes.set(xlabel="gap at the start in m", ylabel="hardest braking of POV in m/s²", ylim=(0, 1.4))
    axes.set_title("Scenario 4: the gentlest braking that is dangerous", fontsize=11)
    axes.grid(alpha=0.3)
    figure.savefig(path, metadata={"Date": None})


if __name__ == "__main__":
    curve = trade_off(GAPS)
    for gap, braking in curve:
        print(f"{gap:2} m: {braking:.2f} m/s^2")
    draw(curve, Path(sys.argv[1] if len(sys.argv) > 1 else "trade-off.svg"))

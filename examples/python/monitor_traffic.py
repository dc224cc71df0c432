"""Traffic: simulated, evaluated, looked at pair by pair; and samples of one's own, as arrays and frames."""

import numpy as np
import polars

import roadproof as rp
from roadproof import POV, SV, F

# A minute of motorway in highD's format (your own recordings do as well), and where danger arises in it.
made = rp.simulate("traffic", seconds=60, flow=3000, seed=7, jobs=1)
found = rp.evaluate(made.folder, among="1-8", using=rp.load("base", "ext"), min_danger=[0.6], jobs=1)
for row in found.to_frame().rows(named=True):
    print(f"{row['set']:<5} {row['matching']} of {row['traces']} dangerous traces match a scenario")
matches = found.matches()
print(matches.group_by("scenario").len().sort("scenario").write_csv())

# One of them again, closely.
one = matches.filter(scenario=4, set="base").row(0, named=True)
pair = f"traffic/{one['recording']}_tracks.csv:{one['SV']},{one['POV']}"
seen = rp.monitor(4, pair, frames=(one["first_frame"], one["last_frame"]))
print(f"scenario 4 for vehicles {one['SV']} and {one['POV']}: {seen.verdict}")
print(seen.to_frame().filter(part="danger(SV, POV)").select("verdict", "begin", "end").write_csv())

# Samples of one's own: SV is 44 m behind POV and brakes from 30 to 18 m/s.
time = np.arange(0, 6.01, 0.1)
still, ones = np.zeros_like(time), np.ones_like(time)
speed = np.maximum(30 - 3 * time, 18)
ahead = {"s": 50 + 20 * time, "v_lon": 20 * ones, "a_lon": still}
behind = {"s": 2 + np.cumsum(speed) * 0.1, "v_lon": speed, "a_lon": np.where(speed > 18, -3.0, 0.0)}
both = {"d": 3 * ones, "v_lat": still, "a_lat": still, "length": 4 * ones, "width": 2 * ones}
frame = polars.concat(
    polars.DataFrame({"time": time, "vehicle": [name] * len(time), **signals, **both})
    for name, signals in (("SV", behind), ("POV", ahead))
)
gap = POV.s - POV.length - SV.s
for what in (gap > "10 m", F(gap < "20 m"), F(gap < "20 m", within=(0, "4 s"))):
    answer = rp.monitor(what, frame)
    low, high = answer.robustness
    print(f"{answer.verdict:<9} {what}  (by {low:.2f} to {high:.2f})")

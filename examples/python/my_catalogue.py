"""A catalogue of one's own on top of the library: what holds together, what implies what, and drives."""

import roadproof as rp

CATALOGUE = """
param headway = 1 s where headway > 0 "what is too close to the vehicle ahead"

def tooClose(a, b: vehicle) "a is behind b by less than headway"
  := s(a) <= s(b) - length(b) and s(b) - length(b) - s(a) < headway*v_lon(a)
def inOneLane(a, b: vehicle, L: lane) := laneKeep(a, L) and laneKeep(b, L)

def scenario_101(SV, POV: vehicle, L: lane) "SV tailgates POV"
  := initSafe(SV, POV) and inOneLane(SV, POV, L) and tooClose(SV, POV)
def scenario_102(SV, POV: vehicle, L: lane) "SV tailgates POV, and is faster"
  := scenario_101(SV, POV, L) and fasterThan(POV, SV)
def scenario_103(SV, POV: vehicle, L: lane) "POV tailgates SV"
  := initSafe(SV, POV) and inOneLane(SV, POV, L) and tooClose(POV, SV)
"""

mine = rp.load(specs=[CATALOGUE])
print(mine, "knows", mine.tooClose.__doc__)

# Which hold together on one drive?
overlap = rp.overlap("101-103", mine, jobs=1)
print(overlap.to_frame().select("a", "b", "verdict").write_csv())

# Which implies which?
order = rp.order("101-103", mine, jobs=1)
for implication, verdict in order.verdicts.items():
    print(f"{verdict:<8} {implication}")

# A drive for each where two seconds are too close already.
careful = rp.load(specs=[CATALOGUE], params={"headway": "2 s"})
found = rp.witness(101, 102, 103, using=careful, jobs=1)
print(found.to_frame().select("scenario", "verdict", "road", "drives").write_csv())
found.save("drives", pictures=False)
print("all that was shown is accepted:", all(x.check().accepted for x in (overlap, order, found)))

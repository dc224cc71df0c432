"""A claim of one's own: proved, or refuted by a drive that is saved, checked and looked at."""

import roadproof as rp
from roadproof import POV, SV, F, G, L

iso = rp.load()  # the definitions of the paper, spec set base
faster = SV.v_lon - POV.v_lon
following = iso.scenario_4(SV, POV, L)  # POV ahead of SV is slower, until there is danger

# Three claims about all drives, on all roads, for all values of parameters within their bounds.
claims = [
    following >> (faster > 0),
    following >> F(iso.danger(SV, POV)),
    following >> G(faster < "10 km/h", within=(0, "2 s")),
]
answers = rp.prove(*claims, using=iso, jobs=1)
for claim, verdict in zip(claims, answers.verdicts.values(), strict=True):
    print(f"{verdict:<8} {claim}")

# What is said is shown: certificates and a drive, which another program can check.
print("evidence:", ", ".join(type(x).__name__ for x in answers.evidence))
answers.save("evidence")
checked = rp.check("evidence", jobs=1)
print("accepted again:", checked.accepted)

# The drive against the last claim: when is SV that much faster?
drive = answers.evidence[-1]
monitored = rp.monitor(F(faster >= "10 km/h", within=(0, "2 s")), drive)
print(monitored.observed.formula)
print(f"on the drive: {monitored.verdict}, by {monitored.robustness[0]:.2f} m/s")

# A drive can also be asked for: what is wanted is written as a claim is.
wanted = rp.witness(following & (SV.v_lon > "100 km/h") & (faster < "10 km/h"), using=iso, jobs=1)
print(wanted.verdict, "for", wanted.drives[0].file.formula)
wanted.plot().save("drive.svg")

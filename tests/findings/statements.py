"""Which command makes which figure of which page. `{}` stands where a figure is, on the page and in the output."""

from findings import readings as r
from findings.checking import Sessions
from findings.figures import Figures, Picture, Statement
from findings.results import ROOT

FINDINGS, PERFORMANCE = "docs/explanation/findings.md", "docs/data/performance/analyses.csv"
CLASSES_OF_SETS, GAPS_OF_SETS = "docs/data/findings/classes.csv", "docs/data/findings/gaps.csv"
EXTREMES = "docs/data/findings/values.csv"

SESSIONS = (
    Sessions("README.md"),
    Sessions("docs/reference/language.md"),
    Sessions("docs/how-to/highd.md"),
    *(
        Sessions(
            f"examples/{name}/README.md",
            tuple(p for p in sorted((ROOT / "examples" / name).iterdir()) if p.name != "README.md"),
        )
        for name in ("motion", "time-to-collision", "traffic")
    ),
)

OVERLAP = "roadproof overlap --out overlap"
CLASSES = "roadproof classify --out classes"
REDUNDANCY = "roadproof redundancy --out redundant"
ORDER = "roadproof order --out order"
CUT_IN = (
    "roadproof witness 1 --out drives --no-pictures",
    "roadproof export drives/scenario-01-base.json --to animation --out drives",
)
RECORDINGS = "roadproof simulate --out recordings --seconds 120 --lanes 3 --seed 3"
COVERAGE = {
    "base": "roadproof coverage --set base --on recordings",
    "extA": "roadproof coverage --set extA --on recordings",
    "ext": "roadproof coverage --set ext --on recordings --out gaps",
    "complete": "roadproof coverage --set complete --on recordings",
}

PLATES = {
    name: f"roadproof preventable {name} --no-lemmas --out {name}"
    for name in ("cut-in", "deceleration", "cut-out")
}
ALL_MODELS = (
    "roadproof preventable cut-in --model careful,r157,eu1426,rss,fsm --at Ve0=60km/h,90km/h,130km/h "
    "--at Vy=1 --lines 50 --no-lemmas --out all-models"
)

PICTURES = (
    Picture("docs/pictures/cut-in.svg", CUT_IN, lambda _: "drives/scenario-01-base-moving.svg"),
    Picture("docs/pictures/overlap-base.png", (OVERLAP,), lambda _: "overlap/overlap.png"),
    Picture("docs/pictures/classes-base.png", (CLASSES,), lambda _: "classes/classes.png"),
    Picture("docs/pictures/gap-ext.png", (RECORDINGS, COVERAGE["ext"]), r.picture_of_a_gap_beside_the_lane),
    Picture("docs/pictures/preventable-cut-in.png", (PLATES["cut-in"],), lambda _: "cut-in/plates.png"),
    Picture(
        "docs/pictures/preventable-deceleration.png",
        (PLATES["deceleration"],),
        lambda _: "deceleration/plates.png",
    ),
    Picture("docs/pictures/preventable-all-models.png", (ALL_MODELS,), lambda _: "all-models/plates.png"),
    Picture("docs/pictures/preventable-cut-out.png", (PLATES["cut-out"],), lambda _: "cut-out/plates.png"),
)

HOLD_TOGETHER = (
    Statement(
        FINDINGS,
        (OVERLAP,),
        (
            Figures("All {} pairs of `base`", "{} pairs in "),
            Figures(
                "of the main road exactly {} are compatible; the other {} are proved impossible",
                r.pairs_of_a_sector,
            ),
        ),
    ),
    Statement(
        FINDINGS,
        ("roadproof overlap --among 1-8",),
        (Figures("Scenario 2 is compatible with {}**, no other disturbance", r.partners_of_2),),
    ),
    Statement(
        FINDINGS,
        ("roadproof overlap --among 4,12,20",),
        (Figures("is in two sectors: {} have drives", "3 WITNESSED: {}\n"),),
        quick=True,
    ),
    Statement(
        FINDINGS,
        ("roadproof overlap --lanes any",),
        (
            Figures(
                "With a lane for each, {} pairs of disturbances still exclude each other**: {}. One has POV in front, "
                "the other behind. These are {} of the {} pairs; the other {} have drives",
                r.disturbances_apart,
            ),
        ),
    ),
    Statement(
        FINDINGS,
        ("roadproof overlap --lanes any --roles any",),
        (
            Figures("no pair excludes another**: all {} pairs have drives", "{} WITNESSED\n"),
            Figures("all {} pairs have drives", "{} pairs in "),
        ),
    ),
    Statement(
        FINDINGS,
        ("roadproof overlap --among 1,4",),
        (Figures("Scenario 1 and scenario 4 exclude each other", "1 IMPOSSIBLE: 1-4"),),
        quick=True,
    ),
    Statement(
        FINDINGS,
        ("roadproof overlap --among 1,4 --start any",),
        (Figures("and can follow one another", "1 WITNESSED: 1-4"),),
        quick=True,
    ),
    Statement(
        FINDINGS,
        ("roadproof overlap --among 1,4 --json -",),
        (Figures("Few clashes cause the exclusions**, printed as cores", '"not sameLane(POV, SV, L)",'),),
        quick=True,
    ),
)

CLASSIFIED = (
    Statement(
        FINDINGS,
        (CLASSES,),
        (
            Figures("fall into {} classes**", r.all_witnessed),
            Figures("each of the {} has a judged drive", r.all_witnessed),
            Figures("{} kinds of behaviour of SV and POV, and scenario 2", lambda x: r.happenings(x)[0]),
            Figures("between three vehicles, each in {} choices of road sectors", r.kinds_of_places),
            Figures(
                "jointly equivalent to the scenarios ({} claims)",
                lambda x: len(r.read(x, "classes/index.json")["claims"]),
            ),
            Figures("The behaviour is one of {}**: {} alone, {}.\n", r.happenings),
            Figures("recording of {} s with {} traces", "recording of {} s, seed 1: {} traces,"),
            Figures(
                "In `base` classes 3 and 4 have {} % each, 1 has {} %, 7 has {} %, 6 has {} %; the other {} have "
                "{} % or less, and {} do not occur there",
                r.shares_of_base,
            ),
        ),
    ),
    *(
        Statement(
            FINDINGS,
            (f"roadproof classify --set {name}",),
            (Figures("The behaviour is one of {}**: {} alone, {}.\n", r.happenings),),
        )
        for name in ("extA", "ext")
    ),
    *(
        Statement(
            FINDINGS,
            (command,),
            (Figures(f"`{name}`,{{}},{{}},{{}}", r.classes_of_set),),
            data=CLASSES_OF_SETS,
        )
        for name, command in (
            ("base", CLASSES),
            *((name, f"roadproof classify --set {name}") for name in ("extA", "ext", "complete")),
        )
    ),
    Statement(
        FINDINGS,
        ("roadproof classify --set complete",),
        (
            Figures("`complete` has {}**", r.all_witnessed),
            Figures("**, {} kinds of behaviour of two vehicles", lambda x: r.happenings(x)[0]),
            Figures("{} choices do not occur: if 6", "do not occur: {} PROVED"),
        ),
    ),
    Statement(
        FINDINGS,
        ("roadproof prove 'scenario_4(SV,POV,L) and scenario_6(SV,POV,L) -> scenario_8(SV,POV,L)'",),
        (Figures("4 and 6 hold together only with 8", "PROVED scenario_4"),),
        quick=True,
    ),
    Statement(
        FINDINGS,
        ("roadproof classify --among 1-8 --out classes",),
        (Figures("**{} pairwise compatible choice does not occur", "do not occur: {} PROVED"),),
    ),
    Statement(
        FINDINGS,
        ("roadproof classify --set ext --among 1-8 --on ../shared/data/us101",),
        (
            Figures(
                "On US-101 the same holds**: {} situations", "{} situations with a scenario, each in exactly"
            ),
            Figures("Of those of two vehicles {} % are in class 1", lambda x: r.shares(x)["1"]),
            Figures(
                "in class 1, {} in a class of several scenarios",
                lambda x: sum(share > 0 for name, share in r.shares(x).items() if "_" in name),
            ),
        ),
    ),
)

LEFT_OUT = (
    Statement(
        FINDINGS,
        ("roadproof redundancy --among 3",),
        (
            Figures(
                "The whole condition on lanes may be dropped",
                "redundant: sameLane(SV, POV, L) or inAdjLanes(SV, POV, L) in initialCondition_3(SV,POV,L) as true",
            ),
            Figures(
                "The disjunct `inAdjLanes` of scenarios 3 and 4 is redundant",
                "redundant: some M in adjacentLanes(L): atLane(POV, M) in inAdjLanes(SV,POV,L) as false",
            ),
        ),
    ),
    Statement(
        FINDINGS,
        ("roadproof redundancy --among 1,5,6,8",),
        (
            Figures(
                "the condition `sameLane` at the start of scenario 8",
                "scenario 8: redundant: atLane(SV, L) and atLane(POV, L) in sameLane(SV,POV,L) as true",
            ),
        ),
    ),
    Statement(
        FINDINGS,
        ("roadproof redundancy --among 2",),
        (
            Figures(
                "All conditions of scenario 2 on SV's lane are redundant for motion",
                "scenario 2: redundant for motion: laneKeep(SV, L) U not sameLane(SV, POV1, L) in",
            ),
        ),
    ),
    Statement(
        FINDINGS,
        (REDUNDANCY,),
        (
            Figures(
                "decided**: of {} changes to the 24 scenarios {} are proved redundant and {} more for motion. A judged "
                "drive refutes {}, and a judged trace over points in time refutes {};",
                "{} changes: {} redundant, {} more for motion, {} told apart by a drive, {} by a trace, 0 in doubt",
            ),
            Figures("refutes 3; {} is in doubt", "by a trace, {} in doubt"),
        ),
    ),
    Statement(
        FINDINGS,
        (REDUNDANCY, "roadproof check redundant"),
        (Figures("accepts all {} answers", r.accepted),),
    ),
    Statement(
        FINDINGS,
        ("roadproof redundancy --among 7",),
        (Figures("Every part of scenario 7 is needed", "changes: 0 redundant, 0 more for motion"),),
    ),
    Statement(
        FINDINGS,
        ("roadproof redundancy --set ext",),
        (
            Figures(
                "In `ext`, {} of {} changes is in doubt, {} are refuted by a trace only",
                r.doubts_and_traces,
            ),
        ),
    ),
)

NO_SINGLE = "in every scenario two or more are false {}"

MISSED = (
    *(
        Statement(
            FINDINGS,
            (RECORDINGS, COVERAGE[name]),
            (Figures(f"`{name}`,{{}},{{}},{{}},{{}}", r.gaps_of_set),),
            data=GAPS_OF_SETS,
        )
        for name in ("base", "extA", "ext")
    ),
    *(
        Statement(
            FINDINGS,
            (RECORDINGS, COVERAGE[name]),
            (
                Figures(
                    "In `base` and `extA` there is {} exception: two vehicles with fronts level",
                    r.gaps_of_no_condition,
                ),
                Figures("and {} disturbances in 120 s", "of {} disturbances in traffic"),
            ),
        )
        for name in ("base", "extA")
    ),
    Statement(
        FINDINGS,
        (RECORDINGS, COVERAGE["ext"]),
        (
            Figures("one condition of one scenario is missing", NO_SINGLE.format("IMPOSSIBLE")),
            Figures(
                "In {} of the nine** simulated disturbances that `ext` misses, scenario 1 would hold",
                r.beside_the_lane_in_traffic,
            ),
        ),
    ),
    Statement(
        FINDINGS,
        (RECORDINGS, COVERAGE["complete"]),
        (Figures("`complete`,,,,{}", "disturbances in traffic {} are missed"),),
        data=GAPS_OF_SETS,
    ),
    Statement(
        FINDINGS,
        (RECORDINGS, COVERAGE["complete"]),
        (Figures("Complete coverage is possible", "set complete misses no danger that arises from safety"),),
    ),
    Statement(
        FINDINGS,
        ("roadproof coverage --set complete --needed",),
        (
            Figures("None of the {} can be left out", lambda x: x.printed.count(": needed, by a drive on ")),
            Figures(
                "extends `ext` by {} replaced definitions",
                lambda x: x.printed.count(": needed, by a drive on "),
            ),
        ),
    ),
    Statement(FINDINGS, ("roadproof show cutIn --set complete",), quick=True),
)

IMPLIED = (
    Statement(
        FINDINGS,
        (ORDER,),
        (
            Figures("Of {} scenarios, {} formulas are different", "{} scenarios, {} formulas:"),
            Figures(
                "between the {} formulas {} edges are proved",
                "scenarios, {} formulas: {} edges proved",
            ),
            Figures(
                "belong the {} implications that follow by a chain",
                lambda x: (
                    len(r.read(x, "order/index.json")["proved"]) - len(r.read(x, "order/index.json")["edges"])
                ),
            ),
            Figures(
                "other {} are refuted by {} drives, and {} are in doubt",
                "{} implications refuted by {} drives, {} in doubt",
            ),
            Figures("edges are proved, {} in each road sector", r.edges_of_a_sector),
            Figures(
                "Scenarios {} are identical in `base` and `extA`, and scenario {} in all three", r.one_formula
            ),
        ),
    ),
    Statement(
        FINDINGS,
        (
            "roadproof witness 'scenario_4@ext(SV,POV,L) and not scenario_4@extA(SV,POV,L)' --road main-2 "
            "--effort 400",
        ),
        (Figures("its drive takes more work", "WITNESSED road main-2"),),
    ),
    Statement(
        FINDINGS,
        ("roadproof witness 'scenario_5(SV,POV,L) and not scenario_1(SV,POV,L)'",),
        (Figures("Scenario 5 does not imply scenario 1", "WITNESSED road"),),
    ),
)

VALUES = (
    Statement(
        EXTREMES,
        ("roadproof explore --all --vary minDanger=0:60",),
        (
            Figures(
                "in all {} scenarios of `base`: each has a drive at every one of {} values of `minDanger` up to 60 s, "
                "and {} drives serve all of them",
                r.drives_that_serve,
            ),
        ),
    ),
    Statement(
        EXTREMES,
        ("roadproof explore 1 3 4 5 6 7 8 --vary minSafe=0:6",),
        (
            Figures("scenario 4 has drives up to `minSafe` = {} s", lambda x: r.boundaries(x)[4]),
            Figures(
                "Drives of the others: {} s (1), {} s (3), {} s (5), {} s (6), {} s (7) and {} s (8)",
                lambda x: tuple(r.boundaries(x)[k] for k in (1, 3, 5, 6, 7, 8)),
            ),
        ),
    ),
    Statement(
        EXTREMES,
        ("roadproof explore 4 --vary minSafe=0:6 --horizon 12 --steps 6",),
        (
            Figures(
                "scenario 4 has drives at all {} values up to 6 s",
                "judged at this value, at {} of 6 values\n",
            ),
        ),
    ),
    *(
        Statement(
            EXTREMES,
            (f"roadproof explore {a} {b} --least '{measure}'",),
            (
                Figures(said, lambda x, a=a, b=b: (r.measures(x)[a, "least"], r.measures(x)[b, "least"])),
                Figures(f"proved that it is never 0 for {a} and {b}", "at 0 m/s IMPOSSIBLE"),
            ),
        )
        for a, b, measure, said in (
            (3, 7, "v_lon(POV) - v_lon(SV)", "drives with {} m/s for 3, {} m/s for 7"),
            (4, 8, "v_lon(SV) - v_lon(POV)", "{} m/s for 4 and {} m/s for 8 were judged"),
        )
    ),
    Statement(
        EXTREMES,
        ("roadproof explore 1 6 --least 'v_lon(SV) - v_lon(POV)' --greatest 'v_lon(SV) - v_lon(POV)'",),
        (Figures("SV starts from {} m/s slower to {} m/s faster", r.range_of_both),),
    ),
    Statement(
        EXTREMES,
        ("roadproof explore 4 --vary POV.a_lon.min=-6:0",),
        (Figures("drives remain if POV never decelerates", "at 11 of 11 values"),),
        quick=True,
    ),
    Statement(
        EXTREMES,
        ("roadproof explore 3 --vary vehicle.a_lon.max=0:3",),
        (Figures("No vehicle must accelerate for scenario 3", "at 11 of 11 values"),),
    ),
    Statement(
        EXTREMES,
        ("roadproof explore 4 --least 's(POV) - s(SV) - length(POV)'",),
        (
            Figures(
                "the least gap is {} m", "least s(POV) - s(SV) - length(POV) at the start: {} m on a judged"
            ),
            Figures("and less is proved impossible", "m IMPOSSIBLE [1]"),
        ),
    ),
    Statement(
        EXTREMES,
        (
            "roadproof explore 4 --greatest 's(POV) - s(SV)' --when 'danger(SV,POV)' --reach 200 --precision 2",
        ),
        (
            Figures('danger in scenario 4 last?,"up to {} m,', "when danger(SV,POV): {} m on a judged drive"),
            Figures("judged drive; at {} m no drive exists within 6 s", "{} m NONE-WITHIN ["),
        ),
    ),
    Statement(
        EXTREMES,
        ("roadproof explore 4 --vary rho=0:3",),
        (Figures("no known one above {} s", "greatest rho with a drive: {} s; at"),),
    ),
    Statement(
        EXTREMES,
        ("roadproof explore 4 --vary rho=0:3 --reach 200",),
        (
            Figures(
                "Within 200 m?,there are drives at all {} values up to 3 s",
                "judged at this value, at {} of 11 values\n",
            ),
        ),
    ),
)

LIMITS = (
    Statement(
        EXTREMES,
        ("roadproof witness 'scenario_1(SV,POV,L) and F scenario_3(SV,POV,L)' --horizon 9 --effort 400",),
        (Figures("1 and then 3 is a drive of {} s", "horizon {} s"),),
    ),
    *(Statement(EXTREMES, (f"roadproof overlap --among {pair} --start any",)) for pair in ("3,4", "2,3")),
)

EVALUATE = "roadproof evaluate ../shared/data/us101 --out out/us101 --no-pictures"
US101 = "docs/explanation/us101.md"

TABLES = tuple(
    Figures(
        "".join(f"{where},{x},{name},{{}}\n" for x in ("0", "0.6") for name in ("base", "extA", "ext")),
        lambda x, ending=ending: r.us101_rows(x, ending),
    )
    for where, ending in (
        ("main road", ""),
        ("merge zone", "-merge-zone"),
        ("departure zone", "-departure-zone"),
    )
)

LISTED = "roadproof evaluate ../shared/data/us101 --list"
MEASURED = (
    Statement(US101, (EVALUATE,), TABLES, data="docs/data/us101.csv"),
    Statement(US101, (LISTED,), (Figures("That is so in {} of the eight windows", r.windows_with_ramps),)),
    Statement(
        US101,
        (EVALUATE,),
        (
            Figures("Scenarios {} match in {} windows", r.sectors_of_matches),
            Figures("{} of {} matches are uncertain", r.uncertain_matches),
            Figures("{} pairs violate the RSS distance", lambda x: r.us101_counts(x)["violating"]),
            Figures("of these, {} (minDanger 0) and {} (0.6) do so", r.disturbances),
            Figures("from 0 to 0.6 s, {} of {} disturbances vanish", r.vanishing),
            Figures(
                "s3 and s4 differ in base** for {} pairs with minDanger 0, and for {} of these with 0.6",
                lambda x: (r.roles_differ(x, "0"), r.roles_differ(x, "3/5")),
            ),
            Figures("base ⊆ extA ⊆ ext for every pair", "every match a disturbance: no violation"),
            Figures(
                "(pairs): cut-in {} by TTC < 4 s, {} by THW < 2 s, {} without a metric; deceleration {}, {} and {}.",
                lambda x: tuple(r.us101_counts(x)["detectors"].values()),
            ),
            Figures(
                "Of {} answers {} depend on the continuation",
                lambda x: (r.us101_counts(x)["asked"], r.us101_counts(x)["undecided"]),
            ),
            Figures(
                "{} of them would be a match under `--end clip`", "{} would be another match under the other"
            ),
            Figures("One sample of {} has the centre", "vehicles (Car evaluated), {} samples"),
            Figures("{} sample of 14", r.samples_on_no_lane),
            Figures(
                "they are off by {} to {} % on average; at most by {} % on a vehicle's whole way (obstacle 610 of "
                "USA_US101-10_4_T-1) and {} % at one place",
                r.errors_of_lengths,
            ),
            Figures("Accelerations contradict velocities in {} of some", r.contradictions),
            Figures(
                "No two of these eight windows show the same moment",
                lambda x: () if not r.us101_counts(x)["repeats"] else ("repeats",),
            ),
            Figures("**overlap** in {} frames, by up to {} m", r.overlap_of_two_vehicles),
        ),
    ),
    Statement(
        US101,
        (EVALUATE, "python benchmarks/us101.py ../shared/data/us101 out/us101"),
        (
            Figures("Of the {} traces that match no scenario of ext", "{} traces match no scenario of ext"),
            Figures("scenario 2 included, {} are of vehicles", "minDanger 0, {} of them without"),
            Figures("These pairs and the other {} are listed", r.others_with_a_lane),
            Figures("trucks ({} of {})", "{} of {} vehicles are longer"),
            Figures("The windows are short ({} to {} s)", "windows of {} to {} s"),
            Figures("clipped at ±{} m/s² in the data, and {} % of all", "greatest is {} m/s², {} % of all"),
        ),
    ),
    Statement(
        US101,
        (f"{EVALUATE} --option lateral_rss=signed",),
        (Figures("with it {} traces begin there and {} of ext match a scenario in a merge zone", r.signed),),
    ),
)

TIMED = (
    Statement(
        PERFORMANCE,
        (OVERLAP,),
        (Figures("`roadproof overlap`: {} pairs of base, {} drives and {} proofs", r.pairs_drives_proofs),),
        named="roadproof overlap",
    ),
    Statement(
        PERFORMANCE,
        ("roadproof overlap --lanes any",),
        (Figures("any`: {} drives, {} proofs", lambda x: r.pairs_drives_proofs(x)[1:]),),
    ),
    Statement(
        PERFORMANCE,
        (ORDER,),
        (
            Figures(
                "order` (exit 20): {} formulas, {} proofs, {} implications refuted, {} in doubt",
                lambda x: tuple(
                    len(r.read(x, "order/index.json")[key])
                    for key in ("kinds", "proved", "missing", "doubts")
                ),
            ),
        ),
        named="roadproof order",
    ),
    Statement(
        PERFORMANCE,
        (REDUNDANCY,),
        (Figures("redundancy`: {} changes of base", "{} changes:"),),
        named="roadproof redundancy",
    ),
    Statement(
        PERFORMANCE,
        (CLASSES,),
        (
            Figures(
                "DIR`: {} classes of base, {} proofs, {} drives, shares",
                lambda x: (
                    r.all_witnessed(x),
                    len(r.read(x, "classes/index.json")["claims"]),
                    r.all_witnessed(x),
                ),
            ),
        ),
        named="roadproof classify --out DIR",
    ),
)

STATEMENTS = (
    *HOLD_TOGETHER, *CLASSIFIED, *LEFT_OUT, *MISSED, *IMPLIED, *VALUES, *LIMITS, *MEASURED, *TIMED,
)  # fmt: skip

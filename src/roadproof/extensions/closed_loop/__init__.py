"""A controller in closed loop with scenarios, and a search for its failures, for those who test vehicles."""

from roadproof.extension import Extension

EXTENSION = Extension(
    title="Your vehicle under test: a search for the scenarios in which it fails",
    audience="testers",
    label="incubating",
    page="docs/tutorials/closed-loop.md",
    needs=("catalogue", "drivers", "exchange", "pages", "surveys", "traffic"),
    functions={"falsify": "falsifying:falsify", "resimulate": "resimulation.resimulating:resimulate"},
    questions={
        "falsify": "question:FalsifyQuestion",
        "resimulate": "resimulation.question:ResimulationQuestion",
    },
    answers={
        "falsify": "falsifying:Falsification",
        "resimulate": "resimulation.resimulating:Resimulated",
    },
    evidence={"roadproof/simulations/1": "simulations_file:SimulationsFile"},
    specifications={"closed_loop": "closed_loop.spec"},
    sections={"falsify": "page:FALSIFY", "resimulate": "resimulation.page:RESIMULATE"},
    schemas=("schemas:TITLES",),
)

"""Titles of the schemas of this extension's JSON files."""

from collections.abc import Mapping

from roadproof.extensions.closed_loop.data import FalsifyData
from roadproof.extensions.closed_loop.resimulation.data import ResimulationData
from roadproof.extensions.closed_loop.simulations_file import SimulationsFile

TITLES: Mapping[type, str] = {
    FalsifyData: "roadproof falsify --json: in which scenarios a vehicle under test fails",
    ResimulationData: "roadproof resimulate --json: a vehicle under test in place of recorded ones",
    SimulationsFile: "NAME.json in a folder of answers: the simulations of a search for failures",
}

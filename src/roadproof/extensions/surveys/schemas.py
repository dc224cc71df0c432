"""Titles of the schemas of this extension's JSON files."""

from collections.abc import Mapping

from roadproof.extensions.surveys.classify.data import ClassesData
from roadproof.extensions.surveys.coverage.schema import CoverageData
from roadproof.extensions.surveys.explore.data import ExploreData
from roadproof.extensions.surveys.redundancy import RedundancyData
from roadproof.extensions.surveys.survey import SurveyData

TITLES: Mapping[type, str] = {
    ClassesData: "roadproof classify --json: classes that exclude each other",
    CoverageData: "roadproof coverage --json: which disturbances a set misses",
    SurveyData: "the surveys of contributors, --json: which of some formulas can hold on a drive",
    ExploreData: "roadproof explore --json: for which values there is a drive",
    RedundancyData: "roadproof redundancy --json: which parts could be left out",
}

"""Scenarios that hold while no other one does, and traces with tabs, for those who write extensions."""

from roadproof.extension import Extension

EXTENSION = Extension(
    title="Scenarios that hold while no other one does; traces with tabs",
    audience="researchers",
    label="incubating",
    needs=("pages", "surveys", "traffic"),
    questions={"alone": "question:Alone"},
    answers={"alone": "roadproof.extensions.surveys.surveying:SurveyAnswers"},
    traces={".tsv": "tabs:read_trace"},
    sections={"survey": "page:SURVEY"},
)

"""A survey, traces with tabs and a driver model, for those who write extensions."""

from roadproof.extension import Extension

EXTENSION = Extension(
    title="Scenarios that hold while no other one does; traces with tabs; an alert driver",
    audience="researchers",
    label="incubating",
    needs=("drivers", "pages", "surveys", "traffic"),
    questions={"alone": "question:Alone"},
    answers={"alone": "roadproof.extensions.surveys.surveying:SurveyAnswers"},
    drivers={"alert": "driver:ALERT"},
    specifications={"alert": "alert.spec", "alert_prevention": "alert_prevention.spec"},
    traces={".tsv": "tabs:read_trace"},
    sections={"survey": "page:SURVEY"},
)

"""The problems that searches for drives solve, for those who audit them or solve them elsewhere."""

from roadproof.extension import Extension

EXTENSION = Extension(
    title="Encodings of searches: files for other solvers, and problems of cvxpy",
    audience="researchers",
    label="incubating",
    page="docs/explanation/encoding.md",
    functions={"encode": "encode:encode", "conflict": "explaining:conflict"},
    options={"witness": "options:EncodingOptions"},
)

"""Writes the drive viewer with its documents as one HTML file, which needs no server and no network."""

import base64
import hashlib
import html
import json
from collections.abc import Mapping, Sequence
from functools import cache
from importlib import resources
from importlib.resources.abc import Traversable

_OWN = ("palette", "terms", "drive", "plane", "labels", "scene", "strips", "curves", "verdict", "viewer")
_MODULES = ("vendor/view", *(f"viewer/{name}" for name in _OWN))


def viewer_folder() -> Traversable:
    """Return the folder of the viewer's files."""
    return resources.files("roadproof.extensions.pages").joinpath("viewer")


@cache
def viewer_modules() -> dict[str, str]:
    """Return the text of each ES module, by the name under which the others import it."""
    return {name: _text(f"{name.removeprefix('viewer/')}.js") for name in _MODULES}


@cache
def design() -> str:
    """Return fonts, colours and badges of every page; light or dark follows the system or ``data-theme``."""
    return _text("design.css")


@cache
def viewer_style() -> str:
    """Return all styles of the viewer."""
    return "\n".join((_text("vendor/uPlot.css"), design(), _text("viewer.css")))


def _text(path: str) -> str:
    return viewer_folder().joinpath(path).read_text("utf-8")


_PAGE = """\
<!doctype html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<meta http-equiv="Content-Security-Policy" content="default-src 'none'; script-src data: {hashes}; \
style-src 'unsafe-inline'; img-src data:; base-uri 'none'; form-action 'none'">
<title>{title}</title>
<style>{style}
body {{ margin: 0 auto; max-width: 1500px; padding: 12px 16px; background: var(--paper); color: var(--ink);
  font: 14px/1.4 var(--text); }}
h1 {{ font-size: 18px; }}
article {{ margin: 0 0 28px; }}
</style>
<script type="importmap">{imports}</script>
</head>
<body>
<h1>{title}</h1>
{articles}
<script type="application/json" id="documents">{documents}</script>
<script type="module">{script}</script>
</body>
</html>
"""
_SCRIPT = """
import {{ mount }} from "viewer/viewer";
const documents = JSON.parse(document.getElementById("documents").textContent);
documents.forEach((x, k) => mount(document.getElementById("document-" + k), x));
""".replace("{{", "{").replace("}}", "}")


def viewer_page(documents: Sequence[Mapping[str, object]], title: str) -> str:
    """Return an HTML page with a viewer for each document of ``viewer_data``; all texts are escaped."""
    imports = json.dumps({"imports": {name: as_url(text) for name, text in viewer_modules().items()}})
    articles = "\n".join(f'<article id="document-{k}"></article>' for k in range(len(documents)))
    hashes = " ".join(hash_of(x) for x in (imports, _SCRIPT))
    return _PAGE.format(
        title=html.escape(title),
        style=viewer_style(),
        imports=imports,
        articles=articles,
        documents=json_in_html(documents),
        script=_SCRIPT,
        hashes=hashes,
    )


def json_in_html(data: object) -> str:
    """Return plain data as JSON that a browser never takes for the end of a script, whatever its texts
    contain.
    """
    text = json.dumps(data, ensure_ascii=False)
    for sign in "<>&\u2028\u2029":
        text = text.replace(sign, f"\\u{ord(sign):04x}")
    return text


def as_url(text: str) -> str:
    """Return a script as a data URL."""
    return "data:text/javascript;base64," + base64.b64encode(text.encode()).decode()


def hash_of(script: str) -> str:
    """Return the hash by which a content security policy allows a script."""
    return f"'sha256-{base64.b64encode(hashlib.sha256(script.encode()).digest()).decode()}'"

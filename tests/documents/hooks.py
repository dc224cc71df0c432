"""Hooks of mkdocs (mkdocs.yml): generated pages, list of decision records, links out of docs/."""

import csv
import re
import sys
from pathlib import Path

from mkdocs.config.defaults import MkDocsConfig
from mkdocs.structure.files import File, Files
from mkdocs.structure.pages import Page

ROOT = Path(__file__).parents[2]
for folder in (ROOT / "tests", ROOT / "src"):
    if str(folder) not in sys.path:
        sys.path.insert(0, str(folder))

from documents.reference import PAGES  # noqa: E402
from roadproof.extensions.pages.viewer_page import design  # noqa: E402

_LINK = re.compile(r"(?<!!)\[((?:[^\[\]]|\[[^\]]*\])*)\]\(([^)\s#]+)(#[^)]*)?\)")
_FOR_DEVELOPERS = ("tests", "map", "explanation/glossary")
_SHIM = "https://unpkg.com/iframe-worker/shim"
_DATA = re.compile(r"^\[([^\]]+)\]\(([^)\s]+\.csv)\)$", re.M)
_HEADING = re.compile(r"^## (.+)$", re.M)
_FILE_BLOCK = re.compile(r"^```file (\S+)$", re.M)


def on_config(config: MkDocsConfig) -> MkDocsConfig:
    """List the decision records in the navigation."""
    records = sorted(path.name for path in ROOT.joinpath("docs/adr").glob("*.md"))
    assert config.nav is not None
    developers = next(entry["Developers"] for entry in config.nav if "Developers" in entry)
    for entry in developers:
        if "Decision records" in entry:
            entry["Decision records"] = [f"adr/{name}" for name in records]
    return config


def on_files(files: Files, config: MkDocsConfig) -> Files:
    """Add the pages that are generated from the program, and its design."""
    for name, write in PAGES.items():
        files.append(File.generated(config, name, content=write()))
    files.append(File.generated(config, "assets/design.css", content=design()))
    return files


def on_page_markdown(markdown: str, page: Page, config: MkDocsConfig, files: Files) -> str:
    """Show data as tables, name files outside docs/ instead of linking to them, title blocks of files."""
    here = Path(config.docs_dir, page.file.src_uri).parent
    if here.name == "adr" or page.file.src_uri.removesuffix(".md").endswith(_FOR_DEVELOPERS):
        page.meta["search"] = {"boost": 0.2}  # the search lists guides for users first

    def outside(link: re.Match[str]) -> str:
        label, target = link[1], link[2]
        if "://" in target:
            return link[0]
        path = (here / target).resolve()
        if path.is_relative_to(config.docs_dir) or not path.exists():
            return link[0]  # mkdocs resolves it, or warns
        name = path.relative_to(ROOT).as_posix()
        return label if name in label.replace("`", "") else f"{label} (`{name}`)"

    if page.file.src_uri == "reference/index.md":
        markdown = _HEADING.sub(_linked, markdown)
    shown = _DATA.sub(lambda x: table(x[1], here / x[2]), markdown)
    return _LINK.sub(outside, _FILE_BLOCK.sub(r'```text title="\1"', shown))


def _linked(heading: re.Match[str]) -> str:
    """The heading about a generated page, as a link to it."""
    made = {write().partition("\n")[0].removeprefix("# "): Path(name).name for name, write in PAGES.items()}
    title = heading[1]
    return f"## [{title}]({made[title]}) {{: #{title.lower().replace(' ', '-')} }}"


def table(title: str, path: Path) -> str:
    """A CSV file as a table; cells are Markdown, and columns of numbers are aligned to the right."""
    with path.open(encoding="utf-8", newline="") as file:
        head, *rows = csv.reader(file)
    columns = zip(*rows, strict=True)
    sides = ["---:" if all(re.match(r"[\d.<-]|$", x) for x in column) else "---" for column in columns]
    lines = (f"| {' | '.join(cells)} |" for cells in (head, sides, *rows))
    return "\n".join([f"**{title}**", "", *lines])


def on_post_page(output: str, page: Page, config: MkDocsConfig) -> str:
    """Take the worker of the search from the site: the theme takes it from a network."""
    return output.replace(_SHIM, "../" * page.file.dest_uri.count("/") + "assets/iframe-worker.js")


def on_post_template(output: str, template_name: str, config: MkDocsConfig) -> str:
    """As ``on_post_page``, for pages without a source, such as 404.html."""
    return output.replace(_SHIM, "assets/iframe-worker.js")

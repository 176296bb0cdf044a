"""mkdocs hooks for the site of tools/docs:

- Navigation follows the folders of docs/. Within a folder, pages are in the order in which its index page links to them, then by title.
- README.md is the home page; CONTRIBUTING.md and CHANGELOG.md are pages too.
- Links from a page to a file outside docs/ lead to a page that shows that file; links to a folder outside become plain text.
- Pages with formulas load Debian's KaTeX.
- The API reference that Doxygen wrote to build/docs/api becomes part of the site.
- Lists that GitHub renders and Python's Markdown does not are warnings; tools/docs makes warnings errors.
"""
import logging
import posixpath
import re
import shutil
from pathlib import Path

from mkdocs.structure.files import File
from mkdocs.structure.nav import Link

ROOT = Path(__file__).resolve().parents[2]
HERE = Path(__file__).resolve().parent
BUILD = ROOT / "build" / "docs"
SHOWN = BUILD / "sources"  # pages that show files of the repository
API = BUILD / "api"
KATEX = Path("/usr/share/javascript/katex")
KATEX_FILES = ("katex.min.css", "katex.min.js", "contrib/auto-render.js", "fonts/*.woff2")

HOME = "README.md"
PROJECT_PAGES = ("CONTRIBUTING.md", "CHANGELOG.md")
FOLDERS = (("Guide", "guide"), ("Reference", "reference"), ("Decisions", "decisions"))
LANGUAGES = {".cpp": "cpp", ".hpp": "cpp", ".py": "python", ".json": "json", ".txt": "cmake", ".cmake": "cmake", ".yml": "yaml"}

NOT_PROSE = re.compile(r"^(?P<fence>`{3,}).*?^(?P=fence)[ \t]*$|`[^`\n]+`", re.DOTALL | re.MULTILINE)
LINK = r"(?P<before>!?\[(?P<text>(?:`[^`\n]+`|[^\]`])*)\]\()(?P<target>[^)\s]+)(?P<after>\))"
# What begins first wins: a link's text may hold code, and a link inside code is none.
LINK_OR_CODE = re.compile(f"{NOT_PROSE.pattern}|{LINK}", NOT_PROSE.flags)
LIST_ITEM = re.compile(r"( *)([-*+]|\d+\.) ")

log = logging.getLogger("mkdocs.handhold")


def replace_links(text: str, replace) -> str:
    """Replaces each link outside fences and inline code by `replace(match of LINK)`."""
    return LINK_OR_CODE.sub(lambda match: replace(match) if match["target"] else match[0], text)


def repository_path(file: File) -> str:
    """Path of a page's source, relative to the repository's root."""
    return Path(file.abs_src_path).relative_to(ROOT).as_posix()


def target_path(file: File, target: str) -> str:
    """Path of a link's target, relative to the repository's root."""
    return posixpath.normpath(posixpath.join(posixpath.dirname(repository_path(file)), target))


def is_of_web(target: str) -> bool:
    return re.match(r"[a-z]+:|#", target) is not None


def site_path(path: str) -> str:
    """Path in the site of a repository file, relative to docs_dir, as mkdocs names it."""
    if path.startswith("docs/"):
        return path.removeprefix("docs/")
    if path in (HOME, *PROJECT_PAGES):
        return path
    return f"source/{path}.md"


def links_of(file: File) -> list[str]:
    """Repository paths of a page's link targets, in order."""
    text = Path(file.abs_src_path).read_text(encoding="utf-8")
    targets = (match["target"] for match in LINK_OR_CODE.finditer(text) if match["target"])
    return [target_path(file, target.partition("#")[0]) for target in targets if not is_of_web(target)]


def title_of(file: File) -> str:
    heading = re.search(r"^# +(.*?) *$", Path(file.abs_src_path).read_text(encoding="utf-8"), re.MULTILINE)
    return heading[1] if heading else file.name


def page_that_shows(path: str, config) -> File:
    language = LANGUAGES.get(Path(path).suffix, "text")
    text = (ROOT / path).read_text(encoding="utf-8")
    fence = "`" * (3 + max((len(run) for run in re.findall("`{3,}", text)), default=0))
    page = SHOWN / "source" / f"{path}.md"
    page.parent.mkdir(parents=True, exist_ok=True)
    page.write_text(f"# {path}\n\n{fence}{language}\n{text}\n{fence}\n", encoding="utf-8")
    return File(f"source/{path}.md", str(SHOWN), config.site_dir, config.use_directory_urls)


def folder_nav(pages: list[File]) -> list[str]:
    """The pages of a folder, its index first."""
    index = next((page for page in pages if page.name == "index"), None)
    linked = links_of(index) if index else []

    def order(page: File):
        path = repository_path(page)
        return (page is not index, linked.index(path) if path in linked else len(linked), title_of(page))

    return [page.src_uri for page in sorted(pages, key=order)]


def add_asset(files, config, on_site: str, source: Path) -> None:
    file = File(on_site, str(HERE), config.site_dir, config.use_directory_urls)
    file.abs_src_path = str(source)
    files.append(file)


def on_files(files, config):
    for name in (HOME, *PROJECT_PAGES):
        files.append(File(name, str(ROOT), config.site_dir, config.use_directory_urls))
    add_asset(files, config, "assets/site.css", HERE / "site.css")
    for path in (path for pattern in KATEX_FILES for path in sorted(KATEX.glob(pattern))):
        add_asset(files, config, f"assets/katex/{path.relative_to(KATEX).as_posix()}", path)

    pages = list(files.documentation_pages())
    folders = [(title, [page for page in pages if page.src_uri.startswith(f"{folder}/")]) for title, folder in FOLDERS]
    unsorted = [page for page in pages if "/" not in page.src_uri and page.src_uri not in (HOME, *PROJECT_PAGES)]
    config.nav = [{"Home": HOME}]
    for title, in_folder in folders:
        in_folder = in_folder + (unsorted if title == "Reference" else [])
        if in_folder:
            config.nav.append({title: folder_nav(in_folder)})
    config.nav.append({"Project": list(PROJECT_PAGES)})

    linked = {path for page in pages for path in links_of(page)}
    for path in sorted(linked):
        if not path.startswith(("docs/", "..")) and path not in (HOME, *PROJECT_PAGES) and (ROOT / path).is_file():
            files.append(page_that_shows(path, config))
    return files


def on_nav(nav, config, files):
    # After mkdocs' own checks, which do not know Doxygen's files.
    if API.is_dir():
        nav.items.insert(-1, Link("API", "api/index.html"))
    return nav


def on_page_markdown(markdown, page, config, files):
    path = repository_path(page.file)
    if page.file.src_uri.startswith("source/"):
        page.meta["search"] = {"exclude": True}
        return markdown

    def relink(match: re.Match) -> str:
        target, hash_sign, anchor = match["target"].partition("#")
        if is_of_web(match["target"]):
            return match[0]
        linked = target_path(page.file, target)
        if (ROOT / linked).is_dir():
            index = next((name for name in ("index.md", "README.md") if site_path(f"{linked}/{name}") in files), None)
            if index is None:
                return match["text"]
            linked = f"{linked}/{index}"
        on_site = posixpath.relpath(site_path(linked), posixpath.dirname(page.file.src_uri) or ".")
        return f"{match['before']}{on_site}{hash_sign}{anchor}{match['after']}"

    warn_of_lists(path, markdown)
    return replace_links(markdown, relink)


def on_post_page(output, page, config):
    if 'class="arithmatex"' not in output:
        return output
    katex = posixpath.relpath("assets/katex", posixpath.dirname(page.file.dest_uri) or ".")
    return output.replace("</head>", f"""<link rel="stylesheet" href="{katex}/katex.min.css">
<script defer src="{katex}/katex.min.js"></script>
<script defer src="{katex}/contrib/auto-render.js" onload="document.querySelectorAll('.arithmatex').forEach(
    formula => renderMathInElement(formula))"></script>
</head>""")


def on_post_build(config):
    if API.is_dir():
        shutil.copytree(API, Path(config.site_dir) / "api", dirs_exist_ok=True)


def warn_of_lists(path: str, markdown: str) -> None:
    """Python's Markdown starts a list only after a blank line, and nests by four columns."""
    lines = NOT_PROSE.sub(lambda match: "\n" * match[0].count("\n") or "code", markdown).split("\n")
    in_list = False
    for number, line in enumerate(lines, start=1):
        item = LIST_ITEM.match(line)
        if item and not in_list and number > 1 and lines[number - 2].strip():
            log.warning("%s:%d: a list needs a blank line before it", path, number)
        if item and len(item[1]) % 4:
            log.warning("%s:%d: indent nested lists by four columns", path, number)
        in_list = item is not None or (in_list and (not line.strip() or line.startswith(" ")))

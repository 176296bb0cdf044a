"""What tools/docs_site adds to mkdocs and Doxygen. The site's tests build small trees with mkdocs and are skipped where it is not installed."""
import importlib.util
import shutil
import subprocess
import tempfile
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
SITE = ROOT / "tools" / "docs_site"
spec = importlib.util.spec_from_file_location("doxygen_filter", SITE / "doxygen_filter.py")
doxygen_filter = importlib.util.module_from_spec(spec)
spec.loader.exec_module(doxygen_filter)

PAGES = {
    "README.md": "# Top\n[guide](docs/guide/index.md) [tests](tests/) ![a](docs/images/a.svg)\n",
    "CONTRIBUTING.md": "# Contributing\n",
    "CHANGELOG.md": "# Changes\n",
    "docs/images/a.svg": "<svg xmlns='http://www.w3.org/2000/svg'/>",
    "docs/guide/index.md": "# Guide\n[z](z.md) [b](b.md)\n",
    "docs/guide/a.md": "# Alpha\n[source](../../engine/a.cpp) [top](../../README.md) `[code](none.md)`\n",
    "docs/guide/b.md": "# Beta\n$x^2$\n",
    "docs/guide/z.md": "# Omega\n",
    "engine/a.cpp": "int answer = 42;\n",
    "tests/a.txt": "",
}


@unittest.skipUnless(shutil.which("mkdocs"), "mkdocs is not installed")
class Site(unittest.TestCase):
    def build(self, pages: dict[str, str]) -> tuple[int, str, Path]:
        """Exit status, what was printed, and the folder of the site."""
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        root = Path(folder.name).resolve()
        shutil.copytree(SITE, root / "tools" / "docs_site", ignore=shutil.ignore_patterns("__pycache__"))
        for name, text in pages.items():
            path = root / name
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(text, encoding="utf-8")
        run = subprocess.run(["mkdocs", "build", "--strict", "--config-file", root / "tools/docs_site/mkdocs.yml"],
                             capture_output=True, text=True, check=False)
        return run.returncode, run.stdout + run.stderr, root / "build" / "docs" / "site"

    def test_pages_stand_in_the_order_of_their_index_and_links_lead_to_the_site(self):
        status, printed, site = self.build(PAGES)
        self.assertEqual(status, 0, printed)
        page = (site / "guide/a.html").read_text(encoding="utf-8")
        places = [page.index(f">\n        {title}\n") for title in ("Omega", "Beta")]
        self.assertEqual(places, sorted(places))
        self.assertLess(places[-1], page.rindex("Alpha\n      </a>"))
        self.assertIn('href="../source/engine/a.cpp.html"', page)
        self.assertIn('href="../index.html"', page)
        self.assertIn("[code](none.md)", page)
        self.assertIn("answer", (site / "source/engine/a.cpp.html").read_text(encoding="utf-8"))
        home = (site / "index.html").read_text(encoding="utf-8")
        self.assertIn('src="images/a.svg"', home)
        self.assertIn('href="guide/index.html">guide</a> tests', home)

    def test_only_pages_with_formulas_load_what_draws_them(self):
        _, _, site = self.build(PAGES)
        self.assertIn("katex", (site / "guide/b.html").read_text(encoding="utf-8"))
        self.assertNotIn("katex", (site / "guide/a.html").read_text(encoding="utf-8"))

    def test_nothing_is_loaded_from_the_web(self):
        _, _, site = self.build(PAGES)
        for page in site.rglob("*.html"):
            self.assertNotRegex(page.read_text(encoding="utf-8"), r'(src|<link[^>]*href)="(https?:)?//')

    def test_broken_links_and_lists_are_named(self):
        status, printed, _ = self.build(PAGES | {"docs/guide/a.md": "# Alpha\n[b](none.md)\nThings:\n- one\n\n  - two\n"})
        self.assertEqual(status, 1)
        self.assertIn("none.md", printed)
        self.assertIn("docs/guide/a.md:4: a list needs a blank line before it", printed)
        self.assertIn("docs/guide/a.md:6: indent nested lists by four columns", printed)


class DoxygenFilter(unittest.TestCase):
    def expect(self, text: str, filtered: str):
        self.assertEqual(doxygen_filter.documented(text), filtered)

    def test_comment_above_a_declaration_documents_it(self):
        self.expect("// Steps.\n// Once.\nvoid step();", "/// Steps.\n/// Once.\nvoid step();")

    def test_comment_above_the_namespace_documents_the_file(self):
        self.expect("#include <span>\n\n// Door.\nnamespace handhold {", "#include <span>\n/// \\file\n/// Door.\nnamespace handhold {")

    def test_comment_after_a_member_documents_it_over_several_lines(self):
        self.expect("    int a;  // One\n            // two.\n    // Next.\n    int b;",
                    "    int a;  ///< One\n            ///< two.\n    /// Next.\n    int b;")

    def test_comments_that_document_nothing_stay(self):
        for text in ("// Apart.\n\nint a;", "}  // namespace handhold", 'f("http://a");', "// Guard\n#endif", "// End\n}"):
            self.expect(text, text)


if __name__ == "__main__":
    unittest.main()

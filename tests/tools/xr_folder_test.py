"""Runs tools/xr_e2e, which deletes folders as root, on folders that it did not make. Needs neither root nor network."""
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.dont_write_bytecode = True
sys.path.insert(0, str(ROOT / "tools"))

from xr import folder as xr_folder  # noqa: E402


class ForeignFolders(unittest.TestCase):
    def setUp(self):
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.root = Path(temporary.name).resolve()

    def run_tool(self, folder: Path) -> subprocess.CompletedProcess:
        return subprocess.run([sys.executable, str(ROOT / "tools/xr_e2e"), "--game", "/bin/true", "--folder", str(folder),
                               "--out", str(self.root / "out"), "absent"], capture_output=True, text=True, timeout=60, check=False)

    def assert_refused(self, folder: Path, kept: Path):
        ended = self.run_tool(folder)
        self.assertEqual(ended.returncode, 2, ended.stderr)
        self.assertIn("not made by xr_e2e", ended.stderr)
        self.assertEqual(kept.read_text(), "a year's work")

    def precious(self, folder: Path) -> Path:
        folder.mkdir(parents=True, exist_ok=True)
        (folder / "thesis.txt").write_text("a year's work")
        return folder / "thesis.txt"

    def test_existing_folder_is_refused_and_kept(self):
        self.assert_refused(self.root / "home", self.precious(self.root / "home"))

    def test_empty_folder_is_refused(self):
        kept = self.precious(self.root / "other")
        (self.root / "empty").mkdir()
        self.assert_refused(self.root / "empty", kept)
        self.assertTrue((self.root / "empty").is_dir())

    def test_file_is_refused_and_kept(self):
        kept = self.precious(self.root / "home")
        self.assert_refused(kept, kept)

    def test_link_to_marked_folder_is_refused(self):
        kept = self.precious(self.root / "home")
        (self.root / "home/etc").mkdir()
        (self.root / "home" / xr_folder.MARK).write_text("incomplete\n")
        (self.root / "link").symlink_to(self.root / "home")
        self.assert_refused(self.root / "link", kept)

    def test_marker_that_is_a_link_does_not_count(self):
        kept = self.precious(self.root / "home")
        (self.root / "home/etc").mkdir()
        (self.root / "home" / xr_folder.MARK).symlink_to(kept)
        self.assert_refused(self.root / "home", kept)

    def test_root_of_the_file_system_is_refused(self):
        self.assert_refused(Path("/"), self.precious(self.root / "home"))

    def test_dots_do_not_hide_an_existing_folder(self):
        kept = self.precious(self.root / "home")
        self.assert_refused(self.root / "absent/../home", kept)

    def test_foreign_neighbour_with_the_working_name_is_kept(self):
        kept = self.precious(self.root / "new.part")
        with self.assertRaises(xr_folder.NotOurs):
            xr_folder.ensure(self.root / "new")
        self.assertEqual(kept.read_text(), "a year's work")
        self.assertFalse((self.root / "new").exists())

    def test_remove_deletes_marked_folders_only(self):
        kept = self.precious(self.root / "home")
        with self.assertRaises(xr_folder.NotOurs):
            xr_folder.remove(self.root / "home")
        self.assertTrue(kept.is_file())
        (self.root / "ours/etc").mkdir(parents=True)
        (self.root / "ours" / xr_folder.MARK).write_text("incomplete\n")
        xr_folder.remove(self.root / "ours")
        self.assertFalse((self.root / "ours").exists())
        xr_folder.remove(self.root / "never_was")


if __name__ == "__main__":
    unittest.main()

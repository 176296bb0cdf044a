"""Runs tools/install_packages with a fake apt-get, whose lock the test holds, and a fake dpkg-query. Needs neither root nor network."""
import fcntl
import os
import shutil
import subprocess
import tempfile
import threading
import unittest
from pathlib import Path

SCRIPT = Path(__file__).resolve().parents[2] / "tools" / "install_packages"

# As Debian's: fails at once while somebody holds the lock of the package lists.
FAKE_APT_GET = """#!/bin/bash
exec 9>"$FAKE_APT/lists_lock"
if ! flock --nonblock 9; then
    echo "E: Could not get lock /var/lib/apt/lists/lock. It is held by process 1 (apt-get)" >&2
    exit 100
fi
if [[ -e $FAKE_APT/no_network ]]; then
    echo "E: Unable to fetch some archives" >&2
    exit 100
fi
echo "$*" >>"$FAKE_APT/calls"
"""
FAKE_DPKG_QUERY = """#!/bin/bash
[[ -e $FAKE_APT/all_installed ]] && echo installed
"""
FAKE_SUDO = """#!/bin/bash
exec "$@"
"""


class InstallPackages(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)
        for name, text in {"apt-get": FAKE_APT_GET, "dpkg-query": FAKE_DPKG_QUERY, "sudo": FAKE_SUDO}.items():
            path = self.folder / "bin" / name
            path.parent.mkdir(exist_ok=True)
            path.write_text(text, encoding="utf-8")
            path.chmod(0o755)

    def install(self, *words: str, wait_s: int = 30) -> subprocess.CompletedProcess:
        environment = os.environ | {
            "PATH": f"{self.folder / 'bin'}:{os.environ['PATH']}",
            "FAKE_APT": str(self.folder),
            "HANDHOLD_APT_WAIT_S": str(wait_s),
        }
        return subprocess.run([SCRIPT, *words], env=environment, capture_output=True, text=True, check=False, timeout=60)

    def hold_lock(self):
        lock = open(self.folder / "lists_lock", "w", encoding="utf-8")
        self.addCleanup(lock.close)
        fcntl.flock(lock, fcntl.LOCK_EX)
        return lock

    def calls(self) -> list[str]:
        path = self.folder / "calls"
        return path.read_text(encoding="utf-8").splitlines() if path.exists() else []

    def test_missing_packages_are_installed_after_an_update(self):
        run = self.install("docs")
        self.assertEqual(run.returncode, 0, run.stderr)
        update, install = self.calls()
        self.assertTrue(update.endswith("update"))
        self.assertIn("mkdocs-material", install)

    def test_nothing_is_called_when_all_are_installed(self):
        (self.folder / "all_installed").touch()
        self.assertEqual(self.install("ci").returncode, 0)
        self.assertEqual(self.calls(), [])

    def test_ci_and_long_hold_the_sets_that_they_run(self):
        installed = {}
        for package_set in ("demo", "test", "docs", "blender", "native", "web", "arm64", "windows", "package", "ci", "long"):
            self.install(package_set)
            installed[package_set] = set(self.calls()[-1].split())
        for package_set in ("demo", "test", "docs", "native", "web"):
            self.assertLess(installed[package_set], installed["ci"])
        for package_set in ("ci", "blender", "arm64", "windows", "package"):
            self.assertLess(installed[package_set], installed["long"])
        for package, package_set in (("mono-mcs", "test"), ("blender", "blender"), ("wine64", "windows"), ("node-ws", "web"), ("pkg-config", "native"),
                                     ("python3-venv", "package"), ("chromium", "long")):
            self.assertIn(package, installed[package_set])

    def test_missing_packages_are_only_named_on_request(self):
        run = self.install("--missing", "docs")
        self.assertEqual(run.returncode, 0, run.stderr)
        self.assertIn("mkdocs-material", run.stdout.split())
        self.assertEqual(self.calls(), [])
        (self.folder / "all_installed").touch()
        self.assertEqual(self.install("--missing", "docs").stdout, "")

    def test_what_is_missing_is_unknown_without_dpkg(self):
        for name in ("bash", "apt-get"):
            (self.folder / "without" / name).parent.mkdir(exist_ok=True)
            (self.folder / "without" / name).symlink_to(shutil.which(name, path=f"{self.folder / 'bin'}:{os.environ['PATH']}"))
        for words, status in ((["--missing", "docs"], 77), (["docs"], 0)):
            run = subprocess.run([SCRIPT, *words], env={"PATH": str(self.folder / "without")}, capture_output=True, text=True, check=False)
            self.assertEqual((run.returncode, run.stdout), (status, ""))
            self.assertIn("this is no Debian", run.stderr)
            self.assertIn("mkdocs-material", run.stderr)

    def test_waits_until_the_lock_is_released(self):
        lock = self.hold_lock()
        release = threading.Timer(1.5, lock.close)
        release.start()
        self.addCleanup(release.cancel)
        run = self.install("docs")
        self.assertEqual(run.returncode, 0, run.stderr)
        self.assertIn("waiting for another apt", run.stdout)
        self.assertEqual(len(self.calls()), 2)

    def test_lock_held_too_long_is_reported_with_its_holder(self):
        self.hold_lock()
        run = self.install("docs", wait_s=1)
        self.assertEqual(run.returncode, 100)
        self.assertIn("It is held by process 1 (apt-get)", run.stderr)
        self.assertIn("another apt still holds its lock after 1 s", run.stderr)
        self.assertEqual(self.calls(), [])

    def test_other_errors_are_reported_at_once(self):
        (self.folder / "no_network").touch()
        run = self.install("docs")
        self.assertEqual(run.returncode, 100)
        self.assertEqual(run.stderr, "E: Unable to fetch some archives\n")
        self.assertNotIn("waiting", run.stdout)

    def test_unknown_set_is_refused_with_the_usage(self):
        run = self.install("all")
        self.assertEqual(run.returncode, 1)
        self.assertIn("usage:", run.stderr)


if __name__ == "__main__":
    unittest.main()

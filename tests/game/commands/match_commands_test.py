"""Runs matches as processes: a server, bots and a recorded player over the loopback interface, and every way of not being admitted.

usage: match_commands_test.py GAME [unittest's flags]
"""
import http.server
import json
import os
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import threading
import time
import unittest
import urllib.error
import urllib.request
from pathlib import Path

GAME = Path(sys.argv.pop(1)).resolve()
if "HANDHOLD_REALTIME_TESTS" not in os.environ:  # bounds of the wall's clock: .ci/long sets it
    sys.exit(77)
WITHIN_S = 60.0


class Program:
    """A program that logs lines of key=value."""

    def __init__(self, folder: Path, *words, env: dict[str, str] | None = None):
        self.out = folder / f"{len(list(folder.glob('*.log')))}.log"
        self.err = self.out.with_suffix(".err")
        with self.out.open("wb") as out, self.err.open("wb") as err:
            self.process = subprocess.Popen([str(GAME), *map(str, words)], stdout=out, stderr=err, cwd=folder, env=env)

    def lines(self, event: str) -> list[dict[str, str]]:
        found = []
        for line in self.out.read_text(encoding="utf-8").splitlines():
            fields = dict(re.findall(r'(\w+)=("(?:[^"\\]|\\.)*"|\S+)', line))
            if fields.get("event") == event:
                found.append(fields)
        return found

    def wait_for(self, event: str, count: int = 1) -> list[dict[str, str]]:
        until = time.monotonic() + WITHIN_S
        while len(self.lines(event)) < count:
            if self.process.poll() is not None or time.monotonic() > until:
                raise AssertionError(f"no {event}: {self.out.read_text()}{self.err.read_text()}")
            time.sleep(0.02)
        return self.lines(event)

    def end(self) -> int:
        try:
            return self.process.wait(WITHIN_S)
        finally:
            self.process.kill()


class Matches(unittest.TestCase):
    def setUp(self):
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = Path(temporary.name).resolve()

    def start(self, *words, env: dict[str, str] | None = None) -> Program:
        program = Program(self.folder, *words, env=env)
        self.addCleanup(lambda: program.process.poll() is None and program.process.kill())
        return program

    def serve(self, *words) -> tuple[Program, str]:
        server = self.start("serve", "--scene", "reach", *words)
        return server, server.wait_for("serves")[0]["url"]

    def assert_refused(self, words: list, what: str):
        ended = subprocess.run([str(GAME), *map(str, words)], capture_output=True, timeout=WITHIN_S, check=False, cwd=self.folder)
        error = ended.stderr.decode()
        self.assertEqual(ended.returncode, 2, error)
        self.assertEqual(error.count("\n"), 1, error)
        self.assertIn(what, error)

    def get(self, url: str, path: str) -> tuple[int, str]:
        try:
            with urllib.request.urlopen(url.replace("ws://", "http://") + path, timeout=5) as answer:
                return answer.status, answer.read().decode()
        except urllib.error.HTTPError as error:
            return error.code, error.read().decode()

    def test_bots_and_a_recorded_player_have_the_servers_hashes_and_sigterm_drains(self):
        subprocess.run([str(GAME), "climb", "--scene", "reach", "--seconds", "2", "--out", "climb.csv"], check=True, capture_output=True,
                       cwd=self.folder)
        server, url = self.serve("--players", "3")
        bots = self.start("bots", 2, "--join", url)
        player = self.start("run", "--join", url, "--input", "climb.csv")
        server.wait_for("plays", 3)
        self.assertEqual(self.get(url, "/health"), (200, "ok\n"))
        self.assertEqual(self.get(url, "/nothing")[0], 404)
        status, metrics = self.get(url, "/metrics")
        self.assertEqual(status, 200)
        self.assertRegex(metrics, r"(?m)^handhold_players 3$")
        self.assertRegex(metrics, r"(?m)^handhold_out_of_sync_total 0$")
        for line in metrics.splitlines():
            self.assertRegex(line, r'^(# (HELP|TYPE) handhold_\w+ .+|handhold_\w+(\{\w+="\w+"\})? -?[\d.e+-]+)$')
        bots.wait_for("confirmed", 2)
        player.wait_for("confirmed")
        server.process.send_signal(signal.SIGTERM)
        for program in (server, bots, player):
            self.assertEqual(program.end(), 0, program.err.read_text())
        hashes = {}
        for program in (server, bots, player):
            for line in program.lines("confirmed"):
                hashes.setdefault(line["tick"], []).append(line["hash"])
        compared = [set(found) for found in hashes.values() if len(found) >= 3]
        self.assertTrue(compared, hashes)
        self.assertTrue(all(len(found) == 1 for found in compared), hashes)
        self.assertEqual(bots.lines("ends")[0]["why"], '"the server is shutting down"')
        self.assertEqual(server.lines("ends")[0]["out_of_sync"], "0")
        self.assertGreater(int(server.lines("ends")[0]["hashes"]), 0)

    def replay(self, name: str) -> tuple[str, int]:
        """The last hash of a recording that was played again, and the number of hashes in it that were compared."""
        ended = subprocess.run([str(GAME), "run", "--match", name], capture_output=True, timeout=WITHIN_S, check=False, cwd=self.folder)
        self.assertEqual(ended.returncode, 0, ended.stderr.decode())
        lines = ended.stdout.decode().splitlines()
        return lines[-1].removeprefix("state_hash "), int(re.search(r"(\d+) hashes", ended.stdout.decode())[1])

    def test_recorded_matches_play_again_with_equal_hashes_and_cut_ones_are_refused(self):
        server, url = self.serve("--players", "3", "--record", "server.hhm")
        bots = self.start("bots", 2, "--join", url)
        server.wait_for("plays", 2)
        player = self.start("run", "--join", url, "--record", "player.hhm")
        watcher = self.start("run", "--join", url, "--watch", "--record", "watcher.hhm")
        server.wait_for("watches")
        player.wait_for("confirmed", 2)
        watcher.wait_for("confirmed", 2)
        self.assertRegex(self.get(url, "/metrics")[1], r"(?m)^handhold_spectators 1$")
        server.process.send_signal(signal.SIGTERM)
        for program in (server, bots, player, watcher):
            self.assertEqual(program.end(), 0, program.err.read_text())
        for name, program in {"server.hhm": server, "player.hhm": player, "watcher.hhm": watcher}.items():
            last, compared = self.replay(name)
            self.assertEqual(last, program.lines("ends")[0]["hash"], name)
            self.assertGreater(compared, 2, name)
        (self.folder / "shots.json").write_text(json.dumps({"shots": [{"name": "seen", "scene": "reach", "at_s": 0.5, "view": "behind"}]}))
        drawn = subprocess.run([str(GAME), *"run --match server.hhm --shots shots.json --out drawn --shot-width 64 --shot-height 36".split()],
                               capture_output=True, timeout=WITHIN_S, check=False, cwd=self.folder)
        with self.subTest("pictures"):
            if b"no pictures" in drawn.stderr:
                self.skipTest("no way to draw here")
            self.assertEqual(drawn.returncode, 0, drawn.stderr.decode())
            self.assertTrue((self.folder / "drawn/seen.png").is_file())
        whole = (self.folder / "server.hhm").read_bytes()
        (self.folder / "cut.hhm").write_bytes(whole[:len(whole) // 2])
        (self.folder / "flipped.hhm").write_bytes(whole[:1000] + bytes([whole[1000] ^ 4]) + whole[1001:])
        self.assert_refused(["run", "--match", "cut.hhm"], "expected the rest of the recording: it was cut off")
        self.assert_refused(["run", "--match", "flipped.hhm"], "the file is damaged")
        self.assert_refused(["run", "--match", "server.hhm", "--scene", "together"], 'other level: "scene" differs')
        self.assert_refused(["run", "--match", "none.hhm"], "expected a readable file, found none")
        self.assert_refused(["serve", "--scene", "reach", "--record", "none/x.hhm"], "expected a writable place in an existing folder")

    def test_players_behind_a_slow_network_have_equal_hashes(self):
        server, url = self.serve("--players", "2")
        proxy = subprocess.Popen([sys.executable, str(Path(__file__).with_name("delay_proxy.py")), url.rpartition(":")[2], "--delay-ms", "75"],
                                 stdout=subprocess.PIPE)
        self.addCleanup(proxy.stdout.close)
        self.addCleanup(proxy.wait)
        self.addCleanup(proxy.kill)
        slow = f"ws://127.0.0.1:{int(proxy.stdout.readline())}"
        bots = self.start("bots", 1, "--join", url)
        far = self.start("run", "--join", slow)
        server.wait_for("plays", 2)
        far.wait_for("confirmed", 4)
        server.process.send_signal(signal.SIGTERM)
        for program in (server, bots, far):
            self.assertEqual(program.end(), 0, program.err.read_text())
        ours = {line["tick"]: line["hash"] for line in server.lines("confirmed")}
        compared = [line["hash"] == ours[line["tick"]] for line in far.lines("confirmed") if line["tick"] in ours]
        self.assertGreater(len(compared), 2)
        self.assertTrue(all(compared))
        self.assertEqual(server.lines("ends")[0]["out_of_sync"], "0")
        self.assertGreater(int(far.lines("ends")[0]["rollbacks"]), 60)

    def test_peers_of_both_transports_have_equal_hashes(self):
        server = self.start("serve", "--scene", "reach", "--players", "3")
        serves = server.wait_for("serves")[0]
        quic = serves["quic"].strip('"')
        if quic == "none":
            self.skipTest("built without ngtcp2")
        self.assertRegex(quic, r"^quic://127\.0\.0\.1:\d+#[0-9a-f]{64}$")
        self.assertEqual(quic.split("#")[0].rpartition(":")[2], serves["url"].rpartition(":")[2])
        bots = self.start("bots", 1, "--join", serves["url"])
        player = self.start("run", "--join", quic)
        watcher = self.start("run", "--join", quic, "--watch")
        server.wait_for("watches")
        player.wait_for("confirmed", 3)
        watcher.wait_for("confirmed", 2)
        self.assert_refused(["run", "--join", quic.split("#")[0]], "the server's certificate is not known here")
        self.assert_refused(["run", "--join", quic[:-64] + "0" * 64], "the server's certificate has another fingerprint")
        self.assert_refused(["run", "--join", quic[:-1]], "expected quic://HOST:PORT")
        self.assert_refused(["serve", "--scene", "reach", "--cert", "none.pem", "--key", "none.pem"], "expected a certificate in PEM")
        server.process.send_signal(signal.SIGTERM)
        for program in (server, bots, player, watcher):
            self.assertEqual(program.end(), 0, program.err.read_text())
        ours = {line["tick"]: line["hash"] for line in server.lines("confirmed")}
        for program in (bots, player, watcher):
            compared = [line["hash"] == ours[line["tick"]] for line in program.lines("confirmed") if line["tick"] in ours]
            self.assertTrue(compared and all(compared))
        self.assertEqual(server.lines("ends")[0]["out_of_sync"], "0")

    def test_a_certificate_of_ones_own_is_shown(self):
        if shutil.which("openssl") is None:
            self.skipTest("no openssl")
        subprocess.run("openssl req -x509 -newkey ec -pkeyopt ec_paramgen_curve:prime256v1 -nodes -keyout key.pem -out cert.pem -days 2 "
                       "-subj /CN=localhost".split(), check=True, capture_output=True, cwd=self.folder)
        told = subprocess.run("openssl x509 -in cert.pem -noout -fingerprint -sha256".split(), check=True, capture_output=True, cwd=self.folder)
        server = self.start("serve", "--scene", "reach", "--cert", "cert.pem", "--key", "key.pem")
        address, _, fingerprint = server.wait_for("serves")[0]["quic"].strip('"').partition("#")
        if address == "none":
            self.skipTest("built without ngtcp2")
        ours = told.stdout.decode().strip().partition("=")[2]
        self.assertEqual(fingerprint, ours.replace(":", "").lower())
        bots = self.start("bots", 1, "--join", f"{address}#{ours}", "--seconds", "1")
        self.assertEqual(bots.end(), 0, bots.err.read_text())
        self.assert_refused(["run", "--join", address], "the server's certificate is not known here")
        self.assert_refused(["serve", "--scene", "reach", "--cert", "key.pem", "--key", "cert.pem"], "expected a certificate in PEM")
        server.process.send_signal(signal.SIGTERM)
        self.assertEqual(server.end(), 0)

    def test_certificates_of_an_authority_need_no_fingerprint(self):
        if shutil.which("openssl") is None:
            self.skipTest("no openssl")
        (self.folder / "san").write_text("subjectAltName=DNS:localhost,IP:127.0.0.1\n")
        key = "-newkey ec -pkeyopt ec_paramgen_curve:prime256v1 -nodes"
        for command in (f"req -x509 {key} -keyout ca.key -out ca.pem -days 2 -subj /CN=authority -addext basicConstraints=critical,CA:TRUE",
                        f"req {key} -keyout key.pem -out request.pem -subj /CN=localhost",
                        "x509 -req -in request.pem -CA ca.pem -CAkey ca.key -CAcreateserial -days 2 -extfile san -out cert.pem",
                        f"req -x509 {key} -keyout other.key -out other.pem -days 2 -subj /CN=other -addext basicConstraints=critical,CA:TRUE"):
            subprocess.run(["openssl", *command.split()], check=True, capture_output=True, cwd=self.folder)
        server = self.start("serve", "--scene", "reach", "--cert", "cert.pem", "--key", "key.pem")
        address = server.wait_for("serves")[0]["quic"].strip('"').partition("#")[0]
        if address == "none":
            self.skipTest("built without ngtcp2")
        for host in ("127.0.0.1", "localhost"):
            bots = self.start("bots", 1, "--join", address.replace("127.0.0.1", host), "--seconds", "1",
                              env=dict(os.environ, SSL_CERT_FILE="ca.pem"))
            self.assertEqual(bots.end(), 0, bots.err.read_text())
            self.assertEqual(len(bots.lines("plays")), 1)
        for authority in ("other.pem", "none.pem"):
            stranger = self.start("bots", 1, "--join", address, env=dict(os.environ, SSL_CERT_FILE=authority))
            self.assertEqual(stranger.end(), 2)
            self.assertIn("the server's certificate is not known here", stranger.err.read_text())
        server.process.send_signal(signal.SIGTERM)
        self.assertEqual(server.end(), 0)

    def test_agones_is_told_when_the_server_is_ready_played_and_ends(self):
        calls = []

        class Sidecar(http.server.BaseHTTPRequestHandler):
            def do_POST(self):
                body = self.rfile.read(int(self.headers["Content-Length"]))
                is_json = self.headers["Content-Type"] == "application/json" and json.loads(body) == {}
                calls.append(self.path if is_json else "not JSON")
                self.send_response(200)
                self.end_headers()

            def log_message(self, *_):
                pass

        with http.server.ThreadingHTTPServer(("127.0.0.1", 0), Sidecar) as sidecar:
            threading.Thread(target=sidecar.serve_forever, daemon=True).start()
            server = self.start("serve", "--scene", "reach", "--agones", "--return-seconds", "1",
                                env=dict(os.environ, AGONES_SDK_HTTP_PORT=str(sidecar.server_address[1])))
            url = server.wait_for("serves")[0]["url"]
            server.wait_for("agones")
            bots = self.start("bots", 1, "--join", url, "--seconds", "5")
            self.assertEqual(bots.end(), 0)
            self.assertEqual(server.end(), 0)  # by itself
            sidecar.shutdown()
        self.assertEqual([call for call in calls if call != "/health"], ["/ready", "/allocate", "/shutdown"])
        self.assertGreaterEqual(calls.count("/health"), 3)

    def test_window_plays_in_a_match(self):
        server, url = self.serve("--players", "2")
        bot = self.start("bots", 1, "--join", url)
        server.wait_for("plays")
        window = self.start("play", "--join", url, "--seconds", "2", "--quality", "plain", "--width", 64, "--height", 36, "--record", "me.csv",
                            env=dict(os.environ, SDL_VIDEODRIVER="dummy", SDL_AUDIODRIVER="dummy", LIBGL_ALWAYS_SOFTWARE="1"))
        status = window.end()
        if status == 3:
            self.skipTest("no way to draw here")
        self.assertEqual(status, 0, window.err.read_text())
        self.assertEqual(len(server.lines("plays")), 2)
        self.assertEqual(server.wait_for("left")[0]["why"], "leaving")
        self.assertIn(f"handhold run --join {url} --input me.csv", window.out.read_text())
        server.process.send_signal(signal.SIGTERM)
        self.assertEqual((server.end(), bot.end()), (0, 0))
        self.assertEqual(server.lines("ends")[0]["out_of_sync"], "0")
        self.assertGreater(int(server.lines("ends")[0]["hashes"]), 1)

    def test_window_watches_a_match_without_a_slot(self):
        server, url = self.serve("--players", "1")
        bot = self.start("bots", 1, "--join", url)
        server.wait_for("plays")
        window = self.start("play", "--join", url, "--watch", "--seconds", "2", "--quality", "plain", "--width", 64, "--height", 36,
                            env=dict(os.environ, SDL_VIDEODRIVER="dummy", SDL_AUDIODRIVER="dummy", LIBGL_ALWAYS_SOFTWARE="1"))
        status = window.end()
        if status == 3:
            self.skipTest("no way to draw here")
        self.assertEqual(status, 0, window.err.read_text())
        self.assertEqual(len(server.lines("watches")), 1)
        server.process.send_signal(signal.SIGTERM)
        self.assertEqual((server.end(), bot.end()), (0, 0))

    def test_who_is_not_admitted_reads_why_in_one_line(self):
        (self.folder / "key").write_text("k" * 40 + "\n")
        (self.folder / "short").write_text("k" * 31)
        (self.folder / "other").write_text("x" * 40)
        token = ["token", "--name", "ann", "--token-key"]
        for name, words in {"good": ["key"], "old": ["key", "--minutes", "0"], "forged": ["other"]}.items():
            made = subprocess.run([str(GAME), *token, *words], check=True, capture_output=True, cwd=self.folder)
            (self.folder / name).write_bytes(made.stdout)
        server, url = self.serve("--players", "1", "--token-key", "key")
        join = ["run", "--join", url]
        self.assert_refused(join, "the server wants a token (--token)")
        self.assert_refused([*join, "--token", "old"], "the token has expired")
        self.assert_refused([*join, "--token", "forged"], "the token is not one of this server")
        self.assert_refused([*join, "--token", "good", "--scene", "together"], 'other level: "scene" differs')
        player = self.start(*join, "--token", "good")
        server.wait_for("plays")
        bob = subprocess.run([str(GAME), "token", "--token-key", "key", "--name", "bob"], check=True, capture_output=True, cwd=self.folder)
        (self.folder / "bob").write_bytes(bob.stdout)
        self.assert_refused([*join, "--token", "bob"], "the match is full")
        self.assert_refused(["bots", 2, "--join", url, "--token", "bob"], "expected 2 tokens, one a line, found 1")
        self.assert_refused(["serve", "--scene", "reach", "--token-key", "short"], "expected a secret of 32 to 4096 bytes, found 31 bytes")
        self.assert_refused(["serve", "--scene", "reach", "--port", url.rpartition(":")[2]], "expected an address and a port that are free")
        player.process.send_signal(signal.SIGINT)
        self.assertEqual(player.end(), 0)
        self.assertEqual(server.wait_for("left")[0]["why"], "leaving")
        server.process.send_signal(signal.SIGTERM)
        self.assertEqual(server.end(), 0)
        self.assert_refused(join, "no server")
        self.assert_refused(["run", "--join", "http://localhost"], "expected ws://HOST:PORT or wss://HOST:PORT")


if __name__ == "__main__":
    probe = subprocess.run([str(GAME), "run", "--join", "ws://127.0.0.1:1"], capture_output=True, check=False)
    if b"built with libwebsockets" in probe.stderr:
        print("built without libwebsockets")
        sys.exit(77)
    unittest.main()

#!/usr/bin/python3
"""terrane bench against a real server: bench_test.py TERRANE TERRANE_SERVER."""

import html.parser
import http.server
import itertools
import json
import pathlib
import signal
import socket
import socketserver
import subprocess
import sys
import tempfile
import threading
import unittest

TERRANE, SERVER = sys.argv[1:3]
EXIT_ERROR, EXIT_USAGE, EXIT_WORSE, EXIT_UNREACHABLE, EXIT_INTERRUPTED = 1, 2, 3, 4, 130
# So long that no machine is late; tests of deadlines have their own.
NO_HURRY = ("--deadline", "60s")


def start_server(*options):
    """A server on a free port: the process and its address."""
    server = subprocess.Popen(
        [SERVER, "--listen", "127.0.0.1:0", "--log-level", "error", *options],
        stdout=subprocess.PIPE, text=True)
    return server, server.stdout.readline().split()[-1]


def stop_server(server):
    server.send_signal(signal.SIGTERM)
    code = server.wait(40)
    server.stdout.close()
    return code


class DamagingProxy(socketserver.ThreadingTCPServer):
    """Hands on what two sides say, but for one byte in the middle of each long answer."""

    daemon_threads = True
    DAMAGED_BYTE = 50_000  # of a connection: amid the first tile

    def __init__(self, address):
        host, port = address.rsplit(":", 1)
        proxy = self

        class Connection(socketserver.BaseRequestHandler):
            def handle(self):
                with socket.create_connection((host, int(port))) as server:
                    threading.Thread(target=proxy.pump, args=(self.request, server), daemon=True).start()
                    proxy.pump(server, self.request, proxy.DAMAGED_BYTE)

        super().__init__(("127.0.0.1", 0), Connection)
        self.address = f"127.0.0.1:{self.server_address[1]}"

    @staticmethod
    def pump(source, sink, damaged_byte=None):
        passed = 0
        try:
            while data := bytearray(source.recv(1 << 16)):
                if damaged_byte is not None and passed <= damaged_byte < passed + len(data):
                    data[damaged_byte - passed] ^= 0x10
                passed += len(data)
                sink.sendall(data)
            sink.shutdown(socket.SHUT_WR)
        except OSError:  # a side is gone
            pass


class PageParser(html.parser.HTMLParser):
    """Counts the elements of a page that must close each one that it opens."""

    OPEN_ONLY = {"meta", "br"}

    def __init__(self):
        super().__init__()
        self.stack, self.counts = [], {}

    def handle_starttag(self, tag, attributes):
        self.counts[tag] = self.counts.get(tag, 0) + 1
        if tag not in self.OPEN_ONLY:
            self.stack.append(tag)

    def handle_startendtag(self, tag, attributes):
        self.counts[tag] = self.counts.get(tag, 0) + 1

    def handle_endtag(self, tag):
        if self.stack.pop() != tag:
            raise ValueError(f"</{tag}> closes another element")


class BenchTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.server, cls.address = start_server()

    @classmethod
    def tearDownClass(cls):
        assert stop_server(cls.server) == 0

    def setUp(self):
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = pathlib.Path(temporary.name)

    def bench(self, *arguments, expected=0, server=None):
        done = subprocess.run(
            [TERRANE, "bench", "--server", server or self.address, "--warm-up", "200ms", *map(str, arguments)],
            capture_output=True, text=True, timeout=120)
        self.assertEqual(done.returncode, expected, done.stdout + done.stderr)
        return done

    def report(self, *arguments, **options):
        return json.loads(self.bench(*arguments, "--json", "-", **options).stdout)

    def assert_sums(self, run):
        """Every offered request ended in exactly one way."""
        codes = sum(code["count"] for code in run["codes"])
        self.assertEqual(codes + run["not_started"] + run["unfinished"], run["offered"])
        self.assertGreater(run["offered"], 0)
        self.assertEqual(sum(kind["offered"] for kind in run["kinds"]), run["offered"])

    def test_closed_loop_over_every_kind_and_two_connections(self):
        report = self.report(
            "--duration", "3s", "--concurrency", 4, "--connections", 2, "--cold", 0.2, "--tile-size", 64, "--mix",
            "tiles=4,profiles=4,surfaces=1,trees=1,flowers=1", "--server-pid", self.server.pid, *NO_HURRY)
        run = report["runs"][0]
        self.assert_sums(run)
        self.assertEqual(run["connections"], 2)
        self.assertEqual({kind["kind"] for kind in run["kinds"]}, {"tiles", "profiles", "surfaces", "trees", "flowers"})
        self.assertEqual([code["code"] for code in run["codes"]], ["OK"], run["codes"])
        self.assertEqual(run["good"], run["offered"])
        self.assertAlmostEqual(run["goodput_per_second"], run["good"] / run["seconds"], places=6)
        latency = run["latency"]
        self.assertLessEqual(latency["p50_ms"], latency["p90_ms"])
        self.assertLessEqual(latency["p90_ms"], latency["p99_ms"])
        self.assertLessEqual(latency["p99_ms"], latency["max_ms"])
        self.assertEqual(latency["count"], run["good"])
        self.assertGreater(run["first_data"]["count"], 0)
        self.assertGreater(run["bytes_per_second"], run["samples_per_second"])
        self.assertGreater(run["server"]["cpus"], 0)
        self.assertGreater(run["server"]["memory_bytes"], 1e6)
        self.assertGreater(run["client"]["cpus"], 0)

    def test_metrics_of_the_server_are_read_over_http(self):
        class Metrics(http.server.BaseHTTPRequestHandler):
            readings = itertools.count(1)

            def do_GET(self):
                text = f"process_cpu_seconds_total {next(self.readings)}\nterrane_memory_bytes 5e6\n"
                self.send_response(200)
                self.end_headers()
                self.wfile.write(text.encode())

            def log_message(self, *_):
                pass

        with http.server.ThreadingHTTPServer(("127.0.0.1", 0), Metrics) as metrics:
            threading.Thread(target=metrics.serve_forever, daemon=True).start()
            url = f"http://127.0.0.1:{metrics.server_port}/metrics"
            usage = self.report("--duration", "3s", "--server-metrics", url, *NO_HURRY)["runs"][0]["server"]
            metrics.shutdown()
        self.assertEqual(usage["memory_peak_bytes"], 5e6)
        self.assertGreater(usage["cpus"], 0)

    def test_tiles_are_counted_sample_by_sample(self):
        run = self.report(
            "--duration", "3s", "--concurrency", 2, "--tile-size", 32, "--tiles-per-stream", 3, *NO_HURRY)["runs"][0]
        self.assertGreater(run["good"], 0)
        tiles = run["tiles_per_second"] * run["seconds"]
        self.assertAlmostEqual(tiles, 3 * run["good"], delta=0.01)
        self.assertAlmostEqual(run["samples_per_second"] * run["seconds"], tiles * 32 * 32, delta=1)
        self.assertAlmostEqual(run["bytes_per_second"] * run["seconds"], tiles * 32 * 32 * 4, delta=4)

    def test_open_loop_offers_the_rate_that_was_asked_for(self):
        run = self.report(
            "--rate", 100, "--arrivals", "even", "--duration", "1s", "--tile-size", 16, "--max-in-flight", 9999,
            *NO_HURRY)["runs"][0]
        self.assert_sums(run)
        self.assertEqual(run["loop"], "open")
        self.assertAlmostEqual(run["offered"], 100, delta=1)
        self.assertAlmostEqual(run["offered_per_second"], 100, delta=1)
        self.assertEqual(run["connections"], 100)  # one for every hundred calls in flight

    def test_page_stands_alone(self):
        page = self.folder / "report.html"
        text = self.bench("--duration", "3s", "--concurrency", 2, "--clients", 2, "--html", page, *NO_HURRY).stdout
        self.assertIn("closed loop, 2 callers, 2 connections", text)
        self.assertIn("goodput", text)
        self.assertIn("Jain index", text)
        content = page.read_text()
        parser = PageParser()
        parser.feed(content)
        self.assertEqual(parser.stack, [])
        self.assertEqual(parser.counts["svg"], 3)
        self.assertNotIn("script", parser.counts)
        self.assertNotIn("http", content)

    def test_a_report_that_cannot_be_written_costs_no_run(self):
        page = self.folder / "report.html"
        for paths in [["--html", self.folder / "none" / "report.html"],
                      ["--html", page, "--json", self.folder / "none" / "report.json"]]:
            done = self.bench("--duration", "1s", *paths, expected=1)
            self.assertEqual(done.stdout, "")
            self.assertIn("cannot create", done.stderr)
            self.assertEqual(list(self.folder.iterdir()), [])

    def test_comparison_tells_worse_from_equal(self):
        old = self.folder / "old.json"
        load = ["--duration", "3s", "--concurrency", 2, "--tile-size", 64, *NO_HURRY]
        self.bench(*load, "--json", old)
        report = json.loads(old.read_text())
        run = report["runs"][0]
        goodput = run["goodput_per_second"]
        run["goodput_per_second"] = goodput / 1000
        run["latency"]["p99_ms"] = run["latency_with_lost"]["p99_ms"] = 1e6
        old.write_text(json.dumps(report))
        done = self.bench(*load, "--compare", old)
        self.assertIn("ratio", done.stdout)
        self.assertNotIn("worse", done.stdout)
        run["goodput_per_second"] = goodput * 1000
        old.write_text(json.dumps(report))
        done = self.bench(*load, "--compare", old, expected=EXIT_WORSE)
        self.assertIn("worse", done.stdout)
        # Another load is refused before it begins.
        done = self.bench(*load, "--cold", 0.5, "--mix", "tiles=2,trees=1", "--compare", old, expected=EXIT_USAGE)
        self.assertIn("of another load: cold 0 against 0.5, mix tiles=1 against tiles=2,trees=1", done.stderr)
        self.assertEqual(done.stdout, "")

    def test_sweep_prints_a_table_and_finds_a_knee(self):
        page, data = self.folder / "sweep.html", self.folder / "sweep.json"
        done = self.bench(
            "--sweep-rates", "20,60", "--duration", "1s", "--tile-size", 32, "--json", data, "--html", page, *NO_HURRY)
        self.assertIn("| offered/s |", done.stdout)
        report = json.loads(data.read_text())
        self.assertEqual([run["rate"] for run in report["runs"]], [20, 60])
        self.assertGreater(report["sweep"]["peak_goodput"], 0)
        self.assertEqual(page.read_text().count("<svg"), 2 + 2 * 3)
        factors = self.report("--sweep", "0.5", "--duration", "3s", "--concurrency", 2, *NO_HURRY)
        self.assertEqual([run["loop"] for run in factors["runs"]], ["closed", "open"])
        self.assertAlmostEqual(factors["runs"][1]["rate"], factors["sweep"]["capacity"] / 2)

    def test_interrupt_leaves_the_results_so_far(self):
        data = self.folder / "report.json"
        bench = subprocess.Popen(
            [TERRANE, "bench", "--server", self.address, "--warm-up", "100ms", "--duration", "10m", "--json", data,
             "--progress", "json", *NO_HURRY],
            stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        for line in bench.stderr:  # one a second
            self.assertIn("in_flight", line)
            if json.loads(line)["ok_per_second"] > 0:
                break
        bench.send_signal(signal.SIGINT)
        text, _ = bench.communicate(timeout=30)
        self.assertEqual(bench.returncode, EXIT_INTERRUPTED)
        self.assertIn("goodput", text)
        report = json.loads(data.read_text())
        self.assertTrue(report["interrupted"])
        self.assert_sums(report["runs"][0])

    def test_wrong_use_is_said(self):
        for options in [["--mix", "rocks=1"], ["--rate", "5", "--concurrency", "2"], ["--duration", "5 parsecs"],
                        ["--server", "nowhere"], ["--tolerance", "0.1"], ["--local"]]:
            done = subprocess.run([TERRANE, "bench", *options], capture_output=True, text=True, timeout=30)
            self.assertEqual(done.returncode, 2, options)
        self.bench("--tiles-preset", "no/such", expected=EXIT_ERROR)
        self.bench("--tiles-preset", "fbm/fig04b", expected=EXIT_ERROR)
        self.bench("--server-pid", 2**31 - 1, expected=EXIT_ERROR)
        self.bench("--duration", "100ms", server="127.0.0.1:1", expected=EXIT_UNREACHABLE)

    def test_more_calls_than_a_connection_takes_are_warned_of(self):
        load = ["--concurrency", 300, "--tile-size", 1, "--duration", "100ms", *NO_HURRY]
        self.assertIn("warning: up to 300 calls to a connection", self.bench(*load, "--connections", 1).stderr)
        self.assertNotIn("warning", self.bench(*load, "--connections", 2).stderr)
        self.assertNotIn("warning", self.bench(*load).stderr)

    def test_one_byte_damaged_on_the_way_is_an_error(self):
        data = self.folder / "report.json"
        with DamagingProxy(self.address) as proxy:
            threading.Thread(target=proxy.serve_forever, daemon=True).start()
            done = self.bench("--duration", "3s", "--concurrency", 1, "--connections", 1, "--json", data, *NO_HURRY,
                              server=proxy.address, expected=EXIT_ERROR)
            proxy.shutdown()
        self.assertIn("1 answers were damaged", done.stderr)
        # The first answer was it, in the warm-up, which is not measured.
        self.assertEqual(json.loads(data.read_text())["runs"][0]["damaged"], 1)

    def test_server_that_goes_away_is_unreachable(self):
        server, address = start_server()
        data = self.folder / "report.json"
        bench = subprocess.Popen(
            [TERRANE, "bench", "--server", address, "--warm-up", "8s", "--duration", "1s", "--concurrency", "2", "--json", data,
             "--progress", "json", *NO_HURRY], stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
        bench.stderr.readline()  # the load has begun
        server.kill()
        server.wait()
        server.stdout.close()
        _, errors = bench.communicate(timeout=120)
        self.assertEqual(bench.returncode, EXIT_UNREACHABLE, errors)
        self.assertIn("ended well", errors)
        run = json.loads(data.read_text())["runs"][0]
        self.assertEqual([code["code"] for code in run["codes"]], ["UNAVAILABLE"])
        # Its callers wait before they ask again.
        self.assertLessEqual(run["offered"], 2 * 10 + 2)

    def test_refused_calls_show_as_resource_exhausted(self):
        server, address = start_server("--workers", "1", "--max-streams", "1")
        try:
            run = self.report(
                "--rate", 150, "--duration", "1s", "--tile-size", 1024, "--cold", 1, "--tiles-per-stream", 4, *NO_HURRY,
                server=address)["runs"][0]
        finally:
            stop_server(server)
        self.assert_sums(run)
        codes = {code["code"]: code["count"] for code in run["codes"]}
        self.assertGreater(codes.get("RESOURCE_EXHAUSTED", 0), 0, codes)
        self.assertEqual(run["refusal"]["count"], codes["RESOURCE_EXHAUSTED"])
        self.assertLess(run["good"], run["offered"])


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])

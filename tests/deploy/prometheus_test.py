#!/usr/bin/python3
"""Alert rules, their tests, the dashboard and a live scrape, by promtool.

Usage: prometheus_test.py TERRANE TERRANE_SERVER BUILD_DIR [unittest arguments]
"""

import json
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

import processes

TERRANE, SERVER, BUILD_DIR = sys.argv[1:4]
PROMETHEUS = processes.DEPLOY / "prometheus"
DASHBOARD = processes.DEPLOY / "grafana" / "terrane.json"
METRIC = re.compile(r"\bterrane_\w+")


def promtool(*arguments, **options):
    return subprocess.run([PROMTOOL, *map(str, arguments)], capture_output=True, text=True, timeout=60, **options)


def dashboard_expressions():
    """Every query of the dashboard, with Grafana's variables filled in."""
    panels = json.loads(DASHBOARD.read_text(encoding="utf-8"))["panels"]
    queries = [target["expr"] for panel in panels for target in panel["targets"]]
    return [query.replace("$__rate_interval", "5m").replace("$instance", ".*") for query in queries]


def adapter_query(field, **parts):
    """A query of prometheus-adapter's rule, with the parts that the adapter fills in."""
    query = re.search(f"{field}: '(.*)'", (PROMETHEUS / "adapter.yaml").read_text(encoding="utf-8"))[1]
    return re.sub(r"<<\.(\w+)>>", lambda part: parts[part[1]], query)


class RulesTest(unittest.TestCase):
    def setUp(self):
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = pathlib.Path(temporary.name)

    def check(self, *arguments):
        done = promtool(*arguments)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)

    def test_rules_and_configuration_are_valid(self):
        self.check("check", "rules", PROMETHEUS / "alerts.yaml")
        self.check("check", "config", PROMETHEUS / "prometheus.yml")

    def test_alerts_fire_when_they_should(self):
        self.check("test", "rules", PROMETHEUS / "alerts_test.yaml")

    def test_every_alert_has_a_test(self):
        alerts = re.findall(r"- alert: (\w+)", (PROMETHEUS / "alerts.yaml").read_text(encoding="utf-8"))
        tests = (PROMETHEUS / "alerts_test.yaml").read_text(encoding="utf-8")
        fired = set(re.findall(r"alertname: (\w+)\n\s+eval_time: \S+\n\s+exp_alerts:\n\s+- exp_labels", tests))
        self.assertEqual(fired, set(alerts))

    def test_a_wrong_threshold_fails_the_rule_tests(self):
        rules = (PROMETHEUS / "alerts.yaml").read_text(encoding="utf-8")
        wrong = rules.replace('sum by (instance) (terrane_workers) > 5', 'sum by (instance) (terrane_workers) > 50')
        self.assertNotEqual(wrong, rules)
        (self.folder / "alerts.yaml").write_text(wrong, encoding="utf-8")
        (self.folder / "alerts_test.yaml").write_bytes((PROMETHEUS / "alerts_test.yaml").read_bytes())
        self.assertNotEqual(promtool("test", "rules", self.folder / "alerts_test.yaml").returncode, 0)

    def test_the_dashboards_queries_parse(self):
        rules = [{"record": f"query{n}", "expr": query} for n, query in enumerate(dashboard_expressions())]
        self.assertGreater(len(rules), 10)
        # JSON is YAML.
        (self.folder / "rules.yaml").write_text(json.dumps({"groups": [{"name": "dashboard", "rules": rules}]}))
        self.check("check", "rules", self.folder / "rules.yaml")

    def test_the_autoscaler_gets_what_a_pod_has_of_both_classes(self):
        autoscaler = (processes.DEPLOY / "helm/terrane/templates/autoscaler.yaml").read_text(encoding="utf-8")
        metric = re.search(r"metric:\n\s+name: (\w+)", autoscaler)[1]
        backlogs = {'namespace="maps",pod="a",class="interactive"': 3, 'namespace="maps",pod="a",class="batch"': 40,
                    'namespace="maps",pod="b",class="batch"': 5, 'namespace="maps",pod="c",class="batch"': 6,
                    'namespace="other",pod="a",class="batch"': 700, 'namespace="maps",class="batch"': 8000}
        # Asked as for two pods of one namespace.
        per_pod = adapter_query("metricsQuery", Series=metric, LabelMatchers='namespace="maps",pod=~"a|b"', GroupBy="pod")
        known = f"count({adapter_query('seriesQuery')})"
        tests = {"evaluation_interval": "1m", "tests": [{
            "interval": "1m",
            "input_series": [{"series": f"{metric}{{{labels}}}", "values": str(value)} for labels, value in backlogs.items()],
            "promql_expr_test": [
                {"expr": per_pod, "eval_time": "0m", "exp_samples": [{"labels": '{pod="a"}', "value": 43},
                                                                     {"labels": '{pod="b"}', "value": 5}]},
                {"expr": known, "eval_time": "0m", "exp_samples": [{"labels": "{}", "value": 5}]}]}]}
        (self.folder / "adapter_test.yaml").write_text(json.dumps(tests))
        self.check("test", "rules", self.folder / "adapter_test.yaml")


class ScrapeTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.replica = processes.Replica(SERVER, "--memory-limit-mib", "4096")
        cls.addClassCleanup(cls.stop)
        cls.address = f"127.0.0.1:{cls.replica.port}"
        with tempfile.TemporaryDirectory() as folder:
            cls.ask("terrain", "--seed", "1", "--window", "0,0,300,200", "--out", f"{folder}/a.f32")
            cls.ask("tree", "--preset", "tree/genetic", "--out", f"{folder}/tree.glb")
        processes.wait_until(cls.both_are_counted, "two calls in the metrics")

    @classmethod
    def stop(cls):
        assert cls.replica.stop() == 0

    @classmethod
    def both_are_counted(cls):
        """Whether a scrape, which is kept, has both calls: a call is counted after its answer."""
        _, cls.scrape = processes.get(cls.replica.url("/metrics"))
        return all(re.search(rf'^terrane_rpc_total\{{.*code="OK".*method="{method}".*\}} [1-9]', cls.scrape, re.MULTILINE)
                   for method in ("StreamTiles", "StreamTreeMesh"))

    @classmethod
    def ask(cls, *arguments):
        subprocess.run([TERRANE, *arguments, "--server", cls.address], check=True, capture_output=True, timeout=60)

    def test_promtool_has_nothing_to_say_about_a_live_scrape(self):
        done = promtool("check", "metrics", input=self.scrape)
        self.assertEqual((done.returncode, done.stdout, done.stderr), (0, "", ""))

    def test_every_metric_and_label_that_is_asked_for_exists(self):
        series = set(re.findall(r"^(terrane_\w+)", self.scrape, re.MULTILINE))
        rules = (PROMETHEUS / "alerts.yaml").read_text(encoding="utf-8")
        chart = "".join(p.read_text(encoding="utf-8") for p in (processes.DEPLOY / "helm").rglob("*.yaml"))
        expressions = re.findall(r"expr: (.*?)\n\s+for:", rules, re.DOTALL) + dashboard_expressions()
        expressions.append(adapter_query("seriesQuery"))
        asked = set(METRIC.findall(" ".join(expressions))) | set(re.findall(r"\bterrane_backlog\w+", chart))
        self.assertGreater(len(asked), 10)
        self.assertEqual(asked - series, set())
        labels = set(re.findall(r'(\w+)(?:=~|=)"', " ".join(expressions))) - {"job", "instance"}
        self.assertEqual({label for label in labels if f'{label}="' not in self.scrape}, set())

    def test_what_was_asked_was_counted(self):
        self.assertRegex(self.scrape, r'terrane_samples_total\{method="StreamTiles"\} 60000\b')
        self.assertRegex(self.scrape, r'terrane_rpc_total\{[^}]*code="OK"[^}]*method="StreamTiles"[^}]*\} 1\b')
        self.assertEqual(processes.get(self.replica.url("/livez"))[0], 200)


if __name__ == "__main__":
    fetched = subprocess.run([pathlib.Path(__file__).parent / "debian_program.sh", BUILD_DIR, "prometheus",
                              "usr/bin/promtool"], stdout=subprocess.PIPE, text=True)
    if fetched.returncode:
        sys.exit(fetched.returncode)
    PROMTOOL = fetched.stdout.strip()
    unittest.main(argv=sys.argv[:1] + sys.argv[4:])

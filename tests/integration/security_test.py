#!/usr/bin/python3
"""TLS, client certificates, tokens and limits of clients, with the real programs.

Certificates are made by the openssl command, tokens by PyJWT: neither is what the
server checks them with.

Usage: security_test.py TERRANE TERRANE_SERVER STUBS [unittest arguments]
"""

import base64
import collections
import contextlib
import hashlib
import hmac
import json
import os
import pathlib
import subprocess
import tempfile
import time
import unittest

import grpc
import jwt
from grpc import StatusCode

from edge import INFO, TILES, Authority, all_methods, call, endless, key_pair
from real_server import PATIENCE_SECONDS, SERVER, TERRANE, RealServer, common_pb2, main, served, tiles_request, wait_until

METHODS = all_methods()
ISSUER, AUDIENCE = "https://issuer.test", "terrane"


class EdgeTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        temporary = tempfile.TemporaryDirectory()
        cls.addClassCleanup(temporary.cleanup)
        cls.folder = pathlib.Path(temporary.name)

    def refused_start(self, *flags, code, listen="127.0.0.1:0"):
        """What a server says that does not start."""
        done = subprocess.run([SERVER, "--listen", listen, *map(str, flags)], capture_output=True, text=True,
                              timeout=PATIENCE_SECONDS)
        self.assertEqual(done.returncode, code, done.stderr)
        return done.stderr

    def assert_refused(self, answer, code, reason):
        self.assertEqual(answer[0], code, answer[1])
        details = common_pb2.ErrorStatus.FromString(answer[2]["grpc-status-details-bin"])
        info = next(d for d in details.details if d.type_url.endswith("ErrorInfo"))
        self.assertEqual(common_pb2.ErrorInfo.FromString(info.value).reason, reason)

    def terrane(self, *arguments, expected=0, **environment):
        done = subprocess.run([TERRANE, *map(str, arguments)], capture_output=True, text=True, timeout=60,
                              env={**os.environ, **{name: str(value) for name, value in environment.items()}})
        self.assertEqual(done.returncode, expected, done.stderr)
        return done.stderr


class TlsTest(EdgeTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.authority, cls.stranger = Authority(cls.folder, "authority"), Authority(cls.folder, "stranger")
        cls.certificate, cls.key = cls.authority.issue("server")
        cls.tls = ["--tls-cert", cls.certificate, "--tls-key", cls.key]

    def channel(self, server, certificate=None, key=None):
        return grpc.secure_channel(server.address, grpc.ssl_channel_credentials(
            self.authority.certificate.read_bytes(), key and key.read_bytes(), certificate and certificate.read_bytes()))

    def presented(self, server, *flags):
        """The serial number of the certificate that a handshake shows; None if it fails."""
        # What HTTP/2 says after the handshake is no text.
        done = subprocess.run(["openssl", "s_client", "-connect", server.address, "-alpn", "h2", *flags], input="", text=True,
                              errors="replace", capture_output=True, timeout=PATIENCE_SECONDS)
        if "BEGIN CERTIFICATE" not in done.stdout:
            return None
        return subprocess.run(["openssl", "x509", "-noout", "-serial"], input=done.stdout, text=True, capture_output=True).stdout

    def test_calls_go_over_tls_1_2_or_later_and_nothing_else(self):
        with served(*self.tls) as server:
            with self.channel(server) as channel:
                self.assertEqual(call(channel, INFO)[0], StatusCode.OK)
            with grpc.insecure_channel(server.address) as channel:
                self.assertEqual(call(channel, INFO)[0], StatusCode.UNAVAILABLE)
            self.assertTrue(self.presented(server, "-tls1_2"))
            self.assertTrue(self.presented(server, "-tls1_3"))
            self.assertIsNone(self.presented(server, "-tls1_1", "-cipher", "DEFAULT@SECLEVEL=0"))

    def test_a_new_certificate_is_taken_while_calls_go_on(self):
        files = [self.folder / "live.pem", self.folder / "live.key"]
        for source, file in zip((self.certificate, self.key), files):
            file.write_bytes(source.read_bytes())
        with served("--tls-cert", files[0], "--tls-key", files[1]) as server, self.channel(server) as channel:
            self.assertEqual(call(channel, INFO)[0], StatusCode.OK)
            before = self.presented(server)
            for source, file in zip(self.authority.issue("renewed"), files):
                source.rename(file)
            self.assertTrue(wait_until(lambda: self.presented(server) not in (before, None)), "the new certificate is not used")
            self.assertEqual(call(channel, INFO)[0], StatusCode.OK)

    def test_a_client_certificate_is_demanded_and_checked(self):
        with served(*self.tls, "--tls-client-ca", self.authority.certificate) as server:
            with self.channel(server, *self.authority.issue("client")) as channel:
                self.assertEqual(call(channel, INFO)[0], StatusCode.OK)
            for pair in [(), self.stranger.issue("client")]:
                with self.channel(server, *pair) as channel:
                    self.assertEqual(call(channel, INFO)[0], StatusCode.UNAVAILABLE)

    def test_wrong_files_stop_the_start_and_name_their_flag(self):
        _, other_key = self.authority.issue("other")
        for flags, text in [(["--tls-cert", "no-file", "--tls-key", self.key], "--tls-cert no-file cannot be read"),
                            (["--tls-cert", self.key, "--tls-key", self.key], "must hold a certificate in PEM"),
                            (["--tls-cert", self.certificate, "--tls-key", "no-file"], "--tls-key no-file cannot be read"),
                            (["--tls-cert", self.certificate, "--tls-key", other_key], "is not the key of the certificate"),
                            ([*self.tls, "--tls-client-ca", "no-file"], "--tls-client-ca no-file cannot be read")]:
            self.assertIn(text, self.refused_start(*flags, code=1))
        self.assertIn("--tls-key", self.refused_start("--tls-cert", self.certificate, code=2))

    def test_other_machines_are_served_only_with_tls_or_on_demand(self):
        self.assertIn("reachable from other machines", self.refused_start(listen="0.0.0.0:0", code=2))
        with served(*self.tls, listen="0.0.0.0:0") as server, self.channel(server) as channel:
            self.assertEqual(call(channel, INFO)[0], StatusCode.OK)

    def test_the_command_line_client_speaks_it(self):
        certificate, key = self.authority.issue("cli")
        mutual = ["--tls-client-ca", self.authority.certificate]
        with served(*self.tls, *mutual) as server:
            ask = ["info", "--server", server.address]
            self.terrane(*ask, "--tls", "--tls-ca", self.authority.certificate, "--tls-cert", certificate, "--tls-key", key)
            self.terrane(*ask, TERRANE_TLS="true", TERRANE_TLS_CA=self.authority.certificate, TERRANE_TLS_CERT=certificate,
                         TERRANE_TLS_KEY=key)
            self.terrane(*ask, expected=4)
            self.terrane(*ask, "--tls", "--tls-ca", self.stranger.certificate, expected=4)
            self.assertIn("--tls-key", self.terrane(*ask, "--tls", "--tls-cert", certificate, expected=2))
            self.assertIn("--tls", self.terrane(*ask, "--tls-ca", self.authority.certificate, expected=2))

    def test_the_client_checks_replicas_against_one_name(self):
        with served(*self.tls) as first, served(*self.tls) as second:
            ask = ["info", "--server", f"{first.address},{second.address}", "--tls", "--tls-ca", self.authority.certificate]
            self.terrane(*ask, "--tls-name", "localhost")
            self.terrane(*ask, TERRANE_TLS_NAME="localhost")
            self.terrane(*ask, "--tls-name", "server.test", expected=4)
            self.assertIn("--tls-name", self.terrane(*ask, expected=1))


class TokenTest(EdgeTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.private, cls.public = key_pair(cls.folder, "rsa", "RSA", "rsa_keygen_bits:2048")
        cls.ec_private, cls.ec_public = key_pair(cls.folder, "ec", "EC", "ec_paramgen_curve:P-256")
        cls.server = RealServer("--jwt-key", cls.public, "--jwt-issuer", ISSUER, "--jwt-audience", AUDIENCE)
        cls.channel = grpc.insecure_channel(cls.server.address)

    @classmethod
    def tearDownClass(cls):
        cls.channel.close()
        assert cls.server.end() == 0

    def claims(self, **changes):
        claims = {"iss": ISSUER, "aud": AUDIENCE, "sub": "alice", "exp": int(time.time()) + 600, "scope": "terrane.read"}
        return {name: value for name, value in {**claims, **changes}.items() if value is not None}

    def token(self, key=None, algorithm="RS256", **changes):
        return jwt.encode(self.claims(**changes), (key or self.private).read_text(), algorithm)

    def call(self, token=None, method=INFO, **options):
        return call(self.channel, method, metadata=[("authorization", f"Bearer {token}")] if token else [], **options)

    def test_every_method_asks_for_a_token_with_its_scope(self):
        scopes = {scope: self.token(scope=f"terrane.{scope}") for scope in ("read", "generate", "upload")}
        self.assertGreater(len(METHODS), 20)
        for method in METHODS:
            with self.subTest(method):
                self.assert_refused(self.call(method=method), StatusCode.UNAUTHENTICATED, "TOKEN_MISSING")
                self.assert_refused(self.call(self.token(scope="other"), method), StatusCode.PERMISSION_DENIED, "SCOPE_MISSING")
                name = method.rsplit("/", 1)[1]
                own = ("upload" if name.startswith("Upload") else
                       "read" if name.startswith("Estimate") or name == "GetServerInfo" or name.endswith("Preset")
                       or name in ("GetRaster", "GetSpotTable") else "generate")
                for scope, token in scopes.items():
                    code = self.call(token, method)[0]
                    if scope == own:
                        self.assertNotIn(code, (StatusCode.UNAUTHENTICATED, StatusCode.PERMISSION_DENIED))
                    else:
                        self.assertEqual(code, StatusCode.PERMISSION_DENIED)

    def test_health_is_open(self):
        self.assertEqual(self.call(method="/grpc.health.v1.Health/Check")[0], StatusCode.OK)

    def test_good_tokens(self):
        now = int(time.time())
        for changes in [{}, {"aud": ["other", AUDIENCE]}, {"scope": "a terrane.read b"}, {"nbf": now}, {"exp": now - 10}, {"nbf": now + 10}]:
            self.assertEqual(self.call(self.token(**changes))[0], StatusCode.OK, changes)

    def test_a_known_token_expires_all_the_same(self):
        made = 0
        while time.time() - made > 2:  # known while it was good, however slow the machine
            made = time.time()
            token = self.token(exp=int(made) - 27)
            answer = self.call(token)
        self.assertEqual(answer[0], StatusCode.OK)
        time.sleep(5)
        self.assert_refused(self.call(token), StatusCode.UNAUTHENTICATED, "TOKEN_INVALID")

    def hand_made(self, header, payload, secret=b""):
        """A token with an HMAC, or none, whatever the header says."""
        def encode(data):
            return base64.urlsafe_b64encode(data).rstrip(b"=").decode()
        text = encode(header.encode()) + "." + encode(payload.encode())
        return text + "." + encode(hmac.digest(secret, text.encode(), hashlib.sha256))

    def test_bad_tokens(self):
        now = int(time.time())
        good = self.token()
        header, payload, signature = good.split(".")
        claims = json.dumps(self.claims())
        stranger, _ = key_pair(self.folder, "stranger", "RSA", "rsa_keygen_bits:2048")
        bad = [self.token(**changes) for changes in [
            {"exp": now - 60}, {"exp": None}, {"exp": -1000}, {"nbf": now + 120}, {"iss": "other"}, {"iss": None}, {"aud": "other"},
            {"aud": None}, {"aud": ["other"]}, {"sub": None}, {"sub": ""}, {"sub": "a" * 300}]]
        bad += [
            self.token(stranger), self.token(self.ec_private, "ES256"), self.token(algorithm="RS512"),
            self.hand_made('{"alg":"HS256","typ":"JWT"}', claims, self.public.read_bytes()),
            self.hand_made('{"alg":"none"}', claims), self.hand_made('{"alg":"none"}', claims).rsplit(".", 1)[0] + ".",
            self.hand_made('{"alg":"RS256"}', claims), self.hand_made('{"alg":7}', claims), self.hand_made('{}', claims),
            self.hand_made('[]', claims), self.hand_made('7', claims), self.hand_made('{"alg":"RS256"}', '[]'),
            self.hand_made('{"alg":"RS256"}', "[" * 3000), self.hand_made('{"alg":"RS256"}', '{"exp":"soon"}'),
            self.hand_made('{"alg":"RS256"}', '{"a":' * 500 + "1" + "}" * 500),
            f"{header}.{payload[:-4]}AAAA.{signature}", f"{header}.{payload}.{signature[:-8]}", f"{header}.{payload}.",
            f"{header}.{payload}", header, "..", ".", "a.b.c", f"{good}.{signature}", f"{header}.{payload}.{signature}=", "*.*.*",
            good.replace(".", "~"), f" {good}"]
        logged = len(self.server.calls())
        for token in bad:
            self.assert_refused(self.call(token), StatusCode.UNAUTHENTICATED, "TOKEN_INVALID")
        twice = call(self.channel, INFO, metadata=[("authorization", f"Bearer {good}")] * 2)
        self.assert_refused(twice, StatusCode.UNAUTHENTICATED, "TOKEN_MISSING")
        self.assertEqual(self.call(good)[0], StatusCode.OK)
        self.assertTrue(wait_until(lambda: len(self.server.calls()) >= logged + len(bad) + 2))
        log = self.server.log_text()
        self.assertIn("TOKEN_INVALID", log)
        for secret in (header, payload, signature, "alice"):
            self.assertNotIn(secret, log)

    def test_the_key_decides_on_the_algorithm(self):
        with served("--jwt-key", self.ec_public) as server, grpc.insecure_channel(server.address) as channel:
            for token, code in [(self.token(self.ec_private, "ES256"), StatusCode.OK), (self.token(), StatusCode.UNAUTHENTICATED)]:
                self.assertEqual(call(channel, INFO, metadata=[("authorization", f"Bearer {token}")])[0], code)

    def test_while_a_key_changes_tokens_of_both_are_taken(self):
        with served("--jwt-key", self.ec_public, "--jwt-key", self.public) as server, grpc.insecure_channel(server.address) as channel:
            expired = self.token(exp=int(time.time()) - 100)
            for token, code, text in [(self.token(self.ec_private, "ES256"), StatusCode.OK, ""), (self.token(), StatusCode.OK, ""),
                                      (expired, StatusCode.UNAUTHENTICATED, "has expired"),
                                      (self.token(key_pair(self.folder, "third", "EC", "ec_paramgen_curve:P-256")[0], "ES256"),
                                       StatusCode.UNAUTHENTICATED, "signed by no key")]:
                answer = call(channel, INFO, metadata=[("authorization", f"Bearer {token}")])
                self.assertEqual(answer[0], code, answer[1])
                self.assertIn(text, answer[1])

    def test_keys_that_will_not_do_stop_the_start(self):
        _, short = key_pair(self.folder, "short", "RSA", "rsa_keygen_bits:1024")
        _, curve = key_pair(self.folder, "curve", "EC", "ec_paramgen_curve:P-384")
        for file, text in [("no-file", "cannot be read"), (self.private, "must hold a public key"), (short, "2048 bits"),
                           (curve, "P-256")]:
            self.assertIn(text, self.refused_start("--jwt-key", file, code=1))
        self.assertIn("--jwt-key", self.refused_start("--jwt-issuer", ISSUER, code=2))

    def test_the_command_line_client_brings_it(self):
        file = self.folder / "token.txt"
        file.write_text(self.token() + "\n")
        self.assertIn("bearer token", self.terrane("info", "--server", self.server.address, expected=1))
        self.terrane("info", "--server", self.server.address, "--token-file", file)
        self.terrane("info", "--server", self.server.address, TERRANE_TOKEN_FILE=file)
        for other in ("server.test:50051", "10.0.0.1:1", "127.server.test:1"):
            refusal = self.terrane("info", "--server", other, "--token-file", file, expected=1)
            self.assertIn(f"would go to {other}", refusal)
        file.write_text("two words")
        self.assertIn("must hold one token", self.terrane("info", "--server", self.server.address, "--token-file", file, expected=1))


class ClientLimitTest(EdgeTest):
    def assert_told_to_wait(self, answer, reason):
        """How many seconds."""
        self.assert_refused(answer, StatusCode.RESOURCE_EXHAUSTED, reason)
        milliseconds = int(answer[2]["grpc-retry-pushback-ms"])
        self.assertGreater(milliseconds, 0)
        return milliseconds / 1000

    def assert_counts(self, channel, one, other):
        stream = endless(channel, one)
        self.assert_told_to_wait(call(channel, INFO, metadata=one), "TOO_MANY_CALLS")
        self.assertEqual(call(channel, INFO, metadata=other)[0], StatusCode.OK)
        stream.cancel()
        self.assertTrue(wait_until(lambda: call(channel, INFO, metadata=one)[0] == StatusCode.OK), "the place is not free again")

    def test_a_subject_has_its_places(self):
        private, public = key_pair(self.folder, "limit", "EC", "ec_paramgen_curve:P-256")
        alice, bob = ([("authorization", "Bearer " + jwt.encode(
            {"sub": name, "exp": int(time.time()) + 600, "scope": "terrane.read terrane.generate"}, private.read_text(), "ES256"))]
            for name in ("alice", "bob"))
        with served("--jwt-key", public, "--client-streams", 1) as server:
            with grpc.insecure_channel(server.address) as channel:
                self.assert_counts(channel, alice, bob)

    def test_a_certificate_has_its_places(self):
        authority = Authority(self.folder, "authority")
        certificate, key = authority.issue("server")
        with contextlib.ExitStack() as stack:
            server = stack.enter_context(served("--tls-cert", certificate, "--tls-key", key, "--tls-client-ca",
                                                authority.certificate, "--client-streams", 1))
            channels = []
            for name in ("alice", "bob"):
                pair = authority.issue(name, names=f"DNS:{name}")
                channels.append(stack.enter_context(grpc.secure_channel(server.address, grpc.ssl_channel_credentials(
                    authority.certificate.read_bytes(), pair[1].read_bytes(), pair[0].read_bytes()))))
            alice, bob = channels
            stream = endless(alice)
            self.assert_told_to_wait(call(alice, INFO), "TOO_MANY_CALLS")
            self.assertEqual(call(bob, INFO)[0], StatusCode.OK)
            stream.cancel()

    def test_a_host_behind_the_proxy_has_its_places(self):
        one, other = [("x-forwarded-for", "9.9.9.9, 10.0.0.1")], [("x-forwarded-for", "10.0.0.1, 2001:db8::1")]
        neighbour = [("x-forwarded-for", "2001:db8::2")]
        with served("--trust-forwarded-for", "--client-streams", 1) as server:
            with grpc.insecure_channel(server.address) as channel:
                self.assert_counts(channel, one, other)
                # An IPv6 network is one client.
                stream = endless(channel, neighbour)
                self.assert_told_to_wait(call(channel, INFO, metadata=other), "TOO_MANY_CALLS")
                stream.cancel()
                # What is no address counts for the proxy itself.
                self.assert_counts(channel, [("x-forwarded-for", "nonsense")], one)

    def test_without_trust_the_header_is_nothing(self):
        with served("--client-streams", 1) as server, grpc.insecure_channel(server.address) as channel:
            stream = endless(channel, [("x-forwarded-for", "10.0.0.1")])
            self.assertEqual(call(channel, INFO, metadata=[("x-forwarded-for", "10.0.0.2")])[0], StatusCode.RESOURCE_EXHAUSTED)
            stream.cancel()

    ONE, OTHER = [("x-forwarded-for", "10.0.0.1")], [("x-forwarded-for", "10.0.0.2")]

    def test_a_client_has_its_rate(self):
        with served("--trust-forwarded-for", "--client-rate", 0.5) as server, server.channel() as channel:
            taken, begun = 0, time.monotonic()
            while (answer := call(channel, INFO, metadata=self.ONE))[0] == StatusCode.OK:
                taken += 1
            # What comes in ten seconds, the call that overdraws it, and what came meanwhile.
            self.assertGreaterEqual(taken, 6)
            self.assertLessEqual(taken, 7 + 0.5 * (time.monotonic() - begun))
            wait = self.assert_told_to_wait(answer, "CALL_RATE_EXCEEDED")
            self.assertLessEqual(wait, 2)
            self.assertEqual(call(channel, INFO, metadata=self.OTHER)[0], StatusCode.OK)
            time.sleep(wait)
            self.assertEqual(call(channel, INFO, metadata=self.ONE)[0], StatusCode.OK)

    def test_limits_that_make_no_sense_stop_the_start(self):
        for flags, text in [(("--client-rate", "nan"), "--client-rate: Value nan not in"),
                            (("--grace-seconds", "inf"), "--grace-seconds: Value inf not in"),
                            (("--memory-limit-mib", 100, "--raster-store-mib", 60, "--prepared-mib", 60),
                             "must be at most 100 together, the memory limit in MiB, got 120")]:
            self.assertIn(text, self.refused_start(*flags, code=2))

    def test_refusals_cost_a_client_nothing(self):
        with served("--trust-forwarded-for", "--client-rate", 0.01) as server, server.channel() as channel:
            self.assertEqual(call(channel, INFO, metadata=self.ONE)[0], StatusCode.OK)
            waits = [self.assert_told_to_wait(call(channel, INFO, metadata=self.ONE), "CALL_RATE_EXCEEDED") for _ in range(10)]
            self.assertEqual(waits, sorted(waits, reverse=True))

    def test_a_client_pays_for_its_work(self):
        workers = 0.001
        with served("--trust-forwarded-for", "--client-workers", workers) as server, server.channel() as channel:
            request = tiles_request(level=12, window=(0, 0, 4096, 4096)).SerializeToString()
            begun = time.monotonic()
            self.assertEqual(call(channel, TILES, request, metadata=self.ONE)[0], StatusCode.OK)
            self.assertTrue(wait_until(server.calls))
            worked = server.calls()[0]["generate_ms"] / 1000
            wait = self.assert_told_to_wait(call(channel, INFO, metadata=self.ONE), "WORK_RATE_EXCEEDED")
            # What came meanwhile is paid back.
            passed = time.monotonic() - begun
            self.assertTrue(-passed - 1 < wait - (worked / workers - 10) < 1, (wait, worked, passed))
            self.assertEqual(call(channel, INFO, metadata=self.OTHER)[0], StatusCode.OK)
            self.assertTrue(wait_until(lambda: len(server.calls()) == 3))
            self.assertEqual(collections.Counter(line.get("reason") for line in server.calls()), {None: 2, "client_limit": 1})


if __name__ == "__main__":
    main()

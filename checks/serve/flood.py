"""Floods `fspid serve`, and says how a person is answered meanwhile.

Every kind of flood is a thread that goes on until the time is over, some of them several. What each has done is counted and
printed, so that a flood that never reached the server cannot pass for one that it withstood.
"""
import json
import os
import random
import re
import socket
import statistics
import subprocess
import sys
import tempfile
import threading
import time
from collections import Counter
from pathlib import Path

MOST_GROWTH_MIB = 64
"""Memory that the server may have at most beyond what it had before: buffers of 64 connections and 16 streams, and what an
allocator keeps."""
ASKED_EVERY_S = 0.5
MOST_ANSWER_S = 5.0
"""Longest that a person may wait for an answer: that of a connection which the system offers anew, after 1 s and after 3 s."""
SCENARIO = Path("scenarios/747-pitch-step.toml")


class Server:
    """The program, as somebody would start it."""

    def __init__(self, program, folder):
        (folder / "mine.toml").write_bytes(SCENARIO.read_bytes())
        command = [program, "serve", str(folder), "--port", "0", "--telemetry", "udp:0", "--format", "json"]
        self.process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True)
        # Over several lines, the last of which closes the object.
        told = json.loads("".join(iter(self.process.stdout.readline, "}\n")) + "}")
        self.token, self.telemetry = told["token"], told["telemetry_port"]
        self.port = told["port"]
        self.host = f"127.0.0.1:{self.port}"

    def connect(self, timeout=10.0):
        return socket.create_connection(("127.0.0.1", self.port), timeout=timeout)

    def head(self, method, path, more="", host=None, token=None):
        return f"{method} {path} HTTP/1.1\r\nHost: {host or self.host}\r\nX-Fspid-Token: {token or self.token}\r\n{more}\r\n".encode()

    def ask(self, path):
        """Asks as the page does; the answer's JSON."""
        with self.connect() as stream:
            stream.sendall(self.head("GET", path, "Connection: close\r\n"))
            answer = b"".join(iter(lambda: stream.recv(65536), b""))
        if not answer.startswith(b"HTTP/1.1 200"):
            raise OSError(f"{path}: {answer[:100]!r}")
        return json.loads(answer.split(b"\r\n\r\n", 1)[1])

    def memory_mib(self, key="VmRSS"):
        status = Path(f"/proc/{self.process.pid}/status").read_text()
        return int(re.search(rf"{key}:\s+(\d+)", status).group(1)) / 1024

    def descriptors(self):
        return len(os.listdir(f"/proc/{self.process.pid}/fd"))


def slow_heads(server, random_, done):
    """A head that never ends, some bytes at a time."""
    with server.connect() as stream:
        for byte in b"GET / HTTP/1.1\r\nHost: x\r\nX-Long: " + b"y" * 20:
            stream.sendall(bytes([byte]))
            if done.wait(0.05):
                return


def slow_bodies(server, random_, done):
    """A body that is announced and does not come. Without the token, and with it."""
    token = random_.choice([None, "0" * 32])
    with server.connect() as stream:
        more = "Content-Type: application/json\r\nContent-Length: 1000\r\n"
        stream.sendall(server.head("POST", "/api/jobs", more, token=token) + b"{")
        for _ in range(20):
            stream.sendall(b" ")
            if done.wait(0.1):
                return


def large_bodies(server, random_, done):
    """Bodies of 900 kB that are read and refused, and of 64 MiB, said beforehand or in pieces."""
    kind = random_.choice(["fits", "said", "pieces"])
    size = {"fits": "Content-Length: 900000\r\n", "said": f"Content-Length: {64 << 20}\r\n", "pieces": "Transfer-Encoding: chunked\r\n"}[kind]
    with server.connect() as stream:
        stream.sendall(server.head("POST", "/api/jobs", f"Content-Type: application/json\r\n{size}"))
        piece = b"[" * 65536
        for _ in range(900_000 // 65536 + 1 if kind == "fits" else 1024):
            stream.sendall(b"10000\r\n" + piece + b"\r\n" if kind == "pieces" else piece)


def comings_and_goings(server, random_, done):
    """Connections that are closed at once, after some bytes, or reset."""
    for _ in range(50):
        with server.connect() as stream:
            if random_.random() < 0.3:
                stream.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, b"\1\0\0\0\0\0\0\0")
            stream.sendall(random_.choice([b"", b"G", b"\0" * 100, random_.randbytes(500), server.head("GET", "/")]))


def wrong_requests(server, random_, done):
    """The wrong token, another host, another origin, paths that lead out, methods that nobody knows."""
    hosts = [None, "evil.example", "127.0.0.1.evil.example", "localhost:1"]
    tokens = [None, "0" * 32, "x", server.token[:31]]
    paths = ["/", "/api/health", "/api/scenarios", "/api/scenarios/../../etc/passwd", "/%2e%2e/x", "/api/jobs/1/events", "/api/jobs/9/runs/-1"]
    with server.connect() as stream:
        for _ in range(20):
            method = random_.choice(["GET", "PUT", "POST", "DELETE", "PATCH", "TRACE"])
            origin = random_.choice(["", "Origin: http://evil.example\r\n"])
            more = f"{origin}Content-Length: 2\r\nContent-Type: {random_.choice(['application/json', 'text/plain'])}\r\n"
            stream.sendall(server.head(method, random_.choice(paths), more, random_.choice(hosts), random_.choice(tokens)) + b"{}")
            if not stream.recv(65536):
                return


def deaf_clients(server, random_, done):
    """Asks for the page and reads nothing of it."""
    with server.connect() as stream:
        stream.sendall(server.head("GET", "/") * 50)
        done.wait(1.0)


def streams(server, random_, done):
    """Streams that are opened and left, some of which read nothing."""
    with server.connect() as stream:
        stream.sendall(server.head("GET", "/api/telemetry/events"))
        if random_.random() < 0.7:
            stream.recv(4096)
        done.wait(random_.random())


def telemetry(server, random_, done):
    """Bytes of any kind, frames that are damaged, and lines that are good."""
    frame = bytes([0xFE, 28, 0, 1, 1, 30]) + bytes(30)
    with socket.socket(type=socket.SOCK_DGRAM) as udp:
        for number in range(200):
            line = f'{{"time_s": {number}, "measurement_deg": 1}}\n'.encode()
            packet = random_.choice([line, line * 100, frame, frame * 100, b"\xfd" + random_.randbytes(200), random_.randbytes(1000), b"{" * 60000])
            udp.sendto(packet, ("127.0.0.1", server.telemetry))
        done.wait(0.02)


FLOODS = {slow_heads: 20, slow_bodies: 10, large_bodies: 2, comings_and_goings: 2, wrong_requests: 3, deaf_clients: 10, streams: 5, telemetry: 1}


def flood(kind, number, server, done, counts):
    random_ = random.Random(number)
    while not done.is_set():
        try:
            kind(server, random_, done)
            counts[kind.__name__, "through"] += 1
        except OSError:
            # Closed by the server, which is what it shall do.
            counts[kind.__name__, "closed"] += 1


def asked(server, seconds, problems):
    """What a person sees: how long each answer took, and the most memory."""
    took, most_mib = [], 0.0
    end = time.monotonic() + seconds
    while (begun := time.monotonic()) < end:
        try:
            server.ask(["/api/health", "/api/scenarios"][len(took) % 2])
        except (OSError, ValueError) as reason:
            problems.append(f"the person was not answered: {reason}")
        took.append(time.monotonic() - begun)
        if server.process.poll() is not None:
            problems.append(f"the server has ended with {server.process.returncode}")
            break
        most_mib = max(most_mib, server.memory_mib())
        time.sleep(max(0.0, ASKED_EVERY_S - took[-1]))
    return took, most_mib


def settled(server, before):
    """Descriptors once all who flooded are gone: slow heads have five seconds, slow bodies thirty."""
    for _ in range(400):
        if server.descriptors() <= before:
            break
        time.sleep(0.1)
    return server.descriptors()


def main():
    program, seconds = sys.argv[1], float(sys.argv[2])
    problems, counts, done = [], Counter(), threading.Event()
    with tempfile.TemporaryDirectory() as folder:
        server = Server(program, Path(folder))
        try:
            # The first answers make what is made once.
            [server.ask("/api/scenarios") for _ in range(20)]
            time.sleep(1.0)
            before, descriptors = server.memory_mib(), server.descriptors()
            numbered = enumerate(kind for kind, times in FLOODS.items() for _ in range(times))
            threads = [threading.Thread(target=flood, args=(kind, number, server, done, counts), daemon=True) for number, kind in numbered]
            [thread.start() for thread in threads]
            took, most_mib = asked(server, seconds, problems)
            done.set()
            [thread.join(30) for thread in threads]
            if server.process.poll() is None:
                left, health = settled(server, descriptors), server.ask("/api/health")
                told(server, (before, most_mib, descriptors, left), took, health, problems)
        finally:
            server.process.kill()
            server.process.wait()
    for (kind, how), number in sorted(counts.items()):
        print(f"  {kind}, {how}: {number}")
    missing = [kind.__name__ for kind in FLOODS if not any(counts[kind.__name__, how] for how in ("through", "closed"))]
    problems += [f"{kind} has flooded nothing" for kind in missing]
    [print(f"! {problem}") for problem in problems[:10]]
    sys.exit(1 if problems else 0)


def told(server, measured, took, health, problems):
    before, most_mib, descriptors, left = measured
    heard = health["telemetry"]
    print(f"{len(took)} answers for a person: median {statistics.median(took) * 1e3:.1f} ms, worst {max(took) * 1e3:.1f} ms")
    print(f"memory before {before:.1f} MiB, most {most_mib:.1f} MiB (peak {server.memory_mib('VmHWM'):.1f}), afterwards {server.memory_mib():.1f} MiB")
    print(f"descriptors before {descriptors}, afterwards {left}; {health['connections']} connection (this one), {health['streams']} streams; telemetry {heard['lines']} lines, {heard['bad']} bad; panics {health['panics']}")
    if max(took) > MOST_ANSWER_S:
        problems.append(f"an answer took {max(took):.2f} s; allowed are {MOST_ANSWER_S} s")
    if not server.memory_mib("VmHWM") - before <= MOST_GROWTH_MIB:
        problems.append(f"memory grew by more than {MOST_GROWTH_MIB} MiB")
    if left > descriptors:
        problems.append(f"{left - descriptors} descriptors are left")
    if health["panics"] != 0 or heard["lines"] == 0 or heard["bad"] == 0:
        problems.append("a handler panicked, or telemetry was not heard")


main()

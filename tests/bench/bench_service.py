#!/usr/bin/env python3
"""bench_service.py BUILD [JOBS]: how fast the daemon answers among so many jobs (100,000). Prints JSON lines: times of starting,
lists, submissions, studies and queries, and the memory it takes, each with its target beside it, whether that is met, and how
many others wanted the processors meanwhile (the machine's load). The one worker sleeps, so that the jobs stay where they are."""
import contextlib
import json
import os
import pathlib
import random
import selectors
import signal
import socket
import sqlite3
import statistics
import subprocess
import sys
import tempfile
import time

CASES = 10_000
POSTED = 100_000  # at most; the others are copies of these in the database
SPEC = {"inputs": {"drum": {"diameter": 0.06, "length": 0.012, "rotation_rate": 3.0}, "particles": [{"diameter": 0.004}],
                   "duration": {"revolutions": 1}}}
HEAVY = "SELECT count(*) FROM job a, job b WHERE a.estimated_seconds < b.estimated_seconds"


def say(figure, unit, values, processor_ms=None, **target):
    """target: what median, p99, maximum or minimum are to stay below, minimum above; processor_ms: the daemon's, for one of them."""
    values = sorted(values)
    told = {"median": statistics.median(values), "p99": values[int(0.99 * (len(values) - 1))], "maximum": values[-1],
            "minimum": values[0], "count": len(values)}
    met = [told[name] >= bound if name == "minimum" else told[name] <= bound for name, bound in target.items()]
    if processor_ms is not None:
        told["processor_ms"] = round(processor_ms, 3)
    print(json.dumps({"figure": figure, "unit": unit} | told | {"target": target, "met": all(met) if met else None,
                                                                "load": os.getloadavg()[0]}), flush=True)


def request(method, path, body=None):
    text = b"" if body is None else json.dumps(body).encode()
    head = f"{method} {path} HTTP/1.1\r\nHost: localhost\r\n"
    if body is not None:
        head += f"Content-Type: application/json\r\nContent-Length: {len(text)}\r\n"
    return head.encode() + b"\r\n" + text


class Client:
    """A connection that is kept open, and what has come of the answer."""

    def __init__(self, port, address="127.0.0.1"):
        self.socket = socket.create_connection(("127.0.0.1", port), source_address=(address, 0))
        self.socket.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)

    def send(self, data):
        self.answer, self.begin = b"", time.perf_counter()
        self.socket.sendall(data)

    def read(self):
        """None until the answer is whole; then its status and body."""
        self.answer += self.socket.recv(1 << 20)
        head, found, body = self.answer.partition(b"\r\n\r\n")
        if not found:
            return None
        lower = head.lower()
        if b"content-length:" in lower:
            whole = len(body) >= int(lower.split(b"content-length:")[1].split()[0])
        else:
            whole = body.endswith(b"0\r\n\r\n")
        self.seconds = time.perf_counter() - self.begin
        return (int(head.split()[1]), body) if whole else None

    def ask(self, data):
        self.send(data)
        while (answer := self.read()) is None:
            pass
        return answer


class Service:
    def __init__(self, build, folder, worker):
        self.command = [build / "reposed", "serve", "--port", "0", "--data", folder / "data", "--workers", "1", "--queue-limit", "1000000",
                        "--worker", worker, "--port-file", folder / "port"]
        self.port_file, self.log = folder / "port", folder / "log"

    def start(self):
        """Seconds until it answers."""
        self.port_file.unlink(missing_ok=True)
        begin = time.perf_counter()
        with open(self.log, "a") as log:
            self.process = subprocess.Popen(self.command, stdout=log, stderr=log)
        while not (self.port_file.exists() and self.port_file.read_text().strip()):
            if self.process.poll() is not None:
                sys.exit(self.log.read_text())
            time.sleep(0.001)
        self.port = int(self.port_file.read_text())
        Client(self.port).ask(request("GET", "/healthz"))
        return time.perf_counter() - begin

    def stop(self):
        self.process.send_signal(signal.SIGTERM)
        self.process.wait(60)

    def processor_seconds(self):
        fields = pathlib.Path(f"/proc/{self.process.pid}/stat").read_text().rsplit(")", 1)[1].split()
        return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")

    def megabytes(self):
        return next(int(line.split()[1]) for line in open(f"/proc/{self.process.pid}/status") if line.startswith("VmRSS")) / 1024


def fill(service, jobs):
    client, seconds = Client(service.port), []
    for k in range(jobs // CASES):
        status, body = client.ask(request("POST", "/studies", {
            "name": f"filling {k}", "base": SPEC, "vary": {"/inputs/contact/friction": [0.05 + 0.00005 * c for c in range(CASES)]}}))
        if status != 201:
            sys.exit(f"a study was refused: {body[:500]}")
        seconds.append(client.seconds)
    say(f"study of {CASES} jobs", "s", seconds, median=1.0)


def fill_in_results(folder):
    """Every second job that waits has ended, so that there is something to sort and to filter by."""
    chance = random.Random(1)
    with contextlib.closing(sqlite3.connect(folder / "data" / "reposed.sqlite")) as database, database:
        waiting = database.execute("SELECT number FROM job WHERE status='accepted' AND number%2 ORDER BY number").fetchall()
        for number, in waiting:
            database.execute("INSERT INTO repose_result(job,angle_deg,verdict) VALUES(?,?,?)",
                             (number, chance.uniform(5, 45), chance.choice(["steady", "drifting", "too-short"])))
            database.execute("INSERT INTO run_result(job,particles,steps,wall_seconds) VALUES(?,100,1000,?)", (number, chance.uniform(1, 9)))
            database.execute("UPDATE job SET status=?, started=created, finished=updated, progress=100 WHERE number=?",
                             (chance.choice(["successful"] * 5 + ["failed"]), number))


def copied(name, table, copies):
    """What a column of a copied row holds; ?1: the copy's number. Ids have the year in front."""
    jobs, studies = copies["job"], copies["study"]
    steps = {"number": jobs if table == "job" else studies if table == "study" else 0, "job": jobs, "study": studies, "turn": jobs}
    if name == "id":
        return "(1900+?1)||substr(id,5)"
    return f'"{name}"+?1*{steps[name]}' if steps.get(name) else f'"{name}"'


def multiply(folder, times):
    """The jobs there are, so many times in all: a hundredth of the time that posting them would take."""
    with contextlib.closing(sqlite3.connect(folder / "data" / "reposed.sqlite", isolation_level=None)) as database:
        database.executescript("PRAGMA journal_mode=DELETE; PRAGMA journal_mode=OFF; PRAGMA synchronous=OFF; PRAGMA cache_size=-400000")
        counting = database.execute("SELECT name, sql FROM sqlite_schema WHERE type='trigger' AND name IN ('job_counted','study_job_counted')").fetchall()
        tables = ["study", "study_document", "study_case", "job", "job_load", "drum_input", "repose_result", "run_result"]
        copies = {table: database.execute(f"SELECT max(number) FROM {table}").fetchone()[0] for table in ("job", "study")}
        database.execute("BEGIN")
        for name, _ in counting:
            database.execute(f"DROP TRIGGER {name}")
        for table in tables:
            columns = [row[1] for row in database.execute(f"PRAGMA table_info({table})")]
            last = {"job": "number<={job}", "study": "number<={study}"}.get(table, "job<={job}" if "job" in columns else "study<={study}").format(**copies)
            values = ",".join(copied(name, table, copies) for name in columns)
            for copy in range(1, times):
                database.execute(f"INSERT INTO {table}({','.join(columns)}) SELECT {values} FROM {table} WHERE {last}", (copy,))
        for _, sql in counting:
            database.execute(sql)
        database.execute("UPDATE job_count SET jobs=(SELECT count(*) FROM job WHERE job.status=job_count.status)")
        database.execute("COMMIT")
        database.execute("PRAGMA journal_mode=WAL")


def times(port, path, count):
    client, seconds = Client(port), []
    for _ in range(count):
        status, body = client.ask(request("GET", path))
        if status != 200:
            sys.exit(f"GET {path}: {status} {body[:300]}")
        seconds.append(1000 * client.seconds)
    return seconds


def submissions(service, clients, seconds):
    """Jobs acknowledged a second by so many clients at once, and what each took."""
    watch = selectors.DefaultSelector()
    bodies = [request("POST", "/processes/drum/execution", {"inputs": {**SPEC["inputs"], "seed": k}}) for k in range(64)]
    for k in range(clients):
        client = Client(service.port)
        watch.register(client.socket, selectors.EVENT_READ, client)
        client.send(bodies[k])
    begin, used, took = time.perf_counter(), service.processor_seconds(), []
    while time.perf_counter() < begin + seconds:
        for key, _ in watch.select(1):
            answer = key.data.read()
            if answer is None:
                continue
            if answer[0] != 201:
                sys.exit(f"a job was refused: {answer[1][:300]}")
            took.append(1000 * key.data.seconds)
            key.data.send(bodies[len(took) % 64])
    say(f"submission by {clients} clients at once", "ms", took)
    say(f"submissions acknowledged by {clients} clients", "1/s", [len(took) / (time.perf_counter() - begin)],
        **({"minimum": 1000} if clients == 16 else {}))
    say(f"processor time of a submission, {clients} clients", "ms", [1000 * (service.processor_seconds() - used) / len(took)])


def query(sql):
    return "/query?sql=" + sql.replace(" ", "%20").replace("<", "%3C").replace("%'", "%25'")


def among_heavy_queries(service):
    """They wait their turn in a lane, each for 2 s; what reads otherwise does not. A short query comes behind them."""
    busy = [Client(service.port) for _ in range(5)]
    for client in busy:
        client.send(request("GET", query(HEAVY)))
    say("GET /jobs among five of the heaviest queries", "ms", times(service.port, "/jobs", 200), median=3.0, p99=20.0)
    say("GET /jobs?q=filling among them", "ms", times(service.port, "/jobs?q=filling", 200), median=3.0, p99=20.0)
    client = Client(service.port)
    client.ask(request("GET", query("SELECT count(*) FROM study")))
    say("a short query behind five of the heaviest", "s", [client.seconds], maximum=20.0)


def churn(service, seconds):
    """Jobs come and go; the memory it takes before and after."""
    control, before, jobs = Client(service.port), service.megabytes(), 0
    end = time.perf_counter() + seconds
    while time.perf_counter() < end:
        for k in range(200):
            control.ask(request("POST", "/processes/drum/execution", {"inputs": {**SPEC["inputs"], "seed": k}, "label": {"churn": str(jobs)}}))
            jobs += 1
        control.ask(request("GET", "/jobs?q=churn&sort=-created&limit=5"))
        control.ask(request("POST", "/jobs/cancel?q=churn"))
        control.ask(request("POST", "/jobs/delete?q=churn"))
    say(f"memory gained while {jobs} jobs came and went", "MB", [service.megabytes() - before], maximum=4.0)


def until_running(build, folder):
    service = Service(build, folder, folder / "sleeper")
    service.start()
    client, seconds = Client(service.port), []
    for _ in range(20):
        begin = time.perf_counter()
        job = json.loads(client.ask(request("POST", "/processes/drum/execution", SPEC))[1])["jobID"]
        while json.loads(client.ask(request("GET", f"/jobs/{job}"))[1])["status"] == "accepted":
            pass
        seconds.append(1000 * (time.perf_counter() - begin))
        client.ask(request("DELETE", f"/jobs/{job}"))
        while json.loads(client.ask(request("GET", "/jobs?status=running"))[1])["jobs"]:
            time.sleep(0.01)
        time.sleep(0.2)
    service.stop()
    say("from a submission to the running job", "ms", seconds, median=50.0, p99=50.0)


def main():
    build = pathlib.Path(sys.argv[1]).resolve()
    jobs = int(sys.argv[2]) if len(sys.argv) > 2 else 100_000
    with tempfile.TemporaryDirectory() as name, contextlib.ExitStack() as at_end:
        folder = pathlib.Path(name)
        sleeper = folder / "sleeper"
        sleeper.write_text("#!/bin/sh\nexec sleep 100000\n")
        sleeper.chmod(0o755)
        (folder / "empty").mkdir()
        (folder / "empty" / "sleeper").symlink_to(sleeper)
        until_running(build, folder / "empty")
        service = Service(build, folder, sleeper)
        say("start with an empty folder", "s", [service.start()], maximum=0.2)
        at_end.callback(lambda: service.process.poll() is None and service.process.kill())
        submissions(service, 1, 5)
        submissions(service, 16, 5)
        fill(service, min(jobs, POSTED))
        service.stop()
        fill_in_results(folder)
        if jobs > POSTED:
            multiply(folder, jobs // POSTED)
        factor = 2.0 if jobs > 100_000 else 1.0
        say(f"start with {jobs} jobs", "s", [service.start()], maximum=0.2 * factor)
        time.sleep(jobs / 50_000)  # what lists are made of is being read
        for path in ("/jobs", "/jobs?limit=1", "/jobs?status=running", "/jobs?status=accepted", "/jobs?status=failed,running",
                     "/jobs?processID=drum", "/jobs?processID=granule,heap", "/jobs?q=filling", "/jobs?q=nothing", "/jobs?q=2",
                     "/jobs?q=ab1", "/jobs?sort=created", "/jobs?sort=-angle_deg", "/jobs?sort=verdict&status=successful&q=filling",
                     "/jobs?value.angle_deg=30..31&sort=friction"):
            used, took = service.processor_seconds(), times(service.port, path, 300)
            say(f"GET {path}, {jobs} jobs", "ms", took, 1000 * (service.processor_seconds() - used) / 300, median=3.0 * factor, p99=20.0 * factor)
        say(f"GET /studies, {jobs} jobs", "ms", times(service.port, "/studies", 300))
        say(f"short /query, {jobs} jobs", "ms", times(service.port, query("SELECT angle_deg FROM run_summary LIMIT 10"), 300), p99=20.0 * factor)
        submissions(service, 16, 5)
        among_heavy_queries(service)
        churn(service, 30)
        idle = [Client(service.port, f"127.0.0.{1 + k % 2}") for k in range(500)]
        say(f"memory with {jobs} jobs and {len(idle)} connections", "MB", [service.megabytes()], maximum=40.0)
        service.stop()


main()

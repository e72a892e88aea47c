"""What one POST may cost: however large its body, however many jobs there are already, whatever else is being posted."""
import sqlite3

from conftest import FAKE_WORKER, Daemon


def processor_seconds(daemon):
    """Of the daemon alone, which waiting for others does not add to."""
    fields = open(f"/proc/{daemon.process.pid}/stat").read().rsplit(")", 1)[1].split()
    return (int(fields[11]) + int(fields[12])) / 100


def test_a_post_does_not_walk_over_the_runs_that_there_were(tmp_path):
    daemon = Daemon(tmp_path, worker=FAKE_WORKER, options=["--workers", "1"]).start()
    try:
        daemon.ended(daemon.submit())
        daemon.stop()
        with sqlite3.connect(tmp_path / "data" / "reposed.sqlite") as database:
            # too short to tell how fast the machine is: none of them ends a search for the latest that do
            database.execute("WITH RECURSIVE n(x) AS (SELECT 1000 UNION ALL SELECT x+1 FROM n WHERE x<400000)"
                             " INSERT INTO run_result(job,steps,wall_seconds) SELECT x,1000,0.01 FROM n")
        daemon.start()
        daemon.submit()
        before = processor_seconds(daemon)
        for _ in range(30):
            daemon.submit()
        assert processor_seconds(daemon) - before < 30 * 0.015
    finally:
        if daemon.is_running():
            daemon.stop()

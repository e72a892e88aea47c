"""A database that the program made before its tables of inputs and results came from the tables of fields: nothing in it
is lost or changed. older_database/reposed.sql is that database: runs of all four processes, some with results in which no
two numbers are equal, a study and a dismissed job. older_database/answers.json holds what the program answered then."""
import json
import signal
import sqlite3
from pathlib import Path

import pytest
from conftest import FAKE_WORKER, SPEC, Daemon

FOLDER = Path(__file__).with_name("older_database")
ANSWERS = json.loads((FOLDER / "answers.json").read_text())


@pytest.fixture(scope="module")
def before():
    """As it was: its own view gives its own answers."""
    database = sqlite3.connect(":memory:")
    database.executescript((FOLDER / "reposed.sql").read_text())
    return database


@pytest.fixture(scope="module")
def daemon(tmp_path_factory):
    folder = tmp_path_factory.mktemp("older")
    (folder / "data").mkdir()
    database = sqlite3.connect(folder / "data/reposed.sqlite")
    database.executescript((FOLDER / "reposed.sql").read_text())
    database.close()
    daemon = Daemon(folder, worker=FAKE_WORKER).start()
    yield daemon
    if daemon.is_running():
        daemon.stop(signal.SIGKILL)


def rows_of(daemon, sql):
    """The columns' names, and the rows as dictionaries."""
    answer = daemon.get("/query", params={"sql": sql}).json()
    assert not answer["truncated"]
    return answer["columns"], [dict(zip(answer["columns"], row)) for row in answer["rows"]]


def tables_of(database):
    return [name for name, in database.execute("SELECT name FROM sqlite_schema WHERE type IN ('table','view') ORDER BY name")]


def missing(before, now, where=""):
    """What of an answer is no longer as it was; objects may have got more members."""
    if isinstance(before, dict) and isinstance(now, dict):
        return [one for name, value in before.items() for one in missing(value, now.get(name), f"{where}/{name}")]
    if where.endswith("/links"):  # of which there may be more
        return [(where, link) for link in before if link not in now]
    if isinstance(before, list) and isinstance(now, list) and len(before) == len(now):
        return [one for i in range(len(before)) for one in missing(before[i], now[i], f"{where}/{i}")]
    return [] if type(before) is type(now) and before == now else [(where, before, now)]


@pytest.mark.parametrize("path", ANSWERS)
def test_it_is_answered_as_before(daemon, path):
    answer = daemon.get(path)
    assert answer.status_code == 200
    text = answer.text.replace(daemon.url, "")
    assert missing(ANSWERS[path], text if isinstance(ANSWERS[path], str) else json.loads(text)) == []


# Columns that have moved to a table of their own: from which, and where they are now.
MOVED = {"study": ("document", "select document from study_document order by study")}


def test_a_column_that_has_moved_is_found_where_it_went(before, daemon):
    for table, (column, sql) in MOVED.items():
        kept = [text for text, in before.execute(f"SELECT {column} FROM {table} ORDER BY number")]
        assert kept and [row[column] for row in rows_of(daemon, sql)[1]] == kept


def test_every_number_of_every_table_and_view_is_found_again(before, daemon):
    empty = set()
    for table in tables_of(before):
        names = [column[0] for column in before.execute(f"SELECT * FROM {table}").description]
        names = [name for name in names if name not in MOVED.get(table, ())]
        sql = f"SELECT {{}} FROM {table} ORDER BY {', '.join(names[:2])}"
        cursor, (columns, rows) = before.execute(sql.format(", ".join(names))), rows_of(daemon, sql.format("*"))
        # What came later may stand between them; their own order stays.
        assert [name for name in columns if name in names] == names, table
        assert [[row[name] for name in names] for row in rows] == [list(row) for row in cursor], table
        if not rows:
            empty.add(table)
    assert empty == {"leaving", "study_part"}


def test_no_two_made_up_results_are_equal_so_that_none_can_stand_for_another(before):
    for table in (name for name in tables_of(before) if name.endswith("_result")):
        for row in before.execute(f"SELECT * FROM {table} WHERE job>4"):
            numbers = [value for value in row[1:] if isinstance(value, float)]
            assert len(set(numbers)) == len(numbers), table


def test_new_jobs_stand_beside_the_old_ones(daemon):
    _, old = rows_of(daemon, "select id from run_summary")
    job = daemon.submit(SPEC | {"contact": {"friction": 0.125}})
    assert daemon.ended(job)["status"] == "successful"
    _, rows = rows_of(daemon, f"select friction, drum_diameter, angle_deg, slumps_count from run_summary where id='{job}'")
    assert rows == [{"friction": 0.125, "drum_diameter": 0.04, "angle_deg": 23.5, "slumps_count": 12}]
    assert len(rows_of(daemon, "select id from run_summary")[1]) == len(old) + 1


def test_it_opens_a_second_time_with_the_same_tables(daemon):
    sql = "select type, name, sql from sqlite_schema order by type, name"
    first = rows_of(daemon, sql)
    daemon.stop()
    daemon.start()
    assert rows_of(daemon, sql) == first

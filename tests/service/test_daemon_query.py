"""Read-only SQL: what it answers, and what it can't be made to do."""
import csv
import io
import json
import os
import sqlite3
import statistics
import threading
import time
from urllib.parse import urljoin

import pytest
import requests
from conftest import FAKE_WORKER, run_daemon


def fill(daemon):
    for job in [daemon.submit(project=project) for project in ("a", "b")]:
        daemon.ended(job)
    return daemon


@pytest.fixture
def own(fake):
    """For what changes its database."""
    return fill(fake)


@pytest.fixture(scope="module")
def filled(tmp_path_factory):
    """One for all that only ask."""
    for daemon in run_daemon(tmp_path_factory.mktemp("filled"), worker=FAKE_WORKER, options=["--workers", "2"]):
        yield fill(daemon)


def ask(daemon, sql, **parameters):
    return daemon.get("/query", params={"sql": sql, **parameters})


def ask_in_time(daemon, sql, **parameters):
    """What takes some milliseconds may still not end within 2 s where others keep the machine busy: asked again then."""
    for _ in range(8):
        answer = ask(daemon, sql, **parameters)
        if answer.status_code != 503:
            break
    return answer


def cpu_seconds(daemon):
    fields = open(f"/proc/{daemon.process.pid}/stat").read().rsplit(")", 1)[1].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


def test_the_example_of_the_documentation_works(filled):
    answer = ask(filled, "select friction, angle_deg from run_summary where process='drum'")
    assert answer.json() == {"columns": ["friction", "angle_deg"], "rows": [[0.3, 23.5]] * 2, "truncated": False}
    table = ask(filled, "select label->>'project' as project, steady, radial_index from run_summary order by 1", format="csv")
    assert table.headers["Content-Type"].startswith("text/csv")
    assert list(csv.reader(io.StringIO(table.text))) == [["project", "steady", "radial_index"], ["a", "1", ""], ["b", "1", ""]]
    by_header = filled.get("/query", params={"sql": "select 'a,\"b' as x"}, headers={"Accept": "text/csv"})
    assert list(csv.reader(io.StringIO(by_header.text))) == [["x"], ['a,"b']]


def test_text_survives_json(filled):
    text = "quote \" slash \\ newline \n bell \x07 umlaut ü"
    answer = ask(filled, f"select '{text}' as text, cast(x'ff' as text) as broken, null as unknown, 1e999 as infinite")
    assert answer.json()["rows"] == [[text, None, None, None]]


@pytest.mark.parametrize("sql", [
    "delete from job", "update job set status='failed'", "insert into job_count values('x', 1)", "drop table job",
    "create table t(x)", "create temp table t(x)", "vacuum", "vacuum into '/tmp/reposed-vacuum'", "attach 'x' as y", "pragma user_version",
    "pragma journal_mode=delete", "begin", "select load_extension('x')", "select readfile('x')", "select randomblob(1000)",
    "select zeroblob(1000)", "select 1; select 2", "select 1; drop table job", "select 1; nonsense", "", ";", "selec 1", "select * from nothing", "select * from pragma_table_info('job')",
    "select * from dbstat", "select count(*) from pragma_table_info('job')"])
def test_everything_but_one_bounded_select_is_refused(filled, sql):
    answer = ask(filled, sql)
    assert answer.status_code == 400 and answer.json()["detail"], sql
    assert filled.get("/jobs").json()["counts"]["successful"] == 2


def test_no_value_grows_without_bound(filled):
    assert ask(filled, "select printf('%.*c', 100000000, 'x') as huge").json()["rows"] == [[None]]
    assert ask(filled, "select replace(printf('%.*c', 200000, 'x'), 'x', 'xxxx') as huge").status_code == 400


def test_a_query_that_takes_too_long_is_ended_and_holds_up_nobody(filled):
    endless = "with recursive n(i) as (select 1 union all select i+1 from n) select count(*) from n"
    for _ in range(4):  # where the machine is too busy for the requests
        answers, cpu, start = [], cpu_seconds(filled), time.monotonic()
        thread = threading.Thread(target=lambda: answers.append(ask(filled, endless)))
        thread.start()
        meanwhile = 0
        while not answers:
            assert filled.get("/healthz").status_code == 200
            meanwhile += not answers
        thread.join()
        assert answers[0].status_code == 503 and "2 s" in answers[0].json()["detail"]
        assert time.monotonic() - start > 1.9 and cpu_seconds(filled) - cpu < 3.5
        if meanwhile > 8:  # more than there are HTTP threads
            break
    assert meanwhile > 8
    assert ask(filled, "select 1").status_code == 200


@pytest.mark.parametrize("call, statuses, value", [
    ("instr(s,p)", (200, 503), 0), ("replace(s,p,'')", (400, 503), "a" * 150000), ("(s like q)", (503,), 0), ("(s glob g)", (503,), 0),
    ("length(trim(s,p))", (400,), None)], ids=["instr", "replace", "like", "glob", "trim"])
def test_many_costly_calls_in_one_row_are_ended_too(filled, call, statuses, value):
    """SQLite itself looks at the clock only between rows, and its own functions would run for 20 s and more. The registers of
    750 calls of replace would need too much memory at once. A few calls work, with texts as long."""
    values = "printf('%.*c',150000,'a') as s, printf('%.*c',50000,'a')||'b' as p, '%a'||printf('%.*c',90,'_')||'b' as q, '*a'||printf('%.*c',90,'?')||'b' as g"
    row = ",".join(["+".join([call] * 15)] * 50)
    cpu = cpu_seconds(filled)
    answer = ask(filled, f"with t as materialized (select {values}) select {row} from t")
    assert cpu_seconds(filled) - cpu < 3.5  # 2 s and one call
    assert answer.status_code in statuses, answer.text[:200]
    few = 20 if statuses == (200, 503) else 2
    answer = ask_in_time(filled, f"with t as materialized (select {values}) select {','.join([call] * few)} from t")
    assert answer.json()["rows"] == [[value] * few] if value is not None else answer.status_code == 400, answer.text[:200]


@pytest.mark.parametrize("expression", [
    "instr('häßlich','lich')", "instr('abc','')", "instr('abc','x')", "instr('','')", "instr(12345,34)", "instr(null,'a')",
    "replace('a,b,c',',','; ')", "replace('aaaa','aa','a')", "replace('abc','','x')", "replace('abc','abc','')",
    "replace(1.5,'.',',')", "replace('a',null,'b')", "'Drum' like 'd%'", "'a%b' like 'a|%b' escape '|'", "'axb' like 'a|%b' escape '|'",
    "'' like ''", "'ab' like '_'", "null like 'a'", "'drum' glob 'd*m'", "'Drum' glob 'd*'", "'d7' glob 'd[0-9]'", "trim('  a ')"])
def test_our_own_functions_answer_as_those_of_sqlite(filled, expression):
    expected = sqlite3.connect(":memory:").execute(f"select {expression}").fetchone()
    assert ask(filled, f"select {expression} as x").json()["rows"] == [list(expected)]


FORMATS = ["%d|%5d|%-5d|%05d|%+d|% d|%,d", "%x %X %o %#x %u", "%f %.2f %10.3f %-10.3f| %e %.3E %g %.17g %!g %+.1f %,.2f", "%s|%10s|%-10s|%.2s|%5.1s|%!.2s",
           "%q %Q %w", "%c|%5c|%-5c|%.3c|%6.3c|%-6.3c|", "%%|%5%|%", "%*d|%-*d|%.*f|%*s", "%ld %lld %lli", "%i%n%d", "%z", "%p", "100%", "%y no type",
           "%.0f %.f %.10d %010.2f %r", "a%", "%5", "%.2147483647c", "%2147483647d", "%.*s", "%-", "", "plain", "%5.2147483647s|", "häß %s %c"]


@pytest.mark.parametrize("function", ["printf", "format"])
def test_our_own_printf_writes_what_that_of_sqlite_writes(filled, function):
    lists = ["", ",7,-3,42,0,5,-6,1234567", ",'häß','x''y','z',2.5,'','long text'", ",null,null,null,null", ",-2,3.75,1e10,-1e-5,123456.789,2,9,8,7,6,5",
             ",5,'ab',-6,'cd',3,2.71828,8,'x'", ",x'c3a4',9007199254740993,'12abc'"]
    reference = sqlite3.connect(":memory:")
    for rest in lists:
        # what would take SQLite seconds is asked of ours alone, below
        texts = [text for text in FORMATS if "2147483647" not in text and not ("*" in text and "1234567" in rest)]
        ours = "select " + ",".join(f"{function}('{text}'{rest})" for text in texts)
        assert ask(filled, ours).json()["rows"][0] == list(reference.execute(ours).fetchone()), rest
    assert ask(filled, f"select {function}('%.2147483647c','x'), {function}('%2147483647d',1), {function}('%.*f',2147483647,1.0), {function}(null), {function}()").json()["rows"] == [[None] * 5]
    assert ask(filled, f"select {function}('%.2147483647s|%.*s','ab',2147483647,'cd')").json()["rows"] == [["ab|cd"]]


def highest_memory(daemon):
    return next(int(line.split()[1]) for line in open(f"/proc/{daemon.process.pid}/status") if line.startswith("VmHWM")) * 1024


LONG_TEXTS = ("with t as materialized (select printf('%.*c',250000,'1') as s), u as materialized"
              " (select '['||replace(printf('%.*c',120000,'1'),'1','1,')||'1]' as j, '$[119999]' as p) select ")


def wide(expression, depth=30, columns=190):
    each = min(depth, 16000 // columns // (len(expression) + 1))
    return LONG_TEXTS + ",".join(["-".join([expression] * each)] * columns) + " from t,u"


@pytest.mark.parametrize("sql", [
    "select " + ",".join(["printf('%.*c',2147483647,'x')"] * 190),
    "select format(replace(printf('%.*c',20000,'x'),'x','%.2147483647c'))",
    "select " + ",".join(["format(replace(printf('%.*c',20000,'x'),'x','%.200000f'))"] * 150),
    wide("s"), wide("length(hex(s))"),
    "with recursive n(i) as (select 1 union all select i+1 from n) select max(x) from (select printf('%.*c',200000,'x')||i as x from n order by 1 desc)",
    *(pytest.param(sql, marks=pytest.mark.torture) for sql in (
        wide("(s<s collate nocase)"), wide("length(upper(s))"), wide("length(strftime(s,0))"), wide("json_valid(j)"), wide("json_type(j,p)"),
        LONG_TEXTS + ",".join(["json_extract(j" + ",p" * 98 + ")"] * 60) + " from t,u",
        "with recursive n(i) as (select 1 union all select i+1 from n limit 100000) select sum(length(g)) from (select"
        " group_concat(printf('%.100c','x')) over (order by i rows 2000 preceding) as g from n)"))],
    ids=["printf", "format of many", "format of reals", "minus", "hex", "sort", "collate", "upper", "strftime", "json_valid", "json_type",
         "json_extract", "window"])
def test_no_statement_outlasts_its_time_or_fills_the_memory(fake, sql):
    """In processor time, since others are at work here, too: 2 s, and what one stretch without a look may take."""
    cpu, memory = cpu_seconds(fake), highest_memory(fake)
    answer = ask(fake, sql)
    assert answer.status_code in (200, 400, 503), answer.text[:200]
    assert cpu_seconds(fake) - cpu < 3.5
    assert highest_memory(fake) - memory < 200e6
    assert ask(fake, "select 1").status_code == 200


def rank(value):
    return value is not None, isinstance(value, str), 0 if value is None else value


def test_every_column_of_every_table_can_be_asked_for(filled):
    """What another reader of the same file sees is what comes."""
    tables = [row[0] for row in ask(filled, "select name from sqlite_schema where type in ('table','view')").json()["rows"]]
    direct = sqlite3.connect(f"file:{filled.data}/reposed.sqlite?mode=ro", uri=True)
    assert sorted(tables) == sorted(row[0] for row in direct.execute("select name from sqlite_schema where type in ('table','view')"))
    assert {"job", "sample", "snapshot", "run_summary", "study", "drum_input", "repose_result"} <= set(tables)
    for table in tables:
        cursor = direct.execute(f"select * from {table} limit 1000")
        rows, names = cursor.fetchall(), [column[0] for column in cursor.description]
        answer = ask(filled, f"select * from {table} limit 1000")
        assert answer.status_code == 200, (table, answer.text)
        assert answer.json()["columns"] == names and answer.json()["rows"] == [list(row) for row in rows], table
        for at, name in enumerate(names):
            one = ask(filled, f'select "{name}" from {table} limit 1000')
            assert one.status_code == 200, (table, name, one.text)  # an index may give them in another order
            assert sorted((row[0] for row in one.json()["rows"]), key=rank) == sorted((row[at] for row in rows), key=rank), (table, name)
    assert ask(filled, "select number, angle_deg from sample where angle_deg > 38").json()["rows"] == [[19, 39]] * 2


def test_long_specifications_are_read_like_short_ones(own):
    spec = '{"inputs": "' + "ä" * 1000000 + '"}'
    with sqlite3.connect(f"{own.data}/reposed.sqlite", timeout=30) as writer:
        writer.execute("update job set spec=? where number=1", (spec,))
    writer.close()
    answer = ask(own, "select * from job order by number").json()
    assert answer["rows"][0][answer["columns"].index("spec")] == spec and len(answer["rows"]) == 2 and answer["truncated"] is False
    refused = ask(own, "select upper(spec) from job")
    assert refused.status_code == 400 and "/jobs/{id}/spec" in refused.json()["detail"]


def test_csv_is_whole_or_refused(filled):
    many = "with recursive n(i) as (select 1 union all select i+1 from n limit 12000) select i, -i, 0.5-i, '=1+'||i, '-'||i, 1e999 from n"
    rows = list(csv.reader(io.StringIO(ask_in_time(filled, many, format="csv").text)))
    assert len(rows) == 12001
    assert rows[12000] == ["12000", "-12000", "-11999.5", "'=1+12000", "-12000", ""]
    wide_rows = ("with recursive t as materialized (select printf('%.*c', 200000, 'x') as s), n(i) as (select 1 union all select i+1 from n limit 300)"
                 " select i, s from n, t")
    answer = ask_in_time(filled, wide_rows, format="csv")
    assert answer.status_code == 400 and "LIMIT and OFFSET" in answer.json()["detail"]


def test_samples_as_csv_are_whole_or_say_where_they_go_on(own):
    job = own.get("/jobs").json()["jobs"][0]["jobID"]
    with sqlite3.connect(f"{own.data}/reposed.sqlite", timeout=30) as writer:
        number = writer.execute("select number from job where id=?", (job,)).fetchone()[0]
        writer.execute("delete from sample where job=?", (number,))
        writer.executemany("insert into sample(job,number,step,time,measures) values(?,?,?,?,?)",
                           ((number, i, 10 * i, i / 8, f'{{"angle_deg": {-i / 4}, "=odd": {i}}}') for i in range(25003)))
    writer.close()
    answer = own.get(f"/jobs/{job}/samples?format=csv")
    rows = list(csv.reader(io.StringIO(answer.text)))
    assert rows[0] == ["number", "step", "time", "angle_deg", "'=odd"] and "Link" not in answer.headers
    assert rows[1:] == [[str(i), str(10 * i), f"{i / 8:.15g}", f"{-i / 4:.15g}", str(i)] for i in range(25003)]
    tail = own.get(f"/jobs/{job}/samples?format=csv&after=24999").text.splitlines()
    assert [row.split(",")[0] for row in tail] == ["number", "25000", "25001", "25002"]
    page, pages = own.get(f"/jobs/{job}/samples?format=csv&limit=9000"), 1
    numbers = [row.split(",")[0] for row in page.text.splitlines()[1:]]
    while "next" in page.links:
        page, pages = requests.get(urljoin(own.url, page.links["next"]["url"]), timeout=30), pages + 1
        numbers += [row.split(",")[0] for row in page.text.splitlines()[1:]]
    assert pages == 3 and numbers == [str(i) for i in range(25003)]
    assert own.get(f"/jobs/{job}/samples?format=csv&after=30000").text == ""


def test_members_of_a_json_text_are_rows(filled):
    sql = "select distinct e.key from job, json_each(job.label) as e union select t.atom from job, json_tree(job.label) as t where t.atom='a'"
    assert ask(filled, sql).json()["rows"] == [["a"], ["project"]]


def test_rows_and_bytes_are_capped(filled):
    many = "with recursive n(i) as (select 1 union all select i+1 from n limit 20000) select i from n"
    answer = ask_in_time(filled, many).json()
    assert len(answer["rows"]) == 10000 and answer["truncated"] is True
    wide = "with recursive n(i) as (select 1 union all select i+1 from n limit 9000) select i, printf('%.*c', 2000, 'x') from n"
    answer = ask_in_time(filled, wide)
    assert len(answer.content) < 9e6 and answer.json()["truncated"] is True and 1000 < len(answer.json()["rows"]) < 9000


@pytest.mark.parametrize("sql", ["select 1 as x;", "select 1 as x; -- done", "/* a */ select 1 as x -- b\n ; ; /* c */", "select 1 as x; ;"])
def test_comments_and_semicolons_are_no_second_statement(filled, sql):
    assert ask(filled, sql).json()["rows"] == [[1]]


def test_the_standard_deviation_is_that_of_a_sample(fake):
    def answer(values):
        sql = f"select stddev(value) from json_each('{json.dumps(values)}')"
        return fake.get("/query", params={"sql": sql}).json()["rows"][0][0]

    for values in ([1, 2, 4, 8.5], [1e9, 1e9 + 1, 1e9 + 2], [3, 3], [2, None, "text", 5]):
        numbers = [value for value in values if isinstance(value, (int, float))]
        assert answer(values) == pytest.approx(statistics.stdev(numbers), rel=1e-12)
    assert answer([1]) is None and answer([]) is None

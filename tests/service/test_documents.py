"""The documents name what there is: contents their sections, comments the sections that they cite, and sentences the files."""
import fnmatch
import os
import re
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
LEFT_OUT = {".git", "build", "data"}
DOCUMENTS = ["core/NUMERICS.md", "core/SPEED.md", "README.md", "server/DESIGN.md"]
WITH_CONTENTS = ["core/NUMERICS.md", "core/SPEED.md"]
CITING = {".c", ".h", ".py", ".md", ".js", ".sh", ".yaml", ""}


def files_of_tree():
    for folder, folders, names in os.walk(ROOT):
        folders[:] = [name for name in folders if name not in LEFT_OUT and not name.startswith(".")]
        yield from (Path(folder, name).relative_to(ROOT) for name in names)


TREE = sorted(str(path) for path in files_of_tree())


def text_of(path):
    return (ROOT / path).read_text()


def without_code(text):
    """Without its blocks of code, in which `#` begins no section and `ds.h` is no file."""
    return re.sub(r"^```.*?^```$", "", text, flags=re.DOTALL | re.MULTILINE)


def sections(text):
    """Level and name of each section."""
    return [(len(marks), name) for marks, name in re.findall(r"^(##+) (.+)$", without_code(text), re.MULTILINE)]


def anchor(name):
    """As GitHub makes it of a heading: lower case, blanks to hyphens, other punctuation gone."""
    return re.sub(r"[^\w\- ]", "", name.lower()).replace(" ", "-")


def citations(text):
    """Document and section of each `NUMERICS.md, "Angles"` or `NUMERICS.md ("Angles")`, also across lines of a comment."""
    joined = re.sub(r"\s*\n\s*(?:[*#]|//)?\s*", " ", text)
    return re.findall(r'\b([A-Z]+\.md)`?,? \(?"([^"]+)"', joined)


def is_there(name):
    """A file of that name, or whose path ends so; * stands for several."""
    return any(fnmatch.fnmatchcase(path, name) or fnmatch.fnmatchcase(path, "*/" + name) for path in TREE)


@pytest.mark.parametrize("path", WITH_CONTENTS)
def test_contents_name_each_section_in_its_order(path):
    text = text_of(path)
    links = re.findall(r"^( *)- \[(.+?)\]\(#(.+?)\)$", text, re.MULTILINE)
    named = [(len(indent) // 2 + 2, name) for indent, name, _ in links]
    assert named == [section for section in sections(text) if section[1] != "Contents"]
    assert [target for _, _, target in links] == [anchor(name) for _, name, _ in links]
    assert len({target for _, _, target in links}) == len(links), "GitHub numbers the later of two equal anchors"


def test_cited_sections_exist():
    names = {Path(path).name: {name for _, name in sections(text_of(path))} for path in TREE if path.endswith(".md")}
    cited = [(path, document, section) for path in TREE
             if Path(path).suffix in CITING and path != str(Path(__file__).relative_to(ROOT))
             for document, section in citations((ROOT / path).read_text(errors="replace"))]
    assert {"NUMERICS.md", "SPEED.md"} <= {document for _, document, _ in cited}
    assert [c for c in cited if c[2] not in names.get(c[1], set())] == []


@pytest.mark.parametrize("path", DOCUMENTS)
def test_named_files_exist(path):
    """But for what a run writes into data/, and X, which stands for any process."""
    named = set(re.findall(r"[\w*./-]*[\w*]\.(?:c|h|py|md)\b", without_code(text_of(path))))
    assert named
    assert sorted(name for name in named if not re.search(r"^data/|\bX_", name) and not is_there(name)) == []


@pytest.mark.parametrize("path", [path for path in DOCUMENTS if "](" in text_of(path)])
def test_links_lead_to_files(path):
    links = re.findall(r"\]\(([^)#:]+)(?:#[^)]*)?\)", text_of(path))
    assert [link for link in links if not (ROOT / path).parent.joinpath(link).exists()] == []


def rows_of_adding():
    chapter = text_of("README.md").split("## To add ...")[1].split("\n## ")[0]
    return [line for line in chapter.splitlines() if line.startswith("| a")]


def test_what_is_to_be_added_to_is_there_for_what_was_added_before():
    """Files named with an X are there for each process, and every other file is there."""
    processes = re.findall(r"&(\w+)_process", text_of("api/process/process_type.c"))
    assert len(processes) >= 4 and len(rows_of_adding()) == 9
    for row in rows_of_adding():
        for name in re.findall(r"`([\w/*.-]+\.(?:c|h|js|css|yaml|json))`", row):
            if name == "X_rules.c":  # a granule's few rules stand beside its process
                continue
            for process in processes if "X" in name else [""]:
                assert is_there(name.replace("X", process)), f"{name} for {process or row}"


def test_each_process_and_law_stands_in_all_of_its_lists():
    processes = set(re.findall(r"&(\w+)_process", text_of("api/process/process_type.c")))
    assert set(re.findall(r'\{ "(\w+)", \w+_run', text_of("server/worker/run/job_run.c"))) == processes
    assert set(re.findall(r"^  (\w+): \{ answer", text_of("web/process_views.js"), re.MULTILINE)) == processes
    assert {Path(path).stem for path in TREE if re.fullmatch(r"api/examples/\w+\.json", path)} == processes | {"calibration"}
    assert all(f"api/process/{process}_SEES" in text_of("Makefile") for process in processes)
    laws = re.search(r"typedef enum dem_contact_law \{(.*?)\}", text_of("include/dem_types.h"), re.DOTALL)[1]
    names = re.search(r"contact_law_names\[\] = \{(.*?)\}", text_of("api/spec/calibration.c"))[1]
    in_c = re.findall(r"DEM_(\w+)", laws)
    assert [name.lower().replace("_", "-") for name in in_c] == re.findall(r'"([\w-]+)"', names)

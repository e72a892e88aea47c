"""npm's axe-core, which finds what keeps people from using a page."""
import functools
import shutil
import subprocess

from conftest import BUILD


@functools.cache
def axe():
    """The checker, fetched once from npm into build/npm; "" where that can't be had."""
    folder = BUILD.absolute() / "npm" / "axe"
    script = folder / "node_modules/axe-core/axe.min.js"
    if not script.exists() and shutil.which("npm"):
        folder.mkdir(parents=True, exist_ok=True)
        (folder / "package.json").write_text('{"name": "axe", "private": true}')
        subprocess.run(["npm", "install", "--no-audit", "--no-fund", "--ignore-scripts", "axe-core@4.14.1"], cwd=folder, capture_output=True, timeout=120)
    return script.read_text() if script.exists() else ""


def violations(browser):
    """[(rule, [what breaks it])] of the page as it is now, with targets of a finger's size; none where there is no checker."""
    if not axe():
        return []
    browser.execute_script(axe())
    found = browser.execute_async_script("axe.run({rules: {'target-size': {enabled: true}}}).then(arguments[0])")["violations"]
    return [(one["id"], [node["html"][:200] for node in one["nodes"]]) for one in found]

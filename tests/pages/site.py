#!/usr/bin/env python3
"""The pages of the site: site.py DOXYGEN DOXYFILE HTML [CHROMIUM]

Doxygen warns of nothing, local links lead somewhere, no page shows a raw reference, and each tutorial
and how-to is behind its door. With Chromium: the search answers each question of docs/questions.md on
its first screen, and no page is wider than a phone.
"""

import html
import json
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
PHONE = 390  # pixels
FOUND = []  # what is wrong


def build(doxygen, doxyfile, folder):
    shutil.rmtree(folder, ignore_errors=True)
    folder.parent.mkdir(parents=True, exist_ok=True)
    gallery = pathlib.Path(doxyfile).parent / "gallery_text"
    subprocess.run([ROOT / "script/gallery", gallery], check=True)
    shown = (gallery / "gallery.md").read_text()
    for scene in (ROOT / "examples/scenes").glob("*.toml"):
        if f"/{scene.name} --plot" not in shown:
            FOUND.append(f"the gallery lacks {scene.name}")
    run = subprocess.run([doxygen, doxyfile], capture_output=True, text=True, check=True)
    FOUND.extend(line for line in run.stderr.splitlines() if "warning: " in line)
    subprocess.run([ROOT / "script/search_index", folder / "search_sections.js", folder], check=True)
    if shutil.which("node"):
        run = subprocess.run(["node", ROOT / "script/formulas", folder], capture_output=True, text=True)
        FOUND.extend([run.stdout + run.stderr] if run.returncode else [])
    for name in ("search.js", "search_pages.html"):
        shutil.copy(ROOT / "docs/site/search" / name, folder)


def check_links(folder):
    texts = {path.name: path.read_text() for path in folder.glob("*.html")}
    names = {page: set(re.findall(r'(?:id|name)="([^"]+)"', text)) for page, text in texts.items()}
    for page, text in texts.items():
        if "@ref " in text:
            FOUND.append(f"{page}: shows a raw @ref")
        for link in set(re.findall(r'(?:href|src)="([^"]+)"', text)):
            link = html.unescape(link)
            if re.match(r"[a-z]+:|\$|#$|\w+_8md\.html", link):  # the list of files needs the code
                continue
            target, _, anchor = link.partition("#")
            target = target.partition("?")[0] or page
            if not (folder / target).exists():
                FOUND.append(f"{page}: links to {target}, which does not exist")
            elif anchor and target in names and anchor not in names[target]:
                FOUND.append(f"{page}: links to {link}, which has no such place")


def check_doors():
    """Each tutorial is behind the door learn, each how-to behind the door do."""
    for folder, door in (("tutorials", "learn"), ("howto", "do")):
        shown = (ROOT / f"docs/site/{door}.md").read_text()
        for page in (ROOT / "docs" / folder).glob("*.md"):
            if f"(../{folder}/{page.name})" not in shown:
                FOUND.append(f"docs/site/{door}.md lacks {folder}/{page.name}")


def questions():
    """[question, page of the answer] of each question."""
    text = (ROOT / "docs/questions.md").read_text()
    for part in text.split("\n## ")[1:]:
        yield part.split("\n")[0], re.findall(r"\(([^()#]*)\.md(?:#[^)]*)?\)", part)[-1].split("/")[-1]


PROBE = """<!DOCTYPE html><body><pre id="answer"></pre>
<script src="search_sections.js"></script><script src="search.js"></script>
<script>
const frame = (url) => new Promise((done) => {
  const shown = Object.assign(document.createElement("iframe"), { src: url, width: WIDTH, height: 800 });
  shown.onload = () => { done(shown.contentDocument.documentElement.scrollWidth); shown.remove(); };
  document.body.append(shown);
});
(async () => {
  const index = new Index(sections), widths = {};
  const found = QUESTIONS.map(([question]) => index.find(question).map(({ section }) => section.url));
  for (const url of [...new Set(sections.map(([, , url]) => url.split("#")[0])), "search_pages.html"]) {
    widths[url] = await frame(url);
  }
  document.getElementById("answer").textContent = JSON.stringify({ found, widths });
})();
</script>"""


def browse(chromium, folder):
    """The search's results for each question, and the widths of all pages on a phone."""
    probe = folder / "probe.html"
    probe.write_text(PROBE.replace("WIDTH", str(PHONE)).replace("QUESTIONS", json.dumps(list(questions()))))
    with tempfile.TemporaryDirectory() as profile:
        shown = subprocess.run(
            [chromium, "--headless", "--no-sandbox", "--disable-gpu", "--no-first-run", "--dump-dom",
             "--allow-file-access-from-files", f"--user-data-dir={profile}", "--timeout=60000",
             "--virtual-time-budget=60000", f"file://{probe}"], capture_output=True, text=True, check=True)
    probe.unlink()
    return json.loads(html.unescape(re.search('<pre id="answer">(.*?)</pre>', shown.stdout)[1]))


def check_in_browser(chromium, folder):
    answer = browse(chromium, folder)
    asked = list(questions())
    if len(asked) < 30:
        FOUND.append(f"docs/questions.md has {len(asked)} questions, not 30")
    for (question, page), urls in zip(asked, answer["found"]):
        if not any(re.search(rf"(_|^){page}\.html", url) for url in urls):
            FOUND.append(f"'{question}' does not find {page}: {urls}")
    for url, width in answer["widths"].items():
        if width > PHONE:
            FOUND.append(f"{url} is {width} pixels wide on a phone of {PHONE}")


def main(doxygen, doxyfile, folder, chromium=None):
    folder = pathlib.Path(folder)
    build(doxygen, doxyfile, folder)
    check_links(folder)
    check_doors()
    if chromium:
        check_in_browser(chromium, folder)
    print("\n".join(sorted(set(FOUND))))
    return 1 if FOUND else 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))

"""What mkdocs.yml asks of the manual beyond docs/: pages that stand elsewhere in the tree, the commands as the
parser has them, C++ by Doxygen, and links to other files of the tree, which come along."""

import os
import pathlib
import re

from mkdocs.structure.files import File

TREE = pathlib.Path(__file__).resolve().parent.parent
BUILD = TREE / "build"
ELSEWHERE = {
    "README.md": "index.md",
    "CONTRIBUTING.md": "develop/contributing.md",
    "CHANGELOG.md": "develop/changelog.md",
    "scenes/user/README.md": "guides/example_scenes.md",
}
ORIGIN = {page: path for path, page in ELSEWHERE.items()}


def commands(roff):
    """The manual page of cli/manual.cpp as Markdown."""
    text = roff.replace("\\-", "-").replace("\\e", "\\").replace("\\&", "").replace("<", "&lt;")
    text = text[text.index(".SH OPTIONS") :]
    text = re.sub(r"^\.TP\n\\f[BI](.*?)\\fR(?:\\fI(.*?)\\fR)?\n(.*)$", r"\n`\1\2`\n:   \3\n", text, flags=re.M)
    text = re.sub(r"^\.SH (.*)$", lambda found: "## " + found[1].capitalize(), text, flags=re.M)
    text = re.sub(r"^\.SS (.*)$", r"### \1\n", text, flags=re.M)
    text = re.sub(r"^\.(?:B|I) (.*)\n", r"**\1** ", text, flags=re.M)
    text = re.sub(r"\\f[BI](.*?)\\fR", r"`\1`", text)
    text = re.sub(r"^\.(?:PP|br)$", "", text, flags=re.M)
    return "# Commands\n\nAs `aphotic help COMMAND` prints them.\n\n" + text


def on_files(files, config):
    for path, page in ELSEWHERE.items():
        files.append(File.generated(config, page, abs_src_path=str(TREE / path)))
    roff = (BUILD / "docs-commands.1").read_text()
    files.append(File.generated(config, "reference/commands.md", content=commands(roff)))
    doxygen = BUILD / "doxygen/html"
    for path in sorted(doxygen.rglob("*")):
        if path.is_file():
            page = f"reference/cpp/{path.relative_to(doxygen)}"
            files.append(File.generated(config, page, abs_src_path=str(path)))
    return files


def on_page_markdown(markdown, page, config, files):
    here = page.file.src_uri
    origin = ORIGIN.get(here, "docs/" + here)

    def in_site(found):
        path, anchor = found[1], found[2] or ""
        target = os.path.normpath(os.path.join(os.path.dirname(origin), path))
        if "://" in path or not (TREE / target).is_file():
            return found[0]
        if target in ELSEWHERE:
            target = ELSEWHERE[target]
        elif target.startswith("docs/"):
            target = target.removeprefix("docs/")
        else:
            source = TREE / target
            target = "source/" + target
            if files.get_file_from_path(target) is None:
                files.append(File.generated(config, target, abs_src_path=str(source)))
        return f"]({os.path.relpath(target, os.path.dirname(here) or '.')}{anchor})"

    return re.sub(r"\]\(([^)#\s]+)(#[^)\s]*)?\)", in_site, markdown)

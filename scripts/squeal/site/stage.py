"""The pages of the repository in a folder of their own, as Sphinx wants them: each in its place, under an index that names all."""

import re
import shutil

GROUPS = (("Begin", ("options/tutorial.md", "options/own_brake.md", "scripts/import.md", "scripts/README.md",
                     "scripts/correlate.md", "scripts/python.md")),
          ("By question", ("options/README.md", "options/guides.md", "options/gallery.md", "options/modes.md", "options/static.md",
                           "options/sweeps.md", "options/time.md", "options/models.md")),
          ("Reference", ("options/language.md", "options/analyses.md", "options/results.md", "options/columns.md",
                         "options/columns_time.md", "options/reference.md",
                         *(f"options/reference/{page}.md" for page in ("run", "model", "contact", "modes", "studies", "time")),
                         "include/theory.md", "include/glossary.md")),
          ("Checks and speed", ("tests/validation.md", "tests/validation_errors.md", "tests/validation_time.md",
                                "tests/margins.md", "tests/margins_unit.md",
                                "scripts/bench/README.md", "scripts/bench/demands.md", "scripts/bench/modes.md",
                                "scripts/bench/time.md", "scripts/study/README.md", "scripts/study/speed_error.md",
                                "scripts/study/contact.md", "scripts/study/mesh.md", "scripts/study/paper.md",
                                "scripts/study/reduced.md", "scripts/study/samples.md")),
          ("Developers", ("src/README.md", "tests/README.md", "tests/quality.md", "include/changelog.md")))
FOLDERS = "include", "options", "scripts", "src", "tests"
CODE = re.compile(r"(?<!\[)`([\w./]+)`(?!\]\()")
BLOCK = re.compile(r"(^```.*?^```$|^    .*$)", re.MULTILINE | re.DOTALL)
LANGUAGES = {"geo": "c", "sh-error": "sh", "sh-warning": "sh"}  # as Pygments calls what colours them
LANGUAGE = re.compile(rf"^```({'|'.join(LANGUAGES)})$", re.MULTILINE)
PICTURE = re.compile(r"!\[[^\]]*\]\(([^)]+)\)")


def pages(root):
    """All pages, by their path in the repository."""
    found = [root / "README.md", *(path for folder in FOLDERS for path in sorted((root / folder).rglob("*.md")))]
    return {path.relative_to(root).as_posix(): path for path in found}


def climb(page):
    """From the folder of a page to the top."""
    return "../" * page.count("/")


def linked(text, page, known):
    """A page whose names of other pages and of rooms, in code, are links."""
    def link(match):
        name = match[1].rstrip("/")
        target = next((one for one in (name, f"{name}/README.md") if one in known and one != page), None)
        return f"[`{match[1]}`]({climb(page)}{target})" if target and "/" in match[1] else match[0]

    parts = BLOCK.split(text)
    return "".join(part if i % 2 else CODE.sub(link, part) for i, part in enumerate(parts))


def index(text, known):
    """README.md as the first page, above lists of all others."""
    listed = [page for _, members in GROUPS for page in members if page in known]
    rest = sorted(set(known) - set(listed) - {"README.md"})
    groups = [(title, [page for page in members if page in known]) for title, members in GROUPS] + [("Rooms of the code", rest)]
    trees = ["```{toctree}\n:hidden:\n:caption: " + title + "\n" + "\n".join(page.removesuffix(".md") for page in members) + "\n```"
             for title, members in groups if members]
    return text + "\n\n" + "\n\n".join(trees) + "\n"


def stage(root, folder):
    """Writes all pages and their pictures below a folder."""
    known = pages(root)
    for page, path in known.items():
        text = path.read_text()
        target = folder / ("index.md" if page == "README.md" else page)
        target.parent.mkdir(parents=True, exist_ok=True)
        for picture in PICTURE.findall(text):
            copy = target.parent / picture
            copy.parent.mkdir(parents=True, exist_ok=True)
            shutil.copy(path.parent / picture, copy)
        text = LANGUAGE.sub(lambda match: "```" + LANGUAGES[match[1]], linked(text, page, known))
        target.write_text(index(text, known) if page == "README.md" else text)
    return len(known)

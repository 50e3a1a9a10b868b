"""Documents agree with the code: every file that they name exists, and every function stands in its header."""

import os
import pathlib
import re
import tempfile
import unittest

import layers

SOURCE = layers.repository(os.environ)
FILE = r"`((?:common|examples|kernels|miniapps|perf|scripts|tests)/[\w/.]+\.(?:[ch]pp|py))`"
LINK = re.compile(r"\]\(([^)#:\s]*)(?:#([^)\s]*))?\)")
NAMED = re.compile(FILE + r": (`[\w:]+`(?:, `[\w:]+`)*)")


def without_code(page):
    return re.sub(r"^```.*?^```$", "", page.read_text(encoding="utf-8"), flags=re.MULTILINE | re.DOTALL)


def anchors(page):
    """Anchors of the headings of a page as GitHub makes them: of equal ones, the second ends in -1."""
    found = []
    for heading in re.findall(r"^#+ (.*)", without_code(page), re.MULTILINE):
        anchor = re.sub(r"[^\w\- ]", "", re.sub(r"\]\([^)]*\)", "", heading).strip().lower()).replace(" ", "-")
        found.append(f"{anchor}-{found.count(anchor)}" if anchor in found else anchor)
    return found


class Documents(unittest.TestCase):
    def documents(self):
        for file in sorted((SOURCE / "docs").glob("*.md")):
            yield file.name, file.read_text(encoding="utf-8")

    def test_files_are_there(self):
        for document, text in self.documents():
            for name in re.findall(FILE, text):
                self.assertTrue((SOURCE / name).is_file(), f"{document} names {name}")

    def test_links_have_targets_and_anchors(self):
        count = 0
        for page in (SOURCE / "README.md", *(page for folder in ("docs", "examples", "miniapps", "scripts", "tests")
                                             for page in sorted((SOURCE / folder).rglob("*.md")))):
            for name, anchor in LINK.findall(without_code(page)):
                count += 1
                target = page.parent / name if name else page
                self.assertTrue(target.exists(), f"{page.name}: {name}")
                if anchor:
                    self.assertIn(anchor, anchors(target), f"{page.name}: {name}")
        self.assertGreater(count, 700)

    def test_anchors_are_those_of_github(self):
        with tempfile.TemporaryDirectory() as folder:
            page = pathlib.Path(folder) / "page.md"
            page.write_text("# Runs that go on\n```\n# no heading\n```\n## `A::b`, [link](x.md): 2.5\n## Runs that go on\n")
            self.assertEqual(["runs-that-go-on", "ab-link-25", "runs-that-go-on-1"], anchors(page))

    def test_functions_stand_in_their_headers(self):
        count = 0
        for document, text in self.documents():
            for name, functions in NAMED.findall(text):
                code = (SOURCE / name).read_text(encoding="utf-8")
                for function in re.findall(r"[\w:]+", functions):
                    count += 1
                    # `Solver::advance` is found by its parts.
                    for part in function.split("::"):
                        self.assertRegex(code, rf"\b{part}\b", f"{document} has {function} in {name}")
        self.assertGreater(count, 80)

    def test_page_of_backends_lists_all_code_for_a_device(self):
        page = (SOURCE / "docs/adding-a-backend.md").read_text(encoding="utf-8")
        listed = set(re.findall(FILE, page[page.index("## 5."):page.index("## Constraints")]))
        condition = re.compile(r"^#.*\b(?:KOKKOS_ENABLE_(?:CUDA|HIP)|__CUDA_ARCH__|__(?:CUDA|HIP)CC__)\b", re.MULTILINE)
        found = {file.relative_to(SOURCE).as_posix() for file in (SOURCE / "kernels").rglob("*.[ch]pp")
                 if condition.search(file.read_text(encoding="utf-8"))}
        self.assertEqual(found, listed)

    def test_tests_that_pages_name_exist(self):
        suites = {}
        for file in (SOURCE / "tests").rglob("*.cpp"):
            for suite, name in re.findall(r"^(?:TYPED_)?TEST(?:_F|_P)?\((\w+), (\w+)\)", file.read_text(encoding="utf-8"), re.M):
                suites.setdefault(suite, set()).add(name)
        for file in (SOURCE / "tests").rglob("*.py"):
            for suite, body in re.findall(r"^class (\w+)\(.*?\):\n(.*?)(?=^\S|\Z)", file.read_text(encoding="utf-8"), re.M | re.S):
                suites.setdefault(suite, set()).update(re.findall(r"^    def (test_\w+)", body, re.M))
        count = 0
        for document, text in self.documents():
            for suite, name in re.findall(r"`([A-Z]\w+)\.(\w+)`", text):
                if suite in suites or name.startswith("test_"):
                    count += 1
                    self.assertIn(name, suites.get(suite, ()), f"{document} names {suite}.{name}")
        self.assertGreater(count, 20)

    def test_diagrams_name_classes_of_the_sources(self):
        sources = "\n".join(file.read_text(encoding="utf-8") for folder in ("common", "kernels", "miniapps", "perf")
                            for file in (SOURCE / folder).rglob("*.hpp"))
        declared = set(re.findall(r"\b(?:class|struct|using|concept)\s+(?:\[\[\w+\]\]\s+)?(\w+)", sources))
        count = 0
        for document, text in self.documents():
            # Blocks in pairs of marks: what stands between two blocks is no diagram.
            for language, diagram in re.findall(r"^```(\w*)\n(.*?)^```$", text, re.DOTALL | re.MULTILINE):
                if language:
                    continue
                for name in re.findall(r"\b[A-Z][a-z]+(?:[A-Z][a-z]+)+\b(?!\.\w)|\b[A-Z]\w+(?=<|::)", diagram):
                    count += 1
                    self.assertTrue(name in declared, f"{document} draws {name}")
        self.assertGreater(count, 10)

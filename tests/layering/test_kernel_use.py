"""docs/kernel-use.md is up to date, and its generator follows includes, sources and explicit instantiations."""

import os
import sys
import unittest

import layers

ROOT = layers.repository(os.environ)
sys.path.insert(0, str(ROOT / "scripts"))
import kernel_use  # noqa: E402


class Repository(unittest.TestCase):
    def test_page_is_up_to_date(self):
        text = kernel_use.page(kernel_use.read_sources(ROOT))
        self.assertEqual(text, kernel_use.PAGE.read_text(encoding="utf-8"), "run scripts/kernel_use.py")


class FollowsIncludes(unittest.TestCase):
    INCLUDES = {
        "miniapps/gas/main.cpp": ["miniapps/gas/app.hpp"],
        "miniapps/gas/app.hpp": ["kernels/gas/solver.hpp"],
        "miniapps/framework/loop.hpp": [],
        "perf/main.cpp": ["kernels/linear/scan.hpp"],
        "kernels/gas/solver.hpp": [],
        "kernels/gas/solver.cpp": ["kernels/gas/solver.hpp", "kernels/gas/tile/launch.hpp"],
        "kernels/gas/tile/launch.hpp": [],
        "kernels/gas/flux/weno.hpp": [],
        "kernels/gas/instances/stage.cpp": ["kernels/gas/tile/launch_impl.hpp"],
        "kernels/gas/tile/launch_impl.hpp": ["kernels/gas/tile/launch.hpp", "kernels/gas/flux/weno.hpp"],
        "kernels/gas/unused/other.hpp": [],
        "kernels/linear/scan.hpp": [],
    }

    def test_files_behind_a_program(self):
        programs = kernel_use.programs(self.INCLUDES)
        self.assertEqual({"gas", "perf"}, set(programs))
        used = kernel_use.used_by(programs["gas"], self.INCLUDES)
        self.assertEqual({path for path in self.INCLUDES if path.startswith(("miniapps/gas/", "kernels/gas/"))}
                         - {"kernels/gas/unused/other.hpp"}, used)

    def test_marks_of_folders(self):
        rows = {}
        for line in kernel_use.page(self.INCLUDES).splitlines():
            name, *marks = [cell.strip() for cell in line.strip("|").split("|")]
            rows.setdefault(name.strip("`"), marks)
        self.assertEqual(["●", ""], rows["kernels/gas"])
        self.assertEqual(["○", ""], rows["kernels/gas/flux"])
        self.assertEqual(["", "●"], rows["kernels/linear"])
        self.assertEqual(["", ""], rows["kernels/gas/unused"])
        self.assertEqual(["●", ""], rows["kernels/gas/solver.hpp"])


if __name__ == "__main__":
    unittest.main()

"""docs/kernel-use.md is up to date, and its generator follows includes, sources and explicit instantiations."""

import os
import sys
import tempfile
import unittest
from pathlib import Path

import layers

ROOT = layers.repository(os.environ)
sys.path.insert(0, str(ROOT / "scripts"))
import kernel_use  # noqa: E402


class Repository(unittest.TestCase):
    def test_page_is_up_to_date(self):
        includes = kernel_use.read_sources(ROOT)
        text = kernel_use.page(includes, kernel_use.read_users(ROOT, includes))
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
        "kernels/gas/instances/row.cpp": ["kernels/gas/row/row_impl.hpp"],
        "kernels/gas/row/row_impl.hpp": ["kernels/gas/row/row.hpp", "kernels/gas/flux/weno.hpp"],
        "kernels/gas/row/row.hpp": [],
        "kernels/linear/scan.hpp": [],
    }
    USERS = {
        "kernels/gas/instances/stage.cpp": {"kernels/gas/tile/launch.hpp", "kernels/gas/tile/launch_impl.hpp"},
        "kernels/gas/instances/row.cpp": {"kernels/gas/row/row.hpp", "kernels/gas/row/row_impl.hpp"},
    }

    def test_files_behind_a_program(self):
        programs = kernel_use.programs(self.INCLUDES)
        self.assertEqual({"gas", "perf"}, set(programs))
        used = kernel_use.used_by(programs["gas"], self.INCLUDES, self.USERS)
        self.assertEqual({path for path in self.INCLUDES if path.startswith(("miniapps/gas/", "kernels/gas/"))}
                         - {"kernels/gas/unused/other.hpp", *self.USERS["kernels/gas/instances/row.cpp"],
                            "kernels/gas/instances/row.cpp"}, used)

    def test_finds_users_of_instances(self):
        with tempfile.TemporaryDirectory() as folder:
            texts = {
                "kernels/gas/instances/stage.cpp": "template void launch_stage<Weno::js>(const Space&,\n  int);\n",
                "kernels/gas/instances/solver.cpp": "template class GasSolver<Space>;\ntemplate P<S> make_solver<Space>(int);\n",
                "kernels/gas/tile/launch.hpp": "void launch_stage(int);\n",
                "kernels/gas/solver.cpp": "auto p = make_solver<Serial>(1);\n",
                "kernels/gas/gas_solver.hpp": "class GasSolver {\n};\n",
                "kernels/gas/flux/weno.hpp": "double weno(double x);\n",
                "kernels/flow/launch.hpp": "void launch_stage(int);\n",
            }
            for name, text in texts.items():
                path = Path(folder) / name
                path.parent.mkdir(parents=True, exist_ok=True)
                path.write_text(text)
            self.assertEqual({"kernels/gas/instances/stage.cpp": {"kernels/gas/tile/launch.hpp"},
                              "kernels/gas/instances/solver.cpp": {"kernels/gas/solver.cpp", "kernels/gas/gas_solver.hpp"}},
                             kernel_use.read_users(Path(folder), texts))

    def test_marks_of_folders(self):
        rows = {}
        for line in kernel_use.page(self.INCLUDES, self.USERS).splitlines():
            name, *marks = [cell.strip() for cell in line.strip("|").split("|")]
            rows.setdefault(name.strip("`"), marks)
        self.assertEqual(["●", ""], rows["kernels/gas"])
        self.assertEqual(["○", ""], rows["kernels/gas/flux"])
        self.assertEqual(["", "●"], rows["kernels/linear"])
        self.assertEqual(["", ""], rows["kernels/gas/unused"])
        self.assertEqual(["", ""], rows["kernels/gas/row"])
        self.assertEqual(["●", ""], rows["kernels/gas/solver.hpp"])

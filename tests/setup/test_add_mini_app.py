# ctest-label: no-sanitizer
"""drogue_add_mini_app makes a program of one source, and of several, which find the folder of their scenes."""

import os
import subprocess
import tempfile
import unittest
from pathlib import Path

SOURCE = Path(os.environ.get("DROGUE_SOURCE", Path(__file__).resolve().parents[2]))
PROJECT = f"""
cmake_minimum_required(VERSION 3.25)
project(MiniApps LANGUAGES CXX)
include(GNUInstallDirs)
list(APPEND CMAKE_MODULE_PATH "{SOURCE}/cmake")
# The framework and what compiles Drogue's own code are not needed here.
add_library(drogue_framework INTERFACE)
add_library(drogue_reference INTERFACE)
function(drogue_optimise_little)
endfunction()
function(drogue_share_standard)
endfunction()
function(drogue_unite)
endfunction()
include(DrogueProgram)
include(DrogueMiniApp)
add_subdirectory(single)
add_subdirectory(double)
"""
PRINT = '#include <cstdio>\nint main() {{ return std::puts({text}) < 0; }}\n'


class AddMiniApp(unittest.TestCase):
    def test_programs_find_their_scenes(self):
        with tempfile.TemporaryDirectory() as folder:
            work = Path(folder)
            files = {
                "CMakeLists.txt": PROJECT,
                "single/CMakeLists.txt": "drogue_add_mini_app(single)\n",
                "single/main.cpp": PRINT.format(text="DROGUE_SINGLE_SCENES"),
                "double/CMakeLists.txt": "drogue_add_mini_app(double)\n",
                "double/main.cpp": "const char* scenes();\n" + PRINT.format(text="scenes()"),
                "double/scene/scene.cpp": "const char* scenes() { return DROGUE_DOUBLE_SCENES; }\n",
            }
            for name, text in files.items():
                (work / name).parent.mkdir(parents=True, exist_ok=True)
                (work / name).write_text(text, encoding="utf-8")
            for command in (["-S", work, "-B", work / "build", "-G", "Ninja"], ["--build", work / "build"]):
                done = subprocess.run(["cmake", *command], capture_output=True, text=True)
                self.assertEqual(0, done.returncode, done.stdout + done.stderr)
            for name in ("single", "double"):
                program = work / "build" / name / f"drogue-{name}"
                shown = subprocess.run([program], capture_output=True, text=True, check=True).stdout
                self.assertEqual(f"{work}/{name}/scenes\n", shown)

"""Starts a module of this package: python3 -I start.py MODULE [ARGUMENT...]

With -I, Python executes no file of the working folder and obeys no PYTHON* variable. Folders of PYTHONPATH, where modules of clusters
keep their packages, and those of `pip install --user` come last, so that they hide nothing of the interpreter.
"""

import os
import runpy
import site
import sys

if sys.version_info < (3, 11):
    sys.stderr.write("drogue-plot: Python 3.11 or newer is needed: %s is older.\n" % sys.executable)
    sys.exit(2)
sys.path.insert(0, os.path.dirname(os.path.dirname(os.path.realpath(__file__))))
added = os.environ.get("PYTHONPATH", "").split(os.pathsep) + [site.getusersitepackages()]
sys.path += filter(os.path.isabs, added)
del sys.argv[0]
runpy.run_module(sys.argv[0], run_name="__main__", alter_sys=True)

"""The wheel of python/, built without a network, imported from where it is installed.

    check_wheel.py FOLDER_OF_pyproject VERSION
"""

import os
import shutil
import subprocess
import sys
import zipfile

source, version = sys.argv[1:3]
shutil.copytree(source, "package", ignore=shutil.ignore_patterns("__pycache__"))
build = "from setuptools import build_meta; print(build_meta.build_wheel('..'))"
done = subprocess.run([sys.executable, "-c", build], cwd="package", capture_output=True, text=True)
assert done.returncode == 0, done.stderr
wheel = done.stdout.split()[-1]
assert wheel == f"neve-{version}-py3-none-any.whl", wheel
with zipfile.ZipFile(wheel) as archive:
    archive.extractall("site")
# As an installed package: no checkout around it, the program in PATH or in NEVE.
use = "import neve, sys; print(neve.program()); print(len(neve.params()) > 100)"
program = os.environ["NEVE"]
os.makedirs("programs")
os.symlink(program, "programs/neve")
for variables in ({"NEVE": program}, {"PATH": os.path.abspath("programs")}):
    done = subprocess.run([sys.executable, "-c", use], capture_output=True, text=True,
                          env={"PYTHONPATH": os.path.abspath("site"), "HOME": os.getcwd(), **variables})
    assert done.stdout.split() == [variables.get("NEVE", os.path.abspath("programs/neve")), "True"], (
        done.stdout, done.stderr)
print("same")

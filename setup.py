"""Builds the compiled module of the package by CMake. pyproject.toml has all else.

Needs a C++20 compiler, CMake, Eigen, GeographicLib, fmt, toml++, nlohmann-json and pybind11, whose
packages script/bootstrap installs on Debian. GSL is not used, so the wheel is BSD-3-Clause.
"""

import os
import pathlib
import re
import subprocess
import sys

from setuptools import Extension, setup
from setuptools.command.build_ext import build_ext

ROOT = pathlib.Path(__file__).resolve().parent


class ByCMake(build_ext):
    """Configures and builds the target kreisel_python, and copies the module into the package."""

    def build_extension(self, extension):
        build = pathlib.Path(self.build_temp).resolve()
        options = {"CMAKE_BUILD_TYPE": "Release", "KREISEL_WITH_PYTHON": "ON",
                   "KREISEL_WITH_GSL": "OFF", "KREISEL_WITH_MPI": "OFF",
                   "KREISEL_WITH_SUNDIALS": "OFF", "KREISEL_BUILD_TESTS": "OFF",
                   "KREISEL_BUILD_EXAMPLES": "OFF", "Python_EXECUTABLE": sys.executable}
        subprocess.run(["cmake", "-S", ROOT, "-B", build,
                        *(f"-D{key}={value}" for key, value in options.items())], check=True)
        subprocess.run(["cmake", "--build", build, "--target", "kreisel_python",
                        "--parallel", str(os.cpu_count())], check=True)
        built, = (build / "python/kreisel").glob("_kreisel*.so")
        target = pathlib.Path(self.get_ext_fullpath(extension.name))
        self.mkpath(str(target.parent))
        self.copy_file(str(built), str(target))


setup(
    version=re.search(r"VERSION ([0-9.]+)", (ROOT / "CMakeLists.txt").read_text().split("project(")[1])[1],
    ext_modules=[Extension("kreisel._kreisel", sources=[])],
    cmdclass={"build_ext": ByCMake})

"""kreisel for Conan 2:  conan create packaging/conan -o "kreisel/*:earth=True" """

import os

from conan import ConanFile
from conan.tools.build import check_min_cppstd
from conan.tools.cmake import CMake, CMakeDeps, CMakeToolchain, cmake_layout
from conan.tools.files import copy, rmdir
from conan.tools.gnu import PkgConfigDeps


class Kreisel(ConanFile):
    name = "kreisel"
    version = "1.0.0"
    description = "Rigid bodies, pendulums and gyros seen from moving reference frames"
    license = "BSD-3-Clause"
    package_type = "static-library"
    settings = "os", "arch", "compiler", "build_type"
    options = {
        "earth": [True, False],  # kreisel::earth, gravity of the ellipsoid
        "gsl": [True, False],  # kreisel::gsl, steppers and special functions of GSL: GPL-3
    }
    default_options = {"earth": False, "gsl": False}

    def export_sources(self):
        root = os.path.join(self.recipe_folder, "..", "..")
        for pattern in ("CMakeLists.txt", "README.md", "LICENSE", "CHANGELOG.md",
                        "CONTRIBUTING.md", "motor/*", "dynamics/*", "docs/*", "examples/*",
                        "programs/*", "packaging/*"):
            copy(self, pattern, root, self.export_sources_folder)

    def layout(self):
        cmake_layout(self)

    def requirements(self):
        self.requires("eigen/3.4.0", transitive_headers=True)
        if self.options.earth:
            self.requires("geographiclib/[>=2.1 <3]", transitive_headers=True)
        if self.options.gsl:
            self.requires("gsl/[>=2.7 <3]", transitive_headers=True)

    def build_requirements(self):
        if self.options.earth:
            self.tool_requires("pkgconf/[>=2 <3]")

    def validate(self):
        check_min_cppstd(self, 20)

    def generate(self):
        toolchain = CMakeToolchain(self)
        toolchain.cache_variables.update({
            "KREISEL_WITH_GEOGRAPHICLIB": bool(self.options.earth),
            "KREISEL_WITH_GSL": bool(self.options.gsl),
            "KREISEL_WITH_SUNDIALS": False,
            "KREISEL_WITH_SCENE_FILES": False,
            "KREISEL_BUILD_TESTS": False,
            "KREISEL_BUILD_EXAMPLES": False,
        })
        toolchain.generate()
        CMakeDeps(self).generate()
        if self.options.earth:
            PkgConfigDeps(self).generate()

    def build(self):
        cmake = CMake(self)
        cmake.configure()
        cmake.build()

    def package(self):
        CMake(self).install()
        copy(self, "LICENSE", self.source_folder, os.path.join(self.package_folder, "licenses"))
        for folder in ("share", "lib/cmake", "lib/pkgconfig"):  # Conan writes its own files
            rmdir(self, os.path.join(self.package_folder, folder))

    def package_info(self):
        self.cpp_info.set_property("cmake_file_name", "kreisel")
        self._component("motor", ["eigen::eigen"])
        self._component("dynamics", ["motor"])
        if self.options.earth:
            self._component("earth", ["dynamics", "geographiclib::geographiclib"])
        if self.options.gsl:
            self._component("gsl", ["dynamics", "gsl::gsl"])

    def _component(self, name, requires):
        component = self.cpp_info.components[name]
        component.set_property("cmake_target_name", f"kreisel::{name}")
        component.set_property("pkg_config_name", f"kreisel-{name}")
        component.includedirs = [os.path.join("include", "kreisel")]
        component.bindirs = []
        component.libs = ["kreisel"] if name == "dynamics" else []
        component.requires = requires

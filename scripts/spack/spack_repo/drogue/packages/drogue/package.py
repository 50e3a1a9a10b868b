"""Recipe for Spack 1.0 or newer, in a clone: `spack repo add scripts/spack/spack_repo/drogue`, `spack dev-build drogue@main`."""

from spack_repo.builtin.build_systems.cmake import CMakePackage
from spack_repo.builtin.build_systems.cuda import CudaPackage

from spack.package import *


class Drogue(CMakePackage, CudaPackage):
    """Verified GPU and CPU mini-apps on Kokkos: gas dynamics and more, each with an independent oracle."""

    license("BSD-3-Clause")

    version("main")

    variant("exact", default=False, description="No fused multiply-add: backends agree bit for bit")
    variant("openmp", default=True, description="OpenMP backend")

    depends_on("c", type="build")
    depends_on("cxx", type="build")
    depends_on("cmake@3.25:", type="build")
    # CMake takes the releases that were tried. Both packages are of one.
    depends_on("kokkos@4.5.01,4.6.01,4.7.00 +serial cxxstd=20")
    depends_on("kokkos+openmp", when="+openmp")
    depends_on("kokkos-kernels@4.5.01,4.6.01,4.7.00")
    depends_on("mpi")
    depends_on("hdf5@1.10: +mpi")
    variant("hypre", default=True, description="hypre as a pressure solver of flows")
    depends_on("hypre@2.26: +mpi", when="+hypre")
    depends_on("tomlplusplus@3.3:")
    depends_on("cli11@2:")
    depends_on("nlohmann-json@3.11:")
    depends_on("muparser@2.3:")
    depends_on("fftw@3.3: precision=double")
    depends_on("boost@1.74:")
    depends_on("googletest@1.12:", type="build")
    depends_on("python@3.11:", type=("build", "run"))
    depends_on("py-numpy", type="run")
    depends_on("py-matplotlib", type="run")
    depends_on("py-h5py", type="run")
    depends_on("py-jinja2", type="run")
    depends_on("py-pillow", type="run")

    # The mdspan View of this release is miscompiled by nvcc as C++20.
    conflicts("^kokkos@4.7.00", when="+cuda")
    conflicts("%gcc@:11")
    for _arch in ("80", "86", "89", "90", "100"):
        depends_on(f"kokkos+cuda~wrapper+cmake_lang cuda_arch={_arch}", when=f"+cuda cuda_arch={_arch}")
    conflicts("cuda_arch=none", when="+cuda", msg="name one GPU architecture, for example cuda_arch=90")

    def cmake_args(self):
        arguments = [
            self.define("DROGUE_SYSTEM", True), self.define("BUILD_TESTING", self.run_tests),
            self.define_from_variant("DROGUE_EXACT", "exact"),
            self.define_from_variant("DROGUE_OPENMP", "openmp"),
            self.define("CMAKE_DISABLE_FIND_PACKAGE_HYPRE", self.spec.satisfies("~hypre")),
            self.define_from_variant("DROGUE_CUDA", "cuda"),
        ]
        if self.spec.satisfies("+cuda"):
            arguments.append(self.define("DROGUE_CUDA_ARCH", self.spec.variants["cuda_arch"].value[0]))
        return arguments

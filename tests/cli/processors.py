#!/usr/bin/python3
"""The tests on other processors and with another compiler: builds them and runs those labelled unit and short. And the
package, whose program takes the widest vectors that a machine has.

  v3        vectors of four (AVX2), as most machines have them
  baseline  vectors of two (SSE2), which every x86-64 has
  clang     clang with its OpenMP, for this machine
  aarch64   vectors of two (NEON), built by Debian's cross compiler (g++-aarch64-linux-gnu) and run by qemu-user; the
            tests of kernels/ alone, or with MPMFAST_ARM64 all that are labelled unit
  package   the Debian package, unpacked: which libraries its program and its Python module take

Skipped where the compiler, or what runs its programs, is missing. With what the first line fetches, the second tests more:

  processors.py libraries FOLDER                           arm64 packages of Debian; nothing is installed
  MPMFAST_ARM64=FOLDER processors.py aarch64 SOURCE_DIR BUILD_DIR

usage: processors.py v3|baseline|clang|aarch64|package SOURCE_DIR BUILD_DIR
       (builds in BUILD_DIR/processors; JOBS=N of them and of the tests at a time, 2 without)
"""
import concurrent.futures
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys

JOBS = int(os.environ.get("JOBS", "2"))
LIBRARIES = ["libyaml-cpp-dev", "libfmt-dev", "zlib1g-dev", "libpugixml-dev", "libhdf5-dev", "libcairo2-dev"]
CROSS = "aarch64-linux-gnu"
LOADER = "/lib64/ld-linux-x86-64.so.2"


def skip(why):
    print(f"skipped: {why}")
    sys.exit(77)


def do(*words, **options):
    print("+", *words, flush=True)
    if subprocess.run([str(word) for word in words], **options).returncode != 0:
        sys.exit(1)


def needs(*programs):
    missing = [name for name in programs if not shutil.which(name)]
    if missing:
        skip(f"no {', '.join(missing)}")


def build_and_test(source, build, labels, *settings):
    """@param settings  NAME=VALUE of CMake"""
    do("cmake", "-S", source, "-B", build, "-G", "Ninja", "-DCMAKE_BUILD_TYPE=Release", "-DMPMFAST_BENCH=OFF",
       "-DMPMFAST_PRECOMPILE=ON", "-DMPMFAST_WERROR=ON", *(f"-D{setting}" for setting in settings))
    do("cmake", "--build", build, "--target", "quick_tests", "-j", JOBS)
    do("ctest", "--test-dir", build, "--output-on-failure", "-j", JOBS, "-L", labels, "-LE", "slow")


def levels():
    """Of x86-64, which this processor has, the lowest first; the loader says."""
    said = subprocess.run([LOADER, "--help"], capture_output=True, text=True).stdout
    return sorted(re.findall(r"(x86-64-v\d) \(supported", said))


def v3(source, build):
    needs("g++")
    if "x86-64-v3" not in levels():
        skip("this processor has no AVX2")
    build_and_test(source, build, "unit|short", "MPMFAST_ARCH=x86-64-v3", "CMAKE_CXX_COMPILER=g++")


def baseline(source, build):
    needs("g++")
    if os.uname().machine != "x86_64":
        skip("this processor is no x86-64")
    build_and_test(source, build, "unit|short", "MPMFAST_ARCH=x86-64", "CMAKE_CXX_COMPILER=g++")


def clang(source, build):
    compiler = next(filter(shutil.which, ["clang++-14", "clang++"]), None)
    if not compiler:
        skip("no clang++-14")
    if subprocess.run([compiler, "-fopenmp", "-x", "c++", "-", "-o", os.devnull], input=b"#include <omp.h>\nint main() {}",
                      capture_output=True).returncode != 0:
        skip(f"no OpenMP of {compiler} (libomp-14-dev)")
    build_and_test(source, build, "unit|short", f"CMAKE_CXX_COMPILER={compiler}")


def aarch64(source, build):
    needs(f"{CROSS}-g++", "qemu-aarch64")
    root = os.environ.get("MPMFAST_ARM64")
    if not root:
        return kernel_tests(source, build)
    folders = [f"{os.path.abspath(root)}/{folder}/{CROSS}" for folder in ("usr/lib", "lib")]
    # The loader of the same release as the C library: the compiler's own reads the lists of threads elsewhere.
    emulator = ["qemu-aarch64", "-L", os.path.abspath(root), "-E",
                f"LD_LIBRARY_PATH={':'.join([*folders, f'/usr/{CROSS}/lib'])}"]
    build_and_test(source, build, "unit", "MPMFAST_NATIVE=OFF", "CMAKE_SYSTEM_NAME=Linux", "CMAKE_SYSTEM_PROCESSOR=aarch64",
                   f"CMAKE_CXX_COMPILER={CROSS}-g++", f"CMAKE_FIND_ROOT_PATH={os.path.abspath(root)}",
                   *(f"CMAKE_FIND_ROOT_PATH_MODE_{kind}=BOTH" for kind in ("LIBRARY", "INCLUDE", "PACKAGE")),
                   "CMAKE_EXE_LINKER_FLAGS=" + " ".join(f"-Wl,-rpath-link,{folder}" for folder in folders),
                   f"CMAKE_CROSSCOMPILING_EMULATOR={';'.join(emulator)}")


def kernel_tests(source, build):
    """They need headers alone, which are the same for every processor."""
    entries = json.loads((build.parent.parent / "compile_commands.json").read_text())
    sources = [entry["file"] for entry in entries if "kernel_tests.dir/" in entry["command"]]
    sources = [name for name in sources if not name.endswith("cmake_pch.hxx.cxx")]
    sources += [f"{source}/tests/main.cpp", f"{source}/tests/source_folder.cpp"]
    flags = ["-std=c++20", "-O3", "-DNDEBUG", "-fopenmp", "-fno-math-errno", "-fno-trapping-math", "-Wall", "-Wextra",
             "-Wconversion", "-Wno-psabi", "-Werror", f"-I{source}", "-isystem", "/usr/include/eigen3",
             f'-DMPMFAST_SOURCE_DIR="{source}"']
    build.mkdir(parents=True, exist_ok=True)

    def compiled(name):
        made = build / (pathlib.Path(name).stem + ".o")
        return made, subprocess.run([f"{CROSS}-g++", *flags, "-c", name, "-o", made]).returncode

    with concurrent.futures.ThreadPoolExecutor(JOBS) as pool:
        objects, codes = zip(*pool.map(compiled, sources))
    if any(codes):
        sys.exit(1)
    do(f"{CROSS}-g++", "-fopenmp", *objects, "-o", build / "kernel_tests")
    do("qemu-aarch64", "-L", f"/usr/{CROSS}", build / "kernel_tests")


def package(source, build):
    needs("g++", "dpkg-shlibdeps", "dpkg")
    if "x86-64-v3" not in levels():
        skip("this processor has no AVX2")
    do("cmake", "--preset", "package", "-B", build, cwd=source)
    do("cmake", "--build", build, "-j", JOBS, env={**os.environ, "CMAKE_BUILD_PARALLEL_LEVEL": str(JOBS)})
    for old in [build / "packages", build / "unpacked"]:
        shutil.rmtree(old, ignore_errors=True)
    do("cpack", "--config", build / "CPackConfig.cmake", "-B", build / "packages")
    do("dpkg", "-x", next((build / "packages").glob("mpmfast_*.deb")), build / "unpacked")
    check_package(source, build / "unpacked" / "usr")


def check_package(source, root):
    """The loader's mask makes this processor one of a lower level."""
    environment = {**os.environ, "OMP_WAIT_POLICY": "passive", "OMP_NUM_THREADS": "1",  # else the program starts itself again
                   "PYTHONPATH": str(root / "lib/python3/dist-packages")}
    built = [level for level in ("x86-64-v3", "x86-64-v4") if level in levels()]

    def answer(*words):
        run = subprocess.run([str(word) for word in words], env=environment, capture_output=True, text=True)
        assert run.returncode == 0, f"{words}: {run.stdout}{run.stderr}"
        return run.stdout

    for count in range(len(built) + 1):
        known = built[:count]
        loader = [LOADER, "--glibc-hwcaps-mask", ":".join(known) or "none"]
        said = answer(*loader, root / "bin/mpmfast", "--version")
        print(f"with {', '.join(known) or 'neither level'}: {said.splitlines()[-1]}")
        assert f"-march={known[-1]}" in said if known else "-march" not in said, said
        maps = answer(*loader, "/usr/bin/python3", "-c", "import mpmfast; print(open('/proc/self/maps').read())")
        library = next(line.split()[-1] for line in maps.splitlines() if "libmpmfast" in line)
        assert known[-1] in library if known else "hwcaps" not in library, library
    assert f"-march={built[-1]}" in answer(root / "bin/mpmfast", "--version"), "the widest is not taken"
    scene = source / "configs" / "thick_ring.yaml"
    answer(root / "bin/mpmfast", "run", scene, "--steps", "3", "--progress", "none", "--force", "--out", root / "run")


def libraries(folder):
    """A list of packages, a cache and a status of its own: the machine's packages are neither asked nor changed."""
    folder = pathlib.Path(folder).absolute()
    for name in ("apt/state/lists/partial", "apt/cache/archives/partial"):
        (folder / name).mkdir(parents=True, exist_ok=True)
    status = folder / "apt" / "status"
    status.touch()
    apt = ["apt-get", "-o", f"Dir::State={folder}/apt/state", "-o", f"Dir::State::status={status}", "-o",
           f"Dir::Cache={folder}/apt/cache", "-o", "APT::Architecture=arm64", "-o", "APT::Architectures::=arm64", "-o",
           "APT::Sandbox::User=root"]
    do(*apt, "update")
    do(*apt, "install", "-y", "--download-only", "--no-install-recommends", *LIBRARIES)
    for package in sorted((folder / "apt/cache/archives").glob("*.deb")):
        if not package.name.startswith(("libc6-dev", "linux-libc-dev", "libcrypt-dev")):  # the cross compiler has them
            do("dpkg", "-x", package, folder)


PROCESSORS = {"v3": v3, "baseline": baseline, "clang": clang, "aarch64": aarch64, "package": package}

if __name__ == "__main__":
    if len(sys.argv) == 3 and sys.argv[1] == "libraries":
        libraries(sys.argv[2])
    elif len(sys.argv) == 4 and sys.argv[1] in PROCESSORS:
        PROCESSORS[sys.argv[1]](pathlib.Path(sys.argv[2]).absolute(),
                                pathlib.Path(sys.argv[3]).absolute() / "processors" / sys.argv[1])
    else:
        sys.exit(__doc__)

"""The wheel: what is in it, and that it works in an empty folder of an environment that has no checkout.

Nothing is downloaded: the build uses the setuptools that is installed (extra `dev`), and the new environment
sees the dependencies of the present one. Kernels that the checkout has compiled go into the wheel.
"""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
import sysconfig
import tarfile
import zipfile
from pathlib import Path

import pytest

from morfax.motion import machine_code
from tests.rooms import ROOMS

ROOT = Path(__file__).parents[2]
# of a checkout, what makes the wheel; the links in morfax/ are copied as links
SOURCES = ("morfax", *ROOMS, "pyproject.toml", "README.md", "LICENSE")


def run(*command: str | Path, folder: Path, **settings: str) -> str:
    """Run a command in a folder, without the paths and caches of this process; give its standard output."""
    ours = ("PYTHONPATH", "NUMBA_CACHE_DIR", "VIRTUAL_ENV")
    environment = {name: value for name, value in os.environ.items() if name not in ours}
    environment |= settings
    done = subprocess.run(
        [str(word) for word in command],
        cwd=folder,
        env=environment,
        capture_output=True,
        text=True,
    )
    assert done.returncode == 0, (
        f"{command} ended with {done.returncode}:\n{done.stdout}\n{done.stderr}"
    )
    return done.stdout


def in_checkout() -> set[str]:
    """Every module of the rooms, by its name in the wheel."""
    modules = [file for room in ROOMS for file in (ROOT / room).rglob("*.py")]
    top = {f"morfax/{file.name}" for file in (ROOT / "morfax").glob("*.py")}
    return top | {f"morfax/{file.relative_to(ROOT).as_posix()}" for file in modules}


@pytest.fixture(scope="module")
def built(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The folder `dist` of a clean copy: a source distribution, and the wheel that is built from it.

    Both bring compiled kernels along, as with `make wheel`, where machine code can be kept.
    """
    copy = tmp_path_factory.mktemp("checkout")
    left_out = shutil.ignore_patterns("__pycache__", "*.egg-info", "*.told", "kernels")
    for name in SOURCES:
        source = ROOT / name
        if source.is_dir():
            shutil.copytree(source, copy / name, symlinks=True, ignore=left_out)
        else:
            shutil.copy(source, copy / name)
    if machine_code.can_be_kept():
        run(sys.executable, "-m", "morfax.motion.wheel_kernels", folder=copy)
    run(sys.executable, "-m", "build", "--no-isolation", folder=copy)
    return copy / "dist"


@pytest.fixture(scope="module")
def wheel(built: Path) -> Path:
    """The wheel."""
    (file,) = built.glob("*.whl")
    return file


@pytest.fixture(scope="module")
def installed(wheel: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A new environment with the wheel in it; its dependencies are those of the present environment."""
    environment = tmp_path_factory.mktemp("environment")
    run(sys.executable, "-m", "venv", "--without-pip", environment, folder=environment)
    python = environment / "bin" / "python"
    pip = (sys.executable, "-m", "pip", "--python", python)
    run(*pip, "install", "--no-deps", "--no-index", "--quiet", wheel, folder=environment)
    (site_packages,) = environment.glob("lib/python*/site-packages")
    dependencies = sysconfig.get_paths()["purelib"]
    (site_packages / "dependencies.pth").write_text(f"{dependencies}\n", encoding="utf-8")
    return environment


def test_nothing_but_morfax_is_in_the_wheel(wheel: Path) -> None:
    names = zipfile.ZipFile(wheel).namelist()
    version = wheel.name.split("-")[1]
    assert {name.split("/")[0] for name in names} == {"morfax", f"morfax-{version}.dist-info"}


def test_every_module_of_every_room_is_in_the_wheel(wheel: Path) -> None:
    names = zipfile.ZipFile(wheel).namelist()
    assert {name for name in names if name.endswith(".py")} == in_checkout()


def test_drawings_tables_and_type_hints_are_in_the_wheel(wheel: Path) -> None:
    names = set(zipfile.ZipFile(wheel).namelist())
    data = [*(ROOT / "samples").glob("*.png")]
    data += [file for room in ROOMS for file in (ROOT / room).rglob("*.toml")]
    data += [ROOT / "motion" / "kernels.tsv"]
    assert "samples/program.toml" in {file.relative_to(ROOT).as_posix() for file in data}
    assert {f"morfax/{file.relative_to(ROOT).as_posix()}" for file in data} <= names
    assert "morfax/py.typed" in names


def test_a_wheel_from_the_checkout_is_the_one_from_the_source_distribution(
    built: Path, wheel: Path, tmp_path: Path
) -> None:
    run(
        sys.executable,
        "-m",
        "build",
        "--no-isolation",
        "--wheel",
        "-o",
        tmp_path,
        folder=built.parent,
    )
    direct = zipfile.ZipFile(tmp_path / wheel.name)
    assert sorted(direct.namelist()) == sorted(zipfile.ZipFile(wheel).namelist())


def test_the_source_distribution_holds_each_module_once(built: Path) -> None:
    (file,) = built.glob("*.tar.gz")
    with tarfile.open(file) as archive:
        names = [name.split("/", 1)[-1] for name in archive.getnames()]
    modules = [name for name in names if name.endswith(".py")]
    assert len(modules) == len(set(modules)) == len(in_checkout())


def test_the_installed_command_traces_and_plays_in_an_empty_folder(
    installed: Path, tmp_path: Path
) -> None:
    python, morfax = installed / "bin" / "python", installed / "bin" / "morfax"
    where = Path(
        run(python, "-c", "import morfax; print(morfax.__file__)", folder=tmp_path).strip()
    )
    assert where.is_relative_to(installed)
    told = run(morfax, "demo", folder=tmp_path)
    assert "played to ink" in told
    results = {f"program.{end}" for end in ("wav", "traced.csv", "played.csv", "png", "json")}
    demo = tmp_path / "morfax-demo"
    assert {file.name for file in (demo / "results").iterdir()} == results
    unpacked = {"program.png", "program.toml", "cam.png"}
    assert {file.name for file in demo.iterdir()} == {*unpacked, "results"}


@pytest.mark.skipif(not machine_code.can_be_kept(), reason="numba runs the kernels here")
def test_the_first_commands_of_a_user_of_the_wheel_compile_nothing(
    installed: Path, wheel: Path, tmp_path: Path
) -> None:
    """The wheel brings the kernels along. A damaged one is made anew, in the user's own folder."""
    home, morfax = tmp_path / "caches", installed / "bin" / "morfax"
    names = [name for name in zipfile.ZipFile(wheel).namelist() if name.endswith(".kernel")]
    assert (
        len(names) > 100
    )  # of 117 in the list; some kernels are there with two types of arguments
    drawing = ROOT / "samples" / "gear.png"
    words = ("trace", drawing, "--lines", "all", "--quiet", "-o", "gear.ngc")
    for command in (("demo", "-o", "demo"), words):
        run(morfax, *command, folder=tmp_path, XDG_CACHE_HOME=str(home))
    assert list(home.rglob("*.kernel")) == []
    program = (tmp_path / "gear.ngc").read_bytes()
    # what is damaged is compiled, and runs as before
    (kernel,) = installed.rglob("morfax.motion.speed_limits._passes.*.kernel")
    kernel.write_bytes(kernel.read_bytes()[:-1])
    run(morfax, *words, folder=tmp_path, XDG_CACHE_HOME=str(home))
    assert [file.name for file in home.rglob("*.kernel")] == [kernel.name]
    assert (tmp_path / "gear.ngc").read_bytes() == program

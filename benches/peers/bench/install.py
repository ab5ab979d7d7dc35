"""Environments of the renderers: one for each under target/peers, with what its requirements file names."""

import os
import shutil
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path

HERE = Path(__file__).resolve().parent
ROOT = HERE.parents[2]
FOLDER = ROOT / "target" / "peers"
# What Mitsuba compiles with. Version 15 does not know Zen 5, and ends the program.
LLVM = 19


class Missing(Exception):
    """What can't be installed, and why."""


def python(version: str | None) -> str:
    """An interpreter of a version, such as 3.13: wheels are made for some only."""
    if version is None or sys.version.startswith(version + "."):
        return sys.executable
    candidates = [shutil.which(f"python{version}")]
    candidates += map(str, sorted(Path.home().glob(f".pyenv/versions/{version}.*/bin/python"), reverse=True))
    for found in candidates:
        # What is found may be a stand-in for a version that is not there.
        if found and subprocess.run([found, "-c", ""], capture_output=True).returncode == 0:
            return found
    raise Missing(f"no Python {version} on the path or in ~/.pyenv/versions")


def environment(name: str, version: str | None = None) -> str:
    """The interpreter of an environment, made or brought up to date where it is not."""
    requirements = HERE / f"requirements-{name}.txt"
    folder, program = FOLDER / name, FOLDER / name / "bin" / "python"
    stamp = folder / "installed.txt"
    if stamp.is_file() and stamp.read_text() == requirements.read_text():
        return str(program)
    print(f"{name}: installing {', '.join(requirements.read_text().split())}", flush=True)
    if not program.is_file():
        subprocess.run([python(version), "-m", "venv", folder], check=True)
    done = subprocess.run([program, "-m", "pip", "install", "-q", "-r", requirements], capture_output=True, text=True)
    if done.returncode:
        raise Missing(f"pip could not install {requirements.name}: {done.stderr.strip().splitlines()[-1]}")
    shutil.copy(requirements, stamp)
    return str(program)


def in_own_environment():
    """Goes on in the environment with what these programs themselves need."""
    program = environment("run")
    if Path(sys.prefix).resolve() != (FOLDER / "run").resolve():
        os.execv(program, [program, *sys.argv])


@dataclass
class Renderer:
    """A renderer; `command` renders a scene when it is given the options of job.py."""

    name: str
    command: list[str]
    # Whether runs of different seeds are different.
    has_seeds: bool = True


def package(name: str):
    """Installs a package of the system where that is allowed; whether it worked is seen by what it brings."""
    if os.geteuid() == 0 and shutil.which("apt-get"):
        print(f"installing the package {name}", flush=True)
        command = ["apt-get", "install", "-y", "--no-install-recommends", name]
        done = subprocess.run(command, capture_output=True, text=True)
        if done.returncode:
            print(done.stderr.strip(), flush=True)


def povray():
    if not shutil.which("povray"):
        package("povray")
        if not shutil.which("povray"):
            raise Missing("apt-get install povray")
    return environment("run")


def mitsuba():
    """With the LLVM that compiles its vectorised variant; without it, Mitsuba takes what it finds, or the scalar variant."""
    libraries = lambda: sorted(Path("/usr/lib").glob(f"*/libLLVM-{LLVM}.so"))
    if "DRJIT_LIBLLVM_PATH" not in os.environ:
        if not libraries():
            package(f"libllvm{LLVM}")
        if libraries():
            os.environ["DRJIT_LIBLLVM_PATH"] = str(libraries()[0])
        else:
            print(f"mitsuba: no LLVM {LLVM}; what it finds may be slower, or not know this processor", flush=True)
    return environment("mitsuba")


def renderer(name: str) -> Renderer:
    """What is missing is installed."""
    shown, program, has_seeds = {
        "mitsuba": ("Mitsuba 3", mitsuba, True),
        "luxcore": ("LuxCore", lambda: environment("luxcore"), True),
        "cycles": ("Cycles", lambda: environment("cycles", "3.13"), True),
        "povray": ("POV-Ray", povray, False),
    }[name]
    return Renderer(shown, [program(), str(HERE / f"to_{name}.py")], has_seeds)


NAMES = ["mitsuba", "luxcore", "cycles", "povray"]
